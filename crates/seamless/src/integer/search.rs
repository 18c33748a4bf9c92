//! Local search around an integer point.

use super::reduced::Dense;
use super::rounding::RoundingProblem;

/// Most moves in all.
const MOST_MOVES: usize = 300;
/// Moves tried in the order of their energies while constraints are violated.
const TRIED: usize = 300;

/// A coordinate and the step it takes, 1 or -1.
type Move = (usize, i64);

/// Moves single coordinates and pairs of them by one while that lowers the number of violated constraints,
/// or the energy at the same number.
///
/// Pairs matter: the relations at cones couple the coordinates.
pub fn improve(problem: &RoundingProblem, x: Vec<i64>) -> Vec<i64> {
    let mut search = Search::new(problem, x);
    for _ in 0..MOST_MOVES {
        let Some(moves) = search.best_single().or_else(|| search.best_pair()) else { break };
        search.apply(&moves);
    }
    search.x
}

struct Search<'a> {
    problem: &'a RoundingProblem,
    matrix: &'a Dense,
    x: Vec<i64>,
    /// Gradient of the energy.
    gradient: Vec<f64>,
    /// Displacement of each constraint.
    values: Vec<[i64; 2]>,
    violated: usize,
    /// For each constraint the shapes that it takes part in.
    shapes_of: Vec<Vec<usize>>,
    /// For each coordinate the constraints it moves, and how.
    moved: Vec<Vec<(usize, [i64; 2])>>,
    /// A fall of the energy that counts.
    gain: f64,
}

impl<'a> Search<'a> {
    fn new(problem: &'a RoundingProblem, x: Vec<i64>) -> Self {
        let n = x.len();
        let d: Vec<f64> = x.iter().zip(&problem.mean).map(|(&x, m)| x as f64 - m).collect();
        let gradient: Vec<f64> = problem.matrix.multiply(&d).iter().map(|g| 2.0 * g).collect();
        let energy: f64 = 0.5 * gradient.iter().zip(&d).map(|(g, d)| g * d).sum::<f64>();
        let mut moved: Vec<Vec<(usize, [i64; 2])>> = vec![Vec::new(); n];
        let mut values = vec![[0; 2]; problem.constraints.len()];
        for (i, constraint) in problem.constraints.iter().enumerate() {
            for (part, row) in constraint.rows.iter().enumerate() {
                for &(k, c) in row {
                    values[i][part] += c * x[k];
                    match moved[k].last_mut() {
                        Some((last, step)) if *last == i => step[part] += c,
                        _ => {
                            let mut step = [0; 2];
                            step[part] = c;
                            moved[k].push((i, step));
                        }
                    }
                }
            }
        }
        let shapes_of = problem.shapes_of();
        let gain = 1e-6 * energy.abs() + 1e-12;
        let matrix = &problem.matrix;
        let mut search =
            Self { problem, matrix, x, gradient, values, violated: 0, shapes_of, moved, gain };
        let every = 0..problem.constraints.len();
        search.violated = every.filter(|&i| !search.allows(i, search.values[i])).count()
            + (0..problem.shapes.len()).filter(|&k| !search.has_room(k, &[])).count();
        search
    }

    fn allows(&self, i: usize, value: [i64; 2]) -> bool {
        self.problem.constraints[i].allows(value.map(|x| x as f64))
    }

    /// Whether a shape leaves room when some constraints take other values.
    fn has_room(&self, shape: usize, changed: &[(usize, [i64; 2])]) -> bool {
        self.problem.shapes[shape].has_room(|i| {
            let new = changed.iter().find(|(j, _)| *j == i).map(|(_, value)| *value);
            new.unwrap_or(self.values[i]).map(|x| x as f64)
        })
    }

    /// Change of the energy by a single move.
    fn cost(&self, (k, step): Move) -> f64 {
        self.matrix.row(k)[k] + step as f64 * self.gradient[k]
    }

    /// The constraints that some moves change, and their new values.
    fn changed(&self, moves: &[Move]) -> Vec<(usize, [i64; 2])> {
        let mut steps: Vec<(usize, [i64; 2])> = Vec::new();
        for &(k, step) in moves {
            steps.extend(self.moved[k].iter().map(|&(i, [u, v])| (i, [step * u, step * v])));
        }
        steps.sort_unstable();
        let sum = |group: &[(usize, [i64; 2])]| {
            let start = (group[0].0, self.values[group[0].0]);
            group.iter().fold(start, |(i, [u, v]), (_, [a, b])| (i, [u + a, v + b]))
        };
        steps.chunk_by(|a, b| a.0 == b.0).map(sum).collect()
    }

    /// Violated constraints and shapes after some moves.
    fn violated_after(&self, moves: &[Move]) -> usize {
        let changed = self.changed(moves);
        let mut shapes: Vec<usize> =
            changed.iter().flat_map(|(i, _)| &self.shapes_of[*i]).copied().collect();
        shapes.sort_unstable();
        shapes.dedup();
        let before = changed.iter().filter(|(i, _)| !self.allows(*i, self.values[*i])).count()
            + shapes.iter().filter(|k| !self.has_room(**k, &[])).count();
        let after = changed.iter().filter(|(i, value)| !self.allows(*i, *value)).count()
            + shapes.iter().filter(|k| !self.has_room(**k, &changed)).count();
        self.violated - before + after
    }

    /// Whether moves of this energy are worth it.
    fn is_better(&self, cost: f64, moves: &[Move]) -> bool {
        let after = self.violated_after(moves);
        after < self.violated || (after == self.violated && cost < -self.gain)
    }

    /// The first single move worth it, the cheapest first.
    fn best_single(&self) -> Option<Vec<Move>> {
        let moves = (0..self.x.len()).flat_map(|k| [(k, 1), (k, -1)]);
        let mut moves: Vec<(f64, Move)> = moves.map(|m| (self.cost(m), m)).collect();
        if self.violated == 0 {
            moves.retain(|m| m.0 < -self.gain);
        }
        moves.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        moves.truncate(TRIED);
        moves.into_iter().find(|&(cost, m)| self.is_better(cost, &[m])).map(|(_, m)| vec![m])
    }

    /// The coordinates that move a violated constraint, or a shape without room.
    fn involved(&self) -> Vec<bool> {
        let constraints = 0..self.problem.constraints.len();
        let mut is_bad: Vec<bool> = constraints.map(|i| !self.allows(i, self.values[i])).collect();
        for (k, span) in self.problem.shapes.iter().enumerate() {
            if !self.has_room(k, &[]) {
                span.ways.iter().for_each(|&i| is_bad[i] = true);
            }
        }
        self.moved.iter().map(|moved| moved.iter().any(|(i, _)| is_bad[*i])).collect()
    }

    /// The best pair among the cheapest ones; while constraints are violated, of those that touch one.
    fn best_pair(&self) -> Option<Vec<Move>> {
        let limit = if self.violated == 0 { -self.gain } else { f64::INFINITY };
        let involved = if self.violated == 0 { Vec::new() } else { self.involved() };
        let is_involved = |k: usize| self.violated == 0 || involved[k];
        let mut pairs: Vec<(f64, [Move; 2])> = Vec::new();
        for i in 0..self.x.len() {
            let row = self.matrix.row(i);
            for step in [1, -1] {
                let own = self.cost((i, step));
                for (j, entry) in row.iter().enumerate().take(i) {
                    if !is_involved(i) && !is_involved(j) {
                        continue;
                    }
                    for other in [1, -1] {
                        let coupling = 2.0 * (step * other) as f64 * entry;
                        let cost = own + self.cost((j, other)) + coupling;
                        if cost < limit {
                            pairs.push((cost, [(j, other), (i, step)]));
                        }
                    }
                }
            }
        }
        let order =
            |a: &(f64, [Move; 2]), b: &(f64, [Move; 2])| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if pairs.len() > TRIED {
            pairs.select_nth_unstable_by(TRIED, order);
            pairs.truncate(TRIED);
        }
        pairs.sort_by(order);
        let worth = pairs.into_iter().filter(|(cost, moves)| self.is_better(*cost, moves));
        worth.min_by_key(|(_, moves)| self.violated_after(moves)).map(|(_, moves)| moves.to_vec())
    }

    fn apply(&mut self, moves: &[Move]) {
        self.violated = self.violated_after(moves);
        for (i, value) in self.changed(moves) {
            self.values[i] = value;
        }
        for &(k, step) in moves {
            self.x[k] += step;
            let scale = 2.0 * step as f64;
            let row = self.matrix.row(k);
            self.gradient.iter_mut().zip(row).for_each(|(g, p)| *g += scale * p);
        }
    }
}
