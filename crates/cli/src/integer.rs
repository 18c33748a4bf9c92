//! `seamstress integer`.

use crate::args::{ConeArgs, FeatureArgs, GridRounding, IntegerArgs};
use crate::features::{AlignedFeatures, Features, edges_of};
use crate::input::LoadedMesh;
use crate::job::{Job, Worker};
use crate::map_file::MapFile;
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, Cost, VERSION};
use crate::summary;
use crate::text::{counted, figure, row};
use seamstress_io::{MapObj, write_map_obj};
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::map::compare_source;
use seamstress_parametrize::{MapError, MapOptions, SeamlessMap, Violations, make_aligned_map};
use seamstress_quantize::{
    GridSize, IntegerError, IntegerOptions, IntegerSolution, to_aligned_integer_map,
};
use seamstress_quantize::{IntegerCertificate, IntegerStats};
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    solution: IntegerSolution,
    /// The features that lie on lines of the grid, if any were asked for.
    features: Option<AlignedFeatures>,
    pictures: Option<[Vec<u8>; 3]>,
}

/// Runs the command.
pub(crate) fn run(args: &IntegerArgs) -> Result<Status, Failure> {
    let job = Job::new(&args.run, &args.mesh)?;
    let plan = plan(args)?;
    let owned = args.clone();
    let product = job.run(move |worker| make(&owned, worker))?;
    finish(args, &job, &plan, &product)?;
    Ok(Status::Done)
}

/// The outputs; the map last, since it says that the rest is there.
fn plan(args: &IntegerArgs) -> Result<Plan, Failure> {
    let mut targets = Vec::new();
    if let Some(folder) = &args.pictures {
        targets.extend(pictures::NAMES.map(|name| Target::new(Kind::Picture, &folder.join(name))));
    }
    targets.extend(args.report.iter().map(|path| Target::new(Kind::Report, path)));
    targets.push(Target::new(Kind::Map, &args.output));
    let given = std::iter::once(&args.mesh).chain(&args.map).map(AsRef::as_ref);
    let inputs: Vec<&Path> = given.chain(args.features.files()).collect();
    Plan::new(&inputs, args.pictures.as_deref(), targets)
}

/// The part of the command that may take long.
fn make(args: &IntegerArgs, mut worker: Worker) -> Result<Product, Failure> {
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    if !args.run.quiet {
        mesh.tell_findings();
    }
    let connectivity = mesh.connect()?;
    let start = match &args.map {
        Some(path) => read_map(args, path, &mesh, &connectivity)?,
        None => {
            let size = args.size.grid();
            make_seamless(&args.method, size, &args.features, &mesh, &connectivity, &mut worker)?
        }
    };
    let solution =
        make_integer(&start, &args.options(), advice(args), &mesh, &connectivity, &mut worker)?;
    worker.stop.lift_limit();
    // One check per quad, unless told otherwise.
    let texture = args.texture.or_period(1.0);
    let pictures = match &args.pictures {
        Some(_) => Some(pictures::draw(
            &mesh.soup,
            solution.map.seamless(),
            start.features.as_ref(),
            &texture,
        )),
        None => None,
    };
    let pictures = pictures
        .transpose()
        .map_err(|cause| Failure::NoPicture { file: mesh.path.clone(), cause })?;
    Ok(Product { mesh, solution, features: start.features, pictures })
}

/// What an integer map is made from.
pub(crate) struct SeamlessStart {
    pub(crate) map: SeamlessMap,
    pub(crate) features: Option<AlignedFeatures>,
}

/// Rounds a seamless map, its aligned features to lines of the grid.
pub(crate) fn make_integer(
    start: &SeamlessStart,
    options: &IntegerOptions,
    advice: &'static str,
    mesh: &LoadedMesh,
    connectivity: &TriMesh,
    worker: &mut Worker,
) -> Result<IntegerSolution, Failure> {
    let kept: &[[u32; 2]] = start.features.as_ref().map_or(&[], |features| &features.kept);
    let (aligned, positions) = (edges_of(connectivity, kept), &mesh.soup.positions);
    let mut observe = |progress| worker.observe(progress);
    let made = to_aligned_integer_map(
        connectivity,
        positions,
        &start.map,
        &aligned,
        options,
        &mut observe,
    );
    made.map_err(|cause| {
        let file = mesh.path.clone();
        match (cause, worker.stop.reason()) {
            (IntegerError::Cancelled(_), Some(reason)) => Failure::Stopped { file, reason },
            (cause, _) => Failure::NoIntegerMap { file, cause, advice },
        }
    })
}

fn advice(args: &IntegerArgs) -> &'static str {
    match args.rounding {
        GridRounding::Constrained => "try a finer grid, or fewer cones with a larger `--cone-bias`",
        GridRounding::Greedy => {
            "greedy rounding is for comparison; leave out `--rounding greedy`, or try a finer grid"
        }
    }
}

/// The seamless map in a file, which must be one of this mesh, with the features that it aligns.
fn read_map(
    args: &IntegerArgs,
    path: &Path,
    mesh: &LoadedMesh,
    connectivity: &TriMesh,
) -> Result<SeamlessStart, Failure> {
    let map = MapFile::read(path)?;
    let bad = |violations: Violations| Failure::BadMap {
        file: path.to_owned(),
        text: format!("not a seamless map of {}: {violations}", mesh.path.display()),
    };
    let soup = &mesh.soup;
    let differences =
        compare_source((&soup.positions, &soup.faces), (&map.soup.positions, &map.soup.faces));
    if !differences.is_empty() {
        return Err(bad(Violations(differences)));
    }
    let map = SeamlessMap::certify(connectivity, map.corner_uvs, &args.options().tolerance)
        .map_err(bad)?;
    if !args.features.is_given() {
        return Ok(SeamlessStart { map, features: None });
    }
    let FeatureArgs { features: sources, align_boundary } = &args.features;
    let asked = Features::resolve(sources, *align_boundary, mesh, connectivity)?;
    let asked = asked.aligned_in(&map, mesh, connectivity);
    let features = AlignedFeatures::certify(connectivity, asked, &map, &[])
        .map_err(|cause| Failure::Misaligned { file: path.to_owned(), cause })?;
    Ok(SeamlessStart { map, features: Some(features) })
}

/// The seamless map to start from, by the direct method, its cones those of a grid of a size.
pub(crate) fn make_seamless(
    cones: &ConeArgs,
    size: GridSize,
    features: &FeatureArgs,
    mesh: &LoadedMesh,
    connectivity: &TriMesh,
    worker: &mut Worker,
) -> Result<SeamlessStart, Failure> {
    let positions = &mesh.soup.positions;
    let side = Metric::from_positions(connectivity, positions).side();
    let options = MapOptions { cell: Some(size.cell(side)), ..cones.options() };
    let FeatureArgs { features: sources, align_boundary } = features;
    let asked = Features::resolve(sources, *align_boundary, mesh, connectivity)?;
    let mut observe = |progress| worker.observe(progress);
    let made = make_aligned_map(connectivity, positions, &asked.edges, &options, &mut observe);
    let solution = made.map_err(|cause| {
        let file = mesh.path.clone();
        match (cause, worker.stop.reason()) {
            (MapError::Cancelled(_), Some(reason)) => Failure::Stopped { file, reason },
            (cause, _) => Failure::NoMap { file, cause },
        }
    })?;
    let certify =
        || AlignedFeatures::certify(connectivity, asked, &solution.map, &solution.released);
    let features = features.is_given().then(certify).transpose();
    let features =
        features.map_err(|cause| Failure::Misaligned { file: mesh.path.clone(), cause })?;
    Ok(SeamlessStart { map: solution.map, features })
}

/// Writes everything, puts it in place and prints the summary.
fn finish(args: &IntegerArgs, job: &Job, plan: &Plan, product: &Product) -> Result<(), Failure> {
    let mut batch = plan.begin()?;
    let cost = job.cost();
    let mut pictures = product.pictures.iter().flatten();
    let report = report::to_text(&report_json(args, plan, product, cost));
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Report => writeln!(file, "{report}"),
            Kind::Picture => file.write_all(pictures.next().map_or(&[], Vec::as_slice)),
            _ => write_map(file, args, product),
        })?;
    }
    job.finish(&args.run, batch, || report, || summary_text(args, plan, product, &cost))
}

fn report_json(args: &IntegerArgs, plan: &Plan, product: &Product, cost: Cost) -> Value {
    let solution = &product.solution;
    let options = args.options();
    let mut value = json!({
        "seamstress": VERSION,
        "command": "integer",
        "options": {
            "size": options.size,
            "rounding": options.rounding,
            "repair": args.repair,
            "cone_bias": args.method.cone_bias,
            "cone_price": args.method.cone_price,
            "features": report::sources_json(&args.features),
            "align_boundary": args.features.align_boundary,
            "tolerance": options.tolerance.seam,
            "time_limit": args.run.time_limit.map(|limit| limit.as_secs_f64()),
            "threads": args.run.threads,
        },
        "input": report::input_json(&product.mesh),
        "seamless_map": args.map.as_ref().map(|path| path.to_string_lossy()),
        "grid": grid_json(options.size, solution),
        "components": solution.components,
        "features": product.features.as_ref().map(AlignedFeatures::json),
        "distortion_before": report::distortion_json(&solution.before),
        "integer_certificate": solution.map.certificate(),
        "files": plan.targets,
        "cost": cost,
    });
    let map = report::map_json(solution.map.seamless(), &solution.distortion);
    if let (Value::Object(all), Value::Object(map)) = (&mut value, map) {
        all.extend(map);
    }
    value
}

fn write_map(file: &mut impl Write, args: &IntegerArgs, product: &Product) -> std::io::Result<()> {
    let solution = &product.solution;
    let name = args.mesh.file_name().unwrap_or(args.mesh.as_os_str());
    let comments = [
        format!("Integer map by Seamstress {VERSION}: one quad per unit square"),
        format!("Source: {}", name.display()),
        grid_text(args.size.grid(), solution),
    ];
    let map = MapObj {
        positions: &product.mesh.soup.positions,
        faces: &product.mesh.soup.faces,
        corner_uvs: solution.map.corner_uvs(),
        comments: &comments,
    };
    write_map_obj(file, &map)
}

/// The grid asked for and the one made.
pub(crate) fn grid_json(requested: GridSize, solution: &IntegerSolution) -> Value {
    json!({
        "requested": requested,
        "quads": solution.quads(),
        "edge_length": solution.cell,
        "scale": 1.0 / solution.cell,
        "refinements": solution.refinements(),
        "sizes_tried": solution.sizes_tried,
    })
}

/// What was asked for, and what came out.
pub(crate) fn grid_text(requested: GridSize, solution: &IntegerSolution) -> String {
    let asked = match requested {
        GridSize::Quads(quads) => format!("{quads} quads"),
        GridSize::EdgeLength(length) => format!("edge length {}", figure(length)),
        GridSize::Scale(scale) => format!("scale {}", figure(scale)),
    };
    let mut text = format!("{:.1} quads, asked for {asked}", solution.quads());
    if solution.refinements() > 0 {
        text +=
            &format!("; {} finer where cones are close", counted(solution.refinements(), "time"));
    }
    text
}

/// What is integral.
pub(crate) fn integers_text(certificate: &IntegerCertificate) -> String {
    let mut text = format!(
        "exact across {}, at {}",
        counted(certificate.exact_edges, "edge"),
        counted(certificate.integral_cones, "cone")
    );
    if certificate.isoline_edges > 0 {
        text += &format!(
            ", {} and {}",
            counted(certificate.integral_corners, "corner"),
            counted(certificate.isoline_edges, "aligned edge")
        );
    }
    text
}

fn summary_text(args: &IntegerArgs, plan: &Plan, product: &Product, cost: &Cost) -> String {
    let solution = &product.solution;
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.extend(product.features.iter().flat_map(|f| summary::feature_rows(&f.asked)));
    rows.push(row("grid", &grid_text(args.size.grid(), solution)));
    rows.extend(summary::map_rows(solution.map.seamless(), &solution.distortion));
    let before = &solution.before;
    rows.push(row(
        "seamless map",
        &format!(
            "tau {}, symmetric Dirichlet {}",
            figure(report::tau(before)),
            figure(before.symmetric_dirichlet)
        ),
    ));
    rows.push(row("integers", &integers_text(solution.map.certificate())));
    rows.extend(product.features.iter().flat_map(summary::aligned_rows));
    let sum = |part: fn(&IntegerStats) -> f64| solution.components.iter().map(part).sum::<f64>();
    let parts = [
        ("reduction", sum(|c| c.seconds_reduction)),
        ("rounding", sum(|c| c.seconds_rounding)),
        ("way", sum(|c| c.seconds_moving)),
        ("polish", sum(|c| c.seconds_polish)),
    ];
    rows.push(summary::cost_row(cost, parts.into_iter()));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}
