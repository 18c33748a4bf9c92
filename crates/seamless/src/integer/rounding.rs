//! Choosing the integers: a closest vector problem in which no connection of cones may collapse.

use super::conditional::{Conditional, Effect, Row, apply, energy};
use super::connections::Connection;
use super::reduced::Dense;
use super::search::improve;
use num_complex::Complex64;
use seamstress_numerics::NotPositiveDefinite;

/// A straight connection of two cones as the rounding sees it: it may neither vanish nor turn around.
#[derive(Debug, Clone)]
pub struct Constraint {
    /// Real and imaginary part of the displacement.
    pub rows: [Row; 2],
    /// The displacement in the seamless map, grid units.
    pub start: [f64; 2],
    /// Length of the connection in the seamless map, grid units.
    pub length: f64,
}

impl Constraint {
    /// From a connection, for coordinates `mean` in grid units and grid size `h`.
    pub fn new(connection: &Connection, mean: &[f64], h: f64) -> Self {
        let mut rows = [Row::new(), Row::new()];
        for (&k, &c) in &connection.displacement {
            let k = 2 * k as usize;
            let [re, im] = &mut rows;
            for (row, column, x) in [(0, k, c.re), (0, k + 1, -c.im), (1, k, c.im), (1, k + 1, c.re)] {
                if x != 0 {
                    let row = if row == 0 { &mut *re } else { &mut *im };
                    row.push((column, x));
                }
            }
        }
        let start = [apply(&rows[0], mean), apply(&rows[1], mean)];
        Self { rows, start, length: connection.length / h }
    }

    /// Whether a displacement with this value is allowed: `D != 0` and `D . D0 > 0`.
    pub fn allows(&self, d: [f64; 2]) -> bool {
        d[0] * d[0] + d[1] * d[1] > 0.5 && d[0] * self.start[0] + d[1] * self.start[1] > 1e-9
    }

    /// Whether the integers allow it.
    pub fn holds(&self, x: &[i64]) -> bool {
        let at = |row: &Row| row.iter().map(|&(k, c)| c * x[k]).sum::<i64>() as f64;
        self.allows([at(&self.rows[0]), at(&self.rows[1])])
    }
}

/// A rounding problem: energy `(x - mean)' P (x - mean)` over integer points that satisfy constraints.
#[derive(Debug, Clone)]
pub struct RoundingProblem {
    /// The matrix P.
    pub matrix: Dense,
    /// The coordinates of the seamless map in grid units, real and imaginary parts by turns.
    pub mean: Vec<f64>,
    /// Connections that must survive.
    pub constraints: Vec<Constraint>,
}

/// Integers for the coordinates.
#[derive(Debug, Clone)]
pub struct Rounded {
    /// Real and imaginary parts by turns.
    pub x: Vec<i64>,
    /// Connections that collapse or turn around.
    pub violated: usize,
    /// Restarts it took.
    pub restarts: usize,
}

/// Connections shorter than this are rounded first, grid units.
const SHORT: f64 = 2.0;
/// Restarts with other priorities.
const MOST_RESTARTS: usize = 5;
/// How much a restart moves a connection forward, grid units of length.
const PRIORITY: f64 = 10.0;
/// Values tried for a connection, the cheapest first.
const TRIED: usize = 8;
/// Values looked at are this many steps around the nearest.
const REACH: i64 = 2;
/// A row whose variance is below this share of the mean is determined.
const DETERMINED: f64 = 1e-9;

/// Rounds one coordinate after the other, the nearest to an integer first, with the others following
/// (Bommes et al. 2009). Pays no heed to the constraints.
///
/// # Errors
/// When the energy is not positive definite.
pub fn round_greedily(problem: &RoundingProblem) -> Result<Rounded, NotPositiveDefinite> {
    let x = Conditional::new(&problem.matrix, problem.mean.clone())?.round_rest();
    let violated = violations(problem, &x).len();
    Ok(Rounded { x, violated, restarts: 0 })
}

/// Rounds the shortest connections first, then the rest, then searches nearby; starts over with other
/// priorities while constraints are violated.
///
/// # Errors
/// When the energy is not positive definite.
pub fn round_constrained(problem: &RoundingProblem) -> Result<Rounded, NotPositiveDefinite> {
    let start = Conditional::new(&problem.matrix, problem.mean.clone())?;
    let mut priority = vec![0.0; problem.constraints.len()];
    let mut best: Option<(usize, f64, Vec<i64>)> = None;
    let mut restarts = 0;
    loop {
        let (conditional, conflicts) = fix_connections(problem, start.clone(), &priority);
        let x = improve(problem, conditional.round_rest());
        let violated = violations(problem, &x);
        let key = (violated.len(), energy(&problem.matrix, &problem.mean, &x));
        if best.as_ref().is_none_or(|b| key < (b.0, b.1)) {
            best = Some((key.0, key.1, x));
        }
        if violated.is_empty() || restarts == MOST_RESTARTS {
            break;
        }
        restarts += 1;
        violated.into_iter().chain(conflicts).for_each(|i| priority[i] += PRIORITY);
    }
    let (violated, _, x) = best.unwrap_or_default();
    Ok(Rounded { x, violated, restarts })
}

/// The constraints that do not hold.
fn violations(problem: &RoundingProblem, x: &[i64]) -> Vec<usize> {
    (0..problem.constraints.len()).filter(|&i| !problem.constraints[i].holds(x)).collect()
}

/// Fixes connections, the shortest as they are now first, at the cheapest value that leaves no determined
/// connection violated; returns those for which there was none as well.
fn fix_connections(
    problem: &RoundingProblem,
    start: Conditional,
    priority: &[f64],
) -> (Conditional, Vec<usize>) {
    let constraints = &problem.constraints;
    let mut fixing = Fixing { constraints, undetermined: DETERMINED * start.mean_variance(), now: start };
    let mut done = vec![false; constraints.len()];
    let mut conflicts = Vec::new();
    loop {
        let candidate = (0..constraints.len())
            .filter(|&i| !done[i])
            .filter_map(|i| {
                let length = fixing.length(i);
                (length < SHORT).then_some((length - priority[i], i))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let Some((_, i)) = candidate else { break };
        done[i] = true;
        if fixing.is_open(i) && !fixing.fix(i) {
            conflicts.push(i);
        }
    }
    (fixing.now, conflicts)
}

struct Fixing<'a> {
    constraints: &'a [Constraint],
    now: Conditional,
    /// Variance below which a value is determined.
    undetermined: f64,
}

impl Fixing<'_> {
    fn value(&self, i: usize) -> [f64; 2] {
        self.constraints[i].rows.each_ref().map(|row| apply(row, self.now.mean()))
    }

    fn length(&self, i: usize) -> f64 {
        let [u, v] = self.value(i);
        u.hypot(v).min(self.constraints[i].length)
    }

    fn is_open(&self, i: usize) -> bool {
        let rows = &self.constraints[i].rows;
        rows.iter().map(|row| self.now.variance(row)).sum::<f64>() > self.undetermined
    }

    /// Fixes a connection; false, and nothing changed, if no value will do.
    fn fix(&mut self, i: usize) -> bool {
        let before = self.now.clone();
        let candidates = self.candidates(i);
        // Which connections a condition determines does not depend on its value.
        let mut determined: Option<Vec<usize>> = None;
        for value in candidates {
            match self.set(i, value) {
                None => break,
                Some(false) => {}
                Some(true) => {
                    let determined = determined.get_or_insert_with(|| {
                        (0..self.constraints.len()).filter(|&j| !self.is_open(j)).collect()
                    });
                    if determined.iter().all(|&j| self.constraints[j].allows(self.value(j))) {
                        return true;
                    }
                }
            }
            self.now = before.clone();
        }
        self.now = before;
        false
    }

    /// Sets both parts of a displacement. None if some integers are impossible whatever the value, false
    /// if this value is.
    fn set(&mut self, i: usize, value: [i64; 2]) -> Option<bool> {
        for (row, value) in self.constraints[i].rows.iter().zip(value) {
            match self.now.effect(row) {
                Effect::Determined => {
                    if (apply(row, self.now.mean()) - value as f64).abs() > 1e-5 {
                        return Some(false);
                    }
                }
                Effect::Free { reduced, pivot } => self.now.fix(row, value, reduced, pivot),
                Effect::NoUnit => return None,
            }
        }
        Some(true)
    }

    /// Allowed values of a connection near the one it has, by the energy they cost.
    fn candidates(&self, i: usize) -> Vec<[i64; 2]> {
        let constraint = &self.constraints[i];
        let now = self.value(i);
        let [a, b] = &constraint.rows;
        let (aa, ab, bb) =
            (self.now.variance(a), self.now.covariance_of(a, b), self.now.variance(b));
        // The inverse of the 2 x 2 covariance, kept away from singular.
        let floor = DETERMINED * (aa + bb);
        let (aa, bb) = (aa + floor, bb + floor);
        let determinant = (aa * bb - ab * ab).max(floor * floor);
        let cost = |v: [i64; 2]| {
            let (x, y) = (v[0] as f64 - now[0], v[1] as f64 - now[1]);
            (bb * x * x - 2.0 * ab * x * y + aa * y * y) / determinant
        };
        let nearest = Complex64::new(now[0].round(), now[1].round());
        let mut values: Vec<[i64; 2]> = (-REACH..=REACH)
            .flat_map(|x| (-REACH..=REACH).map(move |y| [x, y]))
            .map(|[x, y]| [nearest.re as i64 + x, nearest.im as i64 + y])
            .filter(|v| constraint.allows(v.map(|x| x as f64)))
            .collect();
        values.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
        values.truncate(TRIED);
        values
    }
}
