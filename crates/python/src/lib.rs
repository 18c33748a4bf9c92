//! The compiled half of the Python package `seamstress_mesh`: calls of the facade, arrays as bytes, options and
//! reports as JSON. The other half, in Python, makes arrays and classes of them.

mod arrays;
mod attributes;
mod command;
mod errors;
mod json;
mod map;
mod quads;
mod run;
mod surface;

use pyo3::prelude::*;

/// What `seamstress_mesh` is made on. Its names are not public.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::command::{flags, main, write_file};
    #[pymodule_export]
    use super::map::Map;
    #[pymodule_export]
    use super::quads::{CrossField, Curves, Quads};
    #[pymodule_export]
    use super::surface::Surface;

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = seamstress::VERSION;
}
