//! Frames of a map: the rotations nearest to its Jacobians.

use crate::energy::Jacobian;
use crate::quarter::{direction, turn};
use num_complex::Complex64;
use seamstress_mesh::{Face, FaceData, Metric, TriMesh};

/// Rotation of every triangle of a map (three UVs per face) by polar decomposition, section 4.3 of the
/// seed: a unit complex number that turns the flat triangle of [`Metric::flat`] to its place in the plane.
///
/// The rotation belongs to the map's own gauge: across a seam it jumps by a quarter turn. A flipped
/// triangle has the rotation that is nearest all the same.
pub fn frames(mesh: &TriMesh, metric: &Metric, corner_uvs: &[[f64; 2]]) -> FaceData<Complex64> {
    mesh.faces().map(|f| direction(jacobian(metric, corner_uvs, f).similar)).collect()
}

/// Area-weighted mean of `|J - R|^2`, the energy of eq. (6), for the frames of another map. Each frame is
/// turned by the quarters that bring it nearest, since the maps may differ in their seams.
pub fn distance_to_frames(
    mesh: &TriMesh,
    metric: &Metric,
    corner_uvs: &[[f64; 2]],
    other_uvs: &[[f64; 2]],
) -> f64 {
    let frames = frames(mesh, metric, other_uvs);
    let distance = |f: Face| {
        let j = jacobian(metric, corner_uvs, f);
        let nearest = (0..4)
            .map(|k| (j.similar - turn(frames[f], k)).norm_sqr())
            .fold(f64::INFINITY, f64::min);
        2.0 * metric.area[f] * (nearest + j.anti.norm_sqr())
    };
    mesh.faces().map(distance).sum::<f64>() / metric.total_area()
}

/// Jacobian of a map on a face, UV units per mesh unit.
pub(super) fn jacobian(metric: &Metric, corner_uvs: &[[f64; 2]], f: Face) -> Jacobian {
    let [_, p, q] = metric.flat[f];
    let [a, b, c] = [0, 1, 2].map(|k| {
        let [u, v] = corner_uvs[3 * f.at() + k];
        Complex64::new(u, v) / metric.unit
    });
    let x = (b - a) / p.re;
    let y = (c - a - x * q.re) / q.im;
    Jacobian::from_rows([[x.re, y.re], [x.im, y.im]])
}
