//! Choosing an integer matching for every seam.

mod clean_up;
mod holonomy;
mod options;
mod patch;
mod progressive;
mod relaxation;
mod repair;
mod surrogate;
mod system;
mod weights;

pub use crate::cut::MatchedCut;
pub use clean_up::{CleanUpError, CleanUpOptions, CleanUpStats, ConeCount, clean_up};
pub use holonomy::fix_holonomy;
pub use options::{RoundingOptions, RoundingStrategy};
pub use progressive::{RoundingStats, round};
pub use repair::repair;
pub use surrogate::Surrogate;
