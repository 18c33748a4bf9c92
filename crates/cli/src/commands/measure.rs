//! `seamstress measure`.

use super::{inputs, measure_named, targets};
use crate::args::{RunArgs, after_help, not_negative};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan};
use crate::summary;
use crate::text::{counted, row};
use clap::builder::PossibleValuesParser;
use seamstress::command_reports::MeasureReport;
use seamstress::{
    CertifyOptions, Error, MapFile, Measure, Measurements, Objective, Surface, SurfaceOptions,
    ViewOptions,
};
use serde_json::Value;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress measure bunny.ply bunny.obj
  seamstress measure bunny.ply bunny.obj --picture stretch.png --of symmetric-dirichlet
  seamstress measure bunny.ply other_program.obj --tolerance 1e-5
  seamstress measure bunny.ply bunny.obj --json | jq '.measures[] | {measure, mean, max}'";

/// Measure the distortion of a map
///
/// Any map with the triangles of the mesh will do, with flips and open seams too; the summary says whether
/// it is a seamless map. Every measure is taken at the global scale that suits it.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct MeasureArgs {
    /// The mesh: OBJ, OFF, PLY, STL or glTF
    mesh: PathBuf,

    /// A map of the mesh: an OBJ file with a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    map: PathBuf,

    /// Paint a measure on the surface, from both sides, and write the picture to this file
    #[arg(long, value_name = "FILE.png", group = "drawn")]
    picture: Option<PathBuf>,

    /// The measure that is painted
    #[arg(long, value_name = "MEASURE", value_parser = PossibleValuesParser::new(Measure::ALL.map(Measure::name)),
        default_value = "tau", requires = "picture")]
    of: String,

    #[command(flatten)]
    surface: SurfaceOptions,

    /// How far the sides of a seam may be apart, in lengths of the edge, for the map to count as seamless; at
    /// most 0.01 [default: 1e-9]
    #[arg(long, value_name = "X", value_parser = not_negative)]
    tolerance: Option<f64>,

    /// Print everything as JSON on standard output
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    view: ViewOptions,
}

impl MeasureArgs {
    fn options(&self) -> CertifyOptions {
        let default = CertifyOptions::default();
        default.clone().tolerance(self.tolerance.unwrap_or(default.tolerance))
    }
}

impl Command for MeasureArgs {
    const NAME: &'static str = "measure";
    type Product = (Surface, Measurements);

    fn run_args(&self) -> RunArgs {
        RunArgs::quick(self.json)
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let files = targets(Kind::Picture, &self.picture);
        Plan::new(&inputs(&self.mesh, [self.map.as_path()]), None, files)
    }

    fn make(&self, session: &Session) -> Result<Self::Product, Failure> {
        let surface = session.open(&self.mesh, &self.surface)?;
        let map = MapFile::read(&self.map)?;
        map.require_faces_of(&surface)?;
        let measured = surface.measure(map.uvs(), map.face_uvs(), &self.options())?;
        Ok((surface, measured))
    }

    fn pictures(&self, (surface, measured): &Self::Product) -> Result<Vec<Vec<u8>>, Error> {
        let wanted = measure_named(&self.of);
        let painted = measured.measures.iter().filter(|m| m.measure == wanted);
        painted
            .filter(|_| self.picture.is_some())
            .map(|m| surface.heat_picture(m, &self.view))
            .collect()
    }

    fn report(&self, (surface, measured): &Self::Product) -> Value {
        let file = self.map.to_string_lossy().into();
        let options = (self.surface, &self.options());
        to_json(&MeasureReport::new(surface.report(), file, measured, options))
    }

    fn summary(&self, (surface, measured): &Self::Product) -> Vec<String> {
        let mut rows = summary::surface_rows(surface.report());
        rows.push(row("map", &self.map.display().to_string()));
        let seamless = match &measured.fault {
            None => "certified: no flips, every seam fits".into(),
            Some(fault) => format!("not a seamless map: {fault}"),
        };
        rows.push(row("certificate", &seamless));
        if measured.flipped > 0 {
            let triangles = counted(measured.flipped, "triangle");
            rows.push(row(
                "flips",
                &format!(
                    "{triangles} flipped or collapsed: infinite tau, symmetric Dirichlet energy and \
                     dilatation there; ARAP and ASAP with the negative sigma_2"
                ),
            ));
        }
        if measured.degenerate > 0 {
            let triangles = counted(measured.degenerate, "triangle");
            rows.push(row("left out", &format!("{triangles} without area on the surface")));
        }
        rows.push(String::new());
        let is_goal = |measure: Measure| {
            Objective::ALL.iter().any(|objective| objective.measure() == Some(measure))
        };
        rows.extend(summary::measure_table(&measured.measures, is_goal));
        rows.push(String::new());
        rows.push("* what `seamstress lab optimize` can minimise".into());
        rows
    }
}
