//! The finish: the least tau for a small rise of the mean energy.

use super::conic::{ConicError, ConicObjective, ConicOptions, minimize};
use super::exact::ExactLayout;
use super::newton::NewtonOptions;
use super::window::Window;
use crate::progress::{Cancelled, Watch};
use std::time::Duration;
use web_time::Instant;

/// Settings of the finish.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolishOptions {
    /// By how much of itself the mean symmetric Dirichlet energy may rise, for a lower tau.
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

/// Bounds on tau, as parts of the least one: the first tried, and the closest to tau of the relaxed layout.
const TIGHTEST: f64 = 1.003;
const LOOSEST: f64 = 0.999;
/// Energies tried.
const BOUNDS: usize = 5;
/// A rise of this part of the one allowed is near enough.
const ENOUGH: f64 = 0.9;
/// The rise falls about as this power of the bound; only the second bound tried rests on it.
const DECAY: f64 = 15.0;
/// Barrier weight, in units of the energy: a tenth of usual excesses over 4, so that few Newton steps do.
const WEIGHT: f64 = 1e-2;
const SETTLE: NewtonOptions = NewtonOptions { max_iterations: 12, tolerance: 1e-5 };
/// Factors of the least tau below which no more energy is spent.
const NEAR_ENOUGH: f64 = 1.01;
const HALVINGS: usize = 10;
/// Parts of the way to a layout of low energy where a minimisation may start.
const STARTS: [f64; 7] = [1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.0];
/// How near the bounds of a window a start may lie, as a part of its logarithmic width.
const ROOM: f64 = 0.02;

/// Lowers tau below that of `start`, while the mean symmetric Dirichlet energy stays below
/// `1 + max_energy_rise` times that of `relaxed`, a layout of least energy.
///
/// The least tau comes from [`ConicObjective::Tau`] (its first, fused run); then energies with all singular
/// values kept in windows of growing width are minimised, until the rise is what is allowed. None when
/// nothing better than `start` was found. Both layouts must be free of flips.
///
/// # Errors
/// [`Cancelled`].
pub fn polish(
    layout: &mut ExactLayout,
    relaxed: &[f64],
    start: &[f64],
    options: &PolishOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Option<Polished>, Cancelled> {
    let deadline = options.time_limit.and_then(|limit| Instant::now().checked_add(limit));
    let limits = ConicOptions { max_rounds: 0, ..ConicOptions::default() };
    let tightest = watch.limited(deadline, |watch| {
        let problem = layout.problem_mut();
        match minimize(problem, start.to_vec(), ConicObjective::Tau, &limits, watch) {
            Ok(minimum) => Ok(Some(minimum)),
            Err(ConicError::Cancelled(cancelled)) => Err(cancelled),
            Err(_) => Ok(None),
        }
    })?;
    let Some(tightest) = tightest.flatten() else { return Ok(None) };
    let iterations = tightest.iterations;
    let mut search = Search::new(layout, relaxed, start, tightest.y, options, iterations);
    if watch.limited(deadline, |watch| search.run(watch))?.is_some() {
        search.spend_the_rest();
    }
    let Search { best, iterations, improved, .. } = search;
    Ok(improved.then_some(Polished { y: best, iterations }))
}

/// A search for the bound on tau whose energy is the one allowed.
struct Search<'a> {
    layout: &'a mut ExactLayout,
    relaxed: &'a [f64],
    start: &'a [f64],
    /// Energy of the relaxed layout, and its rise that is allowed.
    energy: f64,
    allowed: f64,
    /// Extreme singular values of the layout of least tau at its best scale, and its tau.
    extremes: (f64, f64),
    tau: f64,
    /// The layout of least tau, and the last one found.
    tightest: Vec<f64>,
    last: Vec<f64>,
    best: Vec<f64>,
    best_tau: f64,
    improved: bool,
    iterations: usize,
}

impl<'a> Search<'a> {
    fn new(
        layout: &'a mut ExactLayout,
        relaxed: &'a [f64],
        start: &'a [f64],
        mut tightest: Vec<f64>,
        options: &PolishOptions,
        iterations: usize,
    ) -> Self {
        layout.rescale(&mut tightest);
        let (energy, _) = layout.distortion(relaxed);
        Self {
            allowed: energy * options.max_energy_rise,
            energy,
            extremes: layout.extreme_singular_values(&tightest),
            tau: layout.distortion(&tightest).1,
            best: start.to_vec(),
            best_tau: layout.distortion(start).1,
            last: tightest.clone(),
            tightest,
            layout,
            relaxed,
            start,
            improved: false,
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
            let missing =
                (rise.max(1e-3 * self.allowed) / (0.5 * (1.0 + ENOUGH) * self.allowed)).ln();
            let slope = match previous {
                Some((w, log_rise)) if width != w => {
                    ((log_rise - rise.max(1e-3 * self.allowed).ln()) / (width - w))
                        .clamp(3.0, 100.0)
                }
                _ => DECAY,
            };
            previous = Some((width, rise.max(1e-3 * self.allowed).ln()));
            width = (width + missing / slope).clamp(TIGHTEST.ln(), loosest.max(TIGHTEST.ln()));
        }
        Ok(())
    }

    /// Minimises the energy with tau below `factor` times the least one; returns the rise of the energy.
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

    /// Takes a layout if it is better than the best; returns the rise of its energy.
    fn consider(&mut self, y: &[f64]) -> f64 {
        let (energy, tau) = self.layout.distortion(y);
        let rise = energy - self.energy;
        if rise <= self.allowed && tau < self.best_tau {
            self.best = y.to_vec();
            (self.best_tau, self.improved) = (tau, true);
        }
        rise
    }

    /// Where windows have left tau well above the least one: goes straight towards that one, as far as the
    /// energy allows.
    fn spend_the_rest(&mut self) {
        if self.best_tau <= NEAR_ENOUGH * self.tau {
            return;
        }
        let from = self.best.clone();
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let part = 0.5 * (low + high);
            let between = from.iter().zip(&self.tightest).map(|(y, t)| y + part * (t - y));
            let y: Vec<f64> = between.collect();
            if self.consider(&y) <= self.allowed { low = part } else { high = part }
        }
    }

    /// A point in the window to start from: of those far along straight ways from layouts of low tau to layouts
    /// of low energy, the one of least energy.
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
