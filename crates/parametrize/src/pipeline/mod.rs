//! The direct method from mesh to certified map.

mod baseline;
mod component;
mod fewer_cones;
mod finish;
mod mended;
mod parts;
mod relayout;
mod start;

pub use baseline::{FieldMap, FieldMapOptions, UncertifiedMap, make_field_map};
pub use relayout::{Relayout, RelayoutOptions, RelayoutStats, lay_out_disk, relayout};
pub use start::Start;

use crate::consistency::ConsistencyError;
use crate::features::{LARGEST_INDEX, ReleasedFeature};
use crate::field::{FieldError, PrescriptionError};
use crate::layout::exact::Defects;
use crate::layout::objective::Objective;
use crate::layout::polish::PolishOptions;
use crate::layout::safeguards::{LayoutError, Route};
use crate::map::{Alignment, SeamlessMap, Tolerance, Violations};
use crate::mixed_integer::MixedIntegerStats;
use crate::progress::{Cancelled, Observer, Stage, Watch};
use crate::quality::{Distortion, distortion};
use crate::rounding::RoundingOptions;
use component::map_component;
use parts::{Outcome, Whole};
pub use parts::{followed, in_component};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Face, Metric, TriMesh, Vertex, components};

/// Settings of the direct method.
#[derive(Debug, Clone, Copy)]
pub struct MapOptions {
    /// The rounding loop.
    pub rounding: RoundingOptions,
    /// Mean symmetric Dirichlet energy that may be paid for one cone fewer, in clean-up; 0 leaves the
    /// cones as they were rounded. None: 0.0006; with a `cell` the share of the surface that four cells
    /// have, but at least 0.0015.
    pub cone_price: Option<f64>,
    /// Edge length, in the unit of the positions, of the quads that will be made from the map. None if the
    /// map is an end in itself: then clean-up is undone where it raises tau by more than 5 % or the energy's
    /// excess over 4 by more than 20 %, whatever the price. For quads it is the number of quarters of
    /// cones that counts, spikes much smaller than the cells may go, and no cone has an index of 3, unless it is
    /// prescribed: the best there is for a sharp spike, it would become a vertex of a single quad.
    pub cell: Option<f64>,
    /// Whether a feature edge that cannot be aligned is an error ([`MapError::Released`]) rather than a
    /// line in the result.
    pub strict_features: bool,
    /// The finish that lowers tau. None: growing powers of the energy alone, as clean-up is judged by.
    pub polish: Option<PolishOptions>,
    /// What to minimise in the end, instead of the compromise of mean and worst distortion that is made
    /// without it.
    pub objective: Option<Objective>,
    /// Tolerance of the certificate.
    pub tolerance: Tolerance,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self {
            rounding: RoundingOptions::default(),
            cone_price: None,
            cell: None,
            strict_features: false,
            polish: Some(PolishOptions::default()),
            objective: None,
            tolerance: Tolerance::default(),
        }
    }
}

impl MapOptions {
    /// Largest index of a cone that is not prescribed, quarters.
    fn largest_index(&self) -> i32 {
        match self.cell {
            Some(_) => LARGEST_INDEX - 1,
            None => LARGEST_INDEX,
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
    /// The edges that run along the axes: every feature edge asked for that was not released.
    pub features: EdgeSet,
    /// The certificate of their alignment.
    pub alignment: Alignment,
    /// Feature edges that could not be aligned, component by component.
    pub released: Vec<ReleasedFeature>,
    /// One entry per connected component, in order of first faces.
    pub components: Vec<ComponentStats>,
}

/// How the map of one component was made.
#[derive(Debug, Clone, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
    /// Exponent of the metric the map was first made in: 1 unless the mesh is degenerate.
    pub metric_exponent: f64,
    /// Rounds of the rounding loop.
    pub rounding_rounds: usize,
    /// Seams shifted to make indices possible or matchings consistent.
    pub repaired_seams: usize,
    /// How mixed-integer rounding went, where it was asked for or was the last resort.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixed_integer: Option<MixedIntegerStats>,
    /// Seconds and iterations by stage.
    pub stages: Vec<StageStats>,
}

/// Cost of one stage.
#[derive(Debug, Clone, Copy, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
    /// The number of positions is not that of the vertices.
    #[error("{found} positions for {expected} vertices")]
    PositionCount {
        /// Vertices of the mesh.
        expected: usize,
        /// Positions given.
        found: usize,
    },
    /// A position is not finite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NonFinitePosition {
        /// The vertex.
        vertex: u32,
    },
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
    /// The field to start from is none of this mesh.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// The cones asked for, or those of the field to start from, cannot be had.
    #[error(transparent)]
    Cones(#[from] PrescriptionError),
    /// Feature edges could not be aligned, and [`MapOptions::strict_features`] asked for all of them.
    #[error("{} feature edges could not be aligned{}", released.len(), listed(released))]
    Released {
        /// The edges.
        released: Vec<ReleasedFeature>,
    },
    /// The result did not pass the certificate. Nothing is returned then.
    #[error("the map failed its certificate: {0}")]
    Uncertified(#[from] Violations),
}

impl MapError {
    /// Whether a component that had to be a disk is none.
    pub fn is_not_a_disk(&self) -> bool {
        matches!(self, Self::Component { cause: LayoutError::NotADisk, .. })
    }
}

/// The first few released features of a list.
fn listed(released: &[ReleasedFeature]) -> String {
    const SHOWN: usize = 5;
    let name = |r: &ReleasedFeature| format!("{}-{} ({})", r.vertices[0], r.vertices[1], r.reason);
    let shown: Vec<String> = released.iter().take(SHOWN).map(name).collect();
    let more = if released.len() > SHOWN { ", ..." } else { "" };
    format!(": {}{more}", shown.join(", "))
}

/// Makes a seamless map of every component of a mesh, with nothing aligned; see [`make_aligned_map`].
///
/// # Errors
/// [`MapError`]; never an uncertified map.
pub fn make_map(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    make_aligned_map(mesh, positions, &EdgeSet::new(mesh, []), options, observer)
}

/// Makes a seamless map of every component of a mesh in which feature edges run along the axes.
///
/// Positions are in any unit; the UVs come out in the same unit, at the global scale of least symmetric
/// Dirichlet energy, components side by side. The observer is called in every iteration of
/// every long loop and may break to cancel.
///
/// Feature edges that contradict each other, or for which no layout is found, are released; the solution
/// names each with the reason.
///
/// # Errors
/// [`MapError`]; never an uncertified map.
///
/// # Source
/// Levi 2021, supplement; the steps are those of `docs/theory`.
pub fn make_aligned_map(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    features: &EdgeSet,
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    run(mesh, positions, &Start::Mesh, features, options, observer)
}

/// Makes a seamless map from what the caller has: a cross field, or cones; otherwise as [`make_map`].
///
/// The map has exactly the cones of the field, or those prescribed. Clean-up, which would change them, is
/// left out.
///
/// # Errors
/// [`MapError`]; never an uncertified map.
pub fn make_map_from(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    start: &Start,
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    start.check(mesh)?;
    run(mesh, positions, start, &EdgeSet::new(mesh, []), options, observer)
}

fn run(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    start: &Start,
    features: &EdgeSet,
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    let mut outcome = Outcome::default();
    let (corner_uvs, components) = by_component(mesh, positions, observer, |piece, watch| {
        let mapped =
            map_component(piece, positions, &start.restrict(piece), features, options, watch)?;
        outcome.add(piece, &mapped.features, &mapped.released);
        Ok((mapped.uvs, mapped.stats))
    })?;
    let Whole { map, features, alignment, released } =
        outcome.certify(mesh, corner_uvs, options.strict_features, &options.tolerance)?;
    let metric = Metric::from_positions(mesh, positions);
    let distortion = distortion(mesh, &metric, map.corner_uvs());
    Ok(MapSolution { map, distortion, features, alignment, released, components })
}

type Piecewise<S> = Result<(Vec<[f64; 2]>, S), LayoutError>;

/// Lays out each component for itself and puts the UVs side by side.
fn by_component<S>(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    observer: &mut Observer<'_>,
    mut lay_out: impl FnMut(&Component, &mut Watch<'_, '_>) -> Piecewise<S>,
) -> Result<(Vec<[f64; 2]>, Vec<S>), MapError> {
    check_positions(mesh, positions)?;
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
                cause: in_whole(piece, cause),
            },
        };
        let (uvs, piece_stats) = lay_out(piece, &mut watch).map_err(fail)?;
        left_edge = place(piece, &uvs, left_edge, &mut corner_uvs);
        stats.push(piece_stats);
    }
    Watch::new(observer, pieces.len().saturating_sub(1), pieces.len()).enter(Stage::Certificate)?;
    Ok((corner_uvs, stats))
}

fn check_positions(mesh: &TriMesh, positions: &[[f64; 3]]) -> Result<(), MapError> {
    let (expected, found) = (mesh.n_vertices(), positions.len());
    if expected != found {
        return Err(MapError::PositionCount { expected, found });
    }
    // Vertices without a face may lie anywhere.
    let strange = |v: &Vertex| {
        mesh.outgoing(*v).next().is_some() && !positions[v.at()].iter().all(|x| x.is_finite())
    };
    match mesh.vertices().find(strange) {
        Some(Vertex(vertex)) => Err(MapError::NonFinitePosition { vertex }),
        None => Ok(()),
    }
}

/// A failure of a component with the elements it names in the ids of the whole mesh.
fn in_whole(piece: &Component, cause: LayoutError) -> LayoutError {
    let whole = |v: u32| piece.vertices[Vertex(v)].0;
    match cause {
        LayoutError::Defective(Defects { flips, wrong_angles }) => {
            LayoutError::Defective(Defects {
                flips: flips.iter().map(|f| piece.faces[f.at()]).collect(),
                wrong_angles: wrong_angles.iter().map(|&v| piece.vertices[v]).collect(),
            })
        }
        LayoutError::Uncertified(violations) => {
            LayoutError::Uncertified(violations.in_whole(piece))
        }
        LayoutError::Cones(PrescriptionError::NoTaker { vertex }) => {
            LayoutError::Cones(PrescriptionError::NoTaker { vertex: whole(vertex) })
        }
        LayoutError::Inconsistent(ConsistencyError::Infeasible { vertices }) => {
            let vertices = vertices.into_iter().map(whole).collect();
            LayoutError::Inconsistent(ConsistencyError::Infeasible { vertices })
        }
        cause => cause,
    }
}

/// Moves a component's UVs to the right of what stands there; returns the new right edge.
fn place(piece: &Component, uvs: &[[f64; 2]], left_edge: f64, all: &mut [[f64; 2]]) -> f64 {
    let mut right_edge = left_edge;
    for (i, &Face(f)) in piece.faces.iter().enumerate() {
        for k in 0..3 {
            let [u, v] = uvs[3 * i + k];
            all[3 * f as usize + k] = [u + left_edge, v];
            right_edge = right_edge.max(u + left_edge);
        }
    }
    left_edge + (right_edge - left_edge) * 1.02
}
