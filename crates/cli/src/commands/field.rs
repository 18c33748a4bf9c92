//! `seamstress lab field`.

use super::{inputs, targets};
use crate::args::{RunArgs, after_help, not_negative};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan, Target};
use crate::summary;
use crate::text::{counted, row};
use seamstress::{
    CertifyOptions, CrossField, MapFile, PolygonMesh, SurfaceOptions, write_cones, write_matchings,
};
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress lab field bunny.ply bunny.obj -o bunny.rawfield
  seamstress lab field bunny.ply bunny.obj -o bunny.rosy --sing bunny.sing --matching bunny.matching
  seamstress lab field quads.obj -o quads.rawfield --sing quads.sing";

/// Read the cross field off a seamless map, or off a quad mesh
///
/// The directions of the map's axes on every face, the matchings between them, their cones, and the indices of
/// loops around handles; with `--json` also these loops, and the full turns of the matchings. Of a quad mesh the field is one of its triangles, two for each quad; the cones are its
/// irregular vertices.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct FieldArgs {
    /// The mesh, or the quad mesh: OBJ, OFF, PLY, STL or glTF
    mesh: PathBuf,

    /// A seamless map of the mesh: an OBJ file with a texture coordinate at every corner; not for a quad
    /// mesh
    #[arg(value_name = "MAP.obj")]
    map: Option<PathBuf>,

    /// Write the field to this file: .rosy with one direction per face, else .rawfield with four
    #[arg(short, long, value_name = "FIELD")]
    output: PathBuf,

    /// Write the cones to this file: vertex (counted from 0) and index in quarters of a turn
    #[arg(long, value_name = "FILE.sing")]
    sing: Option<PathBuf>,

    /// Write the matchings modulo 4 to this file
    #[arg(long, value_name = "FILE.matching")]
    matching: Option<PathBuf>,

    /// Repair the mesh first, as `map --repair` does
    #[arg(long, requires = "map")]
    repair: bool,

    /// How far the sides of a seam may be apart, in lengths of the edge, at most 0.01
    #[arg(long, value_name = "X", value_parser = not_negative, default_value_t = CertifyOptions::default().tolerance)]
    tolerance: f64,

    /// Print the indices as JSON on standard output instead of the summary
    #[arg(long)]
    json: bool,
}

impl Command for FieldArgs {
    const NAME: &'static str = "field";
    type Product = CrossField;

    fn run_args(&self) -> RunArgs {
        RunArgs::quick(self.json)
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let mut files = targets(Kind::Cones, &self.sing);
        files.extend(targets(Kind::Matching, &self.matching));
        files.extend(targets(Kind::Field, [&self.output]));
        Plan::new(&inputs(&self.mesh, self.map.as_deref()), None, files)
    }

    fn make(&self, session: &Session) -> Result<CrossField, Failure> {
        let options = SurfaceOptions::default().repair(self.repair);
        let inspection = session.inspect(&self.mesh, &options)?;
        let Some(path) = &self.map else {
            return Ok(PolygonMesh::read(&self.mesh)?.field()?);
        };
        let surface = session.surface(inspection)?;
        let map = MapFile::read(path)?;
        map.require_mesh_of(&surface)?;
        let certify = CertifyOptions::default().tolerance(self.tolerance);
        Ok(surface.field(map.uvs(), map.face_uvs(), &certify)?)
    }

    fn write(
        &self,
        field: &CrossField,
        target: &Target,
        mut file: &mut dyn Write,
    ) -> io::Result<()> {
        match target.kind {
            Kind::Cones => write_cones(field.cones(), &mut file),
            Kind::Matching => write_matchings(field.surface(), &field.matchings(), &mut file),
            _ => field.write_as(&target.path, &mut file),
        }
    }

    fn report(&self, field: &CrossField) -> Value {
        to_json(field.report())
    }

    fn summary(&self, field: &CrossField) -> Vec<String> {
        let report = field.report();
        let loops: Vec<String> = report.loops.iter().map(|l| l.index.to_string()).collect();
        let loops = if loops.is_empty() { "none".into() } else { loops.join(", ") };
        let mut rows = summary::surface_rows(&report.input);
        rows.push(row("field", &counted(report.cones.len(), "cone")));
        rows.push(row("loops", &format!("indices around handles: {loops}")));
        rows
    }
}
