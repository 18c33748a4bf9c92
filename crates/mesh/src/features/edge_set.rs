//! A set of edges of a mesh.

use crate::components::Component;
use crate::ids::{Halfedge, HalfedgeData, Vertex};
use crate::mesh::TriMesh;

/// A set of edges of one mesh, without order or repetition.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeSet {
    /// The smaller half-edge of each edge, ascending.
    edges: Vec<Halfedge>,
    /// Set on every half-edge of every edge.
    contains: HalfedgeData<bool>,
}

impl EdgeSet {
    /// The edges of these half-edges; either half-edge names its edge.
    pub fn new(mesh: &TriMesh, halfedges: impl IntoIterator<Item = Halfedge>) -> Self {
        let mut contains = HalfedgeData::filled(mesh.n_halfedges(), false);
        for h in halfedges {
            contains[h] = true;
            if let Some(twin) = mesh.twin(h) {
                contains[twin] = true;
            }
        }
        Self { edges: mesh.edges().filter(|&h| contains[h]).collect(), contains }
    }

    /// The edges on the boundary.
    pub fn boundary(mesh: &TriMesh) -> Self {
        Self::new(mesh, mesh.edges().filter(|&h| mesh.twin(h).is_none()))
    }

    /// These edges and those of another set of the same mesh.
    #[must_use]
    pub fn union(&self, mesh: &TriMesh, other: &Self) -> Self {
        Self::new(mesh, self.edges.iter().chain(&other.edges).copied())
    }

    /// These edges without some, which either half-edge names.
    #[must_use]
    pub fn without(&self, mesh: &TriMesh, removed: impl IntoIterator<Item = Halfedge>) -> Self {
        let removed = Self::new(mesh, removed);
        Self::new(mesh, self.edges.iter().copied().filter(|&h| !removed.contains(h)))
    }

    /// The edges that lie in a connected piece of the mesh, in its own ids.
    #[must_use]
    pub fn restrict(&self, piece: &Component) -> Self {
        let whole = |h: &Halfedge| piece.faces[h.face().at()].halfedge(h.side());
        let is_in = |h: &Halfedge| self.contains(whole(h));
        Self::new(&piece.mesh, piece.mesh.halfedges().filter(is_in))
    }

    /// Whether the edge of a half-edge belongs to the set.
    #[inline]
    pub fn contains(&self, h: Halfedge) -> bool {
        self.contains[h]
    }

    /// The smaller half-edge of each edge, ascending.
    pub fn edges(&self) -> &[Halfedge] {
        &self.edges
    }

    /// Number of edges.
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// Whether there is no edge.
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// The ends of each edge, in the order of [`EdgeSet::edges`].
    pub fn vertex_pairs(&self, mesh: &TriMesh) -> Vec<[u32; 2]> {
        self.edges.iter().map(|&h| [mesh.origin(h).0, mesh.tip(h).0]).collect()
    }

    /// The edges of the set at a vertex, each with the vertex at its other end, counter-clockwise.
    pub fn around<'a>(
        &'a self,
        mesh: &'a TriMesh,
        v: Vertex,
    ) -> impl Iterator<Item = (Halfedge, Vertex)> + 'a {
        let outgoing = mesh.outgoing(v).map(|h| (h, mesh.tip(h)));
        let last = mesh.outgoing(v).last().map(Halfedge::prev);
        let incoming = last.filter(|&h| mesh.twin(h).is_none()).map(|h| (h, mesh.origin(h)));
        let smaller = |h: Halfedge| mesh.twin(h).map_or(h, |twin| h.min(twin));
        let all = outgoing.chain(incoming).filter(|&(h, _)| self.contains[h]);
        all.map(move |(h, other)| (smaller(h), other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles with the diagonal 0-2.
    fn square() -> TriMesh {
        TriMesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap()
    }

    #[test]
    fn an_edge_counts_once_whatever_half_edges_name_it() {
        let mesh = square();
        let set = EdgeSet::new(&mesh, [Halfedge(3), Halfedge(2), Halfedge(3)]);
        assert_eq!(set.edges(), [Halfedge(2)]);
        assert_eq!(set.vertex_pairs(&mesh), [[2, 0]]);
        assert!(
            set.contains(Halfedge(2)) && set.contains(Halfedge(3)) && !set.contains(Halfedge(0))
        );
        assert!(EdgeSet::new(&mesh, []).is_empty());
    }

    #[test]
    fn the_boundary_and_the_rest_make_all() {
        let mesh = square();
        let boundary = EdgeSet::boundary(&mesh);
        assert_eq!(boundary.vertex_pairs(&mesh), [[0, 1], [1, 2], [2, 3], [3, 0]]);
        let all = boundary.union(&mesh, &EdgeSet::new(&mesh, mesh.interior_edges()));
        assert_eq!(all.len(), mesh.n_edges());
    }

    #[test]
    fn edges_around_a_vertex_go_counter_clockwise() {
        let mesh = square();
        let all = EdgeSet::new(&mesh, mesh.halfedges());
        let around: Vec<_> = all.around(&mesh, Vertex(0)).collect();
        let expected = [(0, 1), (2, 2), (5, 3)];
        assert_eq!(around, expected.map(|(h, v)| (Halfedge(h), Vertex(v))));
        let diagonal = EdgeSet::new(&mesh, [Halfedge(3)]);
        let around: Vec<_> = diagonal.around(&mesh, Vertex(2)).collect();
        assert_eq!(around, [(Halfedge(2), Vertex(0))]);
    }
}
