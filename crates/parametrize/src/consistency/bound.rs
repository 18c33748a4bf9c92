//! What no solution can beat.

use super::groups::{FREE, Groups};
use super::system::System;
use std::f64::consts::{FRAC_PI_2, PI};

/// Steps of the dual ascent.
const STEPS: usize = 60;
/// First step, in units of the exact one for a single triangle; falls like 1 / n.
const FIRST_STEP: f64 = 0.5;
/// Distances are lowered by this share against rounding errors.
const CAUTION: f64 = 1e-9;

/// A lower bound on the sum of squared changes of angles, by Lagrange multipliers of the triangle sums.
///
/// With the triangles' sums priced at `lambda` instead of required, each group is left alone with its
/// integer: its corners change by `-lambda / 2` and share what its angle sum still lacks, at the integer
/// for which that is least. The value is a bound for every `lambda`; a few subgradient steps raise it.
pub(super) fn squares(groups: &Groups, system: &System, angles: &[f64]) -> f64 {
    let n = angles.len();
    // sum over corners of (delta^2 + lambda delta) - lambda (pi - sum of angles)
    let lack: Vec<f64> = angles.chunks_exact(3).map(|a| PI - a.iter().sum::<f64>()).collect();
    let mut lambda = vec![0.0; n / 3];
    let mut best = 0.0f64;
    for step in 0..STEPS {
        let mut wanted: Vec<f64> = groups.list.iter().map(|g| g.full_angle).collect();
        let mut value = -lambda.iter().zip(&lack).map(|(l, t)| l * t).sum::<f64>();
        for (i, &g) in system.group.iter().enumerate() {
            value -= lambda[i / 3] * lambda[i / 3] / 4.0;
            if g != FREE {
                wanted[g as usize] += lambda[i / 3] / 2.0 - angles[i];
            }
        }
        let mut shares = vec![0.0; groups.len()];
        for (g, (group, wanted)) in groups.list.iter().zip(&wanted).enumerate() {
            let off = group.distance(*wanted);
            shares[g] = off / f64::from(group.corners);
            value += off * shares[g];
        }
        best = best.max(value);
        let length = FIRST_STEP * 2.0 / 3.0 / (1.0 + step as f64 / 10.0);
        let mut excess: Vec<f64> = lack.iter().map(|t| -t).collect();
        for (i, &g) in system.group.iter().enumerate() {
            let share = if g == FREE { 0.0 } else { shares[g as usize] };
            excess[i / 3] += share - lambda[i / 3] / 2.0;
        }
        lambda.iter_mut().zip(&excess).for_each(|(l, e)| *l += length * e);
    }
    (best * (1.0 - CAUTION)).max(0.0)
}

/// A lower bound on the sum of absolute changes of angles: what all groups lack, and what all triangles
/// lack, each by itself.
pub(super) fn absolute(groups: &Groups, system: &System, angles: &[f64]) -> f64 {
    let triangles = angles.chunks_exact(3).map(|a| (PI - a.iter().sum::<f64>()).abs());
    let mut wanted: Vec<f64> = groups.list.iter().map(|g| g.full_angle).collect();
    for (i, &g) in system.group.iter().enumerate().filter(|(_, g)| **g != FREE) {
        wanted[g as usize] -= angles[i];
    }
    let off = groups.list.iter().zip(&wanted).map(|(group, w)| group.distance(*w).abs());
    off.sum::<f64>().max(triangles.sum()) * (1.0 - CAUTION)
}

impl super::groups::Group {
    /// What an angle sum lacks, at the best possible index: `wanted - (pi / 2) (index + change)`.
    fn distance(&self, wanted: f64) -> f64 {
        let best = (wanted / FRAC_PI_2 - self.index).round();
        let change = best.clamp(f64::from(self.change.0), f64::from(self.change.1));
        wanted - FRAC_PI_2 * (self.index + change)
    }
}
