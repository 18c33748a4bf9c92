//! Sparse rows over the unknowns, for the general solver.

use super::element::vector_back;
use crate::energy::Triangle;
use crate::layout::space::LinearSpace;

/// A linear form, columns ascending.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row(Vec<(u32, f64)>);

impl Row {
    /// One column.
    pub(super) fn of(column: usize, coefficient: f64) -> Self {
        Self(vec![(column as u32, coefficient)])
    }

    /// Every column with a coefficient other than zero.
    pub(super) fn dense(coefficients: &[f64]) -> Self {
        let columns = coefficients.iter().enumerate().filter(|(_, x)| **x != 0.0);
        Self(columns.map(|(column, &x)| (column as u32, x)).collect())
    }

    /// Adds `factor` times the row to a dense one.
    pub(super) fn add_to(&self, dense: &mut [f64], factor: f64) {
        for &(column, x) in &self.0 {
            dense[column as usize] += factor * x;
        }
    }

    fn collect(mut entries: Vec<(u32, f64)>) -> Self {
        entries.sort_unstable_by_key(|&(column, _)| column);
        entries.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        Self(entries)
    }

    pub(super) fn times(&self, factor: f64) -> Self {
        Self(self.0.iter().map(|&(column, x)| (column, factor * x)).collect())
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self::collect(self.0.iter().chain(&other.0).copied().collect())
    }
}

/// The four parts of a triangle's Jacobian as forms of the unknowns.
pub(super) fn part_rows(space: &LinearSpace, triangle: &Triangle, scale: f64) -> [Row; 4] {
    std::array::from_fn(|part| {
        let (mut unit, mut corners) = ([0.0; 4], [0.0; 6]);
        unit[part] = 1.0;
        vector_back(triangle, scale, &unit, &mut corners);
        let mut entries = Vec::with_capacity(6);
        for (k, &wedge) in triangle.wedges.iter().enumerate() {
            for side in 0..2 {
                let (columns, coefficients) = space.row(2 * wedge as usize + side);
                let factor = corners[2 * k + side];
                entries.extend(columns.iter().zip(coefficients).map(|(&c, x)| (c, factor * x)));
            }
        }
        Row::collect(entries)
    })
}

/// A matrix by columns: entries of column `j` are `starts[j]..starts[j + 1]`, rows ascending.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    pub(super) n_rows: usize,
    pub(super) starts: Vec<usize>,
    pub(super) rows: Vec<usize>,
    pub(super) values: Vec<f64>,
}

/// Rows of `A x + b`, in Clarabel's sign convention once compressed.
pub(super) struct Rows {
    columns: usize,
    offsets: Vec<usize>,
    entries: Vec<(u32, f64)>,
    constants: Vec<f64>,
}

impl Rows {
    pub(super) fn new(columns: usize) -> Self {
        Self { columns, offsets: vec![0], entries: Vec::new(), constants: Vec::new() }
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    pub(super) fn push(&mut self, row: &Row, constant: f64) {
        self.entries.extend(row.0.iter().filter(|(_, x)| *x != 0.0));
        self.offsets.push(self.entries.len());
        self.constants.push(constant);
    }

    /// The matrix `-A` by columns and `b`: Clarabel asks for `b - (-A) x` in the cones.
    pub(super) fn into_columns(self) -> (Columns, Vec<f64>) {
        let mut starts = vec![0usize; self.columns + 1];
        for &(column, _) in &self.entries {
            starts[column as usize + 1] += 1;
        }
        for k in 0..self.columns {
            starts[k + 1] += starts[k];
        }
        let mut fill = starts.clone();
        let mut rows = vec![0usize; self.entries.len()];
        let mut values = vec![0.0; self.entries.len()];
        for (row, ends) in self.offsets.windows(2).enumerate() {
            for &(column, x) in &self.entries[ends[0]..ends[1]] {
                let at = &mut fill[column as usize];
                (rows[*at], values[*at]) = (row, -x);
                *at += 1;
            }
        }
        (Columns { n_rows: self.constants.len(), starts, rows, values }, self.constants)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_add_up_and_compress() {
        let row = Row::of(2, 1.0).plus(&Row::of(0, 3.0)).plus(&Row::of(2, -4.0));
        assert_eq!(row, Row(vec![(0, 3.0), (2, -3.0)]));
        let mut rows = Rows::new(3);
        rows.push(&row, 7.0);
        rows.push(&Row::of(0, 5.0), 0.0);
        let (matrix, constants) = rows.into_columns();
        assert_eq!(constants, [7.0, 0.0]);
        assert_eq!(matrix.starts, [0, 2, 2, 3]);
        assert_eq!(matrix.rows, [0, 1, 0]);
        assert_eq!(matrix.values, [-3.0, -5.0, 3.0]);
    }
}
