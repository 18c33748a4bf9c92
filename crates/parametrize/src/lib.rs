//! Direct seamless parametrization of triangle meshes.
//!
//! Data flow; each stage is a module that takes values and returns new ones:
//!
//! `cut` -> `rounding` (alternating with `layout`) -> exact `layout` -> [`map`]
//!
//! A given [`field`] replaces the rounding; the mesh is still cut. [`make_map`] runs all stages, and
//! [`SeamlessMap::certify`] is the only way to construct a map.

#![cfg_attr(
    not(feature = "internals"),
    allow(
        dead_code,
        unreachable_pub,
        unused_imports,
        reason = "tests and benches use more of the stages than the method does"
    )
)]

pub mod atlas;
mod chebyshev;
pub mod consistency;
mod cotangent;
pub mod field;
pub mod map;
mod method;
mod ordered;
pub mod progress;
pub mod quality;
mod sizes;

// The stages are private, but to the crates that build on them, to tests and to benches.
#[cfg(not(feature = "internals"))]
mod cut;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod cut;
#[cfg(not(feature = "internals"))]
mod energy;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod energy;
#[cfg(not(feature = "internals"))]
mod features;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod features;
#[cfg(not(feature = "internals"))]
mod layout;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod layout;
#[cfg(not(feature = "internals"))]
mod mixed_integer;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod mixed_integer;
#[cfg(not(feature = "internals"))]
mod quarter;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod quarter;
#[cfg(not(feature = "internals"))]
mod rounding;
#[cfg(feature = "internals")]
#[doc(hidden)]
pub mod rounding;

pub use features::{ReleaseReason, ReleasedFeature, Sectors};
pub use layout::anisotropy::{Anisotropy, Stretch};
pub use layout::conic::Solver;
pub use layout::objective::{ConicStats, Objective, ObjectiveOptions};
pub use layout::polish::PolishOptions;
#[doc(hidden)]
pub use map::followed;
pub use map::{Alignment, SeamlessMap, Tolerance, Violation, Violations};
pub use method::{
    ComponentStats, FieldMap, FieldMapOptions, MapError, MapOptions, MapSolution, MethodError,
    Purpose, Relayout, RelayoutOptions, RelayoutStats, StageStats, Start, UncertifiedMap,
    lay_out_disk, make_aligned_map, make_field_map, make_map, make_map_from, relayout,
};
pub use mixed_integer::{MixedIntegerOptions, MixedIntegerStats};
pub use progress::{Observer, Progress, Stage};
pub use rounding::{RoundingOptions, RoundingStrategy};
pub use sizes::{SizeError, Sizing, sizes};
