//! From the isometric layout, which has no flips, to one whose seams nearly close: of the whole mesh or a patch of it.
//!
//! Newton steps that never flip a triangle minimise the symmetric Dirichlet energy plus a penalty on open seams,
//! whose weight grows.

use super::newton::{NewtonOptions, minimize};
use super::patch::Patch;
use super::penalty::SeamPenalty;
use super::problem::LayoutProblem;
use super::space::LinearSpace;
use crate::cut::MatchedCut;
use crate::energy::{SymmetricDirichlet, triangles_of};
use crate::features::Sectors;
use crate::progress::{SolveError, Watch};
use crate::quarter::{rotation, unit};
use num_complex::Complex64;
use seamstress_mesh::Metric;

/// A layout of a patch of the all-seam cut with nearly closed seams.
#[derive(Debug, Clone)]
pub struct PenaltyLayout {
    /// Position of every wedge of the patch.
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

/// Most that a seam is turned in one stage, quarter turns: half of what would leave open which way round.
const LARGEST_TURN: f64 = 1.0;
/// Penalty weight while seams are turned: enough for them to follow.
const TURNING_WEIGHT: f64 = 1e2;

/// Turns the seams of a patch of the all-seam cut in stages from their isometric rotations to the final matchings, and raises
/// the penalty on these step by step. The patch is free at its rim.
///
/// # Errors
/// [`SolveError`].
pub fn barrier(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: &MatchedCut,
    patch: &Patch,
    watch: &mut Watch<'_, '_>,
) -> Result<PenaltyLayout, SolveError> {
    let MatchedCut { unfolding, matching } = matched;
    let triangles = triangles_of(metric, patch.faces().iter().map(|&f| (f, patch.wedges(f))));
    let share = 1.0 / sectors.slit().n_faces() as f64;
    let excess: Vec<f64> = matched.excess().collect();
    let turning = unfolding.turning.iter().zip(&excess).filter(|(h, _)| patch.has(**h));
    let widest = turning.fold(0.0f64, |widest, (_, turn)| widest.max(turn.abs()));
    let stages = (widest / LARGEST_TURN).ceil().max(1.0) as usize;
    let targets = |stage: usize| -> Vec<Complex64> {
        let left = 1.0 - stage as f64 / stages as f64;
        let seams = matching.iter().zip(&excess);
        seams.map(|(&r, excess)| unit(r) * rotation(-left * excess)).collect()
    };
    let turning = (1..stages).map(|stage| (stage, TURNING_WEIGHT));
    let path = turning.chain(BARRIER_WEIGHTS.map(|weight| (stages, weight)));
    let penalty = SeamPenalty::new(sectors, unfolding, patch, targets(0), 0.0);
    let space = LinearSpace::free(patch.n_wedges());
    let mut problem = LayoutProblem::new(space, triangles, Some(penalty))?;
    let isometric = unfolding.positions(sectors, metric);
    let mut y = vec![0.0; 2 * patch.n_wedges()];
    for (h, w) in patch.corners() {
        let z = isometric[unfolding.cut.wedge[h] as usize];
        [y[2 * w as usize], y[2 * w as usize + 1]] = [z.re, z.im];
    }
    let mut steps = 0;
    for (k, (stage, weight)) in path.enumerate() {
        watch.tick(k as f64 / (stages + BARRIER_WEIGHTS.len()) as f64)?;
        if let Some(penalty) = &mut problem.penalty {
            penalty.rotations = targets(stage);
            penalty.weight = weight * share;
        }
        let solution = minimize(&mut problem, y, &SymmetricDirichlet, &BARRIER_STEPS, watch)?;
        (y, steps) = (solution.y, steps + solution.iterations.max(1));
    }
    let z = problem.space().expand(&y);
    let gap = problem.penalty.as_ref().map_or(0.0, |penalty| penalty.largest_gap(&z));
    Ok(PenaltyLayout { z, steps, gap })
}
