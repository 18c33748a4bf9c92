//! Lengths, areas and angles that neither overflow nor vanish, whatever the unit.

use crate::vector::{cross, dot, norm, sub};

/// A triangle counts as flat when it is no higher than this many units in the last place of its
/// largest coordinate: coordinates that were rounded once cannot tell it from a segment.
const FLAT_ULPS: f64 = 4.0;

pub(super) fn is_finite(p: [f64; 3]) -> bool {
    p.iter().all(|x| x.is_finite())
}

fn largest(a: [f64; 3]) -> f64 {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

/// Direction of the area vector of a closed polygon, after Newell: the sum of the cross products
/// of consecutive points. `None` if that sum is zero or not finite.
pub(super) fn unit_normal(points: &[[f64; 3]]) -> Option<[f64; 3]> {
    let next = points.iter().cycle().skip(1);
    let mut sum = [0.0; 3];
    for (&p, &q) in points.iter().zip(next) {
        let step = cross(p, q);
        sum = [sum[0] + step[0], sum[1] + step[1], sum[2] + step[2]];
    }
    let length = norm(sum);
    (length > 0.0 && length.is_finite()).then(|| sum.map(|x| x / length))
}

/// Points moved and scaled so that the first is the origin and the largest coordinate is 1.
#[derive(Debug, Clone)]
pub(super) struct Local {
    pub(super) points: Vec<[f64; 3]>,
    /// One unit in the last place of the largest original coordinate, in local units.
    pub(super) rounding: f64,
}

impl Local {
    /// Empty only if there are no points. Points that all coincide stay at the origin.
    pub(super) fn new(points: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut points: Vec<_> = points.collect();
        let Some(&first) = points.first() else {
            return Self { points, rounding: 0.0 };
        };
        let (unit, rounding) = local_unit(&points, first);
        for p in &mut points {
            *p = to_local(*p, first, unit);
        }
        Self { points, rounding }
    }

    /// Whether the triangle of three points has positive area seen against the unit vector
    /// `normal`: it neither is flat nor faces the other way.
    pub(super) fn is_positive(&self, triangle: [usize; 3], normal: [f64; 3]) -> bool {
        let [a, b, c] = triangle.map(|i| self.points[i]);
        let (u, v, w) = (sub(b, a), sub(c, a), sub(c, b));
        let longest = norm(u).max(norm(v)).max(norm(w));
        let area = dot(cross(u, v), normal);
        area > FLAT_ULPS * self.rounding * longest
    }

    /// The box around a triangle of three points, wider by what counts as flat.
    pub(super) fn bounds(&self, triangle: [usize; 3]) -> Bounds {
        let [a, b, c] = triangle.map(|i| self.points[i]);
        let margin = FLAT_ULPS * self.rounding;
        Bounds {
            low: [0, 1, 2].map(|i| a[i].min(b[i]).min(c[i]) - margin),
            high: [0, 1, 2].map(|i| a[i].max(b[i]).max(c[i]) + margin),
        }
    }
}

/// A box with sides along the axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    pub(super) fn contain(&self, p: [f64; 3]) -> bool {
        (0..3).all(|i| self.low[i] <= p[i] && p[i] <= self.high[i])
    }
}

/// The largest coordinate of the points relative to the first, and the rounding of their largest
/// coordinate measured in it. Halved so that differences of huge coordinates stay finite.
fn local_unit(points: &[[f64; 3]], first: [f64; 3]) -> (f64, f64) {
    let mut extent: f64 = 0.0;
    let mut size: f64 = 0.0;
    for &p in points {
        extent = extent.max(largest(half_difference(p, first)));
        size = size.max(largest(p));
    }
    if extent > 0.0 { (extent, f64::EPSILON * (0.5 * size / extent)) } else { (1.0, 0.0) }
}

fn half_difference(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [0.5 * p[0] - 0.5 * q[0], 0.5 * p[1] - 0.5 * q[1], 0.5 * p[2] - 0.5 * q[2]]
}

fn to_local(p: [f64; 3], first: [f64; 3], unit: f64) -> [f64; 3] {
    half_difference(p, first).map(|x| x / unit)
}

/// Shape of one triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    /// Whether it is no higher than the rounding of its coordinates.
    pub(super) is_flat: bool,
    /// Smallest corner angle in radians, 0 for a flat triangle with coinciding corners.
    pub(super) min_angle: f64,
}

/// Shape of the triangle with these corners, which must be finite.
pub(super) fn shape(corners: [[f64; 3]; 3]) -> Shape {
    let (unit, rounding) = local_unit(&corners, corners[0]);
    let [a, b, c] = corners.map(|p| to_local(p, corners[0], unit));
    let (ab, bc, ca) = (sub(b, a), sub(c, b), sub(a, c));
    let area = norm(cross(ab, ca));
    let longest = norm(ab).max(norm(bc)).max(norm(ca));
    let angle = |u, v| f64::atan2(area, -dot(u, v));
    Shape {
        is_flat: area <= FLAT_ULPS * rounding * longest,
        min_angle: angle(ca, ab).min(angle(ab, bc)).min(angle(bc, ca)),
    }
}

/// Distance of two finite points: infinite only if it exceeds the largest number.
pub(super) fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    let half = half_difference(p, q);
    let unit = largest(half);
    if unit > 0.0 { 2.0 * (unit * norm(half.map(|x| x / unit))) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{Local, distance, shape, unit_normal};
    use std::f64::consts::FRAC_PI_4;

    #[test]
    fn a_right_triangle_keeps_its_shape_at_any_scale() {
        for scale in [1.0, 1e200, 1e-200, 1e307, 1e-300] {
            let found = shape([[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]]);
            assert!(!found.is_flat, "scale {scale}");
            assert!((found.min_angle - FRAC_PI_4).abs() < 1e-15);
            let length = distance([3.0 * scale, 0.0, 0.0], [0.0, 4.0 * scale, 0.0]);
            assert!((length / scale - 5.0).abs() < 1e-14);
        }
    }

    #[test]
    fn flat_means_within_rounding() {
        // Decimal points on one line are not exactly on one line in binary.
        let line = |t: f64| [0.1 + 0.7 * t, 0.3 - 0.2 * t, 1.1 * t];
        assert!(shape([line(0.0), line(0.37), line(1.0)]).is_flat);
        assert!(shape([[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]]).is_flat);
        assert!(shape([[5.0; 3]; 3]).is_flat);
        assert!(!shape([[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1e-12, 0.0]]).is_flat);
        // The same height is lost far from the origin.
        assert!(shape([[1e6, 0.0, 0.0], [1e6 + 1.0, 0.0, 0.0], [1e6 + 0.5, 1e-12, 0.0]]).is_flat);
    }

    #[test]
    fn area_has_the_sign_of_the_normal() {
        let square = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
        let local = Local::new(square.into_iter());
        assert_eq!(local.points[2], [1.0, 1.0, 0.0]);
        let up = unit_normal(&local.points).unwrap();
        assert_eq!(up, [0.0, 0.0, 1.0]);
        assert!(local.is_positive([0, 1, 2], up));
        assert!(!local.is_positive([0, 2, 1], up));
        assert!(!local.is_positive([0, 1, 1], up));
    }
}
