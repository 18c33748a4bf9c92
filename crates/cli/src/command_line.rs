//! The command line: which commands there are.

use crate::args::EXIT_CODES;
use crate::command;
#[cfg(feature = "app")]
use crate::commands::AppArgs;
use crate::commands::{
    CheckArgs, CompletionsArgs, ExtractArgs, FeaturesArgs, FieldArgs, IntegerArgs, LayoutQuadsArgs,
    ManArgs, MapArgs, MatchingsArgs, MeasureArgs, OptimizeArgs, QuadArgs, QualityArgs, ReportArgs,
};
use crate::failure::{Failure, Status};
use clap::{CommandFactory, Parser, Subcommand};

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
  seamstress extract grid.obj -o quads.obj
  seamstress quad bunny.ply --quads 5000 -o quads.obj --report quads.html";

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
    Map(Box<MapArgs>),
    Quad(QuadArgs),
    Integer(IntegerArgs),
    Check(CheckArgs),
    Measure(MeasureArgs),
    Features(FeaturesArgs),
    Extract(ExtractArgs),
    Quality(QualityArgs),
    Report(ReportArgs),
    #[cfg(feature = "app")]
    App(AppArgs),
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
    Map(Box<MapArgs>),
    #[command(name = "optimize", alias = "layout")]
    Optimize(OptimizeArgs),
    Field(FieldArgs),
    RepairMatchings(MatchingsArgs),
    LayoutQuads(LayoutQuadsArgs),
}

/// What people use every day.
const EVERYDAY: [&str; 9] =
    ["map", "quad", "integer", "check", "measure", "features", "extract", "quality", "report"];
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
/// Options of everyday commands that few people need: `-h` leaves them out, `--help` and the manual have them.
const RARE: [&str; 25] = [
    "uv_set",
    "raw",
    "source_points",
    "corner_angle",
    "directions",
    "sizes",
    "partial",
    "min_edge",
    "max_edge",
    "size_growth",
    "pack_margin",
    "cone_bias",
    "cone_price",
    "angle",
    "shift",
    "period",
    "format",
    "scale",
    "align_boundary",
    "features_strict",
    "fast",
    "small_parts",
    "view",
    "up",
    "threads",
];
/// The heading above them.
const RARE_HEADING: &str = "Options that few people need";

/// The command line: everyday commands show what is needed every day.
pub(crate) fn definition() -> clap::Command {
    let put_away = |arg: clap::Arg| match arg.get_id().as_str() {
        name if RESEARCH.contains(&name) => arg.hide(true),
        name if RARE.contains(&name) => arg.hide_short_help(true).help_heading(RARE_HEADING),
        _ => arg,
    };
    let all = EVERYDAY.into_iter().fold(CommandLine::command(), |all, name| {
        all.mut_subcommand(name, |command| command.mut_args(put_away))
    });
    // Integer-grid maps cannot be made symmetric; quads can. Neither are packed.
    let refused =
        [("integer", &["symmetry", "pack", "pack_margin"][..]), ("quad", &["pack", "pack_margin"])];
    refused.into_iter().fold(all, |all, (name, options)| {
        let hide = |command: clap::Command, option| command.mut_arg(option, |arg| arg.hide(true));
        all.mut_subcommand(name, |command| options.iter().fold(command, hide))
    })
}

impl CommandLine {
    /// Runs the command.
    pub(crate) fn run(&self) -> Result<Status, Failure> {
        match &self.command {
            Chosen::Map(args) | Chosen::Lab(Lab::Map(args)) => command::run(args.as_ref()),
            Chosen::Quad(args) => command::run(args),
            Chosen::Integer(args) => command::run(args),
            Chosen::Check(args) => command::run(args),
            Chosen::Measure(args) => command::run(args),
            Chosen::Features(args) => command::run(args),
            Chosen::Extract(args) => command::run(args),
            Chosen::Quality(args) => command::run(args),
            Chosen::Report(args) => command::run(args),
            #[cfg(feature = "app")]
            Chosen::App(args) => args.run(),
            Chosen::Layout(args) | Chosen::Lab(Lab::Optimize(args)) => command::run(args),
            Chosen::Field(args) | Chosen::Lab(Lab::Field(args)) => command::run(args),
            Chosen::RepairMatchings(args) | Chosen::Lab(Lab::RepairMatchings(args)) => {
                command::run(args)
            }
            Chosen::Completions(args) => args.run(definition()),
            Chosen::Man(args) => args.run(definition()),
            Chosen::LayoutQuads(args) | Chosen::Lab(Lab::LayoutQuads(args)) => command::run(args),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_that_messages_name_are_in_some_help() {
        let command = definition();
        let lab = command.find_subcommand("lab").unwrap();
        let shown: Vec<String> = command
            .get_subcommands()
            .chain(lab.get_subcommands())
            .flat_map(clap::Command::get_arguments)
            .filter(|arg| !arg.is_hide_set())
            .map(|arg| arg.get_id().to_string())
            .collect();
        for name in crate::text::OPTIONS {
            assert!(shown.iter().any(|id| id == name), "{name}");
        }
    }
}
