//! Arguments of `repair-matchings`.

use super::{EXIT_CODES, RunArgs};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  seamstress repair-matchings bunny.ply --from broken.obj -o bunny.matching
  seamstress repair-matchings bunny.ply --field bunny.rawfield -o bunny.matching --sing bunny.sing
  seamstress map bunny.ply --matching bunny.matching -o bunny.obj";

/// Make the matchings of a field or of a broken map consistent
///
/// Finds the matchings nearest to those given that triangles can have: positive angles that sum to half
/// a turn in every triangle and to the angle of its index around every vertex, and indices that sum to
/// four times the Euler characteristic. Exits with 3 if none are found.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct RepairMatchingsArgs {
    /// The mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// Take angles and matchings from this map, which may have foldovers
    #[arg(
        long,
        value_name = "MAP.obj",
        required_unless_present_any = ["field", "matching"],
        conflicts_with_all = ["field", "matching"]
    )]
    pub(crate) from: Option<PathBuf>,

    /// Take the matchings of this cross field, and the angles of the surface
    #[arg(long, value_name = "FIELD")]
    pub(crate) field: Option<PathBuf>,

    /// Take these matchings modulo 4, with the frames of `--field` or the smoothest ones
    #[arg(long, value_name = "FILE.matching")]
    pub(crate) matching: Option<PathBuf>,

    /// How the distance to the angles is measured [default: l1 for a map, l2 for a field]
    #[arg(long, value_enum)]
    pub(crate) norm: Option<Norm>,

    /// Write the matchings modulo 4 to this file
    #[arg(short, long, value_name = "FILE.matching")]
    pub(crate) output: PathBuf,

    /// Write the cones to this file: vertex (counted from 0) and index in quarters of a turn
    #[arg(long, value_name = "FILE.sing")]
    pub(crate) sing: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long)]
    pub(crate) repair: bool,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// Names of the norms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Norm {
    /// Sum of absolute values: concentrates the change
    L1,
    /// Sum of squares: spreads the change
    L2,
}
