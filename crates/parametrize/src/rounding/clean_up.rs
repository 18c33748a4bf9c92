//! Fewer and better placed cones, judged by the surrogate.

use super::reach::{Ball, BallSearch};
use super::surrogate::{Response, Surrogate};
use crate::cut::FramedCut;
use crate::features::{Road, Sectors};
use crate::field::Guide;
use crate::ordered::Ordered;
use crate::progress::{Cancelled, SolveError, Watch};
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, Vertex, VertexData};
use seamstress_parallel::both;
use seamstress_parallel::prelude::*;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::f64::consts::FRAC_PI_2;

/// What clean-up did.
#[derive(Debug, Clone, Copy, Default)]
pub struct CleanUpStats {
    /// Pairs of cones cancelled or merged.
    pub cancelled: usize,
    /// Moves of a cone to another vertex.
    pub moved: usize,
    /// The surrogate energy at the end.
    pub energy: f64,
    /// Interior cones fewer, as [`CleanUpOptions::count`] counts them.
    pub saved: i32,
}

/// How cones are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConeCount {
    /// Each once.
    Cones,
    /// Each by its quarters, `|k|`: a cone of two quarters is not preferred to two cones.
    Quarters,
}

impl ConeCount {
    fn of(self, excess: i32) -> i32 {
        match self {
            Self::Cones => i32::from(excess != 0),
            Self::Quarters => excess.abs(),
        }
    }
}

/// Settings of clean-up.
#[derive(Debug, Clone, Copy)]
pub struct CleanUpOptions {
    /// Mean symmetric Dirichlet energy that one cone fewer may cost.
    pub price: f64,
    /// How cones are counted.
    pub count: ConeCount,
    /// An index may differ from the curvature by less than this many quarters.
    pub largest_deviation: f64,
}

/// Rounds in which every cone may go once; the last ones hardly find anything.
const ROUNDS: usize = 12;
/// Cones looked at between two looks at the watch.
const LOOKS: usize = 32;
/// A cone reaches the area that this many have on average.
const REACH: f64 = 4.0;
/// Most cones that go at the same time, and the part of its profit that each must keep when those before it have gone.
const TOGETHER: usize = 4;
const STANDING: f64 = 0.5;
/// A unit of index turns the directions on one side of its way by a quarter. Where they count fully that costs so many prices
/// of a cone for a cell of the way.
const TENSION: f64 = 0.7;
/// A pair that cancels over fewer cells turns an area in place of a strip.
const STRIP_CELLS: f64 = 2.5;
/// Mean symmetric Dirichlet energy that a move has to gain: a part in 500 of the price of a cone, or cones walk to
/// and fro.
const MINIMUM_GAIN: f64 = 1e-6;

/// Cancels pairs of cones and moves cones while the surrogate energy grows by less than the price per cone removed; the
/// matchings change along the way.
///
/// With a guide the ways that cones take have a price too, since they turn its directions. Vertices held keep their cones as
/// they are, or none.
///
/// The surrogate tells exactly what a unit of index that goes from a cone to any sector around it changes. In every round
/// the cones go, the most profitable first, each where it gains most: onto an opposite cone, or to an empty sector. In
/// the first round cones only cancel.
///
/// # Errors
/// [`SolveError`].
pub fn clean_up(
    sectors: &Sectors<'_>,
    metric: &Metric,
    start: &FramedCut,
    guide: Option<&Guide>,
    held: &VertexData<bool>,
    options: &CleanUpOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(FramedCut, CleanUpStats), SolveError> {
    let index = start.matched.sector_indices(sectors, metric);
    let mut work = CleanUp::new(sectors, metric, index, guide, held, *options)?;
    let before = work.count();
    for some in work.cones().chunks(LOOKS) {
        watch.pulse()?;
        work.look_around(some);
    }
    let mut stats = CleanUpStats::default();
    for round in 0..ROUNDS {
        watch.tick(round as f64 / ROUNDS as f64)?;
        let (cancelled, moved) = work.round(round == 0, watch)?;
        stats.cancelled += cancelled;
        stats.moved += moved;
        if round > 0 && cancelled + moved == 0 {
            break;
        }
    }
    stats.saved = before - work.count();
    stats.energy = work.surrogate.energy();
    Ok((start.turned(sectors, &work.transport), stats))
}

struct CleanUp<'a> {
    sectors: &'a Sectors<'a>,
    metric: &'a Metric,
    surrogate: Surrogate<'a>,
    /// Index beyond the preferred one: what makes a cone or a false corner. Free sectors have none.
    excess: VertexData<i32>,
    /// The least and the largest excess that a sector may come to have; free and held ones none.
    range: VertexData<(i32, i32)>,
    options: CleanUpOptions,
    /// Net units sent across each edge, negated on twins.
    transport: HalfedgeData<i32>,
    search: BallSearch<'a>,
    /// Per edge what turning the directions beside it costs; none without a guide.
    tension: Option<HalfedgeData<f64>>,
    /// Where each cone may go.
    reach: HashMap<Vertex, Reach>,
}

/// A unit of the cone at `s` goes to `b`, which has this place in its reach.
struct Move {
    s: Vertex,
    b: Vertex,
    place: usize,
    profit: f64,
}

impl<'a> CleanUp<'a> {
    fn new(
        sectors: &'a Sectors<'a>,
        metric: &'a Metric,
        index: VertexData<i32>,
        guide: Option<&Guide>,
        held: &VertexData<bool>,
        options: CleanUpOptions,
    ) -> Result<Self, NotPositiveDefinite> {
        let slit = sectors.slit();
        let curvature = metric.curvature(slit);
        let range = |s: Vertex| {
            if sectors.is_free(s) || held[sectors.vertex(s)] {
                return (1, 0);
            }
            let (low, high) = sectors.bounds(s);
            let (curvature, most) = (curvature[s] / FRAC_PI_2, options.largest_deviation);
            let low = low.max((curvature - most).floor() as i32 + 1);
            let high = high.min((curvature + most).ceil() as i32 - 1);
            (low - sectors.preferred(s), high - sectors.preferred(s))
        };
        let excess = index.enumerate().map(|(s, index)| index - sectors.preferred(s));
        let excess: VertexData<i32> = excess.collect();
        let cones = excess.iter().filter(|&&excess| excess != 0).count();
        let part = REACH / cones.max(1) as f64;
        Ok(Self {
            surrogate: Surrogate::new(sectors, metric, &index)?,
            range: slit.vertices().map(range).collect(),
            transport: HalfedgeData::filled(sectors.slit().n_halfedges(), 0),
            search: BallSearch::new(sectors, metric, part),
            tension: guide.map(|guide| tension(sectors, metric, guide, options.price)),
            reach: HashMap::new(),
            sectors,
            metric,
            excess,
            options,
        })
    }

    /// Finds where some cones may go, and what they change.
    fn look_around(&mut self, cones: &[Vertex]) {
        let (surrogate, search) = (&self.surrogate, &mut self.search);
        let (responses, balls) = both(
            || surrogate.responses(cones),
            || cones.iter().map(|&s| search.around(s)).collect::<Vec<_>>(),
        );
        for ((&s, ball), response) in cones.iter().zip(balls).zip(responses) {
            self.reach.insert(s, Reach { ball, response });
        }
    }

    fn count(&self) -> i32 {
        self.excess.iter().map(|&excess| self.options.count.of(excess)).sum()
    }

    /// Sectors with another index than the preferred one.
    fn cones(&self) -> Vec<Vertex> {
        self.sectors.slit().vertices().filter(|&s| self.excess[s] != 0).collect()
    }

    fn allows(&self, s: Vertex, excess: i32) -> bool {
        let (low, high) = self.range[s];
        (low..=high).contains(&excess)
    }

    /// Most that sending a unit from a cone at `s` to `b` may add to the energy.
    fn budget(&self, s: Vertex, b: Vertex) -> f64 {
        let count = |k: i32| self.options.count.of(k);
        let (at_s, at_b) = (self.excess[s], self.excess[b]);
        let sign = at_s.signum();
        let removed = count(at_s) + count(at_b) - count(at_s - sign) - count(at_b + sign);
        self.options.price * f64::from(removed)
    }

    /// What it costs to turn the directions on one side of a road that a unit of the cone at `s` takes: less than nothing
    /// where units that went before are undone.
    fn toll(&self, s: Vertex, road: Road) -> f64 {
        let Some(tension) = &self.tension else { return 0.0 };
        let before = self.transport[road.halfedge];
        let after = before + self.excess[s].signum() * road.sign;
        f64::from(after.abs() - before.abs()) * tension[road.halfedge]
    }

    /// The part of the toll on a way that directions really cost.
    fn charge(&self, s: Vertex, b: Vertex, toll: f64) -> f64 {
        let cancels = self.excess[s].signum() * self.excess[b] < 0;
        let strip = TENSION * self.options.price * STRIP_CELLS;
        if cancels && toll > 0.0 { toll * (toll / strip).min(1.0) } else { toll }
    }

    /// What is gained when a unit of the cone at `s` goes to `b` for a toll.
    fn profit(&self, s: Vertex, b: Vertex, toll: f64) -> f64 {
        let sign = self.excess[s].signum();
        let change = self.surrogate.change(sign, [s, b], &self.reach[&s].response);
        self.budget(s, b) - change - self.charge(s, b, toll)
    }

    /// Whether a unit of the cone at `s` may go to `b`.
    fn may_go(&self, s: Vertex, b: Vertex) -> bool {
        let sign = self.excess[s].signum();
        sign != 0
            && self.excess[b] * sign <= 0
            && self.allows(s, self.excess[s] - sign)
            && self.allows(b, self.excess[b] + sign)
    }

    /// The best move of a cone.
    fn best(&self, s: Vertex, cancels_only: bool) -> Option<Move> {
        let sign = self.excess[s].signum();
        let ball = &self.reach.get(&s)?.ball;
        let tolls = ball.sums(|road| self.toll(s, road));
        let mut best = None;
        let mut least = MINIMUM_GAIN;
        for (place, (&b, toll)) in ball.sectors.iter().zip(tolls).enumerate().skip(1) {
            if cancels_only && self.excess[b] * sign >= 0 {
                continue;
            }
            let profit = self.profit(s, b, toll);
            if profit > least && self.may_go(s, b) {
                least = profit;
                best = Some(Move { s, b, place, profit });
            }
        }
        best
    }

    /// Sends a unit of a cone along a way; returns whether it meets another.
    fn send(&mut self, Move { s, b, place, .. }: Move) -> bool {
        let sign = self.excess[s].signum();
        let meets = self.excess[b] != 0;
        for road in self.reach[&s].ball.way_back(place) {
            self.transport[road.halfedge] += sign * road.sign;
            if let Some(t) = self.sectors.slit().twin(road.halfedge) {
                self.transport[t] -= sign * road.sign;
            }
        }
        self.excess[s] -= sign;
        self.excess[b] += sign;
        let [from, to] = if sign > 0 { [s, b] } else { [b, s] };
        self.surrogate.transport(&self.reach[&from].response, &self.reach[&to].response);
        meets
    }

    /// Every cone goes where it gains most, the best first, as long as any gains; how many cancel, and how many move.
    fn round(
        &mut self,
        cancels_only: bool,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(usize, usize), Cancelled> {
        let (mut cancelled, mut moved) = (0, 0);
        let cones = self.cones();
        let best: Vec<_> = cones.par_iter().map(|&s| self.best(s, cancels_only)).collect();
        let of = |best: Move| (Ordered(best.profit), Reverse(best.s), 0);
        let mut queue: BinaryHeap<_> = best.into_iter().flatten().map(of).collect();
        while !queue.is_empty() {
            watch.pulse()?;
            let sent = cancelled + moved;
            let mut moves: Vec<Move> = Vec::new();
            while moves.len() < TOGETHER {
                let Some((_, Reverse(s), judged)) = queue.pop() else { break };
                // What the others did since it was judged counts too.
                let Some(best) = self.best(s, cancels_only) else { continue };
                let next = queue.peek().map_or(0.0, |(Ordered(profit), ..)| *profit);
                if judged < sent && best.profit < next {
                    queue.push((Ordered(best.profit), Reverse(s), sent));
                } else {
                    moves.push(best);
                }
            }
            // The responses where they end, solved for together.
            let mut ends: Vec<Vertex> = moves.iter().map(|to| to.b).collect();
            ends.sort_unstable();
            ends.dedup();
            ends.retain(|b| !self.reach.contains_key(b));
            self.look_around(&ends);
            for to in moves {
                // What those before it did may have left little of its profit.
                let way = self.reach[&to.s].ball.way_back(to.place);
                let toll = way.map(|road| self.toll(to.s, road)).sum();
                let stands = self.profit(to.s, to.b, toll) > STANDING * to.profit;
                if !(stands && self.may_go(to.s, to.b)) {
                    queue.push((Ordered(STANDING * to.profit), Reverse(to.s), 0));
                } else if self.send(to) {
                    cancelled += 1;
                } else {
                    moved += 1;
                }
            }
        }
        let excess = &self.excess;
        self.reach.retain(|&s, _| excess[s] != 0);
        let index = self.excess.enumerate().map(|(s, excess)| excess + self.sectors.preferred(s));
        self.surrogate.refresh(self.metric, &index.collect());
        Ok((cancelled, moved))
    }
}

/// What turning the directions beside each edge by a quarter costs: see [`TENSION`].
fn tension(sectors: &Sectors<'_>, metric: &Metric, guide: &Guide, price: f64) -> HalfedgeData<f64> {
    let slit = sectors.slit();
    let unit = TENSION * price / guide.cell;
    let of = |h: Halfedge| {
        let [left, right] = [h, slit.twin(h).unwrap_or(h)].map(|h| guide.weight[h.face()]);
        unit * metric.length[h] * (left + right) / 2.0
    };
    slit.halfedges().map(of).collect()
}

/// What is known of a cone: where it may go, and what it changes.
struct Reach {
    ball: Ball,
    response: Response,
}
