//! The cross field of a seamless map (Levi 2021, suppl. sec. 6).

use super::cross_field::{CrossField, FieldError};
use super::homology::{DualLoop, Homology, NodeIndices};
use super::lift::{LiftError, lift};
use crate::map::SeamlessMap;
use crate::quarter::direction;
use num_complex::Complex64;
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, TriMesh};
use std::f64::consts::FRAC_PI_2;

/// Why a map's field could not be read off.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExtractError {
    /// The map is not of this mesh.
    #[error("the map has {found} corners, the mesh {expected}")]
    OtherMesh {
        /// Of the mesh.
        expected: usize,
        /// Of the map.
        found: usize,
    },
    /// A frame is missing: the triangle's own shape or its image is not usable.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// Transitions and angles of the map disagree.
    #[error("the map's transitions and angles disagree: {0}")]
    Lift(#[from] LiftError),
}

/// Reads the fully prescribed cross field off a map: frames by polar decomposition, matchings from the
/// transitions, their full turns from the map's cone angles and loop indices by eq. (13).
///
/// # Errors
/// [`ExtractError`]; a map that is certified for this mesh has a field.
pub fn extract(
    mesh: &TriMesh,
    metric: &Metric,
    homology: &Homology,
    map: &SeamlessMap,
) -> Result<CrossField, ExtractError> {
    let (expected, found) = (mesh.n_halfedges(), map.corner_uvs().len());
    if expected != found {
        return Err(ExtractError::OtherMesh { expected, found });
    }
    let mut residues = HalfedgeData::filled(mesh.n_halfedges(), 0);
    for seam in map.seams() {
        residues[seam.left] = seam.matching;
    }
    let frames = map_frames(mesh, metric, map.corner_uvs());
    let near = CrossField::with_residues(mesh, metric, frames, &residues)?;
    let (nodes, loops) = map_indices(mesh, homology, map.corner_uvs());
    let found = near.node_indices(mesh, homology);
    let turns = lift(mesh, homology, near.matching(), &found, &nodes, &loops)?;
    let full = near.matching().iter().zip(turns.iter()).map(|(r, k)| r + 4 * k).collect();
    Ok(CrossField::new(mesh, near.frames().clone(), full)?)
}

/// Rotation of each triangle's Jacobian, given one UV per corner.
pub fn map_frames(mesh: &TriMesh, metric: &Metric, corner_uvs: &[[f64; 2]]) -> FaceData<Complex64> {
    let frame = |f: seamstress_mesh::Face| {
        let [a, b, c] = f.halfedges().map(|h| point(corner_uvs, h));
        let [_, p, q] = metric.flat[f];
        // J maps p = (p, 0) and q to the edges; its similarity part is (J_x - i J_y) / 2. Scaled by the
        // height, which may be tiny.
        let x = (b - a) / p.re;
        let y = (c - a) - x * q.re;
        direction(x * q.im - Complex64::I * y)
    };
    mesh.faces().map(frame).collect()
}

/// Index in quarters of every node and loop, from the angles of a map: cone angles, total turning of the
/// boundary loops, and minus the turning of the loops.
pub fn map_indices(
    mesh: &TriMesh,
    homology: &Homology,
    corner_uvs: &[[f64; 2]],
) -> (NodeIndices, Vec<i32>) {
    let angle = |h: Halfedge| {
        let at = point(corner_uvs, h);
        let w = (point(corner_uvs, h.next()) - at).conj() * (point(corner_uvs, h.prev()) - at);
        w.arg() / FRAC_PI_2
    };
    let mut sums = vec![0.0; homology.n_nodes()];
    for (v, node) in homology.nodes().enumerate() {
        if let Some(node) = node {
            let full = if mesh.is_boundary(v) { 2.0 } else { 4.0 };
            let angles: f64 = mesh.outgoing(v).map(angle).sum();
            sums[*node as usize] += full - angles;
        }
    }
    let turning = |dual_loop: &DualLoop| {
        let turn = |(entry, exit): (Halfedge, Halfedge)| {
            // Around the tip of the entry to the right, or around its origin to the left.
            if exit == entry.next() { -angle(exit) } else { angle(entry) }
        };
        dual_loop.steps(mesh).map(turn).sum::<f64>()
    };
    let loops = homology.loops().iter().map(|l| -turning(l).round() as i32).collect();
    (NodeIndices(sums.into_iter().map(|x| x.round() as i32).collect()), loops)
}

fn point(corner_uvs: &[[f64; 2]], h: Halfedge) -> Complex64 {
    let [u, v] = corner_uvs[h.at()];
    Complex64::new(u, v)
}
