//! The energy as a function of the integral coordinates alone.

use crate::linear::Dense;
use crate::space::IntegerSpace;
use seamstress_parallel::n_threads;
use seamstress_parallel::prelude::*;
use seamstress_parametrize::layout::problem::LayoutProblem;
use seamstress_parametrize::progress::{Cancelled, Watch};

/// Right-hand sides that one pass over the factor serves.
const COLUMNS: usize = 16;
/// Passes of each thread between two looks at the watch.
const PASSES: usize = 4;

/// Couplings of the last assembled matrix that touch a held unknown, as (row, column, value) with the
/// row held.
fn couplings(problem: &LayoutProblem) -> impl Iterator<Item = (usize, usize, f64)> {
    let n_free = problem.n_free();
    let (pattern, values) = problem.matrix();
    (0..pattern.order()).flat_map(move |column| {
        let slots =
            pattern.column_offsets[column] as usize..pattern.column_offsets[column + 1] as usize;
        slots
            .map(move |k| (pattern.rows[k] as usize, column, values[k]))
            .filter(move |(row, _, _)| *row >= n_free)
    })
}

/// `H_xX d`: what moving the held unknowns by `d` does to the gradient of the free ones.
pub fn couple(problem: &LayoutProblem, d: &[f64]) -> Vec<f64> {
    let n_free = problem.n_free();
    let mut out = vec![0.0; n_free];
    for (row, column, value) in couplings(problem).filter(|(_, column, _)| *column < n_free) {
        out[column] += value * d[row - n_free];
    }
    out
}

/// The Schur complement `P = B' (H_XX - H_Xx H_xx^-1 H_xX) B` of the last assembled and factored matrix,
/// with the held unknowns `X = B xi`: to second order, half of `d' P d` is what moving the coordinates xi by
/// `d` costs when everything else follows.
///
/// # Errors
/// [`Cancelled`].
pub fn schur_complement(
    problem: &LayoutProblem,
    space: &IntegerSpace,
    watch: &mut Watch<'_, '_>,
) -> Result<Dense, Cancelled> {
    let n_free = problem.n_free();
    let (order, n_held) = (space.n_coordinates(), space.n_held());
    let columns = columns(space);
    let (cross, held): (Vec<_>, Vec<_>) =
        couplings(problem).partition(|(_, column, _)| *column < n_free);
    let chunks: Vec<&[SparseColumn]> = columns.chunks(COLUMNS).collect();
    let block = |chunk: &&[SparseColumn]| {
        let mut held_part = vec![0.0; n_held * chunk.len()];
        for (column, out) in chunk.iter().zip(held_part.chunks_mut(n_held.max(1))) {
            column.iter().for_each(|&(k, c)| out[k] = c);
        }
        let mut x = vec![0.0; n_free * chunk.len()];
        for k in 0..chunk.len() {
            let (d, out) = (&held_part[k * n_held..], &mut x[k * n_free..(k + 1) * n_free]);
            cross.iter().for_each(|&(row, column, v)| out[column] += v * d[row - n_free]);
        }
        problem.solve_columns(&mut x, chunk.len());
        let mut block = Vec::with_capacity(order * chunk.len());
        for k in 0..chunk.len() {
            let (d, x) = (&held_part[k * n_held..], &x[k * n_free..]);
            let mut response = vec![0.0; n_held];
            for &(row, column, v) in &held {
                let (row, column) = (row - n_free, column - n_free);
                response[row] += v * d[column];
                if row != column {
                    response[column] += v * d[row];
                }
            }
            cross.iter().for_each(|&(row, column, v)| response[row - n_free] -= v * x[column]);
            let project = |c: &SparseColumn| c.iter().map(|&(k, b)| b * response[k]).sum::<f64>();
            block.extend(columns.iter().map(project));
        }
        block
    };
    let mut raw: Vec<f64> = Vec::with_capacity(order * order);
    for passes in chunks.chunks(PASSES * n_threads()) {
        watch.pulse()?;
        let blocks: Vec<Vec<f64>> = passes.par_iter().map(block).collect();
        blocks.iter().for_each(|block| raw.extend(block));
    }
    let at = |i: usize, j: usize| 0.5 * (raw[i * order + j] + raw[j * order + i]);
    let values = (0..order * order).map(|k| at(k / order, k % order)).collect();
    Ok(Dense { order, values })
}

/// Entries of a column of B: held unknown and coefficient.
type SparseColumn = Vec<(usize, f64)>;

/// B column by column.
fn columns(space: &IntegerSpace) -> Vec<SparseColumn> {
    let mut columns = vec![SparseColumn::new(); space.n_coordinates()];
    for (k, row) in space.held().iter().enumerate() {
        row.iter().for_each(|&(column, c)| columns[column].push((k, c as f64)));
    }
    columns
}
