//! Dense kernels on panels and update matrices, stored as [`symbolic`](super::symbolic) says.
//!
//! Products walk block rows in step, so that nothing is packed and no index is checked in their loops. Every
//! number is the same sum in the same order however rows are put together.

use super::quad::{Quad, Scalar};
use super::symbolic::update_len;
use std::ops::Range;

/// Work that gains from the processor's vector instructions.
pub(super) trait Kernel {
    type Output;

    /// Does the work; `FMA` if multiplications and additions are to be rounded together. To be inlined, so that it
    /// is compiled for the instructions of its caller.
    fn run<const FMA: bool>(self) -> Self::Output;
}

/// Runs a kernel with the best instructions that the processor has.
pub(super) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx2,fma")]
        fn with_avx2<K: Kernel>(kernel: K) -> K::Output {
            kernel.run::<true>()
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor has the features that the function is compiled for.
            return unsafe { with_avx2(kernel) };
        }
    }
    // On AArch64 they are part of the base; elsewhere they may be calls of a library.
    kernel.run::<{ cfg!(target_arch = "aarch64") }>()
}

/// `acc[r][w] -= sum over k of a[r][k] conj(b[k][w])`.
#[inline(always)]
fn subtract_product<Q: Quad, const FMA: bool, const R: usize, const W: usize>(
    acc: &mut [[Q; W]; R],
    a: [&[Q]; R],
    b: &[Q],
) {
    let a = a.map(|row| &row[..b.len()]);
    let mut local = *acc;
    for k in 0..b.len() {
        let column: [Q; R] = std::array::from_fn(|r| a[r][k]);
        let row: [Q::Scalar; W] = std::array::from_fn(|w| b[k].get(w));
        for (sums, column) in local.iter_mut().zip(&column) {
            for (sum, &factor) in sums.iter_mut().zip(&row) {
                sum.subtract_outer::<FMA>(column, factor);
            }
        }
    }
    *acc = local;
}

/// The pivots of a panel: its columns, the block rows of the pivots, and the reciprocals of the diagonal.
pub(super) struct Pivots<'a, Q> {
    pub(super) columns: usize,
    pub(super) rows: &'a [Q],
    pub(super) inverse: &'a [f64],
}

impl<Q: Quad> Pivots<'_, Q> {
    /// Columns from `4 j` on (`W` of them) of `R` block rows: subtracts what the columns before contribute, then
    /// solves with the triangle.
    #[inline(always)]
    fn solve_tile<const FMA: bool, const R: usize, const W: usize>(
        &self,
        rows: &mut [Q],
        j: usize,
    ) {
        let (first, columns) = (4 * j, self.columns);
        let pivot = &self.rows[j * columns..][..columns];
        let mut acc = [[Q::default(); W]; R];
        for r in 0..R {
            acc[r].copy_from_slice(&rows[r * columns + first..][..W]);
        }
        let a: [&[Q]; R] = std::array::from_fn(|r| &rows[r * columns..][..first]);
        subtract_product::<Q, FMA, R, W>(&mut acc, a, &pivot[..first]);
        let triangle = &pivot[first..][..W];
        let inverse = &self.inverse[first..][..W];
        for r in 0..R {
            for w in 0..W {
                let mut solved = acc[r][w];
                for v in 0..w {
                    solved.subtract_outer::<FMA>(&acc[r][v], triangle[v].get(w));
                }
                solved.scale(inverse[w]);
                acc[r][w] = solved;
            }
            rows[r * columns + first..][..W].copy_from_slice(&acc[r]);
        }
    }

    /// Solves `R` block rows with some blocks of pivots.
    #[inline(always)]
    fn solve_strip<const FMA: bool, const R: usize>(&self, rows: &mut [Q], blocks: Range<usize>) {
        for j in blocks {
            match self.columns - 4 * j {
                1 => self.solve_tile::<FMA, R, 1>(rows, j),
                2 => self.solve_tile::<FMA, R, 2>(rows, j),
                3 => self.solve_tile::<FMA, R, 3>(rows, j),
                _ => self.solve_tile::<FMA, R, 4>(rows, j),
            }
        }
    }

    /// Solves block rows with some blocks of pivots, strip by strip while they are in the fastest memory.
    #[inline(always)]
    fn solve_rows<const FMA: bool>(&self, rows: &mut [Q], blocks: Range<usize>) {
        let height = Q::Scalar::HEIGHT;
        for strip in rows.chunks_mut(height * self.columns) {
            match strip.len() / self.columns {
                2 => self.solve_strip::<FMA, 2>(strip, blocks.clone()),
                _ => self.solve_strip::<FMA, 1>(strip, blocks.clone()),
            }
        }
    }
}

/// Factors one diagonal tile, `W` wide, whose block row has all columns before it done, and solves what is below it in
/// the block row. None unless it is positive definite.
#[inline(always)]
fn factor_tile<Q: Quad, const FMA: bool, const W: usize>(
    row: &mut [Q],
    inverse: &mut [f64],
    first: usize,
) -> Option<()> {
    let mut acc = [[Q::default(); W]];
    acc[0].copy_from_slice(&row[first..][..W]);
    subtract_product::<Q, FMA, 1, W>(&mut acc, [&row[..first]], &row[..first]);
    let [mut tile] = acc;
    for w in 0..W {
        let mut column = tile[w];
        for before in &tile[..w] {
            column.subtract_outer::<FMA>(before, before.get(w));
        }
        let pivot = column.get(w).real();
        if !(pivot > 0.0 && pivot < f64::INFINITY) {
            return None;
        }
        let root = pivot.sqrt();
        inverse[first + w] = 1.0 / root;
        column.scale(1.0 / root);
        (0..w).for_each(|l| column.set(l, Q::Scalar::default()));
        column.set(w, Q::Scalar::from(root));
        tile[w] = column;
    }
    row[first..][..W].copy_from_slice(&tile);
    Some(())
}

/// Factors the block rows of the pivots in place, and stores the reciprocals of the diagonal.
pub(super) struct FactorPivots<'a, Q> {
    pub(super) columns: usize,
    pub(super) rows: &'a mut [Q],
    pub(super) inverse: &'a mut [f64],
}

impl<Q: Quad> Kernel for FactorPivots<'_, Q> {
    /// None unless the block is positive definite.
    type Output = Option<()>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Option<()> {
        let Self { columns, rows, inverse } = self;
        for k in 0..columns.div_ceil(4) {
            let (done, rest) = rows.split_at_mut(k * columns);
            let row = &mut rest[..columns];
            let pivots = Pivots { columns, rows: done, inverse: &*inverse };
            pivots.solve_strip::<FMA, 1>(row, 0..k);
            match columns - 4 * k {
                1 => factor_tile::<Q, FMA, 1>(row, inverse, 4 * k)?,
                2 => factor_tile::<Q, FMA, 2>(row, inverse, 4 * k)?,
                3 => factor_tile::<Q, FMA, 3>(row, inverse, 4 * k)?,
                _ => factor_tile::<Q, FMA, 4>(row, inverse, 4 * k)?,
            }
        }
        Some(())
    }
}

/// Solves block rows below the pivots with them.
pub(super) struct SolveRows<'a, Q> {
    pub(super) pivots: &'a Pivots<'a, Q>,
    pub(super) rows: &'a mut [Q],
}

impl<Q: Quad> Kernel for SolveRows<'_, Q> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        self.pivots.solve_rows::<FMA>(self.rows, 0..self.pivots.columns.div_ceil(4));
    }
}

/// Writes some block rows of the update matrix: minus the block rows below times their transpose.
pub(super) struct Update<'a, Q> {
    pub(super) columns: usize,
    /// The block rows of the panel that the update matrix has.
    pub(super) below: &'a [Q],
    pub(super) blocks: Range<usize>,
    /// These block rows.
    pub(super) update: &'a mut [Q],
}

impl<Q: Quad> Kernel for Update<'_, Q> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let Self { columns, below, blocks, update } = self;
        let start = update_len(blocks.start);
        let mut i = blocks.start;
        while i < blocks.end {
            let height = (blocks.end - i).min(Q::Scalar::HEIGHT);
            let rows = &mut update[update_len(i) - start..update_len(i + height) - start];
            match height {
                2 => {
                    for j in 0..=i {
                        update_tile::<Q, FMA, 2>(rows, below, columns, [i, j]);
                    }
                    update_tile::<Q, FMA, 1>(&mut rows[4 * (i + 1)..], below, columns, [i + 1; 2]);
                }
                _ => {
                    for j in 0..=i {
                        update_tile::<Q, FMA, 1>(rows, below, columns, [i, j]);
                    }
                }
            }
            i += height;
        }
    }
}

/// Block column `j` of block rows `i` and following, which start `rows`.
#[inline(always)]
fn update_tile<Q: Quad, const FMA: bool, const R: usize>(
    rows: &mut [Q],
    below: &[Q],
    columns: usize,
    [i, j]: [usize; 2],
) {
    let mut acc = [[Q::default(); 4]; R];
    let a: [&[Q]; R] = std::array::from_fn(|r| &below[(i + r) * columns..][..columns]);
    subtract_product::<Q, FMA, R, 4>(&mut acc, a, &below[j * columns..][..columns]);
    for r in 0..R {
        rows[4 * (r * (i + 1) + j)..][..4].copy_from_slice(&acc[r]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cholesky::quad::Reals;

    /// A front of ones plus a heavy diagonal: its panel, 6 columns by 13 rows, factored, and its update matrix.
    fn front<const FMA: bool>() -> (Vec<Reals>, Vec<Reals>) {
        let (columns, rows) = (6, 13);
        let mut panel = vec![Reals::default(); columns * 4];
        for (column, row) in (0..columns).flat_map(|c| (c..rows).map(move |r| (c, r))) {
            let value = if row == column { 20.0 } else { 1.0 + row as f64 / 8.0 };
            panel[row / 4 * columns + column].set(row, value);
        }
        let mut inverse = vec![0.0; columns];
        let (pivots, below) = panel.split_at_mut(2 * columns);
        FactorPivots { columns, rows: pivots, inverse: &mut inverse }.run::<FMA>().unwrap();
        let pivots = Pivots { columns, rows: pivots, inverse: &inverse };
        SolveRows { pivots: &pivots, rows: below }.run::<FMA>();
        let mut update = vec![Reals::default(); update_len(3)];
        let below = &panel[columns..];
        Update { columns, below, blocks: 0..3, update: &mut update }.run::<FMA>();
        (panel, update)
    }

    #[test]
    fn kernels_factor_a_front_with_and_without_fused_operations() {
        for (panel, update) in [front::<false>(), front::<true>()] {
            let entry = |row: usize, column: usize| panel[row / 4 * 6 + column].get(row);
            for (row, column) in (0..13).flat_map(|r| (0..=r).map(move |c| (r, c))) {
                let common = column.min(5);
                let product: f64 = (0..=common).map(|k| entry(row, k) * entry(column, k)).sum();
                let original = if row == column { 20.0 } else { 1.0 + row as f64 / 8.0 };
                let expected = match column {
                    0..6 => original,
                    _ => {
                        let block = row / 4 - 1;
                        -update[update_len(block) + column - 4].get(row)
                    }
                };
                assert!((product - expected).abs() < 1e-13, "entry {row}, {column}");
            }
        }
    }
}
