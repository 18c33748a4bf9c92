//! `seamstress check`.

use crate::args::CheckArgs;
use crate::faults::{fault_json, listing};
use crate::features::Features;
use crate::input::LoadedMesh;
use crate::map_file::MapFile;
use crate::outcome::{Failure, Status};
use crate::output::{Kind, Plan, Target};
use crate::pictures;
use crate::report::{self, VERSION};
use crate::summary;
use crate::text::{self, counted, figure, row};
use crate::verdict;
use seamstress_mesh::TriMesh;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// Faults of each kind that are printed.
const SHOWN: usize = 20;

/// Runs the command.
pub(crate) fn run(args: &CheckArgs) -> Result<Status, Failure> {
    let mut inputs = vec![args.mesh.as_path()];
    inputs.extend(args.features.files());
    let picture = args.picture.iter().map(|path| Target::new(Kind::Picture, path));
    let plan = Plan::new(&inputs, None, picture.collect())?;
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    match &args.map {
        None => check_mesh(args, &plan, &mesh),
        Some(path) => check_map(args, &mesh, path),
    }
}

fn check_mesh(args: &CheckArgs, plan: &Plan, mesh: &LoadedMesh) -> Result<Status, Failure> {
    let is_mesh = mesh.errors().next().is_none();
    let features = if is_mesh { features(args, mesh, &mesh.connect()?)? } else { None };
    if is_mesh {
        draw(plan, mesh, features.as_ref())?;
    }
    if args.json {
        let mut value = json_base(args, mesh);
        value["faults"] = mesh.faults.iter().map(fault_json).collect();
        value["is_mesh"] = is_mesh.into();
        value["is_repairable"] = mesh.is_repairable.into();
        if let Some(features) = &features {
            value["features"] = features.json();
        }
        text::print(&report::to_text(&value))?;
    } else {
        let mut rows = summary::mesh_rows(mesh);
        rows.extend(shape_row(mesh));
        rows.extend(features.iter().flat_map(summary::feature_rows));
        rows.extend(mesh.notes.iter().map(|note| row("note", note)));
        rows.extend(mesh.repairs.iter().map(|repair| row("repair", repair)));
        let warnings = listing(mesh.warnings(), SHOWN);
        rows.extend(warnings.iter().map(|warning| row("warning", warning)));
        let errors = listing(mesh.errors(), SHOWN);
        rows.extend(errors.iter().map(|error| row("fault", error)));
        rows.push(row("verdict", &verdict(mesh)));
        text::print(&rows.join("\n"))?;
    }
    Ok(if is_mesh { Status::Done } else { Status::BadInput })
}

/// The features, if any are asked for.
fn features(
    args: &CheckArgs,
    mesh: &LoadedMesh,
    connectivity: &TriMesh,
) -> Result<Option<Features>, Failure> {
    let asked = &args.features;
    let resolve = || Features::resolve(&asked.features, asked.align_boundary, mesh, connectivity);
    asked.is_given().then(resolve).transpose()
}

/// Writes the picture, if one is asked for.
fn draw(plan: &Plan, mesh: &LoadedMesh, features: Option<&Features>) -> Result<(), Failure> {
    let mut batch = plan.begin()?;
    for target in &plan.targets {
        let picture = pictures::draw_features(&mesh.soup, features)
            .map_err(|cause| Failure::Undrawable { file: mesh.path.clone(), cause })?;
        batch.write(&target.path, |file| file.write_all(&picture))?;
    }
    batch.commit()
}

fn shape_row(mesh: &LoadedMesh) -> Option<String> {
    let facts = &mesh.facts;
    let (shortest, longest) = (facts.min_edge_length?, facts.max_edge_length?);
    let mut text = format!("edges of {} to {}", figure(shortest), figure(longest));
    if let Some(angle) = facts.min_angle {
        text += &format!(", smallest angle {} degrees", figure(angle.to_degrees()));
    }
    Some(row("shape", &text))
}

fn verdict(mesh: &LoadedMesh) -> String {
    let warnings = mesh.warnings().count();
    let mut text = match (mesh.errors().count(), mesh.is_repairable) {
        (0, _) => "a mesh that can be mapped".into(),
        (n, true) => format!("not a mesh; `--repair` can mend its {}", counted(n, "fault")),
        (n, false) => format!("not a mesh: {}", counted(n, "fault")),
    };
    if warnings > 0 {
        text += &format!(", {}", counted(warnings, "warning"));
    }
    if !mesh.faults.is_empty() {
        text += " (elements counted from 0)";
    }
    text
}

fn json_base(args: &CheckArgs, mesh: &LoadedMesh) -> Value {
    json!({
        "seamstress": VERSION,
        "command": "check",
        "options": {
            "repair": args.repair,
            "tolerance": args.tolerance().seam,
            "features": report::sources_json(&args.features),
            "align_boundary": args.features.align_boundary,
            "alignment_tolerance": args.alignment_tolerance().axis,
        },
        "input": report::input_json(mesh),
    })
}

fn check_map(args: &CheckArgs, mesh: &LoadedMesh, path: &Path) -> Result<Status, Failure> {
    let connectivity = mesh.connect()?;
    let features = features(args, mesh, &connectivity)?;
    let map = MapFile::read(path)?;
    let mut verdict = verdict::judge(&mesh.soup, &connectivity, map, &args.tolerance());
    if let Some(features) = &features {
        verdict = verdict.with_features(&connectivity, features, &args.alignment_tolerance());
    }
    if args.json {
        let mut value = json_base(args, mesh);
        if let Some(features) = &features {
            value["features"] = features.json();
        }
        value["map"] = verdict.json(path);
        text::print(&report::to_text(&value))?;
    } else {
        let mut rows = summary::mesh_rows(mesh);
        rows.extend(features.iter().flat_map(summary::feature_rows));
        rows.push(row("map", &path.display().to_string()));
        rows.extend(verdict.rows());
        text::print(&rows.join("\n"))?;
    }
    Ok(if verdict.is_passed() { Status::Done } else { Status::BadInput })
}
