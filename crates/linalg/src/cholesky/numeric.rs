//! The numeric factorisation, front by front (Duff and Reid 1983; Liu 1992).
//!
//! A front gathers its entries of the matrix and what its children hand to it, eliminates its pivots, and hands the
//! rest to its parent. Subtrees go to whoever is free; the large fronts above them come one after the other, cut
//! into strips. The tree fixes every sum, so that the result does not depend on who does what.

use super::NotPositiveDefinite;
use super::kernels::{FactorPivots, Pivots, SolveRows, Update, dispatch};
use super::quad::{Quad, Scalar};
use super::symbolic::{Front, Subtrees, Symbolic, update_len};
use seamstress_parallel::n_threads;
use seamstress_parallel::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// A factor, and the memory that making it takes.
pub(super) struct Factor<T: Scalar> {
    /// The panels of all fronts.
    pub(super) panels: Vec<T::Quad>,
    /// Reciprocals of the diagonal.
    pub(super) inverse: Vec<f64>,
    /// Update matrices that subtrees hand to the top.
    handed: Vec<T::Quad>,
    top: Stacks<T::Quad>,
    /// One pair for each thread that works on subtrees.
    stacks: Vec<Stacks<T::Quad>>,
}

/// Update matrices of fronts at even and at odd depth: a front writes to one stack while its children lie on top of
/// the other.
type Stacks<Q> = [Vec<Q>; 2];

fn stacks<Q: Quad>(lengths: [usize; 2]) -> Stacks<Q> {
    lengths.map(|length| vec![Q::default(); length])
}

impl<T: Scalar> Factor<T> {
    pub(super) fn new(symbolic: &Symbolic) -> Self {
        Self {
            panels: vec![T::Quad::default(); symbolic.panels(0..symbolic.len()).end],
            inverse: vec![0.0; symbolic.order.len()],
            handed: vec![T::Quad::default(); symbolic.handed],
            top: stacks(symbolic.top_stacks),
            stacks: Vec::new(),
        }
    }

    /// Factors the matrix with these values in the slots of the pattern.
    pub(super) fn factorize(
        &mut self,
        symbolic: &Symbolic,
        values: &[T],
    ) -> Result<(), NotPositiveDefinite> {
        let threads = n_threads().min(symbolic.subtrees.len());
        if self.stacks.len() < threads {
            self.stacks.resize_with(threads, || stacks(symbolic.subtree_stacks));
        }
        let queue = shares(symbolic, &mut self.panels, &mut self.inverse, &mut self.handed);
        let queue = Mutex::new(queue);
        let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).pop();
        self.stacks[..threads].par_iter_mut().try_for_each(|stacks| {
            while let Some(share) = next() {
                share.run(symbolic, values, stacks, &[])?;
            }
            Ok(())
        })?;
        for &s in &symbolic.top {
            let share = Share {
                fronts: s..s + 1,
                panels: &mut self.panels[symbolic.panels(s..s + 1)],
                inverse: &mut self.inverse[symbolic.pivots(s..s + 1)],
                handed: &mut [],
                handed_base: 0,
                threads: n_threads(),
            };
            share.run(symbolic, values, &mut self.top, &self.handed)?;
        }
        Ok(())
    }
}

/// Some fronts in a row, and what is written for them.
struct Share<'a, Q> {
    fronts: Range<usize>,
    panels: &'a mut [Q],
    inverse: &'a mut [f64],
    /// Their update matrices that go to the top, and where these begin.
    handed: &'a mut [Q],
    handed_base: usize,
    /// How many threads may work on one front.
    threads: usize,
}

/// The groups of subtrees, the largest last.
fn shares<'a, Q: Quad>(
    symbolic: &Symbolic,
    mut panels: &'a mut [Q],
    mut inverse: &'a mut [f64],
    mut handed: &'a mut [Q],
) -> Vec<Share<'a, Q>> {
    let mut shares = Vec::with_capacity(symbolic.subtrees.len());
    let mut end = 0;
    for Subtrees { fronts, handed: range } in &symbolic.subtrees {
        let gap = end..fronts.start;
        cut(&mut panels, symbolic.panels(gap.clone()).len());
        cut(&mut inverse, symbolic.pivots(gap).len());
        shares.push(Share {
            fronts: fronts.clone(),
            panels: cut(&mut panels, symbolic.panels(fronts.clone()).len()),
            inverse: cut(&mut inverse, symbolic.pivots(fronts.clone()).len()),
            handed: cut(&mut handed, range.len()),
            handed_base: range.start,
            threads: 1,
        });
        end = fronts.end;
    }
    shares.sort_by_key(|share| share.panels.len());
    shares
}

/// Cuts off the beginning of a slice.
pub(super) fn cut<'a, T>(slice: &mut &'a mut [T], length: usize) -> &'a mut [T] {
    let (head, tail) = std::mem::take(slice).split_at_mut(length);
    *slice = tail;
    head
}

impl<Q: Quad> Share<'_, Q> {
    /// Eliminates the fronts in turn.
    fn run(
        self,
        symbolic: &Symbolic,
        values: &[Q::Scalar],
        stacks: &mut Stacks<Q>,
        from_subtrees: &[Q],
    ) -> Result<(), NotPositiveDefinite> {
        let (panel_base, pivot_base) = (
            symbolic.panels(self.fronts.clone()).start,
            symbolic.pivots(self.fronts.clone()).start,
        );
        for s in self.fronts {
            let front = symbolic.front(s);
            let [even, odd] = &mut *stacks;
            let (mine, theirs) = if front.home.side == 0 { (even, &*odd) } else { (odd, &*even) };
            let update = match front.home.handed {
                true => &mut self.handed[front.home.offset - self.handed_base..],
                false => &mut mine[front.home.offset..],
            };
            let update = &mut update[..front.update_len()];
            let update_of = |child: &Front<'_>| {
                let from = if child.home.handed { from_subtrees } else { theirs.as_slice() };
                &from[child.home.offset..][..child.update_len()]
            };
            let range = symbolic.panels(s..s + 1);
            let panel = &mut self.panels[range.start - panel_base..range.end - panel_base];
            panel.fill(Q::default());
            for entry in symbolic.entries(s) {
                let value = values[entry.slot as usize];
                let value = if entry.is_transposed() { value.conjugate() } else { value };
                panel[entry.quad()].set(entry.lane(), value);
            }
            for child in symbolic.children(s) {
                match child.paired {
                    true => add_to_panel::<Q, 2>(panel, front, child, update_of(&child)),
                    false => add_to_panel::<Q, 1>(panel, front, child, update_of(&child)),
                }
            }
            let inverse = &mut self.inverse[front.first - pivot_base..][..front.columns];
            eliminate(front, panel, inverse, update, self.threads)?;
            for child in symbolic.children(s) {
                match child.paired {
                    true => add_to_update::<Q, 2>(update, front, child, update_of(&child)),
                    false => add_to_update::<Q, 1>(update, front, child, update_of(&child)),
                }
            }
        }
        Ok(())
    }
}

/// Adds the columns of a child's update matrix that are pivots of its parent, `RUN` rows at a time.
fn add_to_panel<Q: Quad, const RUN: usize>(
    panel: &mut [Q],
    parent: Front<'_>,
    child: Front<'_>,
    update: &[Q],
) {
    let places = child.places;
    let pivots = places.partition_point(|&place| (place as usize) < parent.columns);
    let skip = child.update_skip();
    for i in (0..places.len()).step_by(RUN) {
        let to = places[i] as usize;
        let row = &mut panel[to / 4 * parent.columns..][..parent.columns];
        let from = &update[update_len((skip + i) / 4) + skip..];
        for (&column, quad) in places[..pivots.min(i + RUN)].iter().zip(from) {
            row[column as usize].add_lanes::<RUN>(to, quad, skip + i);
        }
    }
}

/// Adds the other columns to the parent's update matrix.
fn add_to_update<Q: Quad, const RUN: usize>(
    into: &mut [Q],
    parent: Front<'_>,
    child: Front<'_>,
    update: &[Q],
) {
    let places = child.places;
    let pivots = places.partition_point(|&place| (place as usize) < parent.columns);
    let (skip, above) = (child.update_skip(), 4 * parent.update_blocks().start);
    for i in (pivots..places.len()).step_by(RUN) {
        let to = places[i] as usize - above;
        let row = &mut into[update_len(to / 4)..][..4 * (to / 4 + 1)];
        let from = &update[update_len((skip + i) / 4) + skip + pivots..];
        for (&column, quad) in places[pivots..i + RUN].iter().zip(from) {
            row[column as usize - above].add_lanes::<RUN>(to, quad, skip + i);
        }
    }
}

/// Eliminates the pivots of an assembled panel and writes what they leave to the update matrix.
fn eliminate<Q: Quad>(
    front: Front<'_>,
    panel: &mut [Q],
    inverse: &mut [f64],
    update: &mut [Q],
    threads: usize,
) -> Result<(), NotPositiveDefinite> {
    // Operations that are worth a thread: some fifty microseconds.
    const PART: f64 = 1e6;
    let columns = front.columns;
    let (rows, below) = panel.split_at_mut(front.pivot_blocks().end * columns);
    dispatch(FactorPivots { columns, rows, inverse }).ok_or(NotPositiveDefinite)?;
    let pivots = Pivots { columns, rows, inverse };
    let parts = ((front.work() / PART) as usize).clamp(1, threads);
    if parts == 1 {
        dispatch(SolveRows { pivots: &pivots, rows: below });
    } else {
        let strip = (below.len() / columns).div_ceil(parts).next_multiple_of(Q::Scalar::HEIGHT);
        below
            .par_chunks_mut(strip.max(1) * columns)
            .for_each(|rows| dispatch(SolveRows { pivots: &pivots, rows }));
    }
    let blocks = front.update_blocks();
    let below = &panel[blocks.start * columns..blocks.end * columns];
    if parts == 1 {
        dispatch(Update { columns, below, blocks: 0..blocks.len(), update });
        return Ok(());
    }
    let (mut rest, mut end) = (update, 0);
    let strips: Vec<_> = (1..=parts)
        .map(|k| {
            let next = blocks.len() as f64 * (k as f64 / parts as f64).sqrt();
            let next = (next.ceil() as usize).next_multiple_of(Q::Scalar::HEIGHT).min(blocks.len());
            let strip = std::mem::replace(&mut end, next)..next;
            let length = update_len(strip.end) - update_len(strip.start);
            Update { columns, below, blocks: strip, update: cut(&mut rest, length) }
        })
        .collect();
    strips.into_par_iter().for_each(dispatch);
    Ok(())
}
