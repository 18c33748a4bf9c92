//! Projected Newton on a flip-free layout.

use super::problem::LayoutProblem;
use crate::energy::{Energy, largest_step};
use crate::progress::{Cancelled, Watch};
use num_complex::Complex64;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct NewtonOptions {
    /// Most iterations.
    pub max_iterations: usize,
    /// Stop when the energy falls by less than this fraction in one iteration.
    pub tolerance: f64,
}

/// Why it stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// The energy settled.
    Converged,
    /// The iterations ran out.
    IterationLimit,
    /// No step lowered the energy.
    Stalled,
    /// The linear system could not be solved.
    NoFactor,
}

/// A layout and how it was reached.
#[derive(Debug, Clone)]
pub struct NewtonSolution {
    /// The unknowns.
    pub y: Vec<f64>,
    /// The wedge positions they stand for.
    pub z: Vec<Complex64>,
    /// The energy reached.
    pub energy: f64,
    /// Iterations taken.
    pub iterations: usize,
    /// Why it stopped.
    pub stop: Stop,
}

/// Shift of the Hessian, as a fraction of its mean diagonal: it settles free rigid motions.
const SHIFT: f64 = 1e-8;
/// Fraction of the largest flip-free step that is tried first.
const STEP_FRACTION: f64 = 0.9;
/// Sufficient decrease (Armijo).
const DECREASE: f64 = 1e-4;
const MAX_HALVINGS: usize = 40;

/// Minimises an energy from a layout without flips, never leaving the flip-free region (unless the energy
/// allows flips).
///
/// Each iteration solves with the Hessian whose per-triangle blocks are projected to positive
/// semi-definite ones, steps at most 0.9 of the way to the first collapsing triangle (Smith and
/// Schaefer 2015) and backtracks until the energy falls.
///
/// # Errors
/// [`Cancelled`].
pub fn minimize(
    problem: &mut LayoutProblem,
    y: Vec<f64>,
    energy: &impl Energy,
    options: &NewtonOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<NewtonSolution, Cancelled> {
    let z = problem.space().expand(&y);
    let energy_now = problem.value(energy, &z);
    let mut now =
        NewtonSolution { y, z, energy: energy_now, iterations: 0, stop: Stop::IterationLimit };
    while now.iterations < options.max_iterations {
        watch.pulse()?;
        let mut step = problem.linearize(energy, &now.z);
        let gradient = step.clone();
        if problem.factorize(SHIFT).is_err() {
            now.stop = Stop::NoFactor;
            break;
        }
        problem.solve(&mut step);
        step.iter_mut().for_each(|x| *x = -*x);
        let slope: f64 = gradient.iter().zip(&step).map(|(g, s)| g * s).sum();
        let dz = problem.space().expand(&step);
        let mut t = if energy.allows_flips() {
            1.0
        } else {
            (STEP_FRACTION * largest_step(problem.triangles(), &now.z, &dz)).min(1.0)
        };
        let accepted = (0..MAX_HALVINGS).find_map(|_| {
            let z: Vec<_> = now.z.iter().zip(&dz).map(|(z, d)| z + d * t).collect();
            let value = problem.value(energy, &z);
            if value <= now.energy + DECREASE * t * slope {
                return Some((z, value, t));
            }
            t *= 0.5;
            None
        });
        let Some((z, value, t)) = accepted else {
            now.stop = Stop::Stalled;
            break;
        };
        let drop = now.energy - value;
        now.y.iter_mut().zip(&step).for_each(|(y, s)| *y += t * s);
        now.z = z;
        now.energy = value;
        now.iterations += 1;
        if drop < options.tolerance * value.abs() {
            now.stop = Stop::Converged;
            break;
        }
    }
    // Positions that are exactly N y: the seams close to the last bit of the products.
    let exact = problem.space().expand(&now.y);
    if problem.value(energy, &exact).is_finite() {
        now.z = exact;
    }
    Ok(now)
}
