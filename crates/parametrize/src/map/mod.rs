//! Certified maps: the only way to a [`SeamlessMap`] is through its certificate.

mod alignment;
mod certificate;
mod violation;

pub use alignment::{Alignment, AlignmentTolerance, edges_along_axes};
pub use certificate::{Certificate, Cone, SeamEdge, SeamlessMap, Tolerance, compare_source};
pub use violation::{Violation, Violations};
