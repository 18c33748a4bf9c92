//! Primal-dual interior point for [`Program`]s, by their structure.
//!
//! The unknowns are those of the layout, the bound mu and an epigraph variable per triangle. In each
//! iteration the epigraph variables are eliminated triangle by triangle and mu is bordered, so that one
//! sparse positive definite factorisation over the layout's unknowns remains, of the pattern that
//! Newton's method uses. Nesterov-Todd scalings, steps by Mehrotra's predictor and corrector.

use super::cells::{Cones, DeviationCones, StretchCones};
use super::energy_term::{EnergyTerm, dot};
use super::passes::{Cell, Tally, affine_steps, assemble, corrected_steps, correction, move_on};
use super::program::{Program, ProgramKind, Renewal};
use super::solver::{ConicSolution, Outcome, Solver, SolverOptions};
use super::start;
use crate::layout::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};
use num_complex::Complex64;

/// Part of the way to the boundary that a step may take.
const STEP_FRACTION: f64 = 0.99;
/// The same where frames change: nearer steps leave later ones no room.
const STEP_FRACTION_RENEWED: f64 = 0.95;
/// Steps shorter than this lead nowhere.
const SHORTEST_STEP: f64 = 1e-9;
/// Relative raises of the diagonal against rounding, one after the other until there is a factor. Steps stay
/// directions of descent with the larger ones, and get shorter.
const RAISES: [f64; 3] = [1e-13, 1e-11, 1e-9];
/// Smallest centring parameter.
const SMALLEST_CENTRING: f64 = 1e-8;
/// Floor for the objective when the duality gap is made relative: the optimum of (8) may be 0.
const SMALLEST_SCALE: f64 = 1e-2;

/// Solves a program from a layout inside its constraints.
///
/// # Errors
/// [`Cancelled`].
pub fn solve(
    problem: &mut LayoutProblem,
    program: &Program,
    y: &[f64],
    renewal: Renewal,
    options: &SolverOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ConicSolution, Cancelled> {
    match program.kind {
        ProgramKind::Stretch => {
            run::<3, 3, StretchCones>(problem, program, y, renewal, None, options, watch)
        }
        ProgramKind::Deviation => {
            run::<5, 1, DeviationCones>(problem, program, y, renewal, None, options, watch)
        }
    }
}

/// A term of the objective, and who decides in every iteration what it weighs at the layout reached.
pub(super) struct Tradeoff<'a> {
    pub(super) term: EnergyTerm,
    pub(super) weigh: &'a mut Weigh<'a>,
}

/// Gives the best global scale and a weight for a layout; none to stop there.
pub(super) type Weigh<'a> =
    dyn FnMut(&LayoutProblem, &[f64], &[Complex64]) -> Option<(f64, f64)> + 'a;

/// As [`solve`] for programs of [`ProgramKind::Stretch`], frames renewed, with the energy as a term of the objective.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn solve_with_energy(
    problem: &mut LayoutProblem,
    program: &Program,
    y: &[f64],
    tradeoff: Tradeoff<'_>,
    options: &SolverOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ConicSolution, Cancelled> {
    let renewal = Renewal::Frames;
    run::<3, 3, StretchCones>(problem, program, y, renewal, Some(tradeoff), options, watch)
}

/// Vectors that all iterations share.
struct Vectors {
    y: Vec<f64>,
    /// Positions of `y`, and of a step.
    z: Vec<Complex64>,
    dz: Vec<Complex64>,
    /// Solution for the border, and of the step.
    border: Vec<f64>,
    border_solution: Vec<f64>,
    step: Vec<f64>,
}

fn run<const D: usize, const C: usize, K: Cones<D, C>>(
    problem: &mut LayoutProblem,
    program: &Program,
    y: &[f64],
    renewal: Renewal,
    tradeoff: Option<Tradeoff<'_>>,
    options: &SolverOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ConicSolution, Cancelled> {
    let n = y.len();
    let wedges = problem.space().n_wedges();
    let mut vectors = Vectors {
        y: y.to_vec(),
        z: problem.space().expand(y),
        dz: vec![Complex64::ZERO; wedges],
        border: vec![0.0; n],
        border_solution: vec![0.0; n],
        step: vec![0.0; n],
    };
    let mut end = ConicSolution {
        y: Vec::new(),
        objective: f64::INFINITY,
        gap: f64::INFINITY,
        iterations: 0,
        outcome: Outcome::NoInteriorStart,
        solver_used: Solver::Own,
        fallback_from: None,
    };
    if let Some((scale, bound)) = start::inside(problem, program, &vectors.z) {
        vectors.y.iter_mut().for_each(|x| *x *= scale);
        vectors.z.iter_mut().for_each(|x| *x *= scale);
        let cells = start::cells::<D, C, K>(problem, program, &vectors.z, bound);
        let mut run = Run::<'_, '_, D, C, K> {
            problem,
            cells,
            vectors,
            bound,
            infeasibility: 1.0,
            renewal,
            tradeoff,
            forward: vec![0.0; n],
            cones: std::marker::PhantomData,
        };
        end.outcome = run.iterate(options, &mut end, watch)?;
        vectors = run.vectors;
    }
    end.objective = program.value(problem, &vectors.z);
    end.y = vectors.y;
    Ok(end)
}

struct Run<'p, 't, const D: usize, const C: usize, K> {
    problem: &'p mut LayoutProblem,
    cells: Vec<Cell<D, C>>,
    vectors: Vectors,
    bound: f64,
    /// What is left of the start's dual infeasibility.
    infeasibility: f64,
    renewal: Renewal,
    tradeoff: Option<Tradeoff<'t>>,
    /// Solution for the gradient of the term, negated: zero without one.
    forward: Vec<f64>,
    cones: std::marker::PhantomData<K>,
}

impl<const D: usize, const C: usize, K: Cones<D, C>> Run<'_, '_, D, C, K> {
    fn iterate(
        &mut self,
        options: &SolverOptions,
        end: &mut ConicSolution,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Outcome, Cancelled> {
        loop {
            watch.pulse()?;
            let v = &mut self.vectors;
            let now = assemble::<D, C, K>(
                self.problem,
                &mut self.cells,
                &v.z,
                self.bound,
                self.renewal,
                &mut v.border,
            );
            end.gap = now.gap / self.bound.max(SMALLEST_SCALE);
            if end.gap <= options.tolerance && self.infeasibility <= 10.0 * options.tolerance {
                return Ok(Outcome::Solved);
            }
            if end.iterations == options.max_iterations {
                return Ok(Outcome::IterationLimit);
            }
            if let Some(Tradeoff { term, weigh }) = &mut self.tradeoff {
                let Some((scale, weight)) = weigh(self.problem, &v.y, &v.z) else {
                    return Ok(Outcome::IterationLimit);
                };
                term.add_to(self.problem, &v.y, scale, weight);
            }
            let raised = |&raise: &f64| self.problem.factorize_as_is(raise).is_ok();
            if !(now.gap.is_finite() && RAISES.iter().any(raised)) {
                return Ok(Outcome::LostDefiniteness);
            }
            if let Err(outcome) = self.step(&now) {
                return Ok(outcome);
            }
            end.iterations += 1;
        }
    }

    /// One predictor and corrector.
    ///
    /// # Errors
    /// [`Outcome::Stalled`] if the step leads nowhere.
    fn step(&mut self, now: &Tally) -> Result<(), Outcome> {
        let (problem, v) = (&mut *self.problem, &mut self.vectors);
        v.border_solution.copy_from_slice(&v.border);
        match &mut self.tradeoff {
            None => problem.solve(&mut v.border_solution),
            Some(tradeoff) => {
                self.forward = tradeoff.term.solve(problem, &mut v.border_solution);
            }
        }
        let pivot = now.corner - dot(&v.border, &v.border_solution);

        // The predictor's right-hand side is that of mu and the term alone: the rest cancels.
        let affine_bound = (-1.0 - dot(&v.border, &self.forward)) / pivot;
        scale_into(&v.border_solution, -affine_bound, &mut v.step);
        add_into(&self.forward, &mut v.step);
        problem.space().expand_into(&v.step, &mut v.dz);
        let affine = affine_steps::<D, C, K>(problem, &mut self.cells, &v.dz, affine_bound);
        let centring = affine.centring(now.gap).clamp(SMALLEST_CENTRING, 1.0);
        let target = centring * now.gap / (self.cells.len() * C) as f64;

        let tally = correction::<D, C, K>(problem, &mut self.cells, target, &mut v.step);
        problem.solve(&mut v.step);
        if let Some(Tradeoff { term, .. }) = &self.tradeoff {
            term.correct(&mut v.step);
            add_into(&self.forward, &mut v.step);
        }
        let bound_step = (tally.corner - 1.0 - dot(&v.border, &v.step)) / pivot;
        for (x, b) in v.step.iter_mut().zip(&v.border_solution) {
            *x -= bound_step * b;
        }
        problem.space().expand_into(&v.step, &mut v.dz);
        let reach = corrected_steps::<D, C, K>(problem, &mut self.cells, &v.dz, bound_step);
        let fraction = match self.renewal {
            Renewal::Never => STEP_FRACTION,
            _ => STEP_FRACTION_RENEWED,
        };
        let [primal, dual] = reach.steps.map(|s| (fraction * s).min(1.0));
        // Also so for steps that are not numbers.
        if !(primal.max(dual) > SHORTEST_STEP && bound_step.is_finite()) {
            return Err(Outcome::Stalled);
        }
        v.y.iter_mut().zip(&v.step).for_each(|(y, d)| *y += primal * d);
        v.z.iter_mut().zip(&v.dz).for_each(|(z, d)| *z += primal * d);
        self.bound += primal * bound_step;
        self.infeasibility *= 1.0 - dual;
        move_on(problem, &mut self.cells, primal, dual);
        Ok(())
    }
}

fn add_into(from: &[f64], to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, x)| *to += x);
}

fn scale_into(from: &[f64], factor: f64, to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, x)| *to = factor * x);
}
