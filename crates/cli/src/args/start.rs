//! What a map starts from.

use std::path::PathBuf;

/// Arguments that choose what `map` starts from.
#[derive(Debug, Clone, clap::Args)]
#[command(next_help_heading = "Start from")]
pub(crate) struct StartArgs {
    /// Start from this cross field, a .rawfield, or a .rosy with a vector per face: the map has its cones
    /// and follows it around handles
    #[arg(long, value_name = "FIELD", conflicts_with_all = ["cones", "method", "features", "align_boundary"])]
    pub(crate) field: Option<PathBuf>,

    /// Start from these matchings modulo 4, with the frames of `--field`, or without it with the
    /// smoothest frames
    #[arg(long, value_name = "FILE.matching", conflicts_with_all = ["cones", "method", "features", "align_boundary"])]
    pub(crate) matching: Option<PathBuf>,

    /// Make exactly these cones: a .sing file, or a file with the total angle of every vertex in radians
    /// (those of the boundary are free)
    #[arg(long, value_name = "FILE", conflicts_with_all = ["method", "features", "align_boundary"])]
    pub(crate) cones: Option<PathBuf>,

    /// Start from a map with foldovers: its cones and matchings, or consistent ones near them
    #[arg(
        long,
        value_name = "MAP.obj",
        conflicts_with_all = ["field", "matching", "cones", "method"]
    )]
    pub(crate) from: Option<PathBuf>,

    /// Let vertices that the .sing file does not list become cones; an index of 0 keeps one from it
    #[arg(long, requires = "cones")]
    pub(crate) free_cones: bool,

    /// How the matchings are chosen
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Method::Direct)]
    pub(crate) method: Method,

    /// Lay the field of `--method field` out exactly, with every safeguard against flips
    #[arg(long, requires = "method")]
    pub(crate) exact: bool,

    /// Local/global iterations after the Poisson layout of `--method field`
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        requires = "method",
        conflicts_with = "exact"
    )]
    pub(crate) local_global: usize,

    /// Write the map of `--method field` even if triangles are flipped; it is not certified then
    #[arg(long, requires = "method", conflicts_with_all = ["exact", "pictures", "sing"])]
    pub(crate) allow_flips: bool,
}

/// How the matchings are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Method {
    /// Rounding between layouts, without a field
    Direct,
    /// A smooth cross field by mixed-integer rounding, then its Poisson layout: the classical way, as a
    /// baseline; triangles may flip
    Field,
}

impl StartArgs {
    /// Whether the map is the Poisson layout of a smooth field.
    pub(crate) fn is_baseline(&self) -> bool {
        self.method == Method::Field && !self.exact
    }
}
