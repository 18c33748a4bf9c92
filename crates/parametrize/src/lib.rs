//! Direct seamless parametrization of triangle meshes.
//!
//! The way of the data, each stage a module that takes values and returns new ones:
//!
//! [`cut`] -> [`rounding`] (alternating with [`layout`]) -> exact [`layout`] -> [`map`]
//!
//! A [`field`] can take the place of the first two. [`make_map`] runs them all; [`SeamlessMap::certify`] is the only door to a map.

pub mod consistency;
pub mod cut;
pub mod energy;
pub mod features;
pub mod field;
pub mod layout;
pub mod map;
mod method;
pub mod mixed_integer;
mod ordered;
pub mod progress;
pub mod quality;
pub mod quarter;
pub mod rounding;

pub use features::{ReleaseReason, ReleasedFeature, Sectors};
pub use layout::anisotropy::{Anisotropy, Stretch};
pub use layout::conic::Solver;
pub use layout::objective::{ConicStats, Objective, ObjectiveOptions};
pub use layout::polish::PolishOptions;
#[doc(hidden)]
pub use map::followed;
pub use map::{
    Alignment, AlignmentTolerance, SeamlessMap, Tolerance, ToleranceError, Violation, Violations,
};
pub use method::{
    ComponentStats, FieldMap, FieldMapOptions, MapError, MapOptions, MapSolution, MethodError,
    Purpose, Relayout, RelayoutOptions, RelayoutStats, StageStats, Start, UncertifiedMap,
    lay_out_disk, make_aligned_map, make_field_map, make_map, make_map_from, relayout,
};
pub use progress::{Observer, Progress, Stage};
