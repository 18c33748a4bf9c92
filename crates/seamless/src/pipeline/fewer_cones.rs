//! Cone clean-up with a second layout, kept only if it pays.

use super::finish::Finished;
use crate::features::Sectors;
use crate::layout::safeguards::{Effort, LayoutError, lay_out_with};
use crate::progress::Watch;
use crate::quarter::turn;
use crate::rounding::{CleanUpError, CleanUpOptions, clean_up, fix_holonomy};
use seamstress_surface::Metric;

/// Bounds on the log scale that clean-up tries, loosest first.
const SCALE_BOUNDS: [f64; 2] = [f64::INFINITY, 0.35];
/// Clean-up may raise tau by this factor, and the excess of the symmetric Dirichlet energy over 4.
const TAU_GROWTH: f64 = 1.05;
const EXCESS_GROWTH: f64 = 1.2;

/// Cleans the cones up and lays out again; keeps the result only if it is worth its price.
pub(super) fn fewer_cones(
    sectors: &Sectors<'_>,
    metric: &Metric,
    before: Finished,
    price: f64,
    watch: &mut Watch<'_, '_>,
) -> Result<(Finished, usize), LayoutError> {
    // The surrogate is less reliable between features, so bolder proposals mostly fail there.
    let (bounds, effort) = if sectors.any_aligned() {
        (&SCALE_BOUNDS[1..], Effort::Brief)
    } else {
        (&SCALE_BOUNDS[..], Effort::Thorough)
    };
    let mut iterations = 0;
    for &largest_scale in bounds {
        let mut cleaned = before.laid.matched.clone();
        let options = CleanUpOptions { price, largest_scale };
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
        let saved = stats.cones_before as f64 - stats.cones_after as f64;
        let excess = |f: &Finished| f.symmetric_dirichlet - 4.0;
        if excess(&after) < excess(&before) + price * saved
            && excess(&after) <= EXCESS_GROWTH * excess(&before)
            && after.tau <= TAU_GROWTH * before.tau
        {
            return Ok((after, iterations));
        }
    }
    Ok((before, iterations))
}
