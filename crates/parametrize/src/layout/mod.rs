//! Laying a cut mesh out in the plane.

pub mod alignment;
pub mod anisotropy;
pub mod arap;
pub mod barrier;
pub mod conic;
pub mod disk;
mod element;
pub mod exact;
pub mod ladder;
pub mod newton;
pub mod objective;
pub mod patch;
pub mod penalty;
pub mod polish;
pub mod problem;
pub mod route;
pub mod space;
mod untangle;
mod windings;
