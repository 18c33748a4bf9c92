//! The command line: which commands there are, and what they have in common.

use crate::command;
use crate::commands::{
    CheckArgs, CompletionsArgs, ExtractArgs, FeaturesArgs, FieldArgs, IntegerArgs, LayoutQuadsArgs,
    ManArgs, MapArgs, MatchingsArgs, MeasureArgs, OptimizeArgs, QuadArgs, QualityArgs,
};
use crate::failure::{Failure, Status};
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, value_parser};
use seamstress::{FeatureSource, Features, GridSize};
use std::path::Path;
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
  seamstress features part.obj --features angle:40 --picture part.png
  seamstress extract grid.obj -o quads.obj";

/// Seamless parametrizations of triangle meshes, integer-grid maps and quad meshes
///
/// A seamless map flattens a surface into the plane. The surface is cut along seams, and the two
/// sides of every seam fit after a turn by a multiple of 90 degrees and a shift. A square grid drawn
/// in the plane therefore closes up over the whole surface, except at a few points called cones. Quad
/// meshing and seamless textures start from such a map.
///
/// `map` makes a map and certifies it: no triangle is flipped or collapsed, every seam fits, and the
/// angle at every cone is a multiple of 90 degrees. `quad` makes a quad mesh in one step; `integer`
/// makes the integer-grid map that it comes from, whose unit squares close up over the surface, and
/// `extract` takes the quads of such a map. `check` lists what is wrong with a mesh, or certifies the
/// map in a file, whatever program wrote it. `measure` and `quality` measure maps and quad meshes, and
/// `lab` has what exists to study and compare.
#[derive(Debug, Parser)]
#[command(
    name = "seamstress",
    version,
    max_term_width = 100,
    after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}")
)]
pub(crate) struct CommandLine {
    #[command(subcommand)]
    command: Chosen,
}

#[derive(Debug, Subcommand)]
enum Chosen {
    Map(MapArgs),
    Quad(QuadArgs),
    Integer(IntegerArgs),
    Check(CheckArgs),
    Measure(MeasureArgs),
    Features(FeaturesArgs),
    Extract(ExtractArgs),
    Quality(QualityArgs),
    /// Study and compare: other objectives, starts, solvers and ways of rounding
    ///
    /// `lab map` is `map` with all its options.
    #[command(subcommand)]
    Lab(Lab),
    Completions(CompletionsArgs),
    Man(ManArgs),
    #[command(hide = true)]
    Layout(OptimizeArgs),
    #[command(hide = true)]
    Field(FieldArgs),
    #[command(hide = true)]
    RepairMatchings(MatchingsArgs),
    #[command(hide = true)]
    LayoutQuads(LayoutQuadsArgs),
}

#[derive(Debug, Subcommand)]
enum Lab {
    Map(MapArgs),
    #[command(name = "optimize", alias = "layout")]
    Optimize(OptimizeArgs),
    Field(FieldArgs),
    RepairMatchings(MatchingsArgs),
    LayoutQuads(LayoutQuadsArgs),
}

/// Options that only `lab map` shows.
const RESEARCH: [&str; 18] = [
    "field",
    "matching",
    "cones",
    "from",
    "free_cones",
    "method",
    "exact",
    "local_global",
    "allow_flips",
    "rounding",
    "batch",
    "nodes",
    "rounding_time",
    "corner_weight",
    "no_tau_polish",
    "polish_time",
    "max_energy_rise",
    "objective",
];
/// Options that few users of `map`, `quad` and `integer` need.
const RARE: [&str; 6] = ["cone_price", "scale", "angle", "shift", "period", "features_strict"];

/// Parses the command line, or prints help or what is wrong with it and ends.
pub(crate) fn parse() -> CommandLine {
    let matches = definition().get_matches();
    CommandLine::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
}

/// The command line, with its rarer options hidden.
pub(crate) fn definition() -> clap::Command {
    let hide = |command: clap::Command, names: &'static [&'static str]| {
        command.mut_args(move |arg| {
            let is_hidden = names.contains(&arg.get_id().as_str());
            if is_hidden { arg.hide(true) } else { arg }
        })
    };
    let mut command = CommandLine::command();
    for name in ["map", "quad", "integer"] {
        command = command.mut_subcommand(name, |c| hide(hide(c, &RESEARCH), &RARE));
    }
    command
}

impl CommandLine {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<Status, Failure> {
        match &self.command {
            Chosen::Map(args) | Chosen::Lab(Lab::Map(args)) => command::run(args),
            Chosen::Quad(args) => command::run(args),
            Chosen::Integer(args) => command::run(args),
            Chosen::Check(args) => command::run(args),
            Chosen::Measure(args) => command::run(args),
            Chosen::Features(args) => command::run(args),
            Chosen::Extract(args) => command::run(args),
            Chosen::Quality(args) => command::run(args),
            Chosen::Layout(args) | Chosen::Lab(Lab::Optimize(args)) => command::run(args),
            Chosen::Field(args) | Chosen::Lab(Lab::Field(args)) => command::run(args),
            Chosen::RepairMatchings(args) | Chosen::Lab(Lab::RepairMatchings(args)) => {
                command::run(args)
            }
            Chosen::Completions(args) => args.run(),
            Chosen::Man(args) => args.run(),
            Chosen::LayoutQuads(args) | Chosen::Lab(Lab::LayoutQuads(args)) => command::run(args),
        }
    }
}

/// The help's end: examples and exit codes.
pub(crate) fn after_help(examples: &str) -> String {
    format!("{examples}\n\n{EXIT_CODES}")
}

/// What every command that may take long has.
#[derive(Debug, Clone, Copy, Default, Args)]
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

impl RunArgs {
    /// Those of a command that takes no time.
    pub(crate) fn quick(json: bool) -> Self {
        Self { json, ..Self::default() }
    }
}

/// Edges that a map should follow.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct FeatureArgs {
    /// Feature edges, from one of these sources; may be given several times
    ///
    /// angle:DEGREES  where the surface bends by that much or more
    /// boundary       the boundary
    /// lines          the `l` elements of the mesh, an OBJ file
    /// edges:A-B,...  edges by their vertices, counted from 0
    /// pairs:FILE     two vertices a line, counted from 0; # starts a comment
    /// sharp:FILE     a .sharp file of QuadWild: the count, then `type,face,side` a line
    ///
    /// Vertices and faces are those of the file, also with `--repair`.
    #[arg(long, value_name = "SOURCE", verbatim_doc_comment)]
    features: Vec<FeatureSource>,

    /// The boundary as well, as with `--features boundary`
    #[arg(long)]
    align_boundary: bool,
}

impl FeatureArgs {
    /// All sources.
    pub(crate) fn features(&self) -> Features {
        let sources = self.features.iter().cloned();
        let boundary = self.align_boundary.then_some(FeatureSource::Boundary);
        sources.chain(boundary).fold(Features::none(), Features::and)
    }

    /// The files that features are read from.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        self.features.iter().filter_map(FeatureSource::file)
    }
}

/// How fine a grid is to be.
#[derive(Debug, Clone, Copy, Args)]
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
        given.or(self.scale.map(GridSize::Scale)).unwrap_or_default()
    }
}

pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("expected a number, 0 or larger".into()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match not_negative(text) {
        Ok(x) if x > 0.0 => Ok(x),
        _ => Err("expected a number larger than 0".into()),
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

    #[test]
    fn the_command_line_is_consistent() {
        definition().debug_assert();
    }

    #[test]
    fn everyday_commands_show_few_options() {
        for name in ["map", "quad", "integer", "check", "measure", "features", "extract", "quality"]
        {
            let command = definition();
            let command = command.find_subcommand(name).unwrap();
            let shown = command.get_arguments().filter(|arg| !arg.is_hide_set()).count();
            assert!(shown <= 17, "{name} shows {shown} options");
        }
    }

    #[test]
    fn seconds_are_positive_and_finite() {
        assert_eq!(seconds("0.25"), Ok(Duration::from_millis(250)));
        for text in ["0", "-1", "nan", "inf", "1e300", "soon", ""] {
            assert!(seconds(text).is_err(), "{text}");
        }
    }
}
