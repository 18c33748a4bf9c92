//! New starts for quads that moves of single vertices do not open.

use super::{POWER, Phase, State, phases};
use crate::badness;
use crate::quality::Orientation;
use crate::vector::{Point, add, scale};
use seamstress_parallel::prelude::*;
use std::collections::BTreeSet;

/// Where quads that nothing else helped start over.
struct Reach {
    /// Vertices within so many rings of such a quad are put elsewhere.
    rings: usize,
    /// The quads around a vertex may then stray so far, as a part of the mean edge.
    stray: f64,
    /// Only for quads that are worse than this.
    worse_than: Condition,
}

const REACHES: [Reach; 4] = [
    Reach { rings: 1, stray: 0.4, worse_than: Condition::Convex },
    Reach { rings: 2, stray: 1.0, worse_than: Condition::Reflex },
    Reach { rings: 3, stray: 2.0, worse_than: Condition::Reflex },
    Reach { rings: 4, stray: 4.0, worse_than: Condition::Reflex },
];
/// Rounds of spreading.
const SPREADINGS: usize = 20;
/// Scattered starts after a spread one, for each quad.
const SCATTERED: usize = 32;
/// The same for all quads within a reach, and most quads that start over.
const MOST_SCATTERED: usize = 640;

/// How a quad lies on the surface, the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Condition {
    /// Inverted or crossed, or would be.
    Faulty,
    /// With a reflex corner, in space or seen along the surface's normals.
    Reflex,
    Convex,
}

/// Where the vertices around a quad that nothing else helped are put before they are mended anew.
#[derive(Debug, Clone, Copy)]
enum Start {
    /// Each at the mean of its neighbours, again and again.
    Spread,
    /// Each by up to a mean edge along every axis, by this seed.
    Scattered(u64),
}

impl State<'_> {
    /// Puts the vertices around quads that are stuck elsewhere, and mends what comes of it.
    ///
    /// They are spread evenly, or scattered with one seed after the other, until a start leads to convex quads
    /// only; else the best is kept that leaves fewer faults than there were, if any.
    pub(super) fn restart(&mut self, rounds: u32) {
        for reach in REACHES {
            let stuck = self.worse_than(reach.worse_than);
            let n_scattered = SCATTERED.min(MOST_SCATTERED / stuck.len().max(1));
            for quad in stuck.into_iter().take(MOST_SCATTERED) {
                self.start_over(quad, n_scattered, &reach, rounds);
            }
        }
    }

    fn worse_than(&self, condition: Condition) -> Vec<u32> {
        let is_stuck = |&q: &u32| self.condition(q) < condition;
        (0..self.quads.len() as u32).into_par_iter().filter(is_stuck).collect()
    }

    fn condition(&self, quad: u32) -> Condition {
        let corners = self.quads[quad as usize];
        let points = corners.map(|v| self.positions[v as usize]);
        let normals = corners.map(|v| self.normals[v as usize]);
        if Orientation::of_polygon(&points, &normals).faults() > 0 {
            Condition::Faulty
        } else if badness::on_surface(points, normals).iter().any(|&bad| bad > 1.0) {
            Condition::Reflex
        } else {
            Condition::Convex
        }
    }

    fn start_over(&mut self, quad: u32, n_scattered: usize, reach: &Reach, rounds: u32) {
        if self.condition(quad) >= reach.worse_than {
            return;
        }
        let mut region: BTreeSet<u32> = self.quads[quad as usize].into_iter().collect();
        for _ in 0..reach.rings {
            let around = region.iter().flat_map(|&v| self.quads_around(v).flatten());
            region = region.iter().copied().chain(around.collect::<Vec<_>>()).collect();
        }
        region.retain(|&v| !self.domain.is_fixed(v));
        let quads: BTreeSet<u32> =
            region.iter().flat_map(|&v| self.connectivity.outgoing(v).map(|h| h / 4)).collect();
        let anywhere = Phase { stray: reach.stray, least_cosine: -1.0, ..phases(self.bound)[1] };
        let before = self.places(&region);
        let (faulty, reflex, _) = self.badness(&quads);
        // As many faults are never better.
        let mut best = ((faulty, reflex, f64::NEG_INFINITY), None);
        let scattered = (0..n_scattered as u64).map(Start::Scattered);
        for start in std::iter::once(Start::Spread).chain(scattered) {
            self.begin(start, &region, reach.stray);
            self.run(&anywhere, &region, rounds);
            let badness = self.badness(&quads);
            if badness < best.0 {
                best = (badness, Some(self.places(&region)));
            }
            self.put_back(&region, &before);
            if matches!(best.0, (0, 0, _)) {
                break;
            }
        }
        if let (_, Some(places)) = best {
            self.put_back(&region, &places);
        }
    }

    /// The numbers of faulty and of reflex quads among some, and the badness of all their corners.
    fn badness(&self, quads: &BTreeSet<u32>) -> (usize, usize, f64) {
        let number = |of: Condition| quads.iter().filter(|&&q| self.condition(q) == of).count();
        let of_quad = |&q: &u32| {
            let corners = self.quads[q as usize];
            let points = corners.map(|v| self.positions[v as usize]);
            badness::on_surface(points, corners.map(|v| self.normals[v as usize]))
        };
        let sum = quads.iter().flat_map(of_quad).map(|bad| bad.powi(POWER)).sum();
        (number(Condition::Faulty), number(Condition::Reflex), sum)
    }

    /// Where vertices are, with the normals there.
    fn places(&self, region: &BTreeSet<u32>) -> Vec<(Point, Point)> {
        region.iter().map(|&v| (self.positions[v as usize], self.normals[v as usize])).collect()
    }

    fn put_back(&mut self, region: &BTreeSet<u32>, places: &[(Point, Point)]) {
        for (&v, &place) in region.iter().zip(places) {
            (self.positions[v as usize], self.normals[v as usize]) = place;
        }
    }

    /// Puts the vertices of a region elsewhere.
    fn begin(&mut self, start: Start, region: &BTreeSet<u32>, stray: f64) {
        match start {
            Start::Spread => {
                for _ in 0..SPREADINGS {
                    region.iter().for_each(|&v| self.put(v, self.mean_of_neighbours(v), stray));
                }
            }
            Start::Scattered(seed) => {
                let mut random = fastrand::Rng::with_seed(seed);
                for &v in region {
                    let length = self.mean_edge(v);
                    let by = [0; 3].map(|_| length * (2.0 * random.f64() - 1.0));
                    self.put(v, add(self.positions[v as usize], by), stray);
                }
            }
        }
    }

    /// Puts a vertex at the point nearest to a target, of those where it may be, unless it would stray too far there.
    fn put(&mut self, v: u32, target: Point, stray: f64) {
        let at = self.domain.nearest(v, target);
        if self.stray(v, at) <= stray * self.mean_edge(v) {
            (self.positions[v as usize], self.normals[v as usize]) = (at, self.domain.normal(at));
        }
    }

    fn mean_of_neighbours(&self, v: u32) -> Point {
        let neighbours = self.connectivity.neighbours(v).map(|w| self.positions[w as usize]);
        let (sum, n) = neighbours.fold(([0.0; 3], 0.0), |(sum, n), p| (add(sum, p), n + 1.0));
        scale(sum, 1.0 / n)
    }
}
