//! What no solution can beat: the sums of the triangles are priced instead of required.

use super::input::AngleNorm;
use super::piece::{Member, Piece};
use std::f64::consts::{FRAC_PI_2, PI};

/// Share of the last direction in the next one.
const MOMENTUM: f64 = 0.7;
/// Share of the last mean of indices in the next one.
const MEMORY: f64 = 0.9;
/// Fruitless steps before the length falls, and by which factor; below the least length the ascent ends.
const PATIENCE: usize = 6;
const SHORTER: f64 = 0.6;
const LEAST_LENGTH: f64 = 0.02;
/// A step that gains less than this share of what is missing is fruitless.
const FRUITFUL: f64 = 1e-4;
/// How far above the value the goal is taken to be where none is known.
const BLIND_GOAL: f64 = 1.0;
/// Newton steps towards the multiplier of a group's angle sum. The value at any multiplier is a bound, so
/// that an inexact one does no harm.
const STEPS: usize = 30;
/// A sum this near to the one wanted is met, radians.
const MET: f64 = 1e-12;

/// Prices on the angle sums of the triangles of a piece: each group is left alone with its corners and its
/// integer.
///
/// At a price `p` of a triangle its corners cost `c(d) + p d` for a change `d` between `-angle` and
/// `pi - angle`; a group has the least sum of this at the angle sum that belongs to one of its indices.
#[derive(Clone, Copy)]
pub(super) struct Pricing<'a> {
    pub(super) piece: &'a Piece,
    pub(super) norm: AngleNorm,
}

/// The least cost at some prices.
pub(super) struct Priced {
    /// A bound on the cost of the piece: all groups together, less what the triangles are paid.
    pub(super) value: f64,
    /// By how much the angles exceed pi in each triangle: the derivative of the value by its price.
    pub(super) excess: Vec<f64>,
    /// The best change of each member's index.
    pub(super) change: Vec<i32>,
}

/// Changes of a member's corners and their cost.
#[derive(Default)]
struct Share {
    value: f64,
    changes: Vec<f64>,
}

impl Pricing<'_> {
    /// The best indices within ranges.
    pub(super) fn best(&self, prices: &[f64], ranges: &[(i32, i32)]) -> Priced {
        let piece = self.piece;
        let mut excess: Vec<f64> = piece.lack.iter().map(|lack| -lack).collect();
        let mut value = -prices.iter().zip(&piece.lack).map(|(p, lack)| p * lack).sum::<f64>();
        for &c in &piece.free {
            let c = c as usize;
            let change = self.alone(c, prices[c / 3]);
            value += self.norm.cost(change) + prices[c / 3] * change;
            excess[c / 3] += change;
        }
        let mut change = Vec::with_capacity(piece.members.len());
        for (member, &range) in piece.members.iter().zip(ranges) {
            let (best, share) = self.best_of(member, range, prices);
            value += share.value;
            for (&c, d) in member.corners.iter().zip(&share.changes) {
                excess[c as usize / 3] += d;
            }
            change.push(best);
        }
        Priced { value, excess, change }
    }

    /// The cost of a member at a change of its index.
    pub(super) fn of(&self, member: usize, change: i32, prices: &[f64]) -> f64 {
        let member = &self.piece.members[member];
        self.shares(member, prices)(member.gain(change)).value
    }

    /// By how much each member costs more at the angles of the whole problem than at its best change. At angles with the right sums
    /// in triangles these differences, with those of the free corners, add up to the gap between value and bound.
    pub(super) fn gaps(&self, angles: &[f64], prices: &[f64]) -> Vec<f64> {
        let gap = |member: &Member| {
            let cost = |&c: &u32| {
                let c = c as usize;
                let change = angles[self.piece.corners[c] as usize] - self.piece.given[c];
                self.norm.cost(change) + prices[c / 3] * change
            };
            let now: f64 = member.corners.iter().map(cost).sum();
            now - self.best_of(member, member.range, prices).1.value
        };
        self.piece.members.iter().map(gap).collect()
    }

    /// Narrows ranges to the changes whose cost leaves the value below a goal.
    pub(super) fn narrow(&self, prices: &[f64], spare: f64, ranges: &mut [(i32, i32)]) {
        for (m, range) in ranges.iter_mut().enumerate().filter(|(_, range)| range.0 < range.1) {
            let (best, share) = self.best_of(&self.piece.members[m], *range, prices);
            let is_out = |change| self.of(m, change, prices) - share.value >= spare;
            // Costs are convex in the change.
            let outwards = |step: i32, end: i32| {
                let mut last = best;
                while last != end && !is_out(last + step) {
                    last += step;
                }
                last
            };
            *range = (outwards(-1, range.0), outwards(1, range.1));
        }
    }

    /// The best change of one member within a range: one of the two next to the best real one.
    fn best_of(&self, member: &Member, range: (i32, i32), prices: &[f64]) -> (i32, Share) {
        let alone = |&c: &u32| self.alone(c as usize, prices[c as usize / 3]);
        let sum: f64 = member.corners.iter().map(alone).sum();
        let real = (member.full_angle - member.given - sum) / FRAC_PI_2;
        let clamp = |change: f64| (change as i32).clamp(range.0, range.1);
        let (low, high) = (clamp(real.floor()), clamp(real.ceil()));
        let shares = self.shares(member, prices);
        let below = shares(member.gain(low));
        if low == high {
            return (low, below);
        }
        let above = shares(member.gain(high));
        if above.value < below.value { (high, above) } else { (low, below) }
    }

    /// The best change of a corner that no sum binds.
    fn alone(&self, corner: usize, price: f64) -> f64 {
        let (low, high) = self.bounds(corner);
        let best = match self.norm {
            AngleNorm::L2 => -0.5 * price,
            AngleNorm::L1 if price > 1.0 => low,
            AngleNorm::L1 if price < -1.0 => high,
            AngleNorm::L1 => 0.0,
        };
        best.max(low).min(high)
    }

    /// Least and largest change of a corner.
    fn bounds(&self, corner: usize) -> (f64, f64) {
        (-self.piece.given[corner], PI - self.piece.given[corner])
    }

    /// The best changes of a member's corners as a function of their sum.
    fn shares<'b>(
        &'b self,
        member: &'b Member,
        prices: &'b [f64],
    ) -> Box<dyn Fn(f64) -> Share + 'b> {
        match self.norm {
            AngleNorm::L2 => Box::new(|gain| self.share_squares(member, gain, prices)),
            AngleNorm::L1 => {
                let stretches = self.stretches(member, prices);
                Box::new(move |gain| self.fill(member, &stretches, gain, prices))
            }
        }
    }

    /// Least `sum d^2 + p d`: every corner lies at `(y - p) / 2` within its bounds, `y` the multiplier.
    fn share_squares(&self, member: &Member, gain: f64, prices: &[f64]) -> Share {
        let mut y = 0.0;
        for _ in 0..STEPS {
            let (mut sum, mut inside) = (0.0, 0);
            for &c in &member.corners {
                let (low, high) = self.bounds(c as usize);
                let change = 0.5 * (y - prices[c as usize / 3]);
                sum += change.max(low).min(high);
                inside += usize::from(low < change && change < high);
            }
            if (gain - sum).abs() < MET {
                break;
            }
            y += 2.0 * (gain - sum) / inside.max(1) as f64;
        }
        let mut share =
            Share { value: y * gain, changes: Vec::with_capacity(member.corners.len()) };
        for &c in &member.corners {
            let (low, high) = self.bounds(c as usize);
            let price = prices[c as usize / 3];
            let change = (0.5 * (y - price)).max(low).min(high);
            share.value += change * (change + price - y);
            share.changes.push(change);
        }
        share
    }

    /// The ways of a member's corners from their lower to their upper bounds, cut at no change, the cheapest first.
    fn stretches(&self, member: &Member, prices: &[f64]) -> Vec<Stretch> {
        let mut stretches = Vec::with_capacity(2 * member.corners.len());
        for (corner, &c) in member.corners.iter().enumerate() {
            let (low, high) = self.bounds(c as usize);
            let price = prices[c as usize / 3];
            if low < 0.0 {
                stretches.push(Stretch { slope: price - 1.0, corner, length: high.min(0.0) - low });
            }
            if high > 0.0 {
                stretches.push(Stretch { slope: price + 1.0, corner, length: high - low.max(0.0) });
            }
        }
        stretches.sort_by(|a, b| a.slope.total_cmp(&b.slope));
        stretches
    }

    /// Least `sum |d| + p d`: all corners start at their lower bounds, and the cheapest stretches are filled.
    fn fill(&self, member: &Member, stretches: &[Stretch], gain: f64, prices: &[f64]) -> Share {
        let mut share = Share { value: 0.0, changes: Vec::with_capacity(member.corners.len()) };
        let mut left = gain;
        for &c in &member.corners {
            let (low, _) = self.bounds(c as usize);
            share.changes.push(low);
            share.value += low.abs() + prices[c as usize / 3] * low;
            left -= low;
        }
        for stretch in stretches {
            if left <= 0.0 {
                break;
            }
            let filled = stretch.length.min(left);
            share.changes[stretch.corner] += filled;
            share.value += stretch.slope * filled;
            left -= filled;
        }
        share
    }
}

/// A part of the way of a member's corner along which its cost is linear.
struct Stretch {
    slope: f64,
    /// Its place among the member's corners.
    corner: usize,
    length: f64,
}

/// Prices from the multipliers of the triangle sums in a solved program.
pub(super) fn prices(multipliers: &[f64], norm: AngleNorm) -> Vec<f64> {
    let factor = match norm {
        // Those of squares are halves of derivatives.
        AngleNorm::L2 => -2.0,
        AngleNorm::L1 => -1.0,
    };
    multipliers.iter().map(|t| factor * t).collect()
}

/// Where an ascent came.
pub(super) struct Ascent {
    /// Price per triangle.
    pub(super) prices: Vec<f64>,
    /// The bound.
    pub(super) value: f64,
    /// Change of each member's index, averaged over the steps: fractional where the prices waver.
    pub(super) mean: Vec<f64>,
    /// Evaluations.
    pub(super) steps: usize,
}

/// Raises the bound of a piece by subgradients of its prices, towards a known value that it cannot exceed
/// (Polyak's step lengths, with deflection). The bound is valid wherever this ends.
pub(super) fn ascend(
    pricing: &Pricing<'_>,
    ranges: &[(i32, i32)],
    start: &[f64],
    goal: f64,
    most_steps: usize,
) -> Ascent {
    let mut now = start.to_vec();
    let mut best =
        Ascent { prices: start.to_vec(), value: f64::NEG_INFINITY, mean: Vec::new(), steps: 0 };
    let mut direction = vec![0.0; now.len()];
    let (mut length, mut fruitless) = (1.0, 0);
    while best.steps < most_steps {
        let priced = pricing.best(&now, ranges);
        best.steps += 1;
        best.remember(&priced);
        let target = if goal.is_finite() { goal } else { priced.value + BLIND_GOAL };
        let is_fruitful = priced.value > best.value + FRUITFUL * (target - best.value).abs();
        if priced.value > best.value {
            best.value = priced.value;
            best.prices.clone_from(&now);
        }
        fruitless = if is_fruitful || best.steps == 1 { 0 } else { fruitless + 1 };
        if best.value >= goal {
            break;
        }
        if fruitless >= PATIENCE {
            // Back to the best prices, with shorter steps.
            length *= SHORTER;
            fruitless = 0;
            if length < LEAST_LENGTH {
                break;
            }
            now.clone_from(&best.prices);
            direction.iter_mut().for_each(|d| *d *= 0.5);
            continue;
        }
        let kept = if best.steps == 1 { 0.0 } else { MOMENTUM };
        for (d, excess) in direction.iter_mut().zip(&priced.excess) {
            *d = kept * *d + (1.0 - kept) * excess;
        }
        let square: f64 = direction.iter().map(|d| d * d).sum();
        if square == 0.0 {
            break;
        }
        let step = length * (target - priced.value).max(0.0) / square;
        now.iter_mut().zip(&direction).for_each(|(p, d)| *p += step * d);
    }
    best
}

impl Ascent {
    fn remember(&mut self, priced: &Priced) {
        let change = priced.change.iter().map(|&n| f64::from(n));
        if self.mean.is_empty() {
            self.mean = change.collect();
            return;
        }
        for (mean, n) in self.mean.iter_mut().zip(change) {
            *mean = MEMORY * *mean + (1.0 - MEMORY) * n;
        }
    }
}
