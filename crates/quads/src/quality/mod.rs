//! Quality of quad meshes: shape, irregular vertices, distance to a source (Levi 2021, suppl. sec. 2).

mod comparison;
mod distance;
mod orientation;
mod shape;
mod topology;

pub use crate::split::split_polygons;
pub use comparison::{Comparison, ComparisonError, compare};
pub use distance::{Distance, DistanceError, SurfaceDistance, surface_distance};
pub use orientation::{BadSurface, Orientation};
pub use shape::{Angles, EdgeLengths, angle_deviations, edge_lengths};
pub use topology::Topology;

use crate::QuadMesh;
use crate::layout::{LayoutError, lay_out_squares};
use seamstress_mesh::Metric;
use seamstress_parametrize::quality::{Distortion, SingularValues, Summary, measure_all};

/// Metrics of a polygon mesh, quads above all. They do not depend on the corner a polygon is listed from.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct QuadQuality {
    /// Counts, and what is irregular.
    pub topology: Topology,
    /// Angles at the corners of the polygons.
    pub angles: Angles,
    /// Lengths of the edges.
    pub edge_lengths: EdgeLengths,
    /// Distortion of the map from the mesh to its layout of unit squares (section 7), in all that is
    /// invariant to scale; `None` if there is no such layout.
    pub distortion: Option<Distortion>,
    /// The same in every measure, with a value for each of the two triangles `2 q` and `2 q + 1` of quad `q`;
    /// empty if there is no such layout.
    pub measures: Vec<Summary>,
    /// Why there is no layout.
    pub no_layout: Option<String>,
}

/// Measures polygons in space.
///
/// Angles, lengths and valences are taken on any polygons; the distortion needs quads only, in an
/// oriented manifold. Corners must be below the number of positions.
pub fn measure<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]> + Clone,
) -> QuadQuality {
    let (singular, no_layout) = match layout_distortion(positions, polygons.clone()) {
        Ok(singular) => (Some(singular), None),
        Err(reason) => (None, Some(reason)),
    };
    QuadQuality {
        topology: Topology::new(positions.len(), polygons.clone()),
        angles: Angles::new(positions, polygons.clone()),
        edge_lengths: EdgeLengths::new(positions, polygons),
        distortion: singular.as_ref().map(Distortion::new),
        measures: singular.as_ref().map(measure_all).unwrap_or_default(),
        no_layout,
    }
}

fn layout_distortion<'a>(
    positions: &[[f64; 3]],
    polygons: impl Iterator<Item = &'a [u32]>,
) -> Result<SingularValues, String> {
    let quads: Result<Vec<[u32; 4]>, _> = polygons
        .enumerate()
        .map(|(i, polygon)| {
            let corners = polygon.len();
            <[u32; 4]>::try_from(polygon).map_err(|_| format!("polygon {i} has {corners} corners"))
        })
        .collect();
    let quads = QuadMesh::new(positions.to_vec(), quads?).map_err(|error| error.to_string())?;
    let layout = lay_out_squares(&quads).map_err(|error: LayoutError| error.to_string())?;
    let metric = Metric::from_positions(&layout.mesh, positions);
    Ok(SingularValues::new(&layout.mesh, &metric, &layout.corner_uvs))
}
