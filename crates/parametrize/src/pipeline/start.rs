//! What a map starts from, and the matchings it leads to.

use super::{MapError, MapOptions};
use crate::consistency::{
    AngleNorm, ConsistencyOptions, consistent_cut, lifted_angles, matched_by_angles,
};
use crate::cut::{DualTree, MatchedCut, curvature_weight, frames_of_angles};
use crate::features::Sectors;
use crate::field::{
    ConePrescription, CrossField, FieldError, check_angle, impose, matched_cut, smooth_field,
    smooth_frames,
};
use crate::layout::exact::Defects;
use crate::layout::safeguards::LayoutError;
use crate::map::{Violation, Violations};
use crate::mixed_integer::{MixedIntegerStats, round_mixed_integer};
use crate::progress::Watch;
use crate::quarter::turn;
use crate::rounding::{RoundingStrategy, fix_holonomy, repair, round};
use num_complex::Complex64;
use seamstress_mesh::{Component, Metric, TriMesh};

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
    /// A map, three UVs per face, with whatever foldovers: the new map has its cones and matchings, or
    /// consistent ones near them; see [`crate::consistency`].
    Map(Vec<[f64; 2]>),
}

/// Matchings, and frames in the gauge of their cut, to lay out from.
#[derive(Clone)]
pub(super) struct Begun {
    pub(super) matched: MatchedCut,
    pub(super) frames: Vec<Complex64>,
    pub(super) rounds: usize,
    pub(super) layouts: usize,
    pub(super) shifted_seams: usize,
    pub(super) mixed_integer: Option<MixedIntegerStats>,
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
            Start::Map(uvs) => {
                count("corners", mesh.n_halfedges(), uvs.len())?;
                let strange = uvs.iter().position(|uv| !uv.iter().all(|x| x.is_finite()));
                if let Some(corner) = strange {
                    let face = (corner / 3) as u32;
                    return Err(Violations(vec![Violation::NonFiniteUv { face }]).into());
                }
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
            Start::Map(uvs) => {
                let corners = piece.faces.iter().flat_map(|f| f.halfedges());
                Start::Map(corners.map(|h| uvs[h.at()]).collect())
            }
        }
    }

    /// Integer matchings for a connected mesh.
    pub(super) fn begin(
        &self,
        sectors: &Sectors<'_>,
        metric: &Metric,
        options: &MapOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Begun, LayoutError> {
        let mesh = sectors.mesh();
        match self {
            Start::Mesh => {
                let begun = rounded(sectors, metric, options, watch)?;
                begun.repaired(sectors, metric)
            }
            Start::SmoothField => smooth(sectors, metric, watch)?.repaired(sectors, metric),
            Start::Field(field) => {
                let (matched, frames) = matched_cut(mesh, metric, field);
                Ok(Begun {
                    matched,
                    frames,
                    rounds: 0,
                    layouts: 0,
                    shifted_seams: 0,
                    mixed_integer: None,
                })
            }
            Start::Map(uvs) => from_map(mesh, metric, uvs, watch),
            Start::Cones(cones) => {
                let mut begun = rounded(sectors, metric, options, watch)?;
                begun.shifted_seams = impose(sectors, metric, &mut begun.matched, cones)?;
                if begun.shifted_seams > 0 {
                    fix_holonomy(sectors, metric, &mut begun.matched)?;
                    begun.frames = smooth_frames(mesh, metric, &begun.matched)?;
                }
                Ok(begun)
            }
        }
    }
}

impl Begun {
    /// The same where fewer edges are aligned.
    ///
    /// # Errors
    /// [`LayoutError::Defective`] with sectors that no triangles can make.
    pub(super) fn with_fewer_aligned(
        self,
        from: &Sectors<'_>,
        to: &Sectors<'_>,
        metric: &Metric,
    ) -> Result<Self, LayoutError> {
        let (matched, gauge) = self.matched.with_fewer_aligned(from, to, metric);
        let frames = self.frames.iter().zip(gauge.iter()).map(|(&r, &k)| turn(r, k)).collect();
        let repaired = self.shifted_seams;
        let mut begun = Self { matched, frames, ..self }.repaired(to, metric)?;
        begun.shifted_seams += repaired;
        Ok(begun)
    }

    /// With indices that the triangles can have. At aligned edges what cannot be repaired is a failure:
    /// edges are released then.
    fn repaired(mut self, sectors: &Sectors<'_>, metric: &Metric) -> Result<Self, LayoutError> {
        let (shifted, hopeless) = repair(sectors, metric, &mut self.matched);
        if sectors.any_aligned() && !hopeless.is_empty() {
            let wrong_angles = hopeless.into_iter().map(|s| sectors.vertex(s)).collect();
            return Err(LayoutError::Defective(Defects { flips: Vec::new(), wrong_angles }));
        }
        self.shifted_seams = shifted;
        Ok(self)
    }
}

/// The matchings of the direct method.
fn rounded(
    sectors: &Sectors<'_>,
    metric: &Metric,
    options: &MapOptions,
    watch: &mut Watch<'_, '_>,
) -> Result<Begun, LayoutError> {
    let mut matched = MatchedCut::through_curved_sectors(sectors, metric);
    let rounding = &options.rounding;
    if rounding.strategy == RoundingStrategy::MixedInteger && !sectors.any_aligned() {
        let mesh = sectors.mesh();
        let settings = &rounding.mixed_integer;
        let (frames, stats) = round_mixed_integer(mesh, metric, &mut matched, settings, watch)?;
        let (rounds, layouts) = (stats.batches.len(), stats.nodes());
        let mixed_integer = Some(stats);
        return Ok(Begun { matched, frames, rounds, layouts, shifted_seams: 0, mixed_integer });
    }
    let (frames, stats) = round(sectors, metric, &mut matched, rounding, watch)?;
    let (rounds, layouts) = (stats.rounds, stats.layouts);
    Ok(Begun { matched, frames, rounds, layouts, shifted_seams: 0, mixed_integer: None })
}

/// The matchings of a map, made consistent. Its flipped triangles have angles far from any possible
/// ones: the l1 norm leaves the change with them.
fn from_map(
    mesh: &TriMesh,
    metric: &Metric,
    uvs: &[[f64; 2]],
    watch: &mut Watch<'_, '_>,
) -> Result<Begun, LayoutError> {
    let tree = DualTree::lightest(mesh, curvature_weight(mesh, metric));
    let angles = lifted_angles(mesh, uvs);
    let read = matched_by_angles(mesh, metric, tree, &angles);
    let options = ConsistencyOptions { norm: AngleNorm::L1, ..Default::default() };
    let (matched, consistent) = consistent_cut(mesh, metric, &read, &angles, &options, watch)?;
    let frames = frames_of_angles(mesh, metric, &consistent.angles, &matched.tree);
    let shifted_seams = consistent.stats.changed_matchings;
    Ok(Begun { matched, frames, rounds: 0, layouts: 0, shifted_seams, mixed_integer: None })
}

/// The matchings of a smooth cross field.
pub(super) fn smooth(
    sectors: &Sectors<'_>,
    metric: &Metric,
    watch: &mut Watch<'_, '_>,
) -> Result<Begun, LayoutError> {
    let mut matched = MatchedCut::through_curved_sectors(sectors, metric);
    let (frames, stats) = smooth_field(sectors.mesh(), metric, &mut matched, watch)?;
    let (rounds, layouts) = (stats.rounds, stats.solves);
    Ok(Begun { matched, frames, rounds, layouts, shifted_seams: 0, mixed_integer: None })
}
