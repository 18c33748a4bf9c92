//! Cotangent weights of edges.

use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh};

/// Cotangent weights of edges are kept in this range: needles would drown everything else.
const WEIGHT_RANGE: (f64, f64) = (0.02, 20.0);

/// Cotangent weight of an edge, kept within [`WEIGHT_RANGE`].
pub(crate) fn edge_weight(mesh: &TriMesh, cotangent: &HalfedgeData<f64>, h: Halfedge) -> f64 {
    let sum = cotangent[h] + mesh.twin(h).map_or(0.0, |t| cotangent[t]);
    (sum / 2.0).clamp(WEIGHT_RANGE.0, WEIGHT_RANGE.1)
}
