//! Figures of merit of a map.

mod distortion;
mod figures;
mod frames;
mod measure;
mod scale;
mod singular;
mod summary;

pub use distortion::{Distortion, distortion};
pub use figures::Figures;
pub use frames::{distance_to_frames, frames};
pub use measure::{Aggregate, Measure};
pub use singular::SingularValues;
pub use summary::{Percentiles, Summary, measure_all, summarize};
