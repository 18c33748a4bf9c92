//! What is tried for a component until it is mapped.

use super::certify::ComponentMap;
use super::domain::Domain;
use super::{MapOptions, MethodError, Start, parametrize};
use crate::progress::{Watch, unless_cancelled};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Component, Geometry};

/// Maps one component along its features and a guide; where that fails, or features are lost, without the guide, then with
/// nothing aligned, and then in a metric without thin triangles.
///
/// # Errors
/// [`MethodError`] of the last trial.
pub(super) fn map_component(
    piece: &Component,
    geometry: Geometry<'_>,
    start: &Start,
    features: &EdgeSet,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<ComponentMap, MethodError> {
    let mesh = &piece.mesh;
    let geometry = geometry.of_piece(piece);
    let geometry = geometry.whole();
    let metric = geometry.metric(mesh);
    let features = features.restrict(piece);
    let mut domain = Domain::new(mesh, geometry, &metric, features, options);
    loop {
        match unless_cancelled(parametrize(domain.clone(), start, options, watch))? {
            // Features come before directions.
            Ok(map) if domain.guide.is_some() && map.released.len() > domain.released.len() => {
                domain.guide = None;
            }
            Ok(map) => return Ok(map),
            Err(error) => domain = domain.simpler().ok_or(error)?,
        }
    }
}
