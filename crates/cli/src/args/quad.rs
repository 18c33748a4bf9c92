//! Arguments of `quad`.

use super::integer::SizeArgs;
use super::{ConeArgs, EXIT_CODES, FeatureArgs, RunArgs};
use clap::value_parser;
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  seamstress quad bunny.ply --quads 5000 -o quads.obj
  seamstress quad bunny.ply --edge-length 0.02 -o quads.ply --picture quads.png
  seamstress quad part.off --quads 3000 -o quads.obj --features angle:40 --align-boundary
  seamstress quad scan.stl --quads 800 -o quads.obj --repair --time-limit 60";

/// Make a quad mesh of a triangle mesh
///
/// A seamless map (as by `map`), rounded to an integer map (as by `integer`), whose grid is extracted (as by
/// `extract`): quads only, an oriented manifold, its irregular vertices the cones of the map. Creases are
/// followed with `--features`, boundaries with `--align-boundary`; cells that a boundary cuts are left out.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct QuadArgs {
    /// The mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// Write the quad mesh to this OBJ or PLY file, replacing an existing one
    #[arg(short, long, value_name = "QUADS")]
    pub(crate) output: PathBuf,

    #[command(flatten)]
    pub(crate) size: SizeArgs,

    /// Leave every vertex where the map has it, and badly shaped quads as they are
    #[arg(long)]
    pub(crate) raw: bool,

    /// Move the vertices along the surface this many times, to even out angles and lengths
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = value_parser!(u32).range(0..=1000))]
    pub(crate) smooth: u32,

    /// Write all figures of the run to this JSON file
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Write a picture of the quad mesh with its irregular vertices to this PNG file
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long)]
    pub(crate) repair: bool,

    #[command(flatten)]
    pub(crate) features: FeatureArgs,

    #[command(flatten)]
    pub(crate) method: ConeArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}
