//! Choosing an integer matching for every seam.

mod clean_up;
mod holonomy;
mod matched;
mod patch;
mod progressive;
mod relaxation;
mod repair;
mod surrogate;
mod system;
mod weights;

pub use clean_up::{CleanUpError, CleanUpOptions, CleanUpStats, ConeCount, clean_up};
pub use holonomy::fix_holonomy;
pub use matched::MatchedCut;
pub use progressive::{RoundingOptions, RoundingStats, RoundingStrategy, round};
pub use repair::{index_bounds, repair};
pub use surrogate::Surrogate;
