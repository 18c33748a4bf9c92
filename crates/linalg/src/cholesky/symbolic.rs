//! The symbolic analysis: rows of the fronts, places in memory, and what may run side by side.
//!
//! A front has a *panel*, the columns of its pivots, and an *update matrix*, what it hands to its parent. Both are
//! stored by block rows of four rows: a block row holds its columns one after the other, four numbers each (a
//! [`Quad`](super::quad::Quad)). A panel has the rows of the pivots first, then the others. The block rows of an
//! update matrix are those of the panel from the first one on that has other rows; if pivots come first in it, their
//! rows and columns are there but mean nothing. Block row `i` of an update matrix holds columns `0 .. 4 (i + 1)` only.

use super::NONE;
use super::forest::{Forest, roots};
use super::fronts::{Fronts, Groups, Size};
use crate::buckets::Buckets;
use crate::pattern::Pattern;
use std::ops::Range;

/// Everything about a factorisation that does not depend on values.
pub(super) struct Symbolic {
    /// The unknown that is eliminated `k`-th; rows and columns are named by `k`.
    pub(super) order: Vec<u32>,
    /// First pivot of each front; one more than there are fronts.
    pivots: Vec<u32>,
    /// Children of each front; the last list are the roots.
    children: Buckets,
    /// Rows of each front below its pivots, ascending.
    row_offsets: Vec<usize>,
    rows: Vec<u32>,
    /// Place of each of these rows among the rows of the parent's panel.
    places: Vec<u32>,
    /// Fronts whose rows come in pairs, at even places of their update matrix and of the parent's panel.
    paired: Vec<bool>,
    /// Where panels start, in quads.
    panel_offsets: Vec<usize>,
    /// Entries of the matrix in each panel.
    entry_offsets: Vec<usize>,
    entries: Vec<Entry>,
    /// Groups of subtrees that do not depend on each other, ascending.
    pub(super) subtrees: Vec<Subtrees>,
    /// The other fronts, ascending; they come after all subtrees.
    pub(super) top: Vec<usize>,
    /// Where update matrices lie, in quads.
    homes: Vec<Home>,
    /// Lengths of the stacks that a group of subtrees needs at most, and those of the top.
    pub(super) subtree_stacks: [usize; 2],
    pub(super) top_stacks: [usize; 2],
    /// Length of what the subtrees hand to the top.
    pub(super) handed: usize,
}

/// Neighbouring subtrees that are worked off together.
#[derive(Debug, Clone)]
pub(super) struct Subtrees {
    pub(super) fronts: Range<usize>,
    /// Where their update matrices go among those that are handed to the top.
    pub(super) handed: Range<usize>,
}

/// An entry of the matrix and its place in a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Entry {
    /// Slot of the pattern.
    pub(super) slot: u32,
    /// Number of the panel; the lowest bit is set where the entry comes to lie above the diagonal, so that the
    /// panel gets its conjugate.
    number: u32,
}

impl Entry {
    pub(super) fn quad(self) -> usize {
        (self.number >> 3) as usize
    }

    pub(super) fn lane(self) -> usize {
        (self.number >> 1) as usize % 4
    }

    pub(super) fn is_transposed(self) -> bool {
        self.number % 2 == 1
    }
}

/// Where an update matrix lies.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Home {
    /// Parity of the front's depth in the tree: on which of two stacks.
    pub(super) side: usize,
    /// Quads before it.
    pub(super) offset: usize,
    /// True for the root of a subtree, whose matrix goes to the top and not to a stack.
    pub(super) handed: bool,
}

/// A front, as far as it does not depend on values.
#[derive(Clone, Copy)]
pub(super) struct Front<'a> {
    /// Pivots.
    pub(super) first: usize,
    pub(super) columns: usize,
    /// Rows below the pivots, and their places in the parent's panel.
    pub(super) rows: &'a [u32],
    pub(super) places: &'a [u32],
    pub(super) paired: bool,
    pub(super) home: Home,
}

impl Front<'_> {
    /// All rows of the panel.
    pub(super) fn height(&self) -> usize {
        self.columns + self.rows.len()
    }

    /// Block rows of the panel.
    pub(super) fn blocks(&self) -> Range<usize> {
        0..self.height().div_ceil(4)
    }

    /// Block rows of the panel that have pivots.
    pub(super) fn pivot_blocks(&self) -> Range<usize> {
        0..self.columns.div_ceil(4)
    }

    /// Block rows of the panel that the update matrix has.
    pub(super) fn update_blocks(&self) -> Range<usize> {
        if self.rows.is_empty() { 0..0 } else { self.columns / 4..self.blocks().end }
    }

    /// Rows of pivots that come first in the update matrix.
    pub(super) fn update_skip(&self) -> usize {
        self.columns % 4
    }

    /// Operations, about.
    pub(super) fn work(&self) -> f64 {
        Size { pivots: self.columns, others: self.rows.len() }.work()
    }

    /// Quads of the update matrix.
    pub(super) fn update_len(&self) -> usize {
        update_len(self.update_blocks().len())
    }
}

/// Quads of the first block rows of an update matrix.
#[inline(always)]
pub(super) fn update_len(blocks: usize) -> usize {
    2 * blocks * (blocks + 1)
}

impl Symbolic {
    /// Of a matrix whose entries are so many real numbers each.
    pub(super) fn new(pattern: &Pattern, order: &[u32], reals: usize) -> Self {
        let groups = Groups::new(pattern, order);

        let fronts = Fronts::new(&groups, reals);
        let m = fronts.len();
        let roots = |&p: &u32| p.min(m as u32);
        let children = Buckets::new(m + 1, &fronts.parent.iter().map(roots).collect::<Vec<_>>());

        // The final order of the unknowns, and where each group and front begins in it.
        let mut final_order = Vec::with_capacity(order.len());
        let mut begins = Vec::with_capacity(fronts.sequence.len() + 1);
        for &group in &fronts.sequence.nodes {
            begins.push(final_order.len() as u32);
            let [from, to] = [0, 1].map(|k| groups.offsets[group as usize + k] as usize);
            final_order.extend_from_slice(&order[from..to]);
        }
        begins.push(final_order.len() as u32);
        let pivots: Vec<u32> = fronts.offsets.iter().map(|&g| begins[g as usize]).collect();
        let (row_offsets, rows) = rows_below(&fronts, &children, &begins);

        let mut symbolic = Self {
            order: final_order,
            pivots,
            children,
            places: vec![0; rows.len()],
            row_offsets,
            rows,
            paired: vec![false; m],
            panel_offsets: vec![0],
            entry_offsets: vec![0],
            entries: Vec::with_capacity(pattern.len()),
            subtrees: Vec::new(),
            top: Vec::new(),
            homes: vec![Home::default(); m],
            subtree_stacks: [0; 2],
            top_stacks: [0; 2],
            handed: 0,
        };

        symbolic.place_entries(pattern);
        symbolic.plan(&fronts.parent);
        symbolic
    }

    /// Number of fronts.
    pub(super) fn len(&self) -> usize {
        self.paired.len()
    }

    pub(super) fn front(&self, s: usize) -> Front<'_> {
        let range = self.row_range(s..s + 1);
        Front {
            first: self.pivots[s] as usize,
            columns: (self.pivots[s + 1] - self.pivots[s]) as usize,
            rows: &self.rows[range.clone()],
            places: &self.places[range],
            paired: self.paired[s],
            home: self.homes[s],
        }
    }

    pub(super) fn children(&self, s: usize) -> impl Iterator<Item = Front<'_>> {
        self.children.of(s).iter().map(|&c| self.front(c as usize))
    }

    /// Entries of the matrix in a front's panel.
    pub(super) fn entries(&self, s: usize) -> &[Entry] {
        &self.entries[self.entry_offsets[s]..self.entry_offsets[s + 1]]
    }

    /// Quads of the panels of some fronts in a row.
    pub(super) fn panels(&self, fronts: Range<usize>) -> Range<usize> {
        self.panel_offsets[fronts.start]..self.panel_offsets[fronts.end]
    }

    /// Pivots of some fronts in a row.
    pub(super) fn pivots(&self, fronts: Range<usize>) -> Range<usize> {
        self.pivots[fronts.start] as usize..self.pivots[fronts.end] as usize
    }

    /// The parent of each front, or [`NONE`].
    pub(super) fn parents(&self) -> Vec<u32> {
        let mut parents = vec![NONE; self.len()];
        for s in 0..self.len() {
            self.children.of(s).iter().for_each(|&child| parents[child as usize] = s as u32);
        }
        parents
    }

    /// Where rows of some fronts in a row lie among those of all.
    pub(super) fn row_range(&self, fronts: Range<usize>) -> Range<usize> {
        self.row_offsets[fronts.start]..self.row_offsets[fronts.end]
    }

    /// The front in which each unknown is a pivot.
    pub(super) fn front_of(&self) -> Vec<u32> {
        let sizes = (0..self.len()).map(|s| (s, self.front(s).columns));
        sizes.flat_map(|(s, columns)| std::iter::repeat_n(s as u32, columns)).collect()
    }

    /// Finds the place of rows in the parents' panels, and of the matrix entries in their own.
    fn place_entries(&mut self, pattern: &Pattern) {
        let n = self.order.len();
        let mut position = vec![0u32; n];
        self.order.iter().enumerate().for_each(|(k, &i)| position[i as usize] = k as u32);
        let columns = (0..n).flat_map(|j| {
            let slots = pattern.column_offsets[j]..pattern.column_offsets[j + 1];
            slots.map(move |slot| (slot as usize, j))
        });
        let entry: Vec<[u32; 2]> =
            columns.map(|(slot, j)| [position[pattern.rows[slot] as usize], position[j]]).collect();
        let front_of = self.front_of();
        let keys: Vec<u32> = entry.iter().map(|&[a, b]| front_of[a.min(b) as usize]).collect();
        let by_front = Buckets::new(self.len(), &keys);

        let mut place = vec![0u32; n];
        for s in 0..self.len() {
            let front = self.front(s);
            let (first, columns, blocks) = (front.first, front.columns, front.blocks().len());
            (0..columns).for_each(|k| place[first + k] = k as u32);
            for (k, &row) in front.rows.iter().enumerate() {
                place[row as usize] = (columns + k) as u32;
            }
            for &child in self.children.of(s) {
                let range = self.row_range(child as usize..child as usize + 1);
                for k in range.clone() {
                    self.places[k] = place[self.rows[k] as usize];
                }
                let skip = self.front(child as usize).update_skip();
                let (pairs, rest) = self.places[range].as_chunks::<2>();
                self.paired[child as usize] = skip.is_multiple_of(2)
                    && columns.is_multiple_of(2)
                    && rest.is_empty()
                    && pairs.iter().all(|&[a, b]| a.is_multiple_of(2) && b == a + 1);
            }
            for &slot in by_front.of(s) {
                let [a, b] = entry[slot as usize];
                let row = place[a.max(b) as usize] as usize;
                let column = a.min(b) as usize - first;
                let number = 4 * (row / 4 * columns + column) + row % 4;
                let number = 2 * number as u32 + u32::from(a < b);
                self.entries.push(Entry { slot, number });
            }
            self.entry_offsets.push(self.entries.len());
            self.panel_offsets.push(self.panel_offsets[s] + blocks * columns);
        }
    }

    /// Cuts the tree into subtrees and finds a home for the update matrices. It depends on the tree alone.
    fn plan(&mut self, parent: &[u32]) {
        // No subtree has more than this part of the work, nor have several that go together.
        const PARTS: f64 = 16.0;
        // Work of a front besides its operations, and what is too little for several threads: 50 microseconds.
        const FRONT: f64 = 2500.0;
        const LEAST: f64 = 1e6;
        let parent_of = |s: usize| (parent[s] != NONE).then_some(parent[s] as usize);
        for s in (0..self.len()).rev() {
            self.homes[s].side = parent_of(s).map_or(0, |p| 1 - self.homes[p].side);
        }
        let work = (0..self.len()).map(|s| self.front(s).work() + FRONT).collect();
        let forest = Forest::new(parent, work, PARTS, LEAST);
        for fronts in forest.subtrees {
            let before = self.handed;
            for s in roots(parent, fronts.clone()) {
                self.homes[s].handed = true;
                self.homes[s].offset = self.handed;
                self.handed += self.front(s).update_len();
            }
            let heights = self.stack(fronts.clone());
            self.subtree_stacks = [0, 1].map(|k| self.subtree_stacks[k].max(heights[k]));
            self.subtrees.push(Subtrees { fronts, handed: before..self.handed });
        }
        self.top_stacks = self.stack(forest.top.iter().copied());
        self.top = forest.top;
    }

    /// Places the update matrices of fronts on the stacks; returns the heights that takes.
    fn stack(&mut self, fronts: impl Iterator<Item = usize>) -> [usize; 2] {
        let (mut height, mut peak) = ([0usize; 2], [0usize; 2]);
        for s in fronts {
            let Home { side, handed, .. } = self.homes[s];
            if !handed {
                self.homes[s].offset = height[side];
                height[side] += self.front(s).update_len();
                peak[side] = peak[side].max(height[side]);
            }
            let children = self.children(s).filter(|child| !child.home.handed);
            height[1 - side] -= children.map(|child| child.update_len()).sum::<usize>();
        }
        peak
    }
}

/// Rows below the pivots of every front: those of its entries and of its children.
fn rows_below(fronts: &Fronts<'_>, children: &Buckets, begins: &[u32]) -> (Vec<usize>, Vec<u32>) {
    let m = fronts.len();
    let (mut offsets, mut groups): (Vec<usize>, Vec<u32>) = (vec![0], Vec::new());
    let mut seen = vec![NONE; fronts.sequence.len()];
    let mut list = Vec::new();
    for s in 0..m {
        list.clear();
        let (begin, end) = (fronts.offsets[s], fronts.offsets[s + 1]);
        let mut add = |row: u32| {
            if row >= end && seen[row as usize] != s as u32 {
                seen[row as usize] = s as u32;
                list.push(row);
            }
        };
        (begin..end).flat_map(|k| fronts.sequence.neighbours(k)).for_each(&mut add);
        for &child in children.of(s) {
            groups[offsets[child as usize]..offsets[child as usize + 1]]
                .iter()
                .copied()
                .for_each(&mut add);
        }
        list.sort_unstable();
        groups.extend_from_slice(&list);
        offsets.push(groups.len());
    }
    let unknowns = |group: &u32| begins[*group as usize]..begins[*group as usize + 1];
    let (mut row_offsets, mut rows) = (vec![0], Vec::new());
    for s in 0..m {
        rows.extend(groups[offsets[s]..offsets[s + 1]].iter().flat_map(unknowns));
        row_offsets.push(rows.len());
    }
    (row_offsets, rows)
}
