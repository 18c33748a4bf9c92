//! Fewer and better placed cones, judged by the surrogate.

use super::surrogate::{Response, Surrogate};
use crate::cut::FramedCut;
use crate::features::{Road, Sectors};
use crate::ordered::Ordered;
use crate::progress::{Cancelled, SolveError, Watch};
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{HalfedgeData, Metric, Vertex, VertexData};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, HashMap};
use std::f64::consts::FRAC_PI_2;

/// What clean-up did.
#[derive(Debug, Clone, Copy, Default)]
pub struct CleanUpStats {
    /// Pairs of cones cancelled or merged.
    pub cancelled: usize,
    /// Moves of a cone to a neighbouring vertex.
    pub moved: usize,
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
    /// The log scale at a cone may reach this, or what it was, but not more.
    pub largest_scale: f64,
    /// An index may differ from the curvature by less than this many quarters.
    pub largest_deviation: f64,
}

/// Sweeps of cancellations and moves; the last ones hardly find anything.
const SWEEPS: usize = 6;
/// Opposite cones tried for each positive one: a farther one costs more, whatever lies between.
const PARTNERS: usize = 4;
/// Vertices searched for partners, which bounds the work where there are few.
const SEARCH_LIMIT: usize = 4000;
/// Passes of moves in one sweep: cones walk edge by edge, and cancelling them ends the walk.
const MOVES: usize = 3;
/// Mean symmetric Dirichlet energy that a move has to gain: a thousandth of the price of a cone, or cones walk to and
/// fro.
const MINIMUM_GAIN: f64 = 1e-6;

/// Cancels pairs of cones and moves cones along edges while the surrogate energy grows by less than
/// the price per cone removed; the matchings change along the way.
///
/// # Errors
/// [`SolveError`].
pub fn clean_up(
    sectors: &Sectors<'_>,
    metric: &Metric,
    start: &FramedCut,
    options: &CleanUpOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(FramedCut, CleanUpStats), SolveError> {
    let index = start.matched.sector_indices(sectors, metric);
    let mut work = CleanUp::new(sectors, metric, index, *options)?;
    let before = work.count();
    let mut stats = CleanUpStats::default();
    for sweep in 0..SWEEPS {
        watch.tick(sweep as f64 / SWEEPS as f64)?;
        let (cancelled, moved) = (work.cancel(watch)?, work.move_cones(watch)?);
        stats.cancelled += cancelled;
        stats.moved += moved;
        if cancelled + moved == 0 {
            break;
        }
    }
    stats.saved = before - work.count();
    Ok((start.turned(sectors, &work.transport), stats))
}

struct CleanUp<'a> {
    sectors: &'a Sectors<'a>,
    metric: &'a Metric,
    surrogate: Surrogate<'a>,
    index: VertexData<i32>,
    curvature: VertexData<f64>,
    options: CleanUpOptions,
    /// Net units sent across each edge, negated on twins.
    transport: HalfedgeData<i32>,
    /// Responses found so far, for ascending pairs.
    responses: HashMap<(Vertex, Vertex), Response>,
}

impl<'a> CleanUp<'a> {
    fn new(
        sectors: &'a Sectors<'a>,
        metric: &'a Metric,
        index: VertexData<i32>,
        options: CleanUpOptions,
    ) -> Result<Self, NotPositiveDefinite> {
        Ok(Self {
            surrogate: Surrogate::new(sectors, metric, &index)?,
            curvature: metric.curvature(sectors.slit()).iter().map(|k| k / FRAC_PI_2).collect(),
            transport: HalfedgeData::filled(sectors.slit().n_halfedges(), 0),
            responses: HashMap::new(),
            sectors,
            metric,
            index,
            options,
        })
    }

    fn count(&self) -> i32 {
        self.cones().into_iter().map(|s| self.options.count.of(self.excess(s))).sum()
    }

    /// Index beyond the preferred one: what makes a cone or a false corner. Free sectors have none.
    fn excess(&self, s: Vertex) -> i32 {
        self.index[s] - self.sectors.preferred(s)
    }

    /// Sectors with another index than the preferred one.
    fn cones(&self) -> Vec<Vertex> {
        self.sectors.slit().vertices().filter(|&s| self.excess(s) != 0).collect()
    }

    fn allows(&self, v: Vertex, index: i32) -> bool {
        let (low, high) = self.sectors.bounds(v);
        let deviation = (f64::from(index) - self.curvature[v]).abs();
        (low..=high).contains(&index) && deviation < self.options.largest_deviation
    }

    /// Cones fewer after sending a unit from one vertex to another.
    fn removed(&self, from: Vertex, to: Vertex) -> i32 {
        let count = |k: i32| self.options.count.of(k);
        let (from, to) = (self.excess(from), self.excess(to));
        count(from) + count(to) - count(from - 1) - count(to + 1)
    }

    /// Most that sending a unit may add to the energy.
    fn budget(&self, from: Vertex, to: Vertex) -> f64 {
        self.options.price * f64::from(self.removed(from, to))
    }

    /// Finds the responses of the pairs whose first-order term leaves a chance.
    fn prepare(&mut self, pairs: &[(Vertex, Vertex)]) {
        let mut missing: Vec<(Vertex, Vertex)> = pairs
            .iter()
            .copied()
            .filter(|&(a, b)| self.surrogate.linear(a, b) < self.budget(a, b))
            .map(|(a, b)| (a.min(b), a.max(b)))
            .filter(|pair| !self.responses.contains_key(pair))
            .collect();
        missing.sort_unstable();
        missing.dedup();
        let values = self.surrogate.responses(&missing);
        self.responses.extend(missing.into_iter().zip(values));
    }

    /// Change of the energy; infinity for a pair that had no chance when it was prepared, or that would
    /// stretch the surface at its ends too much.
    fn change(&self, from: Vertex, to: Vertex) -> f64 {
        let Some(response) = self.responses.get(&(from.min(to), from.max(to))) else {
            return f64::INFINITY;
        };
        let [low, high] = response.scale;
        let (at_from, at_to) = if from < to { (low, high) } else { (-high, -low) };
        let now = [self.surrogate.scale(from), self.surrogate.scale(to)];
        let largest = |u: [f64; 2]| u[0].abs().max(u[1].abs());
        if largest([now[0] + at_from, now[1] + at_to])
            > largest(now).max(self.options.largest_scale)
        {
            return f64::INFINITY;
        }
        self.surrogate.linear(from, to) + response.quadratic
    }

    fn send(&mut self, from: Vertex, to: Vertex, path: &[Road]) {
        for road in path {
            self.transport[road.halfedge] += road.sign;
            if let Some(t) = self.sectors.slit().twin(road.halfedge) {
                self.transport[t] -= road.sign;
            }
        }
        self.index[from] -= 1;
        self.index[to] += 1;
        self.surrogate.transport(from, to);
    }

    /// One sweep of cancellations, best first.
    fn cancel(&mut self, watch: &mut Watch<'_, '_>) -> Result<usize, Cancelled> {
        let mut pairs = BTreeMap::new();
        for from in self.cones().into_iter().filter(|&v| self.excess(v) > 0) {
            for (to, path) in self.near_negative(from) {
                pairs.insert((from, to), path);
            }
        }
        let keys: Vec<_> = pairs.keys().copied().collect();
        self.prepare(&keys);
        let mut order: Vec<(f64, Vertex, Vertex)> =
            keys.into_iter().map(|(a, b)| (self.change(a, b), a, b)).collect();
        order.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
        let mut count = 0;
        for (_, from, to) in order {
            watch.pulse()?;
            let fits =
                self.allows(from, self.index[from] - 1) && self.allows(to, self.index[to] + 1);
            let opposite = self.excess(from) > 0 && self.excess(to) < 0;
            if fits && opposite && self.change(from, to) < self.budget(from, to) {
                self.send(from, to, &pairs[&(from, to)]);
                count += 1;
            }
        }
        Ok(count)
    }

    /// Negative cones near a positive one, with shortest paths to them.
    fn near_negative(&self, start: Vertex) -> Vec<(Vertex, Vec<Road>)> {
        // Distance, and the road taken from which sector.
        type Reached = HashMap<Vertex, (f64, Option<(Vertex, Road)>)>;
        let mut reached = Reached::from([(start, (0.0, None))]);
        let mut queue = BinaryHeap::from([Reverse((Ordered(0.0), start))]);
        let (mut found, mut visited) = (Vec::new(), 0);
        let trace = |reached: &Reached, mut s: Vertex| {
            let mut path = Vec::new();
            while let Some((from, road)) = reached[&s].1 {
                path.push(road);
                s = from;
            }
            path
        };
        while let Some(Reverse((Ordered(d), s))) = queue.pop() {
            if d > reached[&s].0 {
                continue;
            }
            visited += 1;
            if self.excess(s) < 0 {
                found.push((s, trace(&reached, s)));
            }
            if found.len() == PARTNERS || visited > SEARCH_LIMIT {
                break;
            }
            for road in self.sectors.roads(s) {
                let reach = d + self.metric.length[road.halfedge];
                if reached.get(&road.to).is_none_or(|r| reach < r.0) {
                    reached.insert(road.to, (reach, Some((s, road))));
                    queue.push(Reverse((Ordered(reach), road.to)));
                }
            }
        }
        found
    }

    /// A few passes in which every cone may move to a neighbour once.
    fn move_cones(&mut self, watch: &mut Watch<'_, '_>) -> Result<usize, Cancelled> {
        let mut total = 0;
        for _ in 0..MOVES {
            // Most steps stay the best ones until their turn comes: find their responses together.
            let steps: Vec<_> = self.cones().into_iter().flat_map(|v| self.steps(v)).collect();
            self.prepare(&steps.iter().map(|&(a, b, _)| (a, b)).collect::<Vec<_>>());
            let mut count = 0;
            for v in self.cones() {
                watch.pulse()?;
                let Some(&(from, to, road)) = self.steps(v).first() else {
                    continue;
                };
                self.prepare(&[(from, to)]);
                if self.change(from, to) < self.budget(from, to) - MINIMUM_GAIN {
                    self.send(from, to, &[road]);
                    count += 1;
                }
            }
            total += count;
            if count == 0 {
                break;
            }
        }
        Ok(total)
    }

    /// The two most promising ways to move one unit of a cone to a neighbour, as (from, to, road).
    fn steps(&self, s: Vertex) -> Vec<(Vertex, Vertex, Road)> {
        let sign = self.excess(s).signum();
        let promise = |step: &(Vertex, Vertex, Road)| {
            self.surrogate.linear(step.0, step.1) - self.budget(step.0, step.1)
        };
        let mut steps: Vec<_> = self
            .sectors
            .roads(s)
            .filter(|road| {
                !self.sectors.is_free(road.to)
                    && self.excess(road.to) * sign <= 0
                    && self.allows(road.to, self.index[road.to] + sign)
                    && self.allows(s, self.index[s] - sign)
            })
            .map(
                |road| if sign > 0 { (s, road.to, road) } else { (road.to, s, self.back(s, road)) },
            )
            .collect();
        steps.sort_by(|x, y| {
            let halfedges = x.2.halfedge.cmp(&y.2.halfedge);
            promise(x).total_cmp(&promise(y)).then(halfedges)
        });
        steps.truncate(2);
        steps
    }

    /// The road from the far end of one that leaves a sector back to it.
    fn back(&self, s: Vertex, road: Road) -> Road {
        match self.sectors.slit().twin(road.halfedge) {
            Some(t) => Road { to: s, halfedge: t, sign: road.sign },
            None => Road { to: s, halfedge: road.halfedge, sign: -road.sign },
        }
    }
}
