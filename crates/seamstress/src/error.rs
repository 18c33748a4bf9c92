//! The one error of this crate.

use crate::finding::{Elements, Finding};
use crate::memory::Memory;
use crate::words::counted;
use seamstress_parametrize::Stage as Step;
use seamstress_quads::QuadFaults;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

/// What was being done when work failed or was stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Stage {
    /// Reading or writing a file.
    Files,
    /// Checking that the input is a surface.
    Check,
    /// Finding the features asked for.
    Features,
    /// Cutting and unfolding.
    Cut,
    /// Rounding the matchings.
    Rounding,
    /// The exact seamless layout of low energy.
    Layout,
    /// Removing and moving cones.
    CleanUp,
    /// Lowering the largest distortion.
    Polish,
    /// Minimising the objective asked for.
    Objective,
    /// Certifying.
    Certificate,
    /// Rounding to an integer-grid map.
    Quantization,
    /// Extracting quads.
    Extraction,
    /// Untangling and smoothing quads.
    Shaping,
    /// Drawing pictures.
    Pictures,
}

impl Stage {
    /// Name for people and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Files => "files",
            Self::Check => "check",
            Self::Features => "features",
            Self::Cut => "cut",
            Self::Rounding => "rounding",
            Self::Layout => "layout",
            Self::CleanUp => "clean-up",
            Self::Polish => "polish",
            Self::Objective => "objective",
            Self::Certificate => "certificate",
            Self::Quantization => "quantization",
            Self::Extraction => "extraction",
            Self::Shaping => "shaping",
            Self::Pictures => "pictures",
        }
    }
}

impl From<Step> for Stage {
    fn from(step: Step) -> Self {
        match step {
            Step::Cut => Self::Cut,
            Step::Rounding => Self::Rounding,
            Step::Layout => Self::Layout,
            Step::CleanUp => Self::CleanUp,
            Step::Polish => Self::Polish,
            Step::Objective => Self::Objective,
            Step::Integers => Self::Quantization,
            Step::Extraction => Self::Extraction,
            Step::Shaping => Self::Shaping,
            _ => Self::Certificate,
        }
    }
}

/// What kind of failure it is. The code of a kind stays the same over versions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A file cannot be read, or does not follow its format.
    Unreadable,
    /// A file cannot be written.
    Unwritable,
    /// An option has a value that it cannot have, or two contradict each other.
    Options,
    /// The input is no surface: an oriented manifold of triangles.
    NotASurface,
    /// The surface is not symmetric at a plane where it should be.
    NotSymmetric,
    /// What is given as a map is no map of the surface, or not a seamless one.
    NotAMap,
    /// A source of features names what is not there.
    BadFeatures,
    /// A field, matchings, cones or stretches are not of the surface, or no map has them.
    BadStart,
    /// A mesh is not one of quads.
    NotQuads,
    /// No certified map could be made.
    NoMap,
    /// No certified integer-grid map could be made.
    NoIntegerMap,
    /// No quads could be extracted.
    NoQuads,
    /// The quads extracted are no manifold.
    NotAManifold,
    /// Features would be dropped although they must not be.
    DroppedFeatures,
    /// A layout was made that is no seamless map.
    Uncertified,
    /// No consistent matchings were found.
    Inconsistent,
    /// A picture could not be drawn.
    NoPicture,
    /// Stopped by the caller.
    Cancelled,
    /// Stopped by the time limit.
    TimeLimit,
    /// Not begun, since it is expected to take more memory than is allowed.
    MemoryLimit,
    /// A fault of this program.
    Internal,
}

/// Who can do something about a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorCategory {
    /// The input has to change.
    Input,
    /// The call has to change.
    Usage,
    /// The method found no result that it can vouch for.
    NoResult,
    /// Stopped before the end, by the caller or a limit.
    Stopped,
}

impl ErrorKind {
    /// A short stable name for programs.
    pub fn code(self) -> &'static str {
        match self {
            Self::Unreadable => "unreadable",
            Self::Unwritable => "unwritable",
            Self::Options => "options",
            Self::NotASurface => "not-a-surface",
            Self::NotSymmetric => "not-symmetric",
            Self::NotAMap => "not-a-map",
            Self::BadFeatures => "bad-features",
            Self::BadStart => "bad-start",
            Self::NotQuads => "not-quads",
            Self::NoMap => "no-map",
            Self::NoIntegerMap => "no-integer-map",
            Self::NoQuads => "no-quads",
            Self::NotAManifold => "not-a-manifold",
            Self::DroppedFeatures => "dropped-features",
            Self::Uncertified => "uncertified",
            Self::Inconsistent => "inconsistent",
            Self::NoPicture => "no-picture",
            Self::Cancelled => "cancelled",
            Self::TimeLimit => "time-limit",
            Self::MemoryLimit => "memory-limit",
            Self::Internal => "internal",
        }
    }

    /// Who can do something about it.
    pub fn category(self) -> ErrorCategory {
        match self {
            Self::Unreadable
            | Self::NotASurface
            | Self::NotSymmetric
            | Self::NotAMap
            | Self::BadFeatures
            | Self::BadStart
            | Self::NotQuads
            | Self::NoQuads => ErrorCategory::Input,
            Self::Options | Self::Unwritable | Self::NoPicture => ErrorCategory::Usage,
            Self::NoMap
            | Self::NoIntegerMap
            | Self::NotAManifold
            | Self::DroppedFeatures
            | Self::Uncertified
            | Self::Inconsistent
            | Self::Internal => ErrorCategory::NoResult,
            Self::Cancelled | Self::TimeLimit | Self::MemoryLimit => ErrorCategory::Stopped,
        }
    }
}

/// Why there is no result: what failed, where, and what may help.
///
/// Displays as the input's name and the message. Elements are counted from 0, in the ids of the input: its vertices,
/// and its faces before polygons were split and repairs were made.
pub struct Error(Box<Parts>);

struct Parts {
    kind: ErrorKind,
    stage: Option<Stage>,
    input: Option<String>,
    message: String,
    hint: Option<String>,
    findings: Vec<Finding>,
    elements: Elements,
    failed_parts: Vec<FailedPart>,
}

impl Error {
    pub(crate) fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self(Box::new(Parts {
            kind,
            stage: None,
            input: None,
            message: message.into(),
            hint: None,
            findings: Vec::new(),
            elements: Elements::default(),
            failed_parts: Vec::new(),
        }))
    }

    pub(crate) fn options(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Options, message)
    }

    /// Work that was stopped: by the caller, or by what the watcher over it knows.
    pub(crate) fn cancelled() -> Self {
        Self::new(ErrorKind::Cancelled, "stopped on request")
    }

    pub(crate) fn no_manifold(faults: &QuadFaults) -> Self {
        Self::new(ErrorKind::NotAManifold, format!("the quads are no manifold: {faults}"))
            .at_stage(Some(Stage::Extraction))
    }

    /// Names the input, unless it has a name already.
    pub(crate) fn of(mut self, input: Option<&str>) -> Self {
        if self.0.input.is_none() {
            self.0.input = input.map(str::to_owned);
        }
        self
    }

    pub(crate) fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.0.hint = Some(hint.into());
        self
    }

    pub(crate) fn with_elements(mut self, elements: Elements) -> Self {
        self.0.elements = elements;
        self
    }

    pub(crate) fn with_findings(mut self, findings: Vec<Finding>) -> Self {
        for finding in &findings {
            self.0.elements.extend(&finding.elements);
        }
        self.0.findings = findings;
        self
    }

    /// With the parts that failed, their elements and the first hint among theirs.
    pub(crate) fn with_failed_parts(mut self, failed: Vec<FailedPart>) -> Self {
        for part in &failed {
            self.0.elements.extend(&part.elements);
        }
        self.0.stage = failed.first().and_then(|part| part.stage);
        self.0.hint = failed.iter().find_map(|part| part.hint.clone());
        self.0.failed_parts = failed;
        self
    }

    /// With the numbers of failed parts replaced by those of the components that faces of the input are in.
    pub(crate) fn with_parts_numbered(mut self, component_of: &BTreeMap<u32, u32>) -> Self {
        self.0.failed_parts.iter_mut().for_each(|part| part.renumber(component_of));
        self
    }

    /// With another thing that may help.
    pub(crate) fn with_further_hint(mut self, further: &str) -> Self {
        self.0.hint = Some(match self.0.hint {
            Some(hint) => format!("{hint}; {further}"),
            None => further.into(),
        });
        self
    }

    pub(crate) fn at_stage(mut self, stage: Option<Stage>) -> Self {
        self.0.stage = self.0.stage.or(stage);
        self
    }

    pub(crate) fn timed_out(mut self, limit: Duration) -> Self {
        self.0.kind = ErrorKind::TimeLimit;
        self.0.message = format!("stopped: the time limit of {} s has passed", limit.as_secs_f64());
        self.with_hint("allow more with `time_limit`")
    }

    /// Work that would take more memory than is allowed.
    pub(crate) fn too_large(expected: Memory, limit: Memory) -> Self {
        let text = format!("this takes about {expected} of memory; the limit is {limit}");
        Self::new(ErrorKind::MemoryLimit, text)
            .with_hint("allow more with `memory_limit`, or take a coarser mesh or fewer quads")
    }

    /// What kind of failure it is.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// The kind's short stable name.
    pub fn code(&self) -> &'static str {
        self.0.kind.code()
    }

    /// What was being done, where that is known.
    pub fn stage(&self) -> Option<Stage> {
        self.0.stage
    }

    /// The file it is about, where there is one.
    pub fn input(&self) -> Option<&str> {
        self.0.input.as_deref()
    }

    /// What happened, without the name of the input.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// What may help. Options stand in backticks, as they are named in this crate.
    pub fn hint(&self) -> Option<&str> {
        self.0.hint.as_deref()
    }

    /// The elements it is about, in the ids of the input.
    pub fn elements(&self) -> &Elements {
        &self.0.elements
    }

    /// The connected parts that failed, where the others might be made.
    pub fn failed_parts(&self) -> &[FailedPart] {
        &self.0.failed_parts
    }

    /// Everything that is wrong, one by one, where a check failed.
    pub fn findings(&self) -> &[Finding] {
        &self.0.findings
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0.input {
            Some(input) => write!(f, "{input}: {}", self.0.message),
            None => f.write_str(&self.0.message),
        }
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self} [{}]", self.code())?;
        match &self.0.hint {
            Some(hint) => write!(f, "; {hint}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Error {}

/// A part of a surface that could not be made.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FailedPart {
    /// Its number among the components of the surface, counted from 0.
    pub component: u32,
    /// Its lowest face in the input.
    pub first_face: u32,
    /// Its faces in the input.
    pub faces: usize,
    /// The code of its error.
    pub code: &'static str,
    /// What was being done.
    pub stage: Option<Stage>,
    /// What failed.
    pub message: String,
    /// The elements it is about, in the ids of the input.
    pub elements: Elements,
    /// What may help.
    pub hint: Option<String>,
}

impl FailedPart {
    /// Gives it the number of the component that its first face is of.
    pub(crate) fn renumber(&mut self, component_of: &BTreeMap<u32, u32>) {
        self.component = component_of.get(&self.first_face).copied().unwrap_or(self.component);
    }
}

impl fmt::Display for FailedPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let faces = counted(self.faces, "face");
        write!(f, "component {} ({faces} from face {})", self.component, self.first_face)
    }
}
