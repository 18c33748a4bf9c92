//! `seamstress features`.

use super::{inputs, targets};
use crate::args::{FeatureArgs, RunArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan};
use crate::summary;
use seamstress::command_reports::FoundFeaturesReport;
use seamstress::{Error, FeatureCurves, Features, Surface, SurfaceOptions, ViewOptions};
use serde_json::Value;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress features part.obj
  seamstress features part.obj --features angle:30 --align-boundary --picture part.png
  seamstress features part.obj --features sharp:part.sharp --json | jq .features.curves";

/// Show the features of a mesh: the creases, rims and marked edges that a map should follow
///
/// Lists their curves, loops, corners and open ends, and draws them: corners are dark dots, open ends
/// orange ones. Without a source these are those of `auto`.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct FeaturesArgs {
    /// The mesh: OBJ, OFF, PLY, STL or glTF
    mesh: PathBuf,

    #[command(flatten)]
    features: FeatureArgs,

    /// Draw the mesh with its features to this PNG file
    #[arg(long, value_name = "FILE.png", group = "drawn")]
    picture: Option<PathBuf>,

    #[command(flatten)]
    surface: SurfaceOptions,

    /// Print everything as JSON on standard output
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    view: ViewOptions,
}

impl Command for FeaturesArgs {
    const NAME: &'static str = "features";
    type Product = (Surface, FeatureCurves);

    fn run_args(&self) -> RunArgs {
        RunArgs::quick(self.json)
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let files = targets(Kind::Picture, &self.picture);
        Plan::new(&inputs(&self.mesh, self.features.files()), None, files)
    }

    fn make(&self, session: &Session) -> Result<Self::Product, Failure> {
        let surface = session.open(&self.mesh, &self.surface)?;
        let asked = self.features.or(Features::auto());
        let curves = surface.features(&asked)?;
        Ok((surface, curves))
    }

    fn pictures(&self, (surface, curves): &Self::Product) -> Result<Vec<Vec<u8>>, Error> {
        self.picture.iter().map(|_| surface.picture(Some(curves), &self.view)).collect()
    }

    fn report(&self, (surface, curves): &Self::Product) -> Value {
        to_json(&FoundFeaturesReport::new(surface.report(), curves.report()))
    }

    fn summary(&self, (surface, curves): &Self::Product) -> Vec<String> {
        let mut rows = summary::surface_rows(surface.report());
        rows.extend(summary::feature_rows(curves.report()));
        rows
    }
}
