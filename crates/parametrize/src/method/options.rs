//! Settings of the direct method.

use crate::features::{CornerRule, LARGEST_INDEX, Sectors};
use crate::field::{Guide, LEAST_CELL};
use crate::layout::objective::Objective;
use crate::layout::polish::PolishOptions;
use crate::map::Tolerance;
use crate::rounding::RoundingOptions;
use seamstress_mesh::{Geometry, Metric};

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

/// A component has no fewer cells than this, however small it is: its cells are smaller then.
pub(super) const FEWEST_CELLS: f64 = 24.0;

/// Settings of the direct method.
#[derive(Debug, Clone, Copy)]
pub struct MapOptions {
    /// The rounding loop.
    pub rounding: RoundingOptions,
    /// What the map is for.
    pub purpose: Purpose,
    /// Mean symmetric Dirichlet energy that may be paid for one cone fewer, in clean-up; 0 leaves the
    /// cones as they were rounded. None: 0.0005; for quads the share of the surface that four of them have, but at
    /// least 0.0015; along directions twice that, at least 0.01.
    pub cone_price: Option<f64>,
    /// The least turn of a corner of aligned curves, degrees: in itself, and for quads from the mean direction over a
    /// cell before it to that after it.
    pub corner_angle: f64,
    /// How much the map follows the principal directions of the surface, from 0 to 1.
    pub alignment: f64,
    /// Whether a feature edge that cannot be aligned is an error ([`MapError::Released`](super::MapError::Released)) rather than a
    /// line in the result.
    pub strict_features: bool,
    /// Whether to save time at the cost of some distortion, as for a preview: larger meshes have their cones looked for on
    /// coarser ones still, and layouts stop short of the minimum.
    pub fast: bool,
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
            alignment: 0.0,
            strict_features: false,
            fast: false,
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

    /// The directions to follow, if any.
    pub(super) fn guide(
        &self,
        sectors: &Sectors<'_>,
        geometry: Geometry<'_>,
        metric: &Metric,
    ) -> Option<Guide> {
        let side = metric.total_area().sqrt();
        let cell = match self.purpose {
            // Directions for textures are those for some thousand quads.
            Purpose::Texture => LEAST_CELL * side,
            Purpose::Quads { edge_length } => {
                (edge_length / metric.unit).min(side / FEWEST_CELLS.sqrt())
            }
        };
        let guide = || Guide::along_curvature(sectors, geometry, metric, cell, self.alignment).ok();
        let is_any = self.alignment > 0.0 || geometry.directions.is_some();
        if is_any { guide() } else { None }
    }

    /// The finish of a map with or without directions, if it has any. Quads along directions do without: on the grid the mean
    /// energy is minimised once more, which undoes it.
    pub(super) fn polish(&self, is_guided: bool) -> Option<&PolishOptions> {
        let is_for_grid = is_guided && matches!(self.purpose, Purpose::Quads { .. });
        self.polish.as_ref().filter(|_| !is_for_grid)
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
