//! From rounded matchings to a flip-free exact layout: three rungs, each tried where the one before leaves defects.

use super::barrier::barrier;
use super::exact::{Defects, ExactLayout};
use super::route::Route;
use super::untangle::untangle;
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
/// untangled if triangles are flipped; else that of the barrier homotopy, whose few flipped triangles are pulled open as well.
/// The first without flips and wrong angles holds; if there is none, the defects of the last. (No flip alone is not enough: a
/// vertex may be wound once too often.)
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
    let held = |space, y, route, steps| {
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
        if space.defects(sectors, &y).none() {
            return held(space, y, Route::Isometric, 0);
        }
    }
    let mut y = space.poisson(frames)?;
    let mut defects = space.defects(sectors, &y);
    if defects.none() {
        return held(space, y, Route::Rigid, 0);
    }
    let mut steps = 0;
    if !defects.flips.is_empty() {
        (y, steps) = untangle(&mut space, y, watch)?;
        defects = space.defects(sectors, &y);
        if defects.none() {
            return held(space, y, Route::Untangled, steps);
        }
    }
    if effort == LayoutEffort::Brief {
        return Ok(Err(defects));
    }
    watch.pulse()?;
    let closed = barrier(sectors, metric, matched, watch)?;
    let mut y = space.project(sectors.mesh(), cut, &closed.z)?;
    steps += closed.steps;
    let mut defects = space.defects(sectors, &y);
    if !defects.flips.is_empty() {
        // Few are, if any, and the others lie well.
        let (pulled, more) = untangle(&mut space, y, watch)?;
        (y, steps) = (pulled, steps + more);
        defects = space.defects(sectors, &y);
    }
    match defects.none() {
        true => held(space, y, Route::Barrier, steps),
        false => Ok(Err(defects)),
    }
}
