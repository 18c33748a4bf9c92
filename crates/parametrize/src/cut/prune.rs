//! Seams that lead nowhere.

use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh, Vertex, VertexData};

/// Glues the last seam at a vertex, from there, wherever that is allowed, until no such end is left.
pub(super) fn prune(
    mesh: &TriMesh,
    is_seam: &mut HalfedgeData<bool>,
    may_glue: impl Fn(Vertex, Halfedge) -> bool,
) {
    let mut degree = VertexData::filled(mesh.n_vertices(), 0u32);
    for h in mesh.halfedges().filter(|&h| is_seam[h]) {
        degree[mesh.origin(h)] += 1;
    }
    let mut ends: Vec<Vertex> = mesh.vertices().filter(|&v| degree[v] == 1).collect();
    while let Some(v) = ends.pop() {
        let last = mesh.outgoing(v).find(|&h| is_seam[h] && may_glue(v, h));
        let Some((h, t)) = last.and_then(|h| Some((h, mesh.twin(h)?))) else {
            continue;
        };
        is_seam[h] = false;
        is_seam[t] = false;
        let w = mesh.tip(h);
        degree[v] = 0;
        degree[w] -= 1;
        if degree[w] == 1 {
            ends.push(w);
        }
    }
}
