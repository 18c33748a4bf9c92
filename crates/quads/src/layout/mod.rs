//! Quad meshes in the plane, section 7 of the seed: every quad is a unit square.

mod conformal;
mod squares;

pub use conformal::lay_out_conformal;
pub use squares::lay_out_squares;

use crate::QuadMesh;
use seamstress_surface::{MeshError, TriMesh};

/// A quad mesh, split into triangles, with UVs in units of one quad edge.
///
/// Quad `q` is split along its shorter diagonal into the triangles `2 q` and `2 q + 1`.
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
/// of the quad, counted from an end of its shorter diagonal.
pub(crate) fn split(quads: &QuadMesh) -> Vec<[u32; 3]> {
    let positions = quads.positions();
    let squared = |a: u32, b: u32| {
        let (a, b) = (positions[a as usize], positions[b as usize]);
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>()
    };
    let halves = |&[a, b, c, d]: &[u32; 4]| {
        let [a, b, c, d] = if squared(b, d) < squared(a, c) { [b, c, d, a] } else { [a, b, c, d] };
        [[a, b, c], [a, c, d]]
    };
    quads.quads().iter().flat_map(halves).collect()
}
