//! Verification of aligned maps by a script that shares no code with the program.

use seamstress_bench::meshes::Mesh;
use seamstress_parametrize::MapSolution;
use serde_json::Value;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Maps meshes with the command and has the maps checked.
#[derive(Debug)]
pub(crate) struct Verifier {
    /// The command `seamstress`.
    pub(crate) seamstress: PathBuf,
    /// The script.
    pub(crate) script: PathBuf,
    /// Folder of the maps, their sources and their features.
    pub(crate) folder: PathBuf,
}

impl Verifier {
    /// Maps a mesh with the features that `arguments` ask for and runs the script on the map that is
    /// written, with the features that the solution keeps. Gives a cell of the table.
    ///
    /// # Errors
    /// If the command or the script fails, or the map does not pass.
    pub(crate) fn verify(
        &self,
        path: &Path,
        mesh: &Mesh,
        arguments: &[String],
        solution: &MapSolution,
    ) -> Result<String, Box<dyn Error>> {
        let stem = path.file_stem().unwrap_or_default();
        let file = |extension| self.folder.join(stem).with_extension(extension);
        let (map, source, pairs) = (file("map.obj"), file("obj"), file("pairs"));
        let mut command = Command::new(&self.seamstress);
        let made = command.arg("map").arg(path).arg("-o").arg(&map).args(arguments).output()?;
        if !made.status.success() {
            return Err(format!("seamstress: {}", String::from_utf8_lossy(&made.stderr)).into());
        }
        write_source(&source, mesh)?;
        let kept = solution.features.vertex_pairs(&mesh.connectivity);
        fs::write(&pairs, kept.iter().map(|[a, b]| format!("{a} {b}\n")).collect::<String>())?;
        let mut script = Command::new("python3");
        script.arg(&self.script).arg("--strict").arg(&source).arg(&map);
        let output = script.arg("--features").arg(&pairs).output()?;
        let verdict: Value = serde_json::from_slice(&output.stdout)
            .map_err(|_| String::from_utf8_lossy(&output.stderr).into_owned())?;
        cell(&verdict, kept.len())
    }
}

/// Most degrees that a feature may be off an axis.
const TOLERANCE: f64 = 1e-9;

/// Flips and the largest angle between a feature and the nearer axis.
fn cell(verdict: &Value, kept: usize) -> Result<String, Box<dyn Error>> {
    let features = &verdict["features"];
    let is_good = verdict["ok"] == true
        && features["edges"].as_u64() == Some(kept as u64)
        && features["not_in_mesh"] == 0;
    let flips = &verdict["flipped_or_degenerate"];
    match features["max_axis_deviation_deg"].as_f64() {
        Some(degrees) if is_good && degrees <= TOLERANCE => {
            Ok(format!("{flips} flips, {degrees:.0e}"))
        }
        _ => Err(format!("not verified: {verdict}").into()),
    }
}

/// Writes the triangles that were mapped.
fn write_source(file: &Path, mesh: &Mesh) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        writeln!(text, "v {x:?} {y:?} {z:?}")?;
    }
    for f in mesh.connectivity.faces() {
        let [a, b, c] = f.halfedges().map(|h| mesh.connectivity.origin(h).0 + 1);
        writeln!(text, "f {a} {b} {c}")?;
    }
    Ok(fs::write(file, text)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn verdicts() {
        let verdict = |ok: bool, degrees: f64, not_in_mesh: u32| {
            let features = json!({
                "edges": 3,
                "max_axis_deviation_deg": degrees,
                "not_in_mesh": not_in_mesh,
            });
            json!({ "ok": ok, "flipped_or_degenerate": 0, "features": features })
        };
        assert_eq!(cell(&verdict(true, 2e-12, 0), 3).unwrap(), "0 flips, 2e-12");
        for (bad, kept) in [
            (verdict(false, 2e-12, 0), 3),
            (verdict(true, 2e-8, 0), 3),
            (verdict(true, 2e-12, 1), 3),
            (verdict(true, 2e-12, 0), 4),
            (json!({ "error": "no uv" }), 3),
        ] {
            assert!(cell(&bad, kept).is_err());
        }
    }
}
