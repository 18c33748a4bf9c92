//! Polygonal curves by arc length.

use crate::vector::{Point, add, angle, norm, scale, sub, vector};
use parry3d_f64::query::{PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::Polyline;

/// A chain of segments, closed if its first point comes again at its end.
pub(crate) struct Curve {
    points: Vec<Point>,
    /// Lengths from the first point to each.
    reach: Vec<f64>,
    /// The same counted in the sizes of quads, where these are not all alike.
    counted: Option<Vec<f64>>,
    polyline: Polyline,
}

impl Curve {
    /// The curve through two points or more, with the sizes of quads there or none.
    pub(crate) fn new(points: &[Point], sizes: &[f64]) -> Option<Self> {
        if points.len() < 2 {
            return None;
        }
        let lengths = || points.windows(2).map(|pair| norm(sub(pair[1], pair[0])));
        let counts =
            lengths().zip(sizes.windows(2)).map(|(l, h)| 0.5 * l * (1.0 / h[0] + 1.0 / h[1]));
        Some(Self {
            points: points.to_vec(),
            reach: sums(lengths()),
            counted: (sizes.len() == points.len()).then(|| sums(counts)),
            polyline: Polyline::new(points.iter().map(|&p| vector(p)).collect(), None),
        })
    }

    pub(crate) fn length(&self) -> f64 {
        self.reach[self.reach.len() - 1]
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.points[0] == self.points[self.points.len() - 1]
    }

    /// The nearest point of the curve.
    pub(crate) fn nearest(&self, at: Point) -> Point {
        let found = self.polyline.project_local_point(vector(at), false);
        [found.point.x, found.point.y, found.point.z]
    }

    /// The arc length at which the nearest point lies.
    pub(crate) fn parameter(&self, at: Point) -> f64 {
        let (found, (segment, _)) =
            self.polyline.project_local_point_and_get_location(vector(at), false);
        let start = segment as usize;
        self.reach[start]
            + norm(sub([found.point.x, found.point.y, found.point.z], self.points[start]))
    }

    /// The point at an arc length; of a closed curve, at any multiple of its length more or less.
    pub(crate) fn point(&self, parameter: f64) -> Point {
        let length = self.length();
        let parameter = match self.is_closed() && length > 0.0 {
            true => parameter.rem_euclid(length),
            false => parameter.clamp(0.0, length),
        };
        let segment = segment(&self.reach, parameter);
        let (from, to) = (self.points[segment], self.points[segment + 1]);
        let step = self.reach[segment + 1] - self.reach[segment];
        let part = if step > 0.0 { (parameter - self.reach[segment]) / step } else { 0.0 };
        add(from, scale(sub(to, from), part))
    }

    /// An arc length counted in the sizes of quads.
    pub(crate) fn count(&self, parameter: f64) -> f64 {
        match &self.counted {
            Some(counted) => self.carried(parameter, &self.reach, counted),
            None => parameter,
        }
    }

    /// The arc length that counts so much.
    pub(crate) fn parameter_of(&self, count: f64) -> f64 {
        match &self.counted {
            Some(counted) => self.carried(count, counted, &self.reach),
            None => count,
        }
    }

    /// The size of quads at an arc length.
    pub(crate) fn size(&self, parameter: f64) -> f64 {
        let Some(counted) = &self.counted else { return 1.0 };
        let at = if self.is_closed() { parameter.rem_euclid(self.length()) } else { parameter };
        let k = segment(&self.reach, at);
        let (length, count) = (self.reach[k + 1] - self.reach[k], counted[k + 1] - counted[k]);
        if count > 0.0 { length / count } else { 1.0 }
    }

    /// A number between some at the points as one between others; of a closed curve, with full turns.
    fn carried(&self, x: f64, from: &[f64], to: &[f64]) -> f64 {
        let last = from.len() - 1;
        let turns = if self.is_closed() { (x / from[last]).floor() } else { 0.0 };
        let x = x - turns * from[last];
        let k = segment(from, x);
        let step = from[k + 1] - from[k];
        let part = if step > 0.0 { (x - from[k]) / step } else { 0.0 };
        turns * to[last] + to[k] + part * (to[k + 1] - to[k])
    }

    /// How much the curve turns at an arc length, radians; nothing inside segments.
    pub(crate) fn turn(&self, parameter: f64) -> f64 {
        let last = self.points.len() - 1;
        let side = |from: usize| sub(self.points[from + 1], self.points[from]);
        match self.reach.binary_search_by(|reach| reach.total_cmp(&parameter)) {
            Ok(k) if 0 < k && k < last => angle(side(k - 1), side(k)),
            Ok(_) if self.is_closed() => angle(side(last - 1), side(0)),
            _ => 0.0,
        }
    }
}

/// Ascending sums, from 0.
fn sums(steps: impl Iterator<Item = f64>) -> Vec<f64> {
    let sums = steps.scan(0.0, |sum, step| {
        *sum += step;
        Some(*sum)
    });
    std::iter::once(0.0).chain(sums).collect()
}

/// The segment between two of ascending numbers that a number lies in.
fn segment(ascending: &[f64], x: f64) -> usize {
    ascending[1..ascending.len() - 1].partition_point(|&end| end < x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    const CORNERS: [Point; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0; 3]];

    #[test]
    fn an_open_and_a_closed_curve_by_hand() {
        assert!(Curve::new(&CORNERS[..1], &[]).is_none());
        let open = Curve::new(&CORNERS[..3], &[]).unwrap();
        assert_eq!((open.length(), open.is_closed()), (3.0, false));
        assert_eq!(open.parameter([2.5, 0.5, 1.0]), 2.5);
        assert_eq!(open.nearest([1.0, -3.0, 0.0]), [1.0, 0.0, 0.0]);
        for (parameter, expected) in [(-1.0, 0.0), (0.5, 0.5), (2.0, 2.0), (2.5, 2.5), (9.0, 3.0)] {
            assert_eq!(open.parameter(open.point(parameter)), expected);
        }
        assert_eq!(open.turn(2.0), FRAC_PI_2);
        assert_eq!([0.0, 1.0, 3.0].map(|at| open.turn(at)), [0.0; 3]);
        let closed = Curve::new(&CORNERS, &[]).unwrap();
        let length = 3.0 + 5.0f64.sqrt();
        assert!(closed.is_closed() && (closed.length() - length).abs() < 1e-12);
        for turns in [-1.0, 1.0, 2.0] {
            let [x, y, _] = closed.point(2.5 + turns * length);
            assert!((x - 2.0).abs() < 1e-12 && (y - 0.5).abs() < 1e-12);
        }
        // From the diagonal, downwards, to the first side.
        // Sizes of 1 on the first side, 1 to 1/2 on the second.
        let sized = Curve::new(&CORNERS[..3], &[1.0, 1.0, 0.5]).unwrap();
        for (parameter, count) in [(0.5, 0.5), (2.0, 2.0), (2.5, 2.75), (3.0, 3.5)] {
            assert_eq!(sized.count(parameter), count);
            assert_eq!(sized.parameter_of(count), parameter);
        }
        assert_eq!((sized.size(1.0), sized.size(2.5)), (1.0, 1.0 / 1.5));
        let sized = Curve::new(&CORNERS, &[2.0; 4]).unwrap();
        assert!((sized.count(2.0 + length) - 1.0 - length / 2.0).abs() < 1e-12);
        assert!((sized.parameter_of(-0.5) + 1.0).abs() < 1e-12);
        let turn = closed.turn(0.0).to_degrees();
        assert!((turn - (180.0 - 0.5f64.atan().to_degrees())).abs() < 1e-9, "{turn}");
    }
}
