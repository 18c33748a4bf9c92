//! Verification of a map by a script that shares no code with the program.

use crate::report::Report;
use serde_json::Value;
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;
use std::process::Command;

/// What the script says of a map.
#[derive(Debug)]
pub(crate) struct Verdict {
    /// Triangles that are flipped or collapsed, and the largest seam mismatch in mean edge lengths.
    flips: Option<u64>,
    residual: Option<f64>,
    /// What is wrong.
    fault: Option<String>,
}

impl Verdict {
    /// A cell of the table.
    pub(crate) fn cell(&self) -> String {
        let word = if self.fault.is_some() { "FAIL" } else { "ok" };
        let flips = self.flips.map_or("-".into(), |n| n.to_string());
        let residual = self.residual.map_or("-".into(), |x| format!("{x:.0e}"));
        format!("{word}, {flips} flips, {residual}")
    }

    pub(crate) fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    fn broken(fault: String) -> Self {
        Self { flips: None, residual: None, fault: Some(fault) }
    }

    fn from_json(json: &Value) -> Self {
        let fault = match (&json["ok"], &json["error"]) {
            (Value::Bool(true), _) => None,
            (_, Value::String(error)) => Some(error.clone()),
            _ => Some(complaints(json)),
        };
        Self {
            flips: json["flipped_or_degenerate"].as_u64(),
            residual: json["seam_residual_max"].as_f64(),
            fault,
        }
    }
}

/// The figures that a verdict depends on.
fn complaints(json: &Value) -> String {
    let fields = [
        "source_unchanged",
        "flipped_or_degenerate",
        "nonfinite_uv",
        "seam_residual_max",
        "cone_angles_not_multiple_of_half_pi",
        "poincare_hopf_ok",
    ];
    let parts = fields.map(|field| format!("{field} {}", json[field]));
    parts.join(", ")
}

/// Runs the script. It reads triangles in OBJ and OFF; of other meshes it is given the triangles that
/// the map was made of.
pub(crate) fn verify(
    script: &Path,
    mesh: &Path,
    map: &Path,
    triangulated: &Path,
    report: &Report,
) -> Verdict {
    let mut source = mesh;
    if !is_read_by_the_script(report) {
        if let Err(e) = write_source(map, triangulated) {
            return Verdict::broken(format!("cannot write {}: {e}", triangulated.display()));
        }
        source = triangulated;
    }
    let mut command = Command::new("python3");
    command.arg(script).arg("--strict").arg(source).arg(map);
    match command.output() {
        Err(e) => Verdict::broken(format!("cannot run python3: {e}")),
        Ok(output) => match serde_json::from_slice(&output.stdout) {
            Ok(json) => Verdict::from_json(&json),
            Err(_) => {
                let text = String::from_utf8_lossy(&output.stderr);
                let last = text.lines().last().unwrap_or("no message");
                Verdict::broken(format!("the script failed: {last}"))
            }
        },
    }
}

/// Whether the file itself holds the triangles that were mapped, in a format of the script.
fn is_read_by_the_script(report: &Report) -> bool {
    let has_format = matches!(report.get("/input/format").as_str(), Some("OBJ" | "OFF"));
    let repairs = report.get("/input/repairs").as_array();
    has_format
        && report.get("/input/polygons_read") == report.get("/input/faces")
        && repairs.is_none_or(Vec::is_empty)
}

/// Writes the vertices and faces of a map without its texture coordinates.
fn write_source(map: &Path, source: &Path) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(source)?);
    for line in BufReader::new(File::open(map)?).lines() {
        let line = line?;
        if line.starts_with("v ") {
            writeln!(out, "{line}")?;
        } else if let Some(corners) = line.strip_prefix("f ") {
            let vertices =
                corners.split_whitespace().map(|corner| corner.split('/').next().unwrap_or(corner));
            writeln!(out, "f {}", vertices.collect::<Vec<_>>().join(" "))?;
        }
    }
    out.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::fs;

    #[test]
    fn verdicts() {
        let good = json!({"ok": true, "flipped_or_degenerate": 0, "seam_residual_max": 2e-16});
        let good = Verdict::from_json(&good);
        assert_eq!((good.cell().as_str(), good.fault()), ("ok, 0 flips, 2e-16", None));
        let bad = Verdict::from_json(&json!({"ok": false, "flipped_or_degenerate": 3}));
        assert_eq!(bad.cell(), "FAIL, 3 flips, -");
        assert!(bad.fault().is_some_and(|f| f.contains("flipped_or_degenerate 3")));
        let broken = Verdict::from_json(&json!({"error": "no uv"}));
        assert_eq!(broken.fault(), Some("no uv"));
    }

    #[test]
    fn the_source_of_a_map_is_the_map_without_its_texture() {
        let folder = tempfile::tempdir().unwrap();
        let (map, source) = (folder.path().join("m.obj"), folder.path().join("s.obj"));
        fs::write(&map, "# a map\nv 0 0 0\nvt 0 0\nf 1/1 2/2 3/1\n").unwrap();
        write_source(&map, &source).unwrap();
        assert_eq!(fs::read_to_string(source).unwrap(), "v 0 0 0\nf 1 2 3\n");
    }
}
