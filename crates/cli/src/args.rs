//! The command line.

use clap::{Parser, Subcommand, value_parser};
use seamstress::rounding::{RoundingOptions, RoundingStrategy};
use seamstress::{MapOptions, Tolerance};
use std::path::PathBuf;
use std::time::Duration;

const EXIT_CODES: &str = "\
Exit codes:
  0  done; any map written or checked is certified
  1  the input is at fault: unreadable, not a mesh, or not a seamless map
  2  wrong usage: unknown option, or an output that cannot be written
  3  no certified map could be made; nothing is written
  4  stopped by the time limit or by Ctrl-C; nothing is written";

const EXAMPLES: &str = "\
Examples:
  seamstress map bunny.ply -o bunny.obj
  seamstress map bunny.ply -o bunny.obj --report bunny.json --pictures bunny
  seamstress map scan.stl -o scan.obj --repair --time-limit 60
  seamstress check bunny.ply
  seamstress check bunny.ply bunny.obj";

const MAP_EXAMPLES: &str = "\
Examples:
  seamstress map bunny.ply -o bunny.obj
  seamstress map bunny.ply -o bunny.obj --report bunny.json --pictures bunny
  seamstress map scan.stl -o scan.obj --repair --time-limit 60
  seamstress map part.off -o part.obj --json | jq .distortion.tau";

const CHECK_EXAMPLES: &str = "\
Examples:
  seamstress check bunny.ply
  seamstress check bunny.ply bunny.obj
  seamstress check bunny.ply other_program.obj --tolerance 1e-5
  seamstress check scan.stl --json | jq '.faults[].message'";

/// Makes seamless maps of triangle meshes
///
/// A seamless map flattens a surface into the plane. The surface is cut along seams, and the two
/// sides of every seam fit after a turn by a multiple of 90 degrees and a shift. A square grid drawn
/// in the plane therefore closes up over the whole surface, except at a few points called cones. Quad
/// meshing and seamless textures start from such a map.
///
/// `map` makes a map and certifies it: no triangle is flipped or collapsed, every seam fits, and the
/// angle at every cone is a multiple of 90 degrees. `check` lists what is wrong with a mesh, or
/// certifies the map in a file, whatever program wrote it.
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
    Check(CheckArgs),
}

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
    pub(crate) cones: Option<PathBuf>,

    /// Repair what can be repaired without moving a vertex, and map the repaired mesh
    ///
    /// Drops degenerate and repeated faces and unused vertices, turns faces over that disagree with
    /// their neighbours, and splits vertices where surfaces only touch. Every repair is listed.
    #[arg(long)]
    pub(crate) repair: bool,

    /// How much to avoid cones: 0 gives the lowest distortion, larger values fewer cones
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        default_value_t = RoundingOptions::default().cone_bias
    )]
    pub(crate) cone_bias: f64,

    /// Distortion that may be paid for one cone fewer when cones are cleaned up, as mean symmetric
    /// Dirichlet energy (4 is an isometry); 0 leaves the cones as they were rounded
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        default_value_t = MapOptions::default().cone_price
    )]
    pub(crate) cone_price: f64,

    /// How the rounding of a seam is judged: by its angle and the cones it makes, or by its effect
    /// estimated on a small patch as well
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Rounding::ConeBias)]
    pub(crate) rounding: Rounding,

    /// Give up when the map is not done after this many seconds [default: no limit]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) time_limit: Option<Duration>,

    /// Number of threads; the map does not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1024))]
    pub(crate) threads: Option<u32>,

    /// Print the report as JSON on standard output instead of the summary
    #[arg(long)]
    pub(crate) json: bool,

    /// Print no summary, progress, notes or warnings, only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Names of the rounding strategies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Rounding {
    /// Angle and cones
    ConeBias,
    /// Effect on a small patch, and cones
    LocalEstimation,
}

impl MapArgs {
    /// The settings of the method.
    pub(crate) fn options(&self) -> MapOptions {
        let mut options = MapOptions::default();
        options.rounding.cone_bias = self.cone_bias;
        options.rounding.strategy = match self.rounding {
            Rounding::ConeBias => RoundingStrategy::ConeBias,
            Rounding::LocalEstimation => RoundingStrategy::LocalEstimation,
        };
        options.cone_price = self.cone_price;
        options
    }
}

/// List the faults of a mesh, or certify a map
///
/// With a mesh alone: its size, its topology, and everything that keeps it from being mapped. With a
/// map as well: whether the map has the mesh's vertices and faces and is seamless, and its distortion;
/// or else everything that is wrong with it. Vertices, faces and components are counted from 0.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{CHECK_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct CheckArgs {
    /// The mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// A map of the mesh: an OBJ file with a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    pub(crate) map: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long)]
    pub(crate) repair: bool,

    /// How far the sides of a seam may be apart.
    #[arg(
        long,
        value_name = "X",
        value_parser = not_negative,
        requires = "map",
        help = format!(
            "How far the sides of a seam may be apart, in mean edge lengths of the map; foreign \
             maps of few digits need more [default: {:e}]",
            Tolerance::default().seam
        )
    )]
    pub(crate) tolerance: Option<f64>,

    /// Print everything as JSON on standard output, with all faults
    #[arg(long)]
    pub(crate) json: bool,
}

impl CheckArgs {
    /// How exact a map must be.
    pub(crate) fn tolerance(&self) -> Tolerance {
        let mut tolerance = Tolerance::default();
        if let Some(seam) = self.tolerance {
            tolerance.seam = seam;
        }
        tolerance
    }
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
