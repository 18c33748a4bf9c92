//! From a cross field to a matched cut, where layouts begin.

use super::FieldError;
use super::cross_field::CrossField;
use super::frames_of_matchings::spectral_frames;
use crate::cut::{FramedCut, MatchedCut, Unfolding, regauge};
use crate::quarter::turn;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{HalfedgeData, Metric, TriMesh};

/// The matchings of a field over an unfolded connected mesh with nothing aligned, and its frames in that gauge.
///
/// A gauge of whole quarters changes neither the index of a vertex nor that of a loop, so lifts carry over
/// but for one convention: the isometric layout has no rotation across its tree, while rotations of
/// independent faces are read from the left half-edge and come out a full turn larger where the parent
/// face is on the right.
pub fn matched_cut(mesh: &TriMesh, unfolding: Unfolding, field: &CrossField) -> FramedCut {
    let tree = &unfolding.tree;
    let mut full = field.matching().clone();
    for (parent, child) in tree.parent.iter().filter_map(|h| Some(((*h)?, mesh.twin((*h)?)?))) {
        if child < parent {
            full[child] -= 4;
            full[parent] += 4;
        }
    }
    let (moved, gauge) = regauge(mesh, tree, &full);
    let matching = unfolding.cut.seams.iter().map(|&h| moved[h]).collect();
    let frames = field.frames().iter().zip(gauge.iter()).map(|(&r, &k)| turn(r, k)).collect();
    FramedCut { matched: MatchedCut { unfolding, matching }, frames }
}

/// Why matchings alone give no field.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ResidualFieldError {
    /// They are none of this mesh.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// The smoothest frames could not be found.
    #[error(transparent)]
    Numeric(#[from] NotPositiveDefinite),
}

/// The field of matchings known modulo 4 and no frames: the smoothest frames for them, and the lifts at
/// which these turn least.
///
/// # Errors
/// [`ResidualFieldError`].
pub fn residual_field(
    mesh: &TriMesh,
    metric: &Metric,
    residues: &HalfedgeData<i32>,
) -> Result<CrossField, ResidualFieldError> {
    let (expected, found) = (mesh.n_halfedges(), residues.len());
    if expected != found {
        return Err(FieldError::Count { what: "matchings", expected, found }.into());
    }
    let frames = spectral_frames(mesh, metric, residues)?;
    Ok(CrossField::with_residues(mesh, metric, frames, residues)?)
}
