//! The Jacobian of a layout on a triangle.

use num_complex::Complex64;

/// A Jacobian split in similarity and anti-similarity, `J v = similar v + anti conj(v)`.
#[derive(Debug, Clone, Copy)]
pub struct Jacobian {
    /// Similarity part.
    pub similar: Complex64,
    /// Anti-similarity part.
    pub anti: Complex64,
}

impl Jacobian {
    /// From the rows of the 2 x 2 matrix.
    #[inline]
    pub fn from_rows(j: [[f64; 2]; 2]) -> Self {
        Self {
            similar: Complex64::new(j[0][0] + j[1][1], j[1][0] - j[0][1]) / 2.0,
            anti: Complex64::new(j[0][0] - j[1][1], j[1][0] + j[0][1]) / 2.0,
        }
    }

    /// The entries of the matrix, row by row.
    #[inline]
    pub fn entries(&self) -> [f64; 4] {
        let (s, a) = (self.similar, self.anti);
        [s.re + a.re, a.im - s.im, s.im + a.im, s.re - a.re]
    }

    /// Signed singular values, the larger first; the second is negative for a flipped triangle.
    #[inline]
    pub fn singular_values(&self) -> (f64, f64) {
        let (a, b) = (self.similar.norm_sqr().sqrt(), self.anti.norm_sqr().sqrt());
        (a + b, a - b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(j: [f64; 4]) -> Jacobian {
        Jacobian::from_rows([[j[0], j[1]], [j[2], j[3]]])
    }

    #[test]
    fn singular_values_of_known_maps() {
        let (s1, s2) = at([3.0, 0.0, 0.0, 0.5]).singular_values();
        assert!((s1 - 3.0).abs() < 1e-15 && (s2 - 0.5).abs() < 1e-15);
        let (s1, s2) = at([0.0, 1.0, 1.0, 0.0]).singular_values();
        assert_eq!((s1, s2), (1.0, -1.0));
    }
}
