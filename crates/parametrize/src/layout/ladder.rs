//! From rounded matchings to a flip-free exact layout: rungs of a ladder, each tried where the one before leaves defects.

use super::barrier::barrier;
use super::exact::{Defects, ExactLayout};
use super::patch::Patch;
use super::route::Route;
use super::untangle::untangle;
use super::windings::unwound;
use crate::cut::{FramedCut, MatchedCut};
use crate::features::Sectors;
use crate::progress::{SolveError, Watch};
use crate::quarter::direction;
use seamstress_mesh::Metric;

/// A flip-free exact layout with the right angles.
pub struct SeamlessLayout {
    /// The matchings it closes up to, over the all-seam cut that gauges refer to.
    pub matched: MatchedCut,
    /// The cut and its exact space.
    pub space: ExactLayout,
    /// The unknowns.
    pub y: Vec<f64>,
    /// The rung that held.
    pub route: Route,
    /// Newton steps of the rungs tried.
    pub steps: usize,
}

/// How much to try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutEffort {
    /// Every rung.
    Thorough,
    /// Not the barrier, which costs most: for matchings that may as well be given up.
    Brief,
}

/// Lays out matched seams exactly: the isometric layout if there is no seam; else the one that follows the frames given,
/// its flipped triangles pulled open; its vertices unwound that are wound once too often (no flip alone is not enough); else that
/// of the barrier homotopy. The first without flips and wrong angles holds; if there is none, the defects of the last.
///
/// # Errors
/// [`SolveError`].
pub fn lay_out(
    sectors: &Sectors<'_>,
    metric: &Metric,
    start: &FramedCut,
    effort: LayoutEffort,
    watch: &mut Watch<'_, '_>,
) -> Result<Result<SeamlessLayout, Defects>, SolveError> {
    let FramedCut { matched, frames } = start;
    let cut = &matched.unfolding.cut;
    let mut space = ExactLayout::new(sectors, metric, matched)?;
    let held = |space, Attempt { y, steps, .. }, route| {
        Ok(Ok(SeamlessLayout { matched: matched.clone(), space, y, route, steps }))
    };
    if cut.seams.is_empty() && !sectors.any_aligned() {
        let mut positions = matched.unfolding.positions(sectors, metric);
        let y = space.adopt(cut, &positions);
        // Nothing else tells how it lies in the plane.
        let turns = frames.iter().zip(space.frames(&y)).zip(metric.area.iter());
        let turn = direction(turns.map(|((to, from), area)| area * to * from.conj()).sum());
        positions.iter_mut().for_each(|z| *z *= turn);
        let y = space.adopt(cut, &positions);
        let isometric = Attempt::new(sectors, &space, y, 0);
        if isometric.defects.none() {
            return held(space, isometric, Route::Isometric);
        }
    }
    let y = space.poisson(frames)?;
    let mut attempt = Attempt::new(sectors, &space, y, 0);
    if attempt.defects.none() {
        return held(space, attempt, Route::Rigid);
    }
    attempt = attempt.pulled_open(sectors, &mut space, watch)?;
    if attempt.defects.none() {
        return held(space, attempt, Route::Untangled);
    }
    if attempt.defects.flips.is_empty() {
        let Attempt { y, defects, steps } = &attempt;
        let (y, more) = unwound(sectors, metric, matched, &mut space, y, defects, watch)?;
        let unwound = Attempt::new(sectors, &space, y, steps + more);
        let unwound = unwound.pulled_open(sectors, &mut space, watch)?;
        if unwound.defects.none() {
            return held(space, unwound, Route::Unwound);
        }
        attempt.steps = unwound.steps;
    }
    if effort == LayoutEffort::Brief {
        return Ok(Err(attempt.defects));
    }
    watch.pulse()?;
    let whole = Patch::whole(sectors.mesh(), cut);
    let closed = barrier(sectors, metric, matched, &whole, watch)?;
    let y = space.project(sectors.mesh(), cut, &closed.z)?;
    // Few triangles are flipped, if any, and the others lie well.
    let attempt = Attempt::new(sectors, &space, y, attempt.steps + closed.steps)
        .pulled_open(sectors, &mut space, watch)?;
    match attempt.defects.none() {
        true => held(space, attempt, Route::Barrier),
        false => Ok(Err(attempt.defects)),
    }
}

/// An exact layout, and what is wrong with it.
struct Attempt {
    y: Vec<f64>,
    defects: Defects,
    /// Newton steps so far.
    steps: usize,
}

impl Attempt {
    fn new(sectors: &Sectors<'_>, space: &ExactLayout, y: Vec<f64>, steps: usize) -> Self {
        Self { defects: space.defects(sectors, &y), y, steps }
    }

    /// The same with its flipped triangles pulled open, as far as that succeeds.
    fn pulled_open(
        self,
        sectors: &Sectors<'_>,
        space: &mut ExactLayout,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Self, SolveError> {
        if self.defects.flips.is_empty() {
            return Ok(self);
        }
        let (y, steps) = untangle(space, self.y, watch)?;
        Ok(Self::new(sectors, space, y, self.steps + steps))
    }
}
