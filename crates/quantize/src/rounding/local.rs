//! Local search around an integer point.

use super::problem::{AreaForm, RoundingProblem, SizeCost};
use crate::linear::{Row, apply};
use seamstress_parametrize::progress::{Cancelled, Watch};

/// Most steps that pay: the rounding before leaves far fewer to take, and this bounds the time of a bad one.
const MOST_STEPS: usize = 300;
/// Steps tried in the order of their energies while constraints are violated.
const TRIED: usize = 300;
/// A fall of the energy that counts, as a share of it.
const GAIN: f64 = 1e-6;
/// A fall of the energy, or of the weight of a repair, that counts where there is none left.
const SMALLEST_GAIN: f64 = 1e-12;
/// Most steps of a repair. Those that succeed take fewer on all meshes measured.
const MOST_REPAIRS: usize = 400;
/// What energy counts in a repair against a violated constraint of weight one; a step along a usual coordinate costs
/// about one.
const ENERGY_WEIGHT: f64 = 0.05;
/// By how much the weight of a constraint rises when no step helps.
const ADDED_WEIGHT: f64 = 1.0;
/// A fall of the weight that counts in a repair.
const WEIGHT_GAIN: f64 = 1e-9;

/// A vector of the basis and how often it is added, 1 or -1.
type Step = (usize, i64);

/// A constraint and its displacement.
type Displacement = (usize, [i64; 2]);

/// Those of several constraints, ascending.
type Displacements = Vec<Displacement>;

/// Takes steps along single vectors of the reduced basis and pairs of them while that lowers the number of
/// violated constraints, or the energy at the same number; where constraints stay violated, repairs them at the cost
/// of energy first, and says so.
///
/// # Errors
/// [`Cancelled`] when the observer breaks.
pub(super) fn improve(
    problem: &RoundingProblem<'_>,
    x: Vec<i64>,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<i64>, bool), Cancelled> {
    let mut search = LocalSearch::new(problem, x);
    search.descend(watch)?;
    let needs_repair = search.violated > 0;
    if needs_repair {
        search = search.repair(watch)?;
        if search.violated == 0 {
            search.descend(watch)?;
        }
    }
    Ok((search.x, needs_repair))
}

/// An integer point that moves, the energy's slope there, and the displacements of all constraints. Joint
/// constraints are numbered after the others.
struct LocalSearch<'a> {
    problem: &'a RoundingProblem<'a>,
    x: Vec<i64>,
    /// Gradient of the energy along the vectors of the basis.
    gradient: Vec<f64>,
    values: Vec<[i64; 2]>,
    /// By how many grid units displacements are too short, and violated joint constraints.
    violated: i64,
    /// The joint constraint that each one is a member of.
    memberships: Vec<Option<usize>>,
    /// For each vector of the basis the constraints it moves, and how.
    moved: Vec<Displacements>,
    /// A fall of the energy that counts.
    gain: f64,
    /// The area there, if the coordinates decide on it.
    area: Option<Area<'a>>,
}

/// The area at an integer point, its slope along the vectors of the basis, and its cost.
struct Area<'a> {
    form: &'a AreaForm,
    value: f64,
    gradient: Vec<f64>,
    cost: SizeCost,
    /// The cost there.
    now: f64,
}

impl<'a> Area<'a> {
    fn new(problem: &'a RoundingProblem<'a>, x: &[i64]) -> Option<Self> {
        let form = problem.energy.area.as_ref()?;
        let at: Vec<f64> = x.iter().map(|&x| x as f64).collect();
        let slope = form.matrix.multiply(&at);
        let gradient = problem.energy.basis.vectors.iter().map(|row| apply(row, &slope)).collect();
        let (value, cost) = (form.at(&at), problem.size_cost());
        Some(Self { form, value, gradient, cost, now: cost.at(value) })
    }

    /// Change of the area by a single step.
    fn change(&self, (k, step): Step) -> f64 {
        step as f64 * self.gradient[k] + 0.5 * self.form.in_basis.row(k)[k]
    }

    /// Change of the cost by a change of the area.
    fn cost_of(&self, change: f64) -> f64 {
        self.cost.at(self.value + change) - self.now
    }

    fn take(&mut self, (k, step): Step) {
        self.value += self.change((k, step));
        self.now = self.cost.at(self.value);
        let row = self.form.in_basis.row(k);
        self.gradient.iter_mut().zip(row).for_each(|(g, f)| *g += step as f64 * f);
    }
}

impl<'a> LocalSearch<'a> {
    fn new(problem: &'a RoundingProblem<'a>, x: Vec<i64>) -> Self {
        let d: Vec<f64> = x.iter().zip(&problem.mean).map(|(&x, m)| x as f64 - m).collect();
        let slope: Vec<f64> = problem.energy.matrix.multiply(&d).iter().map(|g| 2.0 * g).collect();
        let vectors = &problem.energy.basis.vectors;
        let values: Vec<[i64; 2]> = problem.constraints.iter().map(|c| c.at(&x)).collect();
        let mut search = Self {
            problem,
            gradient: vectors.iter().map(|row| apply(row, &slope)).collect(),
            values,
            violated: 0,
            memberships: problem.memberships(),
            moved: displacements(problem),
            gain: GAIN * problem.energy_at(&x).abs() + SMALLEST_GAIN,
            area: Area::new(problem, &x),
            x,
        };
        let all = 0..search.values.len() + problem.joint.len();
        search.violated = all.map(|k| search.shortage_now(k)).sum();
        search
    }

    fn shortage(&self, i: usize, value: [i64; 2]) -> i64 {
        self.problem.constraints[i].shortage(value.map(|x| x as f64))
    }

    /// The value of a constraint after some steps.
    fn value_after(&self, i: usize, steps: &[Step]) -> [i64; 2] {
        steps.iter().fold(self.values[i], |[u, v], &(k, step)| {
            match self.moved[k].binary_search_by_key(&i, |&(j, _)| j) {
                Ok(at) => {
                    let [a, b] = self.moved[k][at].1;
                    [u + step * a, v + step * b]
                }
                Err(_) => [u, v],
            }
        })
    }

    /// One if a joint constraint is violated after some steps.
    fn joint_shortage(&self, joint: usize, steps: &[Step]) -> i64 {
        let (members, rule) = &self.problem.joint[joint];
        let at = |i: usize| Some(self.value_after(i, steps).map(|x| x as f64));
        i64::from(!rule.allows(members.clone().map(at)))
    }

    fn shortage_now(&self, constraint: usize) -> i64 {
        match constraint.checked_sub(self.values.len()) {
            None => self.shortage(constraint, self.values[constraint]),
            Some(joint) => self.joint_shortage(joint, &[]),
        }
    }

    /// Change of the energy by a single step.
    fn cost(&self, step: Step) -> f64 {
        let size = self.area.as_ref().map_or(0.0, |area| area.cost_of(area.change(step)));
        self.cost_of_shape(step) + size
    }

    /// The same, whatever the area.
    fn cost_of_shape(&self, (k, step): Step) -> f64 {
        self.problem.energy.basis.matrix.row(k)[k] + step as f64 * self.gradient[k]
    }

    /// Change of the energy by two steps along different vectors, if it is below a limit.
    fn cost_of_pair(&self, a: Step, b: Step, limit: f64) -> Option<f64> {
        let sign = (a.1 * b.1) as f64;
        let coupling = 2.0 * sign * self.problem.energy.basis.matrix.row(a.0)[b.0];
        let shape = self.cost_of_shape(a) + self.cost_of_shape(b) + coupling;
        let Some(area) = &self.area else { return (shape < limit).then_some(shape) };
        // At best, no area is missed any more.
        if shape - area.now >= limit {
            return None;
        }
        let coupling = sign * area.form.in_basis.row(a.0)[b.0];
        let cost = shape + area.cost_of(area.change(a) + area.change(b) + coupling);
        (cost < limit).then_some(cost)
    }

    /// By how much more each constraint is violated after one or two steps, as far as they change it.
    fn rises(&self, steps: &[Step]) -> impl Iterator<Item = (usize, i64)> {
        let lists = [steps.first(), steps.get(1)]
            .map(|step| step.map_or((&[][..], 0), |&(k, step)| (&self.moved[k][..], step)));
        let single = Merged { lists }.map(|(i, [a, b])| {
            let [u, v] = self.values[i];
            (i, self.shortage(i, [u + a, v + b]) - self.shortage(i, [u, v]))
        });
        // The members of a joint constraint are neighbours.
        let mut last = None;
        let joint = Merged { lists }.filter_map(move |(i, _)| {
            let joint = self.memberships[i].filter(|&joint| last != Some(joint))?;
            last = Some(joint);
            let more = self.joint_shortage(joint, steps) - self.joint_shortage(joint, &[]);
            Some((self.values.len() + joint, more))
        });
        single.chain(joint)
    }

    fn violated_after(&self, steps: &[Step]) -> i64 {
        self.rises(steps).fold(self.violated, |sum, (_, more)| sum + more)
    }

    fn take(&mut self, steps: &[Step]) {
        self.violated = self.violated_after(steps);
        for &(k, step) in steps {
            for &(i, [a, b]) in &self.moved[k] {
                let [u, v] = self.values[i];
                self.values[i] = [u + step * a, v + step * b];
            }
        }
        let basis = &self.problem.energy.basis;
        for &(k, step) in steps {
            basis.vectors[k].iter().for_each(|&(i, c)| self.x[i] += step * c);
            let scale = 2.0 * step as f64;
            let row = basis.matrix.row(k);
            self.gradient.iter_mut().zip(row).for_each(|(g, p)| *g += scale * p);
            if let Some(area) = &mut self.area {
                area.take((k, step));
            }
        }
    }

    /// Steps as long as they pay.
    fn descend(&mut self, watch: &mut Watch<'_, '_>) -> Result<(), Cancelled> {
        for _ in 0..MOST_STEPS {
            watch.pulse()?;
            let Some(steps) = self.best_single().or_else(|| self.best_pair()) else { break };
            self.take(&steps);
        }
        Ok(())
    }

    /// Whether steps of this energy pay.
    fn pays(&self, cost: f64, steps: &[Step]) -> bool {
        let is_cheaper = cost < -self.gain;
        if self.violated == 0 {
            return is_cheaper && self.rises(steps).all(|(_, more)| more <= 0);
        }
        let after = self.violated_after(steps);
        after < self.violated || (after == self.violated && is_cheaper)
    }

    /// The first single step that pays, the cheapest first.
    fn best_single(&self) -> Option<Vec<Step>> {
        let steps = (0..self.moved.len()).flat_map(|k| [(k, 1), (k, -1)]);
        let mut steps: Vec<(f64, Step)> = steps.map(|step| (self.cost(step), step)).collect();
        if self.violated == 0 {
            steps.retain(|step| step.0 < -self.gain);
        }
        steps.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        steps.truncate(TRIED);
        steps.into_iter().find(|&(cost, step)| self.pays(cost, &[step])).map(|(_, step)| vec![step])
    }

    /// The best pair among the cheapest ones; while constraints are violated, of those that touch one.
    fn best_pair(&self) -> Option<Vec<Step>> {
        let is_valid = self.violated == 0;
        let limit = if is_valid { -self.gain } else { f64::INFINITY };
        let mut is_bad = vec![false; self.values.len()];
        self.problem.violations(&self.x).involved.into_iter().for_each(|i| is_bad[i] = true);
        let touches = |moved: &Displacements| is_valid || moved.iter().any(|&(i, _)| is_bad[i]);
        let is_involved: Vec<bool> = self.moved.iter().map(touches).collect();
        let mut pairs: Vec<(f64, [Step; 2])> = Vec::new();
        for i in 0..self.moved.len() {
            for step in [1, -1] {
                for j in (0..i).filter(|&j| is_involved[i] || is_involved[j]) {
                    for other in [1, -1] {
                        let cost = self.cost_of_pair((i, step), (j, other), limit);
                        pairs.extend(cost.map(|cost| (cost, [(j, other), (i, step)])));
                    }
                }
            }
        }
        let order =
            |a: &(f64, [Step; 2]), b: &(f64, [Step; 2])| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if pairs.len() > TRIED {
            pairs.select_nth_unstable_by(TRIED, order);
            pairs.truncate(TRIED);
        }
        pairs.sort_by(order);
        let mut worth = pairs.into_iter().filter(|(cost, steps)| self.pays(*cost, steps));
        let best = match is_valid {
            true => worth.next(),
            false => worth.min_by_key(|(_, steps)| self.violated_after(steps)),
        };
        best.map(|(_, steps)| steps.to_vec())
    }

    /// Looks at one violated constraint after the other and takes the step among those that move it that
    /// lowers the weight of all violated ones most; if none does, it gets more weight. Ends at the point of the
    /// fewest violated constraints.
    ///
    /// # Source
    /// Morris 1993, *The breakout method for escaping from local minima*.
    fn repair(mut self, watch: &mut Watch<'_, '_>) -> Result<Self, Cancelled> {
        let (problem, n_single) = (self.problem, self.values.len());
        let n = n_single + problem.joint.len();
        let touching = self.touching();
        let mut weights = vec![1.0; n];
        let mut best = (self.violated, self.x.clone());
        let mut next = 0;
        for _ in 0..MOST_REPAIRS {
            watch.pulse()?;
            let violated = (0..n).map(|k| (next + k) % n).find(|&k| self.shortage_now(k) > 0);
            let Some(target) = violated else { return Ok(self) };
            next = target + 1;
            let members = match target.checked_sub(n_single) {
                None => target..target + 1,
                Some(joint) => problem.joint[joint].0.clone(),
            };
            let steps = members.flat_map(|i| &touching[i]).flat_map(|&k| [(k, 1), (k, -1)]);
            let worth = |step: Step| {
                let weight: f64 =
                    self.rises(&[step]).map(|(i, more)| more as f64 * weights[i]).sum();
                (weight + ENERGY_WEIGHT * self.cost(step), step)
            };
            match steps.map(worth).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) {
                Some((change, step)) if change < -WEIGHT_GAIN => {
                    self.take(&[step]);
                    if self.violated < best.0 {
                        best = (self.violated, self.x.clone());
                    }
                }
                _ => weights[target] += ADDED_WEIGHT,
            }
        }
        Ok(Self::new(problem, best.1))
    }

    /// For each constraint on a single displacement the vectors of the basis that move it.
    fn touching(&self) -> Vec<Vec<usize>> {
        let mut touching = vec![Vec::new(); self.values.len()];
        for (k, moved) in self.moved.iter().enumerate() {
            moved.iter().for_each(|&(i, _)| touching[i].push(k));
        }
        touching
    }
}

/// What two steps add to constraints, ascending.
struct Merged<'a> {
    /// What the vector of each step moves, and how often it is added.
    lists: [(&'a [Displacement], i64); 2],
}

impl Iterator for Merged<'_> {
    type Item = Displacement;

    fn next(&mut self) -> Option<Displacement> {
        let heads = self.lists.map(|(list, _)| list.first());
        let next = heads.iter().flatten().map(|head| head.0).min()?;
        let mut sum = [0; 2];
        for (list, step) in &mut self.lists {
            if let [(i, [a, b]), rest @ ..] = *list
                && *i == next
            {
                sum = [sum[0] + *step * a, sum[1] + *step * b];
                *list = rest;
            }
        }
        Some((next, sum))
    }
}

/// For each vector of the basis the constraints it moves, and how.
fn displacements(problem: &RoundingProblem<'_>) -> Vec<Displacements> {
    // For each coordinate the constraints it occurs in.
    let mut occurs: Vec<Displacements> = vec![Vec::new(); problem.mean.len()];
    for (i, constraint) in problem.constraints.iter().enumerate() {
        for (part, row) in constraint.rows.iter().enumerate() {
            for &(k, c) in row {
                let mut step = [0; 2];
                step[part] = c;
                occurs[k].push((i, step));
            }
        }
    }
    let mut sums = vec![[0; 2]; problem.constraints.len()];
    let along = |vector: &Row| {
        for &(k, c) in vector {
            for &(i, [u, v]) in &occurs[k] {
                let [a, b] = sums[i];
                sums[i] = [a + c * u, b + c * v];
            }
        }
        let all = sums.iter_mut().map(std::mem::take).enumerate();
        all.filter(|(_, step)| *step != [0; 2]).collect()
    };
    problem.energy.basis.vectors.iter().map(along).collect()
}
