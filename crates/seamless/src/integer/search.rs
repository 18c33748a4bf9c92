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
    is_violated: Vec<bool>,
    violated: usize,
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
        let is_violated: Vec<bool> = values
            .iter()
            .zip(&problem.constraints)
            .map(|(v, c)| !c.allows(v.map(|x| x as f64)))
            .collect();
        let violated = is_violated.iter().filter(|v| **v).count();
        let gain = 1e-6 * energy.abs() + 1e-12;
        let matrix = &problem.matrix;
        Self { problem, matrix, x, gradient, values, is_violated, violated, moved, gain }
    }

    /// Change of the energy by a single move.
    fn cost(&self, (k, step): Move) -> f64 {
        self.matrix.row(k)[k] + step as f64 * self.gradient[k]
    }

    /// Violated constraints after some moves.
    fn violated_after(&self, moves: &[Move]) -> usize {
        let mut touched: Vec<(usize, [i64; 2])> = Vec::new();
        for &(k, step) in moves {
            touched.extend(self.moved[k].iter().map(|&(i, [u, v])| (i, [step * u, step * v])));
        }
        touched.sort_unstable();
        let mut count = self.violated;
        for group in touched.chunk_by(|a, b| a.0 == b.0) {
            let i = group[0].0;
            let mut value = self.values[i];
            group.iter().for_each(|(_, [u, v])| value = [value[0] + u, value[1] + v]);
            let allowed = self.problem.constraints[i].allows(value.map(|x| x as f64));
            match (self.is_violated[i], allowed) {
                (true, true) => count -= 1,
                (false, false) => count += 1,
                _ => {}
            }
        }
        count
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

    /// The best pair among the cheapest ones.
    fn best_pair(&self) -> Option<Vec<Move>> {
        let limit = if self.violated == 0 { -self.gain } else { f64::INFINITY };
        let mut pairs: Vec<(f64, [Move; 2])> = Vec::new();
        for i in 0..self.x.len() {
            let row = self.matrix.row(i);
            for step in [1, -1] {
                let own = self.cost((i, step));
                for j in 0..i {
                    for other in [1, -1] {
                        let coupling = 2.0 * (step * other) as f64 * row[j];
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
        for &(k, step) in moves {
            self.x[k] += step;
            let row = self.matrix.row(k);
            let scale = 2.0 * step as f64;
            self.gradient.iter_mut().zip(row).for_each(|(g, p)| *g += scale * p);
            for &(i, [u, v]) in &self.moved[k] {
                self.values[i] = [self.values[i][0] + step * u, self.values[i][1] + step * v];
                let allowed = self.problem.constraints[i].allows(self.values[i].map(|x| x as f64));
                self.is_violated[i] = !allowed;
            }
        }
        self.violated = self.is_violated.iter().filter(|v| **v).count();
    }
}
