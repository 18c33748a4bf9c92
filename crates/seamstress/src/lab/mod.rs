//! What exists to study or compare: other ways of rounding, other starts, the classical baseline, consistent matchings,
//! layouts of quad meshes.

mod baseline;
mod matchings;
mod method;
mod options;
mod quads;
mod start;
mod stretches;

pub use baseline::{FieldLayout, FieldLayoutReport, LaidOut};
pub use matchings::{ConsistencyReport, ConsistentMatchings, MatchingOptions, Norm};
pub use options::{MethodOptions, Rounding, RoundingOptions};
pub use quads::{QuadLayout, QuadLayoutMethod, QuadLayoutReport};
pub use start::{MethodName, StartOptions};
pub use stretches::read_stretches;
