//! Cone clean-up with a second layout, kept only if it pays.

use super::MapOptions;
use super::finish::Finished;
use crate::features::Sectors;
use crate::layout::safeguards::{Effort, LayoutError, lay_out_with};
use crate::progress::Watch;
use crate::quarter::turn;
use crate::rounding::{CleanUpError, CleanUpOptions, ConeCount, clean_up, fix_holonomy};
use seamstress_mesh::Metric;

/// Price of a cone of a map that is an end in itself.
const MAP_PRICE: f64 = 0.0006;
/// Price of a quarter of a cone of a map for quads, and how many cells it is worth: on the grid a cone bends
/// the cells around it whatever their size, and takes room from its neighbours.
const QUAD_PRICE: f64 = 0.0015;
const QUAD_CELLS: f64 = 4.0;

/// Bounds on the log scale that clean-up tries, loosest first, and on the deviation of indices.
const MAP_BOUNDS: [(f64, f64); 2] = [(f64::INFINITY, 1.5), (0.35, 1.5)];
/// Spikes that are small against the cells may be flattened.
const QUAD_BOUNDS: [(f64, f64); 3] = [(f64::INFINITY, 3.5), (f64::INFINITY, 1.5), (0.35, 3.5)];
/// The surrogate is less reliable between features, so bolder proposals mostly fail there.
const ALIGNED_BOUNDS: [(f64, f64); 1] = [(0.35, 1.5)];

/// What fewer cones may cost.
pub(super) struct Terms {
    /// Mean symmetric Dirichlet energy for one cone fewer.
    price: f64,
    count: ConeCount,
    bounds: &'static [(f64, f64)],
    effort: Effort,
    /// Tau may rise by this factor, and the excess of the energy over 4.
    growth: [f64; 2],
}

impl Terms {
    /// Those of a component; none if its cones stay as they were rounded.
    pub(super) fn new(options: &MapOptions, metric: &Metric, is_aligned: bool) -> Option<Self> {
        let price = options.cone_price.unwrap_or_else(|| match options.cell {
            Some(cell) => QUAD_PRICE.max(QUAD_CELLS * (cell / metric.side()).powi(2)),
            None => MAP_PRICE,
        });
        let (bounds, effort) = match options.cell {
            _ if is_aligned => (&ALIGNED_BOUNDS[..], Effort::Brief),
            Some(_) => (&QUAD_BOUNDS[..], Effort::Thorough),
            None => (&MAP_BOUNDS[..], Effort::Thorough),
        };
        // The quads see nothing of a few bad triangles.
        let (count, growth) = match options.cell {
            Some(_) => (ConeCount::Quarters, [f64::INFINITY; 2]),
            None => (ConeCount::Cones, [1.05, 1.2]),
        };
        (price > 0.0).then_some(Self { price, count, bounds, effort, growth })
    }

    /// Whether a layout with fewer cones is worth its price.
    fn accept(&self, before: &Finished, after: &Finished, saved: i32) -> bool {
        let excess = |f: &Finished| f.symmetric_dirichlet - 4.0;
        excess(after) < excess(before) + self.price * f64::from(saved)
            && excess(after) <= self.growth[1] * excess(before)
            && after.tau <= self.growth[0] * before.tau
    }
}

/// Cleans the cones up and lays out again; keeps the result only if it is worth its price.
pub(super) fn fewer_cones(
    sectors: &Sectors<'_>,
    metric: &Metric,
    before: Finished,
    terms: &Terms,
    watch: &mut Watch<'_, '_>,
) -> Result<(Finished, usize), LayoutError> {
    let mut iterations = 0;
    for &(largest_scale, largest_deviation) in terms.bounds {
        let mut cleaned = before.laid.matched.clone();
        let &Terms { price, count, effort, .. } = terms;
        let options = CleanUpOptions { price, count, largest_scale, largest_deviation };
        let (stats, gauge) = match clean_up(sectors, metric, &mut cleaned, &options, watch) {
            Ok(done) => done,
            Err(CleanUpError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(CleanUpError::Numeric(_)) => break,
        };
        if stats.cancelled + stats.moved == 0 {
            break;
        }
        fix_holonomy(sectors, metric, &mut cleaned)?;
        let frames = before.laid.layout.frames(&before.laid.y);
        let frames: Vec<_> =
            frames.into_iter().zip(gauge.iter()).map(|(r, &k)| turn(r, k)).collect();
        let after = match lay_out_with(sectors, metric, cleaned, Some(&frames), effort, watch) {
            Ok(laid) => Finished::judged(sectors, laid, watch)?,
            Err(LayoutError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(_) => continue,
        };
        iterations += after.iterations;
        if terms.accept(&before, &after, stats.saved) {
            return Ok((after, iterations));
        }
    }
    Ok((before, iterations))
}
