//! A cut with a matching on every seam.

use super::{Cut, DualTree, flatter_end, isometric, regauge};
use crate::features::Sectors;
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, VertexData};
use std::f64::consts::FRAC_PI_2;

/// A slit mesh cut along every edge that a dual tree does not cross, with the rotation of each cut edge in
/// the isometric layout and, once rounded, its integer matching.
///
/// The rotation of a seam leads from its left to its right image; that of an aligned half-edge from its
/// image to the u axis, which is its image on the ground: an edge of direction `a` quarters has rotation
/// `-a`. (The rotation across an interior feature follows from those of its two halves.)
#[derive(Debug, Clone)]
pub struct MatchedCut {
    /// The dual tree of the faces and the ground.
    pub tree: DualTree,
    /// The cut of the slit mesh: every interior edge off the tree is a seam.
    pub cut: Cut,
    /// The half-edges that turn: the left ones of the seams, in their order, then the aligned ones by
    /// which no face hangs on the ground.
    pub turning: Vec<Halfedge>,
    /// Lifted rotation of each of them in the isometric layout, quarter turns.
    pub isometric: Vec<f64>,
    /// Lifted integer matching of each of them.
    pub matching: Vec<i32>,
}

impl MatchedCut {
    /// Cuts along a dual tree; the matchings are the nearest integers.
    pub fn new(sectors: &Sectors<'_>, metric: &Metric, tree: DualTree) -> Self {
        let cut = Cut::new(sectors.slit(), |h| tree.crossed[h]);
        let mut turning = cut.seams.clone();
        turning.extend(sectors.aligned().filter(|&h| !tree.crossed[h]));
        let isometric = isometric::rotations(sectors.slit(), &metric.angle, &tree, &turning);
        let matching = isometric.iter().map(|r| r.round() as i32).collect();
        Self { tree, cut, turning, isometric, matching }
    }

    /// Cuts along the tree that leaves seams to curved sectors; the faces at aligned edges hang on the
    /// ground, by the longest first.
    pub fn through_curved_sectors(sectors: &Sectors<'_>, metric: &Metric) -> Self {
        let grounding = sectors.aligned().map(|h| (-metric.length[h], h));
        let weight = flatter_end(sectors.slit(), sectors.bend(metric));
        Self::new(sectors, metric, DualTree::grounded(sectors.slit(), grounding, weight))
    }

    /// The same matchings over another metric of the same mesh.
    pub fn with_metric(&self, sectors: &Sectors<'_>, metric: &Metric) -> Self {
        let isometric =
            isometric::rotations(sectors.slit(), &metric.angle, &self.tree, &self.turning);
        Self { isometric, ..self.clone() }
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

    /// Index of every sector at the integer matchings; zero where it is free.
    pub fn sector_indices(&self, sectors: &Sectors<'_>, metric: &Metric) -> VertexData<i32> {
        let r: Vec<f64> = self.matching.iter().map(|&r| f64::from(r)).collect();
        let k = self.indices(sectors, metric, &r);
        k.enumerate().map(|(s, k)| if sectors.is_free(s) { 0 } else { k.round() as i32 }).collect()
    }

    /// The matchings per half-edge of the slit mesh: negated on twins, zero across the tree.
    pub fn matching_per_halfedge(&self, sectors: &Sectors<'_>) -> HalfedgeData<i32> {
        let mut full = HalfedgeData::filled(sectors.slit().n_halfedges(), 0);
        for (&h, &r) in self.turning.iter().zip(&self.matching) {
            full[h] = r;
            if let Some(t) = sectors.slit().twin(h) {
                full[t] = -r;
            }
        }
        full
    }

    /// The same matchings where fewer edges are aligned, over a tree of their own; and the quarter turns by
    /// which the faces' gauge changes. Sectors that become one have the sum of their angles.
    pub fn with_fewer_aligned(
        &self,
        from: &Sectors<'_>,
        to: &Sectors<'_>,
        metric: &Metric,
    ) -> (Self, FaceData<i32>) {
        let mut other = Self::through_curved_sectors(to, metric);
        let mut matching = self.matching_per_halfedge(from);
        let mut transport = self.transport(from);
        for [h, t] in from.aligned_pairs().filter(|&[h, _]| !to.is_aligned(h)) {
            (matching[h], transport[h]) =
                (matching[h] - matching[t] + 2, transport[h] - transport[t]);
            (matching[t], transport[t]) = (-matching[h], -transport[h]);
        }
        let (matching, gauge) = regauge(to.slit(), &other.tree, &matching);
        // The transport, which tells the lift, is brought into the gauge in which trees turn nothing.
        let mut turn = FaceData::filled(to.slit().n_faces(), 0.0);
        for &f in &other.tree.order {
            if let Some(h) = other.tree.ground[f] {
                turn[f] = transport[h];
            }
            if let Some(h) = other.tree.parent[f] {
                turn[f] = turn[h.face()] - transport[h];
            }
        }
        for (e, &h) in other.turning.iter().enumerate() {
            let right = to.slit().twin(h).map_or(0.0, |t| turn[t.face()]);
            let lifted = other.isometric[e] + transport[h] + right - turn[h.face()];
            let whole_turns = ((lifted - f64::from(matching[h])) / 4.0).round() as i32;
            other.matching[e] = matching[h] + 4 * whole_turns;
        }
        (other, gauge)
    }

    /// By how much each half-edge of the slit mesh turns beyond its isometric rotation: negated on twins, zero
    /// across the tree.
    fn transport(&self, sectors: &Sectors<'_>) -> HalfedgeData<f64> {
        let mut transport = HalfedgeData::filled(sectors.slit().n_halfedges(), 0.0);
        for ((&h, &r), &r0) in self.turning.iter().zip(&self.matching).zip(&self.isometric) {
            transport[h] = f64::from(r) - r0;
            if let Some(t) = sectors.slit().twin(h) {
                transport[t] = -transport[h];
            }
        }
        transport
    }

    /// Adds whole turns of edges (per half-edge, negated on twins) and returns to the gauge of the tree;
    /// gives the quarter turns by which the faces' gauge changed.
    pub fn turn(&mut self, sectors: &Sectors<'_>, by: &HalfedgeData<i32>) -> FaceData<i32> {
        let mut full = self.matching_per_halfedge(sectors);
        full.iter_mut().zip(by.iter()).for_each(|(r, by)| *r += by);
        let (moved, gauge) = regauge(sectors.slit(), &self.tree, &full);
        for (r, &h) in self.matching.iter_mut().zip(&self.turning) {
            *r = moved[h];
        }
        gauge
    }
}
