//! Arguments of `extract`.

use super::{EXIT_CODES, RunArgs, not_negative};
use crate::features::FeatureSource;
use clap::value_parser;
use seamstress_quads::ExtractOptions;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  seamstress extract integer.obj -o quads.obj
  seamstress extract integer.obj -o quads.ply --picture quads.png --report quads.json
  seamstress extract integer.obj -o quads.obj --smooth 10
  seamstress extract integer.obj -o quads.obj --features angle:40
  seamstress extract other_program.obj -o quads.obj --best-effort";

/// Extract a quad mesh from an integer map
///
/// An integer map is a seamless map in grid units: translations across seams are integers and cones
/// at grid points. Its grid, drawn on the surface, is the quad mesh. Maps of any program are taken;
/// small inexactness is removed first, and reported. At a boundary that does not follow the grid the
/// cells it cuts are left out.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct ExtractArgs {
    /// The integer map: an OBJ file with positions, triangles and a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    pub(crate) map: PathBuf,

    /// Write the quad mesh to this OBJ or PLY file, replacing an existing one
    #[arg(short, long, value_name = "QUADS")]
    pub(crate) output: PathBuf,

    /// Leave every vertex where the map has it, and badly shaped quads as they are
    #[arg(long)]
    pub(crate) raw: bool,

    /// Move the vertices along the surface this many times, to even out angles and lengths
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = value_parser!(u32).range(0..=1000))]
    pub(crate) smooth: u32,

    /// Keep vertices on these feature edges; may be given several times
    ///
    /// They are those that the map aligns, from the sources of `quad`: angle:DEGREES, lines, pairs:FILE or sharp:FILE.
    /// Where the map has a vertex of the quads on one, that slides along it when quads are mended or smoothed.
    #[arg(long, value_name = "SOURCE")]
    pub(crate) features: Vec<FeatureSource>,

    /// How far translations, cones and seams may be from exact, in grid units
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        default_value_t = ExtractOptions::default().tolerance
    )]
    pub(crate) tolerance: f64,

    /// Extract what can be extracted from a map that folds, and write it even if it is not a manifold
    #[arg(long)]
    pub(crate) best_effort: bool,

    /// Write all figures of the run to this JSON file
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Write a picture of the quad mesh with its irregular vertices to this PNG file
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}
