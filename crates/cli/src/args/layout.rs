//! Arguments of `layout`.

use super::{EXIT_CODES, FeatureArgs, RunArgs, TextureArgs, not_negative, objective, tolerance};
use seamstress_parametrize::{Objective, RelayoutOptions, Solver};
use std::path::PathBuf;

const LAYOUT_EXAMPLES: &str = "\
Examples:
  seamstress layout bunny.ply bunny.obj --objective arap -o rigid.obj
  seamstress layout bunny.ply bunny.obj --objective asap -o conformal.obj --pictures conformal
  seamstress layout mask.obj --objective symmetric-dirichlet -o flat.obj
  seamstress layout bunny.ply bunny.obj --objective arap --anisotropy stretch.txt -o long.obj
  seamstress layout part.obj part_map.obj --features angle:40 --objective tau -o even.obj";

/// Lay a map out anew, for the distortion you choose
///
/// Starts from a seamless map and minimises an objective over all maps with its matchings and cones; the
/// seams may come to lie elsewhere. Without a map, a mesh that is a disk is laid out with a free boundary
/// and no seam. The result is certified, has no flips, and is never worse than the start. Features that the
/// map follows stay exactly on its axes; those that it does not follow are reported as released.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = format!("{LAYOUT_EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct LayoutArgs {
    /// The mesh: OBJ, OFF, PLY or STL
    pub(crate) mesh: PathBuf,

    /// A seamless map of the mesh; may be left out if the mesh is a disk
    #[arg(value_name = "MAP.obj")]
    pub(crate) map: Option<PathBuf>,

    /// Write the new map to this OBJ file, replacing an existing one
    #[arg(short, long, value_name = "NEW.obj")]
    pub(crate) output: PathBuf,

    /// What to minimise
    #[arg(long, value_name = "NAME", value_parser = objective())]
    pub(crate) objective: Objective,

    /// Solver of the conic programs of `arap-max`, `tau`, `asap-max` and `dilatation`; where our own
    /// fails, Clarabel takes over
    #[arg(long, value_enum, value_name = "NAME", default_value_t = SolverName::Own)]
    pub(crate) solver: SolverName,

    /// Stretches that count as no distortion: a text file with five numbers per triangle, a direction in
    /// space and the stretch wanted along and across it
    #[arg(long, value_name = "FILE")]
    pub(crate) anisotropy: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) features: FeatureArgs,

    /// Fail with exit code 3 if the map does not follow a feature, instead of reporting it
    #[arg(long)]
    pub(crate) features_strict: bool,

    /// Write all figures of the run to this JSON file
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long)]
    pub(crate) repair: bool,

    /// How far the sides of a seam of the map may be apart, in mean edge lengths [default: 1e-9]
    #[arg(long, value_name = "X", value_parser = not_negative, requires = "map")]
    pub(crate) tolerance: Option<f64>,

    #[command(flatten)]
    pub(crate) texture: TextureArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// Names of the conic solvers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum SolverName {
    /// Our own
    Own,
    /// Clarabel
    Clarabel,
}

impl LayoutArgs {
    /// The settings without the stretches and the features, which files tell.
    pub(crate) fn options(&self) -> RelayoutOptions {
        let mut options = RelayoutOptions::new(self.objective);
        options.tolerance = tolerance(self.tolerance);
        options.strict_features = self.features_strict;
        options.settings.conic.solver = match self.solver {
            SolverName::Own => Solver::Own,
            SolverName::Clarabel => Solver::Clarabel,
        };
        options
    }
}
