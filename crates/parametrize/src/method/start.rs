//! What a map starts from, and the matchings it leads to.

use super::domain::Domain;
use super::{MapError, MapOptions, MethodError};
use crate::consistency::{
    AngleNorm, ConsistencyOptions, consistent_cut, lifted_angles, matched_by_angles,
};
use crate::cut::{FramedCut, Unfolding, frames_of_angles};
use crate::field::{
    ConePrescription, CrossField, FieldError, check_angle, impose, matched_cut, smooth_field,
};
use crate::layout::exact::Defects;
use crate::map::{Violation, Violations};
use crate::progress::Watch;
use crate::rounding::{Holonomy, Repair, Rounding, RoundingStats, repair, round};
use seamstress_mesh::{Component, TriMesh};

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

    /// Integer matchings for an unfolded domain, with indices that its triangles can make; else the aligned sectors
    /// that cannot have any.
    ///
    /// # Errors
    /// [`MethodError`].
    pub(super) fn rounding(
        &self,
        domain: &Domain<'_>,
        unfolding: Unfolding,
        options: &MapOptions,
        watch: &mut Watch<'_, '_>,
    ) -> Result<Result<Rounding, Defects>, MethodError> {
        let (mesh, sectors, metric) = (domain.mesh(), &domain.sectors, &domain.metric);
        let rounded = |unfolding, watch: &mut Watch<'_, '_>| {
            let guide = domain.guide.as_ref();
            round(sectors, metric, unfolding, guide, &options.rounding, watch)
        };
        Ok(Ok(match self {
            Start::Mesh => return Ok(repaired(domain, rounded(unfolding, watch)?)),
            Start::SmoothField => {
                let (start, stats) = smooth_field(mesh, metric, unfolding, watch)?;
                let mut rounding = Rounding::given(start);
                (rounding.stats.rounds, rounding.stats.layouts) = (stats.rounds, stats.solves);
                return Ok(repaired(domain, rounding));
            }
            Start::Field(field) => Rounding::given(matched_cut(mesh, unfolding, field)),
            Start::Map(uvs) => matchings_of_map(domain, unfolding, uvs, watch)?,
            Start::Cones(cones) => with_cones(domain, rounded(unfolding, watch)?, cones)?,
        }))
    }
}

/// Matchings with prescribed cones near rounded ones.
fn with_cones(
    domain: &Domain<'_>,
    rounding: Rounding,
    cones: &ConePrescription,
) -> Result<Rounding, MethodError> {
    let (sectors, metric) = (&domain.sectors, &domain.metric);
    let (matched, shifts) = impose(sectors, metric, &rounding.start.matched, cones)?;
    if shifts == 0 {
        return Ok(rounding);
    }
    let start = FramedCut { matched, frames: rounding.start.frames };
    let start = Holonomy::new(sectors, metric, domain.guide.as_ref())?.fix(start);
    let stats = RoundingStats { shifted_seams: shifts, ..rounding.stats };
    Ok(Rounding { start, stats })
}

/// The matchings of a map, made consistent. Its flipped triangles have angles far from any possible
/// ones: the l1 norm leaves the change with them.
fn matchings_of_map(
    domain: &Domain<'_>,
    unfolding: Unfolding,
    uvs: &[[f64; 2]],
    watch: &mut Watch<'_, '_>,
) -> Result<Rounding, MethodError> {
    let (mesh, metric) = (domain.mesh(), &domain.metric);
    let angles = lifted_angles(mesh, uvs);
    let read = matched_by_angles(mesh, metric, unfolding.tree, &angles);
    let options = ConsistencyOptions { norm: AngleNorm::L1, ..Default::default() };
    let (matched, consistent) = consistent_cut(mesh, metric, &read, &angles, &options, watch)?;
    let frames = frames_of_angles(mesh, metric, &consistent.angles, &matched.unfolding.tree);
    let mut rounding = Rounding::given(FramedCut { matched, frames });
    rounding.stats.shifted_seams = consistent.stats.changed_matchings;
    Ok(rounding)
}

/// With indices that the triangles can make. At aligned edges, where dropping an edge is the better way out, the
/// sectors that cannot be repaired are defects.
///
/// # Errors
/// Those sectors.
pub(super) fn repaired(domain: &Domain<'_>, rounding: Rounding) -> Result<Rounding, Defects> {
    let Rounding { mut start, stats } = rounding;
    let Repair { matched, shifts, hopeless } =
        repair(&domain.sectors, &domain.metric, start.matched);
    if domain.any_aligned() && !hopeless.is_empty() {
        let wrong_angles = hopeless.into_iter().map(|s| domain.sectors.vertex(s)).collect();
        return Err(Defects { flips: Vec::new(), wrong_angles });
    }
    start.matched = matched;
    let shifted_seams = stats.shifted_seams + shifts;
    Ok(Rounding { start, stats: RoundingStats { shifted_seams, ..stats } })
}
