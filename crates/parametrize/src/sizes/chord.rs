//! Sizes at which cells leave a surface alike far.

use super::fit::{Bounds, SizeError, fitted};
use crate::field::curvature;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{HalfedgeData, Metric, TriMesh, VertexData};

/// Curvature is averaged over this part of a cell: less than the smallest cells have.
const RADIUS: f64 = 0.25;
/// The least and the largest size: smaller cells are worth little, and larger ones follow no shape.
const BOUNDS: Bounds = Bounds([0.2, 3.0]);
/// What counts as flat: bent by so much over a cell.
const FLAT: f64 = 1e-3;

/// At each vertex the largest principal curvature, either way, times the length of a cell; along features it bends nothing.
pub(super) fn bends(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    metric: &Metric,
    features: &EdgeSet,
    cell: f64,
) -> Result<VertexData<f64>, SizeError> {
    let is_feature: HalfedgeData<bool> = mesh.halfedges().map(|h| features.contains(h)).collect();
    let (slit, vertex) = mesh.slit(&is_feature);
    let slit_positions: Vec<[f64; 3]> = vertex.iter().map(|v| positions[v.at()]).collect();
    let curvature = curvature(&slit, &slit_positions, metric, RADIUS * cell)?;
    let mut bends = VertexData::filled(mesh.n_vertices(), 0.0f64);
    for f in mesh.faces() {
        let bend = cell * (curvature[f].mean.abs() + curvature[f].anisotropy.norm());
        mesh.face_vertices(f).into_iter().for_each(|v| bends[v] = bends[v].max(bend));
    }
    Ok(bends)
}

/// Sizes `h` with the same height `k h^2 / 8` of an arc of curvature `k` over each.
pub(super) fn sizes(
    bends: &VertexData<f64>,
    area: &VertexData<f64>,
    goal: f64,
) -> Result<Vec<f64>, SizeError> {
    let wanted: Vec<f64> = bends.iter().map(|bend| 1.0 / bend.max(FLAT).sqrt()).collect();
    fitted(&wanted, area, goal, BOUNDS)
}
