//! Components one by one, and side by side in the plane.

use super::{MapError, MethodError};
use crate::progress::{Observer, Stage, Watch, unless_cancelled};
use seamstress_mesh::{Component, Face, TriMesh, Vertex, components};

/// UVs per corner of a component, and how they were made.
type ComponentResult<S> = Result<(Vec<[f64; 2]>, S), MethodError>;

/// Room between components side by side, as a part of the width of the left one: enough to tell them apart.
const MARGIN: f64 = 0.02;

/// Lays out each component for itself and puts the UVs side by side.
pub(super) fn by_component<S>(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    observer: &mut Observer<'_>,
    mut lay_out: impl FnMut(&Component, &mut Watch<'_, '_>) -> ComponentResult<S>,
) -> Result<(Vec<[f64; 2]>, Vec<S>), MapError> {
    check_positions(mesh, positions)?;
    let pieces = components::components(mesh).unwrap_or_default();
    let mut corner_uvs = vec![[0.0; 2]; mesh.n_halfedges()];
    let mut stats = Vec::with_capacity(pieces.len());
    let mut left_edge = 0.0;
    for (k, piece) in pieces.iter().enumerate() {
        let mut watch = Watch::new(observer, k, pieces.len());
        let fail = |cause: MethodError| {
            let (face, cause) = (piece.faces[0].0, cause.in_whole(piece));
            MapError::Component { component: k, face, cause }
        };
        let laid_out = unless_cancelled(lay_out(piece, &mut watch))?;
        let (uvs, piece_stats) = laid_out.map_err(fail)?;
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
    left_edge + (right_edge - left_edge) * (1.0 + MARGIN)
}
