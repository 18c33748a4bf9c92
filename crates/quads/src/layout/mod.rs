//! Quad meshes in the plane, every quad a unit square (Levi 2021, suppl. sec. 7).

mod conformal;
mod squares;

pub use conformal::lay_out_conformal;
pub use squares::lay_out_squares;

use seamstress_mesh::{MeshError, TriMesh};

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
