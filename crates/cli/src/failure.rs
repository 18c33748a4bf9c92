//! How a run ends: exit codes, and failures with their messages.

use crate::text::{self, as_options};
use seamstress::{Error, ErrorCategory, ErrorKind, PartReport};
use serde_json::{Value, json};
use std::fmt;
use std::time::Duration;

/// The exit codes, as documented in the help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    Done = 0,
    BadInput = 1,
    WrongUsage = 2,
    NoResult = 3,
    Stopped = 4,
}

impl Status {
    /// Whether all parts could be made.
    pub(crate) fn of_parts(parts: Option<&PartReport>) -> Self {
        match parts.is_some_and(|parts| !parts.failed.is_empty()) {
            true => Self::NoResult,
            false => Self::Done,
        }
    }
}

/// Why a run failed: what, where, and what to do about it.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The library has no result.
    Library(Error),
    /// The command line asks for what cannot be.
    Usage(String),
    /// Standard input cannot be read.
    StandardInput(std::io::Error),
    /// Stopped while files were written, or for good.
    Interrupted { input: String },
    /// The work did not stop when its time was over.
    TimeLimit { input: String, limit: Duration },
    /// The work broke off.
    Panicked { input: String },
}

/// Prints lines on standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let unwritable = |cause| Failure::Usage(format!("cannot write to standard output: {cause}"));
    text::print(text).map_err(unwritable)
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Library(error)
    }
}

impl Failure {
    pub(crate) fn status(&self) -> Status {
        match self {
            Self::Library(error) => match error.kind().category() {
                ErrorCategory::Input => Status::BadInput,
                ErrorCategory::Usage => Status::WrongUsage,
                ErrorCategory::Stopped => Status::Stopped,
                _ => Status::NoResult,
            },
            Self::StandardInput(_) => Status::BadInput,
            Self::Usage(_) => Status::WrongUsage,
            Self::Interrupted { .. } | Self::TimeLimit { .. } => Status::Stopped,
            Self::Panicked { .. } => Status::NoResult,
        }
    }
}

impl Failure {
    /// For programs: a stable code, and what the library knows of it.
    pub(crate) fn report(&self) -> Value {
        let code = match self {
            Self::Library(error) => error.code(),
            Self::Usage(_) => "usage",
            Self::StandardInput(_) => ErrorKind::Unreadable.code(),
            Self::Interrupted { .. } => ErrorKind::Cancelled.code(),
            Self::TimeLimit { .. } => ErrorKind::TimeLimit.code(),
            Self::Panicked { .. } => ErrorKind::Internal.code(),
        };
        let mut report = json!({ "code": code, "message": self.to_string() });
        if let Self::Library(error) = self {
            report["message"] = error.message().into();
            report["stage"] = json!(error.stage());
            report["hint"] = json!(error.hint().map(as_options));
            report["elements"] = json!(error.elements());
            report["findings"] = json!(error.findings());
            report["failed_parts"] = json!(error.failed_parts());
        }
        report
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(error) => {
                match (error.kind(), error.input()) {
                    (ErrorKind::Cancelled, Some(input)) => {
                        write!(f, "{input}: stopped: interrupted")?
                    }
                    (ErrorKind::Cancelled, None) => f.write_str("stopped: interrupted")?,
                    _ => f.write_str(&as_options(&error.to_string()))?,
                }
                let category = error.kind().category();
                if matches!(category, ErrorCategory::NoResult | ErrorCategory::Stopped) {
                    f.write_str("\nNothing was written")?;
                }
                match error.hint() {
                    Some(hint) => write!(f, "\nhint: {}", as_options(hint)),
                    None => Ok(()),
                }
            }
            Self::StandardInput(cause) => write!(f, "standard input cannot be read: {cause}"),
            Self::Usage(text) => f.write_str(text),
            Self::Interrupted { input } => {
                write!(f, "{input}: stopped: interrupted\nNothing was written")
            }
            Self::TimeLimit { input, limit } => write!(
                f,
                "{input}: stopped: the time limit of {} s has passed\nNothing was written\n\
                 hint: allow more with `--time-limit`",
                limit.as_secs_f64()
            ),
            Self::Panicked { input } => write!(
                f,
                "{input}: internal error: the computation broke off\nNothing was written\n\
                 hint: please report this with the mesh"
            ),
        }
    }
}
