//! Arguments of `measure`.

use super::{EXIT_CODES, measure, not_negative, tolerance};
use seamstress_parametrize::Tolerance;
use seamstress_parametrize::quality::Measure;
use std::path::PathBuf;

const MEASURE_EXAMPLES: &str = "\
Examples:
  seamstress measure bunny.ply bunny.obj
  seamstress measure bunny.ply bunny.obj --picture stretch.png --of symmetric-dirichlet
  seamstress measure bunny.ply other_program.obj --tolerance 1e-5
  seamstress measure bunny.ply bunny.obj --json | jq '.measures[] | {measure, mean, max}'";

/// Measure the distortion of a map in every way
///
/// Prints a table: tau, the symmetric Dirichlet energy, the distance to rotations (ARAP) and to
/// similarities (ASAP), and the dilatation K; mean over the surface, maximum, and percentiles over the
/// triangles, each at the global scale that suits it. Any map with the triangles of the mesh will do,
/// with flips and open seams too.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{MEASURE_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct MeasureArgs {
    /// The mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// A map of the mesh: an OBJ file with a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    pub(crate) map: PathBuf,

    /// Paint a measure on the surface, from both sides, and write the picture to this file
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,

    /// The measure that is painted
    #[arg(long, value_name = "MEASURE", value_parser = measure(), default_value = "tau", requires = "picture")]
    pub(crate) of: Measure,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long)]
    pub(crate) repair: bool,

    /// How far the sides of a seam may be apart, in mean edge lengths of the map, for it to count as
    /// seamless [default: 1e-9]
    #[arg(long, value_name = "X", value_parser = not_negative)]
    pub(crate) tolerance: Option<f64>,

    /// Print everything as JSON on standard output
    #[arg(long)]
    pub(crate) json: bool,
}

impl MeasureArgs {
    /// How exact a map must be to count as seamless.
    pub(crate) fn tolerance(&self) -> Tolerance {
        tolerance(self.tolerance)
    }
}
