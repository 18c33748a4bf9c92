//! Integer linear forms and dense symmetric matrices.

/// An integer linear form: coordinate and coefficient, none of them zero.
pub type Row = Vec<(usize, i64)>;

/// The value of a row at a real point.
pub fn apply(row: &Row, x: &[f64]) -> f64 {
    row.iter().map(|&(k, c)| c as f64 * x[k]).sum()
}

/// The value of a row at an integer point.
pub fn apply_exactly(row: &Row, x: &[i64]) -> i64 {
    row.iter().map(|&(k, c)| c * x[k]).sum()
}

/// A row with the signs of its coefficients changed.
pub fn negated(row: &Row) -> Row {
    row.iter().map(|&(k, c)| (k, -c)).collect()
}

/// Many rows in one place, for products with real points.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    /// Where the entries of each row end.
    ends: Vec<usize>,
    columns: Vec<u32>,
    /// Small whole numbers.
    values: Vec<f32>,
}

impl Rows {
    /// Of some rows.
    pub fn new<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Self {
        let mut all = Self::default();
        for row in rows {
            all.columns.extend(row.iter().map(|&(k, _)| k as u32));
            all.values.extend(row.iter().map(|&(_, c)| c as f32));
            all.ends.push(all.columns.len());
        }
        all
    }

    /// The values of a row at two points, whose coordinates stand side by side.
    pub fn apply(&self, row: usize, points: &[[f64; 2]]) -> [f64; 2] {
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        let range = start..self.ends[row];
        let entries = self.columns[range.clone()].iter().zip(&self.values[range]);
        entries.fold([0.0; 2], |[a, b], (&k, &c)| {
            let ([x, y], c) = (points[k as usize], f64::from(c));
            [a + c * x, b + c * y]
        })
    }
}

/// A dense symmetric matrix, row after row.
#[derive(Debug, Clone)]
pub struct Dense {
    /// Number of rows.
    pub order: usize,
    /// The entries.
    pub values: Vec<f64>,
}

impl Dense {
    /// A row.
    #[inline]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.order..(i + 1) * self.order]
    }

    /// Product with a vector.
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        (0..self.order).map(|i| dot(self.row(i), x)).collect()
    }

    /// Sum of the diagonal.
    pub fn trace(&self) -> f64 {
        (0..self.order).map(|k| self.row(k)[k]).sum()
    }

    /// `(x - mean)' P (x - mean)`.
    pub fn energy(&self, mean: &[f64], x: &[i64]) -> f64 {
        let d: Vec<f64> = x.iter().zip(mean).map(|(&x, m)| x as f64 - m).collect();
        dot(&d, &self.multiply(&d))
    }

    /// Scaled to a mean diagonal of one.
    #[must_use]
    pub fn normalized(&self) -> Self {
        let trace = self.trace();
        let scale = if trace > 0.0 { self.order as f64 / trace } else { 1.0 };
        Self { order: self.order, values: self.values.iter().map(|x| x * scale).collect() }
    }
}

/// Inner product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
