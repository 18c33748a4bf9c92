//! The edges that a map has to align with the axes.

use seamstress_surface::{Component, Face, Halfedge, HalfedgeData, TriMesh};
use std::collections::HashMap;

/// Why edges given as vertex pairs are no edges to align.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FeatureError {
    /// Pairs that are not edges of the mesh, as they were given.
    #[error("{} feature edges are not edges of the mesh: {}", pairs.len(), listed(pairs))]
    UnknownEdges {
        /// The pairs.
        pairs: Vec<[u32; 2]>,
    },
}

/// The first few pairs of a list.
fn listed(pairs: &[[u32; 2]]) -> String {
    const SHOWN: usize = 5;
    let shown: Vec<String> = pairs.iter().take(SHOWN).map(|[a, b]| format!("{a}-{b}")).collect();
    let more = if pairs.len() > SHOWN { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// The edges of a mesh whose image has to run along an axis: feature lines and, on request, the boundary.
///
/// An interior edge is aligned on both sides, so its two half-edges are marked.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureEdges {
    aligned: HalfedgeData<bool>,
}

impl FeatureEdges {
    /// No edge.
    #[must_use]
    pub fn none(mesh: &TriMesh) -> Self {
        Self { aligned: HalfedgeData::filled(mesh.n_halfedges(), false) }
    }

    /// Edges given by their end vertices in any order, repetitions allowed; with `align_boundary` all
    /// boundary edges as well.
    ///
    /// # Errors
    /// [`FeatureError::UnknownEdges`] with every pair that is not an edge.
    pub fn from_pairs(
        mesh: &TriMesh,
        pairs: &[[u32; 2]],
        align_boundary: bool,
    ) -> Result<Self, FeatureError> {
        let key = |a: u32, b: u32| (a.min(b), a.max(b));
        let by_ends: HashMap<_, _> =
            mesh.edges().map(|h| (key(mesh.origin(h).0, mesh.tip(h).0), h)).collect();
        let mut features = Self::none(mesh);
        let mut unknown = Vec::new();
        for &[a, b] in pairs {
            match by_ends.get(&key(a, b)) {
                Some(&h) => features.set(mesh, h, true),
                None => unknown.push([a, b]),
            }
        }
        if !unknown.is_empty() {
            return Err(FeatureError::UnknownEdges { pairs: unknown });
        }
        if align_boundary {
            for h in mesh.halfedges().filter(|&h| mesh.twin(h).is_none()) {
                features.set(mesh, h, true);
            }
        }
        Ok(features)
    }

    /// The edges of a component, in its own ids.
    pub(crate) fn of_component(&self, piece: &Component) -> Self {
        let whole = |f: &Face| f.halfedges().map(|h| self.aligned[h]);
        Self { aligned: piece.faces.iter().flat_map(whole).collect() }
    }

    /// Adds the edges of a component, which are in its own ids.
    pub(crate) fn add_component(&mut self, piece: &Component, edges: &Self) {
        for (i, f) in piece.faces.iter().enumerate() {
            for (h, local) in f.halfedges().into_iter().zip(Face::from(i).halfedges()) {
                self.aligned[h] |= edges.aligned[local];
            }
        }
    }

    /// Whether the edge of a half-edge is aligned.
    #[inline]
    #[must_use]
    pub fn contains(&self, h: Halfedge) -> bool {
        self.aligned[h]
    }

    /// Adds or removes the edge of a half-edge.
    pub fn set(&mut self, mesh: &TriMesh, h: Halfedge, aligned: bool) {
        self.aligned[h] = aligned;
        if let Some(t) = mesh.twin(h) {
            self.aligned[t] = aligned;
        }
    }

    /// Whether there is no edge.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.aligned.contains(&true)
    }

    /// One half-edge per edge, ascending.
    pub fn edges<'a>(&'a self, mesh: &'a TriMesh) -> impl Iterator<Item = Halfedge> + 'a {
        mesh.edges().filter(|&h| self.aligned[h])
    }

    /// The edges as vertex pairs, each once.
    #[must_use]
    pub fn pairs(&self, mesh: &TriMesh) -> Vec<[u32; 2]> {
        self.edges(mesh).map(|h| [mesh.origin(h).0, mesh.tip(h).0]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles.
    fn square() -> TriMesh {
        TriMesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap()
    }

    #[test]
    fn pairs_mark_both_sides_and_the_boundary_on_request() {
        let mesh = square();
        let diagonal = FeatureEdges::from_pairs(&mesh, &[[2, 0], [0, 2]], false).unwrap();
        assert_eq!(diagonal.pairs(&mesh), [[2, 0]]);
        assert_eq!(mesh.halfedges().filter(|&h| diagonal.contains(h)).count(), 2);
        let all = FeatureEdges::from_pairs(&mesh, &[[0, 2]], true).unwrap();
        assert_eq!(all.edges(&mesh).count(), 5);
        assert!(FeatureEdges::none(&mesh).is_empty() && !all.is_empty());
    }

    #[test]
    fn pairs_that_are_no_edges_are_listed() {
        let error = FeatureEdges::from_pairs(&square(), &[[1, 3], [0, 1], [0, 9], [2, 2]], false);
        let pairs = vec![[1, 3], [0, 9], [2, 2]];
        assert_eq!(error, Err(FeatureError::UnknownEdges { pairs }));
        let text = error.unwrap_err().to_string();
        assert_eq!(text, "3 feature edges are not edges of the mesh: 1-3, 0-9, 2-2");
    }
}
