//! Sparse Cholesky factorisations by faer: the yardstick of times, whatever solver the method uses.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::traits::ComplexField;
use faer::{Conj, MatMut, Par, Side};
use seamstress_linalg::Pattern;
use std::error::Error;

/// How faer organises the work.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Kernel {
    /// By blocks of columns with equal structure.
    Supernodal,
    /// Column by column.
    Simplicial,
}

/// A factorisation on the calling thread.
pub(crate) struct Yardstick<T> {
    symbolic: SymbolicCholesky<u32>,
    factor: Vec<T>,
    workspace: MemBuffer,
}

impl<T: ComplexField + Copy + Default> Yardstick<T> {
    /// Analyses a pattern for an elimination order of its unknowns, and for solves of so many columns at once.
    ///
    /// # Errors
    /// When memory runs out.
    pub(crate) fn new(
        kernel: Kernel,
        pattern: &Pattern,
        order: &[u32],
        columns: usize,
    ) -> Result<Self, Box<dyn Error>> {
        let n = pattern.order();
        let mut position = vec![0; n];
        order.iter().enumerate().for_each(|(k, &i)| position[i as usize] = k as u32);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: match kernel {
                Kernel::Supernodal => SupernodalThreshold::FORCE_SUPERNODAL,
                Kernel::Simplicial => SupernodalThreshold::FORCE_SIMPLICIAL,
            },
            ..Default::default()
        };
        let order = SymmetricOrdering::Custom(PermRef::new_checked(order, &position, n));
        let symbolic = factorize_symbolic_cholesky(structure(pattern), Side::Lower, order, params)
            .map_err(|error| format!("{error:?}"))?;
        let request = StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<T>(columns, Par::Seq),
        ]);
        Ok(Self {
            factor: vec![T::default(); symbolic.len_val()],
            workspace: MemBuffer::new(request),
            symbolic,
        })
    }

    /// Entries of the factor.
    pub(crate) fn factor_len(&self) -> usize {
        self.factor.len()
    }

    /// Factors the matrix whose lower triangle has these values.
    ///
    /// # Errors
    /// When it is not positive definite.
    pub(crate) fn factorize(
        &mut self,
        pattern: &Pattern,
        values: &[T],
    ) -> Result<(), Box<dyn Error>> {
        let factored = self.symbolic.factorize_numeric_llt(
            &mut self.factor,
            SparseColMatRef::new(structure(pattern), values),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut self.workspace),
            Default::default(),
        );
        factored.map(|_| ()).map_err(|error| format!("{error:?}").into())
    }

    /// Overwrites some columns, one after the other, with the solutions.
    pub(crate) fn solve(&mut self, rhs: &mut [T], columns: usize) {
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, self.symbolic.nrows(), columns),
            Par::Seq,
            MemStack::new(&mut self.workspace),
        );
    }
}

fn structure(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, u32> {
    let n = pattern.order();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.column_offsets, None, &pattern.rows)
}
