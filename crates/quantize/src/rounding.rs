//! Choosing the integers: a closest vector problem in which no connection of cones may collapse.

use super::conditional::{Conditional, Row, apply, energy};
use super::fixing::Fixing;
use super::moves::Moves;
use super::outcome::IntegerFailure;
use super::reduced::Dense;
use super::scene::Connection;
use super::search::improve;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_parametrize::progress::{Cancelled, Watch};
use std::ops::Range;

/// A connection as the rounding sees it: it may neither vanish nor turn around.
#[derive(Debug, Clone)]
pub struct Constraint {
    /// Real and imaginary part of the displacement.
    pub rows: [Row; 2],
    /// The displacement where the connection was found, grid units.
    pub start: [f64; 2],
    /// Length of the connection there, grid units.
    pub length: f64,
    /// Grid units that a walk along the grid from one end to the other has at least; with 0 anything is allowed.
    pub least: i64,
}

impl Constraint {
    /// From a connection, for coordinates `from` of the layout where it was found and grid size `h`, both
    /// in the layout's units.
    pub fn new(connection: &Connection, from: &[f64], h: f64) -> Self {
        let rows = connection.rows.clone();
        let start = [apply(&rows[0], from) / h, apply(&rows[1], from) / h];
        Self { rows, start, length: connection.length / h, least: connection.least }
    }

    /// Whether a displacement with this value is allowed: far enough, and `D . D0 > 0`; any if it may vanish.
    pub fn allows(&self, d: [f64; 2]) -> bool {
        self.least == 0
            || d[0].abs() + d[1].abs() > self.least as f64 - 0.5
                && d[0] * self.start[0] + d[1] * self.start[1] > 1e-9
    }

    /// The displacement at integers.
    pub fn at(&self, x: &[i64]) -> [f64; 2] {
        self.rows.each_ref().map(|row| row.iter().map(|&(k, c)| c * x[k]).sum::<i64>() as f64)
    }

    /// Whether the integers allow it.
    pub fn holds(&self, x: &[i64]) -> bool {
        self.allows(self.at(x))
    }
}

/// A rounding problem: energy `(x - mean)' P (x - mean)` over integer points that satisfy constraints.
#[derive(Debug, Clone)]
pub struct RoundingProblem {
    /// The matrix P.
    pub matrix: Dense,
    /// Steps along which the search moves.
    pub moves: Moves,
    /// The coordinates of the seamless map in grid units.
    pub mean: Vec<f64>,
    /// Connections that must survive.
    pub constraints: Vec<Constraint>,
    /// What several of them span must leave room for a vertex.
    pub spans: Vec<Span>,
}

impl RoundingProblem {
    /// Adds points that must leave room, with the ways from the origin to the others.
    pub fn add(&mut self, ways: Vec<Constraint>, room: Room) {
        let first = self.constraints.len();
        self.constraints.extend(ways);
        self.spans.push(Span { ways: first..self.constraints.len(), room });
    }

    /// For each constraint the span that it is a way of, by number.
    pub(super) fn span_of(&self) -> Vec<Option<usize>> {
        let mut span_of = vec![None; self.constraints.len()];
        for (k, span) in self.spans.iter().enumerate() {
            span_of[span.ways.clone()].fill(Some(k));
        }
        span_of
    }
}

/// What several ways must leave room for, or lead beyond.
#[derive(Debug, Clone)]
pub struct Span {
    /// The constraints that lead from the origin to the other points, or the ways of a wall, by number.
    pub ways: Range<usize>,
    /// What there must be room for.
    pub room: Room,
}

/// What points must leave room for.
#[derive(Debug, Clone)]
pub enum Room {
    /// A triangle of the mesh, the origin its first corner: the other two are in order around it.
    Face,
    /// Collapsing triangles, whose forces the points have to follow further than this; see [`super::walls::Wall`].
    Wall {
        /// One for each way.
        forces: Vec<f64>,
        /// The sum over all ways of force times the first part of the displacement has to be more.
        more_than: f64,
    },
}

impl Span {
    /// Whether there is room when the constraints have these displacements.
    pub fn has_room(&self, displacement: impl Fn(usize) -> [f64; 2]) -> bool {
        match &self.room {
            Room::Wall { forces, more_than } => {
                along(forces, self.ways.clone().map(displacement)) > *more_than
            }
            Room::Face => {
                let [[a, b], [c, d]] = [0, 1].map(|k| displacement(self.ways.start + k));
                a * d - b * c > LEFT_TURN
            }
        }
    }
}

/// How far displacements are along forces, in all.
pub(super) fn along(forces: &[f64], displacements: impl Iterator<Item = [f64; 2]>) -> f64 {
    displacements.zip(forces).map(|([u, _], force)| force * u).sum()
}

/// Twice the area of a triangle of grid points is an integer; a positive one is above this.
const LEFT_TURN: f64 = 0.5;

/// Integers for the coordinates.
#[derive(Debug, Clone)]
pub struct Rounded {
    /// One per coordinate.
    pub x: Vec<i64>,
    /// Connections that collapse or turn around, and spans without room.
    pub violated: usize,
    /// Restarts it took.
    pub restarts: usize,
}

/// Connections with less to spare than this are rounded first, grid units.
const SHORT: f64 = 2.0;
/// Restarts with other priorities.
const MOST_RESTARTS: usize = 5;
/// More violated connections than this are left to a finer grid.
pub(super) const HOPELESS: usize = 16;
/// How much a restart moves a connection forward, grid units of length.
const PRIORITY: f64 = 10.0;

/// Rounds one coordinate after the other, the nearest to an integer first, with the others following
/// (Bommes et al. 2009). Pays no heed to the constraints.
///
/// # Errors
/// When the energy is not positive definite.
pub fn round_greedily(problem: &RoundingProblem) -> Result<Rounded, NotPositiveDefinite> {
    let x = Conditional::new(&problem.matrix, problem.mean.clone())?.round_rest();
    let violated = violations(problem, &x).0;
    Ok(Rounded { x, violated, restarts: 0 })
}

/// Rounds the shortest connections first, then the rest, then searches nearby; starts over with other
/// priorities while constraints are violated.
///
/// # Errors
/// When the energy is not positive definite, or the observer breaks.
pub fn round_constrained(
    problem: &RoundingProblem,
    watch: &mut Watch<'_, '_>,
) -> Result<Rounded, IntegerFailure> {
    let start = Conditional::new(&problem.matrix, problem.mean.clone())?;
    let mut priority = vec![0.0; problem.constraints.len()];
    let mut best: Option<(usize, f64, Vec<i64>)> = None;
    let mut restarts = 0;
    loop {
        let (conditional, conflicts) = fix_connections(problem, start.clone(), &priority, watch)?;
        let x = improve(problem, conditional.round_rest(), watch)?;
        let (violated, involved) = violations(problem, &x);
        let key = (violated, energy(&problem.matrix, &problem.mean, &x));
        if best.as_ref().is_none_or(|b| key < (b.0, b.1)) {
            best = Some((key.0, key.1, x));
        }
        if violated == 0 || violated > HOPELESS || restarts == MOST_RESTARTS {
            break;
        }
        restarts += 1;
        involved.into_iter().chain(conflicts).for_each(|i| priority[i] += PRIORITY);
    }
    let (violated, _, x) = best.unwrap_or_default();
    Ok(Rounded { x, violated, restarts })
}

/// How many constraints and spans do not hold, and the constraints that have a part in it.
fn violations(problem: &RoundingProblem, x: &[i64]) -> (usize, Vec<usize>) {
    let constraints = &problem.constraints;
    let mut involved: Vec<usize> =
        (0..constraints.len()).filter(|&i| !constraints[i].holds(x)).collect();
    let is_full = |span: &&Span| !span.has_room(|i| constraints[i].at(x));
    let full: Vec<&Span> = problem.spans.iter().filter(is_full).collect();
    let violated = involved.len() + full.len();
    involved.extend(full.into_iter().flat_map(|span| span.ways.clone()));
    (violated, involved)
}

/// Fixes connections, the shortest as they are now first, at the cheapest value that leaves no determined
/// connection violated; returns those for which there was none as well.
fn fix_connections(
    problem: &RoundingProblem,
    start: Conditional,
    priority: &[f64],
    watch: &mut Watch<'_, '_>,
) -> Result<(Conditional, Vec<usize>), Cancelled> {
    let constraints = &problem.constraints;
    let mut fixing = Fixing::new(problem, start);
    let mut open: Vec<usize> = (0..constraints.len()).collect();
    let mut conflicts = Vec::new();
    loop {
        watch.pulse()?;
        // What is determined stays so.
        open.retain(|&i| fixing.is_open(i));
        let candidate = open
            .iter()
            .filter_map(|&i| {
                let length = fixing.length(i);
                let slack = length - (constraints[i].least - 1) as f64;
                (slack < SHORT).then_some((slack - priority[i], i))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let Some((_, i)) = candidate else { break };
        open.retain(|&j| j != i);
        if !fixing.fix(i) {
            conflicts.push(i);
        }
    }
    Ok((fixing.into_conditional(), conflicts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conditional::energy;
    use std::ops::ControlFlow;

    /// A positive definite matrix and a mean of two Gaussian integers, from a seed.
    fn problem(seed: u64) -> RoundingProblem {
        let mut rng = seamstress_testkit::Rng::new(seed);
        let factor: Vec<f64> = (0..16).map(|_| rng.unit() - 0.5).collect();
        let entry = |i: usize, j: usize| {
            let product: f64 = (0..4).map(|k| factor[4 * i + k] * factor[4 * j + k]).sum();
            product + if i == j { 0.3 } else { 0.0 }
        };
        let values = (0..16).map(|k| entry(k / 4, k % 4)).collect();
        let mean: Vec<f64> = (0..4).map(|_| 3.0 * (rng.unit() - 0.5)).collect();
        let connection = |re: &[(usize, i64)], im: &[(usize, i64)]| Connection {
            length: 0.5,
            rows: [re.to_vec(), im.to_vec()],
            least: 1,
        };
        let sum = connection(&[(0, 1), (3, 1)], &[(1, 1), (2, -1)]);
        let connections = [connection(&[(0, 1)], &[(1, 1)]), sum];
        let constraints = connections.iter().map(|c| Constraint::new(c, &mean, 1.0)).collect();
        let matrix = Dense { order: 4, values };
        let moves = Moves::reduced(&matrix, &[0.0; 4]);
        RoundingProblem { matrix, moves, mean, constraints, spans: vec![] }
    }

    fn rounded(problem: &RoundingProblem) -> Rounded {
        let mut go_on = |_| ControlFlow::Continue(());
        round_constrained(problem, &mut Watch::new(&mut go_on, 0, 1)).unwrap()
    }

    /// The best integer point within four of the mean that satisfies the constraints.
    fn brute_force(problem: &RoundingProblem) -> f64 {
        let mut best = f64::INFINITY;
        for code in 0..9i64.pow(4) {
            let digit = |k: u32| code / 9i64.pow(k) % 9 - 4;
            let x: Vec<i64> =
                (0..4).map(|k| problem.mean[k as usize].round() as i64 + digit(k)).collect();
            if problem.constraints.iter().all(|c| c.holds(&x)) {
                best = best.min(energy(&problem.matrix, &problem.mean, &x));
            }
        }
        best
    }

    #[test]
    fn close_to_the_best_of_all_integer_points() {
        let (mut exact, cases) = (0, 60);
        for seed in 0..cases {
            let problem = problem(seed);
            let rounded = rounded(&problem);
            assert_eq!(rounded.violated, 0, "seed {seed}");
            assert!(problem.constraints.iter().all(|c| c.holds(&rounded.x)), "seed {seed}");
            let (found, best) =
                (energy(&problem.matrix, &problem.mean, &rounded.x), brute_force(&problem));
            assert!(found >= best - 1e-12);
            assert!(found <= 2.0 * best + 1e-12, "seed {seed}: {found} against {best}");
            exact += usize::from(found <= best + 1e-9);
        }
        assert!(10 * exact >= 8 * cases as usize, "{exact} of {cases} are the best");
    }

    #[test]
    fn triangles_of_cones_keep_their_orientation() {
        for seed in 0..40 {
            let mut problem = problem(seed);
            // the sides of a thin triangle, which would both round to 1
            problem.mean = vec![0.6, 0.0, 0.6, 0.3];
            let side = |k: usize| Connection {
                length: 0.6,
                rows: [vec![(2 * k, 1)], vec![(2 * k + 1, 1)]],
                least: 1,
            };
            problem.constraints =
                [0, 1].map(|k| Constraint::new(&side(k), &problem.mean, 1.0)).to_vec();
            problem.spans = vec![Span { ways: 0..2, room: Room::Face }];
            let rounded = rounded(&problem);
            let [a, b] = [0, 1].map(|k| problem.constraints[k].at(&rounded.x));
            let cross = a[0] * b[1] - a[1] * b[0];
            assert!(rounded.violated == 0 && cross > 0.0, "seed {seed}: {a:?} {b:?}");
        }
    }

    #[test]
    fn points_end_beyond_a_wall() {
        for seed in 0..40 {
            let mut problem = problem(seed);
            let free = rounded(&problem);
            let way = problem.constraints[0].clone();
            let forces = vec![0.6, 0.8];
            let along = |x: &[i64]| {
                let [u, v] = way.at(x);
                forces[0] * u + forces[1] * v
            };
            let more_than = along(&free.x) + 0.25;
            let part = |row: &Row| {
                let rows = [row.clone(), Row::new()];
                Constraint { rows, least: 0, ..way.clone() }
            };
            let room = Room::Wall { forces: forces.clone(), more_than };
            problem.add(way.rows.iter().map(part).collect(), room);
            let rounded = rounded(&problem);
            assert!(rounded.violated == 0 && along(&rounded.x) > more_than, "seed {seed}");
        }
    }

    #[test]
    fn a_loop_is_as_long_as_it_has_to_be() {
        for (seed, least) in (0..20).flat_map(|seed| [(seed, 1), (seed, 2), (seed, 3)]) {
            let mut problem = problem(seed);
            problem.constraints[1].least = least;
            let rounded = rounded(&problem);
            let [u, v] = problem.constraints[1].at(&rounded.x);
            assert!(rounded.violated == 0 && u.abs() + v.abs() >= least as f64, "seed {seed}");
        }
    }

    #[test]
    fn greedy_pays_no_heed_to_connections() {
        let mut problem = problem(1);
        problem.mean = vec![0.2, 0.1, 0.3, -0.2];
        problem.constraints = problem
            .constraints
            .iter()
            .map(|c| Constraint { start: [0.2, 0.1], ..c.clone() })
            .collect();
        assert!(round_greedily(&problem).unwrap().violated > 0);
        assert_eq!(rounded(&problem).violated, 0);
    }
}
