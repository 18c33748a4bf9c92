//! A cut with a matching on every seam.

use crate::cut::{Cut, DualTree};
use crate::layout::isometric;
use seamstress_surface::{HalfedgeData, Metric, TriMesh, VertexData};
use std::f64::consts::FRAC_PI_2;

/// A mesh cut along every edge that a dual tree does not cross, with the rotation of each seam in the
/// isometric layout and, once rounded, its integer matching.
#[derive(Debug, Clone)]
pub struct MatchedCut {
    /// The dual tree.
    pub tree: DualTree,
    /// The cut: every interior edge off the tree is a seam.
    pub cut: Cut,
    /// Lifted rotation of each seam in the isometric layout, quarter turns.
    pub isometric: Vec<f64>,
    /// Lifted integer matching of each seam.
    pub matching: Vec<i32>,
}

impl MatchedCut {
    /// Cuts along a dual tree; the matchings are the nearest integers.
    pub fn new(mesh: &TriMesh, metric: &Metric, tree: DualTree) -> Self {
        let cut = Cut::new(mesh, |h| tree.crossed[h]);
        let isometric = isometric::seam_rotations(mesh, metric, &tree, &cut);
        let matching = isometric.iter().map(|r| r.round() as i32).collect();
        Self { tree, cut, isometric, matching }
    }

    /// The same matchings over another metric of the same mesh.
    pub fn with_metric(&self, mesh: &TriMesh, metric: &Metric) -> Self {
        let isometric = isometric::seam_rotations(mesh, metric, &self.tree, &self.cut);
        Self { isometric, ..self.clone() }
    }

    /// Index of every vertex, in quarters, for seam rotations `r` (any reals):
    /// `k = 2 K / pi - sum over seams from v of (r - r0) + sum over seams to v of (r - r0)`.
    ///
    /// At integer matchings the index of an interior vertex is an integer; the sum over all vertices is
    /// 4 chi.
    pub fn indices(&self, mesh: &TriMesh, metric: &Metric, r: &[f64]) -> VertexData<f64> {
        let mut k: VertexData<f64> =
            metric.curvature(mesh).iter().map(|defect| defect / FRAC_PI_2).collect();
        for (s, &h) in self.cut.seams.iter().enumerate() {
            let d = r[s] - self.isometric[s];
            k[mesh.origin(h)] -= d;
            k[mesh.tip(h)] += d;
        }
        k
    }

    /// Index of every interior vertex at the integer matchings; zero on the boundary.
    pub fn cone_indices(&self, mesh: &TriMesh, metric: &Metric) -> VertexData<i32> {
        let r: Vec<f64> = self.matching.iter().map(|&r| f64::from(r)).collect();
        let k = self.indices(mesh, metric, &r);
        mesh.vertices().map(|v| if mesh.is_boundary(v) { 0 } else { k[v].round() as i32 }).collect()
    }

    /// The matchings per half-edge: negated on twins, zero across the tree.
    pub fn matching_per_halfedge(&self, mesh: &TriMesh) -> HalfedgeData<i32> {
        let mut full = HalfedgeData::filled(mesh.n_halfedges(), 0);
        for (&h, &r) in self.cut.seams.iter().zip(&self.matching) {
            full[h] = r;
            if let Some(t) = mesh.twin(h) {
                full[t] = -r;
            }
        }
        full
    }
}
