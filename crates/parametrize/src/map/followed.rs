//! Features that a map follows.

use super::certificate::SeamlessMap;
use crate::features::{ReleaseReason, ReleasedFeature, released};
use seamstress_certify::{Tolerance, Violation, Violations};
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Halfedge, TriMesh, Vertex};

/// The features that run along the axes of a map on either side, and the others: dropped, since the map does not
/// follow them.
///
/// # Errors
/// Sectors of the former whose angle is no positive number of quarter turns.
pub fn followed(
    mesh: &TriMesh,
    map: &SeamlessMap,
    features: &EdgeSet,
    tolerance: &Tolerance,
) -> Result<(EdgeSet, Vec<ReleasedFeature>), Violations> {
    let pairs = features.vertex_pairs(mesh);
    let found = map.alignment(mesh, &pairs, tolerance).err().map_or(Vec::new(), |found| found.0);
    let off_axis = |violation: &Violation| match *violation {
        Violation::OffAxis { vertices: [a, b], .. } => mesh.edge_between(Vertex(a), Vertex(b)),
        _ => None,
    };
    let off: Vec<Halfedge> = EdgeSet::new(mesh, found.iter().filter_map(off_axis)).edges().to_vec();
    let kept = features.without(mesh, off.iter().copied());
    map.alignment(mesh, &kept.vertex_pairs(mesh), tolerance)?;
    Ok((kept, released(mesh, &off, ReleaseReason::NotInMap)))
}
