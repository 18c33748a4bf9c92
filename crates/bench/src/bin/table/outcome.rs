//! One run of `seamstress map` and what became of it.

use crate::report::Report;
use crate::verify::{Verdict, verify};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What became of a mesh.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// There is a map, and perhaps a verdict on it.
    Mapped(Report, Option<Verdict>),
    /// The input is at fault.
    Refused(String),
    /// There should be a map, and is none.
    Failed(String),
}

impl Outcome {
    pub(crate) fn is_failure(&self) -> bool {
        match self {
            Self::Mapped(_, verdict) => verdict.iter().any(|v| v.fault().is_some()),
            Self::Refused(_) => false,
            Self::Failed(_) => true,
        }
    }
}

/// How meshes are mapped.
#[derive(Debug)]
pub(crate) struct Runner {
    /// The command.
    pub(crate) seamstress: PathBuf,
    /// Folder of the maps and reports.
    pub(crate) maps: PathBuf,
    /// Script that verifies the maps.
    pub(crate) verifier: Option<PathBuf>,
    /// Seconds.
    pub(crate) time_limit: Option<u32>,
    /// More arguments for the command.
    pub(crate) map_args: Vec<OsString>,
}

impl Runner {
    /// Maps a mesh and verifies the map.
    pub(crate) fn run(&self, mesh: &Path) -> Outcome {
        let map = self.output_path(mesh, ".obj");
        let mut command = Command::new(&self.seamstress);
        command.arg("map").arg(mesh).arg("-o").arg(&map);
        command.arg("--report").arg(self.output_path(mesh, ".json"));
        command.args(["--json", "--quiet"]);
        if let Some(seconds) = self.time_limit {
            command.arg("--time-limit").arg(seconds.to_string());
        }
        let output = match command.args(&self.map_args).output() {
            Ok(output) => output,
            Err(e) => {
                let program = self.seamstress.display();
                return Outcome::Failed(format!("cannot run {program}: {e}"));
            }
        };
        match output.status.code() {
            Some(0) => self.mapped(mesh, &map, &output.stdout),
            Some(1) => Outcome::Refused(reason(mesh, &output)),
            Some(code) => Outcome::Failed(format!("exit {code}: {}", reason(mesh, &output))),
            None => Outcome::Failed(format!("{}: {}", output.status, reason(mesh, &output))),
        }
    }

    fn mapped(&self, mesh: &Path, map: &Path, json: &[u8]) -> Outcome {
        let report = match Report::parse(json) {
            Ok(report) => report,
            Err(e) => return Outcome::Failed(format!("the report cannot be read: {e}")),
        };
        let verdict = self.verifier.as_ref().map(|script| {
            let triangulated = self.output_path(mesh, ".source.obj");
            verify(script, mesh, map, &triangulated, &report)
        });
        Outcome::Mapped(report, verdict)
    }

    /// The whole file name stays, since files may differ in their extensions only.
    fn output_path(&self, mesh: &Path, extension: &str) -> PathBuf {
        let mut name = mesh.file_name().unwrap_or_default().to_owned();
        name.push(extension);
        self.maps.join(name)
    }
}

/// The first line of the error, and the next if the first announces it, without the name of the file.
fn reason(mesh: &Path, output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr);
    let mut lines = text.lines().skip_while(|line| !line.starts_with("error:"));
    let Some(first) = lines.next().or(text.lines().next()) else {
        return "no message".into();
    };
    let first = first.strip_prefix("error: ").unwrap_or(first);
    let file = mesh.display().to_string();
    let first = first.strip_prefix(&file).unwrap_or(first);
    let first = first.trim_start_matches([':', ',', ' ']);
    match lines.next() {
        Some(second) if first.ends_with(':') => format!("{first} {}", second.trim()),
        _ => first.to_owned(),
    }
}
