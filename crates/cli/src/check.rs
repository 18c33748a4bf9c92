//! `seamstress check`.

use crate::args::CheckArgs;
use crate::faults::{fault_json, listing, violation_json};
use crate::input::LoadedMesh;
use crate::map_file::MapFile;
use crate::outcome::{Failure, Status};
use crate::report::{self, VERSION};
use crate::summary;
use crate::text::{self, counted, figure, row};
use seamstress::map::compare_source;
use seamstress::quality::{Distortion, distortion};
use seamstress::{SeamlessMap, Tolerance, Violation, Violations};
use seamstress_surface::soup::TriangleSoup;
use seamstress_surface::{Metric, TriMesh};
use serde_json::{Value, json};
use std::path::Path;

/// Faults or violations of each kind that are printed.
const SHOWN: usize = 20;

/// Runs the command.
pub(crate) fn run(args: &CheckArgs) -> Result<Status, Failure> {
    let mesh = LoadedMesh::load(&args.mesh, args.repair)?;
    match &args.map {
        None => check_mesh(args, &mesh),
        Some(path) => check_map(args, &mesh, path),
    }
}

fn check_mesh(args: &CheckArgs, mesh: &LoadedMesh) -> Result<Status, Failure> {
    let is_mesh = mesh.errors().next().is_none();
    if args.json {
        let mut value = json_base(args, mesh);
        value["faults"] = mesh.faults.iter().map(fault_json).collect();
        value["is_mesh"] = is_mesh.into();
        value["is_repairable"] = mesh.is_repairable.into();
        text::print(&report::to_text(&value))?;
    } else {
        let mut rows = summary::mesh_rows(mesh);
        rows.extend(shape_row(mesh));
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
        "options": { "repair": args.repair, "tolerance": args.tolerance().seam },
        "input": report::input_json(mesh),
    })
}

fn check_map(args: &CheckArgs, mesh: &LoadedMesh, path: &Path) -> Result<Status, Failure> {
    let connectivity = mesh.connect()?;
    let map = MapFile::read(path)?;
    let verdict = judge(&mesh.soup, &connectivity, map, &args.tolerance());
    let is_certified = verdict.certified.is_ok();
    if args.json {
        let mut value = json_base(args, mesh);
        value["map"] = verdict.json(path);
        text::print(&report::to_text(&value))?;
    } else {
        let mut rows = summary::mesh_rows(mesh);
        rows.push(row("map", &path.display().to_string()));
        rows.extend(verdict.rows());
        text::print(&rows.join("\n"))?;
    }
    Ok(if is_certified { Status::Done } else { Status::BadInput })
}

/// What is to say about a map.
struct Verdict {
    certified: Result<SeamlessMap, Violations>,
    /// Of maps whose faces are those of the mesh.
    distortion: Option<Distortion>,
}

fn judge(
    mesh: &TriangleSoup,
    connectivity: &TriMesh,
    map: MapFile,
    tolerance: &Tolerance,
) -> Verdict {
    let mut violations =
        compare_source((&mesh.positions, &mesh.faces), (&map.soup.positions, &map.soup.faces));
    if mesh.faces != map.soup.faces {
        return Verdict { certified: Err(Violations(violations)), distortion: None };
    }
    let metric = Metric::from_positions(connectivity, &mesh.positions);
    let distortion = Some(distortion(connectivity, &metric, &map.corner_uvs));
    let certified = match SeamlessMap::certify(connectivity, map.corner_uvs, tolerance) {
        Ok(map) if violations.is_empty() => Ok(map),
        Ok(_) => Err(Violations(violations)),
        Err(Violations(more)) => {
            violations.extend(more);
            Err(Violations(violations))
        }
    };
    Verdict { certified, distortion }
}

impl Verdict {
    fn json(&self, path: &Path) -> Value {
        let mut value = match (&self.certified, &self.distortion) {
            (Ok(map), Some(distortion)) => report::map_json(map, distortion),
            (_, Some(distortion)) => json!({ "distortion": report::distortion_json(distortion) }),
            (_, None) => json!({}),
        };
        let violations: &[Violation] = match &self.certified {
            Ok(_) => &[],
            Err(Violations(violations)) => violations,
        };
        value["file"] = path.to_string_lossy().into();
        value["certified"] = self.certified.is_ok().into();
        value["violations"] = violations.iter().map(violation_json).collect();
        value
    }

    fn rows(&self) -> Vec<String> {
        match (&self.certified, &self.distortion) {
            (Ok(map), Some(distortion)) => summary::map_rows(map, distortion),
            (Ok(_), None) => Vec::new(),
            (Err(Violations(violations)), distortion) => {
                let mut rows = Vec::new();
                rows.extend(distortion.iter().flat_map(summary::distortion_rows));
                let lines = listing(violations, SHOWN);
                rows.extend(lines.iter().map(|line| row("violation", line)));
                rows.extend(tolerance_row(violations));
                let count = counted(violations.len(), "violation");
                let text = format!("failed: {count} (elements counted from 0)");
                rows.push(row("certificate", &text));
                rows
            }
        }
    }
}

/// How far the worst seam is open, and what that may come from.
fn tolerance_row(violations: &[Violation]) -> Option<String> {
    let residuals = violations.iter().filter_map(|violation| match violation {
        Violation::OpenSeam { residual, .. } => Some(*residual),
        _ => None,
    });
    let worst = residuals.max_by(f64::total_cmp)?;
    let text = format!(
        "open by up to {worst:.1e} mean edge lengths; maps written with few digits need `--tolerance`"
    );
    Some(row("seams", &text))
}
