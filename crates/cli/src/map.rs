//! `seamstress map`.

use crate::args::{FeatureArgs, MapArgs, Method, Rounding, StartArgs};
use crate::features::{AlignedFeatures, Features};
use crate::input::LoadedMesh;
use crate::job::{Job, Worker};
use crate::made::{self, Made};
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, Cost, MapReport, VERSION};
use crate::start::read_start;
use crate::summary;
use crate::text::row;
use crate::writers::{write_cones, write_map};
use seamstress_mesh::TriMesh;
use seamstress_parametrize::{
    FieldMapOptions, MapError, Start, make_aligned_map, make_field_map, make_map_from,
};
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    made: Made,
    /// What became of the features, if any were asked for.
    features: Option<AlignedFeatures>,
    pictures: Option<[Vec<u8>; 3]>,
}

/// Runs the command.
pub(crate) fn run(args: &MapArgs) -> Result<Status, Failure> {
    let job = Job::new(&args.run, &args.mesh)?;
    if args.start.exact && args.start.method != Method::Field {
        return Err(Failure::Usage("`--exact` goes with `--method field`".into()));
    }
    let plan = plan(args)?;
    let owned = args.clone();
    let product = job.run(move |worker| make(&owned, worker))?;
    finish(args, &job, &plan, &product)?;
    Ok(Status::Done)
}

/// The outputs; the map last, since it says that the rest is there.
fn plan(args: &MapArgs) -> Result<Plan, Failure> {
    if args.start.method == Method::Field && args.features.is_given() {
        let text = "features are aligned by the direct method; leave out `--method field`";
        return Err(Failure::Usage(text.into()));
    }
    if args.rounding == Rounding::MixedInteger && args.features.is_given() {
        let text = "features are aligned by the other ways of rounding; leave out `--rounding \
                    mixed-integer`";
        return Err(Failure::Usage(text.into()));
    }
    let mut targets = Vec::new();
    if let Some(folder) = &args.pictures {
        targets.extend(pictures::NAMES.map(|name| Target::new(Kind::Picture, &folder.join(name))));
    }
    targets.extend(args.sing.iter().map(|path| Target::new(Kind::Cones, path)));
    targets.extend(args.report.iter().map(|path| Target::new(Kind::Report, path)));
    targets.push(Target::new(Kind::Map, &args.output));
    let start = &args.start;
    let given = [&start.field, &start.matching, &start.cones, &start.from];
    let given = given.into_iter().flatten().map(PathBuf::as_path).chain(args.features.files());
    let inputs: Vec<&Path> = given.chain([args.mesh.as_path()]).collect();
    Plan::new(&inputs, args.pictures.as_deref(), targets)
}

/// The part of the command that may take long.
fn make(args: &MapArgs, mut worker: Worker) -> Result<Product, Failure> {
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    if !args.run.quiet {
        mesh.tell_findings();
    }
    let connectivity = mesh.connect()?;
    let solved = solve(args, &mesh, &connectivity, &mut worker);
    let (made, features) = solved.map_err(|failure| match failure {
        Unmade::Failure(failure) => failure,
        Unmade::Cause(cause) => {
            let file = mesh.path.clone();
            match (cause, worker.stop.reason()) {
                (MapError::Cancelled(_), Some(reason)) => Failure::Stopped { file, reason },
                (cause @ (MapError::Field(_) | MapError::Cones(_)), _) => {
                    Failure::BadStart { file, text: cause.to_string() }
                }
                (cause @ MapError::Released { .. }, _) => Failure::Released { file, cause },
                (cause, _) => Failure::NoMap { file, cause },
            }
        }
    })?;
    worker.stop.lift_limit();
    let pictures = match (&args.pictures, made.certified()) {
        (Some(_), Some(map)) => {
            Some(pictures::draw(&mesh.soup, map, features.as_ref(), &args.texture))
        }
        _ => None,
    };
    let pictures = pictures
        .transpose()
        .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
    Ok(Product { mesh, made, features, pictures })
}

/// Why there is no map to write.
enum Unmade {
    Failure(Failure),
    Cause(MapError),
}

impl From<Failure> for Unmade {
    fn from(failure: Failure) -> Self {
        Self::Failure(failure)
    }
}

impl From<MapError> for Unmade {
    fn from(cause: MapError) -> Self {
        Self::Cause(cause)
    }
}

/// The map by the method asked for, and its features if any were.
fn solve(
    args: &MapArgs,
    mesh: &LoadedMesh,
    connectivity: &TriMesh,
    worker: &mut Worker,
) -> Result<(Made, Option<AlignedFeatures>), Unmade> {
    let positions = &mesh.soup.positions;
    let mut observe = |progress| worker.observe(progress);
    if !args.start.is_baseline() {
        let start = read_start(&args.start, connectivity, positions)?;
        let options = args.options();
        if !matches!(start, Start::Mesh) {
            let solution = make_map_from(connectivity, positions, &start, &options, &mut observe)?;
            return Ok((Made::from(solution), None));
        }
        let FeatureArgs { features: sources, align_boundary } = &args.features;
        let asked = Features::resolve(sources, *align_boundary, mesh, connectivity)?;
        let solution =
            make_aligned_map(connectivity, positions, &asked.edges, &options, &mut observe)?;
        let certify =
            || AlignedFeatures::certify(connectivity, asked, &solution.map, &solution.released);
        let features = args.features.is_given().then(certify).transpose();
        let features =
            features.map_err(|cause| Failure::Misaligned { file: mesh.path.clone(), cause })?;
        return Ok((Made::from(solution), features));
    }
    let options =
        FieldMapOptions { iterations: args.start.local_global, ..FieldMapOptions::default() };
    let made = Made::from(make_field_map(connectivity, positions, &options, &mut observe)?);
    match made.violations() {
        Some(violations) if !args.start.allow_flips => {
            let file = mesh.path.clone();
            Err(Failure::Uncertified { file, text: made::named(violations) }.into())
        }
        _ => Ok((made, None)),
    }
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
            Kind::Cones => write_cones(file, product.made.cones()),
            Kind::Report => writeln!(file, "{report}"),
            Kind::Picture => file.write_all(pictures.next().map_or(&[], Vec::as_slice)),
            _ => write_map(file, &product.mesh, &product.made.written()),
        })?;
    }
    job.finish(&args.run, batch, || report, || summary_text(plan, product, &cost))
}

fn report_text(args: &MapArgs, plan: &Plan, product: &Product, cost: Cost) -> String {
    report::to_text(&MapReport {
        seamstress: VERSION,
        command: "map",
        options: json!({
            "repair": args.repair,
            "cone_bias": args.method.cone_bias,
            "cone_price": args.method.cone_price,
            "features": report::sources_json(&args.features),
            "align_boundary": args.features.align_boundary,
            "features_strict": args.features_strict,
            "corner_weight": args.corner_weight,
            "rounding": args.options().rounding.strategy,
            "batch": args.batch,
            "nodes": args.nodes,
            "rounding_time": args.rounding_time.map(|limit| limit.as_secs_f64()),
            "start": start_json(&args.start),
            "tau_polish": !args.no_tau_polish,
            "polish_time": args.polish_time.map(|limit| limit.as_secs_f64()),
            "max_energy_rise": args.max_energy_rise,
            "objective": args.objective,
            "time_limit": args.run.time_limit.map(|limit| limit.as_secs_f64()),
            "threads": args.run.threads,
        }),
        input: report::input_json(&product.mesh),
        components: &product.made.components,
        map: product.made.json(),
        features: product.features.as_ref().map(AlignedFeatures::json),
        files: &plan.targets,
        cost,
    })
}

fn start_json(start: &StartArgs) -> serde_json::Value {
    let name =
        |path: &Option<PathBuf>| path.as_ref().map(|path| path.to_string_lossy().into_owned());
    json!({
        "method": match start.method { Method::Direct => "direct", Method::Field => "field" },
        "exact": start.exact,
        "local_global": start.local_global,
        "field": name(&start.field),
        "matching": name(&start.matching),
        "cones": name(&start.cones),
        "free_cones": start.free_cones,
    })
}

fn summary_text(plan: &Plan, product: &Product, cost: &Cost) -> String {
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.extend(product.features.iter().flat_map(|f| summary::feature_rows(&f.asked)));
    rows.extend(product.made.rows());
    rows.extend(summary::mixed_integer_rows(&product.made.components));
    rows.extend(product.features.iter().flat_map(summary::aligned_rows));
    rows.push(summary::cost_row(cost, summary::stages(&product.made.components)));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}
