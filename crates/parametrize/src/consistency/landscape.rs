//! The objective as a function of the indices, in the l2 norm: without and with positive angles.

use super::descent::{Landscape, Valley};
use super::error::ConsistencyError;
use super::groups::{FREE, Groups};
use super::input::{AngleNorm, ConsistencyStats};
use super::program::{Program, Solved};
use super::system::System;
use crate::progress::Watch;
use std::f64::consts::{FRAC_PI_2, PI};

/// Angle sum of each group after a change of indices.
pub(super) fn targets(groups: &Groups, change: &[i32]) -> Vec<f64> {
    let list = groups.list.iter().zip(change);
    list.map(|(g, &n)| g.full_angle - FRAC_PI_2 * (g.index + f64::from(n))).collect()
}

/// Least squares without bounds: one back-substitution.
pub(super) struct Unbounded<'a> {
    groups: &'a Groups,
    system: &'a System,
    /// Angles with the right sums in triangles.
    angles: Vec<f64>,
    /// Sums of these in groups.
    sums: Vec<f64>,
}

impl<'a> Unbounded<'a> {
    pub(super) fn new(groups: &'a Groups, system: &'a System, given: &[f64]) -> Self {
        let mut angles = given.to_vec();
        for a in angles.chunks_exact_mut(3) {
            let share = (PI - a.iter().sum::<f64>()) / 3.0;
            a.iter_mut().for_each(|a| *a += share);
        }
        let mut sums = vec![0.0; groups.len()];
        for (a, &g) in angles.iter().zip(&system.group).filter(|(_, g)| **g != FREE) {
            sums[g as usize] += a;
        }
        Self { groups, system, angles, sums }
    }

    /// The angles that belong to multipliers of the groups, and the multipliers of the triangles that go with them.
    pub(super) fn angles(&self, potential: &[f64], given: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let at = |i: usize| match self.system.group[i] {
            FREE => 0.0,
            g => potential[g as usize],
        };
        let mut angles = self.angles.clone();
        let mut triangle = Vec::with_capacity(angles.len() / 3);
        for (f, a) in angles.chunks_exact_mut(3).enumerate() {
            let y = [0, 1, 2].map(|k| at(3 * f + k));
            let mean = y.iter().sum::<f64>() / 3.0;
            (0..3).for_each(|k| a[k] += y[k] - mean);
            let forces = (0..3).map(|k| a[k] - given[3 * f + k] - y[k]);
            triangle.push(forces.sum::<f64>() / 3.0);
        }
        (angles, triangle)
    }
}

impl Landscape for Unbounded<'_> {
    fn at(&mut self, change: &[i32], _: &mut Watch<'_, '_>) -> Result<Valley, ConsistencyError> {
        let targets = targets(self.groups, change);
        let lack: Vec<f64> = targets.iter().zip(&self.sums).map(|(t, s)| t - s).collect();
        let mut potential = lack.clone();
        self.system.solve(&mut potential);
        let value = lack.iter().zip(&potential).map(|(c, y)| c * y).sum();
        Ok(Valley { value, potential })
    }
}

/// Least squares with positive angles: a quadratic program.
pub(super) struct Bounded<'a> {
    pub(super) groups: &'a Groups,
    pub(super) system: &'a mut System,
    pub(super) angles: &'a [f64],
    pub(super) slack: f64,
    pub(super) stats: &'a mut ConsistencyStats,
}

impl Bounded<'_> {
    pub(super) fn solve(
        &mut self,
        change: &[i32],
        watch: &mut Watch<'_, '_>,
    ) -> Result<Solved, ConsistencyError> {
        let sums = targets(self.groups, change);
        let program = Program::elastic(self.angles, AngleNorm::L2, sums, self.slack);
        let solved = program.solve(self.system, watch)?;
        self.stats.programs += 1;
        self.stats.interior_point_iterations += solved.iterations;
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
