//! Cutting a mesh open so that it can be laid out in the plane.

mod chains;
mod dual_tree;
mod gauge;
pub(crate) mod isometric;
mod matched;
mod partial;
mod prescribed;
mod prune;
mod steiner;
mod unfolding;

pub use chains::{Chain, SeamGraph};
pub use dual_tree::{DualTree, curvature_weight, flatter_end};
pub use gauge::{regauge, turned_vertices};
pub use isometric::{frames_of_angles, rotations, unfold};
pub(crate) use matched::in_gauge;
pub use matched::{FramedCut, MatchedCut};
pub use partial::PartialCut;
pub(crate) use steiner::DisjointSets;
pub use steiner::connect_cones;
pub use unfolding::Unfolding;

use seamstress_mesh::{Halfedge, HalfedgeData, TriMesh};

/// A mesh cut along seams: which corners share a UV, and which edges are seams.
///
/// A *wedge* is a fan of corners around a vertex between seams; it carries one UV.
#[derive(Debug, Clone)]
pub struct Cut {
    /// Wedge of each corner.
    pub wedge: HalfedgeData<u32>,
    /// Number of wedges.
    pub n_wedges: usize,
    /// Left half-edge of each seam (the smaller id); its twin is the right one.
    pub seams: Vec<Halfedge>,
    /// Whether the edge is a seam; the same on twins. Boundary edges are none.
    pub is_seam: HalfedgeData<bool>,
}

impl Cut {
    /// Cuts every interior edge that is not `glued`.
    pub fn new(mesh: &TriMesh, glued: impl Fn(Halfedge) -> bool) -> Self {
        let mut wedge = HalfedgeData::filled(mesh.n_halfedges(), u32::MAX);
        let mut is_seam = HalfedgeData::filled(mesh.n_halfedges(), false);
        let mut seams = Vec::new();
        for h in mesh.interior_edges().filter(|&h| !glued(h)) {
            seams.push(h);
            is_seam[h] = true;
            if let Some(t) = mesh.twin(h) {
                is_seam[t] = true;
            }
        }
        let mut n_wedges = 0;
        for v in mesh.vertices() {
            let fan: Vec<Halfedge> = mesh.outgoing(v).collect();
            // Start behind a seam or the boundary; without one the fan is one wedge.
            let open = |h: Halfedge| is_seam[h] || mesh.twin(h).is_none();
            let start = fan.iter().position(|&h| open(h)).unwrap_or(0);
            for k in 0..fan.len() {
                let h = fan[(start + k) % fan.len()];
                if k == 0 || open(h) {
                    n_wedges += 1;
                }
                wedge[h] = n_wedges as u32 - 1;
            }
        }
        Self { wedge, n_wedges, seams, is_seam }
    }

    /// The wedges of a half-edge's origin and tip, in its own face.
    #[inline]
    pub fn ends(&self, h: Halfedge) -> [u32; 2] {
        [self.wedge[h], self.wedge[h.next()]]
    }

    /// The wedges at the ends of a seam: origin and tip on the left, origin and tip on the right.
    pub fn seam_wedges(&self, mesh: &TriMesh, left: Halfedge) -> [u32; 4] {
        let [a, b] = self.ends(left);
        let right = mesh.twin(left).map_or([b, a], |t| self.ends(t));
        [a, b, right[1], right[0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cutting_a_tetrahedron_along_a_dual_tree_gives_a_disk() {
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        let mesh = TriMesh::from_faces(4, &faces).unwrap();
        let tree = DualTree::lightest(&mesh, |h| f64::from(h.0));
        let cut = Cut::new(&mesh, |h| tree.crossed[h]);
        // a disk of 4 triangles glued along 3 edges has 6 wedges, and 6 - 3 edges are seams
        assert_eq!((cut.n_wedges, cut.seams.len()), (6, 3));
        assert_eq!(tree.order.len(), 4);
        let whole = Cut::new(&mesh, |_| true);
        assert_eq!((whole.n_wedges, whole.seams.len()), (4, 0));
        for h in mesh.halfedges() {
            assert_eq!(whole.wedge[h], mesh.origin(h).0);
        }
    }
}
