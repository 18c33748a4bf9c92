//! Branch and bound, depth first, with dives that decide many integers at a time.

use crate::progress::{Cancelled, Watch};
use web_time::Instant;

/// A program in which some integers are decided and the others are free.
pub(super) trait Relax {
    /// What solving a node leaves for its children to start from.
    type State;

    /// Solves the program for decided values, one entry per variable.
    fn relax(
        &mut self,
        values: &[Option<i32>],
        from: &Self::State,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Verdict<Self::State>, Cancelled>;

    /// Whether two variables should not be decided in one step unless both are near integers.
    fn are_close(&self, a: usize, b: usize) -> bool;
}

/// What became of a node's program.
pub(super) enum Verdict<S> {
    Solved(NodeSolution<S>),
    Infeasible,
    /// The solver failed: nothing is known.
    Unsolved,
}

/// A solved program.
pub(super) struct NodeSolution<S> {
    /// Value reached.
    pub(super) value: f64,
    /// Bound from below on what the program and all integers in it can reach.
    pub(super) bound: f64,
    /// Every variable, the free ones wherever they are.
    pub(super) position: Vec<f64>,
    pub(super) state: S,
}

/// When the search ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Programs solved; [`DIVE`] more as long as there is no incumbent.
    pub(super) nodes: usize,
    pub(super) deadline: Option<Instant>,
    /// Integers must promise to be better by this part of the value.
    pub(super) tolerance: f64,
}

/// What was found.
pub(super) struct SearchResult<S> {
    pub(super) incumbent: Option<Incumbent<S>>,
    /// Without an incumbent: what the node that the search ended at had decided, if anything, and its layout.
    pub(super) partial: Option<(Vec<Option<i32>>, S)>,
    /// Bound from below on the value over all choices; never above the incumbent's value.
    pub(super) bound: f64,
    /// Programs solved.
    pub(super) nodes: usize,
    /// Whether every choice was made or excluded.
    pub(super) is_exhausted: bool,
}

/// The best integers so far.
pub(super) struct Incumbent<S> {
    pub(super) values: Vec<i32>,
    pub(super) value: f64,
    pub(super) state: S,
}

/// Programs that the first dive may take beyond the limit.
const DIVE: usize = 60;
/// A variable this near to an integer is decided along with any others.
const NEAR: f64 = 0.05;
/// Of the others, one in this many is decided in a step.
const SHARE: usize = 6;
/// Distances closer than this are the same.
const SAME: f64 = 1e-9;

/// Finds integers, each one of two given, of least value.
///
/// A node decides a *group* of variables at once, those nearest to one of their two integers. Its children
/// are: the whole group at the nearest integers; then, for each of the group from the last, all before it
/// at the nearest integers and itself at the other one. These cover every choice once, so that the
/// search may run to its end and prove what it found. Before there is an incumbent, a group that has no
/// layout is halved instead.
pub(super) fn search<R: Relax>(
    program: &mut R,
    choices: &[[i32; 2]],
    from: &R::State,
    limits: &Limits,
    watch: &mut Watch<'_, '_>,
) -> Result<SearchResult<R::State>, Cancelled> {
    let mut search =
        BranchAndBound { choices, limits, incumbent: None, lost: f64::INFINITY, nodes: 0 };
    let undecided = vec![None; choices.len()];
    let mut stack: Vec<Open<R::State>> = Vec::new();
    let mut is_exhausted = true;
    match search.solve(program, &undecided, from, watch)? {
        None | Some(Verdict::Unsolved) => {
            return Ok(search.finish(f64::NEG_INFINITY, false, None));
        }
        Some(Verdict::Infeasible) => return Ok(search.finish(f64::INFINITY, true, None)),
        Some(Verdict::Solved(root)) => search.enter(program, &mut stack, undecided, root),
    }
    while let Some(top) = stack.last_mut() {
        let is_hopeless = top.relaxed.bound >= search.cutoff();
        let Some(values) = (!is_hopeless).then(|| top.child(choices)).flatten() else {
            stack.pop();
            continue;
        };
        let verdict = match search.may_go_on() {
            true => search.solve(program, &values, &top.relaxed.state, watch)?,
            false => None,
        };
        match verdict {
            None => {
                is_exhausted = false;
                break;
            }
            Some(Verdict::Solved(relaxed)) => {
                top.advance();
                search.enter(program, &mut stack, values, relaxed);
            }
            Some(verdict) => {
                if matches!(verdict, Verdict::Unsolved) {
                    search.lost = search.lost.min(top.relaxed.bound);
                }
                top.refuse(search.incumbent.is_none());
            }
        }
    }
    // A node's bound holds for the children it has not been asked for.
    let open = stack.iter().map(|open| open.relaxed.bound).fold(f64::INFINITY, f64::min);
    let last = stack.pop().filter(|last| last.values.iter().any(Option::is_some));
    Ok(search.finish(open, is_exhausted, last))
}

/// A node some of whose children are still to be looked at.
struct Open<S> {
    values: Vec<Option<i32>>,
    relaxed: NodeSolution<S>,
    /// Variables to decide, nearest first, with the place of the nearest of their two integers.
    group: Vec<(usize, usize)>,
    next: Child,
}

/// The children of a node in order.
#[derive(Clone, Copy)]
enum Child {
    /// The first so many of the group at their nearest integers.
    Nearest(usize),
    /// The same before the last of so many, and that one at its other integer.
    Other(usize),
}

impl<S> Open<S> {
    /// Values of the next child.
    fn child(&self, choices: &[[i32; 2]]) -> Option<Vec<Option<i32>>> {
        let (count, last) = match self.next {
            Child::Nearest(count) => (count, None),
            Child::Other(0) => return None,
            Child::Other(count) => (count - 1, Some(self.group[count - 1])),
        };
        let mut values = self.values.clone();
        for &(variable, nearest) in &self.group[..count] {
            values[variable] = Some(choices[variable][nearest]);
        }
        if let Some((variable, nearest)) = last {
            values[variable] = Some(choices[variable][1 - nearest]);
        }
        Some(values)
    }

    fn advance(&mut self) {
        self.next = match self.next {
            Child::Nearest(count) => Child::Other(count),
            Child::Other(count) => Child::Other(count - 1),
        };
    }

    /// The child asked for has no layout.
    fn refuse(&mut self, halves: bool) {
        match self.next {
            Child::Nearest(count) if halves && count > 1 => self.next = Child::Nearest(count / 2),
            _ => self.advance(),
        }
    }
}

struct BranchAndBound<'a, S> {
    choices: &'a [[i32; 2]],
    limits: &'a Limits,
    incumbent: Option<Incumbent<S>>,
    /// Least bound of nodes that could not be solved.
    lost: f64,
    nodes: usize,
}

impl<S> BranchAndBound<'_, S> {
    /// Nodes with this bound cannot lead to anything better by the tolerance.
    fn cutoff(&self) -> f64 {
        let best = self.incumbent.as_ref().map_or(f64::INFINITY, |best| best.value);
        best * (1.0 - self.limits.tolerance)
    }

    fn may_go_on(&self) -> bool {
        let more = if self.incumbent.is_none() { DIVE } else { 0 };
        self.nodes < self.limits.nodes.saturating_add(more)
    }

    /// Solves a node; none when time is up.
    fn solve<R: Relax<State = S>>(
        &mut self,
        program: &mut R,
        values: &[Option<i32>],
        from: &S,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Option<Verdict<S>>, Cancelled> {
        watch.pulse()?;
        let solved =
            watch.limited(self.limits.deadline, |watch| program.relax(values, from, watch))?;
        self.nodes += usize::from(solved.is_some());
        Ok(solved)
    }

    /// Takes a solved node: as incumbent, as open, or not at all.
    fn enter<R: Relax<State = S>>(
        &mut self,
        program: &R,
        stack: &mut Vec<Open<S>>,
        values: Vec<Option<i32>>,
        relaxed: NodeSolution<S>,
    ) {
        if relaxed.bound >= self.cutoff() {
            return;
        }
        let all: Option<Vec<i32>> = values.iter().copied().collect();
        match all {
            Some(values) => {
                let NodeSolution { value, state, .. } = relaxed;
                if self.incumbent.as_ref().is_none_or(|best| value < best.value) {
                    self.incumbent = Some(Incumbent { values, value, state });
                }
            }
            None => {
                let group = self.group(program, &values, &relaxed.position);
                let next = Child::Nearest(group.len());
                stack.push(Open { values, relaxed, group, next });
            }
        }
    }

    /// The variables to decide next, nearest to one of their integers first.
    fn group<R: Relax<State = S>>(
        &self,
        program: &R,
        values: &[Option<i32>],
        position: &[f64],
    ) -> Vec<(usize, usize)> {
        let coarse = |x: f64| (x / SAME).round() as i64;
        let mut free: Vec<(i64, usize, usize)> = (0..values.len())
            .filter(|&k| values[k].is_none())
            .map(|k| {
                let [a, b] = self.choices[k].map(|i| coarse((position[k] - f64::from(i)).abs()));
                if b < a { (b, k, 1) } else { (a, k, 0) }
            })
            .collect();
        free.sort_unstable();
        let most = free.len().div_ceil(SHARE);
        let mut group: Vec<(usize, usize)> = Vec::new();
        for (distance, variable, nearest) in free {
            let is_near = distance <= coarse(NEAR);
            let fits = |&(other, _): &(usize, usize)| !program.are_close(variable, other);
            if is_near || (group.len() < most && group.iter().all(fits)) {
                group.push((variable, nearest));
            }
        }
        group
    }

    fn finish(self, open: f64, is_exhausted: bool, last: Option<Open<S>>) -> SearchResult<S> {
        let cutoff = self.cutoff();
        let best = self.incumbent.as_ref().map_or(f64::INFINITY, |best| best.value);
        let bound = match is_exhausted {
            true => cutoff.min(self.lost),
            false => open.min(self.lost).min(best),
        };
        let is_exhausted = is_exhausted && self.lost >= cutoff;
        let partial = last.filter(|_| self.incumbent.is_none());
        let partial = partial.map(|last| (last.values, last.relaxed.state));
        SearchResult { incumbent: self.incumbent, partial, bound, nodes: self.nodes, is_exhausted }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit::Rng;
    use std::ops::ControlFlow;

    /// `sum of weight (x - centre)^2 + coupling (sum of x)^2` over reals, decided ones held; infeasible
    /// where the first two are equal and decided.
    struct Quadratic {
        centre: Vec<f64>,
        weight: Vec<f64>,
        coupling: f64,
    }

    impl Quadratic {
        fn value(&self, x: &[f64]) -> f64 {
            let sum: f64 = x.iter().sum();
            let own = x.iter().zip(&self.centre).zip(&self.weight);
            own.map(|((x, c), w)| w * (x - c).powi(2)).sum::<f64>()
                + self.coupling * sum * sum
                + 1.0
        }
    }

    impl Relax for Quadratic {
        type State = ();

        fn relax(
            &mut self,
            values: &[Option<i32>],
            _: &(),
            watch: &mut Watch<'_, '_>,
        ) -> Result<Verdict<()>, Cancelled> {
            watch.pulse()?;
            if values[0].is_some() && values[0] == values[1] {
                return Ok(Verdict::Infeasible);
            }
            let mut x: Vec<f64> = values.iter().map(|v| v.map_or(0.0, f64::from)).collect();
            for _ in 0..500 {
                for k in (0..x.len()).filter(|&k| values[k].is_none()) {
                    let rest = x.iter().sum::<f64>() - x[k];
                    let w = self.weight[k];
                    x[k] = (w * self.centre[k] - self.coupling * rest) / (w + self.coupling);
                }
            }
            let value = self.value(&x);
            Ok(Verdict::Solved(NodeSolution { value, bound: value, position: x, state: () }))
        }

        fn are_close(&self, a: usize, b: usize) -> bool {
            a.abs_diff(b) == 1
        }
    }

    fn problem(seed: u64, n: usize) -> (Quadratic, Vec<[i32; 2]>) {
        let mut rng = Rng::new(seed);
        let mut draw = |scale: f64| (0..n).map(|_| scale * rng.unit()).collect::<Vec<f64>>();
        let (centre, weight) = (draw(4.0), draw(1.0));
        let choices = centre.iter().map(|c| [c.floor() as i32, c.floor() as i32 + 1]).collect();
        let weight = weight.iter().map(|w| 0.2 + w).collect();
        (Quadratic { centre, weight, coupling: 0.3 }, choices)
    }

    fn run(seed: u64, n: usize, nodes: usize) -> (SearchResult<()>, Quadratic, Vec<[i32; 2]>) {
        let (mut program, choices) = problem(seed, n);
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let limits = Limits { nodes, deadline: None, tolerance: 1e-9 };
        let found = search(&mut program, &choices, &(), &limits, &mut watch).unwrap();
        (found, program, choices)
    }

    #[test]
    fn the_optimum_is_that_of_enumeration() {
        for seed in 0..20 {
            let (found, program, choices) = run(seed, 8, usize::MAX);
            assert!(found.is_exhausted);
            let best = (0..1u32 << 8)
                .map(|bits| {
                    let pick = |k: usize| choices[k][(bits >> k & 1) as usize];
                    (0..8).map(pick).collect::<Vec<i32>>()
                })
                .filter(|x| x[0] != x[1])
                .map(|x| program.value(&x.iter().map(|&x| f64::from(x)).collect::<Vec<_>>()))
                .fold(f64::INFINITY, f64::min);
            let incumbent = found.incumbent.unwrap();
            assert!((incumbent.value - best).abs() < 1e-9 * best, "{} {best}", incumbent.value);
            assert!(found.bound <= incumbent.value && found.bound > best * (1.0 - 1e-8));
        }
    }

    #[test]
    fn a_search_cut_short_has_a_bound_below_the_optimum() {
        for seed in 0..20 {
            let (full, ..) = run(seed, 8, usize::MAX);
            let optimum = full.incumbent.unwrap().value;
            for nodes in [1, 6, 12, 25] {
                let (found, ..) = run(seed, 8, nodes);
                assert!(found.nodes <= nodes.max(DIVE));
                assert!(found.bound <= optimum * (1.0 + 1e-12), "seed {seed}, {nodes} nodes");
                if let Some(incumbent) = found.incumbent {
                    assert!(found.bound <= incumbent.value && incumbent.value >= optimum - 1e-9);
                }
            }
        }
    }

    #[test]
    fn a_group_without_a_layout_is_halved() {
        // The first two variables are nearest to the same integer, which no solution has.
        let program =
            |n: usize| Quadratic { centre: vec![1.02; n], weight: vec![1.0; n], coupling: 0.0 };
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let limits = Limits { nodes: 100, deadline: None, tolerance: 1e-9 };
        let choices = vec![[1, 2]; 5];
        let found = search(&mut program(5), &choices, &(), &limits, &mut watch).unwrap();
        let values = found.incumbent.unwrap().values;
        assert!(values == [1, 2, 1, 1, 1] || values == [2, 1, 1, 1, 1], "{values:?}");
        assert!(found.is_exhausted);
    }

    #[test]
    fn what_has_no_solution_says_so() {
        let mut program = Quadratic { centre: vec![0.3; 2], weight: vec![1.0; 2], coupling: 0.0 };
        let mut go_on = |_| ControlFlow::Continue(());
        let mut watch = Watch::new(&mut go_on, 0, 1);
        let limits = Limits { nodes: 100, deadline: None, tolerance: 1e-9 };
        let choices = [[0, 0], [0, 0]];
        let found = search(&mut program, &choices, &(), &limits, &mut watch).unwrap();
        assert!(found.incumbent.is_none() && found.is_exhausted && found.bound.is_infinite());
    }

    #[test]
    fn cancellation_ends_the_search() {
        let (mut program, choices) = problem(3, 8);
        let mut calls = 0;
        let mut stop = |_| {
            calls += 1;
            if calls > 9 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let mut watch = Watch::new(&mut stop, 0, 1);
        let limits = Limits { nodes: 1000, deadline: None, tolerance: 1e-9 };
        assert!(search(&mut program, &choices, &(), &limits, &mut watch).is_err());
    }
}
