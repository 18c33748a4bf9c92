//! Fans of corners between edges of a set.

use super::EdgeSet;
use crate::ids::{Halfedge, Vertex};
use crate::mesh::TriMesh;

/// A fan of corners around a vertex that no edge of a set parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sector {
    /// The corners, counter-clockwise.
    pub corners: Vec<Halfedge>,
    /// Whether it ends at a boundary edge that does not belong to the set: then nothing fixes its
    /// angle.
    pub is_free: bool,
}

/// The sectors around a vertex, counter-clockwise; one with all corners if no edge of the set, or a
/// single one, ends there.
pub fn sectors(mesh: &TriMesh, edges: &EdgeSet, v: Vertex) -> Vec<Sector> {
    let mut corners: Vec<Halfedge> = mesh.outgoing(v).collect();
    let (Some(&first), Some(&last)) = (corners.first(), corners.last()) else {
        return Vec::new();
    };
    if !mesh.is_boundary(v) {
        let start = corners.iter().position(|&h| edges.contains(h));
        corners.rotate_left(start.unwrap_or(0));
    }
    let mut found: Vec<Sector> = Vec::new();
    for h in corners {
        match found.last_mut() {
            Some(sector) if !edges.contains(h) => sector.corners.push(h),
            _ => found.push(Sector { corners: vec![h], is_free: false }),
        }
    }
    if mesh.is_boundary(v) {
        if let Some(sector) = found.first_mut() {
            sector.is_free |= !edges.contains(first);
        }
        if let Some(sector) = found.last_mut() {
            sector.is_free |= !edges.contains(last.prev());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A closed fan of six triangles around vertex 0, its rim 1 to 6.
    fn wheel() -> TriMesh {
        let faces: Vec<_> = (0..6).map(|i| [0, 1 + i, 1 + (i + 1) % 6]).collect();
        TriMesh::from_faces(7, &faces).unwrap()
    }

    fn set(mesh: &TriMesh, pairs: &[[u32; 2]]) -> EdgeSet {
        EdgeSet::new(
            mesh,
            pairs.iter().map(|p| mesh.edge_between(Vertex(p[0]), Vertex(p[1])).unwrap()),
        )
    }

    /// For each sector the faces of its corners, and whether it is free.
    fn faces(mesh: &TriMesh, pairs: &[[u32; 2]], v: u32) -> Vec<(Vec<u32>, bool)> {
        let faces = |s: Sector| (s.corners.iter().map(|h| h.face().0).collect(), s.is_free);
        sectors(mesh, &set(mesh, pairs), Vertex(v)).into_iter().map(faces).collect()
    }

    #[test]
    fn around_an_inner_vertex() {
        let mesh = wheel();
        let all = |from: u32| (0..6).map(|i| (from + i) % 6).collect::<Vec<_>>();
        assert_eq!(faces(&mesh, &[], 0)[0].0.len(), 6);
        // The edge 0-3 is the first side of face 2.
        assert_eq!(faces(&mesh, &[[0, 3]], 0), [(all(2), false)]);
        let parted = [(vec![1, 2, 3], false), (vec![4, 5, 0], false)];
        let mut found = faces(&mesh, &[[0, 2], [0, 5]], 0);
        found.sort();
        assert_eq!(found, parted);
        assert_eq!(faces(&mesh, &[[0, 1], [0, 2], [0, 3], [0, 4], [0, 5], [0, 6]], 0).len(), 6);
    }

    #[test]
    fn at_the_boundary() {
        let mesh = wheel();
        // Vertex 2 has the faces 1 and 0, parted by the edge 0-2.
        assert_eq!(faces(&mesh, &[], 2), [(vec![1, 0], true)]);
        assert_eq!(faces(&mesh, &[[0, 2]], 2), [(vec![1], true), (vec![0], true)]);
        assert_eq!(faces(&mesh, &[[2, 3]], 2), [(vec![1, 0], true)]);
        assert_eq!(faces(&mesh, &[[2, 3], [1, 2]], 2), [(vec![1, 0], false)]);
        let parted = faces(&mesh, &[[2, 3], [0, 2]], 2);
        assert_eq!(parted, [(vec![1], false), (vec![0], true)]);
    }

    #[test]
    fn a_vertex_without_face_has_none() {
        let mesh = TriMesh::from_faces(4, &[[0, 1, 2]]).unwrap();
        assert!(sectors(&mesh, &set(&mesh, &[]), Vertex(3)).is_empty());
    }
}
