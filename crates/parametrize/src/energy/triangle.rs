//! Triangles as layouts see them.

use super::Jacobian;
use crate::cut::Cut;
use num_complex::Complex64;
use seamstress_mesh::{Face, Metric, TriMesh};
use seamstress_parallel::prelude::*;

/// Faces per parallel task; sums are taken per task, then in order, so that the number of threads does
/// not show in the result.
pub(crate) const CHUNK: usize = 2048;

/// A triangle as layouts see it.
#[derive(Debug, Clone, Copy)]
pub struct Triangle {
    /// Wedges of its corners.
    pub wedges: [u32; 3],
    /// Gradients of the corner hat functions; `J = sum of uv_k times gradient_k`.
    pub gradients: [[f64; 2]; 3],
    /// Share of the total area.
    pub weight: f64,
    /// A rotation wanted, up to quarter turns, times what it counts; zero if none is.
    pub wanted: Complex64,
}

impl Triangle {
    /// Positions of the corners.
    #[inline]
    pub fn corners(&self, z: &[Complex64]) -> [Complex64; 3] {
        self.wedges.map(|w| z[w as usize])
    }

    /// Images of the two axes under the linear map with these corners.
    #[inline]
    pub fn axes(&self, corners: [Complex64; 3]) -> [Complex64; 2] {
        let mut axes = [Complex64::ZERO; 2];
        for (z, g) in corners.into_iter().zip(self.gradients) {
            axes[0] += z * g[0];
            axes[1] += z * g[1];
        }
        axes
    }

    /// The Jacobian of the layout on this triangle.
    #[inline]
    pub fn jacobian(&self, z: &[Complex64]) -> Jacobian {
        let mut j = [[0.0; 2]; 2];
        for (z, g) in self.corners(z).into_iter().zip(self.gradients) {
            j[0][0] += z.re * g[0];
            j[0][1] += z.re * g[1];
            j[1][0] += z.im * g[0];
            j[1][1] += z.im * g[1];
        }
        Jacobian::from_rows(j)
    }

    /// Twice the signed area in the layout.
    #[inline]
    pub fn doubled_area(&self, z: &[Complex64]) -> f64 {
        let [a, b, c] = self.corners(z);
        ((b - a).conj() * (c - a)).im
    }
}

/// A derivative by the entries `(j00, j01, j10, j11)` of the Jacobian as one by the position of the corner with this
/// gradient.
#[inline]
pub fn at_corner(d: [f64; 4], gradient: [f64; 2]) -> [f64; 2] {
    let [x, y] = gradient;
    [d[0] * x + d[1] * y, d[2] * x + d[3] * y]
}

/// The triangles of a cut mesh with a metric.
pub fn triangles(mesh: &TriMesh, metric: &Metric, cut: &Cut) -> Vec<Triangle> {
    let wedges = |f: Face| f.halfedges().map(|h| cut.wedge[h]);
    triangles_of(metric, mesh.faces().map(|f| (f, wedges(f))))
}

/// The triangles of some faces with their wedges.
pub fn triangles_of(
    metric: &Metric,
    faces: impl Iterator<Item = (Face, [u32; 3])>,
) -> Vec<Triangle> {
    let total = metric.total_area();
    faces
        .map(|(f, wedges)| {
            let [_, p, q] = metric.flat[f];
            let determinant = p.re * q.im - p.im * q.re;
            let g1 = [q.im / determinant, -q.re / determinant];
            let g2 = [-p.im / determinant, p.re / determinant];
            Triangle {
                wedges,
                gradients: [[-g1[0] - g2[0], -g1[1] - g2[1]], g1, g2],
                weight: metric.area[f] / total,
                wanted: Complex64::ZERO,
            }
        })
        .collect()
}

/// Deterministic parallel sum over triangles.
pub fn sum_over(triangles: &[Triangle], value: impl Fn(&Triangle) -> f64 + Sync) -> f64 {
    let parts: Vec<f64> =
        triangles.par_chunks(CHUNK).map(|chunk| chunk.iter().map(&value).sum()).collect();
    parts.iter().sum()
}

/// The largest first and the smallest second value of all triangles.
pub(crate) fn extremes(
    triangles: &[Triangle],
    values: impl Fn(usize, &Triangle) -> (f64, f64) + Sync,
) -> (f64, f64) {
    let none = (f64::NEG_INFINITY, f64::INFINITY);
    let join = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.min(b.1));
    let of_chunks: Vec<(f64, f64)> = triangles
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(c, chunk)| {
            let each = chunk.iter().enumerate().map(|(k, t)| values(c * CHUNK + k, t));
            each.fold(none, join)
        })
        .collect();
    of_chunks.into_iter().fold(none, join)
}

/// Exact orientation test of a triangle in the plane.
pub fn is_positive(corners: [Complex64; 3]) -> bool {
    let [a, b, c] = corners.map(|z| robust::Coord { x: z.re, y: z.im });
    robust::orient2d(a, b, c) > 0.0
}

/// The largest step along `dz` before some triangle's area vanishes; infinite if none does.
pub fn largest_step(triangles: &[Triangle], z: &[Complex64], dz: &[Complex64]) -> f64 {
    let step = |t: &Triangle| {
        let ([a, b, c], [da, db, dc]) = (t.corners(z), t.corners(dz));
        let cross = |p: Complex64, q: Complex64| (p.conj() * q).im;
        let (e, f, de, df) = (b - a, c - a, db - da, dc - da);
        smallest_positive_root(cross(de, df), cross(e, df) + cross(de, f), cross(e, f))
    };
    let steps: Vec<f64> = triangles
        .par_chunks(CHUNK)
        .map(|chunk| chunk.iter().map(step).fold(f64::INFINITY, f64::min))
        .collect();
    steps.into_iter().fold(f64::INFINITY, f64::min)
}

/// Smallest positive root of `a t^2 + b t + c`.
pub(crate) fn smallest_positive_root(a: f64, b: f64, c: f64) -> f64 {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let positive = |t: f64| if t > 0.0 { t } else { f64::INFINITY };
    positive(q / a).min(positive(c / q))
}
