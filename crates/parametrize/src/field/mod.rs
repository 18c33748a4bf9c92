//! Cross fields: what a seamless map says about directions, and maps that start from directions.
//!
//! A [`CrossField`] has a frame per face and a lifted matching per edge. [`extract`] reads one off a
//! map; [`smooth_field`] makes one by mixed-integer rounding; a [`ConePrescription`] says which cones a
//! map shall have. [`crate::make_map_from`] maps any of them. Conventions: `docs/theory/10-fields.md`.

mod convert;
mod cross_field;
mod curvature;
mod extract;
mod face_laplacian;
mod frames_of_matchings;
mod guide;
mod homology;
mod lift;
mod matched;
mod prescription;
mod smooth;
mod strokes;
mod transfer;

pub use convert::{directions_in_space, frames_from_directions, matchings_from_rows};
pub use cross_field::{CrossField, FieldError};
pub(crate) use curvature::Bending;
pub use extract::{ExtractError, extract, map_frames, map_indices};
pub(crate) use frames_of_matchings::frames_of;
pub use frames_of_matchings::{smooth_frames, spectral_frames};
pub use guide::Guide;
pub(crate) use guide::LEAST_CELL;
pub use homology::{DualLoop, Homology, NodeIndices};
pub use lift::{LiftError, lift};
pub use matched::{ResidualFieldError, matched_cut, residual_field};
pub(crate) use prescription::check_angle;
pub use prescription::{ConePrescription, PrescriptionError};
pub use smooth::{SmoothStats, smooth_field};
pub use strokes::{Stroke, along_strokes};
pub use transfer::impose;
