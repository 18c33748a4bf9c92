//! Sparse linear algebra for Seamstress: orderings, patterns and Cholesky factorisations.
//!
//! A few ideas, one file each:
//! * [`ordering`]: elimination orders of a graph, by nested dissection (METIS, feature `metis`) or minimum
//!   degree, so that factors stay sparse;
//! * [`pattern`]: a symmetric sparsity pattern that is built once and filled many times;
//! * [`buckets`]: ids grouped by a key;
//! * [`assembly`]: sums of small dense blocks into such a pattern;
//! * [`dense`]: small dense systems;
//! * [`cholesky`]: a multifrontal factorisation whose symbolic analysis is done once, and entries of
//!   the inverse at the places of the pattern.

pub mod assembly;
pub mod buckets;
pub mod cholesky;
pub mod dense;
pub mod ordering;
pub mod pattern;

pub use assembly::Assembly;
pub use buckets::Buckets;
pub use cholesky::{Cholesky, NotPositiveDefinite, Scalar};
pub use num_complex::Complex64;
pub use pattern::{Pattern, PatternBuilder};
