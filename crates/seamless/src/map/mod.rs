//! Certified maps: the only way to a [`SeamlessMap`] is through its certificate.

mod certificate;
mod violation;

pub use certificate::{Certificate, Cone, SeamEdge, SeamlessMap, Tolerance, compare_source};
pub use violation::{Violation, Violations};
