//! Solves with a factor: forwards through the fronts, and back.

use super::kernels::{Kernel, dispatch};
use super::numeric::{Factor, cut};
use super::pieces::{Piece, Pieces};
use super::quad::{Quad, Scalar};
use super::symbolic::{Front, Symbolic};
use seamstress_parallel::prelude::*;

/// A matrix that has been factored.
#[derive(Clone, Copy)]
pub(super) struct Factored<'a, T: Scalar> {
    pub(super) symbolic: &'a Symbolic,
    pub(super) pieces: &'a Pieces,
    pub(super) factor: &'a Factor<T>,
}

/// Memory of a solve with `N` right-hand sides.
pub(super) struct Workspace<T: Scalar, const N: usize> {
    /// The vectors of the pieces, one after the other.
    x: Vec<[T; N]>,
    /// Of each piece as many as its widest front has columns.
    sums: Vec<[T::Quad; N]>,
}

impl<T: Scalar, const N: usize> Workspace<T, N> {
    pub(super) fn new(Pieces { subtrees, top, .. }: &Pieces) -> Self {
        let length = subtrees.iter().map(Piece::len).sum::<usize>() + top.len();
        let widest = subtrees.iter().map(|piece| piece.widest).sum::<usize>() + top.widest;
        Self { x: vec![[T::default(); N]; length], sums: vec![[T::Quad::default(); N]; widest] }
    }

    /// Solves for `N` columns, one after the other in `rhs`. `R` block rows of a panel are worked on together, which is
    /// a matter of speed only.
    pub(super) fn solve<const R: usize>(&mut self, system: Factored<'_, T>, rhs: &mut [T]) {
        let Pieces { subtrees, top, .. } = system.pieces;
        let (mut x, mut sums) = (&mut self.x[..], &mut self.sums[..]);
        let mut top = Part::new(top, &mut x, &mut sums);
        let parts = subtrees.iter().map(|piece| Part::new(piece, &mut x, &mut sums));
        let mut parts: Vec<_> = parts.collect();
        let n = system.symbolic.order.len();

        parts.par_iter_mut().for_each(|part| {
            part.load(rhs, n);
            let fronts = part.piece.fronts.clone();
            dispatch(Forwards::<T, _, R, N> { system, fronts, x: part.x });
        });
        top.load(rhs, n);
        for part in &mut parts {
            for (&k, x) in part.piece.rim.iter().zip(part.rim()) {
                let sum = &mut top.x[k as usize];
                (0..N).for_each(|n| sum[n] = sum[n] + x[n]);
            }
        }
        let fronts = || top.piece.fronts.iter().copied();
        dispatch(Forwards::<T, _, R, N> { system, fronts: fronts(), x: top.x });
        let (fronts, sums) = (fronts(), &mut *top.sums);
        dispatch(Backwards::<T, _, R, N> { system, fronts, x: top.x, sums });
        parts.par_iter_mut().for_each(|part| {
            for (&k, x) in part.piece.rim.iter().zip(part.rim()) {
                *x = top.x[k as usize];
            }
            let Part { piece, x, sums } = part;
            let fronts = piece.fronts.clone();
            dispatch(Backwards::<T, _, R, N> { system, fronts, x, sums });
        });

        top.store(rhs, n);
        parts.iter().for_each(|part| part.store(rhs, n));
    }
}

/// A piece and its share of the memory.
struct Part<'a, T: Scalar, F, const N: usize> {
    piece: &'a Piece<F>,
    x: &'a mut [[T; N]],
    sums: &'a mut [[T::Quad; N]],
}

impl<'a, T: Scalar, F, const N: usize> Part<'a, T, F, N> {
    /// Cuts its share off the memory of all.
    fn new(
        piece: &'a Piece<F>,
        x: &mut &'a mut [[T; N]],
        sums: &mut &'a mut [[T::Quad; N]],
    ) -> Self {
        Self { piece, x: cut(x, piece.len()), sums: cut(sums, piece.widest) }
    }

    fn rim(&mut self) -> &mut [[T; N]] {
        &mut self.x[self.piece.unknowns.len()..]
    }

    /// Takes its unknowns from right-hand sides of length `n`; the rim is zero.
    fn load(&mut self, rhs: &[T], n: usize) {
        for (x, &i) in self.x.iter_mut().zip(&self.piece.unknowns) {
            *x = std::array::from_fn(|k| rhs[k * n + i as usize]);
        }
        self.rim().fill([T::default(); N]);
    }

    /// Gives its unknowns back.
    fn store(&self, rhs: &mut [T], n: usize) {
        for (x, &i) in self.x.iter().zip(&self.piece.unknowns) {
            (0..N).for_each(|k| rhs[k * n + i as usize] = x[k]);
        }
    }
}

/// Solves `L y = b` in place for fronts of one piece.
struct Forwards<'a, T: Scalar, F, const R: usize, const N: usize> {
    system: Factored<'a, T>,
    fronts: F,
    x: &'a mut [[T; N]],
}

impl<T: Scalar, F: Iterator<Item = usize>, const R: usize, const N: usize> Kernel
    for Forwards<'_, T, F, R, N>
{
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let Self { system, fronts, x } = self;
        for s in fronts {
            Panel::<T::Quad>::new(system, s).solve_forwards::<FMA, R, N>(x);
        }
    }
}

/// Solves `L^H x = y` in place for fronts of one piece.
struct Backwards<'a, T: Scalar, F, const R: usize, const N: usize> {
    system: Factored<'a, T>,
    fronts: F,
    x: &'a mut [[T; N]],
    sums: &'a mut [[T::Quad; N]],
}

impl<T: Scalar, F: DoubleEndedIterator<Item = usize>, const R: usize, const N: usize> Kernel
    for Backwards<'_, T, F, R, N>
{
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let Self { system, fronts, x, sums } = self;
        for s in fronts.rev() {
            Panel::<T::Quad>::new(system, s).solve_backwards::<FMA, R, N>(x, sums);
        }
    }
}

/// The panel of a front, with rows as its piece numbers them.
struct Panel<'a, Q> {
    front: Front<'a>,
    first: usize,
    others: &'a [u32],
    rows: &'a [Q],
    /// Reciprocals of the diagonal.
    inverse: &'a [f64],
}

impl<'a, Q: Quad> Panel<'a, Q> {
    #[inline(always)]
    fn new(system: Factored<'a, Q::Scalar>, s: usize) -> Self {
        let Factored { symbolic, pieces, factor } = system;
        let front = symbolic.front(s);
        let inverse = &factor.inverse[front.first..][..front.columns];
        Self {
            front,
            first: pieces.first[s] as usize,
            others: &pieces.rows[symbolic.row_range(s..s + 1)],
            rows: &factor.panels[symbolic.panels(s..s + 1)],
            inverse,
        }
    }

    /// Block rows of the pivots.
    #[inline(always)]
    fn pivots(&self) -> std::slice::ChunksExact<'a, Q> {
        self.rows[..self.front.pivot_blocks().end * self.front.columns]
            .chunks_exact(self.front.columns)
    }

    /// Block rows that have other rows, with these, as strips of `R`. In the first one pivots may come first.
    #[inline(always)]
    fn others<const R: usize>(&self) -> impl Iterator<Item = (&'a [Q], usize, &'a [u32])> {
        let columns = self.front.columns;
        let blocks = self.front.update_blocks();
        let mut skip = self.front.update_skip();
        let mut rows = self.others;
        self.rows[blocks.start * columns..blocks.end * columns].chunks(R * columns).map(
            move |strip| {
                let count = (4 * R - skip).min(rows.len());
                let (these, rest) = rows.split_at(count);
                rows = rest;
                (strip, std::mem::take(&mut skip), these)
            },
        )
    }

    /// Solves for the unknowns of the pivots and subtracts what they contribute to the rows below.
    #[inline(always)]
    fn solve_forwards<const FMA: bool, const R: usize, const N: usize>(
        &self,
        x: &mut [[Q::Scalar; N]],
    ) {
        let columns = self.front.columns;
        let start = self.first + columns;
        let (done, later) = x.split_at_mut(start);
        let y = &mut done[self.first..];
        // Right-hand sides are often zero but for a few rows.
        if y.iter().flatten().all(|&y| y == Q::Scalar::default()) {
            return;
        }
        for (j, row) in self.pivots().enumerate() {
            let first = 4 * j;
            let [acc] = times::<Q, FMA, 1, N>(row, columns, &y[..first]);
            for l in 0..(columns - first).min(4) {
                for n in 0..N {
                    let mut value = y[first + l][n] - acc[n].get(l);
                    for k in first..first + l {
                        value = value - row[k].get(l) * y[k][n];
                    }
                    y[first + l][n] = value.scale(self.inverse[first + l]);
                }
            }
        }
        let y = &*y;
        let mut subtract = |blocks: &[[Q; N]], skip: usize, rows: &[u32]| {
            for (l, &row) in (skip..).zip(rows) {
                let target = &mut later[row as usize - start];
                for n in 0..N {
                    target[n] = target[n] - blocks[l / 4][n].get(l);
                }
            }
        };
        for (strip, skip, rows) in self.others::<R>() {
            if strip.len() == R * columns {
                subtract(&times::<Q, FMA, R, N>(strip, columns, y), skip, rows);
            } else {
                let mut blocks = [[Q::default(); N]; R];
                for (block, strip) in blocks.iter_mut().zip(strip.chunks_exact(columns)) {
                    [*block] = times::<Q, FMA, 1, N>(strip, columns, y);
                }
                subtract(&blocks, skip, rows);
            }
        }
    }

    /// Solves for the unknowns of the pivots, those of the rows below being known.
    #[inline(always)]
    fn solve_backwards<const FMA: bool, const R: usize, const N: usize>(
        &self,
        x: &mut [[Q::Scalar; N]],
        sums: &mut [[Q; N]],
    ) {
        let columns = self.front.columns;
        let start = self.first + columns;
        let (done, later) = x.split_at_mut(start);
        let y = &mut done[self.first..];
        let sums = &mut sums[..columns];
        sums.fill([Q::default(); N]);
        for (strip, skip, rows) in self.others::<R>() {
            let mut blocks = [[Q::default(); N]; R];
            for (l, &row) in (skip..).zip(rows) {
                for n in 0..N {
                    blocks[l / 4][n].set(l, later[row as usize - start][n]);
                }
            }
            if strip.len() == R * columns {
                add_transposed::<Q, FMA, R, N>(strip, columns, &blocks, sums);
            } else {
                for (block, strip) in blocks.into_iter().zip(strip.chunks_exact(columns)) {
                    add_transposed::<Q, FMA, 1, N>(strip, columns, &[block], sums);
                }
            }
        }
        for (j, row) in self.pivots().enumerate().rev() {
            let first = 4 * j;
            let width = (columns - first).min(4);
            let mut solved = [[Q::default(); N]];
            for l in (0..width).rev() {
                for n in 0..N {
                    let mut value = y[first + l][n] - sums[first + l][n].sum();
                    for k in l + 1..width {
                        value = value - row[first + l].get(k).conjugate() * y[first + k][n];
                    }
                    value = value.scale(self.inverse[first + l]);
                    y[first + l][n] = value;
                    solved[0][n].set(l, value);
                }
            }
            add_transposed::<Q, FMA, 1, N>(row, columns, &solved, &mut sums[..first]);
        }
    }
}

/// Block rows times `y`: `R` block rows.
#[inline(always)]
fn times<Q: Quad, const FMA: bool, const R: usize, const N: usize>(
    rows: &[Q],
    columns: usize,
    y: &[[Q::Scalar; N]],
) -> [[Q; N]; R] {
    let a: [&[Q]; R] = std::array::from_fn(|r| &rows[r * columns..][..y.len()]);
    let mut acc = [[Q::default(); N]; R];
    for k in 0..y.len() {
        for r in 0..R {
            for n in 0..N {
                acc[r][n].add_product::<FMA>(&a[r][k], y[k][n]);
            }
        }
    }
    acc
}

/// `sums[k] += conj(column k) x`, lane by lane, for `R` block rows.
#[inline(always)]
fn add_transposed<Q: Quad, const FMA: bool, const R: usize, const N: usize>(
    rows: &[Q],
    columns: usize,
    x: &[[Q; N]; R],
    sums: &mut [[Q; N]],
) {
    let a: [&[Q]; R] = std::array::from_fn(|r| &rows[r * columns..][..sums.len()]);
    for k in 0..sums.len() {
        let mut acc = sums[k];
        for r in 0..R {
            for n in 0..N {
                acc[n].add_inner::<FMA>(&a[r][k], &x[r][n]);
            }
        }
        sums[k] = acc;
    }
}
