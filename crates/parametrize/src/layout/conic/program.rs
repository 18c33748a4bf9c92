//! The convex program of one global step: its data, and its value at a layout.

use crate::layout::energy::Jacobian;
use crate::layout::problem::LayoutProblem;
use crate::layout::triangle::{CHUNK, Triangle};
use num_complex::Complex64;
use seamstress_parallel::prelude::*;

/// A real 2 x 2 matrix by rows.
pub type Matrix2 = [[f64; 2]; 2];

/// What is bounded over all triangles. With z and w the similarity and anti-similarity parts of a
/// triangle's (scaled) Jacobian and R its frame, the Jacobian's singular values are `|z| + |w|` and
/// `|z| - |w|`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProgramKind {
    /// Eq. (9) with `mu_2 = 1`, which homogeneity permits: least `mu` with `|z| + |w| <= mu` and
    /// `|w| <= Re(z conj R) - 1`. The value is `mu`, a bound on `sigma_1 max / sigma_2 min`.
    Stretch,
    /// Eq. (8): least `mu` with `2 |z - R|^2 + 2 |w|^2 <= mu`, which is `|J - R|_F^2`.
    Deviation,
}

/// A convex program over the layouts of a [`LayoutProblem`]: everything but the unknowns is given.
#[derive(Debug, Clone)]
pub struct Program {
    /// What is bounded.
    pub kind: ProgramKind,
    /// Frame of each triangle, a unit complex number.
    pub frames: Vec<Complex64>,
    /// Factor of each triangle's Jacobian: `s_t` of eq. (12), or `1 / s_t` of eq. (11). None: all 1.
    pub scales: Option<Vec<f64>>,
    /// Matrix `A^-1` that each Jacobian is multiplied by from the left. None: the identity.
    pub left: Option<Vec<Matrix2>>,
}

impl Program {
    /// The Jacobian that the program sees on triangle `t`.
    pub fn jacobian(&self, t: usize, triangle: &Triangle, z: &[Complex64]) -> Jacobian {
        let mut j = triangle.jacobian(z);
        if let Some(left) = &self.left {
            j = turned(&left[t], &j);
        }
        if let Some(scales) = &self.scales {
            j = Jacobian { similar: j.similar * scales[t], anti: j.anti * scales[t] };
        }
        j
    }

    /// The least `mu` with which a layout satisfies the program, infinite if there is none; for
    /// [`ProgramKind::Stretch`] after scaling it to `mu_2 = 1`.
    pub fn value(&self, problem: &LayoutProblem, z: &[Complex64]) -> f64 {
        let worst = |t: usize, triangle: &Triangle| {
            let Jacobian { similar, anti } = self.jacobian(t, triangle, z);
            let (frame, anti) = (self.frames[t], anti.norm());
            match self.kind {
                ProgramKind::Stretch => (similar.norm() + anti, (similar * frame.conj()).re - anti),
                ProgramKind::Deviation => {
                    (2.0 * ((similar - frame).norm_sqr() + anti * anti), f64::INFINITY)
                }
            }
        };
        let (largest, smallest) = extremes(problem.triangles(), worst);
        match self.kind {
            ProgramKind::Stretch if smallest > 0.0 => largest / smallest,
            ProgramKind::Stretch => f64::INFINITY,
            ProgramKind::Deviation => largest,
        }
    }
}

/// The largest first and the smallest second figure of all triangles.
pub(in crate::layout) fn extremes(
    triangles: &[Triangle],
    figures: impl Fn(usize, &Triangle) -> (f64, f64) + Sync,
) -> (f64, f64) {
    let none = (f64::NEG_INFINITY, f64::INFINITY);
    let join = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.min(b.1));
    let of_chunks: Vec<(f64, f64)> = triangles
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(c, chunk)| {
            let each = chunk.iter().enumerate().map(|(k, t)| figures(c * CHUNK + k, t));
            each.fold(none, join)
        })
        .collect();
    of_chunks.into_iter().fold(none, join)
}

/// `A J`.
pub(super) fn turned(a: &Matrix2, j: &Jacobian) -> Jacobian {
    let a = Jacobian::from_rows(*a);
    Jacobian {
        similar: a.similar * j.similar + a.anti * j.anti.conj(),
        anti: a.similar * j.anti + a.anti * j.similar.conj(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_matrices() {
        let (a, j) = ([[1.0, 2.0], [-0.5, 3.0]], [[0.3, -1.0], [2.0, 0.7]]);
        let row = |r: [f64; 2]| [0, 1].map(|k| r[0] * j[0][k] + r[1] * j[1][k]);
        let expected = Jacobian::from_rows(a.map(row));
        let found = turned(&a, &Jacobian::from_rows(j));
        assert!((found.similar - expected.similar).norm() < 1e-15);
        assert!((found.anti - expected.anti).norm() < 1e-15);
    }
}
