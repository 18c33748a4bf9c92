//! A mesh cut along every edge that a dual tree does not cross, and unfolded.

use super::{Cut, DualTree, flatter_end, isometric};
use crate::features::Sectors;
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, Metric, VertexData};
use std::f64::consts::FRAC_PI_2;

/// A slit mesh cut along every edge that a dual tree does not cross and laid out in the plane without distortion:
/// its seams turn by real numbers of quarter turns. Rounding gives each an integer, which makes it a
/// [`MatchedCut`](super::MatchedCut).
///
/// The rotation of a seam leads from its left to its right image; that of an aligned half-edge from its
/// image to the u axis, which is its image on the ground: an edge of direction `a` quarters has rotation
/// `-a`. (The rotation across an interior feature follows from those of its two halves.)
#[derive(Debug, Clone)]
pub struct Unfolding {
    /// The dual tree of the faces and the ground.
    pub tree: DualTree,
    /// The cut of the slit mesh: every interior edge off the tree is a seam.
    pub cut: Cut,
    /// The half-edges that turn: the left ones of the seams, in their order, then the aligned ones by
    /// which no face hangs on the ground.
    pub turning: Vec<Halfedge>,
    /// Lifted rotation of each of them, quarter turns.
    pub isometric: Vec<f64>,
}

impl Unfolding {
    /// Cuts and unfolds along a dual tree.
    pub fn new(sectors: &Sectors<'_>, metric: &Metric, tree: DualTree) -> Self {
        let cut = Cut::new(sectors.slit(), |h| tree.crossed[h]);
        let mut turning = cut.seams.clone();
        turning.extend(sectors.aligned().filter(|&h| !tree.crossed[h]));
        let isometric = isometric::rotations(sectors.slit(), &metric.angle, &tree, &turning);
        Self { tree, cut, turning, isometric }
    }

    /// Along the tree that leaves seams to curved sectors; the faces at aligned edges hang on the ground, by the
    /// longest first.
    pub fn through_curved_sectors(sectors: &Sectors<'_>, metric: &Metric) -> Self {
        let grounding = sectors.aligned().map(|h| (-metric.length[h], h));
        let weight = flatter_end(sectors.slit(), sectors.bend(metric));
        Self::new(sectors, metric, DualTree::grounded(sectors.slit(), grounding, weight))
    }

    /// Positions of the wedges in the plane, in units of the metric.
    pub fn positions(&self, sectors: &Sectors<'_>, metric: &Metric) -> Vec<Complex64> {
        isometric::unfold(sectors.slit(), metric, &self.tree, &self.cut)
    }

    /// Index of every sector, in quarters, for rotations `r` (any reals):
    /// `k = 2 K / pi - sum over turning edges from v of (r - r0) + sum over those to v of (r - r0)`.
    ///
    /// At integer matchings the index of a sector that is not free is an integer; the sum over all
    /// sectors is 4 chi of the slit mesh.
    pub fn indices(&self, sectors: &Sectors<'_>, metric: &Metric, r: &[f64]) -> VertexData<f64> {
        let slit = sectors.slit();
        let mut k: VertexData<f64> =
            metric.curvature(slit).iter().map(|defect| defect / FRAC_PI_2).collect();
        for (s, &h) in self.turning.iter().enumerate() {
            let d = r[s] - self.isometric[s];
            k[slit.origin(h)] -= d;
            k[slit.tip(h)] += d;
        }
        k
    }
}
