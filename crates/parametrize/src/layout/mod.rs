//! Laying a cut mesh out in the plane.

pub mod alignment;
pub mod anisotropy;
pub mod arap;
pub mod conic;
pub mod disk;
pub mod distance;
mod element;
pub mod energy;
pub mod exact;
pub mod homotopy;
pub mod isometric;
pub mod newton;
pub mod objective;
pub mod penalty;
pub mod polish;
pub mod problem;
pub mod safeguards;
pub mod space;
pub mod triangle;
pub mod window;
