//! `seamstress lab layout-quads`.

use super::{draw_map, inputs, map_pictures, targets};
use crate::args::{RunArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan, Target};
use crate::summary;
use crate::text::{counted, row};
use seamstress::lab::{QuadLayout, QuadLayoutMethod};
use seamstress::{Error, PolygonMesh, TextureOptions, UvSet};
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress lab layout-quads quads.obj -o map.obj
  seamstress lab layout-quads quads.obj -o map.obj --pictures pictures --texture-angle 22
  seamstress lab layout-quads quads.obj -o map.obj --method conformal";

/// Lay out a quad mesh: every quad a unit square of an integer-grid map
///
/// The mesh may come from any program; it has to be an oriented manifold of quads. Every quad is split into two
/// triangles; irregular vertices are the cones.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct LayoutQuadsArgs {
    /// The quad mesh: OBJ, OFF or PLY
    quads: PathBuf,

    /// Write the map to this OBJ file, replacing an existing one
    #[arg(short, long, value_name = "MAP.obj")]
    output: PathBuf,

    /// How the coordinates are found
    #[arg(long, value_enum, value_name = "HOW", default_value_t = QuadLayoutMethod::Squares)]
    method: QuadLayoutMethod,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR", group = "drawn")]
    pictures: Option<PathBuf>,

    /// Print the report as JSON on standard output instead of the summary
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    texture: TextureOptions,
}

impl Command for LayoutQuadsArgs {
    const NAME: &'static str = "layout-quads";
    type Product = QuadLayout;

    fn run_args(&self) -> RunArgs {
        RunArgs::quick(self.json)
    }

    fn input(&self) -> &Path {
        &self.quads
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let mut files = map_pictures(self.pictures.as_ref());
        files.extend(targets(Kind::Map, [&self.output]));
        Plan::new(&inputs(&self.quads, None), self.pictures.as_deref(), files)
    }

    fn make(&self, _: &Session) -> Result<QuadLayout, Failure> {
        Ok(PolygonMesh::read(&self.quads)?.lay_out(self.method)?)
    }

    fn pictures(&self, layout: &QuadLayout) -> Result<Vec<Vec<u8>>, Error> {
        draw_map(self.pictures.as_ref(), || layout.pictures(&self.texture))
    }

    fn write(
        &self,
        layout: &QuadLayout,
        target: &Target,
        mut file: &mut dyn Write,
    ) -> io::Result<()> {
        layout.write_as(&target.path, UvSet::First, &mut file)
    }

    fn report(&self, layout: &QuadLayout) -> Value {
        to_json(layout.report())
    }

    fn summary(&self, layout: &QuadLayout) -> Vec<String> {
        let report = layout.report();
        let input = &report.input;
        let counts = [counted(input.vertices, "vertex"), counted(input.quads, "quad")];
        let accuracy = match report.integer_error {
            0.0 => "all coordinates are integers".into(),
            error => format!("coordinates within {error:.1e} of integers"),
        };
        let name = input.file.clone().unwrap_or_default();
        let mut rows = vec![
            row("quad mesh", &name),
            row("size", &counts.join(", ")),
            row("layout", &accuracy),
        ];
        rows.extend(summary::distortion_rows(&report.distortion));
        rows.extend(summary::certificate_rows(&report.cones, &report.certificate));
        rows
    }
}
