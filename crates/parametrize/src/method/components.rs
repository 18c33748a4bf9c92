//! Components one by one.

use super::placement::side_by_side;
use super::{MapError, MethodError};
use crate::progress::{Observer, Stage, Watch, unless_cancelled};
use seamstress_mesh::components::{self, FailedComponent};
use seamstress_mesh::{Component, TriMesh, Vertex};

/// UVs per corner of a component, and how they were made.
type ComponentResult<S> = Result<(Vec<[f64; 2]>, S), MethodError>;

/// Lays out each component for itself and puts the UVs side by side; after a failure too, so that all are named.
pub(super) fn by_component<S>(
    mesh: &TriMesh,
    positions: &[[f64; 3]],
    observer: &mut Observer<'_>,
    mut lay_out: impl FnMut(&Component, &mut Watch<'_, '_>) -> ComponentResult<S>,
) -> Result<(Vec<[f64; 2]>, Vec<S>), MapError> {
    check_positions(mesh, positions)?;
    let pieces = components::components(mesh).unwrap_or_default();
    let mut layouts = Vec::with_capacity(pieces.len());
    let mut stats = Vec::with_capacity(pieces.len());
    let mut failed = Vec::new();
    for (k, piece) in pieces.iter().enumerate() {
        let mut watch = Watch::new(observer, k, pieces.len());
        match unless_cancelled(lay_out(piece, &mut watch))? {
            Ok((uvs, piece_stats)) => {
                layouts.push(uvs);
                stats.push(piece_stats);
            }
            Err(cause) => failed.push(FailedComponent {
                component: k,
                face: piece.faces[0].0,
                cause: cause.in_whole(piece),
            }),
        }
    }
    if !failed.is_empty() {
        return Err(MapError::Components(failed));
    }
    Watch::new(observer, pieces.len().saturating_sub(1), pieces.len()).enter(Stage::Certificate)?;
    Ok((side_by_side(mesh, &pieces, &layouts), stats))
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
