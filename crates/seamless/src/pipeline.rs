//! The direct method from mesh to certified map.

use crate::cut::DualTree;
use crate::layout::energy::{PowerOfDirichlet, SymmetricDirichlet};
use crate::layout::homotopy::HomotopyError;
use crate::layout::newton::NewtonOptions;
use crate::layout::safeguards::{Laid, LayoutError, Route, lay_out};
use crate::map::{SeamlessMap, Tolerance, Violations};
use crate::progress::{Cancelled, Observer, Stage, Watch};
use crate::quality::{Distortion, distortion};
use crate::quarter::turn;
use crate::rounding::{
    CleanUpError, CleanUpOptions, MatchedCut, RoundingOptions, RoundingStats, clean_up,
    fix_holonomy, repair, round,
};
use seamstress_surface::{Component, Face, Halfedge, Metric, TriMesh, Vertex, components};
use std::time::Instant;

/// Settings of the direct method.
#[derive(Debug, Clone, Copy)]
pub struct MapOptions {
    /// The rounding loop.
    pub rounding: RoundingOptions,
    /// Mean symmetric Dirichlet energy that may be paid for one cone fewer, in clean-up; 0 leaves the
    /// cones as rounded.
    pub cone_price: f64,
    /// Tolerance of the certificate.
    pub tolerance: Tolerance,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self {
            rounding: RoundingOptions::default(),
            cone_price: 0.0006,
            tolerance: Tolerance::default(),
        }
    }
}

/// A certified map and how it was made.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct MapSolution {
    /// The map; UVs in mesh units.
    pub map: SeamlessMap,
    /// Its distortion.
    pub distortion: Distortion,
    /// One entry per connected component, in order of first faces.
    pub components: Vec<ComponentStats>,
}

/// How the map of one component was made.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct ComponentStats {
    /// Faces.
    pub faces: usize,
    /// Genus.
    pub genus: i64,
    /// Boundary loops.
    pub boundary_loops: usize,
    /// Route of the final layout.
    pub route: Route,
    /// Rounds of the rounding loop.
    pub rounding_rounds: usize,
    /// Seams shifted to make indices possible.
    pub repaired_seams: usize,
    /// Seconds and iterations by stage.
    pub stages: Vec<StageStats>,
}

/// Cost of one stage.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct StageStats {
    /// The stage.
    pub stage: Stage,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Layouts or Newton iterations.
    pub iterations: usize,
}

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A component could not be laid out.
    #[error("component {component} (with face {face}): {cause}")]
    Component {
        /// The component, in order of first faces.
        component: usize,
        /// Its first face.
        face: u32,
        /// What failed.
        #[source]
        cause: LayoutError,
    },
    /// The result did not pass the certificate. Nothing is returned then.
    #[error("the map failed its certificate: {0}")]
    Uncertified(#[from] Violations),
}

/// Makes a seamless map of every component of a mesh.
///
/// Positions are in any unit; the UVs come out in the same unit, at the global scale of least symmetric
/// Dirichlet energy, components side by side. The observer is called at least once per iteration of
/// every loop and may break to cancel.
///
/// # Errors
/// [`MapError`]; never an uncertified map.
///
/// # Source
/// Levi 2021, supplement; the steps are those of `docs/theory`.
pub fn make_map(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    let pieces = components::components(mesh).unwrap_or_default();
    let mut corner_uvs = vec![[0.0; 2]; mesh.n_halfedges()];
    let mut stats = Vec::with_capacity(pieces.len());
    let mut left_edge = 0.0;
    for (k, piece) in pieces.iter().enumerate() {
        let mut watch = Watch::new(observer, k, pieces.len());
        let fail = |cause| match cause {
            LayoutError::Cancelled(cancelled) => MapError::Cancelled(cancelled),
            cause => MapError::Component {
                component: k,
                face: piece.faces[0].0,
                cause,
            },
        };
        let (uvs, piece_stats) =
            map_component(piece, positions, options, &mut watch).map_err(fail)?;
        left_edge = place(piece, &uvs, left_edge, &mut corner_uvs);
        stats.push(piece_stats);
    }
    Watch::new(observer, pieces.len().saturating_sub(1), pieces.len()).enter(Stage::Certificate)?;
    let metric = Metric::from_positions(mesh, positions);
    let distortion = distortion(mesh, &metric, &corner_uvs);
    let map = SeamlessMap::certify(mesh, corner_uvs, &options.tolerance)?;
    Ok(MapSolution {
        map,
        distortion,
        components: stats,
    })
}

/// Cut, round, lay out, clean up, polish: the direct method on one component.
fn map_component(
    piece: &Component,
    positions: &[[f64; 3]],
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<[f64; 2]>, ComponentStats), LayoutError> {
    let mesh = &piece.mesh;
    let positions: Vec<_> = piece.vertices.iter().map(|v| positions[v.at()]).collect();
    let mut clock = Clock::new();

    watch.enter(Stage::Cut)?;
    let metric = Metric::from_positions(mesh, &positions);
    let mut matched = MatchedCut::new(mesh, &metric, curvature_tree(mesh, &metric));
    clock.lap(Stage::Cut, 0);

    watch.enter(Stage::Rounding)?;
    let (frames, rounding) = round(mesh, &metric, &mut matched, &options.rounding, watch)
        .map_err(|e: HomotopyError| LayoutError::from(e))?;
    let (repaired_seams, _) = repair(mesh, &metric, &mut matched);
    clock.lap(Stage::Rounding, rounding.layouts);

    watch.enter(Stage::Layout)?;
    let laid = lay_out(mesh, &metric, &matched, Some(&frames), watch)?;
    let mut finished = Finished::new(laid, watch)?;
    clock.lap(Stage::Layout, finished.iterations);

    if options.cone_price > 0.0 {
        watch.enter(Stage::CleanUp)?;
        let (better, iterations) =
            fewer_cones(mesh, &metric, &matched, finished, options.cone_price, watch)?;
        finished = better;
        clock.lap(Stage::CleanUp, iterations);
    }

    let uvs = corner_uvs(mesh, &metric, &mut finished.laid);
    let stats = component_stats(mesh, &finished.laid, &rounding, repaired_seams, clock.laps);
    Ok((uvs, stats))
}

/// A layout of least symmetric Dirichlet energy with its worst triangles polished.
struct Finished {
    laid: Laid,
    symmetric_dirichlet: f64,
    tau: f64,
    iterations: usize,
}

impl Finished {
    fn new(mut laid: Laid, watch: &mut Watch<'_, '_>) -> Result<Self, Cancelled> {
        let options = NewtonOptions {
            max_iterations: 40,
            tolerance: 1e-6,
        };
        let solution = laid.layout.minimize(laid.y, &SymmetricDirichlet, &options);
        laid.y = solution.y;
        let polishing = polish(&mut laid, watch)?;
        let (symmetric_dirichlet, tau) = laid.layout.distortion(&laid.y);
        let iterations = laid.homotopy_steps + solution.iterations + polishing;
        Ok(Self {
            laid,
            symmetric_dirichlet,
            tau,
            iterations,
        })
    }
}

/// Bounds on the log scale that clean-up tries, loosest first.
const SCALE_BOUNDS: [f64; 2] = [f64::INFINITY, 0.35];
/// Clean-up may raise tau by this factor, and the excess of the symmetric Dirichlet energy over 4.
const TAU_GROWTH: f64 = 1.05;
const EXCESS_GROWTH: f64 = 1.2;

/// Cleans the cones up and lays out again; keeps the result only if it is worth its price.
fn fewer_cones(
    mesh: &TriMesh,
    metric: &Metric,
    matched: &MatchedCut,
    before: Finished,
    price: f64,
    watch: &mut Watch<'_, '_>,
) -> Result<(Finished, usize), LayoutError> {
    let mut iterations = 0;
    for largest_scale in SCALE_BOUNDS {
        let mut cleaned = matched.clone();
        let options = CleanUpOptions {
            price,
            largest_scale,
        };
        let (stats, gauge) = match clean_up(mesh, metric, &mut cleaned, &options, watch) {
            Ok(done) => done,
            Err(CleanUpError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(CleanUpError::Numeric(_)) => break,
        };
        if stats.cancelled + stats.moved == 0 {
            break;
        }
        fix_holonomy(mesh, metric, &mut cleaned)?;
        let frames = before.laid.layout.frames(&before.laid.y);
        let frames: Vec<_> = frames
            .into_iter()
            .zip(gauge.iter())
            .map(|(r, &k)| turn(r, k))
            .collect();
        let after = match lay_out(mesh, metric, &cleaned, Some(&frames), watch) {
            Ok(laid) => Finished::new(laid, watch)?,
            Err(LayoutError::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(_) => continue,
        };
        iterations += after.iterations;
        let saved = stats.cones_before as f64 - stats.cones_after as f64;
        let excess = |f: &Finished| f.symmetric_dirichlet - 4.0;
        if excess(&after) < excess(&before) + price * saved
            && excess(&after) <= EXCESS_GROWTH * excess(&before)
            && after.tau <= TAU_GROWTH * before.tau
        {
            return Ok((after, iterations));
        }
    }
    Ok((before, iterations))
}

/// The dual tree that crosses flat edges first, so that seams run through curved vertices.
fn curvature_tree(mesh: &TriMesh, metric: &Metric) -> DualTree {
    let curvature = metric.curvature(mesh);
    let bend = |v: Vertex| {
        if mesh.is_boundary(v) {
            0.0
        } else {
            curvature[v].abs()
        }
    };
    DualTree::lightest(mesh, |h: Halfedge| {
        bend(mesh.origin(h)).min(bend(mesh.tip(h)))
    })
}

/// Lowers the worst triangles: Newton on a growing power of the symmetric Dirichlet energy.
fn polish(laid: &mut Laid, watch: &mut Watch<'_, '_>) -> Result<usize, Cancelled> {
    const POWERS: [i32; 5] = [2, 4, 8, 16, 32];
    let mut iterations = 0;
    for (k, p) in POWERS.into_iter().enumerate() {
        watch.tick(k as f64 / POWERS.len() as f64)?;
        let z = laid.layout.expand(&laid.y);
        let worst = laid.layout.problem().triangles().iter().map(|t| {
            use crate::layout::energy::Energy;
            let (s1, s2) = t.jacobian(&z).singular_values();
            SymmetricDirichlet.value(s1, s2)
        });
        let energy = PowerOfDirichlet {
            p,
            bound: worst.fold(4.0, f64::max),
        };
        let options = NewtonOptions {
            max_iterations: 10,
            tolerance: 1e-3,
        };
        let solution = laid
            .layout
            .minimize(std::mem::take(&mut laid.y), &energy, &options);
        laid.y = solution.y;
        iterations += solution.iterations;
    }
    Ok(iterations)
}

/// UVs per corner in mesh units at the best global scale.
fn corner_uvs(mesh: &TriMesh, metric: &Metric, laid: &mut Laid) -> Vec<[f64; 2]> {
    laid.layout.rescale(&mut laid.y);
    let z = laid.layout.expand(&laid.y);
    mesh.halfedges()
        .map(|h| {
            let z = z[laid.layout.cut.wedge[h] as usize] * metric.unit;
            [z.re, z.im]
        })
        .collect()
}

fn component_stats(
    mesh: &TriMesh,
    laid: &Laid,
    rounding: &RoundingStats,
    repaired_seams: usize,
    stages: Vec<StageStats>,
) -> ComponentStats {
    ComponentStats {
        faces: mesh.n_faces(),
        genus: mesh.genus(),
        boundary_loops: mesh.n_boundary_loops(),
        route: laid.route,
        rounding_rounds: rounding.rounds,
        repaired_seams,
        stages,
    }
}

/// Moves a component's UVs to the right of what stands there; returns the new right edge.
fn place(piece: &Component, uvs: &[[f64; 2]], left_edge: f64, all: &mut [[f64; 2]]) -> f64 {
    let range = |k: usize| {
        let low = uvs.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = uvs.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        (low, high)
    };
    let ((u0, u1), (v0, _)) = (range(0), range(1));
    for (i, &Face(f)) in piece.faces.iter().enumerate() {
        for k in 0..3 {
            let [u, v] = uvs[3 * i + k];
            all[3 * f as usize + k] = [u - u0 + left_edge, v - v0];
        }
    }
    left_edge + (u1 - u0) * 1.02
}

struct Clock {
    start: Instant,
    laps: Vec<StageStats>,
}

impl Clock {
    fn new() -> Self {
        Self {
            start: Instant::now(),
            laps: Vec::new(),
        }
    }

    fn lap(&mut self, stage: Stage, iterations: usize) {
        let seconds = self.start.elapsed().as_secs_f64();
        self.laps.push(StageStats {
            stage,
            seconds,
            iterations,
        });
        self.start = Instant::now();
    }
}
