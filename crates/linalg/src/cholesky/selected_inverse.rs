//! Entries of the inverse of a sparse matrix where its factor has entries.
//!
//! Takahashi, Fagan and Chin 1973 (see Erisman and Tinney 1975): those entries of the inverse satisfy a
//! recurrence among themselves, which runs from the last column of the factor to the first and costs as
//! much as the factorisation. Rows of a front below its pivots are pivots of its ancestors, so all that its columns
//! need is there when their turn comes.

use super::Cholesky;
use super::quad::Quad;
use super::symbolic::Front;
use crate::pattern::Pattern;

impl Cholesky<f64> {
    /// The inverse of the factored matrix at the entries of its pattern, diagonal included.
    pub fn selected_inverse(&self, pattern: &Pattern) -> Vec<f64> {
        let symbolic = &self.symbolic;
        let front_of = symbolic.front_of();
        let mut offsets = vec![0];
        for s in 0..symbolic.len() {
            let front = symbolic.front(s);
            offsets.push(offsets[s] + front.columns * (front.height()));
        }
        // Of each front its columns of the inverse, one after the other: the pivots, then the rows below.
        let mut inverse = vec![0.0; offsets[symbolic.len()]];
        let mut place = vec![0u32; front_of.len()];
        let mut square = Vec::new();
        for s in (0..symbolic.len()).rev() {
            let front = symbolic.front(s);
            let size = front.height();
            square.clear();
            square.resize(size * size, 0.0);
            let mut done = front.rows;
            while let Some(&row) = done.first() {
                // Rows that are pivots of one ancestor.
                let ancestor = front_of[row as usize] as usize;
                let columns = &inverse[offsets[ancestor]..offsets[ancestor + 1]];
                let ancestor = symbolic.front(ancestor);
                let height = ancestor.height();
                let end = ancestor.first + ancestor.columns;
                (ancestor.first..end).for_each(|k| place[k] = (k - ancestor.first) as u32);
                for (k, &row) in ancestor.rows.iter().enumerate() {
                    place[row as usize] = (ancestor.columns + k) as u32;
                }
                let count = done.partition_point(|&row| (row as usize) < end);
                for k in 0..count {
                    let column = &columns[(done[k] as usize - ancestor.first) * height..][..height];
                    let j = size - done.len() + k;
                    for (i, &row) in (j..size).zip(&done[k..]) {
                        let value = column[place[row as usize] as usize];
                        square[j * size + i] = value;
                        square[i * size + j] = value;
                    }
                }
                done = &done[count..];
            }
            let panel = &self.factor.panels[symbolic.panels(s..s + 1)];
            takahashi(&front, panel, &mut square);
            inverse[offsets[s]..offsets[s + 1]].copy_from_slice(&square[..front.columns * size]);
        }
        let mut position = vec![0u32; front_of.len()];
        symbolic.order.iter().enumerate().for_each(|(k, &i)| position[i as usize] = k as u32);
        let entry = |row: u32, column: usize| {
            let (a, b) = (position[row as usize], position[column]);
            let (row, column) = (a.max(b), a.min(b) as usize);
            let s = front_of[column] as usize;
            let front = symbolic.front(s);
            let height = front.height();
            let row = match (row as usize).checked_sub(front.first + front.columns) {
                None => row as usize - front.first,
                Some(_) => front.columns + front.rows.partition_point(|&r| r < row),
            };
            inverse[offsets[s] + (column - front.first) * height + row]
        };
        let columns = (0..pattern.order()).flat_map(|column| {
            let range = pattern.column_offsets[column]..pattern.column_offsets[column + 1];
            range.map(move |slot| (slot, column))
        });
        columns.map(|(slot, column)| entry(pattern.rows[slot as usize], column)).collect()
    }
}

/// Completes the inverse of a front whose rows and columns below the pivots are there: with unit columns `l` and
/// pivots `d`, `Z_ij = -sum_k Z_ik l_kj` below the diagonal and `Z_jj = 1 / d_j - sum_k l_kj Z_kj` on it.
fn takahashi<Q: Quad<Scalar = f64>>(front: &Front<'_>, panel: &[Q], square: &mut [f64]) {
    let size = front.height();
    let mut unit = vec![0.0; size];
    for j in (0..front.columns).rev() {
        let entry = |i: usize| panel[i / 4 * front.columns + j].get(i);
        let root = entry(j);
        (j + 1..size).for_each(|i| unit[i] = entry(i) / root);
        let (own, others) = square[j * size..].split_at_mut(size);
        for (k, column) in (j + 1..size).zip(others.chunks_exact(size)) {
            for i in j + 1..size {
                own[i] -= column[i] * unit[k];
            }
        }
        let inner: f64 = (j + 1..size).map(|i| unit[i] * own[i]).sum();
        own[j] = 1.0 / (root * root) - inner;
        for i in j + 1..size {
            square[i * size + j] = square[j * size + i];
        }
    }
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::ordering::{Graph, fill_reducing_order};
    use crate::pattern::PatternBuilder;

    #[test]
    fn agrees_with_columns_of_the_inverse() {
        // A grid with irregular weights.
        let side = 7u32;
        let n = (side * side) as usize;
        let edges: Vec<(u32, u32)> = (0..side * side)
            .flat_map(|v| {
                let right = (v % side + 1 < side).then_some((v, v + 1));
                let up = (v / side + 1 < side).then_some((v, v + side));
                right.into_iter().chain(up)
            })
            .collect();
        let mut builder = PatternBuilder::new(n);
        edges.iter().for_each(|&(a, b)| builder.add_clique(&[a, b]));
        let pattern = builder.build();
        let mut values = vec![0.0; pattern.len()];
        for &(a, b) in &edges {
            let weight = 1.0 + f64::from((3 * a + 5 * b) % 7);
            values[pattern.slot(a, b).unwrap() as usize] -= weight;
            for v in [a, b] {
                values[pattern.diagonal()[v as usize] as usize] += weight + 0.01;
            }
        }
        let order = fill_reducing_order(&Graph::from_edges(n, edges.into_iter()));
        let mut cholesky = Cholesky::analyze(&pattern, &order).unwrap();
        cholesky.factorize(&values).unwrap();
        let selected = cholesky.selected_inverse(&pattern);
        for column in 0..n {
            let mut x = vec![0.0; n];
            x[column] = 1.0;
            cholesky.solve(&mut x);
            for slot in pattern.column_offsets[column]..pattern.column_offsets[column + 1] {
                let row = pattern.rows[slot as usize] as usize;
                assert!((x[row] - selected[slot as usize]).abs() < 1e-12);
            }
        }
    }
}
