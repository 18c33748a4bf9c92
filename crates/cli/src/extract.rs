//! `seamstress extract`.

use crate::args::ExtractArgs;
use crate::faults::listing;
use crate::features::{FeatureSource, Features};
use crate::input::LoadedMesh;
use crate::job::Job;
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, Cost, VERSION};
use crate::shape::{Shaped, Shaping};
use crate::summary;
use crate::text::{self, counted, row};
use seamstress_io::{Format, Polymesh};
use seamstress_quads::extract::{Folds, MapFaults};
use seamstress_quads::{
    ExtractError, ExtractOptions, Extraction, IrregularVertex, QuadConnectivity, QuadFaults,
    extract,
};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// Faults of each kind that are printed.
const SHOWN: usize = 5;

/// The work done, and nothing written yet.
struct Product {
    mesh: LoadedMesh,
    /// The features that keep their vertices, if any were asked for.
    features: Option<Features>,
    extraction: Extraction,
    connectivity: Result<QuadConnectivity, QuadFaults>,
    shaped: Option<Shaped>,
    picture: Option<Vec<u8>>,
}

/// Runs the command.
pub(crate) fn run(args: &ExtractArgs) -> Result<Status, Failure> {
    let job = Job::new(&args.run, &args.map)?;
    let plan = plan(args)?;
    let worker = args.clone();
    let product = job.run(move |_| make(&worker))?;
    finish(args, &job, &plan, &product)?;
    Ok(Status::Done)
}

fn plan(args: &ExtractArgs) -> Result<Plan, Failure> {
    let mut targets = Vec::new();
    targets.extend(args.picture.iter().map(|path| Target::new(Kind::Picture, path)));
    targets.extend(args.report.iter().map(|path| Target::new(Kind::Report, path)));
    targets.push(Target::new(Kind::Quads, &args.output));
    let map: &Path = &args.map;
    let features = args.features.iter().filter_map(FeatureSource::file);
    let inputs: Vec<&Path> = std::iter::once(map).chain(features).collect();
    Plan::new(&inputs, None, targets)
}

fn make(args: &ExtractArgs) -> Result<Product, Failure> {
    let (mesh, corner_uvs) = LoadedMesh::load_map(&args.map)?;
    if !args.run.quiet {
        mesh.tell_findings();
    }
    let source = mesh.connect()?;
    let features = Features::resolve(&args.features, false, &mesh, &source)?;
    let no_quads = |text| Failure::NoQuads { file: args.map.clone(), text };
    let options = ExtractOptions { tolerance: args.tolerance, best_effort: args.best_effort };
    let mut extraction = extract(&source, &mesh.soup.positions, &corner_uvs, &options)
        .map_err(|error| no_quads(explained(&error, options.tolerance)))?;
    if !args.run.quiet {
        tell_losses(&extraction);
    }
    let connectivity = extraction.mesh.connectivity();
    if let (Err(faults), false) = (&connectivity, args.best_effort) {
        return Err(Failure::NoManifold {
            file: args.map.clone(),
            faults: faults.clone(),
            advice: "`--best-effort` writes them all the same",
        });
    }
    // What folds have left holes in is no surface to shape.
    let mut shaped = None;
    if connectivity.is_ok() && extraction.folds.is_none() {
        let shaping = Shaping { raw: args.raw, smooth: args.smooth, features: &features.pairs };
        shaped = Some(shaping.apply(&mesh, &source, &mut extraction)?);
    }
    if let (Some(shaped), false) = (&shaped, args.run.quiet) {
        shaped.tell_faults();
    }
    let picture = args.picture.is_some().then(|| {
        let irregular = connectivity.as_ref().map(QuadConnectivity::irregular_vertices);
        pictures::draw_quads(&extraction.mesh, &irregular.unwrap_or_default())
    });
    let picture = picture
        .transpose()
        .map_err(|cause| Failure::NoPicture { file: args.map.clone(), cause })?;
    let features = (!args.features.is_empty()).then_some(features);
    Ok(Product { mesh, features, extraction, connectivity, shaped, picture })
}

/// An error with the elements it names, and what to do about it.
fn explained(error: &ExtractError, tolerance: f64) -> String {
    match error {
        ExtractError::NotInteger(faults) => explained_faults(faults, tolerance),
        ExtractError::Folds { flipped, collapsed } => {
            let faces = |what: &str, faces: &[u32]| {
                let shown: Vec<String> = faces.iter().take(SHOWN).map(u32::to_string).collect();
                match faces.len() {
                    0 => String::new(),
                    n if n > SHOWN => format!("\n  {n} {what} faces: {} ...", shown.join(", ")),
                    n => {
                        format!("\n  {}: {}", counted(n, &format!("{what} face")), shown.join(", "))
                    }
                }
            };
            format!(
                "the map folds{}{}\n`--best-effort` extracts what it can",
                faces("flipped", flipped),
                faces("collapsed", collapsed)
            )
        }
        other => other.to_string(),
    }
}

fn explained_faults(faults: &MapFaults, tolerance: f64) -> String {
    let lines = listing(&faults.0, SHOWN).join("\n  ");
    let advice = if faults.is_seamless() {
        "The map is seamless, but not an integer map: make it one with `seamstress integer`"
    } else {
        "A map of few digits may need a larger `--tolerance`"
    };
    format!("not an integer map to within {tolerance} grid units:\n  {lines}\n{advice}")
}

/// What the quads lack, on standard error.
pub(crate) fn tell_losses(extraction: &Extraction) {
    if extraction.trimmed > 0 {
        let cells = counted(extraction.trimmed, "cell");
        text::tell(&format!("note: {cells} cut by the boundary left out"));
    }
    if extraction.split_vertices > 0 {
        let vertices = counted(extraction.split_vertices, "vertex");
        text::tell(&format!("note: {vertices} added where quads met in a point only"));
    }
    if let Some(folds) = &extraction.folds {
        text::tell(&format!("warning: {}", folds_text(folds)));
    }
}

fn folds_text(folds: &Folds) -> String {
    format!(
        "the map folds: {} and {} collapsed; {} lost, {} merged",
        counted(folds.flipped.len(), "flipped face"),
        folds.collapsed.len(),
        counted(folds.lost, "cell"),
        counted(folds.merged, "grid point"),
    )
}

/// Writes everything, puts it in place and prints the summary.
fn finish(args: &ExtractArgs, job: &Job, plan: &Plan, product: &Product) -> Result<(), Failure> {
    let cost = job.cost();
    let mut batch = plan.begin()?;
    let mut report = String::new();
    if args.run.json || args.report.is_some() {
        report = report::to_text(&report_json(args, plan, product, cost));
    }
    for target in &plan.targets {
        batch.write(&target.path, |file| match target.kind {
            Kind::Quads => write_quads(file, &args.map, &target.path, &product.extraction),
            Kind::Picture => file.write_all(product.picture.as_deref().unwrap_or_default()),
            _ => writeln!(file, "{report}"),
        })?;
    }
    job.finish(&args.run, batch, || report, || summary_text(plan, product, &cost))
}

/// The quads, in the format of the output's name.
pub(crate) fn write_quads(
    file: &mut impl Write,
    source: &Path,
    output: &Path,
    extraction: &Extraction,
) -> std::io::Result<()> {
    let name = source.file_name().unwrap_or(source.as_os_str());
    let quads = &extraction.mesh;
    let comments = [
        format!("Quad mesh by Seamstress {VERSION}"),
        format!("Source: {}", name.display()),
        counted(quads.quads().len(), "quad"),
    ];
    let mesh =
        Polymesh { positions: quads.positions(), polygons: quads.quads(), comments: &comments };
    mesh.write(file, Format::from_path(output).unwrap_or(Format::Obj))
}

fn summary_text(plan: &Plan, product: &Product, cost: &Cost) -> String {
    let mut rows = summary::mesh_rows(&product.mesh);
    rows.extend(product.features.iter().flat_map(summary::feature_rows));
    rows.extend(quad_rows(&product.extraction, &product.connectivity));
    rows.extend(product.shaped.iter().flat_map(Shaped::rows));
    let mut time = format!("{:.2} s", cost.wall_seconds);
    if let Some(cpu) = cost.cpu_seconds {
        time += &format!(", {cpu:.2} s of CPU");
    }
    rows.push(row("time", &time));
    let names: Vec<String> =
        plan.targets.iter().rev().map(|target| target.path.display().to_string()).collect();
    rows.push(row("written", &names.join(", ")));
    rows.join("\n")
}

pub(crate) fn quad_rows(
    extraction: &Extraction,
    connectivity: &Result<QuadConnectivity, QuadFaults>,
) -> Vec<String> {
    let snapping = &extraction.snapping;
    let mut rows = vec![
        row(
            "map",
            &format!(
                "{:.4} grid cells, {}; made exact by moving UVs by up to {:.1e} grid units",
                extraction.uv_area,
                counted(extraction.cones.len(), "cone"),
                snapping.largest_change
            ),
        ),
        row("quads", &extraction.mesh.quads().len().to_string()),
    ];
    match connectivity {
        Ok(c) => rows.extend(topology_rows(c)),
        Err(faults) => rows.extend(listing(&faults.0, SHOWN).iter().map(|f| row("fault", f))),
    }
    if extraction.trimmed > 0 {
        let text = format!("{} cut by the boundary", counted(extraction.trimmed, "cell"));
        rows.push(row("left out", &text));
    }
    if let Some(folds) = &extraction.folds {
        rows.push(row("folds", &folds_text(folds)));
    }
    rows
}

fn topology_rows(connectivity: &QuadConnectivity) -> [String; 2] {
    let boundary = match connectivity.n_boundary_loops() {
        0 => "closed".into(),
        n => counted(n, "boundary loop"),
    };
    let irregular = connectivity.irregular_vertices();
    let by_valence: Vec<String> = by_valence(&irregular)
        .into_iter()
        .map(|(valence, count)| format!("{count} of valence {valence}"))
        .collect();
    let irregular = match irregular.len() {
        0 => "none".into(),
        n => format!("{n}: {}", by_valence.join(", ")),
    };
    [
        row(
            "manifold",
            &format!(
                "{}, {}, {boundary}, Euler characteristic {}",
                counted(connectivity.n_vertices(), "vertex"),
                counted(connectivity.connected_quads().1, "component"),
                connectivity.euler_characteristic()
            ),
        ),
        row("irregular", &irregular),
    ]
}

fn by_valence(irregular: &[IrregularVertex]) -> BTreeMap<i32, usize> {
    let mut counts = BTreeMap::new();
    for vertex in irregular {
        *counts.entry(4 - vertex.index).or_default() += 1;
    }
    counts
}

fn report_json(args: &ExtractArgs, plan: &Plan, product: &Product, cost: Cost) -> Value {
    let extraction = &product.extraction;
    json!({
        "seamstress": VERSION,
        "command": "extract",
        "options": {
            "raw": args.raw,
            "smooth": args.smooth,
            "tolerance": args.tolerance,
            "best_effort": args.best_effort,
            "features": args.features.iter().map(ToString::to_string).collect::<Vec<_>>(),
        },
        "input": report::input_json(&product.mesh),
        "map": {
            "uv_area": extraction.uv_area,
            "snapping": extraction.snapping,
            "cones": extraction.cones,
            "folds": extraction.folds,
        },
        "features": product.features.as_ref().map(Features::json),
        "quads": quads_json(extraction, &product.connectivity),
        "mended": product.shaped.map(Shaped::mended),
        "orientation": product.shaped.map(Shaped::orientation),
        "files": plan.targets,
        "cost": cost,
    })
}

pub(crate) fn quads_json(
    extraction: &Extraction,
    connectivity: &Result<QuadConnectivity, QuadFaults>,
) -> Value {
    let mut value = json!({
        "count": extraction.mesh.quads().len(),
        "vertices": extraction.mesh.positions().len(),
        "trimmed": extraction.trimmed,
        "split_vertices": extraction.split_vertices,
        "is_manifold": connectivity.is_ok(),
    });
    match connectivity {
        Ok(c) => {
            let irregular = c.irregular_vertices();
            value["edges"] = c.n_edges().into();
            value["euler_characteristic"] = c.euler_characteristic().into();
            value["boundary_loops"] = c.n_boundary_loops().into();
            value["components"] = c.connected_quads().1.into();
            value["irregular"] = json!({
                "count": irregular.len(),
                "by_valence": by_valence(&irregular),
                "list": irregular,
            });
        }
        Err(faults) => value["faults"] = json!(faults),
    }
    value
}
