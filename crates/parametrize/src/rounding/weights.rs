//! What a change of its index costs a sector.

use super::options::RoundingOptions;
use crate::features::Sectors;
use seamstress_mesh::{Vertex, VertexData};

/// What a quarter beyond the possible angles costs at a sector between features.
const BOUND_WEIGHT: f64 = 2.0;

/// The cost of a sector.
#[derive(Debug, Clone, Copy)]
struct Cost {
    /// Weight of the distance from the preferred indices.
    weight: f64,
    preferred: [f64; 2],
    /// Smallest and largest index at a feature; outside of them it costs more.
    bounds: (f64, f64),
}

/// The second part of the cost of a rounding: how much more or less the indices deviate from what is
/// preferred.
pub(super) struct SectorWeights(VertexData<Cost>);

impl SectorWeights {
    pub(super) fn new(sectors: &Sectors<'_>, options: &RoundingOptions) -> Self {
        let cost = |s| {
            let weight = if sectors.is_free(s) {
                0.0
            } else if sectors.is_corner(s) {
                options.corner_weight
            } else {
                options.cone_bias
            };
            let at_feature = sectors.slit().is_boundary(s) && !sectors.is_free(s);
            let bounds = if at_feature {
                let (low, high) = sectors.bounds(s);
                (f64::from(low), f64::from(high))
            } else {
                (f64::NEG_INFINITY, f64::INFINITY)
            };
            Cost { weight, preferred: sectors.preferences(s).map(f64::from), bounds }
        };
        Self(sectors.slit().vertices().map(cost).collect())
    }

    /// Change of the cost of a sector when its index goes from `index` to `index + by`.
    pub(super) fn change(&self, sector: Vertex, index: f64, by: f64) -> f64 {
        let Cost { weight, preferred: [least, most], bounds: (low, high) } = self.0[sector];
        let outside = |k: f64, low: f64, high: f64| (low - k).max(0.0) + (k - high).max(0.0);
        let deviation = |k: f64| outside(k, least, most);
        let excess = |k: f64| outside(k, low, high);
        weight * (deviation(index + by) - deviation(index))
            + BOUND_WEIGHT * (excess(index + by) - excess(index))
    }
}
