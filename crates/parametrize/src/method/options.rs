//! Settings of the direct method.

use crate::features::{CornerRule, LARGEST_INDEX};
use crate::layout::objective::Objective;
use crate::layout::polish::PolishOptions;
use crate::map::Tolerance;
use crate::rounding::RoundingOptions;
use seamstress_mesh::Metric;

/// What a map is for, which decides what its cones may cost.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Purpose {
    /// Textures, or any other use of the map itself.
    #[default]
    Texture,
    /// A quad mesh. Every quarter turn of a cone has its price, because each bends the quads around it. A few distorted
    /// triangles do not matter, so that spikes much smaller than the quads may be flattened. No cone has an index of
    /// 3, unless it is prescribed: it would become a vertex of a single quad.
    Quads {
        /// Edge length of the quads, in the unit of the positions.
        edge_length: f64,
    },
}

/// Settings of the direct method.
#[derive(Debug, Clone, Copy)]
pub struct MapOptions {
    /// The rounding loop.
    pub rounding: RoundingOptions,
    /// What the map is for.
    pub purpose: Purpose,
    /// Mean symmetric Dirichlet energy that may be paid for one cone fewer, in clean-up; 0 leaves the
    /// cones as they were rounded. None: 0.0005; for quads the share of the surface that four of them have, but at
    /// least 0.0015.
    pub cone_price: Option<f64>,
    /// The least turn of a corner of aligned curves, degrees: in itself, and for quads from the mean direction over a
    /// cell before it to that after it.
    pub corner_angle: f64,
    /// Whether a feature edge that cannot be aligned is an error ([`MapError::Released`](super::MapError::Released)) rather than a
    /// line in the result.
    pub strict_features: bool,
    /// The finish that lowers tau; none leaves the map of least energy.
    pub polish: Option<PolishOptions>,
    /// What to minimise in the end, instead of the compromise of mean and worst distortion that is made
    /// without it.
    pub objective: Option<Objective>,
    /// Tolerance of the certificate.
    pub tolerance: Tolerance,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self {
            rounding: RoundingOptions::default(),
            purpose: Purpose::default(),
            cone_price: None,
            corner_angle: 45.0,
            strict_features: false,
            polish: Some(PolishOptions::default()),
            objective: None,
            tolerance: Tolerance::default(),
        }
    }
}

impl MapOptions {
    /// Where aligned curves have corners.
    pub(super) fn corners(&self, metric: &Metric) -> CornerRule {
        let reach = match self.purpose {
            Purpose::Texture => 0.0,
            Purpose::Quads { edge_length } => edge_length / metric.unit,
        };
        CornerRule { least: self.corner_angle / 90.0, reach }
    }

    /// Largest index of a cone that is not prescribed, quarters.
    pub(super) fn largest_index(&self) -> i32 {
        match self.purpose {
            Purpose::Texture => LARGEST_INDEX,
            // A cone of index 3 would become a vertex of a single quad.
            Purpose::Quads { .. } => LARGEST_INDEX - 1,
        }
    }
}
