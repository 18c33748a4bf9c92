//! Laying a given map out anew, for another objective.

use super::components::by_component;
use super::domain::corner_uvs;
use super::whole::{AlignedMap, FeatureTally};
use super::{MapError, MethodError};
use crate::energy::SymmetricDirichlet;
use crate::features::{ReleasedFeature, Sectors};
use crate::layout::anisotropy::Anisotropy;
use crate::layout::disk::embed_disk;
use crate::layout::exact::ExactLayout;
use crate::layout::newton::NewtonOptions;
use crate::layout::objective::{
    ConicStats, Ending, Objective, ObjectiveOptions, OptimizeError, Optimized, optimize,
};
use crate::map::{Alignment, SeamlessMap, Tolerance, followed};
use crate::progress::{Observer, Stage, Watch};
use crate::quality::{Distortion, distortion};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Metric, TriMesh};

/// Settings of [`relayout`] and [`lay_out_disk`].
#[derive(Debug, Clone)]
pub struct RelayoutOptions {
    /// What to minimise.
    pub objective: Objective,
    /// How.
    pub settings: ObjectiveOptions,
    /// Stretches that count as no distortion; none by default.
    pub anisotropy: Option<Anisotropy>,
    /// Edges that run along the axes of the map and have to stay there; none by default. Those that do not
    /// run there are released.
    pub features: Option<EdgeSet>,
    /// Whether a released feature is an error ([`MapError::Released`]) rather than a line in the result.
    pub strict_features: bool,
    /// Tolerance of the certificate, for the map given and the one returned.
    pub tolerance: Tolerance,
}

impl RelayoutOptions {
    /// Default settings for an objective.
    pub fn new(objective: Objective) -> Self {
        Self {
            objective,
            settings: ObjectiveOptions::default(),
            anisotropy: None,
            features: None,
            strict_features: false,
            tolerance: Tolerance::default(),
        }
    }
}

/// A certified map laid out for an objective.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Relayout {
    /// The map; UVs in mesh units, at the global scale of the objective's measure.
    pub map: SeamlessMap,
    /// Its distortion.
    pub distortion: Distortion,
    /// The edges that run along the axes: the features asked for, except those released.
    pub features: EdgeSet,
    /// The certificate of their alignment.
    pub alignment: Alignment,
    /// Features that did not run along an axis of the map given.
    pub released: Vec<ReleasedFeature>,
    /// One entry per connected component, in order of first faces.
    pub components: Vec<RelayoutStats>,
}

/// How one component was laid out.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RelayoutStats {
    /// Faces.
    pub faces: usize,
    /// The objective's figure of the map given (or, for a disk without one, of its first layout).
    pub before: f64,
    /// The same figure now.
    pub after: f64,
    /// Iterations of the objective's outer loop.
    pub iterations: usize,
    /// How they ended.
    pub ending: Ending,
    /// How the conic programs were solved, if there were any.
    pub conic: Option<ConicStats>,
    /// The largest dilatation, where it was bounded; the figures are then of the symmetric Dirichlet energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dilatation: Option<f64>,
}

/// Lays a seamless map out anew for an objective, with its matchings and cones. Its seams may come to lie
/// elsewhere; features keep their axes, and their corners their angles.
///
/// # Errors
/// [`MapError`]; never an uncertified map.
pub fn relayout(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    map: &SeamlessMap,
    options: &RelayoutOptions,
    observer: &mut Observer<'_>,
) -> Result<Relayout, MapError> {
    run(mesh, positions, options, observer, |piece, _, watch| {
        watch.enter(Stage::Cut)?;
        let uvs = piece.corner_uvs(map.corner_uvs());
        SeamlessMap::certify(&piece.mesh, uvs, &options.tolerance).map_err(MethodError::Uncertified)
    })
}

/// Lays out disks with a free boundary, without seams or cones. Features can hardly be had this way: they
/// need a map that follows them.
///
/// # Errors
/// [`MapError`], also when a component is not a disk; never an uncertified map.
pub fn lay_out_disk(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    options: &RelayoutOptions,
    observer: &mut Observer<'_>,
) -> Result<Relayout, MapError> {
    run(mesh, positions, options, observer, |piece, metric, watch| {
        watch.enter(Stage::Cut)?;
        let uvs = embed_disk(&piece.mesh, metric)?;
        let embedded = SeamlessMap::certify(&piece.mesh, uvs, &options.tolerance)
            .map_err(MethodError::Uncertified)?;
        let (mut layout, y) = ExactLayout::from_map(&piece.mesh, metric, &embedded)?;
        if !layout.defects(&Sectors::unaligned(&piece.mesh), &y).none() {
            return Ok(embedded);
        }
        let mut y = y;
        layout.rescale(&mut y);
        let y = layout.minimize(y, &SymmetricDirichlet, &SETTLE_DISK, watch)?.y;
        let relaxed = corner_uvs(&piece.mesh, metric, &layout, &y);
        Ok(SeamlessMap::certify(&piece.mesh, relaxed, &options.tolerance).unwrap_or(embedded))
    })
}

/// From the circle to a layout that all objectives can start from.
const SETTLE_DISK: NewtonOptions = NewtonOptions { max_iterations: 100, tolerance: 1e-6 };

/// Runs the objective on every component from the map that `start` gives.
fn run(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    options: &RelayoutOptions,
    observer: &mut Observer<'_>,
    start: impl Fn(&Component, &Metric, &mut Watch<'_, '_>) -> Result<SeamlessMap, MethodError>,
) -> Result<Relayout, MapError> {
    let none = EdgeSet::new(mesh, []);
    let asked = options.features.as_ref().unwrap_or(&none);
    let mut outcome = FeatureTally::default();
    let (corner_uvs, components) = by_component(mesh, positions, observer, |piece, watch| {
        let here = piece.positions(positions);
        let metric = Metric::from_positions(&piece.mesh, &here);
        let map = start(piece, &metric, watch)?;
        let (kept, released) =
            followed(&piece.mesh, &map, &asked.restrict(piece), &Tolerance::default())
                .map_err(MethodError::Uncertified)?;
        outcome.add(piece, &kept, &released);
        improve(piece, &metric, &map, &kept, options, watch)
    })?;
    let AlignedMap { map, features, alignment, released } =
        outcome.certify(mesh, corner_uvs, options.strict_features, &options.tolerance)?;
    let metric = Metric::from_positions(mesh, positions);
    let distortion = distortion(mesh, &metric, map.corner_uvs());
    Ok(Relayout { map, distortion, features, alignment, released, components })
}

/// Minimises the objective from a map; gives the map back if nothing certified comes out of it.
fn improve(
    piece: &Component,
    metric: &Metric,
    map: &SeamlessMap,
    features: &EdgeSet,
    options: &RelayoutOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<(Vec<[f64; 2]>, RelayoutStats), MethodError> {
    let mesh = &piece.mesh;
    let sectors = Sectors::new(mesh, metric, features);
    let (mut layout, y) = ExactLayout::from_aligned_map(&sectors, metric, map)?;
    if let Some(anisotropy) = &options.anisotropy {
        layout.problem_mut().stretch(&anisotropy.of_faces(&piece.faces));
    }
    watch.enter(Stage::Objective)?;
    let defects = layout.defects(&sectors, &y);
    if !defects.none() {
        // The map holds in floating point, but not the layout that closes its seams exactly.
        return Err(MethodError::Defective(defects));
    }
    let Optimized { y, value, before, iterations, ending, conic, dilatation } =
        optimize(&sectors, &mut layout, y, options.objective, &options.settings, watch)?;
    let faces = mesh.n_faces();
    let stats = |after, ending| RelayoutStats {
        faces,
        before,
        after,
        iterations,
        ending,
        conic,
        dilatation,
    };
    let uvs = corner_uvs(mesh, metric, &layout, &y);
    let pairs = features.vertex_pairs(mesh);
    match SeamlessMap::certify_aligned(mesh, uvs, &pairs, &options.tolerance) {
        Ok((better, _)) => Ok((better.into_corner_uvs(), stats(value, ending))),
        // The map given may not keep the bound.
        Err(violations) if options.settings.dilatation_bound.is_some() => {
            Err(MethodError::Uncertified(violations))
        }
        Err(_) => Ok((map.corner_uvs().to_vec(), stats(before, Ending::NoGain))),
    }
}

impl MapError {
    /// Whether no layout that keeps the bound on the dilatation was found.
    pub fn is_infeasible(&self) -> bool {
        self.is_of_a_component(|cause| {
            matches!(cause, MethodError::Objective(OptimizeError::Infeasible { .. }))
        })
    }
}
