//! How a run ends: exit codes, and failures with their messages.

use seamstress_io::{ReadError, WriteError};
use seamstress_parametrize::{MapError, Violations};
use seamstress_quads::QuadFaults;
use seamstress_quantize::IntegerError;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// The exit codes, as documented in the help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    Done = 0,
    BadInput = 1,
    WrongUsage = 2,
    NoMap = 3,
    Stopped = 4,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        ExitCode::from(status as u8)
    }
}

/// What made a run stop before its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StopReason {
    TimeLimit(Duration),
    Interrupt,
}

impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::TimeLimit(limit) => {
                let seconds = limit.as_secs_f64();
                write!(
                    f,
                    "the time limit of {seconds} s has passed; allow more with `--time-limit`"
                )
            }
            Self::Interrupt => f.write_str("interrupted"),
        }
    }
}

/// Why a run failed: what, where, and what to do about it.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error(transparent)]
    Unreadable(#[from] ReadError),
    /// The mesh has faults; the text lists some of them.
    #[error("{}: {text}", file.display())]
    BadMesh { file: PathBuf, text: String },
    #[error("{}: {text}", file.display())]
    BadMap { file: PathBuf, text: String },
    /// A source of features names what is not there.
    #[error("{}: {text}", file.display())]
    BadFeatures { file: PathBuf, text: String },
    /// A field, matchings or cones to start from that are not of the mesh, or that no map has.
    #[error("{}: {text}", file.display())]
    BadStart { file: PathBuf, text: String },
    #[error("{}: {text}", file.display())]
    BadStretches { file: PathBuf, text: String },
    #[error("{0}")]
    Usage(String),
    #[error(transparent)]
    Unwritable(#[from] WriteError),
    #[error("cannot write {}: {cause}", path.display())]
    Output { path: PathBuf, cause: std::io::Error },
    #[error(
        "{}: no certified map could be made: {cause}. Nothing was written.\n\
         This is a limit of the method: try another `--cone-bias`, or remesh triangles that are very \
         thin or without area",
        file.display()
    )]
    NoMap { file: PathBuf, cause: MapError },
    #[error("{}: no quads were extracted: {text}", file.display())]
    NoQuads { file: PathBuf, text: String },
    #[error(
        "{}: the quads are no manifold: {faults}. Nothing was written; {advice}",
        file.display()
    )]
    NoManifold { file: PathBuf, faults: QuadFaults, advice: &'static str },
    #[error(
        "{}: no certified integer map could be made: {cause}. Nothing was written; {advice}",
        file.display()
    )]
    NoIntegerMap { file: PathBuf, cause: IntegerError, advice: &'static str },
    #[error(
        "{}: the layout of the field has {text}. Nothing was written.\n\
         Lay it out with `--exact`, or take it as it is with `--allow-flips`",
        file.display()
    )]
    Uncertified { file: PathBuf, text: String },
    /// Features were released although they must not be.
    #[error(
        "{}: {cause}\nNothing was written; without `--features-strict` the map is made without them",
        file.display()
    )]
    Released { file: PathBuf, cause: MapError },
    /// A bug of ours.
    #[error(
        "{}: a map was made, but its features are not aligned: {cause}. Nothing was written. Please \
         report this with the mesh",
        file.display()
    )]
    Misaligned { file: PathBuf, cause: Violations },
    #[error("{}: no consistent matchings: {text}. Nothing was written", file.display())]
    Inconsistent { file: PathBuf, text: String },
    #[error("{}: stopped: {reason}. Nothing was written", file.display())]
    Stopped { file: PathBuf, reason: StopReason },
    #[error("{}: the map was made, but not its pictures: {cause}. Nothing was written; leave out `--pictures`", file.display())]
    NoPicture { file: PathBuf, cause: seamstress_render::RenderError },
    #[error("{}: no picture could be drawn: {cause}", file.display())]
    Undrawable { file: PathBuf, cause: seamstress_render::RenderError },
    /// A bug of ours.
    #[error("{}: internal error: {text}. Nothing was written. Please report this with the mesh", file.display())]
    Internal { file: PathBuf, text: String },
}

impl Failure {
    pub(crate) fn status(&self) -> Status {
        match self {
            Self::Unreadable(_)
            | Self::BadMesh { .. }
            | Self::BadMap { .. }
            | Self::BadStretches { .. }
            | Self::BadFeatures { .. }
            | Self::Undrawable { .. }
            | Self::NoQuads { .. }
            | Self::BadStart { .. } => Status::BadInput,
            Self::Usage(_) | Self::Unwritable(_) | Self::Output { .. } => Status::WrongUsage,
            Self::NoManifold { .. }
            | Self::NoMap { .. }
            | Self::Inconsistent { .. }
            | Self::Uncertified { .. }
            | Self::Released { .. }
            | Self::Misaligned { .. }
            | Self::NoIntegerMap { .. }
            | Self::NoPicture { .. }
            | Self::Internal { .. } => Status::NoMap,
            Self::Stopped { .. } => Status::Stopped,
        }
    }
}
