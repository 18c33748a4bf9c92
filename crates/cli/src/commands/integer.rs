//! `seamstress integer`.

use super::{draw_map, inputs, map_pictures, reports, targets};
use crate::args::{FeatureArgs, RunArgs, SizeArgs, after_help, not_negative};
use crate::command::{Command, Session, to_json};
use crate::failure::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::summary;
use crate::text::{rounded, row};
use seamstress::{
    CertifyOptions, Error, Features, GridRounding, IntegerGridMap, IntegerMapOptions, MapFile,
    MapOptions, Page, PartOptions, QuantizationStats, SurfaceOptions, TextureOptions, UvSet,
};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress integer bunny.ply --quads 5000 -o grid.obj
  seamstress integer bunny.ply bunny.obj --edge-length 0.02 -o grid.obj
  seamstress integer part.off --scale 4 -o grid.obj --pictures part
  seamstress integer part.off --quads 3000 --features angle:20 --features boundary -o grid.obj
  seamstress integer part.off --quads 800 -o grid.obj --json | jq .grid";

/// Make an integer-grid map: a seamless map whose unit squares close up over the surface
///
/// Rounds a seamless map so that the shifts across all seams and the positions of all cones are whole
/// numbers, exactly, without flipping a triangle. The grid of unit squares is then a quad mesh of the
/// surface. Where cones are too close for the grid, it is made finer, and the summary says so. Without a
/// map the seamless map is made first, as `map` does, along the boundary and the creases. Features and boundaries
/// that are aligned come to lie on lines of the grid; in a map that is given, those of `--features` that it aligns.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct IntegerArgs {
    /// The mesh: OBJ, OFF, PLY, STL or glTF
    mesh: PathBuf,

    /// A seamless map of the mesh: an OBJ file with a texture coordinate at every corner
    #[arg(value_name = "MAP.obj")]
    map: Option<PathBuf>,

    /// Write the integer-grid map to this OBJ, PLY or GLB file, replacing an existing one
    #[arg(short, long, value_name = "INT.obj")]
    output: PathBuf,

    /// Which texture coordinates the map is in a GLB file, where the mesh has some of its own
    #[arg(long, value_enum, value_name = "SET", default_value_t)]
    uv_set: UvSet,

    #[command(flatten)]
    size: SizeArgs,

    /// How the whole numbers are chosen
    #[arg(long, value_enum, value_name = "HOW", default_value_t = GridRounding::Constrained)]
    rounding: GridRounding,

    #[command(flatten)]
    parts: PartOptions,

    /// Write everything about the run to this file: a page to look at with a name in .html, else JSON; may be given
    /// several times
    #[arg(long, value_name = "FILE")]
    report: Vec<PathBuf>,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR", group = "drawn")]
    pictures: Option<PathBuf>,

    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    run: RunArgs,

    #[command(flatten)]
    features: FeatureArgs,

    #[command(flatten)]
    method: MapOptions,

    /// How far the sides of a seam may be apart in the map that is read, in lengths of the edge, at most 0.01
    #[arg(long, value_name = "X", value_parser = not_negative, requires = "map")]
    tolerance: Option<f64>,

    #[command(flatten)]
    texture: TextureOptions,
}

impl IntegerArgs {
    fn options(&self) -> IntegerMapOptions {
        let mut options = IntegerMapOptions::default();
        (options.size, options.rounding) = (self.size.grid(), self.rounding);
        options.parts = self.parts;
        options.map(self.method.clone()).features(self.features.or(Features::default()))
    }
}

impl Command for IntegerArgs {
    const NAME: &'static str = "integer";
    type Product = IntegerGridMap;

    fn run_args(&self) -> RunArgs {
        self.run
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        let mut files = map_pictures(self.pictures.as_ref());
        files.extend(reports(&self.report));
        files.extend(targets(Kind::Map, [&self.output]));
        let options = self.options();
        let given = self.map.as_deref().into_iter().chain(options.map.files());
        Plan::new(&inputs(&self.mesh, given), self.pictures.as_deref(), files)
    }

    fn make(&self, session: &Session) -> Result<IntegerGridMap, Failure> {
        let surface = session.open(&self.mesh, &self.surface)?;
        let options = self.options();
        let integer = match &self.map {
            None => surface.integer_map(&options)?,
            Some(path) => {
                let map = MapFile::read(path)?;
                map.require_mesh_of(&surface)?;
                let default = CertifyOptions::default();
                let tolerance = self.tolerance.unwrap_or(default.tolerance);
                let certify = default.tolerance(tolerance);
                surface.integer_map_of(map.uvs(), map.face_uvs(), &certify, &options)?
            }
        };
        let report = integer.report();
        let lost = summary::lost_warning(&report.input, &report.components_without_quads);
        let failed = summary::failed_warnings(&report.parts);
        failed.iter().chain(&lost).for_each(|line| session.report(line));
        Ok(integer)
    }

    fn pictures(&self, map: &IntegerGridMap) -> Result<Vec<Vec<u8>>, Error> {
        draw_map(self.pictures.as_ref(), || map.pictures(&self.texture))
    }

    fn page(&self, map: &IntegerGridMap) -> Option<Page> {
        Some(map.page())
    }

    fn write(
        &self,
        map: &IntegerGridMap,
        target: &Target,
        mut file: &mut dyn Write,
    ) -> io::Result<()> {
        map.write_as(&target.path, self.uv_set, &mut file)
    }

    fn report(&self, map: &IntegerGridMap) -> Value {
        let mut value = to_json(map.report());
        value["seamless_map"] = json!(self.map);
        value
    }

    fn summary(&self, map: &IntegerGridMap) -> Vec<String> {
        let report = map.report();
        let mut rows = summary::surface_rows(&report.input);
        rows.extend(summary::part_rows(&report.parts));
        rows.extend(report.features.iter().flat_map(summary::feature_rows));
        rows.push(row("grid", &report.grid.to_string()));
        rows.extend(summary::distortion_rows(&report.distortion));
        rows.extend(report.sizes.iter().flat_map(summary::cell_size_rows));
        rows.extend(summary::certificate_rows(&report.cones, &report.certificate));
        let before = &report.distortion_before;
        let text = format!(
            "tau {}, symmetric Dirichlet {}",
            rounded(before.tau),
            rounded(before.symmetric_dirichlet)
        );
        rows.push(row("seamless map", &text));
        rows.push(summary::integers_row(&report.integer_certificate));
        rows.extend(report.features.iter().flat_map(summary::aligned_rows));
        rows
    }

    fn status(&self, map: &IntegerGridMap) -> Status {
        Status::of_parts(Some(&map.report().parts))
    }

    fn stages(&self, map: &IntegerGridMap) -> Option<Vec<(&'static str, f64)>> {
        let components = &map.report().components;
        let sum = |part: fn(&QuantizationStats) -> f64| components.iter().map(part).sum::<f64>();
        Some(vec![
            ("reduction", sum(|c| c.seconds_reduction)),
            ("rounding", sum(|c| c.seconds_rounding)),
            ("path", sum(|c| c.seconds_moving)),
            ("polish", sum(|c| c.seconds_polish)),
        ])
    }
}
