//! Summaries for people: rows of a label and a text.

mod cost;
mod features;
mod map;
mod quads;
mod quality;
mod surface;

pub(crate) use cost::{cost_row, stages};
pub(crate) use features::{aligned_rows, alignment_row, feature_rows};
pub(crate) use map::{
    cell_size_rows, certificate_rows, distortion_rows, integers_row, map_rows, mixed_integer_rows,
    packing_rows,
};
pub(crate) use quads::{quad_rows, quad_warnings};
pub(crate) use quality::{measure_table, quality_rows};
pub(crate) use surface::{
    failed_warnings, lost_warning, part_rows, size_rows, surface_rows, symmetry_rows,
};
