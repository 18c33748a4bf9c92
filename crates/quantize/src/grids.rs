//! The grids to try, one after the other.

use super::IntegerRounding;

/// Cells tried before finer ones, as shares of the area asked for: all make the number of quads asked for
/// within a few percent, but other integers are near.
const NEARBY: [f64; 7] = [1.0, 0.98, 1.02, 0.99, 1.01, 0.97, 1.03];
/// How many of them where there is a map of another size.
const FEW_NEARBY: usize = 3;
/// What the area of a cell falls by when the grid is made finer.
const REFINEMENT: f64 = 1.1;
/// Finer grids tried, as powers of that.
const REFINEMENTS: [usize; 13] = [1, 2, 3, 4, 5, 6, 8, 11, 14, 18, 24, 32, 42];

/// What the rounding keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Care {
    /// Lines between grid points and the faces that they span. The quads may be no manifold.
    Cones,
    /// Also no two edges of quads between the same two points.
    Manifold,
}

/// A grid to try.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    /// Its place among those nearby, with all care first.
    pub(super) nudges: usize,
    /// How much finer it is, as the power of 1.1 in the number of quads.
    pub(super) refinements: usize,
    /// Area of its cells against that of those asked for.
    pub(super) share: f64,
    /// How to round to it.
    pub(super) care: Care,
}

/// The grids to try: first nearby ones, then, if they may be, finer ones. In a group all are alike, so that the
/// rest of it need not be tried once one is hopeless.
///
/// Where they may not be finer, there is a map of another size already, which is kept rather than quads that may
/// be no manifold.
pub(super) fn grids(rounding: IntegerRounding, may_be_finer: bool) -> Vec<Vec<Grid>> {
    let nearby = |n: usize, before: usize, care| -> Vec<Grid> {
        let grid = |(nudges, &share)| Grid { nudges, refinements: 0, share, care };
        (before..).zip(&NEARBY[..n]).map(grid).collect()
    };
    let all = NEARBY.len();
    match (rounding, may_be_finer) {
        (IntegerRounding::Greedy, _) => vec![nearby(1, 0, Care::Manifold)],
        (_, false) => vec![nearby(FEW_NEARBY, 0, Care::Manifold)],
        (_, true) => {
            let finer = |&refinements: &usize| {
                let share = REFINEMENT.powi(-(refinements as i32));
                let grid = |care| vec![Grid { nudges: 0, refinements, share, care }];
                [Care::Manifold, Care::Cones].map(grid)
            };
            let nearby = [nearby(all, 0, Care::Manifold), nearby(all, all, Care::Cones)];
            nearby.into_iter().chain(REFINEMENTS.iter().flat_map(finer)).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_asked_for_comes_first_and_finer_ones_last() {
        let every = grids(IntegerRounding::Constrained, true).concat();
        assert_eq!((every[0].share, every[0].refinements), (1.0, 0));
        assert!(every[..14].iter().enumerate().all(|(k, grid)| grid.nudges == k));
        assert!(every.windows(2).all(|pair| pair[0].refinements <= pair[1].refinements));
        let finest = every.last().map_or(1.0, |grid| grid.share);
        assert!((finest - 1.1f64.powi(-42)).abs() < 1e-12);
        let same = grids(IntegerRounding::Constrained, false).concat();
        assert!(same.iter().all(|g| g.refinements == 0 && g.care == Care::Manifold));
        assert_eq!(grids(IntegerRounding::Greedy, true).concat().len(), 1);
    }
}
