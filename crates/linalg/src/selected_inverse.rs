//! Entries of the inverse of a sparse matrix where its factor has entries.
//!
//! Takahashi, Fagan and Chin 1973 (see Erisman and Tinney 1975): those entries of the inverse satisfy a
//! recurrence among themselves, which runs from the last column of the factor to the first and costs as
//! much as the factorisation.

use crate::cholesky::Cholesky;
use crate::pattern::Pattern;
use faer::sparse::linalg::cholesky::SymbolicCholeskyRaw;

impl Cholesky<f64> {
    /// The inverse of the factored matrix at the entries of its pattern, diagonal included; for the
    /// simplicial kernel only.
    pub fn selected_inverse(&self, pattern: &Pattern) -> Option<Vec<f64>> {
        let SymbolicCholeskyRaw::Simplicial(structure) = self.symbolic().raw() else {
            return None;
        };
        let factor = Factor {
            offsets: structure.col_ptr(),
            rows: structure.row_idx(),
            values: self.factor(),
        };
        let (_, position) = self.symbolic().perm()?.arrays();
        let inverse = factor.takahashi();
        let mut selected = Vec::with_capacity(pattern.len());
        for column in 0..pattern.order() {
            let begin = pattern.column_offsets[column] as usize;
            let end = pattern.column_offsets[column + 1] as usize;
            for &row in &pattern.rows[begin..end] {
                let (i, j) = (position[row as usize], position[column]);
                selected.push(inverse[factor.slot(i.max(j), i.min(j) as usize)?]);
            }
        }
        Some(selected)
    }
}

/// Lower triangular factor by columns, rows ascending, the diagonal first.
struct Factor<'a> {
    offsets: &'a [u32],
    rows: &'a [u32],
    values: &'a [f64],
}

impl Factor<'_> {
    fn column(&self, j: usize) -> std::ops::Range<usize> {
        self.offsets[j] as usize..self.offsets[j + 1] as usize
    }

    fn slot(&self, row: u32, column: usize) -> Option<usize> {
        let range = self.column(column);
        Some(range.start + self.rows[range].binary_search(&row).ok()?)
    }

    /// The inverse at the factor's entries: with unit columns `l` and pivots `d`,
    /// `Z_ij = -sum_k l_kj Z_ik` below the diagonal and `Z_jj = 1 / d_j - sum_k l_kj Z_kj` on it.
    fn takahashi(&self) -> Vec<f64> {
        let n = self.offsets.len() - 1;
        let mut inverse = vec![0.0; self.values.len()];
        // Place of each row in the present column, counted from below its diagonal.
        let mut place = vec![u32::MAX; n];
        let (mut unit, mut sums) = (Vec::new(), Vec::new());
        for j in (0..n).rev() {
            let range = self.column(j);
            let pivot = self.values[range.start];
            let below = &self.rows[range.start + 1..range.end];
            unit.clear();
            unit.extend(self.values[range.start + 1..range.end].iter().map(|x| x / pivot));
            sums.clear();
            sums.resize(below.len(), 0.0);
            for (q, &row) in below.iter().enumerate() {
                place[row as usize] = q as u32;
            }
            for (q, &row) in below.iter().enumerate() {
                let column = self.column(row as usize);
                sums[q] -= unit[q] * inverse[column.start];
                for slot in column.start + 1..column.end {
                    let p = place[self.rows[slot] as usize];
                    if p != u32::MAX {
                        sums[p as usize] -= unit[q] * inverse[slot];
                        sums[q] -= unit[p as usize] * inverse[slot];
                    }
                }
            }
            below.iter().for_each(|&row| place[row as usize] = u32::MAX);
            let inner: f64 = unit.iter().zip(&sums).map(|(l, z)| l * z).sum();
            inverse[range.start] = 1.0 / (pivot * pivot) - inner;
            inverse[range.start + 1..range.end].copy_from_slice(&sums);
        }
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cholesky::Kernel;
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
        let mut cholesky = Cholesky::analyze_for(Kernel::Simplicial, &pattern, &order).unwrap();
        cholesky.factorize(&pattern, &values).unwrap();
        let selected = cholesky.selected_inverse(&pattern).unwrap();
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

    #[test]
    fn the_supernodal_kernel_has_none() {
        let pattern = PatternBuilder::new(1).build();
        let mut cholesky = Cholesky::analyze(&pattern, &[0]).unwrap();
        cholesky.factorize(&pattern, &[2.0]).unwrap();
        assert!(cholesky.selected_inverse(&pattern).is_none());
    }
}
