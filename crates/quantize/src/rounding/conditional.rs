//! A quadratic energy under integer conditions that are added one by one.

use crate::linear::{Dense, Row, apply};

/// A condition `row . x = value` in reduced echelon form: its pivot coefficient is 1 or -1 and occurs in no
/// other condition.
#[derive(Debug, Clone)]
struct Condition {
    row: Vec<i64>,
    pivot: usize,
    value: i64,
}

/// What a condition on a row would do.
#[derive(Debug, Clone)]
pub enum Effect {
    /// The conditions so far determine it.
    Determined,
    /// It can be set to any integer: the reduced row, with the pivot it would get.
    Free {
        /// Coefficients after subtracting the conditions so far.
        reduced: Vec<i64>,
        /// A coordinate with coefficient 1 or -1.
        pivot: usize,
    },
    /// No coefficient is 1 or -1, so that not every integer would be possible.
    NoUnit,
}

/// The minimiser of `(x - mean)' P (x - mean)` under conditions, and the covariance around it.
///
/// A condition is a rank-one update of both. In the echelon form every pivot is a unit, so the conditions
/// together with integers for the other coordinates always have an integer solution.
#[derive(Debug, Clone)]
pub struct Conditional {
    mean: Vec<f64>,
    covariance: Dense,
    conditions: Vec<Condition>,
    is_pivot: Vec<bool>,
}

impl Conditional {
    /// Without conditions yet, for an energy of this inverse.
    pub fn new(covariance: Dense, mean: Vec<f64>) -> Self {
        let is_pivot = vec![false; covariance.order];
        Self { mean, covariance, conditions: Vec::new(), is_pivot }
    }

    /// The minimiser under the conditions so far.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Mean variance of a coordinate.
    pub fn mean_variance(&self) -> f64 {
        let n = self.covariance.order;
        self.covariance.trace() / n.max(1) as f64
    }

    /// What a condition on a row would do, perhaps after one more condition of the effect given.
    pub fn effect(&self, row: &Row, after: Option<&Effect>) -> Effect {
        let mut reduced = vec![0; self.mean.len()];
        row.iter().for_each(|&(k, c)| reduced[k] = c);
        let mut reduce = |row: &[i64], pivot: usize| {
            let factor = reduced[pivot] * row[pivot];
            if factor != 0 {
                subtract(&mut reduced, factor, row);
            }
        };
        self.conditions.iter().for_each(|c| reduce(&c.row, c.pivot));
        if let Some(Effect::Free { reduced, pivot }) = after {
            reduce(reduced, *pivot);
        }
        match reduced.iter().position(|c| c.abs() == 1) {
            Some(pivot) => Effect::Free { reduced, pivot },
            None if reduced.iter().all(|&c| c == 0) => Effect::Determined,
            None => Effect::NoUnit,
        }
    }

    /// Covariance of every coordinate with the value of a row.
    pub fn spread(&self, row: &Row) -> Vec<f64> {
        (0..self.mean.len()).map(|i| apply(row, self.covariance.row(i))).collect()
    }

    /// Variance of the value of a row.
    pub fn variance(&self, row: &Row) -> f64 {
        let spread = |&(k, c): &(usize, i64)| c as f64 * apply(row, self.covariance.row(k));
        row.iter().map(spread).sum()
    }

    /// Adds a condition whose effect is [`Effect::Free`].
    pub fn fix(&mut self, row: &Row, value: i64, reduced: Vec<i64>, pivot: usize) {
        let n = self.covariance.order;
        let spread = self.spread(row);
        let variance = apply(row, &spread);
        let error = value as f64 - apply(row, &self.mean);
        for (i, s) in spread.iter().enumerate().filter(|(_, s)| **s != 0.0) {
            let gain = s / variance;
            self.mean[i] += gain * error;
            let target = &mut self.covariance.values[i * n..(i + 1) * n];
            target.iter_mut().zip(&spread).for_each(|(c, s)| *c -= gain * s);
        }
        self.add_condition(row, value, reduced, pivot);
    }

    fn add_condition(&mut self, row: &Row, value: i64, reduced: Vec<i64>, pivot: usize) {
        let mut full = vec![0; self.mean.len()];
        row.iter().for_each(|&(k, c)| full[k] = c);
        let known: i64 =
            self.conditions.iter().map(|c| full[c.pivot] * c.row[c.pivot] * c.value).sum();
        let added = Condition { row: reduced, pivot, value: value - known };
        for condition in &mut self.conditions {
            let factor = condition.row[pivot] * added.row[pivot];
            if factor != 0 {
                subtract(&mut condition.row, factor, &added.row);
                condition.value -= factor * added.value;
            }
        }
        self.is_pivot[pivot] = true;
        self.conditions.push(added);
    }

    /// Rounds the coordinates that no condition has as pivot, the nearest to an integer first; the integer
    /// point that results.
    pub fn round_rest(mut self) -> Vec<i64> {
        let n = self.mean.len();
        loop {
            let off = |k: usize| (self.mean[k] - self.mean[k].round()).abs();
            let next = (0..n)
                .filter(|&k| !self.is_pivot[k])
                .min_by(|&a, &b| off(a).total_cmp(&off(b)).then(a.cmp(&b)));
            let Some(k) = next else { break };
            let row = vec![(k, 1)];
            let mut reduced = vec![0; n];
            reduced[k] = 1;
            // A coordinate that is no pivot occurs in no condition after its own.
            self.fix(&row, self.mean[k].round() as i64, reduced, k);
        }
        let mut x = vec![0; n];
        self.conditions.iter().for_each(|c| x[c.pivot] = c.row[c.pivot] * c.value);
        x
    }
}

fn subtract(target: &mut [i64], factor: i64, row: &[i64]) {
    target.iter_mut().zip(row).for_each(|(t, r)| *t -= factor * r);
}
