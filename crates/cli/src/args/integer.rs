//! Arguments of `integer`.

use super::texture::positive;
use super::{ConeArgs, EXIT_CODES, FeatureArgs, RunArgs, TextureArgs, not_negative};
use seamstress_parametrize::Tolerance;
use seamstress_quantize::{GridSize, IntegerOptions, IntegerRounding};
use std::path::PathBuf;

const INTEGER_EXAMPLES: &str = "\
Examples:
  seamstress integer bunny.ply --quads 5000 -o grid.obj
  seamstress integer bunny.ply bunny.obj --edge-length 0.02 -o grid.obj
  seamstress integer part.off --scale 4 -o grid.obj --pictures part
  seamstress integer part.off --quads 3000 --features angle:40 --align-boundary -o grid.obj
  seamstress integer part.off --quads 800 -o grid.obj --json | jq .grid";

/// Make an integer map: a seamless map whose unit squares close up over the surface
///
/// Rounds a seamless map so that the shifts across all seams and the positions of all cones are whole
/// numbers, exactly, without flipping a triangle. The grid of unit squares is then a quad mesh of the
/// surface. Where cones are too close for the grid, it is made finer, and the summary says so. Without a
/// map the seamless map is made first, as `map` does. Features and boundaries that are aligned come to lie
/// on lines of the grid; in a map that is given, those that it aligns.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{INTEGER_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct IntegerArgs {
    /// The mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// A seamless map of the mesh: an OBJ file with a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    pub(crate) map: Option<PathBuf>,

    /// Write the integer map to this OBJ file, replacing an existing one
    #[arg(short, long, value_name = "INT.obj")]
    pub(crate) output: PathBuf,

    #[command(flatten)]
    pub(crate) size: SizeArgs,

    /// How the whole numbers are chosen
    #[arg(long, value_enum, value_name = "HOW", default_value_t = GridRounding::Constrained)]
    pub(crate) rounding: GridRounding,

    /// Write all figures of the run to this JSON file
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long)]
    pub(crate) repair: bool,

    #[command(flatten)]
    pub(crate) texture: TextureArgs,

    #[command(flatten)]
    pub(crate) features: FeatureArgs,

    #[command(flatten)]
    pub(crate) method: ConeArgs,

    /// How far the sides of a seam may be apart in the map that is read, in mean edge lengths of that map
    #[arg(long, value_name = "X", value_parser = not_negative, requires = "map")]
    pub(crate) tolerance: Option<f64>,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// How fine the grid is to be.
#[derive(Debug, Clone, Copy, clap::Args)]
#[group(required = true, multiple = false)]
pub(crate) struct SizeArgs {
    /// About so many quads in all
    #[arg(long, value_name = "N", value_parser = positive)]
    quads: Option<f64>,

    /// Mean edge length of the quads, in mesh units
    #[arg(long, value_name = "L", value_parser = positive)]
    edge_length: Option<f64>,

    /// Grid units per mesh unit
    #[arg(long, value_name = "S", value_parser = positive)]
    scale: Option<f64>,
}

impl SizeArgs {
    /// The one that is given; the parser sees to it that there is one.
    pub(crate) fn grid(&self) -> GridSize {
        let given = self.quads.map(GridSize::Quads);
        let given = given.or(self.edge_length.map(GridSize::EdgeLength));
        given.or(self.scale.map(GridSize::Scale)).unwrap_or(IntegerOptions::default().size)
    }
}

/// Names of the ways to round.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum GridRounding {
    /// The nearest whole numbers in the symmetric Dirichlet energy that keep cones apart
    Constrained,
    /// One number after the other in the energy that preserves Jacobians; often fails
    Greedy,
}

impl IntegerArgs {
    /// The settings of the method.
    pub(crate) fn options(&self) -> IntegerOptions {
        let mut options = IntegerOptions { tolerance: self.tolerance(), ..Default::default() };
        options.size = self.size.grid();
        options.rounding = match self.rounding {
            GridRounding::Constrained => IntegerRounding::Constrained,
            GridRounding::Greedy => IntegerRounding::Greedy,
        };
        options
    }

    fn tolerance(&self) -> Tolerance {
        let mut tolerance = Tolerance::default();
        if let Some(seam) = self.tolerance {
            tolerance.seam = seam;
        }
        tolerance
    }
}
