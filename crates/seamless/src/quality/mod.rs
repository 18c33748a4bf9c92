//! Figures of merit of a map.

mod distortion;

pub use distortion::{Distortion, Percentiles, distortion};
