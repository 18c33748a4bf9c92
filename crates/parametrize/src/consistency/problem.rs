//! Indices and angles of problem (14).

use super::descent::{Descent, Effort, Valley};
use super::error::ConsistencyError;
use super::groups::{FREE, Groups};
use super::input::{AngleNorm, ConsistencyOptions, ConsistencyStats};
use super::landscape::{Bounded, Unbounded, targets};
use super::piece::Whole;
use super::program::{Program, Solved};
use super::refine::{Refined, Search, State};
use super::resistance::Resistances;
use super::system::System;
use crate::progress::Watch;
use seamstress_linalg::NotPositiveDefinite;

/// Angles that need no bound are larger than this, radians.
const SURELY_POSITIVE: f64 = 1e-9;
const FREELY: Effort = Effort { thorough: true, trials: 4000 };
/// Each trial with bounds costs a quadratic program.
const BOUNDED: Effort = Effort { thorough: false, trials: 40 };
/// Slack of the angle sums where it is not known whether they can be met, radians per radian: a sum
/// that is off by a hundredth costs as much as a corner that is off by a third of a radian.
const SLACK: f64 = 1e-3;
/// A vertex whose angle sum is off by more than this has no positive angles, radians.
const OFF: f64 = 0.01;
/// Problem (14) with groups for vertices.
pub(super) struct Problem<'a> {
    groups: &'a Groups,
    pub(super) system: System,
    /// For the programs with positive angles, whose weights differ.
    bounded: System,
    angles: &'a [f64],
    /// Triangles of each component of the mesh.
    components: &'a [Vec<u32>],
    stats: ConsistencyStats,
}

impl<'a> Problem<'a> {
    pub(super) fn new(
        groups: &'a Groups,
        system: System,
        angles: &'a [f64],
        components: &'a [Vec<u32>],
    ) -> Result<Self, NotPositiveDefinite> {
        let bounded = system.twin()?;
        let stats = ConsistencyStats::default();
        Ok(Self { groups, system, bounded, angles, components, stats })
    }

    pub(super) fn stats(&self) -> ConsistencyStats {
        self.stats
    }

    /// Changes of indices, angles, and a bound on the objective.
    pub(super) fn solve(
        &mut self,
        options: &ConsistencyOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Refined, ConsistencyError> {
        let found = match options.norm {
            AngleNorm::L2 => self.nearest(options, watch),
            AngleNorm::L1 => self.sparsest(options, watch),
        };
        let whole = Whole::new(self.groups, &self.system, self.angles);
        let search = Search { whole: &whole, graph: &self.system.graph, norm: options.norm };
        match found {
            Ok(Found { change, angles, triangle, .. }) => {
                let known = Some((State { change, angles }, &triangle[..]));
                let found = search.refine(self.components, known, options.work, watch)?;
                found.ok_or(ConsistencyError::Infeasible { vertices: Vec::new() })
            }
            Err(ConsistencyError::Infeasible { vertices }) => {
                let found = search.refine(self.components, None, options.work, watch)?;
                found.ok_or(ConsistencyError::Infeasible { vertices })
            }
            Err(error) => Err(error),
        }
    }

    /// Least squares: descent without bounds, then with them if some angle came out negative.
    fn nearest(
        &mut self,
        options: &ConsistencyOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Found, ConsistencyError> {
        self.system.factorize(&vec![1.0; self.angles.len()], 0.0)?;
        let resistances = Resistances::new(&self.system, self.groups, options.column_memory);
        let (groups, system) = (self.groups, &self.system);
        let change = vec![0; groups.len()];
        let mut search =
            Descent { groups, system, resistances, change, batches: 0, impossible_units: 0 };
        let mut plain = Unbounded::new(groups, system, self.angles);
        search.enter_bounds(&mut plain, watch)?;
        let start = search.change.clone();
        let valley = search.descend(&mut plain, FREELY, watch)?;
        let (mut angles, mut triangle) = plain.angles(&valley.potential, self.angles);
        if angles.iter().any(|&a| a < SURELY_POSITIVE) {
            let (system, stats) = (&mut self.bounded, &mut self.stats);
            let mut landscape =
                Bounded { groups, system, angles: self.angles, slack: SLACK, stats };
            let valley = search.descend(&mut landscape, BOUNDED, watch)?;
            landscape.slack = 0.0;
            let solved = landscape.solve(&search.change, watch)?;
            if !solved.converged {
                return Err(infeasible(groups, &valley));
            }
            (angles, triangle) = (solved.angles, solved.triangle);
        }
        self.stats.impossible_units += search.impossible_units;
        self.stats.batches += search.batches;
        self.stats.columns += search.resistances.solved;
        Ok(Found { start, change: search.change, angles, triangle })
    }

    /// Least absolute changes: the better of the indices nearest in the l2 norm and of those brought into their
    /// bounds only, each with its best angles.
    fn sparsest(
        &mut self,
        options: &ConsistencyOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Found, ConsistencyError> {
        let mut found = self.nearest(options, watch)?;
        let changes = found.angles.iter().zip(self.angles);
        let mut best = changes.map(|(a, b)| options.norm.cost(a - b)).sum();
        for change in [found.change.clone(), found.start.clone()] {
            let program = Program::new(self.angles, options.norm, targets(self.groups, &change));
            let Solved { angles, triangle, value, iterations, converged, .. } =
                program.solve(&mut self.bounded, watch)?;
            self.stats.programs += 1;
            self.stats.interior_point_iterations += iterations;
            if converged && value <= best {
                best = value;
                found = Found { change, angles, triangle, ..found };
            }
        }
        Ok(found)
    }
}

/// What a descent found.
struct Found {
    /// The indices it started from, brought into their bounds.
    start: Vec<i32>,
    change: Vec<i32>,
    angles: Vec<f64>,
    /// Multiplier per triangle.
    triangle: Vec<f64>,
}

/// Vertices whose angle sums could not be met.
fn infeasible(groups: &Groups, valley: &Valley) -> ConsistencyError {
    let off = |g: u32| g != FREE && (SLACK * valley.potential[g as usize]).abs() > OFF;
    let vertices = groups.of.enumerate().filter(|&(_, &g)| off(g)).map(|(v, _)| v.0).collect();
    ConsistencyError::Infeasible { vertices }
}
