//! Certified maps: the only way to a [`SeamlessMap`] is through its certificate.

mod certificate;
mod followed;
mod words;

pub use certificate::{SeamEdge, SeamlessMap};
pub use followed::followed;
pub use seamstress_certify::{
    Alignment, Certificate, Cone, IntegerCertificate, Map, Tolerance, Violation, Violations,
    compare_source,
};
pub use words::{first_in_words, in_whole, in_words};
