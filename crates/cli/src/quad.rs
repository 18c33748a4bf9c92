//! `seamstress quad`.

use crate::args::QuadArgs;
use crate::extract::{quad_rows, quads_json, tell_losses, write_quads};
use crate::features::AlignedFeatures;
use crate::input::LoadedMesh;
use crate::integer::{grid_json, grid_text, integers_text, make_integer, make_seamless};
use crate::job::{Job, Worker};
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, Cost, VERSION};
use crate::shape::{Shaped, Shaping};
use crate::summary;
use crate::text::{counted, row};
use seamstress_quads::{Extraction, ManifoldError, QuadConnectivity, QuadFaults, manifold_quads};
use seamstress_quantize::{IntegerOptions, IntegerSolution};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// What helps where there are no such quads.
const ADVICE: &str = "try more quads, or fewer cones with a larger `--cone-bias`";

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    integer: IntegerSolution,
    /// The features that edges of quads follow, if any were asked for.
    features: Option<AlignedFeatures>,
    /// Coarser grids whose quads were no manifold.
    refinements: usize,
    extraction: Extraction,
    connectivity: Result<QuadConnectivity, QuadFaults>,
    shaped: Shaped,
    picture: Option<Vec<u8>>,
}

/// Runs the command.
pub(crate) fn run(args: &QuadArgs) -> Result<Status, Failure> {
    let job = Job::new(&args.run, &args.mesh)?;
    let plan = plan(args)?;
    let owned = args.clone();
    let product = job.run(move |worker| make(&owned, worker))?;
    finish(args, &job, &plan, &product)?;
    Ok(Status::Done)
}

fn plan(args: &QuadArgs) -> Result<Plan, Failure> {
    let mut targets = Vec::new();
    targets.extend(args.picture.iter().map(|path| Target::new(Kind::Picture, path)));
    targets.extend(args.report.iter().map(|path| Target::new(Kind::Report, path)));
    targets.push(Target::new(Kind::Quads, &args.output));
    let mesh: &Path = &args.mesh;
    let inputs: Vec<&Path> = std::iter::once(mesh).chain(args.features.files()).collect();
    Plan::new(&inputs, None, targets)
}

/// Seamless map, integer map, quads.
fn make(args: &QuadArgs, mut worker: Worker) -> Result<Product, Failure> {
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    if !args.run.quiet {
        mesh.tell_findings();
    }
    let source = mesh.connect()?;
    let positions = &mesh.soup.positions;
    let size = args.size.grid();
    let start = make_seamless(&args.method, size, &args.features, &mesh, &source, &mut worker)?;

    let made = manifold_quads(&source, positions, size, |size| {
        let options = IntegerOptions { size, ..IntegerOptions::default() };
        make_integer(&start, &options, ADVICE, &mesh, &source, &mut worker)
    })
    .map_err(|error| no_quads(error, &mesh))?;
    worker.stop.lift_limit();

    let mut extraction = made.extraction;
    if !args.run.quiet {
        tell_losses(&extraction);
    }
    let features = start.features.as_ref().map_or(&[][..], |features| &features.kept);
    let shaping = Shaping { raw: args.raw, smooth: args.smooth, features };
    let shaped = shaping.apply(&mesh, &source, &mut extraction)?;
    if !args.run.quiet {
        shaped.tell_faults();
    }
    let picture = args
        .picture
        .is_some()
        .then(|| pictures::draw_quads(&extraction.mesh, &made.connectivity.irregular_vertices()));
    let picture = picture
        .transpose()
        .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
    Ok(Product {
        mesh,
        integer: made.integer,
        features: start.features,
        refinements: made.refinements,
        extraction,
        connectivity: Ok(made.connectivity),
        shaped,
        picture,
    })
}

fn no_quads(error: ManifoldError<Failure>, mesh: &LoadedMesh) -> Failure {
    let file = mesh.path.clone();
    match error {
        ManifoldError::Integer(failure) => failure,
        ManifoldError::NoManifold(faults) => Failure::NoManifold { file, faults, advice: ADVICE },
        other => Failure::NoQuads { file, text: other.to_string() },
    }
}

/// Writes everything, puts it in place and prints the summary.
fn finish(args: &QuadArgs, job: &Job, plan: &Plan, product: &Product) -> Result<(), Failure> {
    let cost = job.cost();
    let mut batch = plan.begin()?;
    let report = report::to_text(&report_json(args, plan, product, cost));
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Quads => write_quads(file, &args.mesh, &target.path, &product.extraction),
            Kind::Picture => file.write_all(product.picture.as_deref().unwrap_or_default()),
            _ => writeln!(file, "{report}"),
        })?;
    }
    job.finish(&args.run, batch, || report, || summary_text(args, plan, product, &cost))
}

fn report_json(args: &QuadArgs, plan: &Plan, product: &Product, cost: Cost) -> Value {
    let integer = &product.integer;
    json!({
        "seamstress": VERSION,
        "command": "quad",
        "options": {
            "size": args.size.grid(),
            "raw": args.raw,
            "smooth": args.smooth,
            "repair": args.repair,
            "features": report::sources_json(&args.features),
            "align_boundary": args.features.align_boundary,
            "cone_bias": args.method.cone_bias,
            "cone_price": args.method.cone_price,
            "time_limit": args.run.time_limit.map(|limit| limit.as_secs_f64()),
            "threads": args.run.threads,
        },
        "input": report::input_json(&product.mesh),
        "grid": grid_json(args.size.grid(), integer),
        "distortion": report::distortion_json(&integer.distortion),
        "integer_certificate": integer.map.certificate(),
        "components": integer.components,
        "features": product.features.as_ref().map(AlignedFeatures::json),
        "manifold_refinements": product.refinements,
        "quads": quads_json(&product.extraction, &product.connectivity),
        "mended": product.shaped.mended(),
        "orientation": product.shaped.orientation(),
        "files": plan.targets,
        "cost": cost,
    })
}

fn summary_text(args: &QuadArgs, plan: &Plan, product: &Product, cost: &Cost) -> String {
    let integer = &product.integer;
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.extend(product.features.iter().flat_map(|f| summary::feature_rows(&f.asked)));
    let mut grid = grid_text(args.size.grid(), integer);
    if product.refinements > 0 {
        let times = counted(product.refinements, "time");
        grid += &format!("; {times} finer for the quads to be a manifold");
    }
    rows.push(row("grid", &grid));
    if product.features.is_some() {
        rows.push(row("integers", &integers_text(integer.map.certificate())));
    }
    rows.extend(product.features.iter().flat_map(summary::aligned_rows));
    rows.extend(summary::distortion_rows(&integer.distortion));
    rows.extend(quad_rows(&product.extraction, &product.connectivity));
    rows.extend(product.shaped.rows());
    rows.push(summary::cost_row(cost, std::iter::empty()));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}
