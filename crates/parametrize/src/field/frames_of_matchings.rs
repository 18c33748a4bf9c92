//! The smoothest frames for given matchings.

use super::cross_field::rotations;
use super::face_laplacian::{FaceMatrix, nearest_angles};
use crate::cut::isometric::headings;
use crate::cut::{MatchedCut, Unfolding};
use crate::quarter::{direction, rotation};
use num_complex::Complex64;
use seamstress_linalg::NotPositiveDefinite;
use seamstress_mesh::{FaceData, Halfedge, HalfedgeData, Metric, TriMesh};
use std::f64::consts::FRAC_PI_2;

/// Inverse iterations: each divides what is not smoothest by the ratio of the two least eigenvalues.
const INVERSE_ITERATIONS: usize = 12;

/// Frames, in the gauge of the cut, whose crosses turn least across edges in the mean of squares, for
/// matchings that stay as they are: one Laplacian solve over the faces.
///
/// # Errors
/// When it cannot be solved.
pub fn smooth_frames(
    mesh: &TriMesh,
    metric: &Metric,
    matched: &MatchedCut,
) -> Result<Vec<Complex64>, NotPositiveDefinite> {
    let mut turned = HalfedgeData::filled(mesh.n_halfedges(), 0.0);
    for (&h, excess) in matched.unfolding.cut.seams.iter().zip(matched.excess()) {
        turned[h] = excess;
    }
    let edges: Vec<Halfedge> = mesh.interior_edges().collect();
    let mut matrix = FaceMatrix::new(mesh)?;
    let angles = nearest_angles(&mut matrix, |_| 1.0, |e| turned[edges[e]])?;
    Ok(frames_of(mesh, metric, &matched.unfolding, &angles))
}

/// Frames turned by these angles, in quarters, against the isometric layout of a cut.
pub(crate) fn frames_of(
    mesh: &TriMesh,
    metric: &Metric,
    unfolding: &Unfolding,
    angles: &[f64],
) -> Vec<Complex64> {
    let heading = headings(mesh, &metric.angle, &unfolding.tree);
    heading.iter().zip(angles).map(|(h, x)| rotation(h / FRAC_PI_2 + x)).collect()
}

/// Frames for matchings known modulo 4 (of left half-edges): the eigenvector of least
/// `sum |R_right e_right - i^r R_left e_left|^2` over edges of length one, its entries made unit, after
/// Knöppel et al. 2013 with the fourth power replaced by the matchings.
///
/// # Errors
/// When the system cannot be solved.
pub fn spectral_frames(
    mesh: &TriMesh,
    metric: &Metric,
    residues: &HalfedgeData<i32>,
) -> Result<FaceData<Complex64>, NotPositiveDefinite> {
    let flat = FaceData::filled(mesh.n_faces(), Complex64::ONE);
    let bare = rotations(mesh, metric, &flat);
    // R_right should be c R_left with c turning by the matching less the flat triangles' rotation.
    let c: Vec<Complex64> = mesh
        .interior_edges()
        .map(|h| rotation(f64::from(residues[h].rem_euclid(4)) - bare[h]))
        .collect();
    let mut matrix = FaceMatrix::<Complex64>::new(mesh)?;
    // The entry (right, left) of the form is -c.
    matrix.factorize(|e| (1.0, -c[e]), |x| x.conj())?;
    // A start with a share of every eigenvector, the same in every run.
    let mut frames: Vec<Complex64> =
        (0..mesh.n_faces()).map(|f| rotation(f as f64 * 0.754_877_666)).collect();
    for _ in 0..INVERSE_ITERATIONS {
        matrix.solve(&mut frames);
        let largest = frames.iter().map(|r| r.norm()).fold(0.0, f64::max);
        frames.iter_mut().for_each(|r| *r /= largest);
    }
    Ok(frames.into_iter().map(direction).collect())
}
