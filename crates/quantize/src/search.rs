//! Local search around an integer point.

use super::conditional::{Row, apply};
use super::reduced::Dense;
use super::rounding::RoundingProblem;
use seamstress_parametrize::progress::{Cancelled, Watch};

/// Most moves in all.
const MOST_MOVES: usize = 300;
/// Moves tried in the order of their energies while constraints are violated.
const TRIED: usize = 300;
/// Steps of a repair. Those that succeed take less than a third of it.
const MOST_REPAIRS: usize = 1000;
/// What energy counts in a repair against a violated constraint of weight one; a step along a usual
/// coordinate costs about one.
const ENERGY_WEIGHT: f64 = 0.05;

/// A vector of the basis and how often it is added, 1 or -1.
type Move = (usize, i64);

/// Takes steps along single vectors of the reduced basis and pairs of them while that lowers the number of
/// violated constraints, or the energy at the same number; where constraints stay violated, repairs them at
/// the cost of energy first.
///
/// # Errors
/// [`Cancelled`] when the observer breaks.
pub fn improve(
    problem: &RoundingProblem,
    x: Vec<i64>,
    watch: &mut Watch<'_, '_>,
) -> Result<Vec<i64>, Cancelled> {
    let mut search = Search::new(problem, x);
    search.descend(watch)?;
    if search.violated > 0 && search.repair(watch)? {
        search.descend(watch)?;
    }
    Ok(search.x)
}

struct Search<'a> {
    problem: &'a RoundingProblem,
    /// The energy on multiples of the basis.
    matrix: &'a Dense,
    x: Vec<i64>,
    /// Gradient of the energy along the vectors of the basis.
    gradient: Vec<f64>,
    /// Displacement of each constraint.
    values: Vec<[i64; 2]>,
    violated: usize,
    /// What violating each constraint counts in a repair, and after these each span.
    weights: Vec<f64>,
    /// The span that each constraint is a way of.
    span_of: Vec<Option<usize>>,
    /// For each vector of the basis the constraints it moves, and how.
    moved: Vec<Vec<(usize, [i64; 2])>>,
    /// A fall of the energy that counts.
    gain: f64,
}

impl<'a> Search<'a> {
    fn new(problem: &'a RoundingProblem, x: Vec<i64>) -> Self {
        let d: Vec<f64> = x.iter().zip(&problem.mean).map(|(&x, m)| x as f64 - m).collect();
        let slope: Vec<f64> = problem.matrix.multiply(&d).iter().map(|g| 2.0 * g).collect();
        let energy: f64 = 0.5 * slope.iter().zip(&d).map(|(g, d)| g * d).sum::<f64>();
        let basis = &problem.moves;
        let gradient: Vec<f64> = basis.vectors.iter().map(|row| apply(row, &slope)).collect();
        let values = problem.constraints.iter().map(|c| c.at(&x).map(|u| u as i64)).collect();
        let moved = moved(problem);
        let span_of = problem.span_of();
        let gain = 1e-6 * energy.abs() + 1e-12;
        let matrix = &basis.matrix;
        let weights = vec![1.0; problem.constraints.len() + problem.spans.len()];
        let violated = 0;
        let mut search =
            Self { problem, matrix, x, gradient, values, violated, weights, span_of, moved, gain };
        let every = 0..problem.constraints.len();
        search.violated = every.filter(|&i| !search.allows(i, search.values[i])).count()
            + (0..problem.spans.len()).filter(|&k| !search.has_room(k, &[])).count();
        search
    }

    fn allows(&self, i: usize, value: [i64; 2]) -> bool {
        self.problem.constraints[i].allows(value.map(|x| x as f64))
    }

    /// Whether a span leaves room when some constraints, in ascending order, take other values.
    fn has_room(&self, span: usize, changed: &[(usize, [i64; 2])]) -> bool {
        self.problem.spans[span].has_room(|i| {
            let new = changed.binary_search_by_key(&i, |&(j, _)| j).map(|at| changed[at].1);
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

    /// Violated constraints and spans after some moves, and the change of their weight.
    fn after(&self, moves: &[Move]) -> (usize, f64) {
        let changed = self.changed(moves);
        let mut spans: Vec<usize> = changed.iter().filter_map(|(i, _)| self.span_of[*i]).collect();
        spans.sort_unstable();
        spans.dedup();
        let (mut count, mut weight) = (self.violated, 0.0);
        let mut note = |was_good: bool, is_good: bool, by: f64| match (was_good, is_good) {
            (true, false) => (count, weight) = (count + 1, weight + by),
            (false, true) => (count, weight) = (count - 1, weight - by),
            _ => {}
        };
        for &(i, value) in &changed {
            note(self.allows(i, self.values[i]), self.allows(i, value), self.weights[i]);
        }
        for k in spans {
            let weight = self.weights[self.values.len() + k];
            note(self.has_room(k, &[]), self.has_room(k, &changed), weight);
        }
        (count, weight)
    }

    /// Violated constraints and spans after some moves.
    fn violated_after(&self, moves: &[Move]) -> usize {
        self.after(moves).0
    }

    /// Steps as long as they pay.
    fn descend(&mut self, watch: &mut Watch<'_, '_>) -> Result<(), Cancelled> {
        for _ in 0..MOST_MOVES {
            watch.pulse()?;
            let Some(moves) = self.best_single().or_else(|| self.best_pair()) else { break };
            self.apply(&moves);
        }
        Ok(())
    }

    /// Looks at one violated constraint after the other and takes the step among those that move it that
    /// lowers the weight of all violated ones most; if none does, it gets more weight. True if all
    /// constraints hold in the end; otherwise the fewest violated ones found are left.
    ///
    /// # Source
    /// Morris 1993, *The breakout method for escaping from local minima*.
    fn repair(&mut self, watch: &mut Watch<'_, '_>) -> Result<bool, Cancelled> {
        let (n, all) = (self.problem.constraints.len(), self.problem.spans.len());
        let touching = self.touching();
        let mut best = (self.violated, self.x.clone());
        let mut at = 0;
        for _ in 0..MOST_REPAIRS {
            watch.pulse()?;
            if self.violated == 0 {
                return Ok(true);
            }
            let is_bad = |&i: &usize| match i.checked_sub(n) {
                None => !self.allows(i, self.values[i]),
                Some(k) => !self.has_room(k, &[]),
            };
            let next = (0..n + all).map(|k| (at + k) % (n + all)).find(is_bad);
            let Some(target) = next else { break };
            at = target + 1;
            let vectors: Vec<usize> = match target.checked_sub(n) {
                None => touching[target].clone(),
                Some(k) => {
                    let ways = self.problem.spans[k].ways.clone();
                    let mut all: Vec<usize> = ways.flat_map(|i| touching[i].clone()).collect();
                    all.sort_unstable();
                    all.dedup();
                    all
                }
            };
            let worth = vectors
                .iter()
                .flat_map(|&k| [(k, 1), (k, -1)])
                .map(|step| (self.after(&[step]).1 + ENERGY_WEIGHT * self.cost(step), step));
            match worth.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) {
                Some((change, step)) if change < -1e-9 => {
                    self.apply(&[step]);
                    if self.violated < best.0 {
                        best = (self.violated, self.x.clone());
                    }
                }
                _ => self.weights[target] += 1.0,
            }
        }
        self.x = best.1;
        Ok(self.violated == 0)
    }

    /// For each constraint the vectors of the basis that move it.
    fn touching(&self) -> Vec<Vec<usize>> {
        let mut touching = vec![Vec::new(); self.problem.constraints.len()];
        for (k, moved) in self.moved.iter().enumerate() {
            moved.iter().for_each(|&(i, _)| touching[i].push(k));
        }
        touching
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

    /// The coordinates that move a violated constraint, or a span without room.
    fn involved(&self) -> Vec<bool> {
        let constraints = 0..self.problem.constraints.len();
        let mut is_bad: Vec<bool> = constraints.map(|i| !self.allows(i, self.values[i])).collect();
        for (k, span) in self.problem.spans.iter().enumerate() {
            if !self.has_room(k, &[]) {
                is_bad[span.ways.clone()].fill(true);
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
            self.problem.moves.vectors[k].iter().for_each(|&(i, c)| self.x[i] += step * c);
            let scale = 2.0 * step as f64;
            let row = self.matrix.row(k);
            self.gradient.iter_mut().zip(row).for_each(|(g, p)| *g += scale * p);
        }
    }
}

/// For each vector of the basis the constraints it moves, and how.
fn moved(problem: &RoundingProblem) -> Vec<Vec<(usize, [i64; 2])>> {
    // For each coordinate the constraints it occurs in.
    let mut occurs: Vec<Vec<(usize, [i64; 2])>> = vec![Vec::new(); problem.mean.len()];
    for (i, constraint) in problem.constraints.iter().enumerate() {
        for (part, row) in constraint.rows.iter().enumerate() {
            for &(k, c) in row {
                let mut step = [0; 2];
                step[part] = c;
                occurs[k].push((i, step));
            }
        }
    }
    let along = |vector: &Row| {
        let mut steps: Vec<(usize, [i64; 2])> = vector
            .iter()
            .flat_map(|&(k, c)| occurs[k].iter().map(move |&(i, [u, v])| (i, [c * u, c * v])))
            .collect();
        steps.sort_unstable();
        let sum = |group: &[(usize, [i64; 2])]| {
            group.iter().fold((group[0].0, [0; 2]), |(i, [u, v]), (_, [a, b])| (i, [u + a, v + b]))
        };
        let sums = steps.chunk_by(|a, b| a.0 == b.0).map(sum);
        sums.filter(|(_, step)| *step != [0; 2]).collect()
    };
    problem.moves.vectors.iter().map(along).collect()
}
