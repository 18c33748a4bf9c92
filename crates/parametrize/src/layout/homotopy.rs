//! From the isometric layout, which has no flips, to one whose seams close.
//!
//! Both routes minimise the symmetric Dirichlet energy plus a penalty on open seams by Newton steps
//! that never flip a triangle. The barrier homotopy raises the penalty towards the final matchings;
//! the lifted continuation also turns the target rotations slowly from the isometric ones, watching
//! that no angle sum slips by a full turn.

use super::newton::{NewtonOptions, minimize};
use super::penalty::SeamPenalty;
use super::problem::LayoutProblem;
use super::space::LinearSpace;
use crate::cut::{MatchedCut, Unfolding};
use crate::energy::{SymmetricDirichlet, Triangle, triangles};
use crate::features::Sectors;
use crate::progress::{Cancelled, SolveError, Watch};
use crate::quarter::{rotation, unit};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{Metric, TriMesh, VertexData};
use std::f64::consts::FRAC_PI_2;

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

/// Penalty weights of the barrier homotopy, per triangle of mean area.
const BARRIER_WEIGHTS: [f64; 4] = [1.0, 1e2, 1e4, 1e6];
const BARRIER_STEPS: NewtonOptions = NewtonOptions { max_iterations: 3, tolerance: 1e-3 };

/// Raises the penalty on the final matchings step by step.
pub fn barrier(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: &MatchedCut,
    watch: &mut Watch<'_, '_>,
) -> Result<PenaltyLayout, SolveError> {
    let targets = matched.matching.iter().map(|&r| unit(r)).collect();
    let mut run = SeamHomotopy::new(sectors, metric, &matched.unfolding, targets)?;
    for (k, weight) in BARRIER_WEIGHTS.into_iter().enumerate() {
        watch.tick(k as f64 / BARRIER_WEIGHTS.len() as f64)?;
        run.relax(weight, &BARRIER_STEPS, watch)?;
    }
    Ok(run.finish())
}

/// Settings of the lifted continuation.
#[derive(Debug, Clone, Copy)]
pub struct Continuation {
    /// Most change of an edge's rotation in one step, quarter turns.
    pub largest_turn: f64,
    /// Most error of a sector's angle after a step, radians.
    pub angle_tolerance: f64,
}

impl Default for Continuation {
    fn default() -> Self {
        Self { largest_turn: 0.3, angle_tolerance: 0.7 }
    }
}

const CONTINUATION_WEIGHT: f64 = 1e3;
const CONTINUATION_LARGEST_WEIGHT: f64 = 1e7;
const CONTINUATION_STEPS: NewtonOptions = NewtonOptions { max_iterations: 2, tolerance: 1e-3 };
const CONTINUATION_MOST_STEPS: usize = 600;

/// Turns the seam targets from the isometric rotations to the matchings along the lifted line between
/// them, `r0 + s (r - r0)`.
pub fn continuation(
    sectors: &Sectors<'_>,
    metric: &Metric,
    matched: &MatchedCut,
    settings: &Continuation,
    watch: &mut Watch<'_, '_>,
) -> Result<PenaltyLayout, SolveError> {
    let unfolding = &matched.unfolding;
    let change: Vec<f64> = matched.excess().collect();
    let at = |s: f64| -> Vec<f64> {
        unfolding.isometric.iter().zip(&change).map(|(r0, d)| r0 + s * d).collect()
    };
    let turns = |r: &[f64]| r.iter().map(|&r| rotation(r)).collect::<Vec<_>>();
    let widest = change.iter().fold(0.0f64, |m, d| m.max(d.abs())).max(1e-9);
    let first_step = (settings.largest_turn / widest).min(1.0);
    let mut run = SeamHomotopy::new(sectors, metric, unfolding, turns(&unfolding.isometric))?;
    let (mut s, mut step, mut weight) = (0.0, first_step, CONTINUATION_WEIGHT);
    while s < 1.0 - 1e-12 && run.steps < CONTINUATION_MOST_STEPS {
        watch.tick(s)?;
        let next = (s + step).min(1.0);
        let r = at(next);
        let index = unfolding.indices(sectors, metric, &r);
        run.set_targets(turns(&r));
        let before = run.y.clone();
        let mut tried = weight;
        let mut reached = false;
        for _ in 0..4 {
            run.relax(tried, &CONTINUATION_STEPS, watch)?;
            if run.angle_error(sectors, &index) < settings.angle_tolerance {
                reached = true;
                break;
            }
            tried = (tried * 10.0).min(CONTINUATION_LARGEST_WEIGHT);
        }
        if reached {
            s = next;
            weight = if tried > weight { (tried / 10.0).max(CONTINUATION_WEIGHT) } else { weight };
            step = (step * 1.4).min(first_step);
        } else if step / 2.0 >= first_step / 32.0 {
            run.y = before;
            step /= 2.0;
        } else {
            // Nowhere to halve to: go on and let the final check judge.
            s = next;
            step = first_step;
        }
    }
    run.set_targets(matched.matching.iter().map(|&r| unit(r)).collect());
    let final_steps = NewtonOptions { max_iterations: 2, tolerance: 1e-3 };
    while weight < CONTINUATION_LARGEST_WEIGHT {
        watch.tick(s)?;
        weight *= 10f64.sqrt();
        run.relax(weight, &final_steps, watch)?;
    }
    Ok(run.finish())
}

struct SeamHomotopy {
    problem: LayoutProblem,
    y: Vec<f64>,
    steps: usize,
}

impl SeamHomotopy {
    fn new(
        sectors: &Sectors<'_>,
        metric: &Metric,
        unfolding: &Unfolding,
        targets: Vec<Complex64>,
    ) -> Result<Self, NotPositiveDefinite> {
        let z = unfolding.positions(sectors, metric);
        let penalty = SeamPenalty::new(sectors, unfolding, targets, 0.0);
        let problem = LayoutProblem::new(
            LinearSpace::free(unfolding.cut.n_wedges),
            triangles(sectors.slit(), metric, &unfolding.cut),
            Some(penalty),
        )?;
        let y = z.iter().flat_map(|z| [z.re, z.im]).collect();
        Ok(Self { problem, y, steps: 0 })
    }

    fn set_targets(&mut self, targets: Vec<Complex64>) {
        if let Some(penalty) = &mut self.problem.penalty {
            penalty.rotations = targets;
        }
    }

    fn relax(
        &mut self,
        weight: f64,
        options: &NewtonOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<(), Cancelled> {
        let share = 1.0 / self.problem.triangles().len() as f64;
        if let Some(penalty) = &mut self.problem.penalty {
            penalty.weight = weight * share;
        }
        let y = std::mem::take(&mut self.y);
        let solution = minimize(&mut self.problem, y, &SymmetricDirichlet, options, watch)?;
        self.y = solution.y;
        self.steps += solution.iterations.max(1);
        Ok(())
    }

    fn angle_error(&self, sectors: &Sectors<'_>, index: &VertexData<f64>) -> f64 {
        let z = self.problem.space().expand(&self.y);
        let slit = sectors.slit();
        let sums = angle_sums(slit, self.problem.triangles(), &z);
        slit.vertices()
            .filter(|&s| !sectors.is_free(s))
            .map(|s| (sums[s] - sectors.quarters(s, index[s]) * FRAC_PI_2).abs())
            .fold(0.0, f64::max)
    }

    fn finish(self) -> PenaltyLayout {
        let z = self.problem.space().expand(&self.y);
        let gap = self.problem.penalty.as_ref().map_or(0.0, |p| p.largest_gap(&z));
        PenaltyLayout { z, steps: self.steps, gap }
    }
}

/// Sum of the layout's corner angles around each vertex of a mesh or sector of a slit one, radians; a flipped corner counts negative.
pub fn angle_sums(mesh: &TriMesh, triangles: &[Triangle], z: &[Complex64]) -> VertexData<f64> {
    let mut sums = VertexData::filled(mesh.n_vertices(), 0.0);
    for (f, t) in mesh.faces().zip(triangles) {
        let p = t.wedges.map(|w| z[w as usize]);
        for (k, v) in mesh.face_vertices(f).into_iter().enumerate() {
            let w = (p[(k + 1) % 3] - p[k]).conj() * (p[(k + 2) % 3] - p[k]);
            sums[v] += w.im.atan2(w.re);
        }
    }
    sums
}
