//! `seamstress quad`.

use super::quad_files::{self, QuadFiles};
use crate::args::{FeatureArgs, RunArgs, SizeArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::{Failure, Status};
use crate::output::{Plan, Target};
use crate::summary;
use crate::text::row;
use seamstress::{
    Error, Features, MapOptions, Page, PartOptions, QuadMesh, QuadOptions, ShapeOptions,
    SurfaceOptions, ViewOptions,
};
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress quad bunny.ply --quads 5000 -o quads.obj
  seamstress quad bunny.ply --edge-length 0.02 -o quads.ply --picture quads.png
  seamstress quad part.off --quads 3000 -o quads.obj --features angle:20 --features boundary
  seamstress quad scan.stl --quads 800 -o quads.obj --repair --time-limit 60";

/// Make a quad mesh of a triangle mesh
///
/// A seamless map (as by `map`), rounded to an integer-grid map (as by `integer`), whose grid is extracted
/// (as by `extract`): quads only, an oriented manifold, its irregular vertices the cones of the map.
/// The quads follow the boundary and the creases, as far as `--features` does not say otherwise; cells that a
/// boundary cuts which they do not follow are left out.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct QuadArgs {
    /// The mesh: OBJ, OFF, PLY, STL or glTF, also compressed with gzip; `-` is standard input
    mesh: PathBuf,

    #[command(flatten)]
    files: QuadFiles,

    #[command(flatten)]
    size: SizeArgs,

    #[command(flatten)]
    shape: ShapeOptions,

    #[command(flatten)]
    parts: PartOptions,

    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    features: FeatureArgs,

    #[command(flatten)]
    map: MapOptions,

    #[command(flatten)]
    run: RunArgs,

    #[command(flatten)]
    view: ViewOptions,
}

impl QuadArgs {
    fn options(&self) -> QuadOptions {
        let mut options = QuadOptions::default();
        (options.size, options.shape) = (self.size.grid(), self.shape);
        (options.parts, options.map) = (self.parts, self.map.clone());
        options.features(self.features.or(Features::default()))
    }
}

impl Command for QuadArgs {
    const NAME: &'static str = "quad";
    type Product = QuadMesh;

    fn run_args(&self) -> RunArgs {
        self.run
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        self.files.plan(&self.mesh, self.options().map.files(), self.shape)
    }

    fn make(&self, session: &Session) -> Result<QuadMesh, Failure> {
        let surface = session.open(&self.mesh, &self.surface)?;
        let quads = surface.quad_mesh(&self.options())?;
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
        to_json(quads.report())
    }

    fn summary(&self, quads: &QuadMesh) -> Vec<String> {
        let report = quads.report();
        let mut rows = summary::surface_rows(&report.input);
        rows.extend(report.parts.iter().flat_map(summary::part_rows));
        rows.extend(report.symmetry.iter().flat_map(summary::symmetry_rows));
        rows.extend(report.features.iter().flat_map(summary::feature_rows));
        rows.extend(report.grid.iter().map(|grid| row("grid", &grid.to_string())));
        if report.features.is_some() {
            rows.extend(report.integer_certificate.iter().map(summary::integers_row));
        }
        rows.extend(report.features.iter().flat_map(summary::aligned_rows));
        rows.extend(report.distortion.iter().flat_map(summary::distortion_rows));
        rows.extend(report.sizes.iter().flat_map(summary::cell_size_rows));
        rows.extend(summary::quad_rows(report));
        rows
    }

    fn status(&self, quads: &QuadMesh) -> Status {
        Status::of_parts(quads.report().parts.as_ref())
    }

    fn stages(&self, _: &QuadMesh) -> Option<Vec<(&'static str, f64)>> {
        Some(Vec::new())
    }
}
