//! Between a triangle's corners and the vector `q` of its scaled Jacobian.

use crate::energy::{Jacobian, Triangle, at_corner};
use num_complex::Complex64;

/// The Jacobian parts `(Re z, Im z, Re w, Im w)` that a program sees.
#[inline]
pub(super) fn parts(triangle: &Triangle, z: &[Complex64], scale: f64) -> [f64; 4] {
    let Jacobian { similar, anti } = triangle.jacobian(z);
    [similar.re * scale, similar.im * scale, anti.re * scale, anti.im * scale]
}

/// Transpose of the map from the Jacobian's entries `(j00, j01, j10, j11)` to its parts.
#[inline]
fn to_entries(q: &[f64; 4]) -> [f64; 4] {
    [0.5 * (q[0] + q[2]), 0.5 * (q[3] - q[1]), 0.5 * (q[1] + q[3]), 0.5 * (q[0] - q[2])]
}

/// Carries a vector over `q` back to the six corner coordinates.
#[inline]
pub(super) fn vector_back(triangle: &Triangle, scale: f64, q: &[f64; 4], local: &mut [f64; 6]) {
    let v = to_entries(&q.map(|x| x * scale));
    for (k, &g) in triangle.gradients.iter().enumerate() {
        [local[2 * k], local[2 * k + 1]] = at_corner(v, g);
    }
}

/// What couples two corners: 2 x 2, by rows.
type Block = [[f64; 2]; 2];

/// Carries a symmetric matrix over `q` back to the corner coordinates, as a lower triangle by rows.
#[inline]
pub(super) fn block_back(
    triangle: &Triangle,
    scale: f64,
    matrix: &[[f64; 4]; 4],
    block: &mut [f64; 21],
) {
    let square = scale * scale;
    let rows = matrix.each_ref().map(to_entries);
    let over_entries: [[f64; 4]; 4] =
        std::array::from_fn(|i| to_entries(&std::array::from_fn(|a| square * rows[a][i])));
    let [_, g, h] = triangle.gradients;
    // Blocks of corners 1 and 2; the first corner's follow, since the hat functions sum to one.
    let pair = |g: [f64; 2], h: [f64; 2]| -> Block {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let entry = |c: usize, d: usize| over_entries[2 * i + c][2 * j + d];
                g[0] * (entry(0, 0) * h[0] + entry(0, 1) * h[1])
                    + g[1] * (entry(1, 0) * h[0] + entry(1, 1) * h[1])
            })
        })
    };
    let (b11, b21, b22) = (pair(g, g), pair(h, g), pair(h, h));
    let minus = |x: &Block, y: &Block| -> Block {
        std::array::from_fn(|i| std::array::from_fn(|j| -x[i][j] - y[i][j]))
    };
    let b12: Block = [[b21[0][0], b21[1][0]], [b21[0][1], b21[1][1]]];
    let (b10, b20) = (minus(&b11, &b12), minus(&b21, &b22));
    let b00: Block = std::array::from_fn(|i| std::array::from_fn(|j| -b10[i][j] - b20[i][j]));
    *block = [
        b00[0][0], b00[1][0], b00[1][1], b10[0][0], b10[0][1], b11[0][0], b10[1][0], b10[1][1],
        b11[1][0], b11[1][1], b20[0][0], b20[0][1], b21[0][0], b21[0][1], b22[0][0], b20[1][0],
        b20[1][1], b21[1][0], b21[1][1], b22[1][0], b22[1][1],
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: Triangle = Triangle {
        wedges: [0, 1, 2],
        gradients: [[-0.7, -1.1], [0.9, -0.2], [-0.2, 1.3]],
        weight: 1.0,
        wanted: Complex64::ZERO,
    };

    /// The parts of unit moves of the six coordinates: the matrix of the linear map, by columns.
    fn columns() -> [[f64; 4]; 6] {
        std::array::from_fn(|k| {
            let mut z = [Complex64::ZERO; 3];
            z[k / 2] = if k % 2 == 0 { Complex64::ONE } else { Complex64::I };
            parts(&TRIANGLE, &z, 1.7)
        })
    }

    #[test]
    fn both_ways_are_transposes() {
        let matrix: [[f64; 4]; 4] = std::array::from_fn(|i| {
            std::array::from_fn(|j| if i == j { 2.0 } else { 0.1 * (i + j) as f64 })
        });
        let columns = columns();
        let q = [0.4, -1.0, 0.3, 2.0];
        let (mut local, mut block) = ([0.0; 6], [0.0; 21]);
        vector_back(&TRIANGLE, 1.7, &q, &mut local);
        block_back(&TRIANGLE, 1.7, &matrix, &mut block);
        let dot = |a: &[f64; 4], b: &[f64; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut at = 0;
        for i in 0..6 {
            assert!((local[i] - dot(&columns[i], &q)).abs() < 1e-13);
            for j in 0..=i {
                let product = matrix.each_ref().map(|row| dot(row, &columns[j]));
                assert!((block[at] - dot(&columns[i], &product)).abs() < 1e-13, "{i} {j}");
                at += 1;
            }
        }
    }
}
