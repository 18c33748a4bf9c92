//! The certified map of a component.

use super::domain::Domain;
use super::log::StageLog;
use super::{ComponentStats, MethodError};
use crate::features::ReleasedFeature;
use crate::layout::route::Route;
use crate::map::{Alignment, SeamlessMap, Tolerance, Violations};
use crate::rounding::RoundingStats;
use seamstress_mesh::features::EdgeSet;

/// The map of a component, in its own ids.
pub(super) struct ComponentMap {
    /// UVs in mesh units.
    pub(super) map: SeamlessMap,
    /// The edges that are aligned.
    pub(super) features: EdgeSet,
    /// What is certified of them.
    pub(super) alignment: Alignment,
    /// Those that were to be, but are not.
    pub(super) released: Vec<ReleasedFeature>,
    pub(super) stats: ComponentStats,
}

impl ComponentMap {
    /// With how it was made.
    pub(super) fn new(
        domain: Domain<'_>,
        (map, alignment): (SeamlessMap, Alignment),
        rounding: RoundingStats,
        route: Route,
        log: StageLog,
    ) -> Self {
        let mesh = domain.mesh();
        let stats = ComponentStats {
            faces: mesh.n_faces(),
            genus: mesh.genus(),
            boundary_loops: mesh.n_boundary_loops(),
            route,
            lengthening: domain.lengthening,
            rounding_rounds: rounding.rounds,
            repaired_seams: rounding.shifted_seams,
            mixed_integer: rounding.mixed_integer,
            stages: log.finish(),
        };
        let features = domain.features();
        Self { map, features, alignment, released: domain.released, stats }
    }
}

/// The map of the last of some UVs that are one of a domain, aligned edges along the axes.
///
/// # Errors
/// What is wrong with the first, if all fail.
pub(super) fn last_certified(
    domain: &Domain<'_>,
    candidates: Vec<Vec<[f64; 2]>>,
    tolerance: &Tolerance,
) -> Result<(SeamlessMap, Alignment), MethodError> {
    let mesh = domain.mesh();
    let aligned = domain.features().vertex_pairs(mesh);
    let mut failure = Violations(Vec::new());
    for uvs in candidates.into_iter().rev() {
        match SeamlessMap::certify_aligned(mesh, uvs, &aligned, tolerance) {
            Ok(certified) => return Ok(certified),
            Err(violations) => failure = violations,
        }
    }
    Err(MethodError::Uncertified(failure))
}
