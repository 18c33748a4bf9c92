//! Matchings in the gauge of a dual tree.

use super::DualTree;
use seamstress_mesh::{FaceData, HalfedgeData, TriMesh, VertexData};

/// Whether the matchings around a vertex turn it: it is a cone whose index is no multiple of four.
pub fn turned_vertices(mesh: &TriMesh, matching: &HalfedgeData<i32>) -> VertexData<bool> {
    let turns = |v| {
        let total: i32 = mesh.outgoing(v).map(|h| matching[h]).sum();
        !mesh.is_boundary(v) && total.rem_euclid(4) != 0
    };
    mesh.vertices().map(turns).collect()
}

/// Moves matchings into the gauge of a cut's dual tree: zero across the tree, and the gauge itself.
///
/// `gauge[f]` quarter turns are applied to face `f`. If there is a ground, it is on the right of half-edges
/// without a twin, and does not turn.
pub fn regauge(
    mesh: &TriMesh,
    tree: &DualTree,
    matching: &HalfedgeData<i32>,
) -> (HalfedgeData<i32>, FaceData<i32>) {
    let mut gauge = FaceData::filled(mesh.n_faces(), 0);
    for &f in &tree.order {
        if let Some(h) = tree.ground[f] {
            gauge[f] = matching[h];
        }
        if let Some(h) = tree.parent[f] {
            gauge[f] = gauge[h.face()] - matching[h];
        }
    }
    let has_ground = tree.ground.iter().any(Option::is_some);
    let moved = mesh
        .halfedges()
        .map(|h| match mesh.twin(h) {
            Some(t) => matching[h] + gauge[t.face()] - gauge[h.face()],
            None if has_ground => matching[h] - gauge[h.face()],
            None => 0,
        })
        .collect();
    (moved, gauge)
}
