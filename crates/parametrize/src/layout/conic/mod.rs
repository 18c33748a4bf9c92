//! Layouts of minimum maximal distortion, by second-order cone programs (Levi 2021, suppl. sec. 4.2 and 5).

mod alternate;
mod bisection;
mod cells;
mod cone;
mod descent;
mod dispatch;
mod element;
mod energy_term;
mod fused;
mod general;
pub mod interior_point;
mod measure;
mod passes;
pub mod program;
pub mod reference;
mod rows;
mod settling;
pub mod solver;
mod start;

pub use dispatch::solve;
pub(super) use fused::trade;
pub use measure::MaximalMeasure;
pub use program::{Program, ProgramKind, Renewal};
pub use solver::{ConicSolution, Outcome, Solver, SolverOptions};

use super::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};
use descent::{Descent, is_flip_free};

/// One part of a minimisation; it goes on from where the one before has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// A single interior-point run in which the local step is done in every iteration. It takes most rounds'
    /// place, and needs the own solver: with another one it is left out.
    Fused(MaximalMeasure),
    /// Algorithm 1 as printed: a program for given frames and scales, and new ones, in turns.
    Alternating(MaximalMeasure),
    /// Bisection over bounds on the dilatation (Lipman 2012), frames renewed in between.
    Bisection,
}

impl Phase {
    /// What it lowers.
    pub fn measure(self) -> MaximalMeasure {
        match self {
            Self::Fused(measure) | Self::Alternating(measure) => measure,
            Self::Bisection => MaximalMeasure::Dilatation,
        }
    }
}

/// Settings of [`minimize`].
#[derive(Debug, Clone)]
pub struct ConicOptions {
    /// The solver of the programs.
    pub solver: Solver,
    /// When a program is solved.
    pub program: SolverOptions,
    /// Most rounds of local and global steps.
    pub max_rounds: usize,
    /// Rounds end when the fall of the measure still to come, estimated from the last ones, is less than this part
    /// of it.
    pub tolerance: f64,
}

impl Default for ConicOptions {
    fn default() -> Self {
        Self {
            solver: Solver::default(),
            program: SolverOptions::default(),
            max_rounds: 20,
            tolerance: 1e-4,
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
}

/// A layout of low maximal distortion.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ConicMinimum {
    /// The unknowns; for measures that do not depend on scale, at `sigma_1 max sigma_2 min = 1`.
    pub y: Vec<f64>,
    /// The measure reached, that of the last phase.
    pub value: f64,
    /// The measure at the start.
    pub value_before: f64,
    /// For eq. (8) and (11): whether `mu < 1`, which by itself proves that no triangle is flipped.
    pub injective_by_bound: Option<bool>,
    /// The estimated fall of the measure still to come with further rounds, as a part of it; none if the last phase
    /// has no rounds.
    pub remaining: Option<f64>,
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

/// Minimises a maximal distortion over the layouts of a space in one or several phases, from a flip-free one.
///
/// The result has no flips, and no phase makes its own measure worse. None is guaranteed to find the global
/// minimum, or even a local one: alternation has other fixed points, and ends near one of them when the rounds run
/// out.
///
/// # Errors
/// [`ConicError`].
pub fn minimize(
    problem: &mut LayoutProblem,
    y: Vec<f64>,
    phases: &[Phase],
    options: &ConicOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ConicMinimum, ConicError> {
    let needs_reference = options.solver == Solver::Clarabel || phases.contains(&Phase::Bisection);
    if needs_reference && !Solver::Clarabel.is_available() {
        return Err(ConicError::NoReferenceSolver);
    }
    let measure = phases.last().map_or(MaximalMeasure::Tau, |phase| phase.measure());
    let descent = Descent::new(problem, measure, y);
    if let Some(triangle) = descent::first_flip(problem, &descent.z) {
        return Err(ConicError::FlippedStart { triangle });
    }
    let value_before = descent.value();
    let mut run = Run { problem, options, descent };
    for &phase in phases {
        run.descent.measure_by(run.problem, phase.measure());
        match phase {
            Phase::Fused(_) if options.solver != Solver::Own => {}
            Phase::Fused(measure) => run.fused(measure, watch)?,
            Phase::Alternating(measure) => run.alternate(measure, watch)?,
            Phase::Bisection => run.bisect(watch)?,
        }
    }
    let Run { problem, mut descent, .. } = run;
    if !measure.depends_on_scale() {
        normalize(problem, &mut descent);
    }
    let value = descent.value();
    Ok(ConicMinimum {
        injective_by_bound: measure.proves_injectivity().then_some(value < 1.0),
        value,
        value_before,
        remaining: descent.remaining,
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
    options: &'a ConicOptions,
    descent: Descent,
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
