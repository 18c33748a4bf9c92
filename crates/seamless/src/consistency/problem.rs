//! Indices and angles of problem (14).

use super::descent::{Effort, Landscape, Search, Valley};
use super::error::ConsistencyError;
use super::groups::{FREE, Groups};
use super::input::{AngleNorm, ConsistencyOptions, ConsistencyStats};
use super::program::{Program, Solved};
use super::resistance::Resistances;
use super::system::System;
use crate::progress::Watch;
use seamstress_numerics::NotPositiveDefinite;
use std::f64::consts::{FRAC_PI_2, PI};

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
            AngleNorm::L2 => self.nearest(none, &unit, options, watch).map(|(_, found)| found),
            AngleNorm::L1 => self.sparsest(none, options, watch),
        }
    }

    /// Least squares with the given corner weights (inverse stiffness): descent without bounds, then with
    /// them if some angle came out negative. Returns the start, brought into the bounds of the indices,
    /// and the end.
    fn nearest(
        &mut self,
        change: Vec<i32>,
        weights: &[f64],
        options: &ConsistencyOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(Vec<i32>, (Vec<i32>, Vec<f64>)), ConsistencyError> {
        self.system.factorize(weights, 0.0)?;
        let resistances = Resistances::new(&self.system, self.groups, options.column_memory)?;
        let (groups, system) = (self.groups, &self.system);
        let mut search =
            Search { groups, system, resistances, change, batches: 0, impossible_units: 0 };
        let mut plain = Unbounded::new(groups, system, self.angles, weights);
        search.into_bounds(&mut plain, watch)?;
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
        Ok((start, (search.change, angles)))
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
        let (start, (nearest, angles)) = self.nearest(none, &unit, options, watch)?;
        let mut best = Sparse::new(nearest, angles, self.angles);
        for change in [best.change.clone(), start] {
            if let Some(sparse) = self.reweighted(&change, watch)? {
                best = best.or(sparse);
            }
        }
        let weights: Vec<f64> =
            best.angles.iter().zip(self.angles).map(|(a, b)| (a - b).abs() + LAST_EDGE).collect();
        let other = match self.nearest(best.change.clone(), &weights, options, watch) {
            Ok((_, (other, _))) if other != best.change => self.reweighted(&other, watch)?,
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

/// Angle sum of each group after a change of indices.
fn targets(groups: &Groups, change: &[i32]) -> Vec<f64> {
    let list = groups.list.iter().zip(change);
    list.map(|(g, &n)| g.full_angle - FRAC_PI_2 * (g.index + f64::from(n))).collect()
}

/// Weighted least squares without bounds: one back-substitution.
struct Unbounded<'a> {
    groups: &'a Groups,
    system: &'a System,
    weights: &'a [f64],
    /// Angles with the right sums in triangles.
    angles: Vec<f64>,
    sums: Vec<f64>,
}

impl<'a> Unbounded<'a> {
    fn new(groups: &'a Groups, system: &'a System, angles: &[f64], weights: &'a [f64]) -> Self {
        let mut angles = angles.to_vec();
        for (a, w) in angles.chunks_exact_mut(3).zip(weights.chunks_exact(3)) {
            let share = (PI - a.iter().sum::<f64>()) / w.iter().sum::<f64>();
            a.iter_mut().zip(w).for_each(|(a, w)| *a += w * share);
        }
        let mut sums = vec![0.0; groups.len()];
        for (a, &g) in angles.iter().zip(&system.group).filter(|(_, g)| **g != FREE) {
            sums[g as usize] += a;
        }
        Self { groups, system, weights, angles, sums }
    }

    /// The angles that belong to multipliers of the groups.
    fn angles(&self, potential: &[f64]) -> Vec<f64> {
        let at = |i: usize| match self.system.group[i] {
            FREE => 0.0,
            g => potential[g as usize],
        };
        let mut angles = self.angles.clone();
        for (f, a) in angles.chunks_exact_mut(3).enumerate() {
            let w = &self.weights[3 * f..3 * f + 3];
            let mean = (0..3).map(|k| w[k] * at(3 * f + k)).sum::<f64>() / w.iter().sum::<f64>();
            (0..3).for_each(|k| a[k] += w[k] * (at(3 * f + k) - mean));
        }
        angles
    }
}

impl Landscape for Unbounded<'_> {
    fn at(&mut self, change: &[i32], _: &mut Watch<'_, '_>) -> Result<Valley, ConsistencyError> {
        let targets = targets(self.groups, change);
        let lack: Vec<f64> = targets.iter().zip(&self.sums).map(|(t, s)| t - s).collect();
        let mut potential = lack.clone();
        self.system.solve(&mut potential)?;
        let value = lack.iter().zip(&potential).map(|(c, y)| c * y).sum();
        Ok(Valley { value, potential })
    }
}

/// What the quadratic programs have cost.
#[derive(Debug, Clone, Copy, Default)]
struct Programs {
    count: usize,
    iterations: usize,
}

/// Weighted least squares with positive angles: a quadratic program.
struct Bounded<'a> {
    groups: &'a Groups,
    system: &'a mut System,
    angles: &'a [f64],
    stiffness: Vec<f64>,
    slack: f64,
    programs: Programs,
}

impl Bounded<'_> {
    fn solve(
        &mut self,
        change: &[i32],
        watch: &mut Watch<'_, '_>,
    ) -> Result<Solved, ConsistencyError> {
        let program = Program {
            angles: self.angles,
            stiffness: &self.stiffness,
            target: &targets(self.groups, change),
            slack: self.slack,
        };
        let solved = program.solve(self.system, watch)?;
        self.programs.count += 1;
        self.programs.iterations += solved.iterations;
        Ok(solved)
    }
}

impl Landscape for Bounded<'_> {
    fn at(
        &mut self,
        change: &[i32],
        watch: &mut Watch<'_, '_>,
    ) -> Result<Valley, ConsistencyError> {
        let solved = self.solve(change, watch)?;
        Ok(Valley { value: solved.value, potential: solved.potential })
    }
}
