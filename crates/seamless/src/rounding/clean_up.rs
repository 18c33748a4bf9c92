//! Fewer and better placed cones, judged by the surrogate.

use super::matched::MatchedCut;
use super::repair::index_bounds;
use super::surrogate::{Response, Surrogate};
use crate::cut::Ordered;
use crate::layout::space::regauge;
use crate::progress::{Cancelled, Watch};
use seamstress_numerics::NotPositiveDefinite;
use seamstress_surface::{FaceData, Halfedge, HalfedgeData, Metric, TriMesh, Vertex, VertexData};
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
    /// Interior cones before.
    pub cones_before: usize,
    /// Interior cones after.
    pub cones_after: usize,
}

/// Settings of clean-up.
#[derive(Debug, Clone, Copy)]
pub struct CleanUpOptions {
    /// Mean symmetric Dirichlet energy that one cone fewer may cost.
    pub price: f64,
    /// The log scale at a cone may reach this, or what it was, but not more.
    pub largest_scale: f64,
}

/// Why clean-up stopped early.
#[derive(Debug, thiserror::Error)]
pub enum CleanUpError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The surrogate could not be set up.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
}

const SWEEPS: usize = 6;
/// Opposite cones tried for each positive one.
const PARTNERS: usize = 4;
/// Vertices searched for partners.
const SEARCH_LIMIT: usize = 4000;
/// Passes of moves in one sweep.
const MOVES: usize = 3;
/// A move has to gain this much.
const LEAST_GAIN: f64 = 1e-6;
/// An index may differ from the curvature by less than this many quarters.
const LARGEST_DEVIATION: f64 = 1.5;

/// Cancels pairs of cones and moves cones along edges while the surrogate energy grows by less than
/// the price per cone removed; changes the matchings along the way. Returns also the quarter turns
/// by which the faces' gauge changed.
pub fn clean_up(
    mesh: &TriMesh,
    metric: &Metric,
    matched: &mut MatchedCut,
    options: &CleanUpOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(CleanUpStats, FaceData<i32>), CleanUpError> {
    let index = matched.cone_indices(mesh, metric);
    let mut work = CleanUp::new(mesh, metric, index, *options)?;
    let mut stats = CleanUpStats { cones_before: work.n_cones(), ..Default::default() };
    for sweep in 0..SWEEPS {
        watch.tick(sweep as f64 / SWEEPS as f64)?;
        let (cancelled, moved) = (work.cancel(watch)?, work.move_cones(watch)?);
        stats.cancelled += cancelled;
        stats.moved += moved;
        if cancelled + moved == 0 {
            break;
        }
    }
    stats.cones_after = work.n_cones();
    let gauge = apply(mesh, matched, &work.transport);
    Ok((stats, gauge))
}

/// Adds units of flow to the matchings and returns to the gauge of the cut's tree.
fn apply(mesh: &TriMesh, matched: &mut MatchedCut, transport: &HalfedgeData<i32>) -> FaceData<i32> {
    let mut full = matched.matching_per_halfedge(mesh);
    for h in mesh.halfedges() {
        full[h] += transport[h];
    }
    let (moved, gauge) = regauge(mesh, &matched.tree, &full);
    for (r, &h) in matched.matching.iter_mut().zip(&matched.cut.seams) {
        *r = moved[h];
    }
    gauge
}

struct CleanUp<'a> {
    mesh: &'a TriMesh,
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
        mesh: &'a TriMesh,
        metric: &'a Metric,
        index: VertexData<i32>,
        options: CleanUpOptions,
    ) -> Result<Self, NotPositiveDefinite> {
        Ok(Self {
            surrogate: Surrogate::new(mesh, metric, &index)?,
            curvature: metric.curvature(mesh).iter().map(|k| k / FRAC_PI_2).collect(),
            transport: HalfedgeData::filled(mesh.n_halfedges(), 0),
            responses: HashMap::new(),
            mesh,
            metric,
            index,
            options,
        })
    }

    fn n_cones(&self) -> usize {
        self.index.iter().filter(|&&k| k != 0).count()
    }

    fn cones(&self) -> Vec<Vertex> {
        self.mesh.vertices().filter(|&v| self.index[v] != 0).collect()
    }

    fn allows(&self, v: Vertex, index: i32) -> bool {
        let (low, high) = index_bounds(self.mesh.valence(v));
        let deviation = (f64::from(index) - self.curvature[v]).abs();
        (low..=high).contains(&index) && deviation < LARGEST_DEVIATION
    }

    /// Cones fewer after sending a unit from one vertex to another.
    fn removed(&self, from: Vertex, to: Vertex) -> i32 {
        let count = |k: i32| i32::from(k != 0);
        count(self.index[from]) + count(self.index[to])
            - count(self.index[from] - 1)
            - count(self.index[to] + 1)
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

    fn send(&mut self, from: Vertex, to: Vertex, path: &[Halfedge]) {
        for &h in path {
            self.transport[h] += 1;
            if let Some(t) = self.mesh.twin(h) {
                self.transport[t] -= 1;
            }
        }
        self.index[from] -= 1;
        self.index[to] += 1;
        self.surrogate.transport(from, to);
    }

    /// One sweep of cancellations, best first.
    fn cancel(&mut self, watch: &mut Watch<'_, '_>) -> Result<usize, Cancelled> {
        let mut pairs = BTreeMap::new();
        for from in self.cones().into_iter().filter(|&v| self.index[v] > 0) {
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
            let opposite = self.index[from] > 0 && self.index[to] < 0;
            if fits && opposite && self.change(from, to) < self.budget(from, to) {
                self.send(from, to, &pairs[&(from, to)]);
                count += 1;
            }
        }
        Ok(count)
    }

    /// Negative cones near a positive one, with shortest paths to them.
    fn near_negative(&self, start: Vertex) -> Vec<(Vertex, Vec<Halfedge>)> {
        let mut reached: HashMap<Vertex, (f64, Option<Halfedge>)> =
            HashMap::from([(start, (0.0, None))]);
        let mut queue = BinaryHeap::from([Reverse((Ordered(0.0), start))]);
        let (mut found, mut visited) = (Vec::new(), 0);
        while let Some(Reverse((Ordered(d), v))) = queue.pop() {
            if d > reached[&v].0 {
                continue;
            }
            visited += 1;
            if self.index[v] < 0 {
                found.push((v, self.trace(&reached, v)));
            }
            if found.len() == PARTNERS || visited > SEARCH_LIMIT {
                break;
            }
            for h in self.mesh.outgoing(v).filter(|&h| self.mesh.twin(h).is_some()) {
                let (w, reach) = (self.mesh.tip(h), d + self.metric.length[h]);
                if reached.get(&w).is_none_or(|r| reach < r.0) {
                    reached.insert(w, (reach, Some(h)));
                    queue.push(Reverse((Ordered(reach), w)));
                }
            }
        }
        found
    }

    fn trace(
        &self,
        reached: &HashMap<Vertex, (f64, Option<Halfedge>)>,
        mut v: Vertex,
    ) -> Vec<Halfedge> {
        let mut path = Vec::new();
        while let Some(h) = reached[&v].1 {
            path.push(h);
            v = self.mesh.origin(h);
        }
        path
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
                let Some(&(from, to, h)) = self.steps(v).first() else {
                    continue;
                };
                self.prepare(&[(from, to)]);
                if self.change(from, to) < self.budget(from, to) - LEAST_GAIN {
                    self.send(from, to, &[h]);
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

    /// The two most promising ways to move one unit of a cone to a neighbour, as (from, to, path).
    fn steps(&self, v: Vertex) -> Vec<(Vertex, Vertex, Halfedge)> {
        let sign = self.index[v].signum();
        let promise = |s: &(Vertex, Vertex, Halfedge)| {
            self.surrogate.linear(s.0, s.1) - self.budget(s.0, s.1)
        };
        let mut steps: Vec<_> = self
            .mesh
            .outgoing(v)
            .filter_map(|h| Some((h, self.mesh.twin(h)?)))
            .filter(|&(h, _)| {
                let w = self.mesh.tip(h);
                !self.mesh.is_boundary(w)
                    && self.index[w] * sign <= 0
                    && self.allows(w, self.index[w] + sign)
                    && self.allows(v, self.index[v] - sign)
            })
            .map(|(h, t)| {
                let w = self.mesh.tip(h);
                if sign > 0 { (v, w, h) } else { (w, v, t) }
            })
            .collect();
        steps.sort_by(|x, y| promise(x).total_cmp(&promise(y)).then(x.2.cmp(&y.2)));
        steps.truncate(2);
        steps
    }
}
