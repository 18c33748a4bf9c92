//! Why there is no map.

use crate::consistency::ConsistencyError;
use crate::features::ReleasedFeature;
use crate::field::{FieldError, PrescriptionError};
use crate::layout::disk::DiskError;
use crate::layout::exact::Defects;
use crate::layout::objective::OptimizeError;
use crate::map::{Violations, first_in_words, in_whole};
use crate::progress::{Cancelled, MaybeCancelled, SolveError};
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::components::{self, FailedComponent};
use seamstress_mesh::{Component, Face, Vertex};
use std::collections::BTreeSet;

/// Why a connected mesh has no map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MethodError {
    /// The caller asked to stop, or a linear system could not be solved.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Every route left defects; those of the last one.
    #[error("no route gave a layout without defects; the last one left {0}")]
    Defective(Defects),
    /// The layout stood, but its UVs did not pass the certificate.
    #[error("the component's map failed its certificate: {}", first_in_words(&.0.0))]
    Uncertified(#[source] Violations),
    /// The cones prescribed cannot be had beside free ones.
    #[error(transparent)]
    Cones(#[from] PrescriptionError),
    /// No consistent matchings were found for the map to start from.
    #[error(transparent)]
    Inconsistent(#[from] ConsistencyError),
    /// A disk could not be laid out, or the mesh is none.
    #[error(transparent)]
    Disk(#[from] DiskError),
    /// The objective could not be minimised.
    #[error(transparent)]
    Objective(#[from] OptimizeError),
}

impl From<Cancelled> for MethodError {
    fn from(cancelled: Cancelled) -> Self {
        SolveError::from(cancelled).into()
    }
}

impl From<NotPositiveDefinite> for MethodError {
    fn from(numeric: NotPositiveDefinite) -> Self {
        SolveError::from(numeric).into()
    }
}

impl MaybeCancelled for MethodError {
    fn cancelled(&self) -> Option<Cancelled> {
        match self {
            Self::Solve(error) => error.cancelled(),
            Self::Inconsistent(ConsistencyError::Cancelled(cancelled))
            | Self::Objective(OptimizeError::Cancelled(cancelled)) => Some(*cancelled),
            _ => None,
        }
    }
}

impl MethodError {
    /// With the elements it names in the ids of the whole mesh.
    pub(super) fn in_whole(self, piece: &Component) -> Self {
        self.renamed(|v| piece.vertices[Vertex(v)].0, |f| piece.faces[f as usize].0)
    }

    /// With other names of vertices and faces, each once.
    #[must_use]
    pub fn renamed(self, vertex: impl Fn(u32) -> u32, face: impl Fn(u32) -> u32) -> Self {
        match self {
            Self::Defective(Defects { flips, wrong_angles }) => {
                let flips: BTreeSet<Face> = flips.iter().map(|f| Face(face(f.0))).collect();
                let wrong: BTreeSet<Vertex> =
                    wrong_angles.iter().map(|v| Vertex(vertex(v.0))).collect();
                let (flips, wrong_angles) = (Vec::from_iter(flips), Vec::from_iter(wrong));
                Self::Defective(Defects { flips, wrong_angles })
            }
            Self::Uncertified(violations) => Self::Uncertified(in_whole(violations, face, vertex)),
            Self::Cones(PrescriptionError::NoTaker { vertex: at }) => {
                Self::Cones(PrescriptionError::NoTaker { vertex: vertex(at) })
            }
            Self::Inconsistent(ConsistencyError::Infeasible { vertices }) => {
                let vertices = vertices.into_iter().map(vertex).collect();
                Self::Inconsistent(ConsistencyError::Infeasible { vertices })
            }
            other => other,
        }
    }
}

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The number of positions is not that of the vertices.
    #[error("{found} positions for {expected} vertices")]
    PositionCount {
        /// Vertices of the mesh.
        expected: usize,
        /// Positions given.
        found: usize,
    },
    /// A position is not finite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NonFinitePosition {
        /// The vertex.
        vertex: u32,
    },
    /// Components could not be mapped.
    #[error("{}", components::listed(.0))]
    Components(Vec<FailedComponent<MethodError>>),
    /// The field to start from is none of this mesh.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// The cones asked for, or those of the field to start from, cannot be had.
    #[error(transparent)]
    Cones(#[from] PrescriptionError),
    /// Feature edges could not be aligned, and [`MapOptions::strict_features`](super::MapOptions::strict_features) asked for all of them.
    #[error("{} feature edges could not be aligned{}", released.len(), listed(released))]
    Released {
        /// The edges.
        released: Vec<ReleasedFeature>,
    },
    /// The result did not pass the certificate. Nothing is returned then.
    #[error("the map failed its certificate: {}", first_in_words(&.0.0))]
    Uncertified(#[from] Violations),
}

impl MapError {
    /// Whether a component that had to be a disk is none.
    pub fn is_not_a_disk(&self) -> bool {
        self.is_of_a_component(|cause| matches!(cause, MethodError::Disk(DiskError::NotADisk)))
    }

    /// Whether this is what failed for a component.
    pub(super) fn is_of_a_component(&self, is: impl Fn(&MethodError) -> bool) -> bool {
        matches!(self, Self::Components(failed) if failed.iter().any(|part| is(&part.cause)))
    }
}

/// The first few released features of a list.
fn listed(released: &[ReleasedFeature]) -> String {
    const SHOWN: usize = 5;
    let name = |r: &ReleasedFeature| format!("{}-{} ({})", r.vertices[0], r.vertices[1], r.reason);
    let shown: Vec<String> = released.iter().take(SHOWN).map(name).collect();
    let more = if released.len() > SHOWN { ", ..." } else { "" };
    format!(": {}{more}", shown.join(", "))
}
