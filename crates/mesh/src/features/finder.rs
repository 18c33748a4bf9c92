//! Edges from the names a file gives them.

use crate::ids::{Halfedge, Vertex};
use crate::mesh::TriMesh;

/// Why a name is not that of an edge.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EdgeNameError {
    /// A pair names a vertex that does not exist.
    #[error("vertex {vertex} of the pair {}-{} does not exist: there are {n_vertices}, counted from 0", pair[0], pair[1])]
    NoSuchVertex {
        /// The pair.
        pair: [u32; 2],
        /// The vertex.
        vertex: u32,
        /// Number of vertices.
        n_vertices: usize,
    },
    /// No edge joins the vertices of a pair.
    #[error("no edge joins the vertices {} and {}", pair[0], pair[1])]
    NotAnEdge {
        /// The pair.
        pair: [u32; 2],
    },
    /// A side of a face that does not exist.
    #[error("face {face} does not exist: there are {n_faces}, counted from 0")]
    NoSuchFace {
        /// The face.
        face: u32,
        /// Number of faces.
        n_faces: usize,
    },
    /// A face does not have that many sides.
    #[error("face {face} has no side {side}: it has {n_sides}, counted from 0")]
    NoSuchSide {
        /// The face.
        face: u32,
        /// The side.
        side: u32,
        /// Number of its sides.
        n_sides: usize,
    },
}

/// Finds edges by pairs of vertices, as these were called before a repair.
#[derive(Debug, Clone)]
pub struct EdgeFinder<'a> {
    mesh: &'a TriMesh,
    n_vertices: usize,
    /// For each vertex before the repair the vertices it became: where its list begins in `copies`,
    /// and one entry more; nothing if the names are those of the mesh.
    renamed: Option<Renamed>,
}

#[derive(Debug, Clone)]
struct Renamed {
    begin: Vec<usize>,
    copies: Vec<Vertex>,
}

impl<'a> EdgeFinder<'a> {
    /// Pairs name the vertices of the mesh.
    pub fn new(mesh: &'a TriMesh) -> Self {
        Self { mesh, n_vertices: mesh.n_vertices(), renamed: None }
    }

    /// Pairs name the vertices before a repair: vertex `v` of the mesh was `vertex_origin[v]` (see
    /// [`Repaired`](crate::soup::Repaired)), one of `n_vertices`.
    pub fn after_repair(mesh: &'a TriMesh, vertex_origin: &[u32], n_vertices: usize) -> Self {
        let mut begin = vec![0; n_vertices + 1];
        for &origin in vertex_origin {
            begin[origin as usize + 1] += 1;
        }
        for v in 0..n_vertices {
            begin[v + 1] += begin[v];
        }
        let mut copies: Vec<Vertex> = (0..vertex_origin.len()).map(Vertex::from).collect();
        copies.sort_by_key(|v| vertex_origin[v.at()]);
        Self { mesh, n_vertices, renamed: Some(Renamed { begin, copies }) }
    }

    /// The edge between two vertices. After a repair that split both ends there may be several.
    ///
    /// # Errors
    /// If there is no such vertex or no such edge.
    pub fn find(&self, pair: [u32; 2]) -> Result<Vec<Halfedge>, EdgeNameError> {
        if let Some(&vertex) = pair.iter().find(|&&v| v as usize >= self.n_vertices) {
            return Err(EdgeNameError::NoSuchVertex { pair, vertex, n_vertices: self.n_vertices });
        }
        let [from, to] = pair.map(|v| self.now(v));
        let pairs = from.iter().flat_map(|&a| to.iter().map(move |&b| (a, b)));
        let found: Vec<_> = pairs.filter_map(|(a, b)| self.mesh.edge_between(a, b)).collect();
        if found.is_empty() { Err(EdgeNameError::NotAnEdge { pair }) } else { Ok(found) }
    }

    /// What a vertex is called now.
    fn now(&self, v: u32) -> Vec<Vertex> {
        match &self.renamed {
            None => vec![Vertex(v)],
            Some(Renamed { begin, copies }) => {
                copies[begin[v as usize]..begin[v as usize + 1]].to_vec()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soup::{TriangleSoup, repair};

    #[test]
    fn pairs_are_found_or_refused_by_name() {
        let mesh = TriMesh::from_faces(5, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let finder = EdgeFinder::new(&mesh);
        assert_eq!(finder.find([0, 2]), Ok(vec![Halfedge(2)]));
        assert_eq!(finder.find([2, 0]), Ok(vec![Halfedge(2)]));
        for pair in [[1, 3], [0, 4], [2, 2]] {
            assert_eq!(finder.find(pair), Err(EdgeNameError::NotAnEdge { pair }));
        }
        let error = finder.find([1, 5]).unwrap_err();
        let text = "vertex 5 of the pair 1-5 does not exist: there are 5, counted from 0";
        assert_eq!(error.to_string(), text);
    }

    #[test]
    fn names_from_before_a_repair_are_followed() {
        // Two triangles that touch in vertex 3; vertex 0 belongs to no face.
        let soup = TriangleSoup {
            positions: (0..6).map(|i| [f64::from(i), f64::from(i * i), 0.0]).collect(),
            faces: vec![[1, 2, 3], [3, 4, 5]],
        };
        let repaired = repair(soup.clone());
        let mesh =
            TriMesh::from_faces(repaired.soup.positions.len(), &repaired.soup.faces).unwrap();
        let finder = EdgeFinder::after_repair(&mesh, &repaired.vertex_origin, 6);
        for [a, b] in [[1, 2], [2, 3], [3, 1], [3, 4], [5, 4], [3, 5]] {
            let [h] = finder.find([a, b]).unwrap()[..] else { panic!("{a}-{b}") };
            let ends = [mesh.origin(h), mesh.tip(h)].map(|v| repaired.vertex_origin[v.at()]);
            assert!(ends == [a, b] || ends == [b, a]);
        }
        for pair in [[0, 1], [2, 4], [3, 3]] {
            assert_eq!(finder.find(pair), Err(EdgeNameError::NotAnEdge { pair }));
        }
        assert!(matches!(finder.find([6, 0]), Err(EdgeNameError::NoSuchVertex { vertex: 6, .. })));
    }
}
