//! Placing objects in space.

/// An affine map: three rows of four numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Matrix([[f64; 4]; 3]);

impl Default for Matrix {
    fn default() -> Self {
        Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
    }
}

impl Matrix {
    /// Takes four columns of four numbers, as glTF has them.
    pub(super) fn of_columns(columns: [f64; 16]) -> Self {
        Self([0, 1, 2].map(|row| [0, 1, 2, 3].map(|column| columns[4 * column + row])))
    }

    /// Scales, turns (by a quaternion with its real part last) and shifts.
    pub(super) fn of_parts(shift: [f64; 3], [x, y, z, w]: [f64; 4], scale: [f64; 3]) -> Self {
        let turn = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Self([0, 1, 2].map(|i| {
            [turn[i][0] * scale[0], turn[i][1] * scale[1], turn[i][2] * scale[2], shift[i]]
        }))
    }

    /// This map after another one.
    pub(super) fn times(&self, other: &Self) -> Self {
        let entry = |i: usize, j: usize| {
            let sum: f64 = (0..3).map(|k| self.0[i][k] * other.0[k][j]).sum();
            if j == 3 { sum + self.0[i][3] } else { sum }
        };
        Self([0, 1, 2].map(|i| [0, 1, 2, 3].map(|j| entry(i, j))))
    }

    pub(super) fn point(&self, p: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3])
    }

    /// A normal of what is mapped, of length one.
    pub(super) fn normal(&self, n: [f64; 3]) -> [f64; 3] {
        let mapped = self.cofactors().map(|row| row[0] * n[0] + row[1] * n[1] + row[2] * n[2]);
        let sign = if self.mirrors() { -1.0 } else { 1.0 };
        let length = mapped.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 { mapped.map(|x| sign * x / length) } else { n }
    }

    /// Whether it turns left into right.
    pub(super) fn mirrors(&self) -> bool {
        let (row, cofactors) = (self.0[0], self.cofactors()[0]);
        row[0] * cofactors[0] + row[1] * cofactors[1] + row[2] * cofactors[2] < 0.0
    }

    /// The determinant times the transposed inverse of its linear part.
    fn cofactors(&self) -> [[f64; 3]; 3] {
        let m = &self.0;
        [0, 1, 2].map(|i| {
            let (a, b) = (&m[(i + 1) % 3], &m[(i + 2) % 3]);
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        })
    }
}
