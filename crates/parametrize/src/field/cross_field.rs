//! A cross field with everything that fixes its topology.

use super::homology::{DualLoop, Homology, NodeIndices};
use crate::cut::isometric::turning;
use num_complex::Complex64;
use seamstress_mesh::{
    Component, Face, FaceData, Halfedge, HalfedgeData, Metric, TriMesh, VertexData,
};
use std::f64::consts::{FRAC_PI_2, PI};

/// Frames are of length one up to this.
const UNIT: f64 = 1e-6;

/// Why given data are no cross field on the mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FieldError {
    /// Not one value per element.
    #[error("the field has {found} {what}, the mesh {expected}")]
    Count {
        /// What is counted.
        what: &'static str,
        /// Of the mesh.
        expected: usize,
        /// Given.
        found: usize,
    },
    /// A direction that is zero, not finite, or normal to its face.
    #[error("the field has no direction in the plane of face {face}")]
    NoDirection {
        /// The face.
        face: u32,
    },
    /// Matchings of the two half-edges of an edge that are not opposite, or one on the boundary.
    #[error("edge {}-{} has no consistent matching", vertices[0], vertices[1])]
    BadMatching {
        /// Ends of the edge.
        vertices: [u32; 2],
    },
    /// A row of matchings that names no interior edge, or one twice.
    #[error("matching {row} (from 0) is of faces {} and {}, which share no edge{}", faces[0], faces[1],
        if *.repeated { " that has none yet" } else { "" })]
    BadRow {
        /// The row.
        row: usize,
        /// Its faces.
        faces: [i64; 2],
        /// Whether the edge had a matching already.
        repeated: bool,
    },
    /// An interior edge without a matching.
    #[error("edge {}-{} has no matching", vertices[0], vertices[1])]
    NoMatching {
        /// Ends of the edge.
        vertices: [u32; 2],
    },
}

/// A cross per face and a lifted matching per edge.
///
/// The *frame* `R` of a face turns the flat triangle of [`Metric::flat`] as the map of the field would;
/// the cross on the face has the directions `i^k / R`, `k = 0..4`, in the flat triangle, that of `k = 0`
/// along `u`. Across an edge `R_right e_right` is about `i^r R_left e_left` with the matching `r`, so
/// direction `k` on the left continues as direction `k + r` on the right. The lift of `r` counts full
/// turns against the frames' arguments in `(-pi, pi]`.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossField {
    frames: FaceData<Complex64>,
    matching: HalfedgeData<i32>,
}

impl CrossField {
    /// A field of frames and lifted matchings.
    ///
    /// # Errors
    /// [`FieldError`] if counts do not fit, a frame is not of length one, or matchings are not opposite on
    /// twins and zero on the boundary.
    pub fn new(
        mesh: &TriMesh,
        frames: FaceData<Complex64>,
        matching: HalfedgeData<i32>,
    ) -> Result<Self, FieldError> {
        check_frames(mesh, &frames)?;
        let (expected, found) = (mesh.n_halfedges(), matching.len());
        if expected != found {
            return Err(FieldError::Count { what: "matchings", expected, found });
        }
        let opposite =
            |h: &Halfedge| mesh.twin(*h).map_or(0, |t| matching[t].wrapping_neg()) == matching[*h];
        if let Some(h) = mesh.halfedges().find(|h| !opposite(h)) {
            return Err(FieldError::BadMatching { vertices: ends(mesh, h) });
        }
        Ok(Self { frames, matching })
    }

    /// The field of these frames whose crosses turn least across each edge: the principal matching.
    ///
    /// # Errors
    /// As [`CrossField::new`].
    pub fn principal(
        mesh: &TriMesh,
        metric: &Metric,
        frames: FaceData<Complex64>,
    ) -> Result<Self, FieldError> {
        check_frames(mesh, &frames)?;
        let rotation = rotations(mesh, metric, &frames);
        let matching = antisymmetric(mesh, |h| rotation[h].round() as i32);
        Self::new(mesh, frames, matching)
    }

    /// The field of these frames and of matchings known modulo 4 (of left half-edges; the others are not
    /// read), lifted so that the frames turn least.
    ///
    /// # Errors
    /// As [`CrossField::new`].
    pub fn with_residues(
        mesh: &TriMesh,
        metric: &Metric,
        frames: FaceData<Complex64>,
        residues: &HalfedgeData<i32>,
    ) -> Result<Self, FieldError> {
        check_frames(mesh, &frames)?;
        let (expected, found) = (mesh.n_halfedges(), residues.len());
        if expected != found {
            return Err(FieldError::Count { what: "matchings", expected, found });
        }
        let rotation = rotations(mesh, metric, &frames);
        let nearest = |h: Halfedge| {
            let residue = residues[h].rem_euclid(4);
            residue + 4 * ((rotation[h] - f64::from(residue)) / 4.0).round() as i32
        };
        let matching = antisymmetric(mesh, nearest);
        Self::new(mesh, frames, matching)
    }

    /// Frame of each face.
    pub fn frames(&self) -> &FaceData<Complex64> {
        &self.frames
    }

    /// Lifted matching of each half-edge, negated on twins, zero on the boundary.
    pub fn matching(&self) -> &HalfedgeData<i32> {
        &self.matching
    }

    /// Index in quarters of every interior vertex; zero on the boundary.
    pub fn indices(&self, mesh: &TriMesh) -> VertexData<i32> {
        let share = vertex_shares(mesh, &self.matching);
        mesh.vertices().map(|v| if mesh.is_boundary(v) { 0 } else { share[v] }).collect()
    }

    /// Index in quarters of every node of a homology basis: interior vertices and boundary loops. They sum
    /// to 4 chi on every component.
    pub fn node_indices(&self, mesh: &TriMesh, homology: &Homology) -> NodeIndices {
        homology.gather(&vertex_shares(mesh, &self.matching))
    }

    /// Index in quarters of a dual loop: minus the quarters by which it turns left in a map with these
    /// matchings.
    pub fn loop_index(&self, mesh: &TriMesh, dual_loop: &DualLoop) -> i32 {
        loop_index(mesh, &self.matching, dual_loop)
    }

    /// Rotation of the cross across each half-edge, in quarters: matching less the rotation of the frames.
    /// At most a half for a principal matching.
    pub fn effort(&self, mesh: &TriMesh, metric: &Metric) -> HalfedgeData<f64> {
        let rotation = rotations(mesh, metric, &self.frames);
        mesh.halfedges().map(|h| f64::from(self.matching[h]) - rotation[h]).collect()
    }

    /// The field on one connected piece.
    pub fn restrict(&self, piece: &Component) -> Self {
        let halfedges = piece.faces.iter().flat_map(|f| f.halfedges());
        Self {
            frames: piece.faces.iter().map(|&f| self.frames[f]).collect(),
            matching: halfedges.map(|h| self.matching[h]).collect(),
        }
    }
}

/// The ends of a half-edge, for messages.
pub(super) fn ends(mesh: &TriMesh, h: Halfedge) -> [u32; 2] {
    [mesh.origin(h).0, mesh.tip(h).0]
}

fn check_frames(mesh: &TriMesh, frames: &FaceData<Complex64>) -> Result<(), FieldError> {
    let (expected, found) = (mesh.n_faces(), frames.len());
    if expected != found {
        return Err(FieldError::Count { what: "frames", expected, found });
    }
    let is_unit = |f: &Face| (frames[*f].norm() - 1.0).abs() <= UNIT;
    match mesh.faces().find(|f| !is_unit(f)) {
        Some(Face(face)) => Err(FieldError::NoDirection { face }),
        None => Ok(()),
    }
}

/// Values of left half-edges, negated on their twins, zero on the boundary.
pub(super) fn antisymmetric(mesh: &TriMesh, value: impl Fn(Halfedge) -> i32) -> HalfedgeData<i32> {
    let mut all = HalfedgeData::filled(mesh.n_halfedges(), 0);
    for h in mesh.interior_edges() {
        if let Some(t) = mesh.twin(h) {
            all[h] = value(h);
            all[t] = -all[h];
        }
    }
    all
}

/// Rotation in quarters from the left to the right image of each edge when every triangle is laid flat
/// with its frame: a seam's rotation `r0` for frames other than those of the isometric layout. Negated on
/// twins, zero on the boundary.
pub(super) fn rotations(
    mesh: &TriMesh,
    metric: &Metric,
    frames: &FaceData<Complex64>,
) -> HalfedgeData<f64> {
    let angles: FaceData<f64> = frames.iter().map(|r| r.arg()).collect();
    let mut all = HalfedgeData::filled(mesh.n_halfedges(), 0.0);
    for h in mesh.interior_edges() {
        if let Some(t) = mesh.twin(h) {
            all[h] = rotation(metric, h, t, angles[h.face()], angles[t.face()]);
            all[t] = -all[h];
        }
    }
    all
}

/// Rotation in quarters across a left half-edge, for faces turned by these angles (radians).
pub(super) fn rotation(
    metric: &Metric,
    left: Halfedge,
    right: Halfedge,
    left_angle: f64,
    right_angle: f64,
) -> f64 {
    (right_angle + turning(&metric.angle, right) + PI - left_angle - turning(&metric.angle, left))
        / FRAC_PI_2
}

/// What each vertex has of the index of its node: the index itself for interior vertices, and a share of
/// its loop's for those of the boundary.
///
/// It is `2 K / pi - sum (r - r0)` over outgoing half-edges, in which the angles cancel: a corner at its
/// face's first vertex adds a full turn, an outgoing half-edge on the right of its edge takes one.
fn vertex_shares(mesh: &TriMesh, matching: &HalfedgeData<i32>) -> VertexData<i32> {
    let own = |v| if mesh.is_boundary(v) { 0 } else { 4 };
    let mut share: VertexData<i32> = mesh.vertices().map(own).collect();
    for h in mesh.halfedges() {
        let is_right = mesh.twin(h).is_some_and(|t| t < h);
        let lift = i32::from(h.side() == 0) - i32::from(is_right);
        share[mesh.origin(h)] += 4 * lift - matching[h];
    }
    share
}

/// See [`CrossField::loop_index`]; the angles cancel as in [`vertex_shares`].
pub(super) fn loop_index(
    mesh: &TriMesh,
    matching: &HalfedgeData<i32>,
    dual_loop: &DualLoop,
) -> i32 {
    let steps = dual_loop.steps(mesh).map(|(entry, exit)| {
        let is_right = mesh.twin(exit).is_some_and(|t| t < exit);
        let lift = i32::from(is_right) - i32::from(entry.side() > exit.side());
        4 * lift + matching[exit]
    });
    steps.sum()
}
