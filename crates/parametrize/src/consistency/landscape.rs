//! The objective as a function of the indices: without and with positive angles.

use super::descent::{Landscape, Valley};
use super::error::ConsistencyError;
use super::groups::{FREE, Groups};
use super::program::{Program, Solved};
use super::system::System;
use crate::progress::Watch;
use std::f64::consts::{FRAC_PI_2, PI};

/// Angle sum of each group after a change of indices.
fn targets(groups: &Groups, change: &[i32]) -> Vec<f64> {
    let list = groups.list.iter().zip(change);
    list.map(|(g, &n)| g.full_angle - FRAC_PI_2 * (g.index + f64::from(n))).collect()
}

/// Weighted least squares without bounds: one back-substitution.
pub(super) struct Unbounded<'a> {
    groups: &'a Groups,
    system: &'a System,
    weights: &'a [f64],
    /// Angles with the right sums in triangles.
    angles: Vec<f64>,
    sums: Vec<f64>,
}

impl<'a> Unbounded<'a> {
    pub(super) fn new(
        groups: &'a Groups,
        system: &'a System,
        angles: &[f64],
        weights: &'a [f64],
    ) -> Self {
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
    pub(super) fn angles(&self, potential: &[f64]) -> Vec<f64> {
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
pub(super) struct Programs {
    pub(super) count: usize,
    pub(super) iterations: usize,
}

/// Weighted least squares with positive angles: a quadratic program.
pub(super) struct Bounded<'a> {
    pub(super) groups: &'a Groups,
    pub(super) system: &'a mut System,
    pub(super) angles: &'a [f64],
    pub(super) stiffness: Vec<f64>,
    pub(super) slack: f64,
    pub(super) programs: Programs,
}

impl Bounded<'_> {
    pub(super) fn solve(
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
