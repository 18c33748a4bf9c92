//! Arguments of `map`.

use super::{
    ConeArgs, EXIT_CODES, FeatureArgs, RunArgs, StartArgs, TextureArgs, not_negative, objective,
    seconds,
};
use clap::value_parser;
use seamstress_parametrize::mixed_integer::MixedIntegerOptions;
use seamstress_parametrize::rounding::{RoundingOptions, RoundingStrategy};
use seamstress_parametrize::{MapOptions, Objective, PolishOptions};
use std::path::PathBuf;
use std::time::Duration;

const MAP_EXAMPLES: &str = "\
Examples:
  seamstress map bunny.ply -o bunny.obj
  seamstress map bunny.ply -o bunny.obj --report bunny.json --pictures bunny
  seamstress map scan.stl -o scan.obj --repair --time-limit 60
  seamstress map part.obj -o part_map.obj --features angle:40 --align-boundary
  seamstress map part.off -o part.obj --json | jq .distortion.tau
  seamstress map eight.off -o eight.obj --field eight.rawfield
  seamstress map eight.off -o eight.obj --cones eight.sing --free-cones
  seamstress map eight.off -o eight.obj --method field --allow-flips
  seamstress map block.off -o block.obj --rounding mixed-integer --batch 800";

/// Make a seamless map of a mesh
///
/// Reads a mesh, computes a seamless map of low distortion, certifies it and writes it as an OBJ file
/// with a texture coordinate per corner. Vertices and faces stay as they are and in their order;
/// polygons are split into triangles, and the corners of an STL file are welded where they coincide.
/// Files appear only when everything has succeeded.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{MAP_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct MapArgs {
    /// The mesh to map: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// Write the map to this OBJ file, replacing an existing one
    #[arg(short, long, value_name = "MAP.obj")]
    pub(crate) output: PathBuf,

    /// Write all figures of the run to this JSON file
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,

    /// Write the cones to this file: vertex (counted from 0) and index in quarters of a turn
    #[arg(long, value_name = "FILE.sing")]
    pub(crate) sing: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) start: StartArgs,

    /// Repair what can be repaired without moving a vertex, and map the repaired mesh
    ///
    /// Drops degenerate and repeated faces and unused vertices, turns faces over that disagree with
    /// their neighbours, and splits vertices where surfaces only touch. Every repair is listed.
    #[arg(long)]
    pub(crate) repair: bool,

    #[command(flatten)]
    pub(crate) method: ConeArgs,

    #[command(flatten)]
    pub(crate) features: FeatureArgs,

    /// Fail with exit code 3 if a feature cannot be aligned, instead of releasing and reporting it
    #[arg(long)]
    pub(crate) features_strict: bool,

    /// How much corners between features keep to their own angle: larger values give fewer false
    /// corners and more distortion
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        default_value_t = RoundingOptions::default().corner_weight
    )]
    pub(crate) corner_weight: f64,

    /// How the rounding of a seam is judged: by its angle and the cones it makes, or by its effect
    /// estimated on a small patch as well
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Rounding::ConeBias)]
    pub(crate) rounding: Rounding,

    /// Matchings that are integer variables at a time, with `--rounding mixed-integer`
    #[arg(
        long,
        value_name = "B",
        value_parser = value_parser!(u32).range(1..),
        default_value_t = MixedIntegerOptions::default().batch as u32
    )]
    pub(crate) batch: u32,

    /// Programs solved for a batch at most, with `--rounding mixed-integer`
    #[arg(
        long,
        value_name = "N",
        value_parser = value_parser!(u32).range(1..),
        default_value_t = MixedIntegerOptions::default().nodes as u32
    )]
    pub(crate) nodes: u32,

    /// Stop `--rounding mixed-integer` after this many seconds and round what is left to the nearest
    /// integers; the map then depends on the machine [default: no limit]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) rounding_time: Option<Duration>,

    /// Leave out the finish that lowers the largest distortion (tau)
    #[arg(long, conflicts_with_all = ["polish_time", "max_energy_rise"])]
    pub(crate) no_tau_polish: bool,

    /// Stop that finish after this many seconds; the map then depends on the machine [default: no
    /// limit]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) polish_time: Option<Duration>,

    /// By how much of itself that finish may raise the mean symmetric Dirichlet energy
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        default_value_t = PolishOptions::default().max_energy_rise
    )]
    pub(crate) max_energy_rise: f64,

    /// Minimise this in the end, instead of the compromise of mean and worst distortion
    #[arg(long, value_name = "NAME", value_parser = objective())]
    pub(crate) objective: Option<Objective>,

    #[command(flatten)]
    pub(crate) texture: TextureArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// Names of the rounding strategies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Rounding {
    /// Angle and cones
    ConeBias,
    /// Effect on a small patch, and cones
    LocalEstimation,
    /// Matchings as integer variables of the program of least tau, solved by branch and bound; slow
    MixedInteger,
}

impl MapArgs {
    /// The settings of the method.
    pub(crate) fn options(&self) -> MapOptions {
        let mut options = self.method.options();
        options.rounding.corner_weight = self.corner_weight;
        options.rounding.strategy = match self.rounding {
            Rounding::ConeBias => RoundingStrategy::ConeBias,
            Rounding::LocalEstimation => RoundingStrategy::LocalEstimation,
            Rounding::MixedInteger => RoundingStrategy::MixedInteger,
        };
        options.rounding.mixed_integer = MixedIntegerOptions {
            batch: self.batch as usize,
            nodes: self.nodes as usize,
            time_limit: self.rounding_time,
            ..MixedIntegerOptions::default()
        };
        options.strict_features = self.features_strict;
        options.polish = (!self.no_tau_polish).then_some(PolishOptions {
            max_energy_rise: self.max_energy_rise,
            time_limit: self.polish_time,
        });
        options.objective = self.objective;
        options
    }
}
