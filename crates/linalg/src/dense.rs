//! Small dense systems.

use crate::cholesky::NotPositiveDefinite;
use faer::linalg::solvers::{Llt, SolveCore};
use faer::{Conj, MatMut, MatRef, Side};

/// Overwrites `rhs` with the solution of a dense symmetric positive definite system; `matrix` is n x n,
/// its lower triangle is read.
///
/// # Errors
/// [`NotPositiveDefinite`].
pub fn solve_spd(matrix: &[f64], rhs: &mut [f64]) -> Result<(), NotPositiveDefinite> {
    let n = rhs.len();
    let matrix = MatRef::from_column_major_slice(matrix, n, n);
    let llt = Llt::new(matrix, Side::Lower).map_err(|_| NotPositiveDefinite)?;
    llt.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(rhs, n, 1));
    Ok(())
}

/// The inverse of a dense symmetric positive definite `n x n` matrix, whose lower triangle is read (column
/// by column).
///
/// # Errors
/// [`NotPositiveDefinite`].
pub fn invert_spd(matrix: &[f64], n: usize) -> Result<Vec<f64>, NotPositiveDefinite> {
    let matrix = MatRef::from_column_major_slice(matrix, n, n);
    let llt = Llt::new(matrix, Side::Lower).map_err(|_| NotPositiveDefinite)?;
    let mut inverse = vec![0.0; n * n];
    (0..n).for_each(|k| inverse[k * n + k] = 1.0);
    llt.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(&mut inverse, n, n));
    Ok(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_of_two_by_two() {
        let inverse = invert_spd(&[2.0, 1.0, 1.0, 3.0], 2).unwrap();
        let expected = [0.6, -0.2, -0.2, 0.4];
        assert!(inverse.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15));
        assert_eq!(invert_spd(&[1.0, 2.0, 2.0, 1.0], 2), Err(NotPositiveDefinite));
    }

    #[test]
    fn two_by_two() {
        let mut b = [4.0, 7.0];
        solve_spd(&[2.0, 1.0, 1.0, 3.0], &mut b).unwrap();
        assert!((b[0] - 1.0).abs() < 1e-15 && (b[1] - 2.0).abs() < 1e-15);
        assert_eq!(solve_spd(&[1.0, 2.0, 2.0, 1.0], &mut [1.0, 1.0]), Err(NotPositiveDefinite));
    }
}
