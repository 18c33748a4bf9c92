//! Laying a cut mesh out in the plane.

pub mod alignment;
pub mod anisotropy;
pub mod arap;
pub mod conic;
pub mod disk;
mod element;
pub mod exact;
pub mod homotopy;
pub mod ladder;
pub mod newton;
pub mod objective;
pub mod penalty;
pub mod polish;
pub mod problem;
pub mod route;
pub mod space;

// Old paths of what moved to `cut` and `energy`.
#[doc(hidden)]
pub use crate::cut as isometric;
#[doc(hidden)]
pub use crate::energy;
#[doc(hidden)]
pub use crate::energy as distance;
#[doc(hidden)]
pub use crate::energy as triangle;
#[doc(hidden)]
pub use crate::energy as window;
