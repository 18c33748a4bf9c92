//! The bounded-distortion program (9) over layouts in which only the rounded seams close.

use super::search::{NodeSolution, Relax, Verdict};
use crate::layout::conic::{
    Outcome, Program, ProgramKind, Renewal, Solver, SolverOptions, interior_point, solve,
};
use crate::layout::exact::ExactLayout;
use crate::progress::{Cancelled, Watch};
use crate::quarter::turn;
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{Halfedge, HalfedgeData, Metric, TriMesh};
use std::f64::consts::FRAC_PI_2;

/// Positions of the corners of each face, and its frame, in the gauge of the all-seam cut.
#[derive(Debug, Clone)]
pub(super) struct BatchLayout {
    pub(super) corner: HalfedgeData<Complex64>,
    pub(super) frames: Vec<Complex64>,
}

/// The programs of one batch: matchings rounded before are held, those of the batch are variables, the
/// seams of all others are free.
pub(super) struct BatchProgram<'a> {
    pub(super) mesh: &'a TriMesh,
    pub(super) metric: &'a Metric,
    /// The half-edges of all seams.
    pub(super) turning: &'a [Halfedge],
    /// Matchings rounded before, by seam.
    pub(super) rounded: &'a [Option<i32>],
    /// Seams of the batch.
    pub(super) batch: &'a [usize],
    /// Rotation of every seam in the last layout; lifts are chosen next to these.
    pub(super) rotation: &'a [f64],
    /// Frames of the convexification, those of the last layout.
    pub(super) frames: &'a [Complex64],
    pub(super) tolerance: f64,
}

/// Most interior-point iterations.
const MAX_ITERATIONS: usize = 60;
/// Choices that lead to a larger tau count as having no layout: the final layout does better from any start.
pub(super) const MOST_TAU: f64 = 4.0;
/// Gap of the program that looks for a start, fine enough to tell [`MOST_TAU`].
const DEVIATION_GAP: f64 = 5e-4;

impl Relax for BatchProgram<'_> {
    type State = BatchLayout;

    fn relax(
        &mut self,
        values: &[Option<i32>],
        from: &BatchLayout,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Verdict<BatchLayout>, Cancelled> {
        let mut rounded = self.rounded.to_vec();
        for (&seam, &value) in self.batch.iter().zip(values) {
            rounded[seam] = value;
        }
        match self.solve(&rounded, from, watch)? {
            Ok(verdict) => Ok(verdict),
            Err(NotPositiveDefinite) => Ok(Verdict::Unsolved),
        }
    }

    fn are_close(&self, a: usize, b: usize) -> bool {
        let ends = |k: usize| {
            let h = self.turning[self.batch[k]];
            [self.mesh.origin(h), self.mesh.tip(h)]
        };
        let (a, b) = (ends(a), ends(b));
        a.iter().any(|v| b.contains(v))
    }
}

impl BatchProgram<'_> {
    /// The program with some seams held. Slit along the others the mesh has a boundary there, and its exact
    /// space is that of the layouts which close the seams held and nothing else.
    fn solve(
        &self,
        rounded: &[Option<i32>],
        from: &BatchLayout,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Result<Verdict<BatchLayout>, NotPositiveDefinite>, Cancelled> {
        let (slit, matching) = self.slit(rounded);
        let (mut layout, start) = match self.start(&slit, &matching, from) {
            Ok(started) => started,
            Err(error) => return Ok(Err(error)),
        };
        let frames = self.frames.iter().zip(layout.gauge.iter()).map(|(&r, &k)| turn(r, k));
        let program =
            Program { kind: ProgramKind::Stretch, frames: frames.collect(), scales: None };
        let Some(start) = inside(&mut layout, &program, start, watch)? else {
            return Ok(Ok(Verdict::Infeasible));
        };
        let options = SolverOptions { tolerance: self.tolerance, max_iterations: MAX_ITERATIONS };
        let solution = solve(layout.problem_mut(), &program, &start, Solver::Own, &options, watch)?;
        Ok(Ok(match solution.outcome {
            Outcome::Solved => {
                let corner = layout.corners(&slit, &solution.y);
                Verdict::Solved(NodeSolution {
                    value: solution.objective.sqrt(),
                    bound: (solution.objective * (1.0 - solution.gap)).max(1.0).sqrt(),
                    position: self.batch.iter().map(|&seam| self.position(seam, &corner)).collect(),
                    state: BatchLayout { corner, frames: layout.frames(&solution.y) },
                })
            }
            Outcome::Infeasible => Verdict::Infeasible,
            _ => Verdict::Unsolved,
        }))
    }

    /// The mesh slit along the seams that are not rounded, and the matchings of the others.
    fn slit(&self, rounded: &[Option<i32>]) -> (TriMesh, HalfedgeData<i32>) {
        let mut open = HalfedgeData::filled(self.mesh.n_halfedges(), false);
        let mut matching = HalfedgeData::filled(self.mesh.n_halfedges(), 0);
        for (&h, value) in self.turning.iter().zip(rounded) {
            let Some(t) = self.mesh.twin(h) else { continue };
            match value {
                None => (open[h], open[t]) = (true, true),
                Some(r) => (matching[h], matching[t]) = (*r, -r),
            }
        }
        (self.mesh.slit(&open).0, matching)
    }

    fn position(&self, seam: usize, corner: &HalfedgeData<Complex64>) -> f64 {
        rotation(self.mesh, self.turning[seam], corner, self.rotation[seam])
    }

    /// The exact layouts, and the one nearest to the layout given.
    fn start(
        &self,
        slit: &TriMesh,
        matching: &HalfedgeData<i32>,
        from: &BatchLayout,
    ) -> Result<(ExactLayout, Vec<f64>), NotPositiveDefinite> {
        let mut layout = ExactLayout::closing(slit, self.metric, matching)?;
        let start = layout.nearest(slit, &from.corner)?;
        Ok((layout, start))
    }
}

/// A layout inside the constraints of a program, if one is found soon, else the layout given; none
/// where every solution has a tau above [`MOST_TAU`].
///
/// Least deviation from the frames, (8), is a program that any layout can start. A solution of ours at `mu`,
/// scaled by `1 / mu^2`, has a squared deviation of at most `1 - 1 / mu^2`.
fn inside(
    layout: &mut ExactLayout,
    program: &Program,
    start: Vec<f64>,
    watch: &mut Watch<'_, '_>,
) -> Result<Option<Vec<f64>>, Cancelled> {
    let is_inside = |layout: &ExactLayout, y: &[f64]| {
        program.value(layout.problem(), &layout.expand(y)).is_finite()
    };
    if is_inside(layout, &start) {
        return Ok(Some(start));
    }
    let deviation = Program { kind: ProgramKind::Deviation, ..program.clone() };
    let options = SolverOptions { tolerance: DEVIATION_GAP, max_iterations: MAX_ITERATIONS };
    let problem = layout.problem_mut();
    let near = interior_point::solve(problem, &deviation, &start, Renewal::Never, &options, watch)?;
    let least = (0.5 * near.objective).sqrt() * (1.0 - near.gap);
    if near.outcome == Outcome::Solved && least.powi(2) > 1.0 - MOST_TAU.powi(-4) {
        return Ok(None);
    }
    Ok(Some(if is_inside(layout, &near.y) { near.y } else { start }))
}

/// Angle from the left to the right image of a seam, on the branch nearest to `last`; quarters.
pub(super) fn rotation(
    mesh: &TriMesh,
    h: Halfedge,
    corner: &HalfedgeData<Complex64>,
    last: f64,
) -> f64 {
    let left = corner[h.next()] - corner[h];
    let right = mesh.twin(h).map_or(left, |t| corner[t] - corner[t.next()]);
    let turned = (right * left.conj()).arg() / FRAC_PI_2;
    last + (turned - last + 2.0).rem_euclid(4.0) - 2.0
}
