//! Points of a surface by face and weights.

/// A point of the surface.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SurfacePoint {
    /// The face it lies on.
    pub face: u32,
    /// Weights of the face's vertices; they sum to 1.
    pub barycentric: [f64; 3],
}

impl SurfacePoint {
    /// Where it is in space.
    pub fn position(&self, positions: &[[f64; 3]], faces: &[[u32; 3]]) -> [f64; 3] {
        let corners = faces[self.face as usize].map(|v| positions[v as usize]);
        [0, 1, 2].map(|axis| (0..3).map(|k| self.barycentric[k] * corners[k][axis]).sum())
    }

    /// What values of the vertices are there.
    pub fn interpolate(&self, values: &[f64], faces: &[[u32; 3]]) -> f64 {
        self.weighted(faces[self.face as usize].map(|v| values[v as usize]))
    }

    /// The mean of values at the corners of the face.
    pub(crate) fn weighted(&self, corners: [f64; 3]) -> f64 {
        (0..3).map(|k| self.barycentric[k] * corners[k]).sum()
    }
}
