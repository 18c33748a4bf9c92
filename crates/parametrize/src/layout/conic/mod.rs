//! Layouts of least maximal distortion, by second-order cone programs (seed, sections 4.2 and 5).

mod alternate;
mod bisection;
mod cells;
mod cone;
mod descent;
mod element;
mod fused;
mod general;
pub mod interior_point;
mod objective;
mod passes;
pub mod program;
pub mod reference;
mod rows;
pub mod solver;
mod start;

pub use objective::ConicObjective;
pub use program::{Matrix2, Program, ProgramKind};
pub use solver::{ConicSolution, Outcome, Solver, SolverOptions, solve};

use super::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};
use descent::{Descent, is_flip_free};

/// Settings of [`minimize`].
#[derive(Debug, Clone)]
pub struct ConicOptions {
    /// The solver of the programs.
    pub solver: Solver,
    /// When a program is solved.
    pub program: SolverOptions,
    /// Most rounds of local and global steps.
    pub max_rounds: usize,
    /// Rounds end when one lowers the measure by less than this part.
    pub tolerance: f64,
    /// Anisotropic frames: a matrix A of positive determinant per triangle, by rows, in the triangle's
    /// target axes; `A^-1 J` is measured in place of the Jacobian J. None: the identity everywhere.
    pub anisotropy: Option<Vec<Matrix2>>,
}

impl Default for ConicOptions {
    fn default() -> Self {
        Self {
            solver: Solver::default(),
            program: SolverOptions::default(),
            max_rounds: 20,
            tolerance: 1e-4,
            anisotropy: None,
        }
    }
}

/// Why no minimisation was tried.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConicError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The layout to start from has a flipped or collapsed triangle.
    #[error("the layout to start from flips or collapses triangle {triangle}")]
    FlippedStart {
        /// The first such triangle.
        triangle: usize,
    },
    /// Clarabel is asked for, and this build is without it.
    #[error("the solver Clarabel is not part of this build (feature `clarabel`)")]
    NoReferenceSolver,
    /// The anisotropic frames are not one matrix of positive determinant per triangle.
    #[error(
        "the anisotropic frame of triangle {triangle} is missing or has no positive determinant"
    )]
    BadFrame {
        /// The first such triangle.
        triangle: usize,
    },
}

/// A layout of low maximal distortion.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ConicMinimum {
    /// The unknowns; for objectives that do not depend on scale, at `sigma_1 max sigma_2 min = 1`.
    pub y: Vec<f64>,
    /// The measure reached.
    pub value: f64,
    /// The measure at the start.
    pub value_before: f64,
    /// For eq. (8) and (11): whether `mu < 1`, which by itself proves that no triangle is flipped.
    pub injective_by_bound: Option<bool>,
    /// Programs solved.
    pub rounds: usize,
    /// Interior-point iterations.
    pub iterations: usize,
    /// How the last program ended.
    pub outcome: Outcome,
    /// The solver of the last program.
    pub solver_used: Solver,
    /// How the own solver failed, the first time the reference took over.
    pub fallback_from: Option<Outcome>,
}

/// Minimises a maximal distortion over the layouts of a space, from a flip-free one.
///
/// The result has no flips, and is never worse than the start. The methods named after alternation do local
/// and global steps alone, as printed; the others start with one interior-point run in which the local step
/// is done in every iteration (with the own solver), which takes most rounds' place. None is guaranteed to
/// find the global minimum.
///
/// # Errors
/// [`ConicError`].
pub fn minimize(
    problem: &mut LayoutProblem,
    y: Vec<f64>,
    objective: ConicObjective,
    options: &ConicOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ConicMinimum, ConicError> {
    let needs_reference =
        options.solver == Solver::Clarabel || objective == ConicObjective::DilatationBisection;
    if needs_reference && !Solver::Clarabel.is_available() {
        return Err(ConicError::NoReferenceSolver);
    }
    let left = inverses(problem, options)?;
    let left = left.as_deref();
    let descent = Descent::new(problem, objective, left, y);
    if let Some(triangle) = descent::first_flip(problem, &descent.z) {
        return Err(ConicError::FlippedStart { triangle });
    }
    let value_before = descent.value;
    let mut run = Run { problem, left, options, descent };
    match objective {
        ConicObjective::DilatationBisection => run.bisect(watch)?,
        ConicObjective::TauAlternating | ConicObjective::DilatationAlternating => {
            run.alternate(objective, watch)?;
        }
        ConicObjective::Dilatation => {
            // (11) has the same minimisers and gets stuck less: at a fixed point of (12) no triangle of
            // largest dilatation may change its size.
            run.fused_and_alternate(ConicObjective::AsapMax, watch)?;
            run.restart(objective);
            run.fused_and_alternate(objective, watch)?;
        }
        _ => run.fused_and_alternate(objective, watch)?,
    }
    let Run { problem, mut descent, .. } = run;
    let bounded = matches!(objective, ConicObjective::ArapMax | ConicObjective::AsapMax);
    if objective != ConicObjective::ArapMax {
        normalize(problem, &mut descent);
    }
    Ok(ConicMinimum {
        injective_by_bound: bounded.then_some(descent.value < 1.0),
        value: descent.value,
        value_before,
        rounds: descent.rounds,
        iterations: descent.iterations,
        outcome: descent.outcome,
        solver_used: descent.solver_used,
        fallback_from: descent.fallback_from,
        y: descent.y,
    })
}

/// A minimisation on its way.
struct Run<'a> {
    problem: &'a mut LayoutProblem,
    left: Option<&'a [Matrix2]>,
    options: &'a ConicOptions,
    descent: Descent,
}

impl Run<'_> {
    fn fused_and_alternate(
        &mut self,
        objective: ConicObjective,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), Cancelled> {
        if self.options.solver == Solver::Own {
            self.fused(objective, watch)?;
        }
        self.alternate(objective, watch)
    }

    /// Goes on from the layout reached with another measure.
    fn restart(&mut self, objective: ConicObjective) {
        self.descent.value = objective.value(self.problem, self.left, &self.descent.z);
    }
}

/// Scales a layout to `sigma_1 max sigma_2 min = 1`, eq. (2) for the whole mesh.
fn normalize(problem: &LayoutProblem, descent: &mut Descent) {
    let (largest, smallest) =
        program::extremes(problem.triangles(), |_, t| t.jacobian(&descent.z).singular_values());
    let scale = 1.0 / (largest * smallest).sqrt();
    let scaled: Vec<f64> = descent.y.iter().map(|y| y * scale).collect();
    if scale.is_finite() && is_flip_free(problem, &problem.space().expand(&scaled)) {
        descent.y = scaled;
    }
}

/// `A^-1` for every triangle.
fn inverses(
    problem: &LayoutProblem,
    options: &ConicOptions,
) -> Result<Option<Vec<Matrix2>>, ConicError> {
    let Some(frames) = &options.anisotropy else { return Ok(None) };
    let inverse = |triangle: usize| {
        let [[a, b], [c, d]] = *frames.get(triangle).ok_or(ConicError::BadFrame { triangle })?;
        let determinant = a * d - b * c;
        if determinant > 0.0 && determinant.is_finite() {
            let k = 1.0 / determinant;
            return Ok([[d * k, -b * k], [-c * k, a * k]]);
        }
        Err(ConicError::BadFrame { triangle })
    };
    (0..problem.triangles().len()).map(inverse).collect::<Result<_, _>>().map(Some)
}
