//! The direct method on one connected mesh.

use super::fewer_cones::fewer_cones;
use super::finish::Finished;
use super::{ComponentStats, MapOptions, StageStats};
use crate::cut::{DualTree, curvature_weight};
use crate::layout::safeguards::{Laid, LayoutError, lay_out, way_back};
use crate::map::{SeamlessMap, Violations};
use crate::progress::{Stage, Watch};
use crate::rounding::{MatchedCut, repair, round};
use num_complex::Complex64;
use seamstress_surface::{Component, Halfedge, Metric, TriMesh};
use std::time::Instant;

/// Exponents of the metrics to solve in: the mesh's own, then snowflakes for meshes whose triangles are
/// too thin for arithmetic.
const EXPONENTS: [f64; 3] = [1.0, 0.5, 0.3];

/// UVs per corner of one component, in mesh units, and how they were made.
pub(super) fn map_component(
    piece: &Component,
    positions: &[[f64; 3]],
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<[f64; 2]>, ComponentStats), LayoutError> {
    let positions: Vec<_> = piece.vertices.iter().map(|v| positions[v.at()]).collect();
    let metric = Metric::from_positions(&piece.mesh, &positions);
    let mut first_failure = None;
    for exponent in EXPONENTS {
        match solve(&piece.mesh, &metric, exponent, options, watch) {
            Ok(solved) => return Ok(solved),
            Err(LayoutError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(failure) => first_failure = first_failure.or(Some(failure)),
        }
    }
    Err(first_failure.unwrap_or(LayoutError::Defective(Default::default())))
}

/// Cut, round, lay out, clean up: the direct method in the metric with lengths to the given exponent,
/// and back to the plain metric.
fn solve(
    mesh: &TriMesh,
    plain: &Metric,
    exponent: f64,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<[f64; 2]>, ComponentStats), LayoutError> {
    let mut clock = Clock::new();

    watch.enter(Stage::Cut)?;
    let metric = if exponent < 1.0 { plain.snowflake(mesh, exponent) } else { plain.clone() };
    let tree = DualTree::lightest(mesh, curvature_weight(mesh, &metric));
    let mut matched = MatchedCut::new(mesh, &metric, tree);
    clock.lap(Stage::Cut, 0);

    watch.enter(Stage::Rounding)?;
    let (frames, rounding) = round(mesh, &metric, &mut matched, &options.rounding, watch)?;
    let (repaired_seams, _) = repair(mesh, &metric, &mut matched);
    clock.lap(Stage::Rounding, rounding.layouts);

    watch.enter(Stage::Layout)?;
    let laid = lay_out(mesh, &metric, matched, Some(&frames), watch)?;
    let mut finished = Finished::new(laid, watch)?;
    clock.lap(Stage::Layout, finished.iterations);

    if options.cone_price > 0.0 {
        watch.enter(Stage::CleanUp)?;
        let (better, iterations) = fewer_cones(mesh, &metric, finished, options.cone_price, watch)?;
        finished = better;
        clock.lap(Stage::CleanUp, iterations);
    }

    let mut laid = finished.laid;
    let mut candidates = vec![corner_uvs(mesh, plain, &laid)];
    if exponent < 1.0 {
        laid.y = way_back(mesh, plain, &mut laid.layout, laid.y, exponent, watch)?;
        candidates.push(corner_uvs(mesh, plain, &laid));
    }
    // The thinnest triangles may flip when the result is scaled and moved: look at what is given out.
    let certify = |uvs: &Vec<_>| SeamlessMap::certify(mesh, uvs.clone(), &options.tolerance);
    let mut failure = Violations(Vec::new());
    let certified = candidates.into_iter().rev().find(|uvs| match certify(uvs) {
        Ok(_) => true,
        Err(violations) => {
            failure = violations;
            false
        }
    });
    let Some(uvs) = certified else { return Err(LayoutError::Uncertified(failure)) };
    let stats = ComponentStats {
        faces: mesh.n_faces(),
        genus: mesh.genus(),
        boundary_loops: mesh.n_boundary_loops(),
        route: laid.route,
        metric_exponent: exponent,
        rounding_rounds: rounding.rounds,
        repaired_seams,
        stages: clock.laps,
    };
    Ok((uvs, stats))
}

/// UVs per corner in mesh units at the best global scale, the lower left corner of their box at zero.
fn corner_uvs(mesh: &TriMesh, plain: &Metric, laid: &Laid) -> Vec<[f64; 2]> {
    let mut y = laid.y.clone();
    laid.layout.rescale(&mut y);
    let z = laid.layout.expand(&y);
    let low =
        |coordinate: fn(&Complex64) -> f64| z.iter().map(coordinate).fold(f64::INFINITY, f64::min);
    let corner = Complex64::new(low(|z| z.re), low(|z| z.im));
    let uv = |h: Halfedge| (z[laid.layout.cut.wedge[h] as usize] - corner) * plain.unit;
    mesh.halfedges().map(|h| [uv(h).re, uv(h).im]).collect()
}

/// Seconds and iterations by stage.
struct Clock {
    start: Instant,
    laps: Vec<StageStats>,
}

impl Clock {
    fn new() -> Self {
        Self { start: Instant::now(), laps: Vec::new() }
    }

    fn lap(&mut self, stage: Stage, iterations: usize) {
        let seconds = self.start.elapsed().as_secs_f64();
        self.laps.push(StageStats { stage, seconds, iterations });
        self.start = Instant::now();
    }
}
