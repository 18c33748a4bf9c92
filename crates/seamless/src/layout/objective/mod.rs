//! Layouts that minimise the distortion one chooses, in the exact space and without flips.

mod guarded;
mod rigid;
mod similar;

use super::arap::{distance_to_frames, frames};
use super::energy::{Energy, SymmetricDirichlet};
use super::exact::ExactLayout;
use super::newton::{NewtonOptions, NewtonSolution, Stop, minimize};
use crate::progress::{Cancelled, Watch};
use crate::quality::{Measure, summarize};
use num_complex::Complex64;
use seamstress_numerics::NotPositiveDefinite;
use crate::features::Sectors;

/// What a layout minimises, and by which method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// Mean symmetric Dirichlet energy, eq. (5), by projected Newton.
    SymmetricDirichlet,
    /// Mean ARAP energy, eq. (7), by local and global steps (Liu et al. 2008).
    Arap,
    /// Mean ARAP energy by projected Newton (after Chao et al. 2010).
    ArapNewton,
    /// The single global step (6) for the frames of the layout it starts from.
    Poisson,
    /// Mean ASAP energy, eq. (10), at fixed size.
    Asap,
}

impl Objective {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::SymmetricDirichlet, Self::Arap, Self::ArapNewton, Self::Poisson, Self::Asap];

    /// Name for commands and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::SymmetricDirichlet => "symmetric-dirichlet",
            Self::Arap => "arap",
            Self::ArapNewton => "arap-newton",
            Self::Poisson => "poisson",
            Self::Asap => "asap",
        }
    }

    /// The measure whose figure it minimises; none for [`Objective::Poisson`], which minimises the
    /// distance to given frames.
    pub fn measure(self) -> Option<Measure> {
        match self {
            Self::SymmetricDirichlet => Some(Measure::SymmetricDirichlet),
            Self::Arap | Self::ArapNewton => Some(Measure::Arap),
            Self::Poisson => None,
            Self::Asap => Some(Measure::Asap),
        }
    }
}

impl std::fmt::Display for Objective {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Settings of the minimisers.
#[derive(Debug, Clone, Copy)]
pub struct ObjectiveOptions {
    /// Most iterations of a method's outer loop.
    pub max_iterations: usize,
    /// Stop when the objective falls by less than this fraction in one iteration.
    pub tolerance: f64,
}

impl Default for ObjectiveOptions {
    fn default() -> Self {
        Self { max_iterations: 1000, tolerance: 1e-8 }
    }
}

/// How a minimiser ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
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
}

/// What a method found, before it is judged.
struct Found {
    y: Vec<f64>,
    iterations: usize,
    ending: Ending,
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
    };
    let value = figure.of(layout, &found.y);
    let is_better = value <= before && layout.defects(sectors, &found.y).none();
    let (mut y, value, ending) =
        if is_better { (found.y, value, found.ending) } else { (y, before, Ending::NoGain) };
    figure.rescale(layout, &mut y);
    Ok(Optimized { y, value, before, iterations: found.iterations, ending })
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
    Ok(Found { y, iterations, ending })
}
