//! Triangles in terms of the unknowns of a linear space.

use super::space::LinearSpace;
use crate::energy::Triangle;

/// How the six corner coordinates of a triangle depend on its unknowns.
pub(super) enum ElementMap {
    /// Each coordinate is an unknown of its own, in order.
    Direct,
    /// Row-major 6 x m matrix.
    Matrix(Vec<f64>),
}

impl ElementMap {
    /// The map of a triangle, and its unknowns.
    pub(super) fn new(space: &LinearSpace, triangle: &Triangle) -> (Self, Vec<u32>) {
        let rows = triangle.wedges.map(|w| [2 * w as usize, 2 * w as usize + 1]);
        let rows = rows.as_flattened();
        let mut unknowns: Vec<u32> = Vec::with_capacity(6);
        let mut direct = true;
        for &row in rows {
            let (columns, coefficients) = space.row(row);
            direct &=
                columns.len() == 1 && coefficients[0] == 1.0 && !unknowns.contains(&columns[0]);
            for &column in columns {
                if !unknowns.contains(&column) {
                    unknowns.push(column);
                }
            }
        }
        if direct {
            return (Self::Direct, unknowns);
        }
        unknowns.sort_unstable();
        let m = unknowns.len();
        let mut map = vec![0.0; 6 * m];
        for (i, &row) in rows.iter().enumerate() {
            let (columns, coefficients) = space.row(row);
            for (column, &c) in columns.iter().zip(coefficients) {
                if let Ok(k) = unknowns.binary_search(column) {
                    map[i * m + k] += c;
                }
            }
        }
        (Self::Matrix(map), unknowns)
    }

    /// `B^T g` for the 6 x m matrix B of an element.
    pub(super) fn pull_vector_back(&self, g: &[f64; 6], vector: &mut [f64]) {
        match self {
            Self::Direct => vector.copy_from_slice(g),
            Self::Matrix(map) => {
                let m = vector.len();
                for (column, out) in vector.iter_mut().enumerate() {
                    *out = (0..6).map(|row| map[row * m + column] * g[row]).sum();
                }
            }
        }
    }

    /// `B^T H B` for the row-major 6 x m matrix B of an element.
    pub(super) fn pull_block_back(&self, h: &[f64; 21], block: &mut [f64], m: usize) {
        let map = match self {
            Self::Direct => return block.copy_from_slice(h),
            Self::Matrix(map) => map,
        };
        let entry = |i: usize, j: usize| {
            let (i, j) = (i.max(j), i.min(j));
            h[i * (i + 1) / 2 + j]
        };
        let mut at = 0;
        for a in 0..m {
            let mut product = [0.0; 6];
            for i in 0..6 {
                let x = map[i * m + a];
                if x != 0.0 {
                    for (j, p) in product.iter_mut().enumerate() {
                        *p += x * entry(i, j);
                    }
                }
            }
            for b in 0..=a {
                block[at] = (0..6).map(|j| product[j] * map[j * m + b]).sum();
                at += 1;
            }
        }
    }
}
