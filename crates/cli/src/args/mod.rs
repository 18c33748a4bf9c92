//! The command line.

mod check;
mod extract;
mod features;
mod field;
mod integer;
mod layout;
mod map;
mod measure;
mod quad;
mod quads;
mod repair_matchings;
mod start;
mod texture;

pub(crate) use check::CheckArgs;
pub(crate) use extract::ExtractArgs;
pub(crate) use features::FeatureArgs;
pub(crate) use field::FieldArgs;
pub(crate) use integer::{GridRounding, IntegerArgs};
pub(crate) use layout::LayoutArgs;
pub(crate) use map::{MapArgs, Rounding};
pub(crate) use measure::MeasureArgs;
pub(crate) use quad::QuadArgs;
pub(crate) use quads::{LayoutQuadsArgs, QuadFigure, QuadLayoutMethod, QualityArgs};
pub(crate) use repair_matchings::{Norm, RepairMatchingsArgs};
pub(crate) use start::{Method, StartArgs};
pub(crate) use texture::TextureArgs;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand, value_parser};
use seamstress_parametrize::quality::Measure;
use seamstress_parametrize::rounding::RoundingOptions;
use seamstress_parametrize::{MapOptions, Objective, Tolerance};
use std::time::Duration;

const EXIT_CODES: &str = "\
Exit codes:
  0  done; any map written or checked is certified (unless written with `--allow-flips`)
  1  the input is at fault: unreadable, not a mesh, not a seamless map, not a field of the mesh, or
     cones that no map can have
  2  wrong usage: unknown option, or an output that cannot be written
  3  no certified map could be made, or its quads are no manifold; nothing is written
  4  stopped by the time limit or by Ctrl-C; nothing is written";

const EXAMPLES: &str = "\
Examples:
  seamstress map bunny.ply -o bunny.obj
  seamstress map bunny.ply -o bunny.obj --report bunny.json --pictures bunny
  seamstress map scan.stl -o scan.obj --repair --time-limit 60
  seamstress quad bunny.ply --quads 5000 -o quads.obj
  seamstress integer bunny.ply --quads 5000 -o grid.obj
  seamstress check bunny.ply
  seamstress check bunny.ply bunny.obj
  seamstress measure bunny.ply bunny.obj --picture heat.png
  seamstress layout bunny.ply bunny.obj --objective asap -o conformal.obj
  seamstress extract integer.obj -o quads.obj";

/// Makes seamless maps of triangle meshes
///
/// A seamless map flattens a surface into the plane. The surface is cut along seams, and the two
/// sides of every seam fit after a turn by a multiple of 90 degrees and a shift. A square grid drawn
/// in the plane therefore closes up over the whole surface, except at a few points called cones. Quad
/// meshing and seamless textures start from such a map.
///
/// `map` makes a map and certifies it: no triangle is flipped or collapsed, every seam fits, and the
/// angle at every cone is a multiple of 90 degrees. `integer` makes a map whose unit squares close up
/// over the surface, and `extract` turns such a map into a quad mesh. `check` lists what is wrong with
/// a mesh, or certifies the map in a file, whatever program wrote it. `measure` tells the distortion of
/// any map, and `layout` lowers the kind of distortion you choose.
#[derive(Debug, Parser)]
#[command(
    name = "seamstress",
    version,
    max_term_width = 100,
    after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}")
)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Map(MapArgs),
    Quad(QuadArgs),
    Integer(IntegerArgs),
    Check(CheckArgs),
    Extract(ExtractArgs),
    Field(FieldArgs),
    RepairMatchings(RepairMatchingsArgs),
    LayoutQuads(LayoutQuadsArgs),
    Quality(QualityArgs),
    Measure(MeasureArgs),
    Layout(LayoutArgs),
}

/// What every command that may take long has.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct RunArgs {
    /// Give up when the work is not done after this many seconds [default: no limit]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) time_limit: Option<Duration>,

    /// Number of threads; the result does not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1024))]
    pub(crate) threads: Option<u32>,

    /// Print the report as JSON on standard output instead of the summary
    #[arg(long)]
    pub(crate) json: bool,

    /// Print no summary, progress, notes or warnings, only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// How many cones a seamless map gets.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(crate) struct ConeArgs {
    /// How much to avoid cones: 0 gives the lowest distortion, larger values fewer cones
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        default_value_t = RoundingOptions::default().cone_bias
    )]
    pub(crate) cone_bias: f64,

    /// Distortion that may be paid for one cone fewer when cones are cleaned up, as mean symmetric
    /// Dirichlet energy (4 is an isometry); 0 leaves the cones as they were rounded [default: 0.0006;
    /// for quads the share of the surface that four of them have, but at least 0.0015]
    #[arg(long, value_name = "X", value_parser = not_negative)]
    pub(crate) cone_price: Option<f64>,
}

impl ConeArgs {
    /// The settings of the method, with the defaults for all others.
    pub(crate) fn options(&self) -> MapOptions {
        let mut options = MapOptions::default();
        options.rounding.cone_bias = self.cone_bias;
        options.cone_price = self.cone_price;
        options
    }
}

/// Names of objectives.
fn objective() -> impl TypedValueParser<Value = Objective> {
    PossibleValuesParser::new(Objective::ALL.map(Objective::name)).map(|name| {
        // The parser lets no other name pass.
        let named = Objective::ALL.into_iter().find(|objective| objective.name() == name);
        named.unwrap_or(Objective::SymmetricDirichlet)
    })
}

/// Names of measures.
fn measure() -> impl TypedValueParser<Value = Measure> {
    PossibleValuesParser::new(Measure::ALL.map(Measure::name)).map(|name| {
        let named = Measure::ALL.into_iter().find(|measure| measure.name() == name);
        named.unwrap_or(Measure::Tau)
    })
}

/// The certificate's tolerance with another one for seams.
fn tolerance(seam: Option<f64>) -> Tolerance {
    let mut tolerance = Tolerance::default();
    if let Some(seam) = seam {
        tolerance.seam = seam;
    }
    tolerance
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("expected a number, 0 or larger".into()),
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let positive = text.parse().ok().filter(|&x: &f64| x > 0.0);
    positive
        .and_then(|x| Duration::try_from_secs_f64(x).ok())
        .ok_or_else(|| "expected a number of seconds larger than 0".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn seconds_are_positive_and_finite() {
        assert_eq!(seconds("0.25"), Ok(Duration::from_millis(250)));
        for text in ["0", "-1", "nan", "inf", "1e300", "soon", ""] {
            assert!(seconds(text).is_err(), "{text}");
        }
    }
}
