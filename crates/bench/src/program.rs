//! Runs of a `seamstress` program.

use serde_json::Value;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A `seamstress` program and the arguments that every run gets.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    /// The executable.
    pub(crate) path: PathBuf,
    /// Seconds after which a run gives up.
    pub(crate) time_limit: Option<u32>,
    /// Number of threads; all cores if not given.
    pub(crate) threads: Option<u16>,
}

/// How a run ended.
#[derive(Debug, Clone)]
pub(crate) enum Outcome {
    /// With a result, and its report.
    Done(Report),
    /// The input is at fault; the reason.
    Refused(String),
    /// There is no result; the reason.
    Failed(String),
}

impl Outcome {
    /// The report, if there is a result.
    pub(crate) fn report(&self) -> Option<&Report> {
        match self {
            Self::Done(report) => Some(report),
            _ => None,
        }
    }
}

impl Program {
    /// Runs `COMMAND MESH -o OUTPUT ARGUMENTS` with a JSON report.
    pub(crate) fn run<A: AsRef<OsStr>>(
        &self,
        command: &str,
        mesh: &Path,
        output: &Path,
        arguments: &[A],
    ) -> Outcome {
        let mut process = Command::new(&self.path);
        process.arg(command).arg(mesh).arg("-o").arg(output).args(["--json", "--quiet"]);
        if let Some(seconds) = self.time_limit {
            process.args(["--time-limit", &seconds.to_string()]);
        }
        if let Some(threads) = self.threads {
            process.args(["--threads", &threads.to_string()]);
        }
        let output = match process.args(arguments).output() {
            Ok(output) => output,
            Err(e) => return Outcome::Failed(format!("cannot run {}: {e}", self.path.display())),
        };
        match output.status.code() {
            Some(0) => match Report::parse(&output.stdout) {
                Ok(report) => Outcome::Done(report),
                Err(e) => Outcome::Failed(format!("the report cannot be read: {e}")),
            },
            Some(1) => Outcome::Refused(reason(mesh, &output)),
            Some(code) => Outcome::Failed(format!("exit {code}: {}", reason(mesh, &output))),
            None => Outcome::Failed(format!("{}: {}", output.status, reason(mesh, &output))),
        }
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

/// The JSON report of a run.
#[derive(Debug, Clone)]
pub(crate) struct Report(Value);

impl Report {
    /// Reads a report.
    ///
    /// # Errors
    /// If it is not JSON.
    pub(crate) fn parse(json: &[u8]) -> Result<Self, serde_json::Error> {
        serde_json::from_slice(json).map(Self)
    }

    /// The report with one more entry.
    pub(crate) fn with(mut self, key: &str, value: Value) -> Self {
        if let Value::Object(entries) = &mut self.0 {
            entries.insert(key.into(), value);
        }
        self
    }

    /// A value by its JSON pointer, as in `/input/faces`; null if there is none.
    pub(crate) fn get(&self, pointer: &str) -> &Value {
        self.0.pointer(pointer).unwrap_or(&Value::Null)
    }

    /// A number by its JSON pointer; infinities are spelled out in reports.
    pub(crate) fn number(&self, pointer: &str) -> Option<f64> {
        match self.get(pointer) {
            Value::String(text) => text.parse().ok(),
            value => value.as_f64(),
        }
    }

    /// CPU seconds of the whole run.
    pub(crate) fn cpu_seconds(&self) -> Option<f64> {
        self.number("/cost/cpu_seconds")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_report() {
        let report = Report::parse(br#"{"a": {"b": 3}, "c": "inf", "d": []}"#).unwrap();
        let number = |pointer| report.number(pointer);
        assert_eq!(number("/a/b"), Some(3.0));
        assert_eq!(number("/c"), Some(f64::INFINITY));
        assert_eq!((number("/d"), number("/e")), (None, None));
    }

    #[cfg(unix)]
    #[test]
    fn the_reason_is_the_first_line_of_the_error() {
        use std::os::unix::process::ExitStatusExt;
        let output = |text: &str| Output {
            status: std::process::ExitStatus::from_raw(0),
            stdout: Vec::new(),
            stderr: text.as_bytes().to_vec(),
        };
        let of = |text: &str| reason(Path::new("a/m.obj"), &output(text));
        assert_eq!(of("note: x\nerror: a/m.obj: no faces\n"), "no faces");
        assert_eq!(of("error: a/m.obj is no mesh:\n  an edge\n"), "is no mesh: an edge");
        assert_eq!(of(""), "no message");
    }
}
