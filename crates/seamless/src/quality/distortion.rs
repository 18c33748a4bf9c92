//! Isometric distortion of a map, section 3 of the seed.

use crate::layout::energy::Jacobian;
use num_complex::Complex64;
use seamstress_surface::{Metric, TriMesh};

/// Flat source triangles thinner than this (height against longest side) have no meaningful Jacobian.
const DEGENERATE: f64 = 1e-12;

/// Median, 95th and 99th percentile over triangles.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Percentiles {
    /// Half of the triangles are below.
    pub p50: f64,
    /// 95 of 100 are below.
    pub p95: f64,
    /// 99 of 100 are below.
    pub p99: f64,
}

/// Distortion of a whole map.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Distortion {
    /// `sqrt(sigma_1 max / sigma_2 min)`, eq. (3); infinite when a triangle is flipped or collapsed,
    /// not a number when the source has no triangle with area.
    pub tau: f64,
    /// Percentiles of `max(s sigma_1, 1 / (s sigma_2))` at the scale `s` of eq. (3).
    pub tau_t: Percentiles,
    /// The largest singular value, UV units per mesh unit.
    pub sigma_1_max: f64,
    /// The smallest signed singular value, UV units per mesh unit.
    pub sigma_2_min: f64,
    /// Area-weighted mean of the symmetric Dirichlet energy at its best global scale; 4 at an isometry.
    pub symmetric_dirichlet: f64,
    /// Area-weighted mean of `(sigma_1 - 1)^2 + (sigma_2 - 1)^2` at its best global scale.
    pub arap: f64,
    /// Triangles of positive orientation that were measured.
    pub measured: usize,
    /// Triangles flipped or collapsed by the map.
    pub flipped: usize,
    /// Source triangles without area, left out.
    pub degenerate: usize,
}

/// Measures a map given by one UV per corner (three per face).
///
/// The means are taken over the unflipped triangles; `tau` is infinite when there are others.
pub fn distortion(mesh: &TriMesh, metric: &Metric, corner_uvs: &[[f64; 2]]) -> Distortion {
    let mut values = Vec::with_capacity(mesh.n_faces());
    let (mut flipped, mut degenerate) = (0, 0);
    for f in mesh.faces() {
        let [_, p, q] = metric.flat[f];
        let longest = f.halfedges().map(|h| metric.length[h]).into_iter().fold(0.0, f64::max);
        if 2.0 * metric.area[f] <= DEGENERATE * longest * longest {
            degenerate += 1;
            continue;
        }
        let [a, b, c] = [0, 1, 2].map(|k| {
            let [u, v] = corner_uvs[3 * f.at() + k];
            Complex64::new(u, v) / metric.unit
        });
        let (e1, e2) = (b - a, c - a);
        let x = e1 / p.re;
        let y = (e2 - x * q.re) / q.im;
        let jacobian = Jacobian::from_rows([[x.re, y.re], [x.im, y.im]]);
        let s1 = jacobian.singular_values().0;
        // The determinant keeps its digits where the difference of the two parts loses them.
        let s2 = (e1.conj() * e2).im / (p.re * q.im) / s1;
        if s2 > 0.0 {
            values.push((s1, s2, metric.area[f]));
        } else {
            flipped += 1;
        }
    }
    summarize(&values, flipped, degenerate)
}

fn summarize(values: &[(f64, f64, f64)], flipped: usize, degenerate: usize) -> Distortion {
    let largest = values.iter().map(|v| v.0).fold(0.0, f64::max);
    let smallest = values.iter().map(|v| v.1).fold(f64::INFINITY, f64::min);
    let scale = 1.0 / (largest * smallest).sqrt();
    let mut worst: Vec<f64> =
        values.iter().map(|&(s1, s2, _)| (scale * s1).max(1.0 / (scale * s2))).collect();
    worst.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| {
        let last = worst.len().saturating_sub(1) as f64;
        worst.get((share * last) as usize).copied().unwrap_or(f64::NAN)
    };
    let area: f64 = values.iter().map(|v| v.2).sum();
    let mean = |g: &dyn Fn(f64, f64) -> f64| {
        values.iter().map(|&(s1, s2, a)| a * g(s1, s2)).sum::<f64>() / area
    };
    let squares = mean(&|s1, s2| s1 * s1 + s2 * s2);
    let inverse_squares = mean(&|s1, s2| 1.0 / (s1 * s1) + 1.0 / (s2 * s2));
    let sums = mean(&|s1, s2| s1 + s2);
    Distortion {
        tau: match (flipped, values.is_empty()) {
            (0, true) => f64::NAN,
            (0, false) => (largest / smallest).sqrt(),
            _ => f64::INFINITY,
        },
        tau_t: Percentiles { p50: at(0.5), p95: at(0.95), p99: at(0.99) },
        sigma_1_max: largest,
        sigma_2_min: smallest,
        // min over s of s^2 a + b / s^2 and of s^2 a - 2 s c + 2
        symmetric_dirichlet: 2.0 * (squares * inverse_squares).sqrt(),
        arap: (2.0 - sums * sums / squares).max(0.0),
        measured: values.len(),
        flipped,
        degenerate,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measure(map: impl Fn([f64; 2]) -> [f64; 2]) -> Distortion {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let faces = [[0, 1, 2], [0, 2, 3]];
        let mesh = TriMesh::from_faces(4, &faces).unwrap();
        let metric = Metric::from_positions(&mesh, &positions);
        let corner = |v: u32| map([positions[v as usize][0], positions[v as usize][1]]);
        let uvs: Vec<[f64; 2]> = faces.iter().flatten().map(|&v| corner(v)).collect();
        distortion(&mesh, &metric, &uvs)
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn similarities_have_no_distortion() {
        let d = measure(|[x, y]| [3.0 * x - 4.0 * y + 7.0, 4.0 * x + 3.0 * y - 1.0]);
        assert!(close(d.tau, 1.0) && close(d.symmetric_dirichlet, 4.0) && close(d.arap, 0.0));
        assert!(close(d.sigma_1_max, 5.0) && close(d.tau_t.p50, 1.0));
    }

    #[test]
    fn anisotropic_scaling_by_hand() {
        let d = measure(|[x, y]| [2.0 * x, 0.5 * y]);
        assert!(close(d.tau, 2.0) && close(d.symmetric_dirichlet, 8.5));
        // best scale s = (s1 + s2) / (s1^2 + s2^2); energy 2 - 2.5^2 / 4.25
        assert!(close(d.arap, 2.0 - 6.25 / 4.25));
    }

    #[test]
    fn reflection_is_infinite_and_counted() {
        let d = measure(|[x, y]| [x, -y]);
        assert!(d.tau.is_infinite() && d.flipped == 2 && d.measured == 0);
    }
}
