//! The best flip-free layout so far.

use super::objective::ConicObjective;
use super::program::Matrix2;
use super::solver::{ConicSolution, Outcome, Solver};
use crate::layout::exact::is_positive;
use crate::layout::problem::LayoutProblem;
use crate::layout::triangle::largest_step;
use num_complex::Complex64;

/// Part of the way to the first collapsing triangle that is taken where a step would flip one.
const FLIP_FREE_FRACTION: f64 = 0.9;

/// The best layout without flips, and how it was reached.
pub(super) struct Descent {
    pub(super) y: Vec<f64>,
    pub(super) z: Vec<Complex64>,
    pub(super) value: f64,
    pub(super) rounds: usize,
    pub(super) iterations: usize,
    pub(super) outcome: Outcome,
    pub(super) solver_used: Solver,
    pub(super) fallback_from: Option<Outcome>,
}

impl Descent {
    pub(super) fn new(
        problem: &LayoutProblem,
        objective: ConicObjective,
        left: Option<&[Matrix2]>,
        y: Vec<f64>,
    ) -> Self {
        let z = problem.space().expand(&y);
        Self {
            value: objective.value(problem, left, &z),
            y,
            z,
            rounds: 0,
            iterations: 0,
            outcome: Outcome::Solved,
            solver_used: Solver::Own,
            fallback_from: None,
        }
    }

    /// Notes how a program was solved.
    pub(super) fn record(&mut self, solution: &ConicSolution) {
        self.rounds += 1;
        self.iterations += solution.iterations;
        self.outcome = solution.outcome;
        self.solver_used = solution.solver_used;
        self.fallback_from = self.fallback_from.or(solution.fallback_from);
    }

    /// Moves to a layout, or towards it as far as no triangle flips, if the measure falls; whether it did.
    pub(super) fn move_to(
        &mut self,
        problem: &LayoutProblem,
        objective: ConicObjective,
        left: Option<&[Matrix2]>,
        y: &[f64],
    ) -> bool {
        let mut z = problem.space().expand(y);
        let mut y = y.to_vec();
        if !is_flip_free(problem, &z) {
            let step: Vec<f64> = y.iter().zip(&self.y).map(|(new, old)| new - old).collect();
            let dz = problem.space().expand(&step);
            let reach = largest_step(problem.triangles(), &self.z, &dz);
            let part = (FLIP_FREE_FRACTION * reach).min(1.0);
            y = self.y.iter().zip(&step).map(|(y, d)| y + part * d).collect();
            z = problem.space().expand(&y);
        }
        let value = objective.value(problem, left, &z);
        let better = value < self.value && is_flip_free(problem, &z);
        if better {
            (self.y, self.z, self.value) = (y, z, value);
        }
        better
    }
}

/// Whether all triangles are positive, by an exact test.
pub(super) fn is_flip_free(problem: &LayoutProblem, z: &[Complex64]) -> bool {
    first_flip(problem, z).is_none()
}

/// The first triangle that is not positive.
pub(super) fn first_flip(problem: &LayoutProblem, z: &[Complex64]) -> Option<usize> {
    problem.triangles().iter().position(|t| !is_positive(t.corners(z)))
}
