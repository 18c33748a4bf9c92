//! Bounded dilatation by bisection over the bound (Lipman 2012), to compare eq. (12) with.

use super::general::{Cone, End, run};
use super::measure::MaximalMeasure;
use super::program::Program;
use super::rows::{Row, Rows, part_rows};
use super::settling::Settling;
use super::solver::{ConicSolution, Outcome, Solver};
use super::{ConicOptions, Run};
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};

/// Bisection ends when the bounds on K differ by less than this part.
const BRACKET: f64 = 1e-3;

impl Run<'_> {
    /// Bisects for the smallest K with `|w| <= k Re(z conj R)`, `k = (K - 1) / (K + 1)`, then renews the frames,
    /// in turns.
    pub(super) fn bisect(&mut self, watch: &mut Watch<'_, '_>) -> Result<(), Cancelled> {
        let mut settling = Settling::new(self.descent.value());
        for _ in 0..self.options.max_rounds {
            let program = MaximalMeasure::Dilatation.program(self.problem, &self.descent.z);
            let (mut lowest, mut highest) = (1.0, self.descent.value());
            while highest - lowest > BRACKET * lowest {
                watch.pulse()?;
                let bound = 0.5 * (lowest + highest);
                let attempt = bounded(self.problem, &program, bound, self.options);
                self.descent.record(&attempt);
                if attempt.outcome == Outcome::Solved && attempt.objective <= 0.0 {
                    self.descent.move_to(self.problem, &attempt.y);
                    highest = self.descent.value().min(bound);
                } else {
                    lowest = bound;
                }
            }
            settling.push(self.descent.value());
            if settling.remaining() <= self.options.tolerance {
                break;
            }
        }
        // No bisection is finer than its bracket.
        self.descent.remaining = Some(settling.remaining().max(BRACKET));
        Ok(())
    }
}

/// The layout of mean 1 of `Re(z conj R)` with the least violation t of `|w| <= k Re(z conj R) + t`; the bound
/// on K can be kept if t is not positive. The objective of the solution is t.
fn bounded(
    problem: &LayoutProblem,
    program: &Program,
    bound: f64,
    options: &ConicOptions,
) -> ConicSolution {
    let (n, triangles) = (problem.space().n_unknowns(), problem.triangles());
    let k = (bound - 1.0) / (bound + 1.0);
    let mut rows = Rows::new(n + 1);
    let mut cones = Vec::with_capacity(triangles.len());
    let mut mean = vec![0.0; n];
    for (t, triangle) in triangles.iter().enumerate() {
        let [z0, z1, w0, w1] = part_rows(problem.space(), triangle, 1.0);
        let along = z0.times(program.frames[t].re).plus(&z1.times(program.frames[t].im));
        along.add_to(&mut mean, triangle.weight);
        rows.push(&along.times(k).plus(&Row::of(n, 1.0)), 0.0);
        rows.push(&w0, 0.0);
        rows.push(&w1, 0.0);
        cones.push(Cone::SecondOrder(3));
    }
    rows.push(&Row::dense(&mean), -1.0);
    cones.push(Cone::Zero(1));
    let mut cost = vec![0.0; n + 1];
    cost[n] = 1.0;
    let (x, End { gap, iterations, outcome }) =
        run(rows.into_columns(), &cost, &cones, &options.program);
    ConicSolution {
        y: x[..n].to_vec(),
        objective: x[n],
        gap,
        iterations,
        outcome,
        solver_used: Solver::Clarabel,
        fallback_from: None,
    }
}
