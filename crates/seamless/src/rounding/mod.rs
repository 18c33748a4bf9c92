//! Choosing an integer matching for every seam.

mod bias;
mod matched;
mod relaxation;
mod repair;

pub use bias::{RoundingOptions, RoundingStats, round};
pub use matched::MatchedCut;
pub use repair::{index_bounds, repair};
