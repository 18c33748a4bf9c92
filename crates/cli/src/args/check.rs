//! Arguments of `check`.

use super::{EXIT_CODES, FeatureArgs, not_negative, tolerance};
use seamstress_parametrize::{AlignmentTolerance, Tolerance};
use std::path::PathBuf;

const CHECK_EXAMPLES: &str = "\
Examples:
  seamstress check bunny.ply
  seamstress check bunny.ply bunny.obj
  seamstress check bunny.ply other_program.obj --tolerance 1e-5
  seamstress check part.obj --features angle:40 --align-boundary --picture part.png
  seamstress check part.obj part_map.obj --features sharp:part.sharp
  seamstress check scan.stl --json | jq '.faults[].message'";

/// List the faults of a mesh, or certify a map
///
/// With a mesh alone: its size, its topology, and everything that keeps it from being mapped. With a
/// map as well: whether the map has the mesh's vertices and faces and is seamless, and its distortion;
/// or else everything that is wrong with it. With features: their curves and corners, and whether the
/// map has them on its grid lines. Vertices, faces and components are counted from 0.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{CHECK_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct CheckArgs {
    /// The mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// A map of the mesh: an OBJ file with a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    pub(crate) map: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long)]
    pub(crate) repair: bool,

    /// How far the sides of a seam may be apart.
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        requires = "map",
        help = format!(
            "How far the sides of a seam may be apart, in mean edge lengths of the map; foreign \
             maps of few digits need more [default: {:e}]",
            Tolerance::default().seam
        )
    )]
    pub(crate) tolerance: Option<f64>,

    #[command(flatten)]
    pub(crate) features: FeatureArgs,

    /// How far a feature may be off the axes of the map.
    #[arg(
        long,
        value_name = "DEGREES",
        value_parser = not_negative,
        requires = "map",
        help = format!(
            "How far a feature may be off the axes of the map, in degrees; foreign maps of few \
             digits need more [default: {:e}]",
            AlignmentTolerance::default().axis
        )
    )]
    pub(crate) alignment_tolerance: Option<f64>,

    /// Draw the mesh with its features to this PNG file
    #[arg(long, value_name = "FILE.png", conflicts_with = "map")]
    pub(crate) picture: Option<PathBuf>,

    /// Print everything as JSON on standard output, with all faults
    #[arg(long)]
    pub(crate) json: bool,
}

impl CheckArgs {
    /// How exact a map must be.
    pub(crate) fn tolerance(&self) -> Tolerance {
        tolerance(self.tolerance)
    }

    /// How well features must be aligned.
    pub(crate) fn alignment_tolerance(&self) -> AlignmentTolerance {
        let mut tolerance = AlignmentTolerance::default();
        if let Some(axis) = self.alignment_tolerance {
            tolerance.axis = axis;
        }
        tolerance
    }
}
