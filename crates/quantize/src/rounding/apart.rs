//! The nearest real point where nothing is too short.

use super::problem::{Constraint, RoundingProblem, Rule};
use crate::linear::{Dense, Row};
use seamstress_parametrize::progress::{Cancelled, Watch};
use std::collections::BTreeMap;

/// What a displacement may be too short by, grid units: far less than rounding moves it.
const TOLERANCE: f64 = 0.02;
/// Steps that change a displacement by less are none, grid units.
const SMALLEST_STEP: f64 = 0.004;
/// Times that half-planes are added, and sweeps over them each time. Most points take a few of both; where no point is
/// far enough in all half-planes, the one found is a start as good as others.
const MOST_ROUNDS: usize = 10;
const MOST_SWEEPS: usize = 30;
/// How much easier a half-plane gives way than its energy says, as a share: those that contradict each other share what
/// is missing.
const YIELDING: f64 = 1e-3;
/// The tangent of an eighth of a half turn: a displacement nearer to an axis has to keep its length along it, any other
/// one the sum of its parts.
const NEAR_AXIS: f64 = std::f64::consts::SQRT_2 - 1.0;

/// A linear form with real coefficients.
type RealRow = Vec<(usize, f64)>;

/// Points where a form is at least a bound.
struct HalfPlane {
    row: RealRow,
    bound: f64,
}

/// A half-plane that was violated, in the dual of the quadratic program.
struct Active<'a> {
    of: &'a HalfPlane,
    /// Covariance of every coordinate with the row.
    spread: Vec<f64>,
    variance: f64,
    multiplier: f64,
}

impl<'a> Active<'a> {
    fn new(of: &'a HalfPlane, covariance: &Dense) -> Self {
        let spread: Vec<f64> =
            (0..covariance.order).map(|i| value(&of.row, covariance.row(i))).collect();
        let variance = (1.0 + YIELDING) * value(&of.row, &spread);
        Self { of, spread, variance, multiplier: 0.0 }
    }

    /// Moves a point to the half-plane, or back as far as it was moved for it; by how much.
    fn meet(&mut self, x: &mut [f64]) -> f64 {
        let given_way = YIELDING * self.variance * self.multiplier;
        let missing = self.of.bound - value(&self.of.row, x) - given_way;
        let step = (missing / self.variance).max(-self.multiplier);
        if step != 0.0 {
            self.multiplier += step;
            x.iter_mut().zip(&self.spread).for_each(|(x, s)| *x += step * s);
        }
        (step * self.variance).abs()
    }
}

/// The point of the least energy where every displacement is as long as it has to be, in the direction that it has: what
/// is too short is drawn apart all at once, before the first of it is rounded. The conditions are those of the integers
/// but for the corners of triangles.
///
/// # Source
/// Hildreth 1957, *A quadratic programming procedure*, on half-planes that are added when they are violated.
///
/// # Errors
/// [`Cancelled`] when the observer breaks.
pub(super) fn drawn_apart(
    problem: &RoundingProblem<'_>,
    watch: &mut Watch<'_, '_>,
) -> Result<Vec<f64>, Cancelled> {
    let single = problem.constraints.iter().filter_map(half_plane);
    let half_planes: Vec<HalfPlane> = single.chain(cuts(problem)).collect();
    let mut is_active = vec![false; half_planes.len()];
    let mut active: Vec<Active<'_>> = Vec::new();
    let mut x = problem.mean.clone();
    for _ in 0..MOST_ROUNDS {
        watch.pulse()?;
        let before = active.len();
        for (half_plane, is_active) in half_planes.iter().zip(&mut is_active) {
            let missing = half_plane.bound - value(&half_plane.row, &x);
            if missing > TOLERANCE && !*is_active {
                *is_active = true;
                active.push(Active::new(half_plane, &problem.energy.covariance));
            }
        }
        let mut largest = f64::INFINITY;
        for _ in 0..MOST_SWEEPS {
            largest = active.iter_mut().map(|active| active.meet(&mut x)).fold(0.0, f64::max);
            if largest < SMALLEST_STEP {
                break;
            }
        }
        if active.len() == before && largest < SMALLEST_STEP {
            break;
        }
    }
    Ok(x)
}

/// Where a displacement is long enough and does not turn around: the half-plane of those that are on the side it is
/// on, a part of the allowed ones.
fn half_plane(constraint: &Constraint) -> Option<HalfPlane> {
    let [u, v] = constraint.direction.filter(|_| constraint.minimum > 0)?;
    let sign = |along: f64, across: f64| match along.abs() < NEAR_AXIS * across.abs() {
        true => 0.0,
        false => along.signum(),
    };
    let row = combination(constraint.rows.iter().zip([sign(u, v), sign(v, u)]));
    Some(HalfPlane { row, bound: constraint.minimum as f64 })
}

/// Those of infeasibility cuts.
fn cuts<'a>(problem: &'a RoundingProblem<'_>) -> impl Iterator<Item = HalfPlane> + 'a {
    problem.joint.iter().filter_map(|(members, rule)| match rule {
        Rule::Oriented => None,
        Rule::Beyond { forces, bound } => {
            let rows = problem.constraints[members.clone()].iter().map(|member| &member.rows[0]);
            Some(HalfPlane { row: combination(rows.zip(forces.iter().copied())), bound: *bound })
        }
    })
}

/// The sum of multiples of rows.
fn combination<'a>(rows: impl Iterator<Item = (&'a Row, f64)>) -> RealRow {
    let mut sum = BTreeMap::<usize, f64>::new();
    for (row, factor) in rows.filter(|&(_, factor)| factor != 0.0) {
        row.iter().for_each(|&(k, c)| *sum.entry(k).or_default() += factor * c as f64);
    }
    sum.into_iter().filter(|&(_, c)| c != 0.0).collect()
}

/// The value of a form at a point.
fn value(row: &RealRow, x: &[f64]) -> f64 {
    row.iter().map(|&(k, c)| c * x[k]).sum()
}
