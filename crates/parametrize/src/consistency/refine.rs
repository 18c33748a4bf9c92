//! Better indices, and how good they are at least: exactly where the problem is small, patch by patch where it
//! is not.

use super::bound::{Pricing, ascend, prices};
use super::branch::{Choice, Work, proven_above, search};
use super::error::ConsistencyError;
use super::input::AngleNorm;
use super::piece::{Piece, Whole};
use crate::progress::Watch;
use seamstress_linalg::ordering::Graph;

/// Components with at most so many undecided indices are searched to the end, as far as the work goes.
const SMALL: usize = 64;
/// Components with at most so many are a patch by themselves.
const TINY: usize = 24;
/// Steps of the ascent on a whole component.
const STEPS: usize = 120;
/// Passes over the patches of a component; few change anything after the third.
const PASSES: usize = 8;
/// Share of the work for the patches, so that some is left for a proof.
const PATCHES: f64 = 0.7;
/// Groups of a patch whose indices may change: enough for pairs of cones two edges apart, few enough for a
/// proof within some hundred nodes.
const CORE: usize = 14;
/// Corners of these groups at most; groups joined by real matchings may have many.
const MOST_CORNERS: usize = 200;
/// Groups in the middle of a patch where nothing better was found, which no longer start one.
const SETTLED: usize = 4;
/// A gap below this promises nothing, radians or radians squared.
const LEAST_GAP: f64 = 1e-6;
/// Work on one patch at most, visits of corners.
const PATCH_WORK: u64 = 1_500_000;
/// Gains below this share of a patch's value are rounding errors.
const LEAST_GAIN: f64 = 1e-7;

/// Indices and angles of the whole problem.
pub(super) struct State {
    /// Per group.
    pub(super) change: Vec<i32>,
    /// Per corner, radians.
    pub(super) angles: Vec<f64>,
}

impl State {
    /// Takes over the indices and angles of a piece.
    fn take(&mut self, piece: &Piece, change: &[i32], angles: &[f64]) {
        for (member, &n) in piece.members.iter().zip(change) {
            self.change[member.group as usize] = n;
        }
        for (&c, &a) in piece.corners.iter().zip(angles) {
            self.angles[c as usize] = a;
        }
    }
}

/// A solution of the whole problem, and what is known of it.
pub(super) struct Refined {
    pub(super) state: State,
    /// No solution costs less.
    pub(super) bound: f64,
    /// Whether the bound proves the solution, in every component.
    pub(super) proven: bool,
}

/// The whole problem and how it is searched.
pub(super) struct Search<'a> {
    pub(super) whole: &'a Whole<'a>,
    /// Groups that share a triangle.
    pub(super) graph: &'a Graph,
    pub(super) norm: AngleNorm,
}

/// A component on its way.
struct Part<'a> {
    search: &'a Search<'a>,
    triangles: &'a [u32],
    piece: Piece,
    /// Price per triangle of the piece.
    prices: Vec<f64>,
    /// Infinite if no solution is known.
    value: f64,
    bound: f64,
}

impl Search<'_> {
    /// Improves a solution component by component, by so much work in all, and bounds what could still be gained; it
    /// comes with multipliers of the triangle sums. Where none is known it looks for one: none if a component is not
    /// small, has none, or the work did not suffice.
    pub(super) fn refine(
        &self,
        components: &[Vec<u32>],
        known: Option<(State, &[f64])>,
        work: u64,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Option<Refined>, ConsistencyError> {
        let (mut state, multipliers) = match known {
            Some((state, multipliers)) => (state, Some(multipliers)),
            None => {
                let change = vec![0; self.whole.groups.len()];
                (State { change, angles: self.whole.given.to_vec() }, None)
            }
        };
        let (mut bound, mut proven) = (0.0, true);
        for triangles in components {
            // A component's part of the work, by its triangles.
            let share = 3.0 * triangles.len() as f64 / self.whole.given.len().max(1) as f64;
            let mut work = Work((work as f64 * share) as u64);
            let mut part = Part::new(self, triangles, &state, multipliers);
            if part.value.is_finite() && part.piece.n_open() > TINY {
                let mut patches = Work((work.0 as f64 * PATCHES) as u64);
                work.0 -= patches.0;
                part.improve(&mut state, &mut patches, watch)?;
                work.0 += patches.0;
            }
            part.finish(&mut state, &mut work, watch)?;
            if part.value.is_infinite() {
                return Ok(None);
            }
            bound += part.bound;
            proven &= part.is_proven();
        }
        Ok(Some(Refined { state, bound, proven }))
    }

    /// Looks for better indices of some groups, ascending, where all other angles and indices stay.
    fn improve_patch(
        &self,
        core: &[u32],
        prices: &[f64],
        state: &mut State,
        work: &mut Work,
        watch: &mut Watch<'_, '_>,
    ) -> Result<bool, ConsistencyError> {
        let corners = core.iter().flat_map(|&g| self.whole.corners(g));
        let mut triangles: Vec<u32> = corners.map(|c| c / 3).collect();
        triangles.sort_unstable();
        triangles.dedup();
        let may_change = |g: u32| core.binary_search(&g).is_ok();
        let piece = self.whole.piece(&triangles, may_change, &state.change, &state.angles);
        let value = piece.value(self.norm, &state.angles);
        let start = triangles.iter().map(|&t| prices[t as usize]).collect();
        let found = search(&piece, self.norm, value, start, work, watch)?;
        let is_better = |choice: &Choice| choice.value < value - LEAST_GAIN * (1.0 + value);
        let Some(choice) = found.better.filter(is_better) else { return Ok(false) };
        state.take(&piece, &choice.change, &choice.angles);
        Ok(true)
    }

    /// Groups around one, the nearest first, as many as a patch takes.
    fn ball(&self, seed: u32) -> Vec<u32> {
        let (whole, graph) = (self.whole, self.graph);
        let mut core = vec![seed];
        let mut corners = whole.corners(seed).len();
        let mut next = 0;
        while next < core.len() && core.len() < CORE {
            let g = core[next] as usize;
            next += 1;
            let around = graph.offsets[g] as usize..graph.offsets[g + 1] as usize;
            for other in graph.neighbours[around].iter().map(|&other| other as u32) {
                let more = whole.corners(other).len();
                let fits = core.len() < CORE && corners + more <= MOST_CORNERS;
                if fits && !core.contains(&other) {
                    core.push(other);
                    corners += more;
                }
            }
        }
        core
    }
}

impl<'a> Part<'a> {
    fn new(
        search: &'a Search<'a>,
        triangles: &'a [u32],
        state: &State,
        multipliers: Option<&[f64]>,
    ) -> Self {
        let Search { whole, norm, .. } = *search;
        let piece = whole.piece(triangles, |_| true, &state.change, &state.angles);
        let pricing = Pricing { piece: &piece, norm };
        let mut start = vec![0.0; triangles.len()];
        let mut value = f64::INFINITY;
        if let Some(multipliers) = multipliers {
            value = piece.value(norm, &state.angles);
            let here: Vec<f64> = triangles.iter().map(|&t| multipliers[t as usize]).collect();
            let solved = prices(&here, norm);
            let ranges = piece.ranges();
            if pricing.best(&solved, &ranges).value > pricing.best(&start, &ranges).value {
                start = solved;
            }
        }
        let mut part = Self { search, triangles, piece, prices: start, value, bound: 0.0 };
        part.raise();
        part
    }

    fn pricing(&self) -> Pricing<'_> {
        Pricing { piece: &self.piece, norm: self.search.norm }
    }

    /// Raises the bound.
    fn raise(&mut self) {
        let ranges = self.piece.ranges();
        let ascent = ascend(&self.pricing(), &ranges, &self.prices, self.value, STEPS);
        self.bound = self.bound.max(ascent.value);
        self.prices = ascent.prices;
    }

    fn is_proven(&self) -> bool {
        self.bound >= proven_above(self.value)
    }

    /// Passes over patches around the groups with the largest gaps, until one changes nothing.
    fn improve(
        &mut self,
        state: &mut State,
        work: &mut Work,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), ConsistencyError> {
        let Search { whole, norm, .. } = *self.search;
        let mut system = self.piece.system(false)?;
        let mut all_prices = vec![0.0; whole.given.len() / 3];
        for _ in 0..PASSES {
            if self.is_proven() || work.0 == 0 {
                break;
            }
            for (&t, &p) in self.triangles.iter().zip(&self.prices) {
                all_prices[t as usize] = p;
            }
            let gaps = self.pricing().gaps(&state.angles, &self.prices);
            let groups = self.piece.members.iter().map(|member| member.group);
            let mut seeds: Vec<(u32, f64)> =
                groups.zip(gaps).filter(|&(_, gap)| gap > LEAST_GAP).collect();
            seeds.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            let mut settled = vec![false; whole.groups.len()];
            let mut improved = false;
            for (seed, _) in seeds {
                if settled[seed as usize] || work.0 == 0 {
                    continue;
                }
                let mut core = self.search.ball(seed);
                core.iter().take(SETTLED).for_each(|&g| settled[g as usize] = true);
                core.sort_unstable();
                let most = PATCH_WORK.min(work.0);
                let mut left = Work(most);
                improved |=
                    self.search.improve_patch(&core, &all_prices, state, &mut left, watch)?;
                work.0 -= most - left.0;
            }
            if !improved {
                break;
            }
            let change = self.piece.changes(&state.change);
            let solved = self.piece.solve(norm, &mut system, &change, watch)?;
            if solved.converged && solved.value < self.piece.value(norm, &state.angles) {
                state.take(&self.piece, &change, &solved.angles);
            }
            self.value = self.piece.value(norm, &state.angles);
            self.raise();
        }
        Ok(())
    }

    /// Branch and bound, if few enough indices are undecided.
    fn finish(
        &mut self,
        state: &mut State,
        work: &mut Work,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), ConsistencyError> {
        let mut ranges = self.piece.ranges();
        let spare = proven_above(self.value) - self.bound;
        self.pricing().narrow(&self.prices, spare, &mut ranges);
        let undecided = ranges.iter().filter(|range| range.0 < range.1).count();
        if self.is_proven() || undecided > SMALL || work.0 == 0 {
            return Ok(());
        }
        let start = self.prices.clone();
        let found = search(&self.piece, self.search.norm, self.value, start, work, watch)?;
        self.bound = self.bound.max(found.bound);
        if let Some(choice) = found.better {
            self.value = choice.value;
            state.take(&self.piece, &choice.change, &choice.angles);
        }
        Ok(())
    }
}
