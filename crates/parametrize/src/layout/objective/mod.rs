//! Layouts that minimise the distortion one chooses, in the exact space and without flips.

mod bounded;
mod guarded;
mod maximal;
mod outcome;
mod rigid;
mod similar;

pub use outcome::{ConicStats, Ending, OptimizeError, Optimized};

use super::arap::{distance_to_frames, frames};
use super::conic::{ConicOptions, MaximalMeasure, Phase, Solver};
use super::exact::ExactLayout;
use super::newton::{NewtonOptions, NewtonSolution, Stop, minimize};
use crate::energy::{Energy, SymmetricDirichlet};
use crate::features::Sectors;
use crate::progress::{Cancelled, Watch};
use crate::quality::{Measure, summarize};
use num_complex::Complex64;

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
    /// Largest dilatation, by programs (11) and (12), which has a scale per triangle.
    Dilatation,
    /// Largest dilatation by programs (12) alone, as printed.
    DilatationAlternating,
    /// Largest dilatation by bisection over bounds on it (Lipman 2012).
    DilatationBisection,
}

impl Objective {
    /// Whether this build can minimise it: the bisection needs the feature `clarabel`.
    pub fn is_available(self) -> bool {
        self != Self::DilatationBisection || Solver::Clarabel.is_available()
    }

    /// All of them.
    pub const ALL: [Self; 12] = [
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
        Self::DilatationAlternating,
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
            Self::DilatationAlternating => "dilatation-alternating",
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
            Self::Dilatation | Self::DilatationAlternating | Self::DilatationBisection => {
                Some(Measure::Dilatation)
            }
        }
    }

    /// Whether it lowers the dilatation, which can be bounded instead of minimised.
    pub fn is_of_dilatation(self) -> bool {
        self.measure() == Some(Measure::Dilatation)
    }

    /// How conic programs minimise it; none if they do not.
    fn phases(self) -> &'static [Phase] {
        use MaximalMeasure::{Arap, Asap, Dilatation, Tau};
        use Phase::{Alternating, Bisection, Fused};
        match self {
            Self::ArapMax => &[Fused(Arap), Alternating(Arap)],
            Self::Tau => &[Fused(Tau), Alternating(Tau)],
            Self::TauAlternating => &[Alternating(Tau)],
            Self::AsapMax => &[Fused(Asap), Alternating(Asap)],
            // (11) has the same minimisers as (12) and gets stuck less: at a fixed point of (12) no triangle of
            // largest dilatation may change its size. From where (12) settles it may find more.
            Self::Dilatation => &[
                Fused(Asap),
                Alternating(Asap),
                Fused(Dilatation),
                Alternating(Dilatation),
                Fused(Asap),
                Alternating(Asap),
            ],
            Self::DilatationAlternating => &[Alternating(Dilatation)],
            Self::DilatationBisection => &[Bisection, Fused(Asap), Alternating(Asap)],
            Self::SymmetricDirichlet
            | Self::Arap
            | Self::ArapNewton
            | Self::Poisson
            | Self::Asap => &[],
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
    /// With an objective of the dilatation: a bound on it, at least 1. The mean symmetric Dirichlet energy is then
    /// minimised over the layouts that keep it, and the objective is how such a layout is found. None: the
    /// dilatation itself is minimised.
    pub dilatation_bound: Option<f64>,
}

impl Default for ObjectiveOptions {
    fn default() -> Self {
        Self {
            max_iterations: 1000,
            tolerance: 1e-8,
            conic: ConicOptions::default(),
            dilatation_bound: None,
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
    if let Some(bound) = options.dilatation_bound {
        return bounded::optimize(sectors, layout, y, (objective, bound), options, watch);
    }
    let figure = Figure::new(layout, &y, objective);
    let before = figure.of(layout, &y);
    let start = y.clone();
    let found = match objective {
        Objective::SymmetricDirichlet => {
            newton(layout, start, &SymmetricDirichlet, options, watch)?
        }
        Objective::Arap => rigid::local_global(sectors, layout, start, options, watch)?,
        Objective::ArapNewton => rigid::newton_steps(layout, start, options, watch)?,
        Objective::Poisson => rigid::poisson(sectors, layout, start)?,
        Objective::Asap => similar::asap(sectors, layout, start, options, watch)?,
        Objective::ArapMax
        | Objective::Tau
        | Objective::TauAlternating
        | Objective::AsapMax
        | Objective::Dilatation
        | Objective::DilatationAlternating
        | Objective::DilatationBisection => {
            maximal::minimize(layout, start, objective.phases(), options, watch)?
        }
    };
    let value = figure.of(layout, &found.y);
    let is_better = value <= before && layout.defects(sectors, &found.y).none();
    let (mut y, value, ending) =
        if is_better { (found.y, value, found.ending) } else { (y, before, Ending::NoGain) };
    figure.rescale(layout, &mut y);
    let Found { iterations, conic, .. } = found;
    Ok(Optimized { y, value, before, iterations, ending, conic, dilatation: None })
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
        let measure = if measure.has_scale() { measure } else { Measure::SymmetricDirichlet };
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
