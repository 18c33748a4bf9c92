//! What a map starts from, and the matchings it leads to.

use super::{MapError, MapOptions};
use crate::cut::{DualTree, curvature_weight};
use crate::field::{
    ConePrescription, CrossField, FieldError, check_angle, impose, matched_cut, smooth_field,
    smooth_frames,
};
use crate::layout::safeguards::LayoutError;
use crate::progress::Watch;
use crate::rounding::{MatchedCut, fix_holonomy, repair, round};
use num_complex::Complex64;
use seamstress_surface::{Component, Metric, TriMesh};

/// What a map starts from.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Start {
    /// The mesh alone: the direct method.
    Mesh,
    /// A smooth cross field made by mixed-integer rounding, the classical way; see
    /// [`crate::field::smooth_field`]. Indices that no triangles can have are repaired.
    SmoothField,
    /// A given cross field: the map has its cones and its loop indices.
    Field(CrossField),
    /// Given cones: the map has these, and rotations around handles that suit them.
    Cones(ConePrescription),
}

/// Matchings, and frames in the gauge of their cut, to lay out from.
pub(super) struct Begun {
    pub(super) matched: MatchedCut,
    pub(super) frames: Vec<Complex64>,
    pub(super) rounds: usize,
    pub(super) layouts: usize,
    pub(super) shifted_seams: usize,
}

impl Start {
    /// Whether clean-up may change the cones.
    pub(super) fn leaves_cones_free(&self) -> bool {
        matches!(self, Start::Mesh)
    }

    /// Refuses what is not of this mesh, and cones that no map has.
    pub(super) fn check(&self, mesh: &TriMesh) -> Result<(), MapError> {
        let count = |what, expected, found| match expected == found {
            true => Ok(()),
            false => Err(FieldError::Count { what, expected, found }),
        };
        match self {
            Start::Mesh | Start::SmoothField => {}
            Start::Field(field) => {
                count("faces", mesh.n_faces(), field.frames().len())?;
                let indices = field.indices(mesh);
                for v in mesh.vertices().filter(|&v| mesh.outgoing(v).next().is_some()) {
                    check_angle(mesh, v, indices[v])?;
                }
                let cones = indices.enumerate().filter(|(_, k)| **k != 0);
                let cones: Vec<(u32, i32)> = cones.map(|(v, &k)| (v.0, k)).collect();
                ConePrescription::exactly(mesh, &cones)?;
            }
            Start::Cones(cones) => count("vertices", mesh.n_vertices(), cones.index().len())?,
        }
        Ok(())
    }

    /// The start on one connected piece.
    pub(super) fn restrict(&self, piece: &Component) -> Self {
        match self {
            Start::Mesh => Start::Mesh,
            Start::SmoothField => Start::SmoothField,
            Start::Field(field) => Start::Field(field.restrict(piece)),
            Start::Cones(cones) => Start::Cones(cones.restrict(piece)),
        }
    }

    /// Integer matchings for a connected mesh.
    pub(super) fn begin(
        &self,
        mesh: &TriMesh,
        metric: &Metric,
        options: &MapOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Begun, LayoutError> {
        match self {
            Start::Mesh => {
                let mut begun = rounded(mesh, metric, options, watch)?;
                begun.shifted_seams = repair(mesh, metric, &mut begun.matched).0;
                Ok(begun)
            }
            Start::SmoothField => {
                let mut begun = smooth(mesh, metric, watch)?;
                begun.shifted_seams = repair(mesh, metric, &mut begun.matched).0;
                Ok(begun)
            }
            Start::Field(field) => {
                let (matched, frames) = matched_cut(mesh, metric, field);
                Ok(Begun { matched, frames, rounds: 0, layouts: 0, shifted_seams: 0 })
            }
            Start::Cones(cones) => {
                let mut begun = rounded(mesh, metric, options, watch)?;
                begun.shifted_seams = impose(mesh, metric, &mut begun.matched, cones)?;
                if begun.shifted_seams > 0 {
                    fix_holonomy(mesh, metric, &mut begun.matched)?;
                    begun.frames = smooth_frames(mesh, metric, &begun.matched)?;
                }
                Ok(begun)
            }
        }
    }
}

/// The matchings of the direct method.
fn rounded(
    mesh: &TriMesh,
    metric: &Metric,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Begun, LayoutError> {
    let tree = DualTree::lightest(mesh, curvature_weight(mesh, metric));
    let mut matched = MatchedCut::new(mesh, metric, tree);
    let (frames, stats) = round(mesh, metric, &mut matched, &options.rounding, watch)?;
    let (rounds, layouts) = (stats.rounds, stats.layouts);
    Ok(Begun { matched, frames, rounds, layouts, shifted_seams: 0 })
}

/// The matchings of a smooth cross field.
pub(super) fn smooth(
    mesh: &TriMesh,
    metric: &Metric,
    watch: &mut Watch<'_, '_>,
) -> Result<Begun, LayoutError> {
    let tree = DualTree::lightest(mesh, curvature_weight(mesh, metric));
    let mut matched = MatchedCut::new(mesh, metric, tree);
    let (frames, stats) = smooth_field(mesh, metric, &mut matched, watch)?;
    let (rounds, layouts) = (stats.rounds, stats.solves);
    Ok(Begun { matched, frames, rounds, layouts, shifted_seams: 0 })
}
