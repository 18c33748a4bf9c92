//! Arguments of `field`.

use super::{EXIT_CODES, not_negative};
use seamstress_parametrize::Tolerance;
use std::path::PathBuf;

const FIELD_EXAMPLES: &str = "\
Examples:
  seamstress field bunny.ply bunny.obj -o bunny.rawfield
  seamstress field bunny.ply bunny.obj -o bunny.rosy --sing bunny.sing --matching bunny.matching
  seamstress field quads.obj -o quads.rawfield --sing quads.sing";

/// Read the cross field off a seamless map, or off a quad mesh
///
/// Frames come from the map's Jacobians, indices from its cone angles, matchings from its transitions
/// across seams. `map --field` leads back to a map with the same cones. Without a map the mesh must be of
/// quads; its map is the layout of every quad as a unit square, and the field is one of the triangles into
/// which `map` splits the quads, two for each.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{FIELD_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct FieldArgs {
    /// The mesh, or the quad mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// A seamless map of the mesh: an OBJ file with a texture coordinate at every corner; not for a quad
    /// mesh
    #[arg(value_name = "MAP.obj")]
    pub(crate) map: Option<PathBuf>,

    /// Write the field to this file: .rosy with one direction per face, else .rawfield with four
    #[arg(short, long, value_name = "FIELD")]
    pub(crate) output: PathBuf,

    /// Write the cones to this file: vertex (counted from 0) and index in quarters of a turn
    #[arg(long, value_name = "FILE.sing")]
    pub(crate) sing: Option<PathBuf>,

    /// Write the matchings modulo 4 to this file
    #[arg(long, value_name = "FILE.matching")]
    pub(crate) matching: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long, requires = "map")]
    pub(crate) repair: bool,

    /// How far the sides of a seam may be apart, in mean edge lengths of the map
    #[arg(long, value_name = "X", value_parser = not_negative, default_value_t = Tolerance::default().seam)]
    pub(crate) tolerance: f64,

    /// Print the indices as JSON on standard output instead of the summary
    #[arg(long)]
    pub(crate) json: bool,
}
