//! A certified map of one connected mesh.

use super::fewer_cones::{Terms, fewer_cones};
use super::finish::Finished;
use super::mended::lay_out_or_mend;
use super::parts::in_component;
use super::start::{Begun, Start};
use super::{ComponentStats, MapOptions, StageStats};
use crate::features::{ReleasedFeature, Sectors, drop_conflicts, release_near};
use crate::layout::exact::ExactLayout;
use crate::layout::objective::{ObjectiveOptions, optimize};
use crate::layout::polish::PolishOptions;
use crate::layout::safeguards::{LayoutError, lay_out, way_back};
use crate::map::{Alignment, AlignmentTolerance, SeamlessMap, Violations};
use crate::progress::{Stage, Watch};
use crate::rounding::RoundingStrategy;
use num_complex::Complex64;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Halfedge, Metric, TriMesh, VertexData};
use web_time::Instant;

/// Exponents of the metrics to solve in: the mesh's own, then snowflakes for meshes whose triangles are
/// too thin for arithmetic.
const EXPONENTS: [f64; 3] = [1.0, 0.5, 0.3];
/// Mixed-integer rounding of more triangles than this takes many minutes.
const LAST_RESORT_FACES: usize = 20_000;
/// Rounds in which features near defects are released, each with a wider ring.
const RELEASE_ROUNDS: usize = 8;

/// The map of one component, in its own ids.
pub(super) struct ComponentMap {
    /// UVs per corner, mesh units.
    pub(super) uvs: Vec<[f64; 2]>,
    /// The edges that are aligned.
    pub(super) features: EdgeSet,
    /// Those that were to be, but are not.
    pub(super) released: Vec<ReleasedFeature>,
    pub(super) stats: ComponentStats,
}

/// Maps one component: drops features that contradict each other, solves, and releases features around
/// what went wrong until it goes right.
pub(super) fn map_component(
    piece: &Component,
    positions: &[[f64; 3]],
    start: &Start,
    features: &EdgeSet,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ComponentMap, LayoutError> {
    let mesh = &piece.mesh;
    let positions: Vec<_> = piece.vertices.iter().map(|v| positions[v.at()]).collect();
    let metric = Metric::from_positions(mesh, &positions);
    let (mut features, mut released) =
        drop_conflicts(mesh, &positions, &metric, in_component(features, piece));
    let sectors_of = |features: &EdgeSet| {
        Sectors::new(mesh, &metric, features).with_largest_index(options.largest_index())
    };
    let mut sectors = sectors_of(&features);
    let mut begun = None;
    for round in 0..=RELEASE_ROUNDS {
        if features.is_empty() {
            break;
        }
        let failure = match solve(&sectors, &metric, 1.0, start, &mut begun, options, watch) {
            Ok((uvs, stats)) => return Ok(ComponentMap { uvs, features, released, stats }),
            Err(LayoutError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(failure) => failure,
        };
        let near = match failure {
            LayoutError::Defective(defects) if round < RELEASE_ROUNDS => defects.vertices(mesh),
            _ => VertexData::filled(mesh.n_vertices(), true),
        };
        let (kept, more) = release_near(mesh, near, round, &features);
        let fewer = sectors_of(&kept);
        // What was rounded stays, unless it was at fault itself.
        begun = begun.and_then(|b: Begun| b.with_fewer_aligned(&sectors, &fewer, &metric).ok());
        (features, sectors) = (kept, fewer);
        released.extend(more);
    }
    let (uvs, stats) = map_unaligned(mesh, &metric, start, options, watch)?;
    Ok(ComponentMap { uvs, features, released, stats })
}

/// Maps one component with nothing aligned, in whichever metric it takes.
fn map_unaligned(
    mesh: &TriMesh,
    metric: &Metric,
    start: &Start,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<[f64; 2]>, ComponentStats), LayoutError> {
    let sectors = Sectors::unaligned(mesh).with_largest_index(options.largest_index());
    let mut first_failure = None;
    for exponent in EXPONENTS {
        match solve(&sectors, metric, exponent, start, &mut None, options, watch) {
            Ok(solved) => return Ok(solved),
            Err(LayoutError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(failure) => first_failure = first_failure.or(Some(failure)),
        }
    }
    let failure = first_failure.unwrap_or(LayoutError::Defective(Default::default()));
    if let (LayoutError::Defective(_), Some(options)) =
        (&failure, last_resort(mesh, start, options))
    {
        match solve(&sectors, metric, 1.0, start, &mut None, &options, watch) {
            Ok(solved) => return Ok(solved),
            Err(LayoutError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(_) => {}
        }
    }
    Err(failure)
}

/// The other way of rounding for a component that nothing else has mapped: mixed integers if it is small
/// enough, or, where these were asked for, the default.
fn last_resort(mesh: &TriMesh, start: &Start, options: &MapOptions) -> Option<MapOptions> {
    let mut last = *options;
    last.rounding.strategy = match options.rounding.strategy {
        RoundingStrategy::MixedInteger => RoundingStrategy::default(),
        _ => RoundingStrategy::MixedInteger,
    };
    let is_fit = options.rounding.strategy == RoundingStrategy::MixedInteger
        || mesh.n_faces() <= LAST_RESORT_FACES;
    (matches!(start, Start::Mesh) && is_fit).then_some(last)
}

/// Cut and round or what else there is to start from, lay out, clean up: in the metric with lengths to the
/// given exponent, and back to the plain metric. Matchings given are laid out as they are; where edges are
/// aligned, those that were laid out are left there.
fn solve(
    sectors: &Sectors<'_>,
    plain: &Metric,
    exponent: f64,
    start: &Start,
    given: &mut Option<Begun>,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<[f64; 2]>, ComponentStats), LayoutError> {
    let mesh = sectors.mesh();
    let mut clock = Clock::new();

    watch.enter(Stage::Cut)?;
    let metric = if exponent < 1.0 { plain.snowflake(mesh, exponent) } else { plain.clone() };
    clock.lap(Stage::Cut, 0);

    watch.enter(Stage::Rounding)?;
    let mut begun = match given.take() {
        Some(begun) => begun,
        None => start.begin(sectors, &metric, options, watch)?,
    };
    *given = sectors.any_aligned().then(|| begun.clone());
    let mixed_integer = begun.mixed_integer.take();
    clock.lap(Stage::Rounding, begun.layouts);

    watch.enter(Stage::Layout)?;
    let (rounds, shifted_seams) = (begun.rounds, begun.shifted_seams);
    let (laid, mended_seams) = if start.leaves_cones_free() && !sectors.any_aligned() {
        lay_out_or_mend(sectors, &metric, begun, watch)?
    } else {
        (lay_out(sectors, &metric, begun.matched, Some(&begun.frames), watch)?, 0)
    };
    let mut finished = Finished::judged(sectors, laid, watch)?;
    clock.lap(Stage::Layout, finished.iterations);

    let terms = Terms::new(options, plain, sectors.any_aligned());
    if let Some(terms) = terms.filter(|_| start.leaves_cones_free()) {
        watch.enter(Stage::CleanUp)?;
        let (better, iterations) = fewer_cones(sectors, &metric, finished, &terms, watch)?;
        finished = better;
        clock.lap(Stage::CleanUp, iterations);
    }

    let aligned = sectors.any_aligned();
    if aligned || options.polish.is_some() {
        watch.enter(Stage::Polish)?;
    }
    if aligned {
        let before = finished.iterations;
        finished.sharpen(watch)?;
        clock.lap(Stage::Polish, finished.iterations - before);
    }
    // Where edges are aligned, sharpening is mostly all that can be done: few triangles hold tau up.
    let spent = |polish: &PolishOptions| aligned && finished.has_risen_beyond(polish);
    if let Some(polish) = options.polish.filter(|polish| !spent(polish)) {
        let iterations = finished.polish(&polish, watch)?;
        clock.lap(Stage::Polish, iterations);
    }

    let mut laid = finished.laid;
    laid.layout.rescale(&mut laid.y);
    let mut candidates = vec![corner_uvs(mesh, plain, &laid.layout, &laid.y)];
    if exponent < 1.0 {
        laid.y = way_back(mesh, plain, &mut laid.layout, laid.y, exponent, watch)?;
        laid.layout.rescale(&mut laid.y);
        candidates.push(corner_uvs(mesh, plain, &laid.layout, &laid.y));
    }
    if let Some(objective) = options.objective {
        watch.enter(Stage::Objective)?;
        let settings = ObjectiveOptions::default();
        let best = optimize(sectors, &mut laid.layout, laid.y, objective, &settings, watch)?;
        candidates.push(corner_uvs(mesh, plain, &laid.layout, &best.y));
        clock.lap(Stage::Objective, best.iterations);
    }
    // The thinnest triangles may flip when the result is scaled and moved: look at what is given out.
    let aligned = EdgeSet::new(mesh, sectors.aligned()).vertex_pairs(mesh);
    let certify = |uvs: &Vec<_>| {
        let map = SeamlessMap::certify(mesh, uvs.clone(), &options.tolerance)?;
        Alignment::certify(mesh, &map, &aligned, &AlignmentTolerance::default())
    };
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
        rounding_rounds: rounds,
        repaired_seams: shifted_seams + mended_seams,
        mixed_integer,
        stages: clock.laps,
    };
    Ok((uvs, stats))
}

/// UVs per corner in mesh units, the lower left corner of their box at zero.
pub(super) fn corner_uvs(
    mesh: &TriMesh,
    plain: &Metric,
    layout: &ExactLayout,
    y: &[f64],
) -> Vec<[f64; 2]> {
    let z = layout.expand(y);
    let low =
        |coordinate: fn(&Complex64) -> f64| z.iter().map(coordinate).fold(f64::INFINITY, f64::min);
    let corner = Complex64::new(low(|z| z.re), low(|z| z.im));
    let uv = |h: Halfedge| (z[layout.cut.wedge[h] as usize] - corner) * plain.unit;
    mesh.halfedges().map(|h| [uv(h).re, uv(h).im]).collect()
}

/// Seconds and iterations by stage.
pub(super) struct Clock {
    start: Instant,
    pub(super) laps: Vec<StageStats>,
}

impl Clock {
    pub(super) fn new() -> Self {
        Self { start: Instant::now(), laps: Vec::new() }
    }

    pub(super) fn lap(&mut self, stage: Stage, iterations: usize) {
        let seconds = self.start.elapsed().as_secs_f64();
        self.laps.push(StageStats { stage, seconds, iterations });
        self.start = Instant::now();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seamstress_testkit as testkit;

    #[test]
    fn the_last_resort_is_the_other_way_of_rounding() {
        let soup = testkit::cube();
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
        let other = |strategy, start: &Start| {
            let mut options = MapOptions::default();
            options.rounding.strategy = strategy;
            last_resort(&mesh, start, &options).map(|last| last.rounding.strategy)
        };
        let (mixed, bias) = (RoundingStrategy::MixedInteger, RoundingStrategy::ConeBias);
        assert_eq!(other(bias, &Start::Mesh), Some(mixed));
        assert_eq!(other(mixed, &Start::Mesh), Some(bias));
        assert_eq!(other(bias, &Start::SmoothField), None);
    }
}
