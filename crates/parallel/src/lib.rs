//! Loops on all cores, or on one, for Seamstress.
//!
//! With the feature `rayon` the [`prelude`] is rayon's. Without it the same method names are those of plain
//! iterators, for targets without threads and for builds that want no thread pool. Loops written with them
//! return the same bytes either way, since the results of rayon's adaptors keep the order of the input.
//! `reduce` is left out on purpose: collect and fold, so that a sum has one order.

#[cfg(not(feature = "rayon"))]
#[path = "sequential.rs"]
pub mod prelude;
mod threads;

#[cfg(feature = "rayon")]
pub use rayon::prelude;
pub use threads::{ThreadsError, beside, both, n_threads, with_threads};
