//! `seamstress layout`.

use crate::args::LayoutArgs;
use crate::features::{AlignedFeatures, Features};
use crate::input::LoadedMesh;
use crate::job::{Job, Worker};
use crate::map_file::MapFile;
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, Cost, VERSION};
use crate::stretches::read_stretches;
use crate::summary;
use crate::text::{counted, figure, row};
use crate::writers::{Written, write_map};
use seamstress_mesh::TriMesh;
use seamstress_parametrize::{
    Anisotropy, ConicStats, MapError, Progress, Relayout, SeamlessMap, lay_out_disk, relayout,
};
use serde_json::json;
use std::io::Write;
use std::path::Path;

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    solution: Relayout,
    features: Option<AlignedFeatures>,
    pictures: Option<[Vec<u8>; 3]>,
}

/// Runs the command.
pub(crate) fn run(args: &LayoutArgs) -> Result<Status, Failure> {
    let job = Job::new(&args.run, &args.mesh)?;
    let plan = plan(args)?;
    let owned = args.clone();
    let product = job.run(move |worker| make(&owned, worker))?;
    finish(args, &job, &plan, &product)?;
    Ok(Status::Done)
}

/// The outputs; the map last, since it says that the rest is there.
fn plan(args: &LayoutArgs) -> Result<Plan, Failure> {
    let mut inputs: Vec<&Path> = vec![&args.mesh];
    inputs.extend(args.map.as_deref());
    inputs.extend(args.anisotropy.as_deref());
    inputs.extend(args.features.files());
    let mut targets = Vec::new();
    if let Some(folder) = &args.pictures {
        targets.extend(pictures::NAMES.map(|name| Target::new(Kind::Picture, &folder.join(name))));
    }
    targets.extend(args.report.iter().map(|path| Target::new(Kind::Report, path)));
    targets.push(Target::new(Kind::Map, &args.output));
    Plan::new(&inputs, args.pictures.as_deref(), targets)
}

/// The part of the command that may take long.
fn make(args: &LayoutArgs, mut worker: Worker) -> Result<Product, Failure> {
    if args.features.is_given() && args.map.is_none() {
        let text = "features need a map that follows them, as made by `seamstress map --features`";
        return Err(Failure::Usage(format!("{}: {text}", args.mesh.display())));
    }
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    if !args.run.quiet {
        mesh.tell_findings();
    }
    let connectivity = mesh.connect()?;
    let start = args.map.as_deref().map(|path| read_map(args, path, &mesh, &connectivity));
    let start = start.transpose()?;
    let mut options = args.options();
    options.anisotropy =
        args.anisotropy.as_deref().map(|path| stretches(path, &mesh, &connectivity)).transpose()?;
    let sources = &args.features.features;
    let asked = Features::resolve(sources, args.features.align_boundary, &mesh, &connectivity)?;
    options.features = args.features.is_given().then(|| asked.edges.clone());
    let mut observer = |progress: Progress| worker.observe(progress);
    let positions = &mesh.soup.positions;
    let made = match &start {
        Some(map) => relayout(&connectivity, positions, map, &options, &mut observer),
        None => lay_out_disk(&connectivity, positions, &options, &mut observer),
    };
    let solution = made.map_err(|cause| {
        let file = mesh.path.clone();
        match (cause, worker.stop.reason()) {
            (MapError::Cancelled(_), Some(reason)) => Failure::Stopped { file, reason },
            (cause, _) if cause.is_not_a_disk() => Failure::Usage(format!(
                "{}: {cause}; give a seamless map to start from, as made by `seamstress map`",
                file.display()
            )),
            (cause, _) => Failure::NoMap { file, cause },
        }
    })?;
    worker.stop.lift_limit();
    let certify =
        || AlignedFeatures::certify(&connectivity, asked, &solution.map, &solution.released);
    let features = args.features.is_given().then(certify).transpose();
    let features =
        features.map_err(|cause| Failure::Misaligned { file: mesh.path.clone(), cause })?;
    let pictures = args
        .pictures
        .as_ref()
        .map(|_| pictures::draw(&mesh.soup, &solution.map, features.as_ref(), &args.texture))
        .transpose()
        .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
    Ok(Product { mesh, solution, features, pictures })
}

/// The map to start from, which must be certified.
fn read_map(
    args: &LayoutArgs,
    path: &Path,
    mesh: &LoadedMesh,
    connectivity: &TriMesh,
) -> Result<SeamlessMap, Failure> {
    let map = MapFile::read(path)?;
    map.require_faces_of(mesh, path)?;
    let tolerance = args.options().tolerance;
    SeamlessMap::certify(connectivity, map.corner_uvs, &tolerance).map_err(|violations| {
        let text = format!(
            "not a seamless map: {violations}; `seamstress check` lists everything, and a larger \
             `--tolerance` allows seams that are open by rounding"
        );
        Failure::BadMap { file: path.to_owned(), text }
    })
}

fn stretches(
    path: &Path,
    mesh: &LoadedMesh,
    connectivity: &TriMesh,
) -> Result<Anisotropy, Failure> {
    Anisotropy::new(connectivity, &mesh.soup.positions, &read_stretches(path)?)
        .map_err(|error| Failure::BadStretches { file: path.to_owned(), text: error.to_string() })
}

/// Writes everything, puts it in place and prints the summary.
fn finish(args: &LayoutArgs, job: &Job, plan: &Plan, product: &Product) -> Result<(), Failure> {
    let (mesh, solution) = (&product.mesh, &product.solution);
    let cost = job.cost();
    let report = if args.run.json || args.report.is_some() {
        report_text(args, plan, product, cost)
    } else {
        String::new()
    };
    let mut pictures = product.pictures.iter().flatten();
    let mut batch = plan.begin()?;
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Report => writeln!(file, "{report}"),
            Kind::Picture => file.write_all(pictures.next().map_or(&[], Vec::as_slice)),
            _ => write_map(file, mesh, &Written::certified(&solution.map, &solution.distortion)),
        })?;
    }
    job.finish(&args.run, batch, || report, || summary_text(args, plan, product, &cost))
}

fn report_text(args: &LayoutArgs, plan: &Plan, product: &Product, cost: Cost) -> String {
    let solution = &product.solution;
    let mut value = json!({
        "seamstress": VERSION,
        "command": "layout",
        "options": {
            "objective": args.objective,
            "start": args.map.as_ref().map(|path| path.to_string_lossy()),
            "solver": args.options().settings.conic.solver,
            "anisotropy": args.anisotropy.as_ref().map(|path| path.to_string_lossy()),
            "features": report::sources_json(&args.features),
            "align_boundary": args.features.align_boundary,
            "features_strict": args.features_strict,
            "repair": args.repair,
            "tolerance": args.options().tolerance.seam,
            "time_limit": args.run.time_limit.map(|limit| limit.as_secs_f64()),
            "threads": args.run.threads,
        },
        "input": report::input_json(&product.mesh),
        "components": solution.components,
        "files": plan.targets,
        "cost": cost,
    });
    if let Some(features) = &product.features {
        value["features"] = features.json();
    }
    report::merge(&mut value, report::map_json(&solution.map, &solution.distortion));
    report::to_text(&value)
}

/// How the conic programs went.
fn conic_row(stats: ConicStats) -> String {
    let solver = report::name_of(&stats.solver);
    let mut text = format!("{} solved by {solver}", counted(stats.programs, "program"));
    if let Some(outcome) = stats.fallback_from {
        text += &format!(", after our own solver ended with {}", report::name_of(&outcome));
    }
    text += match stats.injective_by_bound {
        Some(true) => ", mu < 1: no flips by the bound alone",
        Some(false) => ", mu not below 1",
        None => "",
    };
    row("", &text)
}

fn summary_text(args: &LayoutArgs, plan: &Plan, product: &Product, cost: &Cost) -> String {
    let solution = &product.solution;
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.extend(product.features.iter().flat_map(|f| summary::feature_rows(&f.asked)));
    for (k, stats) in solution.components.iter().enumerate() {
        let whose = match solution.components.len() {
            1 => String::new(),
            _ => format!("component {k}: "),
        };
        let text = format!(
            "{whose}{} {} -> {} ({})",
            args.objective,
            figure(stats.before),
            figure(stats.after),
            stats.ending
        );
        rows.push(row("objective", &text));
        rows.extend(stats.conic.map(conic_row));
    }
    rows.extend(summary::map_rows(&solution.map, &solution.distortion));
    rows.extend(product.features.iter().flat_map(summary::aligned_rows));
    rows.push(summary::cost_row(cost, std::iter::empty()));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}
