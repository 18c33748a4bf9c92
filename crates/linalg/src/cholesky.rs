//! Cholesky factorisation of a sparse Hermitian positive definite matrix: multifrontal, by supernodes (Duff and Reid
//! 1983; Liu 1992).
//!
//! The symbolic analysis depends on the [`Pattern`] and the order only and is kept; each [`Cholesky::factorize`] is
//! numeric work alone, on the threads of the caller's pool. Results do not depend on how many there are. They may
//! differ in the last bits between processors that round a multiplication and an addition together (x86-64 with
//! AVX2 and FMA, AArch64) and others.

mod forest;
mod fronts;
mod kernels;
mod numeric;
mod pieces;
mod quad;
mod selected_inverse;
mod solve;
mod symbolic;
mod tree;

use crate::pattern::Pattern;
use numeric::Factor;
use pieces::Pieces;
pub use quad::Scalar;
use solve::{Factored, Workspace};
use symbolic::Symbolic;

/// No id.
const NONE: u32 = u32::MAX;

/// The matrix is not positive definite to working precision (or holds a value that is not finite).
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is not positive definite to working precision")]
pub struct NotPositiveDefinite;

/// Analysis, factor and workspace for one pattern.
pub struct Cholesky<T: Scalar> {
    symbolic: Symbolic,
    pieces: Pieces,
    factor: Factor<T>,
    /// Of solves with one right-hand side.
    workspace: Workspace<T, 1>,
}

impl<T: Scalar> Cholesky<T> {
    /// Analyses the pattern for the elimination order given (`order[k]` goes `k`-th).
    ///
    /// # Errors
    /// When `order` is no permutation of the unknowns.
    pub fn analyze(pattern: &Pattern, order: &[u32]) -> Result<Self, NotPositiveDefinite> {
        let mut seen = vec![false; pattern.order()];
        for &i in order {
            let seen = seen.get_mut(i as usize).ok_or(NotPositiveDefinite)?;
            if std::mem::replace(seen, true) {
                return Err(NotPositiveDefinite);
            }
        }
        if order.len() != pattern.order() {
            return Err(NotPositiveDefinite);
        }
        let symbolic = Symbolic::new(pattern, order, T::REALS);
        let pieces = Pieces::new(&symbolic);
        let (factor, workspace) = (Factor::new(&symbolic), Workspace::new(&pieces));
        Ok(Self { symbolic, pieces, factor, workspace })
    }

    /// Number of entries of the factor, with those that only fill up blocks.
    pub fn factor_len(&self) -> usize {
        4 * self.factor.panels.len()
    }

    /// Factors the matrix with these values in the slots of the pattern.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`]; the factor is then unusable until the next success.
    pub fn factorize(&mut self, values: &[T]) -> Result<(), NotPositiveDefinite> {
        self.factor.factorize(&self.symbolic, values)
    }

    /// Overwrites the right-hand side with the solution.
    pub fn solve(&mut self, rhs: &mut [T]) {
        let Self { symbolic, pieces, factor, workspace } = self;
        workspace.solve::<4>(Factored { symbolic, pieces, factor }, rhs);
    }

    /// Solves for several right-hand sides at once, column after column in `rhs`; one pass over the factor serves up
    /// to four. Needs no exclusive access, so threads can share the factor. Each solution has the same bits as that
    /// of [`Cholesky::solve`].
    pub fn solve_columns(&self, rhs: &mut [T], columns: usize) {
        let Self { symbolic, pieces, factor, .. } = self;
        let (n, system) = (symbolic.order.len(), Factored { symbolic, pieces, factor });
        let (fours, rest) = rhs[..n * columns].split_at_mut(columns / 4 * 4 * n);
        let (twos, ones) = rest.split_at_mut(columns % 4 / 2 * 2 * n);
        if !fours.is_empty() {
            let mut workspace = Workspace::<T, 4>::new(pieces);
            fours.chunks_exact_mut(4 * n).for_each(|rhs| workspace.solve::<2>(system, rhs));
        }
        if !twos.is_empty() {
            Workspace::<T, 2>::new(pieces).solve::<4>(system, twos);
        }
        if !ones.is_empty() {
            Workspace::<T, 1>::new(pieces).solve::<4>(system, ones);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::PatternBuilder;
    use num_complex::Complex64;

    fn path(n: u32) -> Pattern {
        let mut builder = PatternBuilder::new(n as usize);
        for i in 1..n {
            builder.add_clique(&[i - 1, i]);
        }
        builder.build()
    }

    #[test]
    fn solves_a_real_system_twice_with_one_analysis() {
        let pattern = path(30);
        let order: Vec<u32> = (0..30).rev().collect();
        let mut cholesky = Cholesky::analyze(&pattern, &order).unwrap();
        for shift in [0.1, 2.0] {
            let diagonal = pattern.diagonal();
            let values: Vec<f64> = (0..pattern.len() as u32)
                .map(|k| if diagonal.contains(&k) { 2.0 + shift } else { -1.0 })
                .collect();
            cholesky.factorize(&values).unwrap();
            let x: Vec<f64> = (0..30).map(|i| f64::from(i).sin()).collect();
            let mut b = vec![0.0; 30];
            pattern.multiply(&values, &x, &mut b);
            let mut twice = b.repeat(2);
            cholesky.solve(&mut b);
            assert!(x.iter().zip(&b).all(|(x, b)| (x - b).abs() < 1e-12));
            cholesky.solve_columns(&mut twice, 2);
            assert!(b.repeat(2).iter().zip(&twice).all(|(x, b)| (x - b).abs() < 1e-12));
        }
    }

    #[test]
    fn solves_a_hermitian_system() {
        let pattern = path(2);
        let mut cholesky = Cholesky::analyze(&pattern, &[0, 1]).unwrap();
        let i = Complex64::i();
        // [[2, -i], [i, 2]] has eigenvalues 1 and 3; the lower entry is i.
        let values = [Complex64::from(2.0), i, Complex64::from(2.0)];
        cholesky.factorize(&values).unwrap();
        let x = [Complex64::new(1.0, 2.0), Complex64::new(-3.0, 0.5)];
        let mut b = [2.0 * x[0] - i * x[1], i * x[0] + 2.0 * x[1]];
        cholesky.solve(&mut b);
        assert!((b[0] - x[0]).norm() < 1e-14 && (b[1] - x[1]).norm() < 1e-14);
    }

    #[test]
    fn a_system_by_hand() {
        // L = [[2, 0, 0], [1, 3, 0], [-1, 2, 1]], x = (1, 2, 3).
        let mut builder = PatternBuilder::new(3);
        builder.add_clique(&[0, 1, 2]);
        let pattern = builder.build();
        let values = [4.0, 2.0, -2.0, 10.0, 5.0, 6.0];
        let rhs = [2.0, 37.0, 26.0];
        for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
            let mut cholesky = Cholesky::analyze(&pattern, &order).unwrap();
            cholesky.factorize(&values).unwrap();
            let mut x = rhs;
            cholesky.solve(&mut x);
            assert!(x.iter().zip([1.0, 2.0, 3.0]).all(|(x, y)| (x - y).abs() < 1e-14), "{x:?}");
        }
        // The inverse is that of L transposed times that of L.
        let mut cholesky = Cholesky::analyze(&pattern, &[2, 1, 0]).unwrap();
        cholesky.factorize(&values).unwrap();
        let inverse = cholesky.selected_inverse(&pattern);
        let expected = [35.0 / 36.0, -22.0 / 36.0, 30.0 / 36.0, 20.0 / 36.0, -24.0 / 36.0, 1.0];
        assert!(inverse.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-14), "{inverse:?}");
    }

    #[test]
    fn systems_without_and_with_one_unknown() {
        let mut none = Cholesky::<f64>::analyze(&path(0), &[]).unwrap();
        none.factorize(&[]).unwrap();
        none.solve(&mut []);
        none.solve_columns(&mut [], 5);
        assert_eq!(none.factor_len(), 0);
        assert!(none.selected_inverse(&path(0)).is_empty());
        let mut one = Cholesky::analyze(&path(1), &[0]).unwrap();
        one.factorize(&[4.0]).unwrap();
        let mut x = [8.0, 2.0];
        one.solve_columns(&mut x, 2);
        assert_eq!(x, [2.0, 0.5]);
        assert_eq!(one.selected_inverse(&path(1)), [0.25]);
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(one.factorize(&[bad]), Err(NotPositiveDefinite));
        }
        one.factorize(&[16.0]).unwrap();
        one.solve(&mut x[..1]);
        assert_eq!(x[0], 0.125);
    }

    #[test]
    fn singular_matrices_are_refused() {
        // The Laplacian of a path, exactly.
        let pattern = path(8);
        let mut cholesky = Cholesky::analyze(&pattern, &[0, 1, 2, 3, 4, 5, 6, 7]).unwrap();
        let mut values = vec![-1.0; pattern.len()];
        for (k, &slot) in pattern.diagonal().iter().enumerate() {
            values[slot as usize] = if k == 0 || k == 7 { 1.0 } else { 2.0 };
        }
        assert_eq!(cholesky.factorize(&values), Err(NotPositiveDefinite));
        // A part of the system that is singular.
        let loose = PatternBuilder::new(3).build();
        let mut loose = Cholesky::analyze(&loose, &[2, 0, 1]).unwrap();
        assert_eq!(loose.factorize(&[1.0, 0.0, 1.0]), Err(NotPositiveDefinite));
    }

    #[test]
    fn refuses_an_indefinite_matrix_and_a_bad_order() {
        let pattern = path(2);
        let mut cholesky = Cholesky::analyze(&pattern, &[0, 1]).unwrap();
        assert_eq!(cholesky.factorize(&[1.0, 2.0, 1.0]), Err(NotPositiveDefinite));
        for order in [&[0, 0][..], &[0], &[0, 2], &[0, 1, 1]] {
            assert!(Cholesky::<f64>::analyze(&pattern, order).is_err());
        }
    }
}
