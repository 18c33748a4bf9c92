//! Signed singular values of a map, triangle by triangle.

use super::frames::jacobian;
use crate::energy::Triangle;
use num_complex::Complex64;
use seamstress_mesh::{Face, FaceData, Metric, TriMesh};

/// Flat source triangles thinner than this (height against longest side) have no meaningful Jacobian.
const DEGENERATE: f64 = 1e-12;

/// Signed singular values `[sigma_1, sigma_2]` of every triangle of a map, in UV units per mesh unit;
/// `|sigma_2| <= sigma_1`, and `sigma_2` is negative where the triangle is flipped (Levi 2021, suppl. sec. 3).
#[derive(Debug, Clone, PartialEq)]
pub struct SingularValues {
    /// The two values; `None` for source triangles without area, which no figure counts.
    pub values: FaceData<Option<[f64; 2]>>,
    /// Area of the source triangles; only ratios matter.
    pub area: FaceData<f64>,
}

impl SingularValues {
    /// Of a map given by one UV per corner (three per face).
    pub fn new(mesh: &TriMesh, metric: &Metric, corner_uvs: &[[f64; 2]]) -> Self {
        let values = mesh.faces().map(|f| of_face(metric, corner_uvs, f)).collect();
        Self { values, area: metric.area.clone() }
    }

    /// Of a layout: `z` holds the positions of the wedges.
    pub fn of_layout(triangles: &[Triangle], z: &[Complex64]) -> Self {
        let of = |t: &Triangle| {
            let (s1, s2) = t.jacobian(z).singular_values();
            Some([s1, s2])
        };
        Self {
            values: triangles.iter().map(of).collect(),
            area: triangles.iter().map(|t| t.weight).collect(),
        }
    }

    /// The values of the measured triangles and their areas.
    pub(super) fn measured(&self) -> impl Iterator<Item = (Face, [f64; 2], f64)> {
        let pairs = self.values.enumerate().zip(self.area.iter());
        pairs.filter_map(|((f, value), &area)| value.map(|value| (f, value, area)))
    }

    /// The same without flipped and collapsed triangles.
    pub(super) fn positive(&self) -> impl Iterator<Item = (Face, [f64; 2], f64)> {
        self.measured().filter(|(_, [_, s2], _)| *s2 > 0.0)
    }

    /// Triangles that the map flips or collapses.
    pub fn flipped(&self) -> usize {
        self.measured().count() - self.positive().count()
    }

    /// Source triangles without area.
    pub fn degenerate(&self) -> usize {
        self.values.iter().filter(|value| value.is_none()).count()
    }

    /// Largest `sigma_1` and smallest `sigma_2` over the triangles that are neither flipped nor collapsed;
    /// `(0, infinity)` if there is none.
    pub fn extremes(&self) -> (f64, f64) {
        self.positive().fold((0.0, f64::INFINITY), |(largest, smallest), (_, [s1, s2], _)| {
            (largest.max(s1), smallest.min(s2))
        })
    }

    /// Area-weighted mean of a function of the values over some triangles.
    pub(super) fn mean(
        triangles: impl Iterator<Item = (Face, [f64; 2], f64)>,
        of: impl Fn([f64; 2]) -> f64,
    ) -> f64 {
        let (sum, area) = triangles.fold((0.0, 0.0), |(sum, total), (_, value, area)| {
            (sum + area * of(value), total + area)
        });
        sum / area
    }
}

fn of_face(metric: &Metric, corner_uvs: &[[f64; 2]], f: Face) -> Option<[f64; 2]> {
    let [_, p, q] = metric.flat[f];
    let longest = f.halfedges().map(|h| metric.length[h]).into_iter().fold(0.0, f64::max);
    if 2.0 * metric.area[f] <= DEGENERATE * longest * longest {
        return None;
    }
    let s1 = jacobian(metric, corner_uvs, f).singular_values().0;
    if s1 == 0.0 {
        return Some([0.0, 0.0]);
    }
    // The determinant keeps its digits where the difference of the two parts loses them.
    let [a, b, c] = [0, 1, 2].map(|k| {
        let [u, v] = corner_uvs[3 * f.at() + k];
        Complex64::new(u, v) / metric.unit
    });
    let s2 = ((b - a).conj() * (c - a)).im / (p.re * q.im) / s1;
    Some([s1, s2])
}
