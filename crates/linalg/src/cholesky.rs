//! Cholesky factorisation of a sparse Hermitian positive definite matrix.
//!
//! The symbolic analysis depends on the [`Pattern`] and the order only and is kept; each
//! [`Cholesky::factorize`] is numeric work alone. Everything runs on the calling thread: two threads
//! gained nothing on matrices of this kind, and one keeps the bits of the result independent of how
//! many there are.

use crate::pattern::Pattern;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// Numbers that matrices may hold: `f64` and [`num_complex::Complex64`].
pub trait Scalar: faer::traits::ComplexField + Copy + Default + Send + Sync {}
impl Scalar for f64 {}
impl Scalar for num_complex::Complex64 {}

/// How the numeric work is organised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kernel {
    /// By dense blocks of columns with equal structure: for systems with two unknowns per vertex.
    #[default]
    Supernodal,
    /// Column by column: for scalar systems on a surface, whose factors are too sparse for blocks; solves
    /// were twice as fast on a Laplacian of 43,000 vertices.
    Simplicial,
}

/// The matrix is not positive definite to working precision (or holds a value that is not finite).
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is not positive definite to working precision")]
pub struct NotPositiveDefinite;

/// Analysis, factor and workspace for one pattern.
pub struct Cholesky<T: Scalar> {
    symbolic: SymbolicCholesky<u32>,
    factor: Vec<T>,
    workspace: MemBuffer,
}

impl<T: Scalar> Cholesky<T> {
    /// Analyses the pattern for the elimination order given (`order[k]` goes `k`-th), for the supernodal
    /// kernel.
    ///
    /// # Errors
    /// As [`Cholesky::analyze_for`].
    pub fn analyze(pattern: &Pattern, order: &[u32]) -> Result<Self, NotPositiveDefinite> {
        Self::analyze_for(Kernel::Supernodal, pattern, order)
    }

    /// Analyses the pattern for the elimination order given (`order[k]` goes `k`-th).
    ///
    /// # Errors
    /// When memory runs out, or `order` is no permutation of the unknowns.
    pub fn analyze_for(
        kernel: Kernel,
        pattern: &Pattern,
        order: &[u32],
    ) -> Result<Self, NotPositiveDefinite> {
        let n = pattern.order();
        let mut position = vec![u32::MAX; n];
        for (k, &i) in order.iter().enumerate() {
            *position.get_mut(i as usize).ok_or(NotPositiveDefinite)? = k as u32;
        }
        if order.len() != n || position.contains(&u32::MAX) {
            return Err(NotPositiveDefinite);
        }
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: match kernel {
                Kernel::Supernodal => SupernodalThreshold::FORCE_SUPERNODAL,
                Kernel::Simplicial => SupernodalThreshold::FORCE_SIMPLICIAL,
            },
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(
            symbolic_matrix(pattern),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(order, &position, n)),
            params,
        )
        .map_err(|_| NotPositiveDefinite)?;
        let request = StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<T>(1, Par::Seq),
        ]);
        Ok(Self {
            factor: vec![T::default(); symbolic.len_val()],
            workspace: MemBuffer::try_new(request).map_err(|_| NotPositiveDefinite)?,
            symbolic,
        })
    }

    pub(crate) fn symbolic(&self) -> &SymbolicCholesky<u32> {
        &self.symbolic
    }

    pub(crate) fn factor(&self) -> &[T] {
        &self.factor
    }

    /// Number of entries of the factor.
    pub fn factor_len(&self) -> usize {
        self.factor.len()
    }

    /// Factors the matrix whose lower triangle has these values.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`]; the factor is then unusable until the next success.
    pub fn factorize(
        &mut self,
        pattern: &Pattern,
        values: &[T],
    ) -> Result<(), NotPositiveDefinite> {
        let matrix = SparseColMatRef::new(symbolic_matrix(pattern), values);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.workspace),
                Default::default(),
            )
            .map(|_| ())
            .map_err(|_| NotPositiveDefinite)
    }

    /// Overwrites the right-hand side with the solution.
    pub fn solve(&mut self, rhs: &mut [T]) {
        let n = rhs.len();
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, 1),
            Par::Seq,
            MemStack::new(&mut self.workspace),
        );
    }

    /// Solves for several right-hand sides at once, column after column in `rhs`; one pass over the
    /// factor serves all. Needs no exclusive access, so threads can share the factor.
    ///
    /// # Errors
    /// When there is no memory for the workspace.
    pub fn solve_columns(&self, rhs: &mut [T], columns: usize) -> Result<(), NotPositiveDefinite> {
        let n = self.symbolic.nrows();
        let request = self.symbolic.solve_in_place_scratch::<T>(columns, Par::Seq);
        let mut workspace = MemBuffer::try_new(request).map_err(|_| NotPositiveDefinite)?;
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut rhs[..n * columns], n, columns),
            Par::Seq,
            MemStack::new(&mut workspace),
        );
        Ok(())
    }
}

fn symbolic_matrix(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, u32> {
    let n = pattern.order();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.column_offsets, None, &pattern.rows)
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
        for kernel in [Kernel::Supernodal, Kernel::Simplicial] {
            solve_twice(kernel);
        }
    }

    fn solve_twice(kernel: Kernel) {
        let pattern = path(30);
        let order: Vec<u32> = (0..30).rev().collect();
        let mut cholesky = Cholesky::analyze_for(kernel, &pattern, &order).unwrap();
        for shift in [0.1, 2.0] {
            let diagonal = pattern.diagonal();
            let values: Vec<f64> = (0..pattern.len() as u32)
                .map(|k| if diagonal.contains(&k) { 2.0 + shift } else { -1.0 })
                .collect();
            cholesky.factorize(&pattern, &values).unwrap();
            let x: Vec<f64> = (0..30).map(|i| f64::from(i).sin()).collect();
            let mut b = vec![0.0; 30];
            pattern.multiply(&values, &x, &mut b);
            let mut twice = b.repeat(2);
            cholesky.solve(&mut b);
            assert!(x.iter().zip(&b).all(|(x, b)| (x - b).abs() < 1e-12));
            cholesky.solve_columns(&mut twice, 2).unwrap();
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
        cholesky.factorize(&pattern, &values).unwrap();
        let x = [Complex64::new(1.0, 2.0), Complex64::new(-3.0, 0.5)];
        let mut b = [2.0 * x[0] - i * x[1], i * x[0] + 2.0 * x[1]];
        cholesky.solve(&mut b);
        assert!((b[0] - x[0]).norm() < 1e-14 && (b[1] - x[1]).norm() < 1e-14);
    }

    #[test]
    fn refuses_an_indefinite_matrix_and_a_bad_order() {
        let pattern = path(2);
        let mut cholesky = Cholesky::analyze(&pattern, &[0, 1]).unwrap();
        assert_eq!(cholesky.factorize(&pattern, &[1.0, 2.0, 1.0]), Err(NotPositiveDefinite));
        assert!(Cholesky::<f64>::analyze(&pattern, &[0, 0]).is_err());
    }
}
