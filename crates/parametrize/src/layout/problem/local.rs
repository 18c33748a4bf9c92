//! Work on every triangle, in parallel, and its sums.

use super::LayoutProblem;
use crate::energy::{CHUNK, Triangle};
use seamstress_parallel::prelude::*;
use std::ops::Range;

impl LayoutProblem {
    /// Assembles a matrix and a vector from a block and a vector per triangle, both in the six corner
    /// coordinates (the block as the lower triangle by rows), for [`LayoutProblem::factorize`] or
    /// [`LayoutProblem::factorize_as_is`].
    ///
    /// `local` works on the triangle's own `state` and on a tally; the tallies of fixed ranges of triangles
    /// are returned in order, for reductions that do not depend on the number of threads.
    pub fn assemble<S: Send, T: Default + Send>(
        &mut self,
        state: &mut [S],
        vector: &mut [f64],
        local: impl Fn(&Triangle, &mut S, &mut T, &mut [f64; 6], &mut [f64; 21]) + Sync,
    ) -> Vec<T> {
        let tallies = self.fill_with_state(state, local);
        self.assembly.sum_matrix(&self.blocks, &mut self.matrix);
        self.assembly.sum_vector(&self.locals, vector);
        tallies
    }

    /// Assembles a vector alone, in the way of [`LayoutProblem::assemble`].
    pub fn assemble_vector<S: Send, T: Default + Send>(
        &mut self,
        state: &mut [S],
        vector: &mut [f64],
        local: impl Fn(&Triangle, &mut S, &mut T, &mut [f64; 6]) + Sync,
    ) -> Vec<T> {
        let mut tasks = Vec::new();
        let (mut locals, mut states) = (self.locals.as_mut_slice(), state);
        for range in chunks(self.triangles.len()) {
            let (chunk, more_locals) =
                locals.split_at_mut(span(&range, |e| self.assembly.local(e)));
            let (state, more_states) = states.split_at_mut(range.len());
            (locals, states) = (more_locals, more_states);
            tasks.push((range, chunk, state));
        }
        let work = |(range, locals, states): (Range<usize>, &mut [f64], &mut [S])| {
            let (mut tally, mut l, mut at) = (T::default(), [0.0; 6], 0);
            for (e, state) in range.zip(states) {
                local(&self.triangles[e], state, &mut tally, &mut l);
                let len = self.assembly.local(e).len();
                self.maps[e].pull_vector_back(&l, &mut locals[at..at + len]);
                at += len;
            }
            tally
        };
        let tallies = tasks.into_par_iter().map(work).collect();
        self.assembly.sum_vector(&self.locals, vector);
        tallies
    }

    /// Visits every triangle with its own state, tallies as in [`LayoutProblem::assemble`].
    pub fn visit<S: Send, T: Default + Send>(
        &self,
        state: &mut [S],
        local: impl Fn(&Triangle, &mut S, &mut T) + Sync,
    ) -> Vec<T> {
        let chunks = self.triangles.par_chunks(CHUNK).zip(state.par_chunks_mut(CHUNK));
        let work = |(triangles, states): (&[Triangle], &mut [S])| {
            let mut tally = T::default();
            for (t, state) in triangles.iter().zip(states) {
                local(t, state, &mut tally);
            }
            tally
        };
        chunks.map(work).collect()
    }

    /// Runs `local` on triangles without state.
    pub(super) fn fill_triangles(
        &mut self,
        local: impl Fn(&Triangle, &mut [f64; 6], &mut [f64; 21]) + Sync,
    ) {
        let mut stateless = vec![(); self.triangles.len()];
        self.fill_with_state(&mut stateless, |t, (), (): &mut (), l, b| local(t, l, b));
    }

    /// Runs `local` on every triangle in the six corner coordinates and carries the results over to
    /// the element's unknowns.
    fn fill_with_state<S: Send, T: Default + Send>(
        &mut self,
        state: &mut [S],
        local: impl Fn(&Triangle, &mut S, &mut T, &mut [f64; 6], &mut [f64; 21]) + Sync,
    ) -> Vec<T> {
        let assembly = &self.assembly;
        let mut tasks = Vec::new();
        let (mut blocks, mut locals) = (self.blocks.as_mut_slice(), self.locals.as_mut_slice());
        let mut states = state;
        for range in chunks(self.triangles.len()) {
            let (block, more_blocks) = blocks.split_at_mut(span(&range, |e| assembly.block(e)));
            let (vector, more_locals) = locals.split_at_mut(span(&range, |e| assembly.local(e)));
            let (state, more_states) = states.split_at_mut(range.len());
            (blocks, locals, states) = (more_blocks, more_locals, more_states);
            tasks.push((range, block, vector, state));
        }
        let work =
            |(range, blocks, locals, states): (Range<usize>, &mut [f64], &mut [f64], &mut [S])| {
                let (mut tally, mut b, mut l) = (T::default(), [0.0; 21], [0.0; 6]);
                let (mut block_at, mut local_at) = (0, 0);
                for (e, state) in range.zip(states) {
                    local(&self.triangles[e], state, &mut tally, &mut l, &mut b);
                    let (block_len, local_len) = (assembly.block(e).len(), assembly.local(e).len());
                    let block = &mut blocks[block_at..block_at + block_len];
                    self.maps[e].pull_block_back(&b, block, local_len);
                    let vector = &mut locals[local_at..local_at + local_len];
                    self.maps[e].pull_vector_back(&l, vector);
                    block_at += block_len;
                    local_at += local_len;
                }
                tally
            };
        tasks.into_par_iter().map(work).collect()
    }
}

/// Fixed ranges of triangles, one parallel task each.
fn chunks(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count).step_by(CHUNK).map(move |begin| begin..(begin + CHUNK).min(count))
}

/// Length of what the elements of a range hold, one after the other.
fn span(range: &Range<usize>, of: impl Fn(usize) -> Range<usize>) -> usize {
    of(range.end - 1).end - of(range.start).start
}
