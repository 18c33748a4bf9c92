//! What exists to study or compare: other ways of rounding, other starts, the classical baseline, consistent matchings,
//! layouts of quad meshes.

mod baseline;
mod method;
mod quads;
mod start;

pub use baseline::{FieldLayout, FieldLayoutReport, LaidOut};
pub use method::{MethodOptions, Rounding, RoundingOptions};
pub use quads::{QuadLayout, QuadLayoutMethod, QuadLayoutReport};
pub use start::{MethodName, StartOptions};
