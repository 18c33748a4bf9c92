//! Half-edge connectivity of an oriented triangle manifold.

use crate::directed::Directed;
use crate::ids::{Face, FaceData, Halfedge, HalfedgeData, Vertex, VertexData};

const NONE: u32 = u32::MAX;

/// Why faces do not make a mesh. [`crate::soup::check`] lists every fault; this is the first one met.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no face.
    #[error("the mesh has no face")]
    NoFaces,
    /// More than about a billion faces.
    #[error("the mesh has more than {} faces", u32::MAX / 4)]
    TooManyFaces,
    /// A face names a vertex that does not exist, or one vertex twice.
    #[error("face {face} does not have three different vertices among {n_vertices}")]
    BadFace {
        /// The face.
        face: u32,
        /// Number of vertices.
        n_vertices: usize,
    },
    /// Two faces run along an edge in the same direction.
    #[error("edge {from}-{to} is used twice in the same direction, the second time by face {face}")]
    RepeatedHalfedge {
        /// Origin of the half-edge.
        from: u32,
        /// Tip of the half-edge.
        to: u32,
        /// The second face.
        face: u32,
    },
    /// The faces around a vertex do not form one fan.
    #[error("vertex {0} has more than one fan of faces")]
    NonManifoldVertex(u32),
}

/// Connectivity of an oriented triangle manifold, possibly with boundary; no geometry.
///
/// Vertices without a face are allowed; they have no outgoing half-edge.
#[derive(Debug, Clone, PartialEq)]
pub struct TriMesh {
    origin: HalfedgeData<Vertex>,
    twin: HalfedgeData<u32>,
    outgoing: VertexData<u32>,
    boundary: VertexData<bool>,
}

impl TriMesh {
    /// Builds the connectivity from vertex triples.
    ///
    /// # Errors
    /// The first fault met; see [`MeshError`].
    pub fn from_faces(n_vertices: usize, faces: &[[u32; 3]]) -> Result<Self, MeshError> {
        if faces.is_empty() {
            return Err(MeshError::NoFaces);
        }
        if faces.len() > (u32::MAX / 4) as usize {
            return Err(MeshError::TooManyFaces);
        }
        let is_bad = |&[a, b, c]: &[u32; 3]| {
            [a, b, c].iter().any(|&v| v as usize >= n_vertices) || a == b || b == c || c == a
        };
        if let Some(face) = faces.iter().position(is_bad) {
            return Err(MeshError::BadFace { face: face as u32, n_vertices });
        }
        let directed = Directed::new(n_vertices, faces);
        if let Some((from, to, h)) = directed.first_repeated() {
            return Err(MeshError::RepeatedHalfedge { from, to, face: h / 3 });
        }
        let origin: HalfedgeData<Vertex> = faces.iter().flatten().map(|&v| Vertex(v)).collect();
        let mut mesh = TriMesh {
            twin: HalfedgeData::filled(origin.len(), NONE),
            outgoing: VertexData::filled(n_vertices, NONE),
            boundary: VertexData::filled(n_vertices, false),
            origin,
        };
        for h in mesh.halfedges() {
            let (from, to) = (mesh.origin(h), mesh.tip(h));
            if let Some(t) = directed.find(to.0, from.0) {
                mesh.twin[h] = t;
            } else {
                mesh.boundary[from] = true;
                mesh.boundary[to] = true;
            }
            if mesh.outgoing[from] == NONE || mesh.twin[h] == NONE {
                mesh.outgoing[from] = h.0;
            }
        }
        mesh.check_fans()?;
        Ok(mesh)
    }

    fn check_fans(&self) -> Result<(), MeshError> {
        let mut corners = VertexData::filled(self.n_vertices(), 0u32);
        for h in self.halfedges() {
            corners[self.origin(h)] += 1;
        }
        for v in self.vertices() {
            if self.outgoing(v).count() as u32 != corners[v] {
                return Err(MeshError::NonManifoldVertex(v.0));
            }
        }
        Ok(())
    }

    /// #V.
    pub fn n_vertices(&self) -> usize {
        self.outgoing.len()
    }

    /// #F.
    pub fn n_faces(&self) -> usize {
        self.origin.len() / 3
    }

    /// Number of half-edges, three per face.
    pub fn n_halfedges(&self) -> usize {
        self.origin.len()
    }

    /// #E.
    pub fn n_edges(&self) -> usize {
        self.edges().count()
    }

    /// All vertices.
    pub fn vertices(&self) -> impl Iterator<Item = Vertex> + use<> {
        (0..self.outgoing.len() as u32).map(Vertex)
    }

    /// All faces.
    pub fn faces(&self) -> impl Iterator<Item = Face> + use<> {
        (0..self.n_faces() as u32).map(Face)
    }

    /// All half-edges.
    pub fn halfedges(&self) -> impl Iterator<Item = Halfedge> + use<> {
        (0..self.origin.len() as u32).map(Halfedge)
    }

    /// One half-edge per edge: the smaller of the two, or the only one.
    pub fn edges(&self) -> impl Iterator<Item = Halfedge> + '_ {
        self.halfedges().filter(|h| h.0 < self.twin[*h])
    }

    /// One half-edge per interior edge.
    pub fn interior_edges(&self) -> impl Iterator<Item = Halfedge> + '_ {
        self.edges().filter(|h| self.twin[*h] != NONE)
    }

    /// The half-edge on the other side, or `None` on the boundary.
    #[inline]
    pub fn twin(&self, h: Halfedge) -> Option<Halfedge> {
        let t = self.twin[h];
        (t != NONE).then_some(Halfedge(t))
    }

    /// Where a half-edge starts; the vertex of a corner.
    #[inline]
    pub fn origin(&self, h: Halfedge) -> Vertex {
        self.origin[h]
    }

    /// Where a half-edge ends.
    #[inline]
    pub fn tip(&self, h: Halfedge) -> Vertex {
        self.origin[h.next()]
    }

    /// The three vertices of a face.
    #[inline]
    pub fn face_vertices(&self, f: Face) -> [Vertex; 3] {
        f.halfedges().map(|h| self.origin[h])
    }

    /// Outgoing half-edges of a vertex counter-clockwise; at a boundary vertex from the first to the
    /// last face of its fan.
    pub fn outgoing(&self, v: Vertex) -> Outgoing<'_> {
        let first = self.outgoing[v];
        Outgoing { mesh: self, first, next: first }
    }

    /// The edge between two vertices, as the smaller of its half-edges; `None` if there is none, or
    /// no such vertex.
    pub fn edge_between(&self, a: Vertex, b: Vertex) -> Option<Halfedge> {
        let towards = |from: Vertex, to: Vertex| {
            let exists = from.at() < self.n_vertices();
            let mut outgoing = exists.then(|| self.outgoing(from)).into_iter().flatten();
            outgoing.find(|&h| self.tip(h) == to)
        };
        towards(a, b).into_iter().chain(towards(b, a)).min()
    }

    /// Number of faces at a vertex.
    pub fn valence(&self, v: Vertex) -> usize {
        self.outgoing(v).count()
    }

    /// Whether the vertex lies on the boundary.
    #[inline]
    pub fn is_boundary(&self, v: Vertex) -> bool {
        self.boundary[v]
    }

    /// Whether there is a boundary.
    pub fn has_boundary(&self) -> bool {
        self.boundary.iter().any(|&b| b)
    }

    /// The mesh cut open along edges, and the vertex that each of its vertices comes from.
    ///
    /// Faces and half-edges keep their ids. Every fan of corners between cut edges becomes a vertex of
    /// its own; the first at a vertex keeps its id, the others are numbered behind all vertices. Edges are
    /// given by both half-edges; boundary edges are open already.
    #[must_use]
    pub fn slit(&self, along: &HalfedgeData<bool>) -> (Self, VertexData<Vertex>) {
        let mut slit = self.clone();
        for h in self.halfedges().filter(|&h| along[h]) {
            slit.twin[h] = NONE;
        }
        let mut source: VertexData<Vertex> = self.vertices().collect();
        for v in self.vertices() {
            let fan: Vec<Halfedge> = self.outgoing(v).collect();
            let is_start = |&k: &usize| slit.twin[fan[k]] == NONE;
            let starts: Vec<usize> = (0..fan.len()).filter(is_start).collect();
            for (i, &start) in starts.iter().enumerate() {
                let id = if i == 0 { v } else { Vertex::from(source.len()) };
                if i > 0 {
                    source.0.push(v);
                    slit.outgoing.0.push(NONE);
                    slit.boundary.0.push(true);
                }
                slit.outgoing[id] = fan[start].0;
                slit.boundary[id] = true;
                let end = starts.get(i + 1).copied().unwrap_or(starts[0] + fan.len());
                (start..end).for_each(|k| slit.origin[fan[k % fan.len()]] = id);
            }
        }
        (slit, source)
    }

    /// Euler characteristic #V - #E + #F, vertices without a face left out, boundaries unfilled.
    pub fn euler_characteristic(&self) -> i64 {
        let used = self.outgoing.iter().filter(|&&h| h != NONE).count();
        used as i64 - self.n_edges() as i64 + self.n_faces() as i64
    }

    /// Number of boundary loops.
    pub fn n_boundary_loops(&self) -> usize {
        let mut seen = HalfedgeData::filled(self.n_halfedges(), false);
        let mut loops = 0;
        for start in self.halfedges().filter(|h| self.twin[*h] == NONE) {
            if seen[start] {
                continue;
            }
            loops += 1;
            let mut h = start;
            while !seen[h] {
                seen[h] = true;
                // The boundary leaves a vertex along its first outgoing half-edge.
                h = Halfedge(self.outgoing[self.tip(h)]);
            }
        }
        loops
    }

    /// Genus of a connected mesh.
    pub fn genus(&self) -> i64 {
        (2 - self.euler_characteristic() - self.n_boundary_loops() as i64) / 2
    }

    /// Faces joined across edges: a label per face, and how many labels there are.
    pub fn connected_faces(&self) -> (FaceData<u32>, usize) {
        let mut label = FaceData::filled(self.n_faces(), NONE);
        let mut count = 0;
        let mut stack = Vec::new();
        for start in self.faces() {
            if label[start] != NONE {
                continue;
            }
            label[start] = count;
            stack.push(start);
            while let Some(f) = stack.pop() {
                for t in f.halfedges().into_iter().filter_map(|h| self.twin(h)) {
                    if label[t.face()] == NONE {
                        label[t.face()] = count;
                        stack.push(t.face());
                    }
                }
            }
            count += 1;
        }
        (label, count as usize)
    }
}

/// Iterator of [`TriMesh::outgoing`].
pub struct Outgoing<'a> {
    mesh: &'a TriMesh,
    first: u32,
    next: u32,
}

impl Iterator for Outgoing<'_> {
    type Item = Halfedge;

    fn next(&mut self) -> Option<Halfedge> {
        if self.next == NONE {
            return None;
        }
        let h = Halfedge(self.next);
        let t = self.mesh.twin[h.prev()];
        self.next = if t == self.first { NONE } else { t };
        Some(h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];

    #[test]
    fn tetrahedron() {
        let mesh = TriMesh::from_faces(4, &TETRAHEDRON).unwrap();
        assert_eq!(mesh.euler_characteristic(), 2);
        assert_eq!(mesh.genus(), 0);
        assert_eq!(mesh.n_edges(), 6);
        assert!(!mesh.has_boundary());
        for v in mesh.vertices() {
            let fan: Vec<_> = mesh.outgoing(v).collect();
            assert_eq!(fan.len(), 3);
            assert!(fan.iter().all(|&h| mesh.origin(h) == v));
            for (i, &h) in fan.iter().enumerate() {
                assert_eq!(mesh.twin(h.prev()), Some(fan[(i + 1) % 3]));
            }
        }
    }

    #[test]
    fn edges_are_found_from_both_ends() {
        let mesh = TriMesh::from_faces(5, &[[0, 2, 3], [0, 1, 2], [0, 3, 4]]).unwrap();
        for h in mesh.edges() {
            let (a, b) = (mesh.origin(h), mesh.tip(h));
            assert_eq!(mesh.edge_between(a, b), Some(h));
            assert_eq!(mesh.edge_between(b, a), Some(h));
        }
        for [a, b] in [[1, 3], [0, 0], [0, 5], [7, 0]] {
            assert_eq!(mesh.edge_between(Vertex(a), Vertex(b)), None);
        }
    }

    #[test]
    fn fan_of_a_boundary_vertex_starts_at_the_boundary() {
        let mesh = TriMesh::from_faces(5, &[[0, 2, 3], [0, 1, 2], [0, 3, 4]]).unwrap();
        let tips: Vec<_> = mesh.outgoing(Vertex(0)).map(|h| mesh.tip(h).0).collect();
        assert_eq!(tips, [1, 2, 3]);
        assert_eq!(mesh.n_boundary_loops(), 1);
        assert_eq!(mesh.euler_characteristic(), 1);
    }

    #[test]
    fn faults_are_refused() {
        let bad = |n, faces: &[[u32; 3]]| TriMesh::from_faces(n, faces).unwrap_err();
        assert_eq!(bad(3, &[]), MeshError::NoFaces);
        assert_eq!(bad(3, &[[0, 1, 3]]), MeshError::BadFace { face: 0, n_vertices: 3 });
        assert_eq!(bad(3, &[[0, 1, 1]]), MeshError::BadFace { face: 0, n_vertices: 3 });
        assert_eq!(
            bad(4, &[[0, 1, 2], [0, 1, 3]]),
            MeshError::RepeatedHalfedge { from: 0, to: 1, face: 1 }
        );
        assert_eq!(bad(5, &[[0, 1, 2], [0, 3, 4]]), MeshError::NonManifoldVertex(0));
    }

    #[test]
    fn slitting_one_edge_opens_two_fans() {
        let mesh = TriMesh::from_faces(4, &TETRAHEDRON).unwrap();
        let cut = |ends: [u32; 2]| {
            move |h: Halfedge, m: &TriMesh| {
                ends.contains(&m.origin(h).0) && ends.contains(&m.tip(h).0)
            }
        };
        let along = mesh.halfedges().map(|h| cut([0, 1])(h, &mesh)).collect();
        let (slit, source) = mesh.slit(&along);
        // one edge became two, no vertex came apart: a sphere with a hole of two edges
        assert_eq!(source.0, [0, 1, 2, 3].map(Vertex));
        assert_eq!(
            (slit.n_edges(), slit.n_boundary_loops(), slit.euler_characteristic()),
            (7, 1, 1)
        );
        assert_eq!(slit.outgoing(Vertex(0)).count(), 3);
        let nothing = HalfedgeData::filled(12, false);
        assert_eq!(mesh.slit(&nothing).0, mesh);
    }

    #[test]
    fn slitting_a_loop_separates_the_fans_on_its_sides() {
        let mesh = TriMesh::from_faces(4, &TETRAHEDRON).unwrap();
        // around face 0, whose vertices are 0, 1 and 2
        let along = mesh.halfedges().map(|h| mesh.origin(h).0 < 3 && mesh.tip(h).0 < 3).collect();
        let (slit, source) = mesh.slit(&along);
        assert_eq!(slit.connected_faces().1, 2);
        assert_eq!((slit.n_vertices(), slit.n_boundary_loops()), (7, 2));
        for h in mesh.halfedges() {
            assert_eq!(source[slit.origin(h)], mesh.origin(h));
            assert!(slit.outgoing(slit.origin(h)).any(|g| g == h));
        }
    }

    #[test]
    fn connected_pieces() {
        let mesh = TriMesh::from_faces(7, &[[0, 1, 2], [3, 4, 5], [2, 1, 6]]).unwrap();
        let (label, count) = mesh.connected_faces();
        assert_eq!(count, 2);
        assert_eq!(label.0, [0, 1, 0]);
    }
}
