//! Arguments of the commands for quad meshes.

use super::{EXIT_CODES, TextureArgs};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use seamstress_parametrize::quality::Measure;
use std::path::PathBuf;

const LAYOUT_EXAMPLES: &str = "\
Examples:
  seamstress layout-quads quads.obj -o map.obj
  seamstress layout-quads quads.obj -o map.obj --pictures pictures --texture-angle 22
  seamstress layout-quads quads.obj -o map.obj --method conformal";

const QUALITY_EXAMPLES: &str = "\
Examples:
  seamstress quality quads.obj
  seamstress quality quads.obj --source bunny.ply
  seamstress quality quads.obj --picture angles.png
  seamstress quality quads.obj --picture tau.png --of tau
  seamstress quality quads.obj --json | jq .angles";

/// Lay a quad mesh out in the plane, every quad a unit square
///
/// The quads, split into triangles, and their layout are an integer seamless map whose cones are the
/// irregular vertices. It is certified, its distortion measured, and it is written as an OBJ file with a
/// texture coordinate per corner, in units of one quad edge.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{LAYOUT_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct LayoutQuadsArgs {
    /// The quad mesh: OBJ, OFF or PLY
    pub(crate) quads: PathBuf,

    /// Write the map to this OBJ file, replacing an existing one
    #[arg(short, long, value_name = "MAP.obj")]
    pub(crate) output: PathBuf,

    /// How the coordinates are found
    #[arg(long, value_enum, value_name = "HOW", default_value_t = QuadLayoutMethod::Squares)]
    pub(crate) method: QuadLayoutMethod,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) texture: TextureArgs,

    /// Print the report as JSON on standard output instead of the summary
    #[arg(long)]
    pub(crate) json: bool,
}

/// Names of the methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum QuadLayoutMethod {
    /// One square after the other, breadth first: exact
    Squares,
    /// Least squares conformal map: one linear system, exact up to rounding
    Conformal,
}

/// What can be painted on a quad mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum QuadFigure {
    /// The largest deviation of a corner from the regular polygon's.
    Angle,
    /// A measure of the distortion of the layout.
    Measure(Measure),
}

fn quad_figure() -> impl TypedValueParser<Value = QuadFigure> {
    let names = std::iter::once("angle").chain(Measure::ALL.into_iter().map(Measure::name));
    PossibleValuesParser::new(names).map(|text| {
        let measure = Measure::ALL.into_iter().find(|measure| measure.name() == text);
        measure.map_or(QuadFigure::Angle, QuadFigure::Measure)
    })
}

/// Measure a quad mesh
///
/// Irregular vertices, angles, edge lengths, and the distortion of the map to a layout in which every
/// quad is a unit square, in every measure; with a source, the distances between the two surfaces both ways
/// and quads that face the wrong way. Meshes with triangles or
/// larger polygons are measured where the figures are defined.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{QUALITY_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct QualityArgs {
    /// The quad mesh: OBJ, OFF or PLY
    pub(crate) quads: PathBuf,

    /// The surface it was made from, to measure the distances to: OBJ, OFF, PLY or STL
    #[arg(long, value_name = "MESH")]
    pub(crate) source: Option<PathBuf>,

    /// Draw the mesh from both sides, with its irregular vertices, in the colours of a figure
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,

    /// The figure that is painted: the largest deviation of an angle, or a distortion of the layout
    #[arg(long, value_name = "FIGURE", value_parser = quad_figure(), default_value = "angle", requires = "picture")]
    pub(crate) of: QuadFigure,

    /// Points sampled on each surface, about
    #[arg(
        long,
        value_name = "N",
        default_value_t = 100_000,
        value_parser = clap::value_parser!(u32).range(1..=100_000_000),
        requires = "source"
    )]
    pub(crate) samples: u32,

    /// Print the report as JSON on standard output instead of the table
    #[arg(long)]
    pub(crate) json: bool,
}
