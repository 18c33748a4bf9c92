//! Matchings with given indices.

use super::{MatchedCut, Unfolding};
use crate::features::Sectors;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, Vertex, VertexData};

impl MatchedCut {
    /// Some matchings of a connected mesh without aligned edges whose interior vertices have these indices (quarters), if
    /// they sum up to those of any: which, is a matter of the rotations around handles and between boundaries.
    ///
    /// What the nearest matchings have too much goes along a tree, to the boundary or to the vertex that is left.
    pub fn with_indices(
        sectors: &Sectors<'_>,
        metric: &Metric,
        unfolding: Unfolding,
        indices: &VertexData<i32>,
    ) -> Self {
        let mesh = sectors.slit();
        let nearest = Self::nearest(unfolding);
        let found = nearest.sector_indices(sectors, metric);
        let is_free = |v: Vertex| sectors.is_free(v);
        let surplus = |v| if is_free(v) { 0 } else { found[v] - indices[v] };
        let mut surplus: VertexData<i32> = mesh.vertices().map(surplus).collect();

        // Breadth first from the boundary, or from any vertex: the way from each to the one before it.
        let mut way: VertexData<Option<Halfedge>> = VertexData::filled(mesh.n_vertices(), None);
        let mut order: Vec<Vertex> = mesh.vertices().filter(|&v| is_free(v)).collect();
        order.extend(mesh.vertices().next().filter(|_| order.is_empty()));
        let mut is_reached = VertexData::filled(mesh.n_vertices(), false);
        order.iter().for_each(|&v| is_reached[v] = true);
        let mut next = 0;
        while let Some(&v) = order.get(next) {
            next += 1;
            for back in mesh.outgoing(v).filter_map(|h| mesh.twin(h)) {
                let from = mesh.origin(back);
                if !is_reached[from] {
                    is_reached[from] = true;
                    way[from] = Some(back);
                    order.push(from);
                }
            }
        }

        let mut transport = HalfedgeData::filled(mesh.n_halfedges(), 0);
        for &v in order.iter().rev() {
            let Some(h) = way[v] else { continue };
            transport[h] += surplus[v];
            if let Some(t) = mesh.twin(h) {
                transport[t] -= surplus[v];
            }
            surplus[mesh.tip(h)] += surplus[v];
        }
        nearest.turned(sectors, &transport).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cut::DualTree;
    use seamstress_mesh::TriMesh;
    use seamstress_mesh::soup::TriangleSoup;
    use seamstress_testkit as kit;

    fn found(soup: &TriangleSoup, indices: &[(u32, i32)]) -> Vec<(u32, i32)> {
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let metric = Metric::from_positions(&mesh, &soup.positions);
        let sectors = Sectors::unaligned(&mesh);
        let tree = DualTree::lightest(&mesh, |h| f64::from(h.0));
        let unfolding = Unfolding::new(&sectors, &metric, tree);
        let mut wanted = VertexData::filled(mesh.n_vertices(), 0);
        indices.iter().for_each(|&(v, k)| wanted[Vertex(v)] = k);
        let matched = MatchedCut::with_indices(&sectors, &metric, unfolding, &wanted);
        let found = matched.sector_indices(&sectors, &metric);
        found.enumerate().filter(|(_, k)| **k != 0).map(|(v, &k)| (v.0, k)).collect()
    }

    #[test]
    fn vertices_have_the_indices_asked_for() {
        // The indices of a torus sum up to zero, those of a ball to eight.
        let torus = kit::torus(12, 8, 2.0, 0.7);
        assert_eq!(found(&torus, &[(3, 1), (50, -2), (77, 1)]), [(3, 1), (50, -2), (77, 1)]);
        let octahedron = kit::octahedron();
        assert_eq!(found(&octahedron, &[(0, 3), (5, 3), (2, 2)]), [(0, 3), (2, 2), (5, 3)]);
        // On a disk the boundary takes the rest.
        assert_eq!(found(&kit::disk_grid(6, 6), &[(24, 2)]), [(24, 2)]);
    }
}
