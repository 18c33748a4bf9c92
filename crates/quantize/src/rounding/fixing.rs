//! Fixing the displacements of connections one by one.

use super::conditional::{Conditional, Effect};
use super::problem::{Constraint, RoundingProblem};
use crate::linear::{Row, apply};
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
    /// The joint constraint that each one is a member of.
    memberships: Vec<Option<usize>>,
    now: Conditional,
    means: Vec<[f64; 2]>,
    variances: Vec<f64>,
    /// Variance below which a value is determined.
    determined: f64,
}

/// One of the two rows of a connection that is about to be fixed.
struct Part {
    effect: Effect,
    /// Covariance with both rows of every connection, given the part before.
    coupling: Vec<[f64; 2]>,
    variance: f64,
}

impl Part {
    /// How the value of a connection moves when this part is raised by one.
    fn gain(&self, j: usize) -> [f64; 2] {
        match self.effect {
            Effect::Free { .. } => self.coupling[j].map(|c| c / self.variance),
            _ => [0.0; 2],
        }
    }

    /// By how much fixing this part lowers the variance of a connection.
    fn settles(&self, j: usize) -> f64 {
        let [gain, c] = [self.gain(j), self.coupling[j]];
        gain[0] * c[0] + gain[1] * c[1]
    }
}

/// A value for a connection and what it does to the others.
pub(super) struct Choice {
    connection: usize,
    parts: [Part; 2],
    value: [i64; 2],
}

impl<'a> Fixing<'a> {
    pub(super) fn new(problem: &'a RoundingProblem<'a>) -> Self {
        let start = Conditional::new(problem.energy.covariance.clone(), problem.mean.clone());
        let constraints = &problem.constraints;
        let mean = |c: &Constraint| c.rows.each_ref().map(|row| apply(row, start.mean()));
        let variance =
            |c: &Constraint| c.rows.iter().map(|row| apply(row, &start.spread(row))).sum::<f64>();
        Self {
            problem,
            memberships: problem.memberships(),
            means: constraints.iter().map(mean).collect(),
            variances: constraints.par_iter().map(variance).collect(),
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
        let parts = self.parts(i);
        if parts.iter().any(|part| matches!(part.effect, Effect::NoUnit)) {
            return None;
        }
        // Which connections get determined does not depend on the value.
        let left = |j: usize| self.variances[j] - parts[0].settles(j) - parts[1].settles(j);
        let all = 0..problem.constraints.len();
        let is_determined: Vec<bool> = all.map(|j| left(j) <= self.determined).collect();
        let is_new = |&j: &usize| is_determined[j] && self.is_open(j);
        let new: Vec<usize> = (0..problem.constraints.len()).filter(is_new).collect();
        let mut joint: Vec<usize> = new.iter().filter_map(|&j| self.memberships[j]).collect();
        joint.dedup();
        let is_possible = |value: &[i64; 2]| {
            let errors = self.errors(i, &parts, *value);
            let fits = |part: usize| {
                matches!(parts[part].effect, Effect::Free { .. }) || errors[part].abs() < SAME
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
            self.variances[j] -= parts[0].settles(j) + parts[1].settles(j);
        }
        let rows = &self.problem.constraints[connection].rows;
        for ((part, row), value) in parts.into_iter().zip(rows).zip(value) {
            if let Effect::Free { reduced, pivot } = part.effect {
                self.now.fix(row, value, reduced, pivot);
            }
        }
    }

    /// What fixing the two rows of a connection, one after the other, would do.
    fn parts(&self, i: usize) -> [Part; 2] {
        let rows = &self.problem.constraints[i].rows;
        let spread = self.now.spread(&rows[0]);
        let effect = self.now.effect(&rows[0], None);
        let first = self.part(&rows[0], effect, &spread);
        let mut spread_after = self.now.spread(&rows[1]);
        let effect = self.now.effect(&rows[1], Some(&first.effect));
        if matches!(first.effect, Effect::Free { .. }) {
            let gain = apply(&rows[1], &spread) / first.variance;
            spread_after.iter_mut().zip(&spread).for_each(|(s, before)| *s -= gain * before);
        }
        let second = self.part(&rows[1], effect, &spread_after);
        [first, second]
    }

    fn part(&self, row: &Row, effect: Effect, spread: &[f64]) -> Part {
        // What is determined has no covariance with anything.
        let coupling = |(i, &variance): (usize, &f64)| match variance > self.determined {
            true => self.problem.constraints[i].rows.each_ref().map(|row| apply(row, spread)),
            false => [0.0; 2],
        };
        let coupling =
            self.variances.par_iter().enumerate().with_min_len(CHUNK).map(coupling).collect();
        Part { effect, coupling, variance: apply(row, spread) }
    }

    /// How far a value is from the mean of the first row, and then from that of the second.
    fn errors(&self, i: usize, parts: &[Part; 2], value: [i64; 2]) -> [f64; 2] {
        let first = value[0] as f64 - self.means[i][0];
        let second = value[1] as f64 - self.means[i][1] - parts[0].gain(i)[1] * first;
        [first, second]
    }

    /// The mean of a connection after fixing.
    fn moved(&self, j: usize, parts: &[Part; 2], errors: [f64; 2]) -> [f64; 2] {
        let [a, b] = [parts[0].gain(j), parts[1].gain(j)];
        [0, 1].map(|k| self.means[j][k] + a[k] * errors[0] + b[k] * errors[1])
    }

    /// Allowed values of a connection near the one it has, by the energy they cost.
    fn candidates(&self, i: usize, parts: &[Part; 2]) -> Vec<[i64; 2]> {
        let constraint = &self.problem.constraints[i];
        let [u, v] = self.means[i].map(|x| x.round() as i64);
        let cost = |value: [i64; 2]| {
            let errors = self.errors(i, parts, value);
            let of = |k: usize| errors[k] * errors[k] / parts[k].variance.max(self.determined);
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
