//! Certified maps: the only way to a [`SeamlessMap`] is through its certificate.

mod alignment;
mod certificate;
mod exact;
mod fan;
mod source;
mod tolerance;
mod violation;

pub use alignment::{Alignment, followed};
pub use certificate::{Certificate, Cone, SeamEdge, SeamlessMap};
pub use source::compare_source;
pub use tolerance::{AlignmentTolerance, Tolerance, ToleranceError};
pub use violation::{Violation, Violations};
