//! Verification of maps, and judgement of quads, by scripts that share no code with the program.

use crate::map_files::{write_map, write_mesh};
use crate::meshes::Mesh;
use serde_json::Value;
use std::error::Error;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A Python script, called as `python3 SCRIPT --strict SOURCE MAP`, that prints a JSON object with `ok`,
/// `flipped_or_degenerate` and `seam_residual_max`.
#[derive(Debug, Clone)]
pub(crate) struct Verifier {
    script: PathBuf,
}

/// What the script says of a map.
#[derive(Debug, Clone)]
pub(crate) struct Verdict {
    /// All that it says.
    pub(crate) json: Value,
    /// What is wrong.
    pub(crate) fault: Option<String>,
}

/// What a Python script, called as `python3 SCRIPT --json --asked N SOURCE QUADS`, says of quads.
///
/// # Errors
/// If it says nothing.
pub(crate) fn judge(
    script: &Path,
    asked: f64,
    source: &Path,
    quads: &Path,
) -> Result<Value, Box<dyn Error>> {
    let mut command = Command::new("python3");
    command.arg(script).args(["--json", "--asked", &asked.to_string()]).args([source, quads]);
    let output = command.output()?;
    serde_json::from_slice(&output.stdout).map_err(|_| {
        let text = String::from_utf8_lossy(&output.stderr);
        text.lines().last().unwrap_or("no message").into()
    })
}

impl Verifier {
    /// The verifier of a script.
    pub(crate) fn new(script: &Path) -> Self {
        Self { script: script.to_owned() }
    }

    /// Runs the script with more options on a mesh, an OBJ or OFF file of triangles, and a map.
    pub(crate) fn check(&self, source: &Path, map: &Path, options: &[&OsStr]) -> Verdict {
        let mut command = Command::new("python3");
        command.arg(&self.script).arg("--strict").args(options).arg(source).arg(map);
        match command.output() {
            Err(e) => Verdict::broken(format!("cannot run python3: {e}")),
            Ok(output) => match serde_json::from_slice(&output.stdout) {
                Ok(json) => Verdict::new(json),
                Err(_) => {
                    let text = String::from_utf8_lossy(&output.stderr);
                    let last = text.lines().last().unwrap_or("no message");
                    Verdict::broken(format!("the script failed: {last}"))
                }
            },
        }
    }

    /// Runs the script with more options on a mesh and corner UVs in memory.
    ///
    /// # Errors
    /// If the files for it cannot be written.
    pub(crate) fn check_uvs(
        &self,
        mesh: &Mesh,
        corner_uvs: &[[f64; 2]],
        options: &[&OsStr],
    ) -> Result<Verdict, Box<dyn Error>> {
        let folder = tempfile::tempdir()?;
        let [source, map] = ["source.obj", "map.obj"].map(|name| folder.path().join(name));
        write_mesh(&source, mesh)?;
        write_map(&map, mesh, corner_uvs)?;
        Ok(self.check(&source, &map, options))
    }
}

impl Verdict {
    fn new(json: Value) -> Self {
        let fault = match (&json["ok"], &json["error"]) {
            (Value::Bool(true), _) => None,
            (_, Value::String(error)) => Some(error.clone()),
            _ => Some(complaints(&json)),
        };
        Self { json, fault }
    }

    fn broken(fault: String) -> Self {
        Self { json: Value::Null, fault: Some(fault) }
    }

    /// A cell of a table: the verdict, the number of flipped or collapsed triangles, and the largest seam
    /// mismatch in mean edge lengths of the map.
    pub(crate) fn cell(&self) -> String {
        let word = if self.fault.is_some() { "FAIL" } else { "ok" };
        let flips = self.json["flipped_or_degenerate"].as_u64();
        let flips = flips.map_or("-".into(), |n| n.to_string());
        let residual = self.json["seam_residual_max"].as_f64();
        let residual = residual.map_or("-".into(), |x| format!("{x:.0e}"));
        format!("{word}, {flips} flips, {residual}")
    }
}

/// The numbers that a verdict depends on.
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

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn verdicts() {
        let good = json!({"ok": true, "flipped_or_degenerate": 0, "seam_residual_max": 2e-16});
        let good = Verdict::new(good);
        assert_eq!((good.cell().as_str(), good.fault), ("ok, 0 flips, 2e-16", None));
        let bad = Verdict::new(json!({"ok": false, "flipped_or_degenerate": 3}));
        assert_eq!(bad.cell(), "FAIL, 3 flips, -");
        assert!(bad.fault.is_some_and(|f| f.contains("flipped_or_degenerate 3")));
        let broken = Verdict::new(json!({"error": "no uv"}));
        assert_eq!(broken.fault.as_deref(), Some("no uv"));
    }
}
