//! Choosing the integers: a closest vector problem in which no connection may collapse.

mod apart;
mod basis;
mod conditional;
mod fixing;
mod local;
mod problem;

pub use problem::{Constraint, ReducedEnergy, RoundingProblem, Rule, Violations};

use apart::drawn_apart;
use conditional::Conditional;
use fixing::Fixing;
use seamstress_parametrize::progress::{Cancelled, Watch};

/// Integers for the coordinates.
#[derive(Debug, Clone)]
pub struct Rounding {
    /// One per coordinate.
    pub x: Vec<i64>,
    /// What does not hold there.
    pub violated: Violations,
    /// Energy there.
    pub energy: f64,
    /// Constraints on single displacements that were hard to meet: those to fix earlier next time.
    pub hard: Vec<usize>,
    /// Whether they come from fixing the connections first that were hard to keep.
    pub is_second: bool,
    /// Whether constraints were violated before a repair.
    pub is_repaired: bool,
    /// Passes made.
    pub passes: usize,
}

/// Connections shorter than this are rounded first, grid units.
const SHORT: f64 = 2.0;
/// What the parts of an infeasibility cut count as, grid units: they are rounded after connections that are shorter
/// than a cell.
const PART_OF_CUT: f64 = 1.0;
/// By how much a connection counts as shorter each time that it was hard to keep, grid units: more than any length
/// that counts.
const PRIORITY: f64 = 10.0;
/// Passes at most while constraints stay violated.
const MOST_PASSES: usize = 6;
/// With more violated constraints there is no second pass: this grid, and those nearby, are too coarse.
pub const HOPELESS: usize = 16;

/// Rounds one coordinate after the other, the nearest to an integer first, with the others following
/// (Bommes et al. 2009). Pays no heed to the constraints.
pub fn round_greedily(problem: &RoundingProblem<'_>) -> Vec<i64> {
    Conditional::new(problem.energy.covariance.clone(), problem.mean.clone()).round_rest()
}

/// Draws apart what is too short, rounds the shortest connections first, then the rest, then improves the result by local search; if some connections
/// were hard to keep, once more with these before all others, and again while constraints are violated. Returns what
/// violates least, or has the least energy, after so many passes at most.
///
/// # Errors
/// [`Cancelled`] when the observer breaks.
pub fn round(
    problem: &RoundingProblem<'_>,
    passes: usize,
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, Cancelled> {
    let mut times_hard = vec![0; problem.constraints.len()];
    let start = drawn_apart(problem, watch)?;
    let mut best = round_once(problem, &start, &times_hard, watch)?;
    let mut hard = best.hard.clone();
    for pass in 1..MOST_PASSES.min(passes) {
        let is_enough = pass > 1 && best.violated.count == 0;
        if hard.is_empty() || is_enough || best.violated.count > HOPELESS {
            break;
        }
        hard.into_iter().for_each(|i| times_hard[i] += 1);
        let next = round_once(problem, &start, &times_hard, watch)?;
        hard = next.hard.clone();
        let key = |rounding: &Rounding| (rounding.violated.count, rounding.energy);
        if key(&next) < key(&best) {
            best = Rounding { is_second: true, passes: best.passes, ..next };
        }
        best.passes += 1;
    }
    Ok(best)
}

/// One pass of [`round`], from a point.
fn round_once(
    problem: &RoundingProblem<'_>,
    start: &[f64],
    times_hard: &[u32],
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, Cancelled> {
    let (fixed, conflicts) = fix_short_ones(problem, start, times_hard, watch)?;
    let mut rounding = improve(problem, fixed.round_rest(), watch)?;
    rounding.hard.extend(conflicts);
    rounding.hard.sort_unstable();
    rounding.hard.dedup();
    Ok(rounding)
}

/// Improves integers by local search.
///
/// # Errors
/// [`Cancelled`] when the observer breaks.
pub fn improve(
    problem: &RoundingProblem<'_>,
    x: Vec<i64>,
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, Cancelled> {
    let (x, is_repaired) = local::improve(problem, x, watch)?;
    let (violated, energy) = (problem.violations(&x), problem.energy_at(&x));
    let hard = violated.involved.clone();
    Ok(Rounding { x, violated, energy, hard, is_second: false, is_repaired, passes: 1 })
}

/// Fixes connections around a point, the shortest as they are now first, at the cheapest value that lets no determined one vanish;
/// returns those for which there was none as well.
fn fix_short_ones(
    problem: &RoundingProblem<'_>,
    start: &[f64],
    times_hard: &[u32],
    watch: &mut Watch<'_, '_>,
) -> Result<(Conditional, Vec<usize>), Cancelled> {
    let mut fixing = Fixing::new(problem, start);
    let mut open: Vec<usize> = (0..problem.constraints.len()).collect();
    let mut conflicts = Vec::new();
    loop {
        watch.pulse()?;
        // What is determined stays so.
        open.retain(|&i| fixing.is_open(i));
        let candidate = open
            .iter()
            .filter_map(|&i| {
                let is_free = problem.constraints[i].minimum == 0;
                let length = if is_free { PART_OF_CUT } else { fixing.length(i) };
                (length < SHORT).then_some((length - PRIORITY * f64::from(times_hard[i]), i))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let Some((_, i)) = candidate else { break };
        open.retain(|&j| j != i);
        match fixing.choose(i) {
            Some(choice) => fixing.fix(choice),
            None => conflicts.push(i),
        }
    }
    Ok((fixing.into_conditional(), conflicts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::{Dense, Row};
    use crate::scene::Connection;
    use seamstress_mesh::Vertex;
    use std::ops::ControlFlow;

    /// A positive definite matrix, from a seed.
    fn energy(seed: u64) -> ReducedEnergy {
        let mut rng = seamstress_testkit::Rng::new(seed);
        let factor: Vec<f64> = (0..16).map(|_| rng.unit() - 0.5).collect();
        let entry = |i: usize, j: usize| {
            let product: f64 = (0..4).map(|k| factor[4 * i + k] * factor[4 * j + k]).sum();
            product + if i == j { 0.3 } else { 0.0 }
        };
        let values = (0..16).map(|k| entry(k / 4, k % 4)).collect();
        ReducedEnergy::new(&Dense { order: 4, values }, None, None).unwrap()
    }

    fn mean(seed: u64) -> Vec<f64> {
        let mut rng = seamstress_testkit::Rng::new(seed ^ 0x5eed);
        (0..4).map(|_| 3.0 * (rng.unit() - 0.5)).collect()
    }

    fn line(rows: [Row; 2], length: f64) -> Connection {
        Connection { ends: [Vertex(0), Vertex(1)], length, rows, minimum: 1 }
    }

    /// The difference of two Gaussian integers and the first of them may not vanish.
    fn problem(energy: &ReducedEnergy, mean: Vec<f64>) -> RoundingProblem<'_> {
        let rows: [[Row; 2]; 2] =
            [[vec![(0, 1)], vec![(1, 1)]], [vec![(0, 1), (3, 1)], vec![(1, 1), (2, -1)]]];
        let constraints = rows.map(|rows| Constraint::new(&line(rows, 0.5), &mean, 1.0)).to_vec();
        RoundingProblem { energy, mean, constraints, joint: vec![] }
    }

    fn rounded(problem: &RoundingProblem<'_>) -> Vec<i64> {
        let mut go_on = |_| ControlFlow::Continue(());
        let rounding = round(problem, MOST_PASSES, &mut Watch::new(&mut go_on, 0, 1)).unwrap();
        assert_eq!(rounding.violated, Violations::default());
        assert_eq!(problem.violations(&rounding.x), Violations::default());
        rounding.x
    }

    /// The best integer point within four of the mean that satisfies the constraints.
    fn brute_force(problem: &RoundingProblem<'_>) -> f64 {
        let mut best = f64::INFINITY;
        for code in 0..9i64.pow(4) {
            let digit = |k: u32| code / 9i64.pow(k) % 9 - 4;
            let x: Vec<i64> =
                (0..4).map(|k| problem.mean[k as usize].round() as i64 + digit(k)).collect();
            if problem.violations(&x).count == 0 {
                best = best.min(problem.energy_at(&x));
            }
        }
        best
    }

    #[test]
    fn close_to_the_best_of_all_integer_points() {
        let (mut exact, cases) = (0, 60);
        for seed in 0..cases {
            let energy = energy(seed);
            let problem = problem(&energy, mean(seed));
            let (found, best) = (problem.energy_at(&rounded(&problem)), brute_force(&problem));
            assert!(found >= best - 1e-12);
            assert!(found <= 2.0 * best + 1e-12, "seed {seed}: {found} against {best}");
            exact += usize::from(found <= best + 1e-9);
        }
        assert!(10 * exact >= 8 * cases as usize, "{exact} of {cases} are the best");
    }

    #[test]
    fn triangles_of_cones_keep_their_orientation() {
        for seed in 0..40 {
            let energy = energy(seed);
            // the sides of a thin triangle, which would both round to 1
            let mean = vec![0.6, 0.0, 0.6, 0.3];
            let side = |k: usize| {
                let rows = [vec![(2 * k, 1)], vec![(2 * k + 1, 1)]];
                Constraint::new(&line(rows, 0.6), &mean, 1.0)
            };
            let problem = problem(&energy, mean.clone());
            let mut problem = RoundingProblem { constraints: Vec::new(), ..problem };
            problem.add([0, 1].map(side).into_iter(), Rule::Oriented);
            let x = rounded(&problem);
            let [a, b] = [0, 1].map(|k| problem.constraints[k].at(&x));
            assert!(a[0] * b[1] - a[1] * b[0] > 0, "seed {seed}: {a:?} {b:?}");
        }
    }

    #[test]
    fn points_end_beyond_a_cut() {
        for seed in 0..40 {
            let energy = energy(seed);
            let mut problem = problem(&energy, mean(seed));
            let forces: [f64; 2] = [0.6, 0.8];
            let rows = problem.constraints[0].rows.clone();
            let along = |x: &[i64]| {
                let [u, v] = rows.each_ref().map(|row| crate::linear::apply_exactly(row, x) as f64);
                forces[0] * u + forces[1] * v
            };
            let bound = along(&rounded(&problem)) + 0.25;
            let parts = rows.clone().map(Constraint::free).into_iter();
            problem.add(parts, Rule::Beyond { forces: forces.into(), bound });
            let x = rounded(&problem);
            assert!(along(&x) > bound, "seed {seed}");
        }
    }

    #[test]
    fn a_loop_is_as_long_as_it_has_to_be() {
        for (seed, minimum) in (0..20).flat_map(|seed| [(seed, 1), (seed, 2), (seed, 3)]) {
            let energy = energy(seed);
            let mut problem = problem(&energy, mean(seed));
            problem.constraints[1].minimum = minimum;
            let [u, v] = problem.constraints[1].at(&rounded(&problem));
            assert!(u.abs() + v.abs() >= minimum, "seed {seed}");
        }
    }

    #[test]
    fn what_is_nearly_right_is_repaired() {
        for seed in 0..20 {
            let energy = energy(seed);
            let problem = problem(&energy, mean(seed));
            let mut go_on = |_| ControlFlow::Continue(());
            let mut watch = Watch::new(&mut go_on, 0, 1);
            let rounding = improve(&problem, vec![0; 4], &mut watch).unwrap();
            assert_eq!(rounding.violated, Violations::default(), "seed {seed}");
        }
    }

    #[test]
    fn greedy_pays_no_heed_to_connections() {
        let energy = energy(1);
        let problem = problem(&energy, vec![0.2, 0.1, 0.3, -0.2]);
        assert!(problem.violations(&round_greedily(&problem)).count > 0);
        rounded(&problem);
    }
}
