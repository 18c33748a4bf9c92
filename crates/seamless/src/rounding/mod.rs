//! Choosing an integer matching for every seam.

mod bias;
mod clean_up;
mod holonomy;
mod matched;
mod relaxation;
mod repair;
mod surrogate;

pub use bias::{RoundingOptions, RoundingStats, round};
pub use clean_up::{CleanUpError, CleanUpOptions, CleanUpStats, clean_up};
pub use holonomy::fix_holonomy;
pub use matched::MatchedCut;
pub use repair::{index_bounds, repair};
pub use surrogate::Surrogate;
