//! Maps of meshes with any number of components.

use super::component::map_component;
use super::components::by_component;
use super::whole::{AlignedMap, FeatureTally};
use super::{MapError, MapOptions, MapSolution, Start};
use crate::progress::Observer;
use crate::quality::distortion;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Geometry, TriMesh};
use seamstress_parallel::both;

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
/// Positions are in any unit, with or without sizes of cells; the UVs come out in the same unit, at the global scale of least symmetric
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
pub fn make_aligned_map<'a>(
    mesh: &TriMesh,
    geometry: impl Into<Geometry<'a>>,
    features: &EdgeSet,
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    run(mesh, geometry.into(), &Start::Mesh, features, options, observer)
}

/// Makes a seamless map from what the caller has: a cross field, or cones; otherwise as [`make_map`].
///
/// The map has exactly the cones of the field, or those prescribed. Clean-up, which would change them, is
/// left out.
///
/// # Errors
/// [`MapError`]; never an uncertified map.
pub fn make_map_from<'a>(
    mesh: &TriMesh,
    geometry: impl Into<Geometry<'a>>,
    start: &Start,
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    start.check(mesh)?;
    run(mesh, geometry.into(), start, &EdgeSet::new(mesh, []), options, observer)
}

fn run(
    mesh: &TriMesh,
    geometry: Geometry<'_>,
    start: &Start,
    features: &EdgeSet,
    options: &MapOptions,
    observer: &mut Observer<'_>,
) -> Result<MapSolution, MapError> {
    let mut tally = FeatureTally::default();
    let (corner_uvs, components) =
        by_component(mesh, geometry.positions, observer, |piece, watch| {
            let mapped =
                map_component(piece, geometry, &start.restrict(piece), features, options, watch)?;
            tally.add(piece, &mapped.features, &mapped.released);
            let uvs = mapped.map.corner_uvs().to_vec();
            if piece.mesh == *mesh {
                tally.take_whole(mapped.map, mapped.alignment);
            }
            Ok((uvs, mapped.stats))
        })?;
    let (certified, distortion) = both(
        || tally.certify(mesh, corner_uvs.clone(), options.strict_features, &options.tolerance),
        || distortion(mesh, &geometry.metric(mesh), &corner_uvs),
    );
    let AlignedMap { map, features, alignment, released } = certified?;
    Ok(MapSolution { map, distortion, features, alignment, released, components })
}
