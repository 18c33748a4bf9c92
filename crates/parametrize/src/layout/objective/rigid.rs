//! The distance to rotations: ARAP by two methods, and the single step for given frames.

use super::guarded::minimize_guarded;
use super::{Ending, Found, ObjectiveOptions, OptimizeError, newton};
use crate::energy::Arap;
use crate::energy::largest_step;
use crate::features::Sectors;
use crate::layout::arap::{Poisson, distance_to_frames, frames};
use crate::layout::exact::ExactLayout;
use crate::progress::{Cancelled, Watch};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;

/// Local/global iterations from the frames of a layout until the energy settles. Where they end with
/// flips, Newton steps from the start behind a barrier.
pub(super) fn local_global(
    sectors: &Sectors<'_>,
    layout: &mut ExactLayout,
    start: Vec<f64>,
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Found, OptimizeError> {
    let mut ending = Ending::Stopped;
    let mut iterations = 0;
    let mut y = start.clone();
    let mut energy = f64::INFINITY;
    let mut poisson = Poisson::new(layout.problem_mut())?;
    while iterations < options.max_iterations {
        watch.pulse()?;
        let (triangles, z) = (poisson.problem().triangles(), poisson.problem().space().expand(&y));
        let rotations = frames(triangles, &z);
        let now = distance_to_frames(triangles, &rotations, &z);
        if energy - now < options.tolerance * now {
            ending = Ending::Converged;
            break;
        }
        energy = now;
        y = poisson.follow(&targets(&rotations));
        iterations += 1;
    }
    let defects = layout.defects(sectors, &y);
    if !defects.none() {
        let (guarded, more) = minimize_guarded(layout.problem_mut(), start, Arap, watch)?;
        y = guarded;
        iterations += more;
        ending = Ending::Guarded { flips: defects.flips.len() };
    }
    Ok(Found::new(y, iterations, ending))
}

/// A triangle squeezed below this may have stopped a Newton step at the edge of the flip-free region.
const SQUEEZED: f64 = 0.05;

/// Newton steps on the ARAP energy; behind a barrier where they run into a triangle about to collapse.
pub(super) fn newton_steps(
    layout: &mut ExactLayout,
    start: Vec<f64>,
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Found, Cancelled> {
    let plain = newton(layout, start.clone(), &Arap, options, watch)?;
    let z = layout.expand(&plain.y);
    let triangles = layout.problem().triangles();
    let squeezed = triangles.iter().any(|t| t.jacobian(&z).singular_values().1 < SQUEEZED);
    if !squeezed {
        return Ok(plain);
    }
    let problem = layout.problem_mut();
    let (guarded, more) = minimize_guarded(problem, start, Arap, watch)?;
    let energy = |y: &[f64]| problem.value(&Arap, &problem.space().expand(y));
    let y = if energy(&guarded) < energy(&plain.y) { guarded } else { plain.y };
    let ending = Ending::Guarded { flips: 0 };
    Ok(Found::new(y, plain.iterations + more, ending))
}

/// Fraction of the way to the first collapsing triangle that a step may go.
const STEP_FRACTION: f64 = 0.9;

/// One global step for the frames of the layout, shortened if it flips a triangle.
///
/// The distance to the frames is convex: every point on the way is better than the start.
pub(super) fn poisson(
    sectors: &Sectors<'_>,
    layout: &mut ExactLayout,
    start: Vec<f64>,
) -> Result<Found, NotPositiveDefinite> {
    let z = layout.expand(&start);
    let rotations = frames(layout.problem().triangles(), &z);
    let mut y = Poisson::new(layout.problem_mut())?.follow(&targets(&rotations));
    let defects = layout.defects(sectors, &y);
    let mut ending = Ending::Converged;
    if !defects.none() {
        let step: Vec<f64> = y.iter().zip(&start).map(|(to, from)| to - from).collect();
        let far = largest_step(layout.problem().triangles(), &z, &layout.expand(&step));
        let t = (STEP_FRACTION * far).min(1.0);
        y = start.iter().zip(&step).map(|(from, d)| from + t * d).collect();
        ending = Ending::Guarded { flips: defects.flips.len() };
    }
    Ok(Found::new(y, 1, ending))
}

/// Rotations as images of the axes.
fn targets(rotations: &[Complex64]) -> Vec<[Complex64; 2]> {
    rotations.iter().map(|&r| [r, r * Complex64::I]).collect()
}
