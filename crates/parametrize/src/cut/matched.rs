//! Cuts with an integer matching on every seam.

use super::{DualTree, Unfolding, regauge};
use crate::features::Sectors;
use crate::quarter::turn;
use num_complex::Complex64;
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, VertexData};

/// An unfolded mesh with a lifted integer for the rotation of every seam and aligned edge: what a seamless layout
/// closes up to.
#[derive(Debug, Clone)]
pub struct MatchedCut {
    /// The cut and its isometric rotations.
    pub unfolding: Unfolding,
    /// Lifted integer matching of each turning half-edge.
    pub matching: Vec<i32>,
}

/// A matched cut and a rotation for every face in its gauge: where a layout starts.
#[derive(Debug, Clone)]
pub struct FramedCut {
    /// The cut and its matchings.
    pub matched: MatchedCut,
    /// Rotation of each face, a unit complex number.
    pub frames: Vec<Complex64>,
}

impl FramedCut {
    /// Adds whole turns of edges, as [`MatchedCut::turned`]; the frames follow the gauge.
    #[must_use]
    pub fn turned(&self, sectors: &Sectors<'_>, by: &HalfedgeData<i32>) -> Self {
        let (matched, gauge) = self.matched.turned(sectors, by);
        Self { matched, frames: in_gauge(&self.frames, &gauge) }
    }

    /// The same where fewer edges are aligned, as [`MatchedCut::with_fewer_aligned`].
    #[must_use]
    pub fn with_fewer_aligned(
        &self,
        from: &Sectors<'_>,
        to: &Sectors<'_>,
        metric: &Metric,
    ) -> Self {
        let (matched, gauge) = self.matched.with_fewer_aligned(from, to, metric);
        Self { matched, frames: in_gauge(&self.frames, &gauge) }
    }
}

/// Frames of faces whose gauge changes by these quarter turns.
pub(crate) fn in_gauge(frames: &[Complex64], gauge: &FaceData<i32>) -> Vec<Complex64> {
    frames.iter().zip(gauge.iter()).map(|(&r, &k)| turn(r, k)).collect()
}

impl MatchedCut {
    /// Cuts along a dual tree; the matchings are the nearest integers.
    pub fn new(sectors: &Sectors<'_>, metric: &Metric, tree: DualTree) -> Self {
        Self::nearest(Unfolding::new(sectors, metric, tree))
    }

    /// The nearest integer for every rotation of an unfolding.
    pub fn nearest(unfolding: Unfolding) -> Self {
        let matching = unfolding.isometric.iter().map(|r| r.round() as i32).collect();
        Self { unfolding, matching }
    }

    /// The matchings as real numbers.
    pub fn rotations(&self) -> Vec<f64> {
        self.matching.iter().map(|&r| f64::from(r)).collect()
    }

    /// By how much each turning half-edge turns beyond its isometric rotation, quarter turns.
    pub fn excess(&self) -> impl Iterator<Item = f64> + '_ {
        self.matching.iter().zip(&self.unfolding.isometric).map(|(&r, r0)| f64::from(r) - r0)
    }

    /// Index of every sector at the integer matchings; zero where it is free.
    pub fn sector_indices(&self, sectors: &Sectors<'_>, metric: &Metric) -> VertexData<i32> {
        let k = self.unfolding.indices(sectors, metric, &self.rotations());
        k.enumerate().map(|(s, k)| if sectors.is_free(s) { 0 } else { k.round() as i32 }).collect()
    }

    /// The matchings per half-edge of the slit mesh: negated on twins, zero across the tree.
    pub fn matching_per_halfedge(&self, sectors: &Sectors<'_>) -> HalfedgeData<i32> {
        let mut full = HalfedgeData::filled(sectors.slit().n_halfedges(), 0);
        for (&h, &r) in self.unfolding.turning.iter().zip(&self.matching) {
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
        let other = Unfolding::through_curved_sectors(to, metric);
        let mut matching = self.matching_per_halfedge(from);
        let mut transport = self.transport(from);
        for [h, t] in from.aligned_pairs().filter(|&[h, _]| !to.is_aligned(h)) {
            (matching[h], transport[h]) =
                (matching[h] - matching[t] + 2, transport[h] - transport[t]);
            (matching[t], transport[t]) = (-matching[h], -transport[h]);
        }
        let (matching, gauge) = regauge(to.slit(), &other.tree, &matching);
        // The transport, which tells the lift, is brought into the gauge in which trees turn nothing.
        let mut turned = FaceData::filled(to.slit().n_faces(), 0.0);
        for &f in &other.tree.order {
            if let Some(h) = other.tree.ground[f] {
                turned[f] = transport[h];
            }
            if let Some(h) = other.tree.parent[f] {
                turned[f] = turned[h.face()] - transport[h];
            }
        }
        let lift = |(&h, r0): (&Halfedge, &f64)| {
            let right = to.slit().twin(h).map_or(0.0, |t| turned[t.face()]);
            let lifted = r0 + transport[h] + right - turned[h.face()];
            let whole_turns = ((lifted - f64::from(matching[h])) / 4.0).round() as i32;
            matching[h] + 4 * whole_turns
        };
        let matching = other.turning.iter().zip(&other.isometric).map(lift).collect();
        (Self { unfolding: other, matching }, gauge)
    }

    /// By how much each half-edge of the slit mesh turns beyond its isometric rotation: negated on twins, zero
    /// across the tree.
    fn transport(&self, sectors: &Sectors<'_>) -> HalfedgeData<f64> {
        let mut transport = HalfedgeData::filled(sectors.slit().n_halfedges(), 0.0);
        for (&h, excess) in self.unfolding.turning.iter().zip(self.excess()) {
            transport[h] = excess;
            if let Some(t) = sectors.slit().twin(h) {
                transport[t] = -transport[h];
            }
        }
        transport
    }

    /// With whole turns added to edges (per half-edge, negated on twins), in the gauge of the tree; and the
    /// quarter turns by which the faces' gauge changed.
    pub fn turned(&self, sectors: &Sectors<'_>, by: &HalfedgeData<i32>) -> (Self, FaceData<i32>) {
        let mut full = self.matching_per_halfedge(sectors);
        full.iter_mut().zip(by.iter()).for_each(|(r, by)| *r += by);
        let (moved, gauge) = regauge(sectors.slit(), &self.unfolding.tree, &full);
        let matching = self.unfolding.turning.iter().map(|&h| moved[h]).collect();
        (Self { unfolding: self.unfolding.clone(), matching }, gauge)
    }
}
