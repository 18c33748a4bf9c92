//! A map against the mesh it was made from.

use super::violation::Violation;

/// Compares a map's vertices and faces with its source; a map must not touch them.
///
/// Positions have to agree exactly: they are written with enough digits.
pub fn compare_source(
    source: (&[[f64; 3]], &[[u32; 3]]),
    map: (&[[f64; 3]], &[[u32; 3]]),
) -> Vec<Violation> {
    let mut violations = Vec::new();
    if source.0.len() != map.0.len() {
        violations.push(Violation::VertexCount { source_count: source.0.len(), map: map.0.len() });
    }
    if source.1.len() != map.1.len() {
        violations.push(Violation::FaceCount { source_count: source.1.len(), map: map.1.len() });
    }
    if !violations.is_empty() {
        return violations;
    }
    for (vertex, (a, b)) in source.0.iter().zip(map.0).enumerate() {
        if a != b {
            let distance = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            violations.push(Violation::MovedVertex { vertex: vertex as u32, distance });
        }
    }
    for (face, (a, b)) in source.1.iter().zip(map.1).enumerate() {
        if a != b {
            violations.push(Violation::ChangedFace { face: face as u32 });
        }
    }
    violations
}
