//! `seamstress quad`.

use crate::args::QuadArgs;
use crate::extract::{quad_rows, quads_json, smoothed, tell_losses, write_quads};
use crate::features::AlignedFeatures;
use crate::input::LoadedMesh;
use crate::integer::{grid_json, grid_text, integers_text, make_integer, make_seamless};
use crate::job::{Job, Worker};
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, Cost, VERSION};
use crate::summary;
use crate::text::{self, row};
use seamstress::{IntegerOptions, IntegerSolution};
use seamstress_quads::{ExtractOptions, Extraction, QuadConnectivity, QuadFaults, extract};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    integer: IntegerSolution,
    /// The features that edges of quads follow, if any were asked for.
    features: Option<AlignedFeatures>,
    extraction: Extraction,
    connectivity: Result<QuadConnectivity, QuadFaults>,
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
    let start = make_seamless(&args.method, &args.features, &mesh, &source, &mut worker)?;

    let options = IntegerOptions { size: args.size.grid(), ..IntegerOptions::default() };
    let advice = "try more quads, or fewer cones with a larger `--cone-bias`";
    let integer = make_integer(&start, &options, advice, &mesh, &source, &mut worker)?;
    worker.stop.lift_limit();

    let no_quads = |text| Failure::NoQuads { file: mesh.path.clone(), text };
    let mut extraction =
        extract(&source, positions, integer.map.corner_uvs(), &ExtractOptions::default())
            .map_err(|error| no_quads(error.to_string()))?;
    if !args.run.quiet {
        tell_losses(&extraction);
    }
    let connectivity = extraction.mesh.connectivity();
    if let Err(faults) = &connectivity {
        return Err(Failure::Internal {
            file: mesh.path.clone(),
            text: format!("the quads are no manifold: {faults}"),
        });
    }
    if args.smooth > 0 {
        extraction.mesh = smoothed(args.smooth, &mesh, &extraction.mesh)?;
    }
    let picture = args.picture.is_some().then(|| {
        let irregular = connectivity.as_ref().map(QuadConnectivity::irregular_vertices);
        pictures::draw_quads(&extraction.mesh, &irregular.unwrap_or_default())
    });
    let picture = picture
        .transpose()
        .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
    Ok(Product { mesh, integer, features: start.features, extraction, connectivity, picture })
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
    job.still_wanted()?;
    batch.commit()?;
    if args.run.json {
        text::print(&report)?;
    } else if !args.run.quiet {
        text::print(&summary_text(args, plan, product, &cost))?;
    }
    Ok(())
}

fn report_json(args: &QuadArgs, plan: &Plan, product: &Product, cost: Cost) -> Value {
    let integer = &product.integer;
    json!({
        "seamstress": VERSION,
        "command": "quad",
        "options": {
            "size": args.size.grid(),
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
        "quads": quads_json(&product.extraction, &product.connectivity),
        "files": plan.targets,
        "cost": cost,
    })
}

fn summary_text(args: &QuadArgs, plan: &Plan, product: &Product, cost: &Cost) -> String {
    let integer = &product.integer;
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.extend(product.features.iter().flat_map(|f| summary::feature_rows(&f.asked)));
    rows.push(row("grid", &grid_text(args.size.grid(), integer)));
    if product.features.is_some() {
        rows.push(row("integers", &integers_text(integer.map.certificate())));
    }
    rows.extend(product.features.iter().flat_map(summary::aligned_rows));
    rows.extend(summary::distortion_rows(&integer.distortion));
    rows.extend(quad_rows(&product.extraction, &product.connectivity));
    rows.push(summary::cost_row(cost, std::iter::empty()));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}
