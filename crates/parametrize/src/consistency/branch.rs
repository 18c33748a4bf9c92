//! Branch and bound over the integers of a piece.

use super::bound::{Pricing, ascend, prices};
use super::error::ConsistencyError;
use super::input::AngleNorm;
use super::piece::Piece;
use super::system::System;
use crate::progress::Watch;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A bound within this share of a value proves it: sums of angles are met to a billionth.
const PROOF: f64 = 1e-7;
/// Steps of the ascent at the root, at other nodes, which start from the prices of their parents, and where a
/// split is only tried.
const ROOT_STEPS: usize = 200;
const NODE_STEPS: usize = 40;
const TRIAL_STEPS: usize = 8;
/// Steps at a node where everything is decided and no positive angles were found.
const LEAF_STEPS: usize = 400;
/// Splits compared at a node, of these tried, and how often a side has to be seen before what it gained is relied
/// upon (reliability branching).
const CANDIDATES: usize = 12;
const TRIALS: usize = 5;
const RELIABLE: u32 = 2;
/// Gains of a bound count at least this much when splits are compared, so that one good side counts.
const LEAST_GAIN: f64 = 1e-6;
/// A side that is closed counts as if the bound had risen to the value to beat, if there is one, and to this at most.
const MOST_GAIN: f64 = 1e3;
/// What an iteration of the interior point costs, in evaluations of the bound.
const ITERATION: u64 = 8;

/// Work that may still be done, in visits of corners by the bound.
#[derive(Debug, Clone, Copy)]
pub(super) struct Work(pub(super) u64);

impl Work {
    fn spend(&mut self, visits: u64) {
        self.0 = self.0.saturating_sub(visits);
    }
}

/// Changes of the members' indices, and the best angles for them.
#[derive(Debug, Clone)]
pub(super) struct Choice {
    pub(super) change: Vec<i32>,
    /// Radians, per corner of the piece.
    pub(super) angles: Vec<f64>,
    pub(super) value: f64,
}

/// What a search came to.
pub(super) struct Searched {
    /// The best choice, if it is better than the one given.
    pub(super) better: Option<Choice>,
    /// No choice costs less; infinite if none has positive angles.
    pub(super) bound: f64,
}

/// Value above which a bound proves that nothing better is left.
pub(super) fn proven_above(value: f64) -> f64 {
    if value.is_finite() { value - PROOF * (1.0 + value.abs()) } else { value }
}

/// Looks for indices that cost less than `value` (infinite: for any), by branch and bound. It ends with a proof or when
/// the work is done.
///
/// A node's bound is that of [`ascend`], from its parent's prices or, if they are better, from the multipliers of the
/// program with real indices. Ranges are narrowed to the changes that the bound does not exclude. The split is the one
/// of a few whose sides raise the bound most. The search goes down by the better side and then on with the open node
/// of the least bound.
pub(super) fn search(
    piece: &Piece,
    norm: AngleNorm,
    value: f64,
    start: Vec<f64>,
    work: &mut Work,
    watch: &mut Watch<'_, '_>,
) -> Result<Searched, ConsistencyError> {
    let (exact, relaxed) = (piece.system(false)?, piece.system(true)?);
    let pricing = Pricing { piece, norm };
    let gains = vec![[(0.0, 0); 2]; piece.members.len()];
    let mut tree =
        Tree { pricing, exact, relaxed, value, better: None, unproven: f64::INFINITY, gains };
    let root = Node { ranges: piece.ranges(), prices: start, bound: 0.0, depth: 0, untried: None };
    let mut open = BinaryHeap::from([root]);
    'next: while let Some(mut node) = open.pop() {
        // Down by the better side until nothing is left of it.
        loop {
            watch.pulse()?;
            if node.bound >= proven_above(tree.value) {
                continue 'next;
            }
            if work.0 == 0 {
                open.push(node);
                break 'next;
            }
            match tree.visit(node, work, watch)? {
                Visited::Closed => continue 'next,
                Visited::Narrowed(same) => node = same,
                Visited::Split([worse, better]) => {
                    open.push(worse);
                    node = better;
                }
            }
        }
    }
    let left = open.iter().map(|node| node.bound).fold(tree.unproven, f64::min);
    let bound = left.min(proven_above(tree.value)).max(0.0);
    Ok(Searched { better: tree.better, bound })
}

/// Branch and bound on a piece.
struct Tree<'a> {
    pricing: Pricing<'a>,
    /// Systems for given indices and for real ones.
    exact: System,
    relaxed: System,
    /// Value to beat.
    value: f64,
    better: Option<Choice>,
    /// Least bound of nodes that were left without a proof.
    unproven: f64,
    /// What the splits of each member have gained, by side: sum and number.
    gains: Vec<[(f64, u32); 2]>,
}

/// Ranges of the changes, with prices to start from and what is known of the bound.
struct Node {
    ranges: Vec<(i32, i32)>,
    prices: Vec<f64>,
    bound: f64,
    depth: u32,
    /// The split it comes from, if that was not tried before: member and side.
    untried: Option<(usize, usize)>,
}

enum Visited {
    /// Nothing better is left in the node.
    Closed,
    /// Some of its ranges have become smaller.
    Narrowed(Node),
    /// Two nodes that share out its choices, the one with the larger bound first.
    Split([Node; 2]),
}

impl Tree<'_> {
    fn visit(
        &mut self,
        mut node: Node,
        work: &mut Work,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Visited, ConsistencyError> {
        if node.is_decided() {
            self.leaf(&node, work, watch)?;
            return Ok(Visited::Closed);
        }
        let steps = if node.depth == 0 { ROOT_STEPS } else { NODE_STEPS };
        match self.raise(&mut node, steps, work, watch)? {
            Some(mean) => self.split(node, &mean, work, watch),
            None => Ok(Visited::Closed),
        }
    }

    /// Of some splits, the one whose two sides raise the bound most together: those of members that were split often
    /// are judged by what that gained, a few others by trial.
    fn split(
        &mut self,
        node: Node,
        mean: &[f64],
        work: &mut Work,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Visited, ConsistencyError> {
        let mut best: Option<(f64, [Node; 2])> = None;
        let mut trials = 0;
        for (member, at) in waverers(&node.ranges, mean) {
            let mut sides = node.sides(member, at);
            if self.gains[member].iter().any(|&(_, count)| count < RELIABLE) {
                trials += 1;
                if trials > TRIALS {
                    continue;
                }
                for k in 0..2 {
                    if self.raise(&mut sides[k], TRIAL_STEPS, work, watch)?.is_none() {
                        // All that is left is on the other side.
                        let [below, above] = sides;
                        return Ok(Visited::Narrowed(if k == 0 { above } else { below }));
                    }
                }
            }
            let gains = self.gains[member].map(|(sum, count)| sum / f64::from(count));
            let score = gains.iter().map(|gain| gain.max(LEAST_GAIN)).product();
            // The side with the larger bound first; what was not tried goes by the mean.
            if sides[0].bound < sides[1].bound
                || (sides[0].bound == sides[1].bound && mean[member] < f64::from(at) + 0.5)
            {
                sides.swap(0, 1);
            }
            if best.as_ref().is_none_or(|(most, _)| score > *most) {
                best = Some((score, sides));
            }
        }
        Ok(match best {
            Some((_, sides)) => Visited::Split(sides),
            // All is decided now.
            None => Visited::Narrowed(node),
        })
    }

    /// Raises a node's bound and narrows its ranges: the mean of each member's change over the ascent, or none if
    /// nothing better is left in the node. By how much the bound rose is remembered of the split that it comes from.
    fn raise(
        &mut self,
        node: &mut Node,
        steps: usize,
        work: &mut Work,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Option<Vec<f64>>, ConsistencyError> {
        let Pricing { piece, norm } = self.pricing;
        let goal = proven_above(self.value);
        let before = node.bound;
        let mut open = piece.balance(&mut node.ranges).then(Vec::new);
        if open.is_some() && (node.depth == 0 || norm == AngleNorm::L1) {
            let solved = piece.relax(norm, &mut self.relaxed, &node.ranges, watch)?;
            work.spend(ITERATION * (solved.iterations * piece.given.len()) as u64);
            let found = prices(&solved.triangle, norm);
            let [old, new] =
                [&node.prices, &found].map(|p| self.pricing.best(p, &node.ranges).value);
            if new > old {
                node.prices = found;
            }
        }
        if open.is_some() {
            let ascent = ascend(&self.pricing, &node.ranges, &node.prices, self.value, steps);
            work.spend((ascent.steps * piece.given.len()) as u64);
            node.bound = node.bound.max(ascent.value);
            node.prices = ascent.prices;
            if node.bound < goal && goal.is_finite() {
                self.pricing.narrow(&node.prices, goal - ascent.value, &mut node.ranges);
            }
            let is_open = node.bound < goal && piece.balance(&mut node.ranges);
            open = is_open.then_some(ascent.mean);
        }
        if let Some((member, side)) = node.untried.take() {
            let after = if open.is_some() { node.bound } else { goal.min(MOST_GAIN) };
            let (sum, count) = &mut self.gains[member][side];
            (*sum, *count) = (*sum + after - before, *count + 1);
        }
        Ok(open)
    }

    /// A node at which all indices are decided.
    fn leaf(
        &mut self,
        node: &Node,
        work: &mut Work,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), ConsistencyError> {
        let Pricing { piece, norm } = self.pricing;
        let change: Vec<i32> = node.ranges.iter().map(|range| range.0).collect();
        let solved = piece.solve(norm, &mut self.exact, &change, watch)?;
        work.spend(ITERATION * (solved.iterations * piece.given.len()) as u64);
        if solved.converged {
            if solved.value < self.value {
                self.value = solved.value;
                self.better = Some(Choice { change, angles: solved.angles, value: solved.value });
            }
            return Ok(());
        }
        // There are no positive angles, or they were not found: the bound has to say so.
        let ascent = ascend(&self.pricing, &node.ranges, &node.prices, self.value, LEAF_STEPS);
        work.spend((ascent.steps * piece.given.len()) as u64);
        let bound = node.bound.max(ascent.value);
        if bound < proven_above(self.value) {
            self.unproven = self.unproven.min(bound);
        }
        Ok(())
    }
}

impl Node {
    fn is_decided(&self) -> bool {
        self.ranges.iter().all(|range| range.0 == range.1)
    }

    /// Both parts of a node: the index of a member at most at an integer, and above it.
    fn sides(&self, member: usize, at: i32) -> [Self; 2] {
        let (low, high) = self.ranges[member];
        [(0, (low, at)), (1, (at + 1, high))].map(|(side, range)| {
            let mut ranges = self.ranges.clone();
            ranges[member] = range;
            let (prices, untried) = (self.prices.clone(), Some((member, side)));
            Self { ranges, prices, bound: self.bound, depth: self.depth + 1, untried }
        })
    }
}

/// Nodes of small bounds come first, of equal ones the deepest; further ties are settled by the ranges.
impl Ord for Node {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_bound = other.bound.total_cmp(&self.bound);
        by_bound.then(self.depth.cmp(&other.depth)).then_with(|| self.ranges.cmp(&other.ranges))
    }
}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Node {}

/// Undecided members whose index is furthest from an integer on average, and the integers below; ties go to the first.
fn waverers(ranges: &[(i32, i32)], mean: &[f64]) -> Vec<(usize, i32)> {
    let mut all: Vec<(f64, usize, i32)> = Vec::new();
    for (m, (&(low, high), &mean)) in ranges.iter().zip(mean).enumerate() {
        if low < high {
            let at = (mean.floor() as i32).clamp(low, high - 1);
            all.push(((mean - mean.round()).abs(), m, at));
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    all.into_iter().take(CANDIDATES).map(|(_, m, at)| (m, at)).collect()
}
