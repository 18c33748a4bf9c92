//! From the isometric layout, which has no flips, to one whose seams nearly close.
//!
//! Newton steps that never flip a triangle minimise the symmetric Dirichlet energy plus a penalty on open seams,
//! whose weight grows.

use super::newton::{NewtonOptions, minimize};
use super::penalty::SeamPenalty;
use super::problem::LayoutProblem;
use super::space::LinearSpace;
use crate::cut::MatchedCut;
use crate::energy::{SymmetricDirichlet, triangles};
use crate::features::Sectors;
use crate::progress::{SolveError, Watch};
use crate::quarter::unit;
use num_complex::Complex64;
use seamstress_mesh::Metric;

/// A layout of the all-seam cut with nearly closed seams.
#[derive(Debug, Clone)]
pub struct PenaltyLayout {
    /// Wedge positions.
    pub z: Vec<Complex64>,
    /// Newton steps taken.
    pub steps: usize,
    /// The widest gap left at a seam or an axis, in mean edge lengths.
    pub gap: f64,
}

/// Penalty weights in turn, per triangle of mean area: the first is that of the energy itself, the last leaves gaps of
/// some 1e-5 mean edge lengths, which the projection into the exact space closes without a flip.
const BARRIER_WEIGHTS: [f64; 4] = [1.0, 1e2, 1e4, 1e6];
/// Each weight is only a step on the path; the last one has converged by then.
const BARRIER_STEPS: NewtonOptions = NewtonOptions { max_iterations: 3, tolerance: 1e-3 };

/// Raises the penalty on the final matchings step by step.
///
/// # Errors
/// [`SolveError`].
pub fn barrier(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: &MatchedCut,
    watch: &mut Watch<'_, '_>,
) -> Result<PenaltyLayout, SolveError> {
    let MatchedCut { unfolding, matching } = matched;
    let triangles = triangles(sectors.slit(), metric, &unfolding.cut);
    let share = 1.0 / triangles.len() as f64;
    let rotations = matching.iter().map(|&r| unit(r)).collect();
    let penalty = SeamPenalty::new(sectors, unfolding, rotations, 0.0);
    let space = LinearSpace::free(unfolding.cut.n_wedges);
    let mut problem = LayoutProblem::new(space, triangles, Some(penalty))?;
    let isometric = unfolding.positions(sectors, metric);
    let mut y = isometric.iter().flat_map(|z| [z.re, z.im]).collect();
    let mut steps = 0;
    for (k, weight) in BARRIER_WEIGHTS.into_iter().enumerate() {
        watch.tick(k as f64 / BARRIER_WEIGHTS.len() as f64)?;
        if let Some(penalty) = &mut problem.penalty {
            penalty.weight = weight * share;
        }
        let solution = minimize(&mut problem, y, &SymmetricDirichlet, &BARRIER_STEPS, watch)?;
        (y, steps) = (solution.y, steps + solution.iterations.max(1));
    }
    let z = problem.space().expand(&y);
    let gap = problem.penalty.as_ref().map_or(0.0, |penalty| penalty.largest_gap(&z));
    Ok(PenaltyLayout { z, steps, gap })
}
