//! `seamstress map`.

use super::{draw_map, inputs, map_pictures, reports, targets};
use crate::args::{FeatureArgs, RunArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan, Target};
use crate::summary;
use crate::text::{as_options, counted, row};
use seamstress::lab::{LaidOut, MethodOptions};
use seamstress::{Error, Features, Page, SurfaceOptions, TextureOptions, UvSet, write_cones};
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress map bunny.ply -o bunny.obj
  seamstress map bunny.ply -o bunny.obj --report bunny.json --pictures bunny
  seamstress map scan.stl -o scan.obj --repair --time-limit 60
  seamstress map part.obj -o part_map.obj --features angle:40 --features boundary
  seamstress map toy.obj -o toy_uv.obj --pack=4096
  seamstress map part.off -o part.obj --json | jq .distortion.tau
  seamstress lab map eight.off -o eight.obj --field eight.rawfield
  seamstress lab map eight.off -o eight.obj --cones eight.sing --free-cones
  seamstress lab map eight.off -o eight.obj --method field --allow-flips
  seamstress lab map block.off -o block.obj --rounding mixed-integer --batch 800

`seamstress lab map --help` shows all options.";

/// Make a seamless map of a mesh
///
/// Reads a mesh, computes a seamless map of low distortion, certifies it and writes it as an OBJ file
/// with a texture coordinate per corner. Vertices and faces stay as they are and in their order;
/// polygons are split into triangles, and the corners of an STL file are welded where they coincide.
/// Files appear only when everything has succeeded.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct MapArgs {
    /// The mesh to map: OBJ, OFF, PLY, STL or glTF, also compressed with gzip; `-` is standard input
    mesh: PathBuf,

    /// Write the map to this OBJ, PLY or GLB file, replacing an existing one; `-` is standard output, as OBJ
    #[arg(short, long, value_name = "MAP.obj")]
    output: PathBuf,

    /// Which texture coordinates the map is in a GLB file, where the mesh has some of its own
    #[arg(long, value_enum, value_name = "SET", default_value_t)]
    uv_set: UvSet,

    /// Write everything about the run to this file: a page to look at with a name in .html, else JSON; may be given
    /// several times
    #[arg(long, value_name = "FILE")]
    report: Vec<PathBuf>,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR", group = "drawn")]
    pictures: Option<PathBuf>,

    /// Write the cones to this file: vertex (counted from 0) and index in quarters of a turn
    #[arg(long, value_name = "FILE.sing")]
    sing: Option<PathBuf>,

    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    features: FeatureArgs,

    #[command(flatten)]
    run: RunArgs,

    #[command(flatten)]
    method: MethodOptions,

    #[command(flatten)]
    texture: TextureOptions,
}

impl MapArgs {
    fn options(&self) -> MethodOptions {
        let mut options = self.method.clone();
        options.map.features = self.features.or(Features::none());
        options
    }
}

impl Command for MapArgs {
    const NAME: &'static str = "map";
    type Product = LaidOut;

    fn run_args(&self) -> RunArgs {
        self.run
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        self.options().validate().map_err(|error| Failure::Usage(as_options(error.message())))?;
        let mut files = map_pictures(self.pictures.as_ref());
        files.extend(targets(Kind::Cones, &self.sing));
        files.extend(reports(&self.report));
        files.extend(targets(Kind::Map, [&self.output]));
        let options = self.options();
        let given = options.start.files().chain(options.map.files());
        Plan::new(&inputs(&self.mesh, given), self.pictures.as_deref(), files)
    }

    fn make(&self, session: &Session) -> Result<LaidOut, Failure> {
        let surface = session.open(&self.mesh, &self.surface)?;
        Ok(surface.parametrize_with(&self.options())?)
    }

    fn pictures(&self, product: &LaidOut) -> Result<Vec<Vec<u8>>, Error> {
        match product {
            LaidOut::Certified(map) => {
                draw_map(self.pictures.as_ref(), || map.pictures(&self.texture))
            }
            LaidOut::Uncertified(_) => Ok(Vec::new()),
        }
    }

    fn page(&self, product: &LaidOut) -> Option<Page> {
        match product {
            LaidOut::Certified(map) => Some(map.page()),
            LaidOut::Uncertified(_) => None,
        }
    }

    fn write(
        &self,
        product: &LaidOut,
        target: &Target,
        mut file: &mut dyn Write,
    ) -> io::Result<()> {
        match (product, target.kind) {
            (LaidOut::Certified(map), Kind::Cones) => write_cones(map.cones(), &mut file),
            (LaidOut::Uncertified(layout), Kind::Cones) => write_cones(layout.cones(), &mut file),
            (LaidOut::Certified(map), _) => map.write_as(&target.path, self.uv_set, &mut file),
            (LaidOut::Uncertified(layout), _) => {
                layout.write_as(&target.path, self.uv_set, &mut file)
            }
        }
    }

    fn report(&self, product: &LaidOut) -> Value {
        let mut value = match product {
            LaidOut::Certified(map) => to_json(map.report()),
            LaidOut::Uncertified(layout) => to_json(layout.report()),
        };
        let options = self.options();
        value["options"] = to_json(&options.map);
        value["lab"] = to_json(&options.rounding);
        value["lab"]["start"] = to_json(&options.start);
        value
    }

    fn summary(&self, product: &LaidOut) -> Vec<String> {
        let map = match product {
            LaidOut::Certified(map) => map.report(),
            LaidOut::Uncertified(layout) => {
                let report = layout.report();
                let mut rows = summary::surface_rows(&report.input);
                rows.extend(summary::distortion_rows(&report.distortion));
                rows.push(row("cones", &counted(report.cones.count, "cone")));
                let text = format!("none: {}", layout.violations_text());
                rows.push(row("certificate", &text));
                return rows;
            }
        };
        let mut rows = summary::surface_rows(&map.input);
        rows.extend(map.symmetry.iter().flat_map(summary::symmetry_rows));
        rows.extend(map.features.iter().flat_map(summary::feature_rows));
        rows.extend(summary::map_rows(map));
        rows.extend(map.packing.iter().flat_map(summary::packing_rows));
        rows.extend(summary::mixed_integer_rows(&map.components));
        rows.extend(map.features.iter().flat_map(summary::aligned_rows));
        rows
    }

    fn stages(&self, product: &LaidOut) -> Option<Vec<(&'static str, f64)>> {
        let components = match product {
            LaidOut::Certified(map) => &map.report().components,
            LaidOut::Uncertified(layout) => &layout.report().components,
        };
        Some(summary::stages(components))
    }
}
