//! Solvers of programs: their settings, and how they end.

/// A solver of conic programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Solver {
    /// The interior point of this crate, which uses the structure of the programs.
    #[default]
    Own,
    /// Clarabel, a general conic solver (Goulart and Chen 2024): the reference.
    Clarabel,
}

impl Solver {
    /// Whether this build has the solver: Clarabel is the feature `clarabel`.
    pub fn is_available(self) -> bool {
        match self {
            Self::Own => true,
            Self::Clarabel => cfg!(feature = "clarabel"),
        }
    }
}

/// When a solver stops.
#[derive(Debug, Clone, Copy)]
pub struct SolverOptions {
    /// Gap between the objective and its bound from below, as a part of the objective.
    pub tolerance: f64,
    /// Most iterations.
    pub max_iterations: usize,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self { tolerance: 1e-6, max_iterations: 100 }
    }
}

/// How a solver ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Outcome {
    /// To the tolerance.
    Solved,
    /// The iterations ran out.
    IterationLimit,
    /// The linear system was not positive definite to working precision.
    LostDefiniteness,
    /// Steps became too short.
    Stalled,
    /// The layout given is not inside the program's constraints, where the own solver starts.
    NoInteriorStart,
    /// No layout satisfies the program, as the reference solver has proven.
    Infeasible,
    /// The reference solver ended otherwise.
    ReferenceFailed,
    /// The reference solver is not part of this build (feature `clarabel`).
    ReferenceUnavailable,
}

/// A layout that solves a program, or the best one reached.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ConicSolution {
    /// The unknowns.
    pub y: Vec<f64>,
    /// [`Program::value`](super::Program::value) of them.
    pub objective: f64,
    /// Gap to the bound from below, as a part of the objective.
    pub gap: f64,
    /// Iterations of the solver used.
    pub iterations: usize,
    /// How it ended.
    pub outcome: Outcome,
    /// The solver that found the unknowns.
    pub solver_used: Solver,
    /// How the own solver failed, where the reference took over.
    pub fallback_from: Option<Outcome>,
}
