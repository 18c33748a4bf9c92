//! `seamstress map`.

use crate::args::MapArgs;
use crate::faults::listing;
use crate::input::LoadedMesh;
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan};
use crate::pictures;
use crate::progress::Bars;
use crate::report::{self, Cost, MapReport, VERSION};
use crate::stop::{Abandoned, Stop, supervise};
use crate::summary;
use crate::system;
use crate::text::{self, counted, figure, row};
use seamstress::{MapError, MapSolution, make_map};
use seamstress_io::{MapObj, write_map_obj, write_singularities};
use seamstress_surface::TriMesh;
use serde_json::json;
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;

/// Warnings of each kind shown; the report has them all.
const SHOWN_WARNINGS: usize = 5;
/// Repairs shown; the report has them all.
const SHOWN_REPAIRS: usize = 20;

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    solution: MapSolution,
    pictures: Option<[Vec<u8>; 3]>,
}

/// Runs the command.
pub(crate) fn run(args: &MapArgs) -> Result<Status, Failure> {
    let stop = Stop::new(args.time_limit);
    set_threads(args.threads)?;
    let plan = Plan::new(args)?;
    let bars = Bars::new(!args.quiet);
    let worker = Worker { args: args.clone(), stop: stop.clone(), bars: bars.clone() };
    let made = supervise(&stop, move || worker.make());
    bars.clear();
    let product = made.unwrap_or_else(|abandoned| Err(abandoned_failure(&args.mesh, abandoned)))?;
    finish(args, &stop, &plan, &product)?;
    Ok(Status::Done)
}

fn set_threads(threads: Option<u32>) -> Result<(), Failure> {
    let Some(threads) = threads else {
        return Ok(());
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads as usize)
        .build_global()
        .map_err(|error| Failure::Usage(format!("cannot start {threads} threads: {error}")))
}

fn abandoned_failure(file: &Path, abandoned: Abandoned) -> Failure {
    let file = file.to_owned();
    match abandoned {
        Abandoned::Stopped(reason) => Failure::Stopped { file, reason },
        Abandoned::Panicked => Failure::Internal { file, text: "the computation broke off".into() },
    }
}

/// The part of the command that may take long.
struct Worker {
    args: MapArgs,
    stop: Stop,
    bars: Bars,
}

impl Worker {
    fn make(mut self) -> Result<Product, Failure> {
        let mesh = LoadedMesh::load(&self.args.mesh, self.args.repair)?;
        if !self.args.quiet {
            tell_findings(&mesh);
        }
        mesh.require_mesh()?;
        let connectivity =
            TriMesh::from_faces(mesh.soup.positions.len(), &mesh.soup.faces).map_err(|error| {
                Failure::BadMesh { file: mesh.path.clone(), text: error.to_string() }
            })?;
        let solution = self.solve(&mesh, &connectivity)?;
        self.stop.lift_limit();
        let pictures = match &self.args.pictures {
            Some(_) => Some(pictures::draw(&mesh.soup, &solution.map)),
            None => None,
        };
        let pictures = pictures
            .transpose()
            .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
        Ok(Product { mesh, solution, pictures })
    }

    fn solve(&mut self, mesh: &LoadedMesh, connectivity: &TriMesh) -> Result<MapSolution, Failure> {
        let (stop, bars) = (&self.stop, &mut self.bars);
        let mut observe = |progress| {
            bars.show(progress);
            match stop.reason() {
                Some(_) => ControlFlow::Break(()),
                None => ControlFlow::Continue(()),
            }
        };
        let positions = &mesh.soup.positions;
        let made = make_map(connectivity, positions, &self.args.options(), &mut observe);
        made.map_err(|cause| {
            let file = mesh.path.clone();
            match (cause, stop.reason()) {
                (MapError::Cancelled(_), Some(reason)) => Failure::Stopped { file, reason },
                (cause, _) => Failure::NoMap { file, cause },
            }
        })
    }
}

/// Notes, warnings and repairs, on standard error.
fn tell_findings(mesh: &LoadedMesh) {
    for note in &mesh.notes {
        text::tell(&format!("note: {note}"));
    }
    for repair in mesh.repairs.iter().take(SHOWN_REPAIRS) {
        text::tell(&format!("repair: {repair}"));
    }
    if mesh.repairs.len() > SHOWN_REPAIRS {
        let more = mesh.repairs.len() - SHOWN_REPAIRS;
        text::tell(&format!("repair: and {more} more"));
    }
    if !mesh.repairs.is_empty() {
        text::tell("note: the map is of the repaired mesh");
    }
    for warning in listing(mesh.warnings(), SHOWN_WARNINGS) {
        text::tell(&format!("warning: {warning}"));
    }
}

/// Writes everything, puts it in place and prints the summary.
fn finish(args: &MapArgs, stop: &Stop, plan: &Plan, product: &Product) -> Result<(), Failure> {
    let mut batch = plan.begin()?;
    let mut report = String::new();
    let cost = cost_so_far(stop);
    let mut pictures = product.pictures.iter().flatten();
    if args.json || args.report.is_some() {
        report = report_text(args, plan, product, cost);
    }
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Map => write_map(file, args, product),
            Kind::Cones => write_cones(file, product),
            Kind::Report => writeln!(file, "{report}"),
            Kind::Picture => file.write_all(pictures.next().map_or(&[], Vec::as_slice)),
        })?;
    }
    if let Some(reason) = stop.reason() {
        let file = args.mesh.clone();
        return Err(Failure::Stopped { file, reason });
    }
    batch.commit()?;
    if args.json {
        text::print(&report)?;
    } else if !args.quiet {
        text::print(&summary_text(plan, product, &cost))?;
    }
    Ok(())
}

fn cost_so_far(stop: &Stop) -> Cost {
    Cost {
        wall_seconds: stop.elapsed().as_secs_f64(),
        cpu_seconds: system::cpu_seconds(),
        peak_memory_bytes: system::peak_memory(),
        threads: rayon::current_num_threads(),
    }
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
            "time_limit": args.time_limit.map(|limit| limit.as_secs_f64()),
            "threads": args.threads,
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
