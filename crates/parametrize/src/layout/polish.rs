//! The finish: the minimum tau for a small rise of the mean energy.

use super::conic::trade;
use super::exact::ExactLayout;
use super::problem::LayoutProblem;
use crate::progress::{Cancelled, Watch};
use crate::quality::Figures;
use num_complex::Complex64;
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

/// Weight of the energy at first and at least, against tau squared: with less the energy rises for next to nothing.
const LEAST_WEIGHT: f64 = 2.0;
/// Iterations before the weight changes: those in which the run leaves its start.
const PATIENCE: usize = 3;
/// The weight is multiplied by the rise to come as a part of the one allowed, squared where it is above: it has less time to
/// come back; but by no more than these factors at a time.
const CHANGE: (f64, f64) = (0.4, 2.5);
/// A rise counts as this part of the one allowed at least.
const SMALLEST_RISE: f64 = 0.05;
/// The rise goes on as it went from the last layout, for two more; by no more than this factor for each.
const LARGEST_TREND: f64 = 2.0;
/// The part by which tau has to fall to be worth an iteration, and how many may go without.
const WORTHWHILE: f64 = 0.01;
const IDLE: usize = 2;
/// Halvings of the line search that spends the rest: to a thousandth of the line.
const HALVINGS: usize = 10;

/// Lowers tau while the mean symmetric Dirichlet energy stays within `1 + max_energy_rise` times that of a layout of
/// minimum energy, `relaxed`, which is free of flips.
///
/// A fused conic run for tau has the energy as a term of its objective, to second order, whose weight is adapted until
/// the rise measured is the one allowed. Of the layouts that it passes through, the one of smallest tau within the
/// bound goes on towards the best one beyond, as far as the bound allows.
///
/// # Errors
/// [`Cancelled`].
pub fn polish(
    layout: &mut ExactLayout,
    relaxed: &[f64],
    options: &PolishOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Polished, Cancelled> {
    let start = Candidate {
        y: relaxed.to_vec(),
        ..Candidate::new(layout.problem(), relaxed, &layout.expand(relaxed))
    };
    let mut search = Search::new(start, options.max_energy_rise);
    if options.max_energy_rise <= 0.0 {
        return Ok(Polished { y: search.within.y, iterations: 0 });
    }
    let deadline = options.time_limit.and_then(|limit| Instant::now().checked_add(limit));
    let mut minimum = relaxed.to_vec();
    layout.rescale(&mut minimum);
    let iterations = watch.limited(deadline, |watch| {
        let mut weigh =
            |problem: &LayoutProblem, y: &[f64], z: &[Complex64]| search.weigh(problem, y, z);
        trade(layout.problem_mut(), minimum, &mut weigh, watch)
    })?;
    search.spend_the_rest(layout);
    Ok(Polished { y: search.within.y, iterations: iterations.unwrap_or(0) })
}

/// A layout at its best scale with what it is judged by.
struct Candidate {
    y: Vec<f64>,
    scale: f64,
    energy: f64,
    tau: f64,
}

impl Candidate {
    fn new(problem: &LayoutProblem, y: &[f64], z: &[Complex64]) -> Self {
        let Figures { scale, symmetric_dirichlet, pull, tau } =
            Figures::of_layout(problem.triangles(), z);
        let y = y.iter().map(|y| scale * y).collect();
        Self { y, scale, energy: symmetric_dirichlet + pull, tau }
    }
}

/// A search for the smallest tau within a bound on the energy.
struct Search {
    /// The smallest energy, and the rise allowed.
    least: f64,
    allowed: f64,
    weight: f64,
    /// Layouts seen.
    count: usize,
    /// The rise of the last, as a part of the one allowed.
    last_rise: f64,
    /// The last layouts, all of them within the bound, that gained nothing.
    idle: usize,
    /// Those of smallest tau within the bound and beyond.
    within: Candidate,
    beyond: Option<Candidate>,
}

impl Search {
    fn new(start: Candidate, max_energy_rise: f64) -> Self {
        Self {
            least: start.energy,
            allowed: max_energy_rise * start.energy,
            weight: LEAST_WEIGHT,
            count: 0,
            last_rise: SMALLEST_RISE,
            idle: 0,
            within: start,
            beyond: None,
        }
    }

    /// Judges a layout; returns its best scale, and the weight of the energy from there on, unless layouts within the bound
    /// have gained nothing for a while.
    fn weigh(&mut self, problem: &LayoutProblem, y: &[f64], z: &[Complex64]) -> Option<(f64, f64)> {
        let found = Candidate::new(problem, y, z);
        let scale = found.scale;
        let rise = ((found.energy - self.least) / self.allowed).max(SMALLEST_RISE);
        if self.count >= PATIENCE {
            // What the rise will be when the weight is felt.
            let trend = (rise / self.last_rise).clamp(1.0 / LARGEST_TREND, LARGEST_TREND);
            let coming = (rise * trend * trend).max(SMALLEST_RISE);
            let change = if coming > 1.0 { coming * coming } else { coming };
            self.weight = (self.weight * change.clamp(CHANGE.0, CHANGE.1)).max(LEAST_WEIGHT);
        }
        self.count += 1;
        self.last_rise = rise;
        let tau = self.within.tau;
        let is_within = self.take(found);
        let gains = self.within.tau < (1.0 - WORTHWHILE) * tau;
        self.idle = if is_within && !gains { self.idle + 1 } else { 0 };
        (self.idle < IDLE).then_some((scale, self.weight))
    }

    /// Keeps a layout if it is the best of its kind; returns whether it is within the bound.
    fn take(&mut self, found: Candidate) -> bool {
        let is_within = found.energy - self.least <= self.allowed;
        if is_within {
            if found.tau < self.within.tau {
                self.within = found;
            }
        } else if self.beyond.as_ref().is_none_or(|beyond| found.tau < beyond.tau) {
            self.beyond = Some(found);
        }
        is_within
    }

    /// Goes from the best layout within the bound straight to the one beyond, as far as the bound allows.
    fn spend_the_rest(&mut self, layout: &ExactLayout) {
        let Some(beyond) = self.beyond.take().filter(|beyond| beyond.tau < self.within.tau) else {
            return;
        };
        let from = self.within.y.clone();
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let part = 0.5 * (low + high);
            let between = from.iter().zip(&beyond.y).map(|(a, b)| a + part * (b - a));
            let y: Vec<f64> = between.collect();
            let found = Candidate::new(layout.problem(), &y, &layout.expand(&y));
            if self.take(found) { low = part } else { high = part }
        }
    }
}
