//! Fixing the displacements of connections one by one.

use super::conditional::{Conditional, Effect};
use super::problem::{Constraint, RoundingProblem};
use crate::linear::{Rows, apply};
use seamstress_parallel::prelude::*;

/// Values tried for a connection, the cheapest first.
const TRIED: usize = 8;
/// Values looked at are this many steps around the nearest.
const REACH: i64 = 2;
/// A determined value this close to an integer is that integer.
const SAME: f64 = 1e-5;
/// Connections per parallel task.
const CHUNK: usize = 512;
/// A row whose variance is below this share of the mean is determined.
const DETERMINED: f64 = 1e-9;

/// Connections being fixed, with the mean and the variance of each under the conditions so far.
pub(super) struct Fixing<'a> {
    problem: &'a RoundingProblem<'a>,
    /// Both rows of every connection.
    rows: Rows,
    /// The joint constraint that each one is a member of.
    memberships: Vec<Option<usize>>,
    now: Conditional,
    means: Vec<[f64; 2]>,
    variances: Vec<f64>,
    /// Variance below which a value is determined.
    determined: f64,
}

/// What fixing the two rows of a connection, one after the other, would do.
struct Parts {
    effects: [Effect; 2],
    /// Of each row, that of the second given the first.
    variances: [f64; 2],
    /// Covariance of both rows of every connection with the first row, and with the second given the first.
    couplings: Vec<[[f64; 2]; 2]>,
}

impl Parts {
    /// How the value of a connection moves when each part is raised by one.
    fn gains(&self, j: usize) -> [[f64; 2]; 2] {
        let gain = |part: usize| match self.effects[part] {
            Effect::Free { .. } => self.couplings[j].map(|c| c[part] / self.variances[part]),
            _ => [0.0; 2],
        };
        [gain(0), gain(1)]
    }

    /// By how much fixing both lowers the variance of a connection.
    fn settles(&self, j: usize) -> [f64; 2] {
        let (gains, [u, v]) = (self.gains(j), self.couplings[j]);
        [0, 1].map(|part| gains[part][0] * u[part] + gains[part][1] * v[part])
    }
}

/// A value for a connection and what it does to the others.
pub(super) struct Choice {
    connection: usize,
    parts: Parts,
    value: [i64; 2],
}

impl<'a> Fixing<'a> {
    /// Nothing fixed yet, around a point.
    pub(super) fn new(problem: &'a RoundingProblem<'a>, at: &[f64]) -> Self {
        let start = Conditional::new(problem.energy.covariance.clone(), at.to_vec());
        let constraints = &problem.constraints;
        let mean = |c: &Constraint| c.rows.each_ref().map(|row| apply(row, start.mean()));
        let variance = |c: &Constraint| c.rows.iter().map(|row| start.variance(row)).sum();
        Self {
            problem,
            rows: Rows::new(constraints.iter().flat_map(|constraint| &constraint.rows)),
            means: constraints.iter().map(mean).collect(),
            variances: constraints.par_iter().map(variance).collect(),
            memberships: problem.memberships(),
            determined: DETERMINED * start.mean_variance(),
            now: start,
        }
    }

    /// The solution under the conditions so far.
    pub(super) fn into_conditional(self) -> Conditional {
        self.now
    }

    /// The length of a connection now, grid units; at most what it was in the seamless map.
    pub(super) fn length(&self, i: usize) -> f64 {
        let [u, v] = self.means[i];
        u.hypot(v).min(self.problem.constraints[i].length)
    }

    /// Whether the conditions so far do not determine a connection.
    pub(super) fn is_open(&self, i: usize) -> bool {
        self.variances[i] > self.determined
    }

    /// The cheapest value for a connection that is long enough and makes no determined one vanish or turn around, if
    /// there is one.
    ///
    /// That those determined with it have to be longer is left to the local search: to demand it here leads into dead
    /// ends, with energies a hundred times as high.
    pub(super) fn choose(&self, i: usize) -> Option<Choice> {
        let problem = self.problem;
        let parts = self.parts(i)?;
        // Which connections get determined does not depend on the value.
        let left = |j: usize| {
            let [first, second] = parts.settles(j);
            self.variances[j] - first - second
        };
        let all = 0..problem.constraints.len();
        let is_determined: Vec<bool> = all.map(|j| left(j) <= self.determined).collect();
        let is_new = |&j: &usize| is_determined[j] && self.is_open(j);
        let new: Vec<usize> = (0..problem.constraints.len()).filter(is_new).collect();
        let mut joint: Vec<usize> = new.iter().filter_map(|&j| self.memberships[j]).collect();
        joint.dedup();
        let is_possible = |value: &[i64; 2]| {
            let errors = self.errors(i, &parts, *value);
            let fits = |part: usize| {
                matches!(parts.effects[part], Effect::Free { .. }) || errors[part].abs() < SAME
            };
            let at = |j: usize| self.moved(j, &parts, errors);
            let known = |j: usize| is_determined[j].then(|| at(j));
            fits(0)
                && fits(1)
                && new.iter().all(|&j| problem.constraints[j].keeps_apart(at(j)))
                && joint.iter().all(|&k| {
                    let (members, rule) = &problem.joint[k];
                    rule.allows(members.clone().map(known))
                })
        };
        let value = self.candidates(i, &parts).into_iter().find(is_possible)?;
        Some(Choice { connection: i, parts, value })
    }

    /// Fixes a connection.
    pub(super) fn fix(&mut self, choice: Choice) {
        let Choice { connection, parts, value } = choice;
        let errors = self.errors(connection, &parts, value);
        for j in 0..self.problem.constraints.len() {
            self.means[j] = self.moved(j, &parts, errors);
            self.variances[j] -= parts.settles(j).iter().sum::<f64>();
        }
        let rows = &self.problem.constraints[connection].rows;
        for ((effect, row), value) in parts.effects.into_iter().zip(rows).zip(value) {
            if let Effect::Free { reduced, pivot } = effect {
                self.now.fix(row, value, reduced, pivot);
            }
        }
    }

    /// What fixing the two rows of a connection, one after the other, would do, if they can be set to any integers.
    fn parts(&self, i: usize) -> Option<Parts> {
        let rows = &self.problem.constraints[i].rows;
        let effect = self.now.effect(&rows[0], None);
        let effects = [effect.clone(), self.now.effect(&rows[1], Some(&effect))];
        if effects.iter().any(|effect| matches!(effect, Effect::NoUnit)) {
            return None;
        }
        let [first, mut second] = rows.each_ref().map(|row| self.now.spread(row));
        let variance = apply(&rows[0], &first);
        if matches!(effect, Effect::Free { .. }) {
            let gain = apply(&rows[1], &first) / variance;
            second.iter_mut().zip(&first).for_each(|(s, before)| *s -= gain * before);
        }
        let variances = [variance, apply(&rows[1], &second)];
        let spreads: Vec<[f64; 2]> = first.into_iter().zip(second).map(Into::into).collect();
        // What is determined has no covariance with anything.
        let coupling = |(j, &variance): (usize, &f64)| match variance > self.determined {
            true => [2 * j, 2 * j + 1].map(|row| self.rows.apply(row, &spreads)),
            false => [[0.0; 2]; 2],
        };
        let all = self.variances.par_iter().enumerate().with_min_len(CHUNK);
        Some(Parts { effects, variances, couplings: all.map(coupling).collect() })
    }

    /// How far a value is from the mean of the first row, and then from that of the second.
    fn errors(&self, i: usize, parts: &Parts, value: [i64; 2]) -> [f64; 2] {
        let first = value[0] as f64 - self.means[i][0];
        let second = value[1] as f64 - self.means[i][1] - parts.gains(i)[0][1] * first;
        [first, second]
    }

    /// The mean of a connection after fixing.
    fn moved(&self, j: usize, parts: &Parts, errors: [f64; 2]) -> [f64; 2] {
        let [a, b] = parts.gains(j);
        [0, 1].map(|k| self.means[j][k] + a[k] * errors[0] + b[k] * errors[1])
    }

    /// Allowed values of a connection near the one it has, by the energy they cost.
    fn candidates(&self, i: usize, parts: &Parts) -> Vec<[i64; 2]> {
        let constraint = &self.problem.constraints[i];
        let [u, v] = self.means[i].map(|x| x.round() as i64);
        let cost = |value: [i64; 2]| {
            let errors = self.errors(i, parts, value);
            let of = |k: usize| errors[k] * errors[k] / parts.variances[k].max(self.determined);
            of(0) + of(1)
        };
        let mut values: Vec<[i64; 2]> = (-REACH..=REACH)
            .flat_map(|x| (-REACH..=REACH).map(move |y| [u + x, v + y]))
            .filter(|v| constraint.shortage(v.map(|x| x as f64)) == 0)
            .collect();
        values.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
        values.truncate(TRIED);
        values
    }
}
