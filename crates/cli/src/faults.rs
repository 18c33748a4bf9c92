//! Lists of faults and violations, shortened for people and complete for programs.

use seamstress_mesh::soup::{Fault, Severity};
use seamstress_parametrize::Violation;
use serde_json::{Value, json};
use std::fmt::Display;
use std::mem::{Discriminant, discriminant};

/// One line per item, those of a kind together, at most `limit` of each kind.
pub(crate) fn listing<'a, T: Display + 'a>(
    items: impl IntoIterator<Item = &'a T>,
    limit: usize,
) -> Vec<String> {
    let mut kinds: Vec<(Discriminant<T>, Vec<&T>)> = Vec::new();
    for item in items {
        let kind = discriminant(item);
        match kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, members)) => members.push(item),
            None => kinds.push((kind, vec![item])),
        }
    }
    let mut lines = Vec::new();
    for (_, members) in kinds {
        lines.extend(members.iter().take(limit).map(ToString::to_string));
        if members.len() > limit {
            lines.push(format!("and {} more", members.len() - limit));
        }
    }
    lines
}

/// A fault for programs.
pub(crate) fn fault_json(fault: &Fault) -> Value {
    let severity = match fault.severity() {
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    json!({ "severity": severity, "kind": kind(fault), "message": fault.to_string() })
}

fn kind(fault: &Fault) -> &'static str {
    match fault {
        Fault::NoFaces => "no-faces",
        Fault::TooManyFaces { .. } => "too-many-faces",
        Fault::TooManyVertices { .. } => "too-many-vertices",
        Fault::TooFewCorners { .. } => "too-few-corners",
        Fault::IndexOutOfRange { .. } => "index-out-of-range",
        Fault::NonFiniteCoordinate { .. } => "non-finite-coordinate",
        Fault::RepeatedVertex { .. } => "repeated-vertex",
        Fault::DuplicateFace { .. } => "duplicate-face",
        Fault::OppositeFace { .. } => "opposite-face",
        Fault::NonManifoldEdge { .. } => "non-manifold-edge",
        Fault::NonManifoldVertex { .. } => "non-manifold-vertex",
        Fault::InconsistentOrientation { .. } => "inconsistent-orientation",
        Fault::NonOrientable { .. } => "non-orientable",
        Fault::ZeroAreaFace { .. } => "zero-area-face",
        Fault::ZeroLengthEdge { .. } => "zero-length-edge",
        Fault::UnreferencedVertex { .. } => "unreferenced-vertex",
        _ => "other",
    }
}

/// A violation for programs: its fields and its message.
pub(crate) fn violation_json(violation: &Violation) -> Value {
    let mut value = serde_json::to_value(violation).unwrap_or_default();
    if let Value::Object(fields) = &mut value {
        fields.insert("message".into(), violation.to_string().into());
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut_by_kind() {
        let mut faults: Vec<Fault> = (0..5).map(|face| Fault::ZeroAreaFace { face }).collect();
        faults.push(Fault::UnreferencedVertex { vertex: 7 });
        let lines = listing(&faults, 2);
        let expected = [
            "face 0 has zero area",
            "face 1 has zero area",
            "and 3 more",
            "vertex 7 belongs to no face",
        ];
        assert_eq!(lines, expected);
    }
}
