//! `seamstress quality`.

use super::{inputs, measure_named, targets};
use crate::args::{RunArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan};
use crate::summary;
use clap::builder::PossibleValuesParser;
use seamstress::{
    Error, Inspection, Measure, PolygonMesh, QuadMetric, QualityReport, SurfaceOptions, ViewOptions,
};
use serde_json::Value;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress quality quads.obj
  seamstress quality quads.obj --source bunny.ply
  seamstress quality quads.obj --picture angles.png
  seamstress quality quads.obj --picture tau.png --of tau
  seamstress quality quads.obj --json | jq .angles";

/// The metric of angles, beside the measures of distortion.
const ANGLE: &str = "angle";

fn metric_names() -> PossibleValuesParser {
    let measures = Measure::ALL.into_iter().map(Measure::name);
    PossibleValuesParser::new(std::iter::once(ANGLE).chain(measures))
}

/// Measure a quad mesh
///
/// Polygons, irregular vertices, angles, edge lengths, the distortion of the layout in which every quad is a
/// unit square, and with a source the distances between the two surfaces. The mesh may come from any program;
/// meshes with other polygons are measured where metrics are defined.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct QualityArgs {
    /// The quad mesh: OBJ, OFF or PLY
    quads: PathBuf,

    /// The surface it was made from, to measure the distances to: OBJ, OFF, PLY, STL or glTF
    #[arg(long, value_name = "MESH")]
    source: Option<PathBuf>,

    /// Draw the mesh from both sides, with its irregular vertices, in the colours of a metric
    #[arg(long, value_name = "FILE.png", group = "drawn")]
    picture: Option<PathBuf>,

    /// The metric that is painted: the largest deviation of an angle, or a distortion of the layout
    #[arg(long, value_name = "METRIC", value_parser = metric_names(), default_value = ANGLE, requires = "picture")]
    of: String,

    /// Points sampled on each surface, about
    #[arg(
        long,
        value_name = "N",
        default_value_t = 100_000,
        value_parser = clap::value_parser!(u32).range(1..=100_000_000),
        requires = "source"
    )]
    samples: u32,

    /// Print the report as JSON on standard output instead of the table
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    view: ViewOptions,
}

impl QualityArgs {
    fn metric(&self) -> QuadMetric {
        match self.of.as_str() {
            ANGLE => QuadMetric::Angle,
            name => QuadMetric::Measure(measure_named(name)),
        }
    }
}

impl Command for QualityArgs {
    const NAME: &'static str = "quality";
    type Product = (PolygonMesh, QualityReport);

    fn run_args(&self) -> RunArgs {
        RunArgs::quick(self.json)
    }

    fn input(&self) -> &Path {
        &self.quads
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let files = targets(Kind::Picture, &self.picture);
        Plan::new(&inputs(&self.quads, self.source.as_deref()), None, files)
    }

    fn make(&self, _: &Session) -> Result<Self::Product, Failure> {
        let mesh = PolygonMesh::read(&self.quads)?;
        let read = |path: &PathBuf| Inspection::read(path, &SurfaceOptions::default());
        let source = self.source.as_ref().map(read).transpose()?;
        let report = mesh.quality(source.as_ref().map(|source| (source, self.samples)))?;
        Ok((mesh, report))
    }

    fn pictures(&self, (mesh, report): &Self::Product) -> Result<Vec<Vec<u8>>, Error> {
        self.picture.iter().map(|_| mesh.picture(report, self.metric(), &self.view)).collect()
    }

    fn report(&self, (_, report): &Self::Product) -> Value {
        to_json(report)
    }

    fn summary(&self, (_, report): &Self::Product) -> Vec<String> {
        let mut rows = summary::quality_rows(report);
        if !report.measures.is_empty() {
            rows.push(String::new());
            rows.extend(summary::measure_table(&report.measures, |_| false));
        }
        rows
    }
}
