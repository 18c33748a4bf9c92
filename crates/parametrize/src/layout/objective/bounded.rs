//! Minimum energy under a bound on the dilatation (Lipman 2012; Levi 2021, suppl. sec. 5).

use super::{Ending, Found, Objective, ObjectiveOptions, OptimizeError, Optimized, maximal};
use crate::energy::BoundedDilatation;
use crate::features::Sectors;
use crate::layout::conic::MaximalMeasure;
use crate::layout::exact::ExactLayout;
use crate::layout::newton::{NewtonOptions, Stop};
use crate::progress::{Cancelled, Watch};

/// A dilatation that exceeds its bound by this part keeps it: where the bound is the minimum itself, above all 1
/// on a developable surface, nothing is left to be strictly below, and the programs find it to their gap of 1e-6.
const TOLERANCE: f64 = 1e-5;
/// Weights of the barrier in turn, as parts of the energy. The last one is what the energy may be above its
/// minimum for it, if all triangles are at the bound.
const FADE: [f64; 5] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
const STAGE: NewtonOptions = NewtonOptions { max_iterations: 25, tolerance: 1e-7 };
/// Parts of the way from a layout inside the bound to the given one where the minimisation may start: the farther,
/// the nearer it stays to what was given.
const STARTS: [f64; 5] = [0.9, 0.75, 0.5, 0.25, 0.0];

/// Minimises the mean symmetric Dirichlet energy over the layouts whose dilatation is at most the bound. One of
/// them is found by minimising the dilatation, unless the start is one.
///
/// The result may have more energy than the start, if that does not keep the bound.
///
/// # Errors
/// [`OptimizeError::Infeasible`] if none is found; there may be one all the same, since the programs that minimise
/// the dilatation are convex for given frames only.
pub(super) fn optimize(
    sectors: &Sectors<'_>,
    layout: &mut ExactLayout,
    start: Vec<f64>,
    (objective, bound): (Objective, f64),
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Optimized, OptimizeError> {
    if !objective.is_of_dilatation() {
        return Err(OptimizeError::BoundOfOther { objective });
    }
    if !(bound >= 1.0 && bound.is_finite()) {
        return Err(OptimizeError::BadBound { bound });
    }
    let energy = |layout: &ExactLayout, y: &[f64]| layout.figures(y).symmetric_dirichlet;
    let before = energy(layout, &start);
    let mut inside = Found::new(start.clone(), 0, Ending::Converged);
    if dilatation(layout, &start) >= bound {
        inside = maximal::minimize(layout, start.clone(), objective.phases(), options, watch)?;
        let smallest = dilatation(layout, &inside.y);
        if smallest > bound * (1.0 + TOLERANCE) || !layout.defects(sectors, &inside.y).none() {
            return Err(OptimizeError::Infeasible { bound, smallest });
        }
    }
    let Found { y: found, mut iterations, conic, .. } = inside;
    let wall = if dilatation(layout, &found) < bound { bound } else { bound * (1.0 + TOLERANCE) };
    let from = towards(layout, &found, &start, wall);
    let (mut y, newton, stop) = behind_barrier(layout, from, wall, watch)?;
    iterations += newton;
    let mut ending = if stop == Stop::Converged { Ending::Converged } else { Ending::Stopped };
    let is_kept = dilatation(layout, &y) <= wall && layout.defects(sectors, &y).none();
    if !(is_kept && energy(layout, &y) <= energy(layout, &found)) {
        (y, ending) = (found, Ending::NoGain);
    }
    layout.rescale(&mut y);
    let (value, dilatation) = (energy(layout, &y), Some(dilatation(layout, &y)));
    Ok(Optimized { y, value, before, iterations, ending, conic, dilatation })
}

/// The largest dilatation.
fn dilatation(layout: &ExactLayout, y: &[f64]) -> f64 {
    MaximalMeasure::Dilatation.of_layout(layout.problem(), &layout.expand(y))
}

/// The point farthest along the straight way from a layout inside the bound to another one that is inside, too.
fn towards(layout: &ExactLayout, inside: &[f64], other: &[f64], wall: f64) -> Vec<f64> {
    let at = |part: f64| -> Vec<f64> {
        inside.iter().zip(other).map(|(y, o)| y + part * (o - y)).collect()
    };
    let starts = STARTS.into_iter().map(at);
    starts.into_iter().find(|y| dilatation(layout, y) < wall).unwrap_or_else(|| inside.to_vec())
}

/// Minimises the energy behind a barrier at the bound that fades out; the unknowns, the iterations and how the
/// last stage ended.
fn behind_barrier(
    layout: &mut ExactLayout,
    mut y: Vec<f64>,
    wall: f64,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<f64>, usize, Stop), Cancelled> {
    layout.rescale(&mut y);
    let size = layout.figures(&y).symmetric_dirichlet;
    let (mut iterations, mut stop) = (0, Stop::Stalled);
    for share in FADE {
        let energy = BoundedDilatation::new(wall, share * size);
        let solution = layout.minimize(y, &energy, &STAGE, watch)?;
        (y, stop) = (solution.y, solution.stop);
        iterations += solution.iterations;
    }
    Ok((y, iterations, stop))
}
