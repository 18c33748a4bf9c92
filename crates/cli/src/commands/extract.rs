//! `seamstress extract`.

use super::quad_files::{self, QuadFiles};
use crate::args::{RunArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Plan, Target};
use crate::summary;
use seamstress::command_reports::ExtractReport;
use seamstress::{
    Error, ExtractionOptions, FeatureSource, Features, MapFile, Page, QuadMesh, ViewOptions,
};
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress extract grid.obj -o quads.obj
  seamstress extract grid.obj -o quads.ply --picture quads.png --report quads.json
  seamstress extract grid.obj -o quads.obj --smooth 10
  seamstress extract grid.obj -o quads.obj --features angle:40
  seamstress extract other_program.obj -o quads.obj --best-effort";

/// Extract the quad mesh of an integer-grid map
///
/// Every unit square of the map becomes a quad. The map may come from any program: an OBJ file with
/// positions, triangles and texture coordinates in grid units. Small inexactness is removed and reported.
/// Badly shaped quads are untangled along the surface. Cells that a boundary cuts are left out.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct ExtractArgs {
    /// The integer-grid map: an OBJ file with positions, triangles and a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    map: PathBuf,

    #[command(flatten)]
    files: QuadFiles,

    #[command(flatten)]
    options: ExtractionOptions,

    /// Keep vertices on these feature edges; may be given several times
    ///
    /// They are those that the map aligns, from the sources of `quad`: angle:DEGREES, boundary, lines,
    /// edges:A-B,..., pairs:FILE or sharp:FILE. A quad vertex that the map places on such an edge only slides
    /// along it during untangling and smoothing. Those that the quads do not follow are reported as dropped.
    #[arg(long, value_name = "SOURCE")]
    features: Vec<FeatureSource>,

    #[command(flatten)]
    run: RunArgs,

    #[command(flatten)]
    view: ViewOptions,
}

impl Command for ExtractArgs {
    const NAME: &'static str = "extract";
    type Product = QuadMesh;

    fn run_args(&self) -> RunArgs {
        self.run
    }

    fn input(&self) -> &Path {
        &self.map
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let others = self.features.iter().filter_map(FeatureSource::file);
        self.files.plan(&self.map, others, self.options.shape)
    }

    fn make(&self, session: &Session) -> Result<QuadMesh, Failure> {
        let map = MapFile::read(&self.map)?;
        let inspection = map.inspect();
        session.report_findings(&inspection);
        let surface = session.surface(inspection)?;
        let features = self.features.iter().cloned().fold(Features::none(), Features::and);
        let quads = surface.extract_quads(map.uvs(), map.face_uvs(), &features, &self.options)?;
        summary::quad_warnings(quads.report()).iter().for_each(|line| session.report(line));
        Ok(quads)
    }

    fn pictures(&self, quads: &QuadMesh) -> Result<Vec<Vec<u8>>, Error> {
        self.files.pictures(quads, &self.view)
    }

    fn page(&self, quads: &QuadMesh) -> Option<Page> {
        Some(quads.page())
    }

    fn write(&self, quads: &QuadMesh, target: &Target, file: &mut dyn Write) -> io::Result<()> {
        quad_files::write(quads, target, file)
    }

    fn report(&self, quads: &QuadMesh) -> Value {
        to_json(&ExtractReport::new(quads.report(), self.options, &self.features))
    }

    fn summary(&self, quads: &QuadMesh) -> Vec<String> {
        let report = quads.report();
        let mut rows = summary::surface_rows(&report.input);
        rows.extend(report.features.iter().flat_map(summary::feature_rows));
        rows.extend(report.features.iter().flat_map(summary::aligned_rows));
        rows.extend(summary::quad_rows(report));
        rows
    }

    fn stages(&self, _: &QuadMesh) -> Option<Vec<(&'static str, f64)>> {
        Some(Vec::new())
    }
}
