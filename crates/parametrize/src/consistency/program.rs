//! The angles for fixed indices: a quadratic program with positive angles.

use super::error::ConsistencyError;
use super::groups::FREE;
use super::system::System;
use crate::progress::Watch;
use std::f64::consts::PI;

const MOST_ITERATIONS: usize = 60;
/// Share of the way to the nearest bound.
const STEP: f64 = 0.99;
/// Complementarity and residuals at the end, radians.
const COMPLEMENTARITY: f64 = 1e-11;
const PRIMAL: f64 = 1e-9;
const DUAL: f64 = 1e-8;
/// Angles start at least at this, radians.
const FIRST_ANGLE: f64 = 0.05;
/// The bounds' first multipliers.
const FIRST_MULTIPLIER: f64 = 0.1;

/// Minimise `sum stiffness (alpha - angles)^2 + slack sum y^2` over `alpha >= 0` with triangle sums pi
/// and group sums `target - slack y`, `y` the multiplier: with slack 0 the sums are met, and with a small
/// slack they are met as well as can be.
pub(super) struct Program<'a> {
    /// Per corner, radians.
    pub(super) angles: &'a [f64],
    /// Per corner.
    pub(super) stiffness: &'a [f64],
    /// Angle sum per group, radians.
    pub(super) target: &'a [f64],
    pub(super) slack: f64,
}

/// Where the interior point came.
pub(super) struct Solved {
    pub(super) angles: Vec<f64>,
    /// Multiplier per group: half the derivative of the value by the target.
    pub(super) potential: Vec<f64>,
    pub(super) value: f64,
    pub(super) iterations: usize,
    pub(super) converged: bool,
}

impl Program<'_> {
    /// Infeasible primal-dual interior point with Mehrotra's steps; the normal matrix is that of the
    /// [`System`] with corner weights `1 / (stiffness + z / alpha)`.
    pub(super) fn solve(
        &self,
        system: &mut System,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Solved, ConsistencyError> {
        let mut point = Point::new(self);
        let mut iterations = 0;
        let mut converged = false;
        while iterations < MOST_ITERATIONS {
            watch.pulse()?;
            let residual = point.residual(self, system);
            converged = residual.is_small();
            if converged || !residual.complementarity.is_finite() {
                break;
            }
            let weights = point.weights(self);
            if system.factorize(&weights, self.slack).is_err() {
                break;
            }
            let predictor = point.step(system, &weights, &residual, None)?;
            let corrected = point.step(system, &weights, &residual, Some(&predictor))?;
            point.advance(&corrected);
            iterations += 1;
        }
        let value = point.value(self);
        Ok(Solved { angles: point.alpha, potential: point.group, value, iterations, converged })
    }
}

struct Point {
    alpha: Vec<f64>,
    /// Multipliers of the bounds.
    z: Vec<f64>,
    triangle: Vec<f64>,
    group: Vec<f64>,
}

struct Residual {
    triangle: Vec<f64>,
    group: Vec<f64>,
    dual: Vec<f64>,
    complementarity: f64,
}

impl Residual {
    fn is_small(&self) -> bool {
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        self.complementarity < COMPLEMENTARITY
            && largest(&self.triangle) < PRIMAL
            && largest(&self.group) < PRIMAL
            && largest(&self.dual) < DUAL
    }
}

struct Direction {
    alpha: Vec<f64>,
    z: Vec<f64>,
    triangle: Vec<f64>,
    group: Vec<f64>,
}

impl Point {
    fn new(program: &Program<'_>) -> Self {
        let n = program.angles.len();
        Self {
            alpha: program.angles.iter().map(|a| a.max(FIRST_ANGLE)).collect(),
            z: vec![FIRST_MULTIPLIER; n],
            triangle: vec![0.0; n / 3],
            group: vec![0.0; program.target.len()],
        }
    }

    fn value(&self, program: &Program<'_>) -> f64 {
        let squares = self.alpha.iter().zip(program.angles).zip(program.stiffness);
        let squares: f64 = squares.map(|((a, b), s)| s * (a - b) * (a - b)).sum();
        squares + program.slack * self.group.iter().map(|y| y * y).sum::<f64>()
    }

    fn residual(&self, program: &Program<'_>, system: &System) -> Residual {
        let n = self.alpha.len();
        let mut residual = Residual {
            triangle: vec![PI; n / 3],
            group: program.target.to_vec(),
            dual: vec![0.0; n],
            complementarity: 0.0,
        };
        for (r, y) in residual.group.iter_mut().zip(&self.group) {
            *r -= program.slack * y;
        }
        for (i, &g) in system.group.iter().enumerate() {
            residual.triangle[i / 3] -= self.alpha[i];
            let mut pull = self.triangle[i / 3];
            if g != FREE {
                residual.group[g as usize] -= self.alpha[i];
                pull += self.group[g as usize];
            }
            let force = program.stiffness[i] * (self.alpha[i] - program.angles[i]);
            residual.dual[i] = pull + self.z[i] - force;
            residual.complementarity += self.alpha[i] * self.z[i];
        }
        residual.complementarity /= n as f64;
        residual
    }

    fn weights(&self, program: &Program<'_>) -> Vec<f64> {
        let bars = self.z.iter().zip(&self.alpha).zip(program.stiffness);
        bars.map(|((z, a), s)| 1.0 / (s + z / a)).collect()
    }

    /// Newton direction: the predictor aims at complementarity zero; the corrector at a share of the
    /// present one, with the predictor's second-order term.
    fn step(
        &self,
        system: &System,
        weights: &[f64],
        residual: &Residual,
        predictor: Option<&Direction>,
    ) -> Result<Direction, ConsistencyError> {
        let goal = predictor.map_or(0.0, |p| self.centring(p, residual.complementarity));
        let bar = |i: usize| {
            let second = predictor.map_or(0.0, |p| p.alpha[i] * p.z[i]);
            (goal - second) / self.alpha[i] - self.z[i]
        };
        let n = self.alpha.len();
        let push: Vec<f64> = (0..n).map(|i| residual.dual[i] + bar(i)).collect();
        let mut triangle = residual.triangle.clone();
        let mut sums = vec![0.0; n / 3];
        for i in 0..n {
            triangle[i / 3] -= weights[i] * push[i];
            sums[i / 3] += weights[i];
        }
        let mut group = residual.group.clone();
        for (i, &g) in system.group.iter().enumerate().filter(|(_, g)| **g != FREE) {
            group[g as usize] -= weights[i] * (push[i] + triangle[i / 3] / sums[i / 3]);
        }
        system.solve(&mut group)?;
        let at = |g: u32| if g == FREE { 0.0 } else { group[g as usize] };
        for (i, &g) in system.group.iter().enumerate() {
            triangle[i / 3] -= weights[i] * at(g);
        }
        triangle.iter_mut().zip(&sums).for_each(|(t, s)| *t /= s);
        let alpha: Vec<f64> = (0..n)
            .map(|i| weights[i] * (push[i] + triangle[i / 3] + at(system.group[i])))
            .collect();
        let z = (0..n).map(|i| bar(i) - self.z[i] / self.alpha[i] * alpha[i]).collect();
        Ok(Direction { alpha, z, triangle, group })
    }

    /// Mehrotra's choice: the cube of what the predictor leaves.
    fn centring(&self, predictor: &Direction, complementarity: f64) -> f64 {
        let a = reach(&self.alpha, &predictor.alpha).min(1.0);
        let b = reach(&self.z, &predictor.z).min(1.0);
        let left = (0..self.alpha.len())
            .map(|i| (self.alpha[i] + a * predictor.alpha[i]) * (self.z[i] + b * predictor.z[i]));
        let left = left.sum::<f64>() / self.alpha.len() as f64;
        complementarity * (left / complementarity).powi(3)
    }

    fn advance(&mut self, direction: &Direction) {
        let reach = reach(&self.alpha, &direction.alpha).min(reach(&self.z, &direction.z));
        let step = (STEP * reach).min(1.0);
        let go = |x: &mut [f64], d: &[f64]| x.iter_mut().zip(d).for_each(|(x, d)| *x += step * d);
        go(&mut self.alpha, &direction.alpha);
        go(&mut self.z, &direction.z);
        go(&mut self.triangle, &direction.triangle);
        go(&mut self.group, &direction.group);
    }
}

/// Largest step that keeps all entries non-negative.
fn reach(x: &[f64], direction: &[f64]) -> f64 {
    let steps = x.iter().zip(direction).filter(|(_, d)| **d < 0.0).map(|(x, d)| -x / d);
    steps.fold(f64::INFINITY, f64::min)
}
