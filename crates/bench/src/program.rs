//! Runs of a `seamstress` program.

use serde_json::Value;
use std::ffi::OsStr;
use std::fmt;
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
    Refused(Reason),
    /// There is no result; the reason.
    Failed(Reason),
}

/// Why a run gave no result.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Reason {
    /// The code of the error, if the program ended with one.
    pub(crate) code: Option<String>,
    /// What it said.
    pub(crate) message: String,
    /// What it cost, as a report says it.
    pub(crate) cost: Option<Report>,
}

impl From<String> for Reason {
    fn from(message: String) -> Self {
        Self { code: None, message, cost: None }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.code {
            Some(code) => write!(f, "{code}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
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
            Err(e) => {
                return Outcome::Failed(format!("cannot run {}: {e}", self.path.display()).into());
            }
        };
        match output.status.code() {
            Some(0) => match Report::parse(&output.stdout) {
                Ok(report) => Outcome::Done(report),
                Err(e) => Outcome::Failed(format!("the report cannot be read: {e}").into()),
            },
            Some(1) => Outcome::Refused(reason(mesh, &output)),
            _ => Outcome::Failed(reason(mesh, &output)),
        }
    }
}

/// The error that the program printed as JSON, or what else it said.
fn reason(mesh: &Path, output: &Output) -> Reason {
    let report = Report::parse(&output.stdout).ok();
    let text = |pointer| Some(report.as_ref()?.get(pointer).as_str()?.to_owned());
    match (text("/error/code"), text("/error/message")) {
        (Some(code), Some(message)) => Reason { code: Some(code), message, cost: report },
        _ => format!("{}: {}", output.status, first_line(mesh, output)).into(),
    }
}

/// The first line of the error, and the next if the first announces it, without the name of the file.
fn first_line(mesh: &Path, output: &Output) -> String {
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
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Report(Value);

impl From<Value> for Report {
    fn from(json: Value) -> Self {
        Self(json)
    }
}

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
        let of = |text: &str| first_line(Path::new("a/m.obj"), &output(text));
        assert_eq!(of("note: x\nerror: a/m.obj: no faces\n"), "no faces");
        assert_eq!(of("error: a/m.obj is no mesh:\n  an edge\n"), "is no mesh: an edge");
        assert_eq!(of(""), "no message");
    }

    #[cfg(unix)]
    #[test]
    fn an_error_in_json_has_its_code() {
        use std::os::unix::process::ExitStatusExt;
        let json =
            br#"{"error": {"code": "no-map", "message": "none"}, "cost": {"cpu_seconds": 2}}"#;
        let status = std::process::ExitStatus::from_raw(3 << 8);
        let output = Output { status, stdout: json.to_vec(), stderr: Vec::new() };
        let found = reason(Path::new("m.obj"), &output);
        assert_eq!(found.to_string(), "no-map: none");
        assert_eq!(found.cost.unwrap().cpu_seconds(), Some(2.0));
        let killed = Output { stdout: Vec::new(), ..output };
        assert_eq!(reason(Path::new("m.obj"), &killed).code, None);
    }
}
