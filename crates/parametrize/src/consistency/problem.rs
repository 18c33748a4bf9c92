//! Indices and angles of problem (14).

use super::descent::{Effort, Search, Valley};
use super::error::ConsistencyError;
use super::groups::{FREE, Groups};
use super::input::{AngleNorm, ConsistencyOptions, ConsistencyStats};
use super::landscape::{Bounded, Programs, Unbounded};
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
/// Changes of angles below this count as none in reweighting for the l1 norm, radians: at first, at
/// last, and the factor between rounds.
const FIRST_EDGE: f64 = 0.1;
const LAST_EDGE: f64 = 1e-5;
const SHARPER: f64 = 0.3;

/// Problem (14) with groups for vertices.
pub(super) struct Problem<'a> {
    groups: &'a Groups,
    pub(super) system: System,
    /// For the quadratic programs, whose weights differ.
    bounded: Option<System>,
    angles: &'a [f64],
    ones: Vec<f64>,
    stats: ConsistencyStats,
}

impl<'a> Problem<'a> {
    pub(super) fn new(
        groups: &'a Groups,
        system: System,
        angles: &'a [f64],
    ) -> Result<Self, NotPositiveDefinite> {
        let ones = vec![1.0; angles.len()];
        let stats = ConsistencyStats::default();
        Ok(Self { groups, system, bounded: None, angles, ones, stats })
    }

    pub(super) fn stats(&self) -> ConsistencyStats {
        self.stats
    }

    /// Changes of indices, and angles.
    pub(super) fn solve(
        &mut self,
        options: &ConsistencyOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(Vec<i32>, Vec<f64>), ConsistencyError> {
        let none = vec![0; self.groups.len()];
        let unit = self.ones.clone();
        match options.norm {
            AngleNorm::L2 => {
                self.nearest(none, &unit, options, watch).map(|found| (found.change, found.angles))
            }
            AngleNorm::L1 => self.sparsest(none, options, watch),
        }
    }

    /// Least squares with the given corner weights (inverse stiffness): descent without bounds, then with
    /// them if some angle came out negative.
    fn nearest(
        &mut self,
        change: Vec<i32>,
        weights: &[f64],
        options: &ConsistencyOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Nearest, ConsistencyError> {
        self.system.factorize(weights, 0.0)?;
        let resistances = Resistances::new(&self.system, self.groups, options.column_memory)?;
        let (groups, system) = (self.groups, &self.system);
        let mut search =
            Search { groups, system, resistances, change, batches: 0, impossible_units: 0 };
        let mut plain = Unbounded::new(groups, system, self.angles, weights);
        search.enter_bounds(&mut plain, watch)?;
        let start = search.change.clone();
        let valley = search.descend(&mut plain, FREELY, watch)?;
        let mut angles = plain.angles(&valley.potential);
        let mut programs = Programs::default();
        if angles.iter().any(|&a| a < SURELY_POSITIVE) {
            let bounded = match &mut self.bounded {
                Some(bounded) => bounded,
                none => none.insert(system.twin()?),
            };
            let stiffness: Vec<f64> = weights.iter().map(|w| 1.0 / w).collect();
            let (angles_given, slack) = (self.angles, SLACK);
            let mut landscape = Bounded {
                groups,
                system: bounded,
                angles: angles_given,
                stiffness,
                slack,
                programs,
            };
            let valley = search.descend(&mut landscape, BOUNDED, watch)?;
            landscape.slack = 0.0;
            let solved = landscape.solve(&search.change, watch)?;
            programs = landscape.programs;
            if !solved.converged {
                return Err(infeasible(groups, &valley));
            }
            angles = solved.angles;
        }
        self.stats.impossible_units += search.impossible_units;
        self.stats.batches += search.batches;
        self.stats.columns += search.resistances.solved;
        self.stats.programs += programs.count;
        self.stats.interior_point_iterations += programs.iterations;
        Ok(Nearest { start, change: search.change, angles })
    }

    /// Least absolute changes by reweighting: the best of the indices given, those nearest in the l2
    /// norm, and those that a descent leads to with the weights that came out for the better of these.
    fn sparsest(
        &mut self,
        none: Vec<i32>,
        options: &ConsistencyOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(Vec<i32>, Vec<f64>), ConsistencyError> {
        let unit = self.ones.clone();
        let Nearest { start, change, angles } = self.nearest(none, &unit, options, watch)?;
        let mut best = Sparse::new(change, angles, self.angles);
        for change in [best.change.clone(), start] {
            if let Some(sparse) = self.reweighted(&change, watch)? {
                best = best.or(sparse);
            }
        }
        let weights: Vec<f64> =
            best.angles.iter().zip(self.angles).map(|(a, b)| (a - b).abs() + LAST_EDGE).collect();
        let other = match self.nearest(best.change.clone(), &weights, options, watch) {
            Ok(other) if other.change != best.change => self.reweighted(&other.change, watch)?,
            Err(ConsistencyError::Cancelled(cancelled)) => return Err(cancelled.into()),
            _ => None,
        };
        if let Some(sparse) = other {
            best = best.or(sparse);
        }
        Ok((best.change, best.angles))
    }

    /// Angles of least absolute change for fixed indices, nearly: iteratively reweighted least squares.
    /// None if no positive angles have these indices.
    fn reweighted(
        &mut self,
        change: &[i32],
        watch: &mut Watch<'_, '_>,
    ) -> Result<Option<Sparse>, ConsistencyError> {
        let bounded = match &mut self.bounded {
            Some(bounded) => bounded,
            none => none.insert(self.system.twin()?),
        };
        let mut landscape = Bounded {
            groups: self.groups,
            system: bounded,
            angles: self.angles,
            stiffness: self.ones.clone(),
            slack: 0.0,
            programs: Programs::default(),
        };
        let mut best: Option<Sparse> = None;
        let mut edge = FIRST_EDGE;
        while edge >= LAST_EDGE {
            let solved = landscape.solve(change, watch)?;
            if !solved.converged {
                break;
            }
            let changes = solved.angles.iter().zip(self.angles).map(|(a, b)| (a - b).abs());
            landscape.stiffness = changes.map(|d| 1.0 / (d + edge)).collect();
            let sparse = Sparse::new(change.to_vec(), solved.angles, self.angles);
            best = Some(match best {
                Some(best) => best.or(sparse),
                None => sparse,
            });
            edge *= SHARPER;
        }
        self.stats.programs += landscape.programs.count;
        self.stats.interior_point_iterations += landscape.programs.iterations;
        Ok(best)
    }
}

/// What a descent in the l2 norm found.
struct Nearest {
    /// The indices it started from, brought into their bounds.
    start: Vec<i32>,
    change: Vec<i32>,
    angles: Vec<f64>,
}

/// Indices and angles judged by the l1 norm.
struct Sparse {
    change: Vec<i32>,
    angles: Vec<f64>,
    distance: f64,
}

impl Sparse {
    fn new(change: Vec<i32>, angles: Vec<f64>, given: &[f64]) -> Self {
        let distance = angles.iter().zip(given).map(|(a, b)| (a - b).abs()).sum();
        Self { change, angles, distance }
    }

    fn or(self, other: Self) -> Self {
        if other.distance < self.distance { other } else { self }
    }
}

/// Vertices whose angle sums could not be met.
fn infeasible(groups: &Groups, valley: &Valley) -> ConsistencyError {
    let off = |g: u32| g != FREE && (SLACK * valley.potential[g as usize]).abs() > OFF;
    let vertices = groups.of.enumerate().filter(|&(_, &g)| off(g)).map(|(v, _)| v.0).collect();
    ConsistencyError::Infeasible { vertices }
}
