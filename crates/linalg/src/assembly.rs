//! Sums of small dense blocks into a sparse symmetric matrix, in parallel and always in one order.

use crate::buckets::Buckets;
use crate::pattern::Pattern;
use seamstress_parallel::prelude::*;

/// Where the entries of local blocks go: elements with a few unknowns each, coupled all with all.
///
/// A local block is the lower triangle of a symmetric matrix by rows, `(i, j)` with `i >= j` at
/// `i (i + 1) / 2 + j`, in the element's own order of unknowns; blocks lie one after the other.
/// Each matrix entry *gathers* its contributions in a fixed order, so that the sum does not depend on
/// the number of threads.
#[derive(Debug, Clone)]
pub struct Assembly {
    pattern: Pattern,
    /// Start of each element in `unknowns`; one more than the number of elements.
    element_offsets: Vec<u32>,
    unknowns: Vec<u32>,
    /// Start of each element's block.
    block_offsets: Vec<u32>,
    /// Block entries of each matrix entry, local entries of each unknown.
    matrix: Buckets,
    vector: Buckets,
}

/// Adds up, for each target, the values it gathers.
fn gather(buckets: &Buckets, values: &[f64], targets: &mut [f64]) {
    targets.par_iter_mut().enumerate().with_min_len(4096).for_each(|(i, out)| {
        *out = buckets.of(i).iter().map(|&source| values[source as usize]).sum();
    });
}

impl Assembly {
    /// Prepares the assembly of elements over [their pattern](Pattern::of_cliques).
    pub fn new<'a>(pattern: Pattern, elements: impl Iterator<Item = &'a [u32]>) -> Self {
        let (mut element_offsets, mut block_offsets) = (vec![0u32], vec![0u32]);
        let (mut all, mut slots) = (Vec::new(), Vec::new());
        for unknowns in elements {
            for (i, &a) in unknowns.iter().enumerate() {
                // The pattern holds every pair.
                slots.extend(unknowns[..=i].iter().filter_map(|&b| pattern.slot(a, b)));
            }
            all.extend_from_slice(unknowns);
            element_offsets.push(all.len() as u32);
            block_offsets.push(slots.len() as u32);
        }
        Self {
            matrix: Buckets::new(pattern.len(), &slots),
            vector: Buckets::new(pattern.order(), &all),
            pattern,
            element_offsets,
            unknowns: all,
            block_offsets,
        }
    }

    /// The pattern of the sum.
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Number of elements.
    pub fn n_elements(&self) -> usize {
        self.element_offsets.len() - 1
    }

    /// Unknowns of an element, in its own order.
    pub fn unknowns(&self, element: usize) -> &[u32] {
        &self.unknowns[self.local(element)]
    }

    /// Where an element's vector lies among the local vectors.
    pub fn local(&self, element: usize) -> std::ops::Range<usize> {
        self.element_offsets[element] as usize..self.element_offsets[element + 1] as usize
    }

    /// Where an element's block lies among the blocks.
    pub fn block(&self, element: usize) -> std::ops::Range<usize> {
        self.block_offsets[element] as usize..self.block_offsets[element + 1] as usize
    }

    /// Total length of the local vectors.
    pub fn locals_len(&self) -> usize {
        self.unknowns.len()
    }

    /// Total length of the blocks.
    pub fn blocks_len(&self) -> usize {
        self.matrix.len()
    }

    /// Sums the blocks into the lower triangle of the matrix.
    pub fn sum_matrix(&self, blocks: &[f64], values: &mut [f64]) {
        gather(&self.matrix, blocks, values);
    }

    /// Sums the local vectors into one vector.
    pub fn sum_vector(&self, locals: &[f64], vector: &mut [f64]) {
        gather(&self.vector, locals, vector);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_springs_by_hand() {
        // k (x_a - x_b)^2 / 2 on pairs (1, 0) and (1, 2)
        let elements: [&[u32]; 2] = [&[1, 0], &[1, 2]];
        let assembly =
            Assembly::new(Pattern::of_cliques(3, elements.into_iter()), elements.into_iter());
        assert_eq!(assembly.unknowns(1), [1, 2]);
        let blocks = [5.0, -5.0, 5.0, 7.0, -7.0, 7.0];
        assert_eq!(assembly.blocks_len(), 6);
        let mut values = vec![0.0; assembly.pattern().len()];
        assembly.sum_matrix(&blocks, &mut values);
        let at = |i, j| values[assembly.pattern().slot(i, j).unwrap() as usize];
        assert_eq!([at(0, 0), at(1, 1), at(2, 2)], [5.0, 12.0, 7.0]);
        assert_eq!([at(1, 0), at(2, 1)], [-5.0, -7.0]);
        let mut vector = vec![0.0; 3];
        assembly.sum_vector(&[1.0, 2.0, 3.0, 4.0], &mut vector);
        assert_eq!(vector, [2.0, 4.0, 4.0]);
    }
}
