//! Sizes in proportion to those wanted, for cells of a number in all.

use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::VertexData;

/// Why there are no sizes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SizeError {
    /// Cells of the largest size are too many.
    #[error("cells of the largest size allowed are still more than asked for")]
    TooMany,
    /// Cells of the least size are too few.
    #[error("cells of the least size allowed are still fewer than asked for")]
    TooFew,
    /// The curvature could not be averaged.
    #[error("the curvature of the surface could not be averaged: {0}")]
    Curvature(#[from] NotPositiveDefinite),
}

/// The least and the largest size.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds(pub(super) [f64; 2]);

/// Halvings of an interval of levels, which make it as small as rounding.
const HALVINGS: usize = 60;
/// Bounds that leave no choice but one are met to this.
const SLACK: f64 = 1e-9;

/// The sizes that are one multiple of those wanted, within bounds, and with which the areas of vertices, counted in squares of
/// their sizes, have a sum.
pub(super) fn fitted(
    wanted: &[f64],
    area: &VertexData<f64>,
    goal: f64,
    Bounds([least, largest]): Bounds,
) -> Result<Vec<f64>, SizeError> {
    let size = |factor: f64, v: usize| (factor.exp() * wanted[v]).clamp(least, largest);
    let smallest_wish = wanted.iter().copied().fold(f64::INFINITY, f64::min);
    let largest_wish = wanted.iter().copied().fold(0.0, f64::max);
    let factors = [(least / largest_wish).ln(), (largest / smallest_wish).ln()];
    balanced(wanted.len(), size, factors, area, goal)
}

/// The sizes of `n` vertices, growing with a level between two, with which their areas, counted in squares of sizes, have a sum.
pub(super) fn balanced(
    n: usize,
    size: impl Fn(f64, usize) -> f64,
    [mut low, mut high]: [f64; 2],
    area: &VertexData<f64>,
    goal: f64,
) -> Result<Vec<f64>, SizeError> {
    let sum = |level: f64| {
        let cells = (0..n).zip(area.iter()).map(|(v, area)| {
            let size = size(level, v);
            area / (size * size)
        });
        cells.sum::<f64>()
    };
    if sum(low) < goal * (1.0 - SLACK) {
        return Err(SizeError::TooFew);
    }
    if sum(high) > goal * (1.0 + SLACK) {
        return Err(SizeError::TooMany);
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match sum(middle) > goal {
            true => low = middle,
            false => high = middle,
        }
    }
    let level = 0.5 * (low + high);
    Ok((0..n).map(|v| size(level, v)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_by_hand() {
        let area = VertexData(vec![1.0, 1.0]);
        let bounds = Bounds([0.01, 100.0]);
        // Twice the size: 1 / x^2 + 1 / 4 x^2 = 2.
        let free = fitted(&[1.0, 2.0], &area, 2.0, bounds).unwrap();
        let x = (1.25f64 / 2.0).sqrt();
        assert!((free[0] - x).abs() < 1e-12 && (free[1] - 2.0 * x).abs() < 1e-12);
        // At most 1.1: the other has what is left.
        let bound = fitted(&[1.0, 2.0], &area, 2.0, Bounds([0.01, 1.1])).unwrap();
        let rest: f64 = 2.0 - 1.0 / 1.21;
        assert!(bound[1] == 1.1 && (bound[0] - 1.0 / rest.sqrt()).abs() < 1e-12);
        let refused = |bounds| fitted(&[1.0, 2.0], &area, 2.0, Bounds(bounds)).unwrap_err();
        assert_eq!(refused([0.01, 0.9]), SizeError::TooMany);
        assert_eq!(refused([1.1, 2.0]), SizeError::TooFew);
    }
}
