//! Certified maps: the only way to a [`SeamlessMap`] is through its certificate.

mod certificate;
mod followed;

pub use certificate::{SeamEdge, SeamlessMap};
pub use followed::followed;
pub use seamstress_certify::{
    Alignment, AlignmentTolerance, Certificate, Cone, IntegerCertificate, IntegralTolerance, Map,
    Tolerance, ToleranceError, Violation, Violations, compare_source,
};
