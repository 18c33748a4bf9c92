//! What the tests of all shapes ask.

use seamstress_mesh::soup::{Facts, TriangleSoup, check};

/// Asserts that the soup is a mesh without any fault, and returns its facts.
pub(crate) fn sound(soup: &TriangleSoup) -> Facts {
    let report = check(soup);
    assert_eq!(report.faults, []);
    report.facts
}

/// Asserts that the soup is a faultless mesh in one piece, and returns its Euler characteristic,
/// genus and number of boundary loops.
pub(crate) fn topology(soup: &TriangleSoup) -> (i64, usize, usize) {
    let facts = sound(soup);
    assert_eq!(facts.components.len(), 1);
    (facts.euler_characteristic(), facts.genus().unwrap(), facts.boundary_loops())
}

/// Six times the volume enclosed, positive if the faces look outwards.
pub(crate) fn six_volumes(soup: &TriangleSoup) -> f64 {
    let determinant = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| soup.positions[v as usize]);
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    soup.faces.iter().map(determinant).sum()
}
