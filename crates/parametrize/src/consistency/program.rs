//! The angles for fixed indices: a convex program with positive angles.

use super::error::ConsistencyError;
use super::groups::FREE;
use super::input::AngleNorm;
use super::system::System;
use crate::progress::Watch;
use std::f64::consts::PI;

const MOST_ITERATIONS: usize = 60;
/// Share of the way to the nearest bound.
const STEP: f64 = 0.99;
/// Angles start at least at this, radians.
const FIRST_ANGLE: f64 = 0.05;
/// The first multipliers of the angles.
const FIRST_MULTIPLIER: f64 = 0.1;
/// Both parts of a change exceed what is needed by this at first, radians.
const FIRST_PART: f64 = 0.1;
/// Room of a sum that is fixed, radians, and the weight that holds it in the middle: the sum is off by a millionth.
const FIXED_ROOM: f64 = 3.0;
const FIXED_WEIGHT: f64 = 1e6;

/// Complementarity and residuals at the end, radians.
#[derive(Debug, Clone, Copy)]
struct Precision {
    complementarity: f64,
    primal: f64,
    dual: f64,
}

/// Angles that are given out.
const FINE: Precision = Precision { complementarity: 1e-11, primal: 1e-9, dual: 1e-8 };
/// Angles that are given out as well where the weights become too different to go on.
const NEAR: Precision = Precision { complementarity: 1e-9, primal: 1e-8, dual: 1e-7 };
/// Multipliers that a bound starts from.
const ROUGH: Precision = Precision { complementarity: 1e-5, primal: 1e-4, dual: 1e-4 };

/// Minimises the cost of changed angles over `alpha >= 0` with given sums in triangles and groups.
///
/// A group's sum that may lie between two bounds has a triangle of its own: of the width of the room, one corner in
/// the group, the others free, all without cost ([`rooms`]).
pub(super) struct Program {
    /// Angle given per corner, radians.
    given: Vec<f64>,
    /// Weight of the squared change per corner.
    weight: Vec<f64>,
    /// Corners of the mesh; those of rooms follow.
    n_corners: usize,
    norm: AngleNorm,
    /// Sum per triangle.
    triangle: Vec<f64>,
    /// Sum per group; a sum that gives way is this less `slack y` at the multiplier `y`, at a cost of `slack y^2`.
    group: Vec<f64>,
    slack: f64,
    precision: Precision,
}

/// Groups of corners, with those of a room for each group.
pub(super) fn rooms(group: &[u32], n_groups: usize) -> Vec<u32> {
    group.iter().copied().chain((0..n_groups as u32).flat_map(|g| [g, FREE, FREE])).collect()
}

/// Where the interior point came.
pub(super) struct Solved {
    pub(super) angles: Vec<f64>,
    /// Multiplier per triangle: the derivative of the value by its sum, half of it for squares.
    pub(super) triangle: Vec<f64>,
    /// Multiplier per group.
    pub(super) potential: Vec<f64>,
    /// Cost, that of the slack included.
    pub(super) value: f64,
    pub(super) iterations: usize,
    pub(super) converged: bool,
}

impl Program {
    /// Sums of groups that are met.
    pub(super) fn new(given: &[f64], norm: AngleNorm, sums: Vec<f64>) -> Self {
        let n = given.len();
        Self {
            given: given.to_vec(),
            weight: vec![1.0; n],
            n_corners: n,
            norm,
            triangle: vec![PI; n / 3],
            group: sums,
            slack: 0.0,
            precision: FINE,
        }
    }

    /// Sums of groups that are met as well as can be.
    pub(super) fn elastic(given: &[f64], norm: AngleNorm, sums: Vec<f64>, slack: f64) -> Self {
        Self { slack, ..Self::new(given, norm, sums) }
    }

    /// Sums of groups between two bounds, for a system with [`rooms`].
    pub(super) fn between(given: &[f64], norm: AngleNorm, bounds: &[(f64, f64)]) -> Self {
        let mut program = Self::new(given, norm, Vec::with_capacity(bounds.len()));
        program.precision = ROUGH;
        for &(low, high) in bounds {
            let fixed = low == high;
            let (room, weight) = if fixed { (FIXED_ROOM, FIXED_WEIGHT) } else { (high - low, 0.0) };
            program.given.extend([room / 3.0; 3]);
            program.weight.extend([weight, 0.0, 0.0]);
            program.triangle.push(room);
            program.group.push(if fixed { low + room / 3.0 } else { high });
        }
        program
    }

    /// Infeasible primal-dual interior point with Mehrotra's steps; the normal matrix is that of the
    /// [`System`] with corner weights `1 / (stiffness + z / alpha)`.
    pub(super) fn solve(
        &self,
        system: &mut System,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Solved, ConsistencyError> {
        let mut point = Point::new(self);
        let (mut iterations, mut converged) = (0, false);
        while iterations < MOST_ITERATIONS {
            watch.pulse()?;
            let residual = point.residual(system);
            converged = residual.is_within(self.precision);
            if converged || !residual.complementarity.is_finite() {
                break;
            }
            let weights = point.weights();
            if system.factorize(&weights, self.slack).is_err() {
                converged = residual.is_within(NEAR);
                break;
            }
            let predictor = point.step(system, &weights, &residual, 0.0, None)?;
            let goal = point.centring(&predictor, residual.complementarity);
            let corrected = point.step(system, &weights, &residual, goal, Some(&predictor))?;
            point.advance(&corrected);
            iterations += 1;
        }
        let Point { mut variables, mut triangle, group: potential, .. } = point;
        let mut angles = variables.swap_remove(ANGLE).value;
        angles.truncate(self.n_corners);
        triangle.truncate(self.n_corners / 3);
        let changes = angles.iter().zip(&self.given).map(|(a, b)| self.norm.cost(a - b));
        let slack = self.slack * potential.iter().map(|y| y * y).sum::<f64>();
        let value = changes.sum::<f64>() + slack;
        Ok(Solved { angles, triangle, potential, value, iterations, converged })
    }
}

/// Non-negative variables and their multipliers, or steps of them.
struct Positive {
    value: Vec<f64>,
    multiplier: Vec<f64>,
}

impl Positive {
    /// `value / multiplier`.
    fn compliance(&self, at: usize) -> f64 {
        self.value[at] / self.multiplier[at]
    }

    /// The step of a value while its multiplier steps by this.
    fn value_step(&self, at: usize, lack: f64, multiplier_step: f64) -> f64 {
        (lack - self.value[at] * multiplier_step) / self.multiplier[at]
    }

    /// The step of a multiplier while its value steps by this.
    fn multiplier_step(&self, at: usize, lack: f64, value_step: f64) -> f64 {
        (lack - self.multiplier[at] * value_step) / self.value[at]
    }
}

/// Largest step that keeps all entries non-negative.
fn reach(x: &[f64], direction: &[f64]) -> f64 {
    let steps = x.iter().zip(direction).filter(|(_, d)| **d < 0.0).map(|(x, d)| -x / d);
    steps.fold(f64::INFINITY, f64::min)
}

/// The angles among the variables, and in the l1 norm the parts of `change = up - down`.
const ANGLE: usize = 0;
const UP: usize = 1;
const DOWN: usize = 2;

/// Newton's equations of a corner reduce to `d alpha = (push + d pull) / (stiffness + z / alpha)` in both norms: `pull`
/// is the sum of the multipliers of its triangle and group, `z` that of `alpha >= 0`.
struct Point<'a> {
    program: &'a Program,
    variables: Vec<Positive>,
    triangle: Vec<f64>,
    group: Vec<f64>,
}

struct Direction {
    variables: Vec<Positive>,
    triangle: Vec<f64>,
    group: Vec<f64>,
}

struct Residual {
    triangle: Vec<f64>,
    group: Vec<f64>,
    /// All that pulls at each corner: the multipliers of its triangle, group and bound.
    pull: Vec<f64>,
    /// Largest violation of the optimality conditions.
    dual: f64,
    complementarity: f64,
}

impl Residual {
    fn is_within(&self, precision: Precision) -> bool {
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        self.complementarity < precision.complementarity
            && largest(&self.triangle) < precision.primal
            && largest(&self.group) < precision.primal
            && self.dual < precision.dual
    }
}

impl<'a> Point<'a> {
    fn new(program: &'a Program) -> Self {
        let given = &program.given;
        let value: Vec<f64> = given.iter().map(|a| a.max(FIRST_ANGLE)).collect();
        // The multipliers of both parts sum to 2.
        let part = |sign: f64| {
            let parts = value.iter().zip(given).take(program.n_corners);
            let value: Vec<f64> =
                parts.map(|(a, b)| (sign * (a - b)).max(0.0) + FIRST_PART).collect();
            Positive { multiplier: vec![1.0; value.len()], value }
        };
        let parts = [part(1.0), part(-1.0)];
        let mut variables =
            vec![Positive { multiplier: vec![FIRST_MULTIPLIER; given.len()], value }];
        if program.norm == AngleNorm::L1 {
            variables.extend(parts);
        }
        let (n_triangles, n_groups) = (program.triangle.len(), program.group.len());
        Self { program, variables, triangle: vec![0.0; n_triangles], group: vec![0.0; n_groups] }
    }

    /// Whether the change of a corner is split into two parts.
    fn is_split(&self, corner: usize) -> bool {
        self.program.norm == AngleNorm::L1 && corner < self.program.n_corners
    }

    /// `value / multiplier` of both parts: how far a corner yields to a unit of pull.
    fn compliance(&self, corner: usize) -> f64 {
        self.variables[UP].compliance(corner) + self.variables[DOWN].compliance(corner)
    }

    /// By how much a change is more than its parts, from rounding errors.
    fn drift(&self, corner: usize) -> f64 {
        let [angle, up, down] = [ANGLE, UP, DOWN].map(|k| self.variables[k].value[corner]);
        angle - self.program.given[corner] - (up - down)
    }

    /// What the multiplier of a part lacks: they are `1 - pull` upwards and `1 + pull` downwards.
    fn off(&self, part: usize, corner: usize, pull: f64) -> f64 {
        let pull = if part == UP { -pull } else { pull };
        1.0 + pull - self.variables[part].multiplier[corner]
    }

    /// What pulls at a corner beyond the force of its square.
    fn square_off(&self, corner: usize, pull: f64) -> f64 {
        let change = self.variables[ANGLE].value[corner] - self.program.given[corner];
        pull - self.program.weight[corner] * change
    }

    fn residual(&self, system: &System) -> Residual {
        let angle = &self.variables[ANGLE];
        let yielded = self.program.group.iter().zip(&self.group);
        let mut residual = Residual {
            triangle: self.program.triangle.clone(),
            group: yielded.map(|(sum, y)| sum - self.program.slack * y).collect(),
            pull: angle.multiplier.clone(),
            dual: 0.0,
            complementarity: self.complementarity(None),
        };
        for (i, &g) in system.group.iter().enumerate() {
            residual.triangle[i / 3] -= angle.value[i];
            let pull = &mut residual.pull[i];
            *pull += self.triangle[i / 3];
            if g != FREE {
                residual.group[g as usize] -= angle.value[i];
                *pull += self.group[g as usize];
            }
            let error = match self.is_split(i) {
                true => {
                    let parts = [UP, DOWN].map(|part| self.off(part, i, *pull).abs());
                    parts[0].max(parts[1]).max(self.drift(i).abs())
                }
                false => self.square_off(i, *pull).abs(),
            };
            residual.dual = residual.dual.max(error);
        }
        residual
    }

    /// Mean product of a variable and its multiplier, after a step of these lengths.
    fn complementarity(&self, ahead: Option<(&Direction, [f64; 2])>) -> f64 {
        let (mut sum, mut count) = (0.0, 0);
        for (k, at) in self.variables.iter().enumerate() {
            count += at.value.len();
            let step = ahead.map(|(direction, lengths)| (&direction.variables[k], lengths));
            for i in 0..at.value.len() {
                let (value, multiplier) =
                    step.map_or((0.0, 0.0), |(s, [a, b])| (a * s.value[i], b * s.multiplier[i]));
                sum += (at.value[i] + value) * (at.multiplier[i] + multiplier);
            }
        }
        sum / count as f64
    }

    fn weights(&self) -> Vec<f64> {
        let stiffness = |i: usize| match self.is_split(i) {
            true => 1.0 / self.compliance(i),
            false => self.program.weight[i],
        };
        let angle = &self.variables[ANGLE];
        let weight = |i: usize| 1.0 / (stiffness(i) + 1.0 / angle.compliance(i));
        (0..angle.value.len()).map(weight).collect()
    }

    /// Newton direction: the predictor aims at complementarity zero; the corrector at a share of the
    /// present one, with the predictor's second-order terms.
    fn step(
        &self,
        system: &System,
        weights: &[f64],
        residual: &Residual,
        goal: f64,
        predictor: Option<&Direction>,
    ) -> Result<Direction, ConsistencyError> {
        let angle = &self.variables[ANGLE];
        let n = angle.value.len();
        // What the product of a variable and its multiplier lacks.
        let lack = |k: usize, i: usize| {
            let second =
                predictor.map_or(0.0, |p| p.variables[k].value[i] * p.variables[k].multiplier[i]);
            goal - second - self.variables[k].value[i] * self.variables[k].multiplier[i]
        };
        let own = |i: usize| match self.is_split(i) {
            true => {
                let [up, down] = [UP, DOWN].map(|k| {
                    let off = self.off(k, i, residual.pull[i]);
                    self.variables[k].value_step(i, lack(k, i), off)
                });
                (up - down - self.drift(i)) / self.compliance(i)
            }
            false => self.square_off(i, residual.pull[i]),
        };
        let push: Vec<f64> = (0..n).map(|i| own(i) + lack(ANGLE, i) / angle.value[i]).collect();
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
        system.solve(&mut group);
        let at = |g: u32| if g == FREE { 0.0 } else { group[g as usize] };
        for (i, &g) in system.group.iter().enumerate() {
            triangle[i / 3] -= weights[i] * at(g);
        }
        triangle.iter_mut().zip(&sums).for_each(|(t, s)| *t /= s);
        let pulled = |i: usize| triangle[i / 3] + at(system.group[i]);
        let value: Vec<f64> = (0..n).map(|i| weights[i] * (push[i] + pulled(i))).collect();
        let multiplier: Vec<f64> =
            (0..n).map(|i| angle.multiplier_step(i, lack(ANGLE, i), value[i])).collect();
        let step = Positive { value, multiplier };
        let n_parts = self.variables.get(UP).map_or(0, |part| part.value.len());
        let zero = || Positive { value: vec![0.0; n_parts], multiplier: vec![0.0; n_parts] };
        let (mut up, mut down) = (zero(), zero());
        for i in 0..n_parts {
            let pull = residual.pull[i] + pulled(i) + step.multiplier[i];
            let change = step.value[i] + self.drift(i);
            // The part that yields less is found from its multiplier, the other one from the change: a small
            // multiplier in a denominator would blow up rounding errors.
            let yields = [UP, DOWN].map(|part| self.variables[part].compliance(i));
            let (first, k, second, other, change) = match yields[0] > yields[1] {
                true => (&mut down, DOWN, &mut up, UP, change),
                false => (&mut up, UP, &mut down, DOWN, -change),
            };
            first.multiplier[i] = self.off(k, i, pull);
            first.value[i] = self.variables[k].value_step(i, lack(k, i), first.multiplier[i]);
            second.value[i] = first.value[i] + change;
            second.multiplier[i] =
                self.variables[other].multiplier_step(i, lack(other, i), second.value[i]);
        }
        let mut variables = vec![step];
        if self.variables.len() > 1 {
            variables.extend([up, down]);
        }
        Ok(Direction { variables, triangle, group })
    }

    /// Mehrotra's choice: the cube of what the predictor leaves.
    fn centring(&self, predictor: &Direction, complementarity: f64) -> f64 {
        let lengths = self.reach(predictor).map(|length| length.min(1.0));
        let left = self.complementarity(Some((predictor, lengths)));
        complementarity * (left / complementarity).powi(3)
    }

    /// Largest lengths of a direction for the variables and for the multipliers.
    fn reach(&self, direction: &Direction) -> [f64; 2] {
        let pairs = self.variables.iter().zip(&direction.variables);
        pairs.fold([f64::INFINITY; 2], |[a, b], (at, step)| {
            let values = reach(&at.value, &step.value);
            [a.min(values), b.min(reach(&at.multiplier, &step.multiplier))]
        })
    }

    fn advance(&mut self, direction: &Direction) {
        let [a, b] = self.reach(direction);
        let step = (STEP * a.min(b)).min(1.0);
        let go = |x: &mut [f64], d: &[f64]| x.iter_mut().zip(d).for_each(|(x, d)| *x += step * d);
        for (at, to) in self.variables.iter_mut().zip(&direction.variables) {
            go(&mut at.value, &to.value);
            go(&mut at.multiplier, &to.multiplier);
        }
        go(&mut self.triangle, &direction.triangle);
        go(&mut self.group, &direction.group);
    }
}
