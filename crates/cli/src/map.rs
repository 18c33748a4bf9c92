//! `seamstress map`.

use crate::args::MapArgs;
use crate::input::LoadedMesh;
use crate::job::{Job, Worker};
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, Cost, MapReport, VERSION};
use crate::summary;
use crate::text::{self, counted, figure, row};
use seamstress::{MapError, MapSolution, make_map};
use seamstress_io::{MapObj, write_map_obj, write_singularities};
use serde_json::json;
use std::io::Write;

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    solution: MapSolution,
    pictures: Option<[Vec<u8>; 3]>,
}

/// Runs the command.
pub(crate) fn run(args: &MapArgs) -> Result<Status, Failure> {
    let job = Job::new(&args.run, &args.mesh)?;
    let plan = plan(args)?;
    let owned = args.clone();
    let product = job.run(move |worker| make(&owned, worker))?;
    finish(args, &job, &plan, &product)?;
    Ok(Status::Done)
}

/// The outputs; the map last, since it says that the rest is there.
fn plan(args: &MapArgs) -> Result<Plan, Failure> {
    let mut targets = Vec::new();
    if let Some(folder) = &args.pictures {
        targets.extend(pictures::NAMES.map(|name| Target::new(Kind::Picture, &folder.join(name))));
    }
    targets.extend(args.cones.iter().map(|path| Target::new(Kind::Cones, path)));
    targets.extend(args.report.iter().map(|path| Target::new(Kind::Report, path)));
    targets.push(Target::new(Kind::Map, &args.output));
    Plan::new(&[&args.mesh], args.pictures.as_deref(), targets)
}

/// The part of the command that may take long.
fn make(args: &MapArgs, mut worker: Worker) -> Result<Product, Failure> {
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    if !args.run.quiet {
        mesh.tell_findings();
    }
    let connectivity = mesh.connect()?;
    let made = make_map(&connectivity, &mesh.soup.positions, &args.options(), &mut |progress| {
        worker.observe(progress)
    });
    let solution = made.map_err(|cause| {
        let file = mesh.path.clone();
        match (cause, worker.stop.reason()) {
            (MapError::Cancelled(_), Some(reason)) => Failure::Stopped { file, reason },
            (cause, _) => Failure::NoMap { file, cause },
        }
    })?;
    worker.stop.lift_limit();
    let pictures = match &args.pictures {
        Some(_) => Some(pictures::draw(&mesh.soup, &solution.map, &args.texture)),
        None => None,
    };
    let pictures = pictures
        .transpose()
        .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
    Ok(Product { mesh, solution, pictures })
}

/// Writes everything, puts it in place and prints the summary.
fn finish(args: &MapArgs, job: &Job, plan: &Plan, product: &Product) -> Result<(), Failure> {
    let mut batch = plan.begin()?;
    let mut report = String::new();
    let cost = job.cost();
    let mut pictures = product.pictures.iter().flatten();
    if args.run.json || args.report.is_some() {
        report = report_text(args, plan, product, cost);
    }
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Map | Kind::Quads => write_map(file, args, product),
            Kind::Cones => write_cones(file, product),
            Kind::Report => writeln!(file, "{report}"),
            Kind::Picture => file.write_all(pictures.next().map_or(&[], Vec::as_slice)),
        })?;
    }
    job.still_wanted()?;
    batch.commit()?;
    if args.run.json {
        text::print(&report)?;
    } else if !args.run.quiet {
        text::print(&summary_text(plan, product, &cost))?;
    }
    Ok(())
}

fn report_text(args: &MapArgs, plan: &Plan, product: &Product, cost: Cost) -> String {
    let solution = &product.solution;
    report::to_text(&MapReport {
        seamstress: VERSION,
        command: "map",
        options: json!({
            "repair": args.repair,
            "cone_bias": args.cone_bias,
            "cone_price": args.cone_price,
            "rounding": args.options().rounding.strategy,
            "time_limit": args.run.time_limit.map(|limit| limit.as_secs_f64()),
            "threads": args.run.threads,
        }),
        input: report::input_json(&product.mesh),
        components: &solution.components,
        map: report::map_json(&solution.map, &solution.distortion),
        files: &plan.targets,
        cost,
    })
}

fn write_map(file: &mut impl Write, args: &MapArgs, product: &Product) -> std::io::Result<()> {
    let solution = &product.solution;
    let name = args.mesh.file_name().unwrap_or(args.mesh.as_os_str());
    let repaired = match product.mesh.repairs.len() {
        0 => String::new(),
        n => format!(", after {}", counted(n, "repair")),
    };
    let comments = [
        format!("Seamless map by Seamstress {VERSION}"),
        format!("Source: {}{repaired}", name.display()),
        format!(
            "tau {}, symmetric Dirichlet energy {}, {}",
            figure(report::tau(&solution.distortion)),
            figure(solution.distortion.symmetric_dirichlet),
            counted(solution.map.cones().len(), "cone"),
        ),
    ];
    let map = MapObj {
        positions: &product.mesh.soup.positions,
        faces: &product.mesh.soup.faces,
        corner_uvs: solution.map.corner_uvs(),
        comments: &comments,
    };
    write_map_obj(file, &map)
}

fn write_cones(file: &mut impl Write, product: &Product) -> std::io::Result<()> {
    let cones = product.solution.map.cones();
    let rows: Vec<(u32, i32)> = cones.iter().map(|c| (c.vertex, c.index)).collect();
    write_singularities(file, 4, &rows)
}

fn summary_text(plan: &Plan, product: &Product, cost: &Cost) -> String {
    let solution = &product.solution;
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.extend(summary::map_rows(&solution.map, &solution.distortion));
    rows.push(summary::cost_row(cost, &solution.components));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}
