//! Layouts that minimise the distortion one chooses, in the exact space and without flips.

mod guarded;
mod rigid;
mod similar;

use super::arap::{distance_to_frames, frames};
use super::conic::{self, ConicError, ConicObjective, ConicOptions, Outcome, Solver};
use super::energy::{Energy, SymmetricDirichlet};
use super::exact::ExactLayout;
use super::newton::{NewtonOptions, NewtonSolution, Stop, minimize};
use crate::features::Sectors;
use crate::progress::{Cancelled, Watch};
use crate::quality::{Measure, summarize};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;

/// What a layout minimises, and by which method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Objective {
    /// Mean symmetric Dirichlet energy, eq. (5), by projected Newton.
    SymmetricDirichlet,
    /// Mean ARAP energy, eq. (7), by local and global steps (Liu et al. 2008).
    Arap,
    /// Mean ARAP energy by projected Newton (after Chao et al. 2010).
    ArapNewton,
    /// The single global step (6) for the frames of the layout it starts from.
    Poisson,
    /// Largest ARAP energy, eq. (8), by local steps and conic programs.
    ArapMax,
    /// tau, eq. (3), with frames renewed inside the interior point.
    Tau,
    /// tau by Algorithm 1: conic programs (9) for given frames, and new frames, in turns.
    TauAlternating,
    /// Mean ASAP energy, eq. (10), at fixed size.
    Asap,
    /// Largest scaled ASAP energy, eq. (11).
    AsapMax,
    /// Largest dilatation, with a scale per triangle, eq. (12).
    Dilatation,
    /// Largest dilatation by bisection over bounds on it (Lipman 2012).
    DilatationBisection,
}

impl Objective {
    /// Whether this build can minimise it: the bisection needs the feature `clarabel`.
    pub fn is_available(self) -> bool {
        self != Self::DilatationBisection || Solver::Clarabel.is_available()
    }

    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::SymmetricDirichlet,
        Self::Arap,
        Self::ArapNewton,
        Self::Poisson,
        Self::ArapMax,
        Self::Tau,
        Self::TauAlternating,
        Self::Asap,
        Self::AsapMax,
        Self::Dilatation,
        Self::DilatationBisection,
    ];

    /// Name for commands and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::SymmetricDirichlet => "symmetric-dirichlet",
            Self::Arap => "arap",
            Self::ArapNewton => "arap-newton",
            Self::Poisson => "poisson",
            Self::ArapMax => "arap-max",
            Self::Tau => "tau",
            Self::TauAlternating => "tau-alternating",
            Self::Asap => "asap",
            Self::AsapMax => "asap-max",
            Self::Dilatation => "dilatation",
            Self::DilatationBisection => "dilatation-bisection",
        }
    }

    /// The measure whose figure it minimises; none for [`Objective::Poisson`], which minimises the
    /// distance to given frames.
    pub fn measure(self) -> Option<Measure> {
        match self {
            Self::SymmetricDirichlet => Some(Measure::SymmetricDirichlet),
            Self::Arap | Self::ArapNewton => Some(Measure::Arap),
            Self::Poisson => None,
            Self::ArapMax => Some(Measure::ArapMax),
            Self::Tau | Self::TauAlternating => Some(Measure::Tau),
            Self::Asap => Some(Measure::Asap),
            Self::AsapMax => Some(Measure::AsapMax),
            Self::Dilatation | Self::DilatationBisection => Some(Measure::Dilatation),
        }
    }
}

impl std::fmt::Display for Objective {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Settings of the minimisers.
#[derive(Debug, Clone)]
pub struct ObjectiveOptions {
    /// Most iterations of the outer loop of the methods without conic programs.
    pub max_iterations: usize,
    /// They stop when the objective falls by less than this fraction in one iteration.
    pub tolerance: f64,
    /// The methods with conic programs.
    pub conic: ConicOptions,
}

impl Default for ObjectiveOptions {
    fn default() -> Self {
        Self { max_iterations: 1000, tolerance: 1e-8, conic: ConicOptions::default() }
    }
}

/// How a minimiser ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Ending {
    /// The objective settled.
    Converged,
    /// The iterations ran out, or no step lowered the objective further.
    Stopped,
    /// The minimiser over all layouts has flips or wrong angles; this is a layout without, near the edge of
    /// what is allowed.
    Guarded {
        /// Flipped triangles of the layout that was given up.
        flips: usize,
    },
    /// Nothing better than the start was found; it is returned.
    NoGain,
}

impl std::fmt::Display for Ending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Converged => f.write_str("converged"),
            Self::Stopped => f.write_str("stopped before it settled"),
            Self::Guarded { flips: 0 } => f.write_str("held at the edge of the flip-free region"),
            Self::Guarded { flips } => write!(
                f,
                "held at the edge of the flip-free region: the minimiser would flip {flips} triangles"
            ),
            Self::NoGain => f.write_str("no gain: the start is returned"),
        }
    }
}

/// A layout that minimises an objective. It has no flips and the right angles if its start had.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Optimized {
    /// The unknowns, at the global scale of the objective's measure.
    pub y: Vec<f64>,
    /// The objective's figure: of its measure, or the mean squared distance to the frames.
    pub value: f64,
    /// The same figure before.
    pub before: f64,
    /// Iterations of the outer loop, those of abandoned attempts included.
    pub iterations: usize,
    /// How it ended.
    pub ending: Ending,
    /// How the conic programs were solved, if there were any.
    pub conic: Option<ConicStats>,
}

/// How the conic programs of a layout were solved.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConicStats {
    /// Programs solved.
    pub programs: usize,
    /// The solver of the last program.
    pub solver: Solver,
    /// How the own solver failed, if Clarabel had to take over.
    pub fallback_from: Option<Outcome>,
    /// For eq. (8) and (11): whether the bound reached, below 1, proves by itself that there is no flip.
    pub injective_by_bound: Option<bool>,
}

/// Why there is no optimised layout.
#[derive(Debug, thiserror::Error)]
pub enum OptimizeError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A linear system could not be set up or factored.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
    /// The conic programs could not be set up.
    #[error(transparent)]
    Conic(ConicError),
}

impl From<ConicError> for OptimizeError {
    fn from(error: ConicError) -> Self {
        match error {
            ConicError::Cancelled(cancelled) => cancelled.into(),
            error => Self::Conic(error),
        }
    }
}

/// What a method found, before it is judged.
struct Found {
    y: Vec<f64>,
    iterations: usize,
    ending: Ending,
    conic: Option<ConicStats>,
}

impl Found {
    fn new(y: Vec<f64>, iterations: usize, ending: Ending) -> Self {
        Self { y, iterations, ending, conic: None }
    }
}

/// Minimises an objective over the exact layouts, from one without flips and with the right angles.
///
/// Methods that jump may land where triangles are flipped; then the objective is minimised again by Newton
/// steps that cannot flip, behind a barrier that fades out. The result is never worse than the start by the
/// objective's own measure, and at that measure's global scale.
///
/// # Errors
/// [`OptimizeError`].
pub fn optimize(
    sectors: &Sectors<'_>,
    layout: &mut ExactLayout,
    y: Vec<f64>,
    objective: Objective,
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Optimized, OptimizeError> {
    let figure = Figure::new(layout, &y, objective);
    let before = figure.of(layout, &y);
    let found = match objective {
        Objective::SymmetricDirichlet => {
            newton(layout, y.clone(), &SymmetricDirichlet, options, watch)?
        }
        Objective::Arap => rigid::local_global(sectors, layout, y.clone(), options, watch)?,
        Objective::ArapNewton => rigid::newton_steps(layout, y.clone(), options, watch)?,
        Objective::Poisson => rigid::poisson(sectors, layout, y.clone())?,
        Objective::Asap => similar::asap(sectors, layout, y.clone(), options, watch)?,
        Objective::ArapMax => conic(layout, &y, ConicObjective::ArapMax, options, watch)?,
        Objective::Tau => conic(layout, &y, ConicObjective::Tau, options, watch)?,
        Objective::TauAlternating => {
            conic(layout, &y, ConicObjective::TauAlternating, options, watch)?
        }
        Objective::AsapMax => conic(layout, &y, ConicObjective::AsapMax, options, watch)?,
        Objective::Dilatation => {
            dilatation(layout, &y, ConicObjective::Dilatation, options, watch)?
        }
        Objective::DilatationBisection => {
            dilatation(layout, &y, ConicObjective::DilatationBisection, options, watch)?
        }
    };
    let value = figure.of(layout, &found.y);
    let is_better = value <= before && layout.defects(sectors, &found.y).none();
    let (mut y, value, ending) =
        if is_better { (found.y, value, found.ending) } else { (y, before, Ending::NoGain) };
    figure.rescale(layout, &mut y);
    Ok(Optimized { y, value, before, iterations: found.iterations, ending, conic: found.conic })
}

/// The figure that an objective lowers.
enum Figure {
    Measured(Measure),
    /// Mean squared distance of the Jacobians to these rotations.
    Framed(Vec<Complex64>),
}

impl Figure {
    fn new(layout: &ExactLayout, y: &[f64], objective: Objective) -> Self {
        match objective.measure() {
            Some(measure) => Self::Measured(measure),
            None => Self::Framed(frames(layout.problem().triangles(), &layout.expand(y))),
        }
    }

    fn of(&self, layout: &ExactLayout, y: &[f64]) -> f64 {
        match self {
            Self::Measured(measure) => summarize(*measure, &layout.singular_values(y)).figure(),
            Self::Framed(rotations) => {
                distance_to_frames(layout.problem().triangles(), rotations, &layout.expand(y))
            }
        }
    }

    /// Brings a layout to the global scale of the measure, or of the symmetric Dirichlet energy where the
    /// measure has none. Frames fix the scale themselves.
    fn rescale(&self, layout: &ExactLayout, y: &mut [f64]) {
        let Self::Measured(measure) = *self else { return };
        let measure = match measure {
            Measure::TauTilde | Measure::AsapMax | Measure::Dilatation => {
                Measure::SymmetricDirichlet
            }
            scaled => scaled,
        };
        let scale = measure.scale(&layout.singular_values(y));
        y.iter_mut().for_each(|x| *x *= scale);
    }
}

/// Newton steps are dear, and few are needed.
const MOST_NEWTON_STEPS: usize = 100;

fn newton(
    layout: &mut ExactLayout,
    y: Vec<f64>,
    energy: &impl Energy,
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Found, Cancelled> {
    let options = NewtonOptions {
        max_iterations: options.max_iterations.min(MOST_NEWTON_STEPS),
        tolerance: options.tolerance,
    };
    let NewtonSolution { y, iterations, stop, .. } =
        minimize(layout.problem_mut(), y, energy, &options, watch)?;
    let ending = if stop == Stop::Converged { Ending::Converged } else { Ending::Stopped };
    Ok(Found::new(y, iterations, ending))
}

fn conic(
    layout: &mut ExactLayout,
    y: &[f64],
    objective: ConicObjective,
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Found, OptimizeError> {
    let problem = layout.problem_mut();
    let found = conic::minimize(problem, y.to_vec(), objective, &options.conic, watch)?;
    let ending = match found.outcome {
        Outcome::Solved => Ending::Converged,
        _ => Ending::Stopped,
    };
    let stats = ConicStats {
        programs: found.rounds,
        solver: found.solver_used,
        fallback_from: found.fallback_from,
        injective_by_bound: found.injective_by_bound,
    };
    let conic = Some(stats);
    Ok(Found { y: found.y, iterations: found.iterations, ending, conic })
}

/// A method for the dilatation, then programs (11) from where it settles: their measure
/// `(K - 1)^2 / (K^2 + 1)` orders layouts as K does, and they may find more.
fn dilatation(
    layout: &mut ExactLayout,
    y: &[f64],
    objective: ConicObjective,
    options: &ObjectiveOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Found, OptimizeError> {
    let first = conic(layout, y, objective, options, watch)?;
    let second = conic(layout, &first.y, ConicObjective::AsapMax, options, watch)?;
    let conic = first.conic.zip(second.conic).map(|(a, b)| ConicStats {
        programs: a.programs + b.programs,
        fallback_from: a.fallback_from.or(b.fallback_from),
        ..b
    });
    Ok(Found { iterations: first.iterations + second.iterations, conic, ..second })
}
