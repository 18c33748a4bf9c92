//! The linear system of the relaxation.

use num_complex::Complex64;
use seamstress_linalg::ordering::expand;
use seamstress_linalg::{Cholesky, NotPositiveDefinite, Pattern, Scalar};

/// Shift of the diagonal; the rows have weights of order one and more.
const SHIFT: f64 = 1e-8;

/// A quadratic form of points of the plane, built row by row in a fixed pattern.
///
/// Rows with one complex coefficient per point make a Hermitian matrix of as many unknowns; rows of single
/// coordinates need the real matrix of twice the order, whose factorisation takes twice the time.
pub(super) enum RelaxationSystem {
    /// One complex unknown per point.
    Complex(MatrixForm<Complex64>),
    /// Two real unknowns per point.
    Real {
        /// The matrix.
        form: MatrixForm<f64>,
        /// Coordinates of the points while the system is solved.
        coordinates: Vec<f64>,
    },
}

impl RelaxationSystem {
    /// The form zero, with room for rows among the points of each clique, which are eliminated in the given order; `real` if
    /// single coordinates will appear.
    ///
    /// # Errors
    /// When the factorisation cannot be set up (memory).
    pub(super) fn new<'a>(
        order: &[u32],
        cliques: impl Iterator<Item = &'a [u32]>,
        real: bool,
    ) -> Result<Self, NotPositiveDefinite> {
        let n = order.len();
        if !real {
            return MatrixForm::new(n, cliques.map(<[u32]>::to_vec), order).map(Self::Complex);
        }
        let both = |w: &[u32]| w.iter().flat_map(|&w| [2 * w, 2 * w + 1]).collect();
        let form = MatrixForm::new(2 * n, cliques.map(both), &expand(order, 2))?;
        Ok(Self::Real { form, coordinates: vec![0.0; 2 * n] })
    }

    /// Adds `weight |sum of c z|^2`.
    pub(super) fn add_row(&mut self, row: &[(u32, Complex64)], weight: f64) {
        match self {
            Self::Complex(form) => form.add_row(row, Complex64::conj, weight),
            Self::Real { form, .. } => {
                let real: Vec<_> =
                    row.iter().flat_map(|&(w, c)| [(2 * w, c.re), (2 * w + 1, -c.im)]).collect();
                let imaginary: Vec<_> =
                    row.iter().flat_map(|&(w, c)| [(2 * w, c.im), (2 * w + 1, c.re)]).collect();
                for row in [real, imaginary] {
                    let row: Vec<_> = row.into_iter().filter(|(_, c)| *c != 0.0).collect();
                    form.add_row(&row, |c| *c, weight);
                }
            }
        }
    }

    /// Adds a small multiple of the identity, which settles rigid motions of loose pieces.
    pub(super) fn shift(&mut self) {
        match self {
            Self::Complex(form) => form.shift(),
            Self::Real { form, .. } => form.shift(),
        }
    }

    /// Adds `weight (x_b - x_a)^2` for one coordinate (0 or 1) of two points; only in a real system.
    pub(super) fn equate(&mut self, [a, b]: [u32; 2], coordinate: u32, weight: f64) {
        if let Self::Real { form, .. } = self {
            let row = [(2 * a + coordinate, -1.0), (2 * b + coordinate, 1.0)];
            form.add_row(&row, |c| *c, weight);
        }
    }

    /// Factors the form as it stands.
    ///
    /// # Errors
    /// When it is not positive definite to working precision.
    pub(super) fn factorize(&mut self) -> Result<(), NotPositiveDefinite> {
        match self {
            Self::Complex(form) => form.factorize(),
            Self::Real { form, .. } => form.factorize(),
        }
    }

    /// Solves with the last factor in place.
    pub(super) fn solve(&mut self, z: &mut [Complex64]) {
        match self {
            Self::Complex(form) => form.cholesky.solve(z),
            Self::Real { form, coordinates } => {
                for (x, z) in coordinates.chunks_exact_mut(2).zip(z.iter()) {
                    x.copy_from_slice(&[z.re, z.im]);
                }
                form.cholesky.solve(coordinates);
                for (x, z) in coordinates.chunks_exact(2).zip(z) {
                    *z = Complex64::new(x[0], x[1]);
                }
            }
        }
    }
}

/// A matrix with its pattern and factorisation.
pub(super) struct MatrixForm<T: Scalar> {
    pattern: Pattern,
    matrix: Vec<T>,
    cholesky: Cholesky<T>,
}

impl<T: Scalar + From<f64> + std::ops::AddAssign + std::ops::Mul<Output = T>> MatrixForm<T> {
    fn new(
        n: usize,
        cliques: impl Iterator<Item = Vec<u32>>,
        order: &[u32],
    ) -> Result<Self, NotPositiveDefinite> {
        let pattern = Pattern::of_cliques(n, cliques);
        let cholesky = Cholesky::analyze(&pattern, order)?;
        let matrix = vec![T::from(0.0); pattern.len()];
        Ok(Self { pattern, matrix, cholesky })
    }

    fn shift(&mut self) {
        for &k in self.pattern.diagonal() {
            self.matrix[k as usize] += T::from(SHIFT);
        }
    }

    fn add_row(&mut self, row: &[(u32, T)], conjugate: impl Fn(&T) -> T, weight: f64) {
        for (i, ci) in row {
            for &(j, cj) in row {
                // Entry (i, j) is conj(c_i) c_j; only the lower triangle is stored.
                if let Some(slot) = self.pattern.slot(*i, j).filter(|_| *i >= j) {
                    self.matrix[slot as usize] += T::from(weight) * conjugate(ci) * cj;
                }
            }
        }
    }

    fn factorize(&mut self) -> Result<(), NotPositiveDefinite> {
        self.cholesky.factorize(&self.matrix)
    }
}
