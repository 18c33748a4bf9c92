//! The rounding loop: batch after batch of integer variables.

use super::program::{BatchLayout, BatchProgram, MOST_TAU, rotation};
use super::search::{Limits, SearchResult, search};
use super::{BatchStats, MixedIntegerOptions, MixedIntegerStats};
use crate::cut::{FramedCut, MatchedCut, Unfolding, frames_of_angles, unfold};
use crate::progress::{Cancelled, Watch};
use seamstress_mesh::{Metric, TriMesh};
use web_time::Instant;

/// Distances to integers closer than this are the same, quarters.
const SAME: f64 = 1e-9;

/// Chooses the matchings of a connected mesh by mixed-integer programs, with nothing aligned.
///
/// Batches are of the matchings nearest to integers in the last layout. Each may take one of the two
/// integers next to it. A batch is rounded to the best integers found; where none are found, so much of it
/// as the search had decided; and where it had decided nothing, the batch is halved. Returns the rotations of the faces in the last layout, in the gauge of the all-seam cut, and how
/// it went.
///
/// # Errors
/// [`Cancelled`].
///
/// # Source
/// Levi 2021, supplement, section 10; there the program is given to a commercial solver.
pub fn round_mixed_integer(
    mesh: &TriMesh,
    metric: &Metric,
    unfolding: Unfolding,
    options: &MixedIntegerOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(FramedCut, MixedIntegerStats), Cancelled> {
    let deadline = options.time_limit.map(|limit| Instant::now() + limit);
    let limits = Limits { nodes: options.nodes.max(1), deadline, tolerance: options.tolerance };
    let mut state = BatchRounding::begin(mesh, metric, unfolding);
    let mut stats = MixedIntegerStats::default();
    let most = options.batch.max(1);
    let mut size = most;
    loop {
        let batch = state.nearest(size);
        watch.tick(state.share_rounded())?;
        let is_late = deadline.is_some_and(|deadline| Instant::now() >= deadline);
        if batch.is_empty() || is_late {
            break;
        }
        let begun = Instant::now();
        let found = state.choose(&batch, &limits, watch)?;
        stats.batches.push(BatchStats {
            integers: batch.len(),
            nodes: found.nodes,
            tau: found.incumbent.as_ref().map(|best| best.value),
            bound: found.bound.clamp(1.0, MOST_TAU),
            proven: found.is_exhausted && found.incumbent.is_some(),
            seconds: begun.elapsed().as_secs_f64(),
        });
        let values =
            found.incumbent.map(|best| (best.values.into_iter().map(Some).collect(), best.state));
        match values.or(found.partial) {
            Some((values, layout)) => {
                state.accept(&batch, &values, layout);
                size = (2 * batch.len()).min(most);
            }
            None if batch.len() > 1 => size = batch.len() / 2,
            // Neither integer has a layout with these frames, and no other choice would change that.
            None => break,
        }
    }
    let rest: Vec<usize> = state.open().collect();
    stats.left_to_nearest += state.round_to_nearest(&rest);
    let BatchRounding { unfolding, rounded, layout, .. } = state;
    let nearest = unfolding.isometric.iter().map(|r| r.round() as i32);
    let matching = rounded.into_iter().zip(nearest).map(|(r, r0)| r.unwrap_or(r0)).collect();
    let matched = MatchedCut { unfolding, matching };
    Ok((FramedCut { matched, frames: layout.frames }, stats))
}

/// Matchings on their way to integers.
struct BatchRounding<'a> {
    mesh: &'a TriMesh,
    metric: &'a Metric,
    unfolding: Unfolding,
    /// Integer of each seam that has one.
    rounded: Vec<Option<i32>>,
    /// Rotation of each seam in the last layout.
    rotation: Vec<f64>,
    /// The last layout.
    layout: BatchLayout,
}

impl<'a> BatchRounding<'a> {
    /// From the isometric layout.
    fn begin(mesh: &'a TriMesh, metric: &'a Metric, unfolding: Unfolding) -> Self {
        let Unfolding { tree, cut, .. } = &unfolding;
        let z = unfold(mesh, metric, tree, cut);
        let corner = mesh.halfedges().map(|h| z[cut.wedge[h] as usize]).collect();
        let frames = frames_of_angles(mesh, metric, &metric.angle, tree);
        Self {
            mesh,
            metric,
            rounded: vec![None; unfolding.turning.len()],
            rotation: unfolding.isometric.clone(),
            layout: BatchLayout { corner, frames },
            unfolding,
        }
    }

    fn open(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.rounded.len()).filter(|&seam| self.rounded[seam].is_none())
    }

    fn share_rounded(&self) -> f64 {
        1.0 - self.open().count() as f64 / self.rounded.len().max(1) as f64
    }

    /// The open seams nearest to integers, so many at most, ascending.
    fn nearest(&self, size: usize) -> Vec<usize> {
        let distance = |seam: usize| {
            let r = self.rotation[seam];
            ((r - r.round()).abs() / SAME).round() as i64
        };
        let mut open: Vec<(i64, usize)> = self.open().map(|s| (distance(s), s)).collect();
        open.sort_unstable();
        let mut batch: Vec<usize> = open.into_iter().take(size).map(|(_, seam)| seam).collect();
        batch.sort_unstable();
        batch
    }

    /// Branch and bound over the integers of a batch.
    fn choose(
        &self,
        batch: &[usize],
        limits: &Limits,
        watch: &mut Watch<'_, '_>,
    ) -> Result<SearchResult<BatchLayout>, Cancelled> {
        let mut program = BatchProgram {
            mesh: self.mesh,
            metric: self.metric,
            turning: &self.unfolding.turning,
            rounded: &self.rounded,
            batch,
            rotation: &self.rotation,
            frames: &self.layout.frames,
            tolerance: limits.tolerance,
        };
        let next = |&seam: &usize| two_nearest(self.rotation[seam]);
        let choices: Vec<[i32; 2]> = batch.iter().map(next).collect();
        search(&mut program, &choices, &self.layout, limits, watch)
    }

    /// Rounds what was decided of a batch and moves on to its layout.
    fn accept(&mut self, batch: &[usize], values: &[Option<i32>], layout: BatchLayout) {
        for (&seam, &value) in batch.iter().zip(values) {
            self.rounded[seam] = value;
        }
        for seam in 0..self.rounded.len() {
            if self.rounded[seam].is_none() {
                let h = self.unfolding.turning[seam];
                self.rotation[seam] = rotation(self.mesh, h, &layout.corner, self.rotation[seam]);
            }
        }
        self.layout = layout;
    }

    fn round_to_nearest(&mut self, seams: &[usize]) -> usize {
        for &seam in seams {
            self.rounded[seam] = Some(self.rotation[seam].round() as i32);
        }
        seams.len()
    }
}

/// The integers next to a rotation, the nearest first; a whole number has the next smaller one as well.
fn two_nearest(rotation: f64) -> [i32; 2] {
    // Rounding errors must not decide on which side of a whole number a rotation lies.
    let nearest = rotation.round();
    let is_above = rotation - nearest > SAME;
    let nearest = nearest as i32;
    [nearest, if is_above { nearest + 1 } else { nearest - 1 }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_next_to_a_rotation() {
        assert_eq!(two_nearest(0.3), [0, 1]);
        assert_eq!(two_nearest(-0.3), [0, -1]);
        assert_eq!(two_nearest(2.7), [3, 2]);
        assert_eq!(two_nearest(1e-12), two_nearest(-1e-12));
    }
}
