//! Symmetric sparsity patterns, built once and filled many times.

use crate::buckets::Buckets;

/// Lower triangle of a symmetric pattern by columns, diagonal first in each column.
#[derive(Debug, Clone)]
pub struct Pattern {
    /// One more than the order.
    pub column_offsets: Vec<u32>,
    /// Row of each entry, ascending in a column, never above the diagonal.
    pub rows: Vec<u32>,
}

impl Pattern {
    /// The pattern in which all unknowns of a clique are coupled with each other.
    pub fn of_cliques(order: usize, cliques: impl Iterator<Item = impl AsRef<[u32]>>) -> Self {
        let mut builder = PatternBuilder::new(order);
        cliques.for_each(|clique| builder.add_clique(clique.as_ref()));
        builder.build()
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        self.column_offsets.len() - 1
    }

    /// Number of stored entries.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// True when there is no entry.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Position of entry `(i, j)` or `(j, i)`, whichever lies in the lower triangle.
    pub fn slot(&self, i: u32, j: u32) -> Option<u32> {
        let (row, column) = (i.max(j), i.min(j) as usize);
        let begin = *self.column_offsets.get(column)?;
        let end = *self.column_offsets.get(column + 1)?;
        let found = self.rows[begin as usize..end as usize].binary_search(&row).ok()?;
        Some(begin + found as u32)
    }

    /// Positions of the diagonal entries.
    pub fn diagonal(&self) -> &[u32] {
        &self.column_offsets[..self.order()]
    }

    /// `y = A x` for the symmetric matrix with these lower-triangle `values`.
    pub fn multiply(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for column in 0..self.order() {
            let begin = self.column_offsets[column] as usize;
            let end = self.column_offsets[column + 1] as usize;
            y[column] += values[begin] * x[column];
            let below = self.rows[begin + 1..end].iter().zip(&values[begin + 1..end]);
            for (&row, value) in below {
                y[row as usize] += value * x[column];
                y[column] += value * x[row as usize];
            }
        }
    }
}

/// Collects the cliques (sets of unknowns that meet in one element) of a pattern.
#[derive(Debug, Clone)]
pub struct PatternBuilder {
    order: usize,
    /// (column, row) pairs packed as `column << 32 | row`.
    entries: Vec<u64>,
}

impl PatternBuilder {
    /// A pattern of the given order that holds the diagonal so far.
    pub fn new(order: usize) -> Self {
        let entries = (0..order as u64).map(|i| i << 32 | i).collect();
        Self { order, entries }
    }

    /// Adds all pairs among `unknowns`.
    pub fn add_clique(&mut self, unknowns: &[u32]) {
        for (k, &i) in unknowns.iter().enumerate() {
            for &j in &unknowns[..k] {
                let (column, row) = (u64::from(i.min(j)), u64::from(i.max(j)));
                self.entries.push(column << 32 | row);
            }
        }
    }

    /// Sorts and removes repetitions.
    pub fn build(self) -> Pattern {
        // Group by column, then sort inside each column: the columns are small.
        let columns: Vec<u32> = self.entries.iter().map(|&e| (e >> 32) as u32).collect();
        let by_column = Buckets::new(self.order, &columns);
        let mut pattern = Pattern {
            column_offsets: Vec::with_capacity(self.order + 1),
            rows: Vec::with_capacity(self.entries.len() / 2),
        };
        pattern.column_offsets.push(0);
        let mut rows = Vec::new();
        for column in 0..self.order {
            rows.clear();
            rows.extend(by_column.of(column).iter().map(|&e| self.entries[e as usize] as u32));
            rows.sort_unstable();
            rows.dedup();
            pattern.rows.extend_from_slice(&rows);
            pattern.column_offsets.push(pattern.rows.len() as u32);
        }
        pattern
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cliques_make_the_lower_triangle() {
        let mut builder = PatternBuilder::new(4);
        builder.add_clique(&[2, 0, 1]);
        builder.add_clique(&[1, 2]);
        let pattern = builder.build();
        assert_eq!(pattern.column_offsets, [0, 3, 5, 6, 7]);
        assert_eq!(pattern.rows, [0, 1, 2, 1, 2, 2, 3]);
        assert_eq!(pattern.slot(2, 0), Some(2));
        assert_eq!(pattern.slot(0, 2), Some(2));
        assert_eq!(pattern.slot(3, 0), None);
        assert_eq!(pattern.diagonal(), [0, 3, 5, 6]);
    }

    #[test]
    fn multiply_uses_both_triangles() {
        let mut builder = PatternBuilder::new(2);
        builder.add_clique(&[0, 1]);
        let pattern = builder.build();
        let mut y = [0.0; 2];
        pattern.multiply(&[2.0, 1.0, 3.0], &[1.0, 10.0], &mut y);
        assert_eq!(y, [12.0, 31.0]);
    }
}
