//! Coincident vertices, made one.

use super::{EdgeSet, TriMesh};
use crate::ids::Vertex;
use crate::soup::sets::SignedSets;
use crate::vector::{norm, sub};
use std::collections::HashMap;

/// A mesh whose edges without length have been collapsed. Vertices keep their numbers; some are no longer used.
pub(super) struct Merged {
    pub(super) mesh: TriMesh,
    /// The face that each face was.
    pub(super) face_origin: Vec<u32>,
    /// The vertex that each vertex was merged into.
    into: Vec<u32>,
}

/// Edges shorter than this part of the longest edge of their faces have no length to speak of: coordinates in files often
/// have seven digits.
const NO_LENGTH: f64 = 1e-6;

impl Merged {
    /// None if every edge has a length, or the surface would be no manifold without those that have none.
    pub(super) fn new(mesh: &TriMesh, positions: &[[f64; 3]]) -> Option<Self> {
        let length = |h| {
            let [a, b] = [mesh.origin(h), mesh.tip(h)].map(|v| positions[v.at()]);
            norm(sub(b, a))
        };
        let mut sets = SignedSets::new(mesh.n_vertices());
        let mut is_any = false;
        for h in mesh.halfedges() {
            let longest = h.face().halfedges().map(length).into_iter().fold(0.0, f64::max);
            if length(h) <= NO_LENGTH * longest {
                sets.join(mesh.origin(h).0, mesh.tip(h).0, false);
                is_any = true;
            }
        }
        if !is_any {
            return None;
        }
        let into = sets.into_roots();
        let (mut faces, mut face_origin) = (Vec::new(), Vec::new());
        for f in mesh.faces() {
            let [a, b, c] = mesh.face_vertices(f).map(|v| into[v.at()]);
            if a != b && b != c && c != a {
                faces.push([a, b, c]);
                face_origin.push(f.0);
            }
        }
        let mesh = TriMesh::from_faces(mesh.n_vertices(), &faces).ok()?;
        Some(Self { mesh, face_origin, into })
    }

    /// Edges of the mesh as it was, and for the ends of each, ascending, how they were named.
    pub(super) fn edges(
        &self,
        source: &TriMesh,
        edges: &EdgeSet,
    ) -> (EdgeSet, HashMap<[u32; 2], [u32; 2]>) {
        let mut names = HashMap::new();
        let mut merged = Vec::new();
        for name in edges.vertex_pairs(source) {
            let [a, b] = name.map(|v| self.into[v as usize]);
            if let Some(edge) = self.mesh.edge_between(Vertex(a), Vertex(b)) {
                names.insert([a.min(b), a.max(b)], name);
                merged.push(edge);
            }
        }
        (EdgeSet::new(&self.mesh, merged), names)
    }
}
