//! Cone clean-up with a second layout, kept only if it pays.

use super::domain::Domain;
use super::relaxed::{RelaxedLayout, relax};
use super::{MapOptions, Purpose, Start};
use crate::cut::FramedCut;
use crate::layout::ladder::{LayoutEffort, lay_out};
use crate::progress::{SolveError, Watch, unless_cancelled};
use crate::rounding::{CleanUpOptions, ConeCount, clean_up, fix_holonomy};

/// Price of a cone of a map that is an end in itself.
const MAP_PRICE: f64 = 0.0006;
/// Price of a quarter of a cone of a map for quads, and how many cells it is worth: on the grid a cone bends
/// the cells around it whatever their size, and takes room from its neighbours.
const QUAD_PRICE: f64 = 0.0015;
const QUAD_CELLS: f64 = 4.0;
/// A component has no fewer cells than this, however small it is: its cells are smaller then.
const FEWEST_CELLS: f64 = 24.0;

/// Bounds on the log scale that clean-up tries, loosest first, and on the deviation of indices.
const MAP_BOUNDS: [(f64, f64); 2] = [(f64::INFINITY, 1.5), (0.35, 1.5)];
/// Spikes that are small against the cells may be flattened.
const QUAD_BOUNDS: [(f64, f64); 3] = [(f64::INFINITY, 3.5), (f64::INFINITY, 1.5), (0.35, 3.5)];
/// The surrogate is less reliable between features, so bolder proposals mostly fail there.
const ALIGNED_BOUNDS: [(f64, f64); 1] = [(0.35, 1.5)];
/// For quads one is worth trying: stairs between features go at once.
const ALIGNED_QUAD_BOUNDS: [(f64, f64); 2] = [QUAD_BOUNDS[0], ALIGNED_BOUNDS[0]];

/// What tau and the excess of the energy over 4 may grow by with fewer cones, for a map that is an end in itself; to quads a
/// few distorted triangles do not matter.
const MAP_GROWTH: [f64; 2] = [1.05, 1.2];

/// What fewer cones may cost.
pub(super) struct CleanUpTerms {
    /// Mean symmetric Dirichlet energy for one cone fewer.
    price: f64,
    count: ConeCount,
    bounds: &'static [(f64, f64)],
    effort: LayoutEffort,
    /// Tau may rise by this factor, and the excess of the energy over 4; none if by any.
    growth: Option<[f64; 2]>,
}

impl CleanUpTerms {
    /// Those of a component; none if its cones stay as they were rounded.
    pub(super) fn new(domain: &Domain<'_>, start: &Start, options: &MapOptions) -> Option<Self> {
        let (usual_price, bounds, count, growth) = match options.purpose {
            Purpose::Texture => (MAP_PRICE, &MAP_BOUNDS[..], ConeCount::Cones, Some(MAP_GROWTH)),
            Purpose::Quads { edge_length } => {
                let cell = (edge_length / domain.surface.side()).powi(2).min(1.0 / FEWEST_CELLS);
                let price = QUAD_PRICE.max(QUAD_CELLS * cell);
                (price, &QUAD_BOUNDS[..], ConeCount::Quarters, None)
            }
        };
        let (bounds, effort) = match (domain.any_aligned(), options.purpose) {
            (true, Purpose::Texture) => (&ALIGNED_BOUNDS[..], LayoutEffort::Brief),
            (true, Purpose::Quads { .. }) => (&ALIGNED_QUAD_BOUNDS[..], LayoutEffort::Brief),
            (false, _) => (bounds, LayoutEffort::Thorough),
        };
        let price = options.cone_price.unwrap_or(usual_price);
        let is_wanted = price > 0.0 && start.leaves_cones_free();
        is_wanted.then_some(Self { price, count, bounds, effort, growth })
    }

    /// Whether a layout with fewer cones is worth its price.
    fn accept(&self, before: &RelaxedLayout, after: &RelaxedLayout, saved: i32) -> bool {
        let excess = |f: &RelaxedLayout| f.symmetric_dirichlet - 4.0;
        let is_within = |[tau, energy]: [f64; 2]| {
            after.tau <= tau * before.tau && excess(after) <= energy * excess(before)
        };
        excess(after) < excess(before) + self.price * f64::from(saved)
            && self.growth.is_none_or(is_within)
    }
}

/// Cleans the cones up and lays out again; keeps the result only if it is worth its price. With the iterations of all
/// layouts tried.
///
/// # Errors
/// [`SolveError`].
pub(super) fn with_fewer_cones(
    domain: &Domain<'_>,
    before: RelaxedLayout,
    terms: &CleanUpTerms,
    watch: &mut Watch<'_, '_>,
) -> Result<(RelaxedLayout, usize), SolveError> {
    let (sectors, metric) = (&domain.sectors, &domain.metric);
    let start = FramedCut {
        matched: before.layout.matched.clone(),
        frames: before.layout.space.frames(&before.layout.y),
    };
    let mut iterations = 0;
    for &(largest_scale, largest_deviation) in terms.bounds {
        let &CleanUpTerms { price, count, effort, .. } = terms;
        let options = CleanUpOptions { price, count, largest_scale, largest_deviation };
        let cleaned = clean_up(sectors, metric, &start, &options, watch);
        let Ok((cleaned, stats)) = unless_cancelled(cleaned)? else { break };
        if stats.cancelled + stats.moved == 0 {
            break;
        }
        watch.pulse()?;
        let matched = fix_holonomy(sectors, metric, cleaned.matched)?;
        watch.pulse()?;
        let cleaned = FramedCut { matched, frames: cleaned.frames };
        let laid_out = lay_out(sectors, metric, &cleaned, effort, watch);
        let Ok(Ok(layout)) = unless_cancelled(laid_out)? else { continue };
        let after = relax(domain, layout, watch)?;
        iterations += after.iterations;
        if terms.accept(&before, &after, stats.saved) {
            return Ok((after, iterations));
        }
    }
    Ok((before, iterations))
}
