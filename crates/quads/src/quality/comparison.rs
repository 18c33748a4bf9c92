//! How a polygon mesh lies to the surface it stands for.

use super::{BadSurface, DistanceError, Orientation, SurfaceDistance, surface_distance};
use crate::split::split_polygons;
use crate::vector::Point;
use seamstress_mesh::soup::Fault;

/// How polygons lie to the surface they stand for.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// Distances both ways.
    pub distance: SurfaceDistance,
    /// Which way the polygons face.
    pub orientation: Orientation,
}

/// Why a mesh and its source were not compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ComparisonError {
    /// The polygons of the mesh cannot be split into triangles.
    #[error("{}", list(.0))]
    BadMesh(Vec<Fault>),
    /// Those of the source cannot.
    #[error("{}", list(.0))]
    BadSource(Vec<Fault>),
    /// There is no distance.
    #[error(transparent)]
    NoDistance(#[from] DistanceError),
    /// The source has no normals.
    #[error(transparent)]
    NoNormals(#[from] BadSurface),
}

fn list(faults: &[Fault]) -> String {
    faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("; ")
}

/// Compares polygons with those of their source, both split along short diagonals; which corner a polygon is
/// listed from does not matter. About `samples` points are sampled each way.
///
/// # Errors
/// [`ComparisonError`].
pub fn compare<'a, 'b>(
    (positions, polygons): (&[Point], impl Iterator<Item = &'a [u32]> + Clone),
    (source_positions, source): (&[Point], impl Iterator<Item = &'b [u32]>),
    samples: usize,
) -> Result<Comparison, ComparisonError> {
    let faces = split_polygons(positions, polygons.clone()).map_err(ComparisonError::BadMesh)?;
    let reference = split_polygons(source_positions, source).map_err(ComparisonError::BadSource)?;
    let reference = (source_positions, reference.as_slice());
    Ok(Comparison {
        distance: surface_distance((positions, &faces), reference, samples)?,
        orientation: Orientation::new(positions, polygons, reference)?,
    })
}
