//! The best flip-free layout so far.

use super::measure::MaximalMeasure;
use super::solver::{ConicSolution, Outcome, Solver};
use crate::energy::{is_positive, largest_step};
use crate::layout::problem::LayoutProblem;
use num_complex::Complex64;

/// Part of the way to the first collapsing triangle that is taken where a step would flip one.
const FLIP_FREE_FRACTION: f64 = 0.9;

/// The best layout without flips, and how it was reached.
pub(super) struct Descent {
    pub(super) y: Vec<f64>,
    pub(super) z: Vec<Complex64>,
    measure: MaximalMeasure,
    value: f64,
    /// The estimated fall still to come in the phase, as a part of the value.
    pub(super) remaining: Option<f64>,
    pub(super) rounds: usize,
    pub(super) iterations: usize,
    pub(super) outcome: Outcome,
    pub(super) solver_used: Solver,
    pub(super) fallback_from: Option<Outcome>,
}

impl Descent {
    pub(super) fn new(problem: &LayoutProblem, measure: MaximalMeasure, y: Vec<f64>) -> Self {
        let z = problem.space().expand(&y);
        Self {
            measure,
            value: measure.of_layout(problem, &z),
            y,
            z,
            remaining: None,
            rounds: 0,
            iterations: 0,
            outcome: Outcome::Solved,
            solver_used: Solver::Own,
            fallback_from: None,
        }
    }

    /// The measure of the layout.
    pub(super) fn value(&self) -> f64 {
        self.value
    }

    /// Begins a phase: judges layouts by another measure from here on.
    pub(super) fn measure_by(&mut self, problem: &LayoutProblem, measure: MaximalMeasure) {
        self.remaining = None;
        if measure != self.measure {
            self.measure = measure;
            self.value = measure.of_layout(problem, &self.z);
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

    /// Moves to a layout, or towards it as far as no triangle flips, if the measure falls.
    pub(super) fn move_to(&mut self, problem: &LayoutProblem, y: &[f64]) {
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
        let value = self.measure.of_layout(problem, &z);
        if value < self.value && is_flip_free(problem, &z) {
            (self.y, self.z, self.value) = (y, z, value);
        }
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
