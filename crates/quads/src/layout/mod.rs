//! Quad meshes in the plane, section 7 of the seed: every quad is a unit square.

mod conformal;
mod squares;

pub use conformal::lay_out_conformal;
pub use squares::lay_out_squares;

use crate::QuadMesh;
use seamstress_mesh::{MeshError, TriMesh};
use std::collections::HashSet;

/// A quad mesh, split into triangles, with UVs in units of one quad edge.
///
/// Quad `q` is split along a diagonal, if possible its shorter one, into the triangles `2 q` and `2 q + 1`.
#[derive(Debug, Clone)]
pub struct QuadLayout {
    /// The triangles' connectivity.
    pub mesh: TriMesh,
    /// The triangles' vertices.
    pub faces: Vec<[u32; 3]>,
    /// One UV per corner, three per triangle.
    pub corner_uvs: Vec<[f64; 2]>,
}

/// Why a quad mesh has no layout.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LayoutError {
    /// The quads are no oriented manifold; the faces named are triangles `2 q` and `2 q + 1` of quad `q`.
    #[error("the quads are not an oriented manifold: {0}")]
    NoManifold(#[from] MeshError),
    /// The linear system could not be solved.
    #[error("the linear system of the conformal layout could not be factored")]
    NoFactor,
}

/// The two triangles of every quad. Their corners are the first three, and the first, third and fourth
/// of the quad, counted from an end of its diagonal: the shorter one, unless there is an edge or a diagonal
/// with these ends already.
pub(crate) fn split(quads: &QuadMesh) -> Vec<[u32; 3]> {
    let positions = quads.positions();
    let squared = |a: u32, b: u32| {
        let (a, b) = (positions[a as usize], positions[b as usize]);
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>()
    };
    let ends = |a: u32, b: u32| [a.min(b), a.max(b)];
    let sides = quads.quads().iter().flat_map(|q| (0..4).map(|k| ends(q[k], q[(k + 1) % 4])));
    let mut taken: HashSet<[u32; 2]> = sides.collect();
    let mut faces = Vec::with_capacity(2 * quads.quads().len());
    for &[a, b, c, d] in quads.quads() {
        let (first, second) = (!taken.contains(&ends(a, c)), !taken.contains(&ends(b, d)));
        let is_shorter = squared(b, d) < squared(a, c);
        let [a, b, c, d] = match (first, second) {
            (false, true) => [b, c, d, a],
            (true, false) => [a, b, c, d],
            _ if is_shorter => [b, c, d, a],
            _ => [a, b, c, d],
        };
        taken.insert(ends(a, c));
        faces.extend([[a, b, c], [a, c, d]]);
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::split;
    use crate::QuadMesh;

    #[test]
    fn diagonals_are_short_and_no_two_have_the_same_ends() {
        let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        let one = QuadMesh::new(corners.to_vec(), vec![[0, 1, 2, 3]]).unwrap();
        assert_eq!(split(&one), [[1, 2, 3], [1, 3, 0]]);
        // A pillow: the second quad cannot have the diagonal of the first.
        let two = QuadMesh::new(corners.to_vec(), vec![[0, 1, 2, 3], [3, 2, 1, 0]]).unwrap();
        assert_eq!(split(&two)[2..], [[2, 1, 0], [2, 0, 3]]);
    }
}
