//! A mesh of quads.

/// Vertices and quads, each quad counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadMesh {
    positions: Vec<[f64; 3]>,
    quads: Vec<[u32; 4]>,
}

/// Why vertices and quads are no mesh.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum QuadMeshError {
    /// A quad names a vertex that is not there.
    #[error("quad {quad} names vertex {vertex}, of {count}")]
    NoSuchVertex {
        /// The quad.
        quad: usize,
        /// The vertex it names.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
}

impl QuadMesh {
    /// Takes vertices and quads whose indices are in range.
    ///
    /// # Errors
    /// [`QuadMeshError::NoSuchVertex`].
    pub fn new(positions: Vec<[f64; 3]>, quads: Vec<[u32; 4]>) -> Result<Self, QuadMeshError> {
        let count = positions.len();
        for (quad, corners) in quads.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
                return Err(QuadMeshError::NoSuchVertex { quad, vertex, count });
            }
        }
        Ok(Self { positions, quads })
    }

    /// Vertices and quads whose indices are known to be in range.
    pub(crate) fn from_parts(positions: Vec<[f64; 3]>, quads: Vec<[u32; 4]>) -> Self {
        debug_assert!(quads.iter().flatten().all(|&v| (v as usize) < positions.len()));
        Self { positions, quads }
    }

    /// Positions of the vertices.
    pub fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    /// Corners of the quads.
    pub fn quads(&self) -> &[[u32; 4]] {
        &self.quads
    }
}
