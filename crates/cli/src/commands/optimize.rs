//! `seamstress lab optimize`.

use super::{draw_map, inputs, map_pictures, targets};
use crate::args::{FeatureArgs, RunArgs, after_help};
use crate::command::{Command, Session, to_json};
use crate::failure::Failure;
use crate::output::{Kind, Plan, Target};
use crate::summary;
use crate::text::{counted, rounded, row};
use seamstress::lab::read_stretches;
use seamstress::{
    ConicStats, Error, Features, MapFile, Objective, OptimizeOptions, OptimizeReport, SeamlessMap,
    SurfaceOptions, TextureOptions, UvSet,
};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  seamstress lab optimize bunny.ply bunny.obj --objective arap -o rigid.obj
  seamstress lab optimize bunny.ply bunny.obj --objective asap -o conformal.obj --pictures conformal
  seamstress lab optimize mask.obj --objective symmetric-dirichlet -o flat.obj
  seamstress lab optimize bunny.ply bunny.obj --objective arap --anisotropy stretch.txt -o long.obj
  seamstress lab optimize part.obj part_map.obj --features angle:40 --objective tau -o even.obj
  seamstress lab optimize bunny.ply bunny.obj --objective dilatation --bound 1.5 -o bounded.obj";

/// Lay a map out anew, for the distortion you choose
///
/// Starts from a seamless map and minimises an objective over all maps with its matchings and cones; the
/// seams may come to lie elsewhere. Without a map, a mesh that is a disk is laid out with a free boundary
/// and no seam. The result is certified, has no flips, and is never worse than the start. Features that the
/// map follows stay exactly on its axes; those that it does not follow are reported as dropped.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = after_help(EXAMPLES))]
pub(crate) struct OptimizeArgs {
    /// The mesh: OBJ, OFF, PLY, STL or glTF
    mesh: PathBuf,

    /// A seamless map of the mesh; may be left out if the mesh is a disk
    #[arg(value_name = "MAP.obj")]
    map: Option<PathBuf>,

    /// Write the new map to this OBJ file, replacing an existing one
    #[arg(short, long, value_name = "NEW.obj")]
    output: PathBuf,

    #[command(flatten)]
    options: OptimizeOptions,

    /// Stretches that count as no distortion: a text file with five numbers per triangle, a direction in
    /// space and the stretch wanted along and across it
    #[arg(long, value_name = "FILE")]
    anisotropy: Option<PathBuf>,

    #[command(flatten)]
    features: FeatureArgs,

    /// Write everything about the run to this JSON file
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,

    /// Write front.png, back.png and layout.png to this folder, made if it does not exist
    #[arg(long, value_name = "DIR", group = "drawn")]
    pictures: Option<PathBuf>,

    #[command(flatten)]
    surface: SurfaceOptions,

    #[command(flatten)]
    run: RunArgs,

    #[command(flatten)]
    texture: TextureOptions,
}

impl Command for OptimizeArgs {
    const NAME: &'static str = "optimize";
    type Product = SeamlessMap<OptimizeReport>;

    fn run_args(&self) -> RunArgs {
        self.run
    }

    fn input(&self) -> &Path {
        &self.mesh
    }

    fn plan(&self) -> Result<Plan, Failure> {
        if self.map.is_none() && !self.features.or(Features::none()).is_none() {
            let hint = "a map that follows them, as made by `seamstress map --features`";
            return Err(Failure::Usage(format!("{}: features need {hint}", self.mesh.display())));
        }
        let mut files = map_pictures(self.pictures.as_ref());
        files.extend(targets(Kind::Report, &self.report));
        files.extend(targets(Kind::Map, [&self.output]));
        let given = self.map.as_deref().into_iter().chain(self.anisotropy.as_deref());
        let given = inputs(&self.mesh, given.chain(self.features.files()));
        Plan::new(&given, self.pictures.as_deref(), files)
    }

    fn make(&self, session: &Session) -> Result<Self::Product, Failure> {
        let surface = session.open(&self.mesh, &self.surface)?;
        let mut options = self.options.clone().features(self.features.or(Features::none()));
        options.stretches = self.anisotropy.as_ref().map(read_stretches).transpose()?;
        let Some(path) = &self.map else {
            return Ok(surface.flatten_disk(&options)?);
        };
        let map = MapFile::read(path)?;
        map.require_faces_of(&surface)?;
        Ok(surface.optimize(map.uvs(), map.face_uvs(), &options)?)
    }

    fn pictures(&self, map: &Self::Product) -> Result<Vec<Vec<u8>>, Error> {
        draw_map(self.pictures.as_ref(), || map.pictures(&self.texture))
    }

    fn write(
        &self,
        map: &Self::Product,
        target: &Target,
        mut file: &mut dyn Write,
    ) -> io::Result<()> {
        map.write_as(&target.path, UvSet::First, &mut file)
    }

    fn report(&self, map: &Self::Product) -> Value {
        let mut value = to_json(map.report());
        value["options"]["start"] = json!(self.map);
        value["options"]["anisotropy"] = json!(self.anisotropy);
        value
    }

    fn summary(&self, map: &Self::Product) -> Vec<String> {
        let report = map.report();
        let mut rows = summary::surface_rows(&report.input);
        rows.extend(report.features.iter().flat_map(summary::feature_rows));
        for (k, stats) in report.components.iter().enumerate() {
            let whose = match report.components.len() {
                1 => String::new(),
                _ => format!("component {k}: "),
            };
            let energy = self.options.bound.map(|_| Objective::SymmetricDirichlet);
            let what = energy.unwrap_or(self.options.objective);
            let (before, after) = (rounded(stats.before), rounded(stats.after));
            let text = format!("{whose}{what} {before} -> {after} ({})", stats.ending);
            rows.push(row("objective", &text));
            if let (Some(bound), Some(dilatation)) = (self.options.bound, stats.dilatation) {
                let text = format!("{whose}dilatation {}, at most {bound}", rounded(dilatation));
                rows.push(row("bound", &text));
            }
            rows.extend(stats.conic.map(conic_row));
        }
        rows.extend(summary::distortion_rows(&report.distortion));
        rows.extend(summary::certificate_rows(&report.cones, &report.certificate));
        rows.extend(report.features.iter().flat_map(summary::aligned_rows));
        rows
    }

    fn stages(&self, _: &Self::Product) -> Option<Vec<(&'static str, f64)>> {
        Some(Vec::new())
    }
}

/// How the conic programs went.
fn conic_row(stats: ConicStats) -> String {
    let name = |value: Value| value.as_str().unwrap_or_default().to_owned();
    let solver = name(to_json(&stats.solver));
    let mut text = format!("{} solved by {solver}", counted(stats.programs, "program"));
    if let Some(outcome) = stats.fallback_from {
        text += &format!(", after our own solver ended with {}", name(to_json(&outcome)));
    }
    if let Some(part) = stats.remaining.filter(|&part| part > 0.0) {
        text += &format!(", {part:.0e} of the objective perhaps still to gain");
    }
    text += match stats.injective_by_bound {
        Some(true) => ", mu < 1: no flips by the bound alone",
        Some(false) => ", mu not below 1",
        None => "",
    };
    row("", &text)
}
