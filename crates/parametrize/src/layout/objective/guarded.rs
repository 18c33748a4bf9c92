//! Minimising behind a barrier that fades out.

use crate::energy::Energy;
use crate::energy::Guarded;
use crate::layout::newton::{NewtonOptions, minimize};
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};

/// Weights of the barrier in turn, as fractions of the energy at the start.
pub(super) const FADE: [f64; 6] = [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
/// The energy at the start counts as this at least.
const LEAST_ENERGY: f64 = 1e-9;
const STAGE: NewtonOptions = NewtonOptions { max_iterations: 25, tolerance: 1e-5 };

/// Minimises an energy over the layouts without flips, from one of them, by Newton steps for a barrier of
/// falling weight. Returns the unknowns and the iterations.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn minimize_guarded<E: Energy + Copy>(
    problem: &mut LayoutProblem,
    mut y: Vec<f64>,
    energy: E,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<f64>, usize), Cancelled> {
    let start = problem.value(&energy, &problem.space().expand(&y)).max(LEAST_ENERGY);
    let mut iterations = 0;
    for share in FADE {
        let guarded = Guarded { energy, weight: share * start };
        let solution = minimize(problem, y, &guarded, &STAGE, watch)?;
        y = solution.y;
        iterations += solution.iterations;
    }
    Ok((y, iterations))
}
