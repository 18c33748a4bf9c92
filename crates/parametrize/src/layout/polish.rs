//! The finish: the minimum tau for a small rise of the mean energy.

use super::conic::{ConicError, ConicMinimum, ConicOptions, MaximalMeasure, Phase, minimize};
use super::exact::ExactLayout;
use super::newton::NewtonOptions;
use crate::energy::Window;
use crate::progress::{Cancelled, Watch};
use std::time::Duration;
use web_time::Instant;

/// Settings of the finish.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolishOptions {
    /// Maximum relative increase of the mean symmetric Dirichlet energy over its minimum, for a lower tau.
    pub max_energy_rise: f64,
    /// Stop after this time with the best so far; the map then depends on the machine. None: no limit.
    pub time_limit: Option<Duration>,
}

impl Default for PolishOptions {
    fn default() -> Self {
        Self { max_energy_rise: 0.003, time_limit: None }
    }
}

/// A polished layout.
#[derive(Debug, Clone)]
pub struct Polished {
    /// The unknowns.
    pub y: Vec<f64>,
    /// Interior-point and Newton iterations.
    pub iterations: usize,
}

/// Range of bounds on tau: the first one tried, relative to the minimum tau, and the loosest, relative to tau of
/// the relaxed layout, which needs no bound any more.
const TIGHTEST: f64 = 1.003;
const LOOSEST: f64 = 0.999;
/// Bounds tried: secant steps seldom need more, and each costs up to a dozen factorisations.
const BOUNDS: usize = 5;
/// A rise of this part of the one allowed is near enough.
const ENOUGH: f64 = 0.9;
/// The part of the allowed rise that is aimed at, in the middle of what is near enough.
const TARGET: f64 = 0.5 * (1.0 + ENOUGH);
/// A rise counts as this part of the one allowed at least, so that it has a logarithm.
const SMALLEST_RISE: f64 = 1e-3;
/// The rise falls about as this power of the bound; only the second bound tried rests on it.
const DECAY: f64 = 15.0;
/// Powers that a secant may have: others come from rises that hardly differ.
const FLATTEST: f64 = 3.0;
const STEEPEST: f64 = 100.0;
/// Barrier weight, in units of the energy: a tenth of usual excesses over 4, so that few Newton steps do.
const WEIGHT: f64 = 1e-2;
/// To a fraction of the usual rise: a window is one of several that are tried.
const SETTLE: NewtonOptions = NewtonOptions { max_iterations: 12, tolerance: 1e-5 };
/// Within this factor of the minimum tau no more energy is spent.
const NEAR_ENOUGH: f64 = 1.01;
/// Halvings of the line search that spends the rest: to a thousandth of the line.
const HALVINGS: usize = 10;
/// Parts of the way to a layout of low energy where a minimisation may start.
const STARTS: [f64; 7] = [1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.0];
/// How near the bounds of a window a start may lie, as a part of its logarithmic width.
const ROOM: f64 = 0.02;

/// Lowers tau while the mean symmetric Dirichlet energy stays within `1 + max_energy_rise` times its minimum.
///
/// Returned is the layout of smallest tau among all those found whose energy is within this bound of the smallest
/// energy found: `relaxed`, a layout of minimum energy, `start`, one of lower tau that may have more energy than
/// is allowed, and those of the search. So the bound always holds, and nothing that a smaller rise would
/// have kept of `relaxed` and `start` is lost with a larger one.
///
/// The search finds the minimum tau by a fused run of conic programs (9); then it minimises energies with all
/// singular values kept in windows of growing width, until the rise is what is allowed. Both layouts must be
/// free of flips.
///
/// # Errors
/// [`Cancelled`].
pub fn polish(
    layout: &mut ExactLayout,
    relaxed: &[f64],
    start: &[f64],
    options: &PolishOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Polished, Cancelled> {
    let rise = options.max_energy_rise;
    let mut front = Front::new(Candidate::new(layout, relaxed));
    front.add(Candidate::new(layout, start));
    if rise <= 0.0 {
        return Ok(Polished { y: front.best(rise).y.clone(), iterations: 0 });
    }
    let deadline = options.time_limit.and_then(|limit| Instant::now().checked_add(limit));
    let tightest = watch.limited(deadline, |watch| minimum_tau(layout, start, watch))?;
    let Some(tightest) = tightest.flatten() else {
        return Ok(Polished { y: front.best(rise).y.clone(), iterations: 0 });
    };
    let mut search = Search::new(layout, relaxed, start, tightest, front, rise);
    if watch.limited(deadline, |watch| search.run(watch))?.is_some() {
        search.spend_the_rest();
    }
    let Search { front, iterations, .. } = search;
    Ok(Polished { y: front.best(rise).y.clone(), iterations })
}

/// A layout of low tau, whatever its energy; none if the programs fail.
fn minimum_tau(
    layout: &mut ExactLayout,
    start: &[f64],
    watch: &mut Watch<'_, '_>,
) -> Result<Option<ConicMinimum>, Cancelled> {
    let phases = [Phase::Fused(MaximalMeasure::Tau)];
    let options = ConicOptions::default();
    match minimize(layout.problem_mut(), start.to_vec(), &phases, &options, watch) {
        Ok(minimum) => Ok(Some(minimum)),
        Err(ConicError::Cancelled(cancelled)) => Err(cancelled),
        Err(_) => Ok(None),
    }
}

/// A layout with what it is judged by.
struct Candidate {
    y: Vec<f64>,
    energy: f64,
    tau: f64,
}

impl Candidate {
    fn new(layout: &ExactLayout, y: &[f64]) -> Self {
        let (energy, tau) = layout.distortion(y);
        Self { y: y.to_vec(), energy, tau }
    }
}

/// The layouts found.
struct Front {
    /// The one of smallest energy.
    minimum: Candidate,
    others: Vec<Candidate>,
}

impl Front {
    fn new(first: Candidate) -> Self {
        Self { minimum: first, others: Vec::new() }
    }

    fn add(&mut self, candidate: Candidate) {
        let other = match candidate.energy < self.minimum.energy {
            true => std::mem::replace(&mut self.minimum, candidate),
            false => candidate,
        };
        self.others.push(other);
    }

    /// The one of smallest tau among those whose energy is at most `1 + rise` times the smallest.
    fn best(&self, rise: f64) -> &Candidate {
        let most = (1.0 + rise) * self.minimum.energy;
        let within = self.others.iter().filter(|c| c.energy <= most);
        within.fold(&self.minimum, |best, c| if c.tau < best.tau { c } else { best })
    }
}

/// A search for the bound on tau whose energy is the one allowed.
struct Search<'a> {
    layout: &'a mut ExactLayout,
    relaxed: &'a [f64],
    start: &'a [f64],
    /// Energy of the relaxed layout, and its rise that is allowed, absolute and relative.
    energy: f64,
    allowed: f64,
    rise: f64,
    /// Extreme singular values of the layout of minimum tau at its best scale, and its tau.
    extremes: (f64, f64),
    tau: f64,
    /// The layout of minimum tau, and the last one found.
    tightest: Vec<f64>,
    last: Vec<f64>,
    front: Front,
    iterations: usize,
}

impl<'a> Search<'a> {
    fn new(
        layout: &'a mut ExactLayout,
        relaxed: &'a [f64],
        start: &'a [f64],
        tightest: ConicMinimum,
        front: Front,
        rise: f64,
    ) -> Self {
        let ConicMinimum { y: mut tightest, iterations, .. } = tightest;
        layout.rescale(&mut tightest);
        let (energy, _) = layout.distortion(relaxed);
        Self {
            energy,
            allowed: energy * rise,
            rise,
            extremes: layout.extreme_singular_values(&tightest),
            tau: layout.distortion(&tightest).1,
            last: tightest.clone(),
            tightest,
            layout,
            relaxed,
            start,
            front,
            iterations,
        }
    }

    /// Secant steps in the logarithms of bound and rise.
    fn run(&mut self, watch: &mut Watch<'_, '_>) -> Result<(), Cancelled> {
        let loosest = (LOOSEST * self.layout.distortion(self.relaxed).1 / self.tau).ln();
        let mut width = TIGHTEST.ln();
        let mut previous: Option<(f64, f64)> = None;
        for _ in 0..BOUNDS {
            let rise = self.minimize_within(width.exp(), watch)?;
            if width >= loosest || (ENOUGH * self.allowed..=self.allowed).contains(&rise) {
                break;
            }
            if previous.is_none() && rise <= self.allowed {
                break;
            }
            let rise = rise.max(SMALLEST_RISE * self.allowed);
            let missing = (rise / (TARGET * self.allowed)).ln();
            let slope = match previous {
                Some((w, log_rise)) if width != w => {
                    ((log_rise - rise.ln()) / (width - w)).clamp(FLATTEST, STEEPEST)
                }
                _ => DECAY,
            };
            previous = Some((width, rise.ln()));
            width = (width + missing / slope).clamp(TIGHTEST.ln(), loosest.max(TIGHTEST.ln()));
        }
        Ok(())
    }

    /// Minimises the energy with tau below `factor` times the minimum; returns the rise of the energy.
    fn minimize_within(
        &mut self,
        factor: f64,
        watch: &mut Watch<'_, '_>,
    ) -> Result<f64, Cancelled> {
        let (highest, lowest) = (self.extremes.0 * factor, self.extremes.1 / factor);
        let window = Window { lowest, highest, weight: WEIGHT };
        let start = self.start_within(&window);
        let solution = self.layout.minimize(start, &window, &SETTLE, watch)?;
        self.iterations += solution.iterations;
        let rise = self.consider(&solution.y);
        self.last = solution.y;
        Ok(rise)
    }

    /// Takes a layout to those found; returns the rise of its energy.
    fn consider(&mut self, y: &[f64]) -> f64 {
        let candidate = Candidate::new(self.layout, y);
        let rise = candidate.energy - self.energy;
        self.front.add(candidate);
        rise
    }

    /// Where windows have left tau well above the minimum: goes straight towards that, as far as the energy
    /// allows.
    fn spend_the_rest(&mut self) {
        let best = self.front.best(self.rise);
        if best.tau <= NEAR_ENOUGH * self.tau {
            return;
        }
        let from = best.y.clone();
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let part = 0.5 * (low + high);
            let between = from.iter().zip(&self.tightest).map(|(y, t)| y + part * (t - y));
            let y: Vec<f64> = between.collect();
            if self.consider(&y) <= self.allowed { low = part } else { high = part }
        }
    }

    /// A point in the window to start from: of those far along straight lines from layouts of low tau to layouts
    /// of low energy, the one of smallest energy.
    fn start_within(&self, window: &Window) -> Vec<f64> {
        let inside = |y: &[f64], margin: f64| {
            let (largest, smallest) = self.layout.extreme_singular_values(y);
            largest * margin < window.highest && smallest > window.lowest * margin
        };
        let margin = (window.highest / window.lowest).powf(ROOM);
        let mut found = (f64::INFINITY, self.tightest.clone());
        for from in [&self.tightest, &self.last] {
            for to in [self.relaxed, self.start] {
                let between = |part: f64| -> Vec<f64> {
                    from.iter().zip(to).map(|(y, r)| y + part * (r - y)).collect()
                };
                let farthest = STARTS.into_iter().map(between).find(|y| inside(y, margin));
                let energy = |y: &Vec<f64>| self.layout.distortion(y).0;
                if let Some(y) = farthest.filter(|y| energy(y) < found.0) {
                    found = (energy(&y), y);
                }
            }
        }
        found.1
    }
}
