//! The general conic solver: Clarabel, or none in builds without the feature `clarabel`.

use super::rows::Columns;
use super::solver::{Outcome, SolverOptions};

/// A cone and its number of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cone {
    /// Zero in each row.
    Zero(usize),
    /// The first row is at least the length of the vector of the others.
    SecondOrder(usize),
}

/// How the general solver ended.
pub(super) struct End {
    pub(super) gap: f64,
    pub(super) iterations: usize,
    pub(super) outcome: Outcome,
}

impl End {
    fn without_solution(outcome: Outcome) -> Self {
        Self { gap: f64::NAN, iterations: 0, outcome }
    }
}

/// Minimises `cost . x` with `A x + b` in the cones, one thread; `-A` and `b` are given.
#[cfg(feature = "clarabel")]
pub(super) fn run(
    (matrix, constants): (Columns, Vec<f64>),
    cost: &[f64],
    cones: &[Cone],
    options: &SolverOptions,
) -> (Vec<f64>, End) {
    use clarabel::algebra::CscMatrix;
    use clarabel::solver::{
        DefaultSettings, DefaultSolver, IPSolver, SecondOrderConeT, SolverStatus, SupportedConeT,
        ZeroConeT,
    };
    let settings = DefaultSettings::<f64> {
        verbose: false,
        max_iter: options.max_iterations as u32,
        tol_gap_abs: options.tolerance,
        tol_gap_rel: options.tolerance,
        tol_feas: options.tolerance,
        max_threads: 1,
        ..DefaultSettings::default()
    };
    let n = cost.len();
    let Columns { n_rows, starts, rows, values } = matrix;
    let matrix = CscMatrix::new(n_rows, n, starts, rows, values);
    let cone = |cone: &Cone| match *cone {
        Cone::Zero(rows) => ZeroConeT(rows),
        Cone::SecondOrder(rows) => SecondOrderConeT(rows),
    };
    let cones: Vec<SupportedConeT<f64>> = cones.iter().map(cone).collect();
    let quadratic = CscMatrix::<f64>::zeros((n, n));
    let Ok(mut solver) =
        DefaultSolver::new(&quadratic, cost, &matrix, &constants, &cones, settings)
    else {
        return (vec![0.0; n], End::without_solution(Outcome::ReferenceFailed));
    };
    solver.solve();
    let outcome = match solver.solution.status {
        SolverStatus::Solved => Outcome::Solved,
        SolverStatus::MaxIterations => Outcome::IterationLimit,
        SolverStatus::InsufficientProgress => Outcome::Stalled,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            Outcome::Infeasible
        }
        _ => Outcome::ReferenceFailed,
    };
    let (primal, dual) = (solver.solution.obj_val, solver.solution.obj_val_dual);
    let gap = (primal - dual).abs() / primal.abs().max(1e-12);
    let iterations = solver.solution.iterations as usize;
    (solver.solution.x, End { gap, iterations, outcome })
}

/// No solution: [`Outcome::ReferenceUnavailable`].
#[cfg(not(feature = "clarabel"))]
pub(super) fn run(
    _rows: (Columns, Vec<f64>),
    cost: &[f64],
    _cones: &[Cone],
    _options: &SolverOptions,
) -> (Vec<f64>, End) {
    (vec![0.0; cost.len()], End::without_solution(Outcome::ReferenceUnavailable))
}
