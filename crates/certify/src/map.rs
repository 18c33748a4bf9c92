//! A map of a triangle mesh: its corners in the plane, across edges and around vertices.

use crate::exact::side;
use crate::manifold::{Manifold, Star};
use crate::plane::{Arrow, Point, angle, difference, nearest_quarters, quadrant, scaled, turned};
use crate::verdict::{Checked, Violation, Violations};
use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_2;

/// A map of a triangle mesh, with one UV per corner, about which nothing is known yet but that its faces form an
/// oriented manifold and its UVs are finite.
#[derive(Debug)]
pub struct Map<'a> {
    pub(crate) mesh: Manifold<3>,
    pub(crate) uvs: &'a [Point],
    /// Quarter turns from the face of each half-edge to that of its twin, the nearest; 0 at the boundary.
    pub(crate) quarters: Vec<i32>,
}

impl<'a> Map<'a> {
    /// Takes the faces by their vertices, and three UVs for each.
    ///
    /// # Errors
    /// Faces that are no oriented manifold, and UVs that are missing or not finite.
    pub fn new(n_vertices: usize, faces: &[[u32; 3]], uvs: &'a [Point]) -> Checked<Self> {
        let (expected, found) = (3 * faces.len(), uvs.len());
        let is_other = expected != found;
        Violations::unless_none(is_other.then_some(Violation::UvCount { expected, found }))?;
        let is_finite = |uvs: &[Point]| uvs.as_flattened().iter().all(|x| x.is_finite());
        let strange = (0..).zip(uvs.chunks(3)).filter(|(_, uvs)| !is_finite(uvs));
        Violations::unless_none(strange.map(|(face, _)| Violation::NonFiniteUv { face }))?;
        let mesh = Manifold::new(n_vertices, faces)?;
        let mut map = Self { quarters: vec![0; uvs.len()], mesh, uvs };
        for (h, t) in map.mesh.interior_edges() {
            let [a, b, c, d] = scaled(map.images(h, t)).0;
            let quarters = nearest_quarters(difference(b, a), difference(d, c));
            (map.quarters[h], map.quarters[t]) = (quarters, -quarters);
        }
        Ok(map)
    }

    /// From one corner to another.
    fn arrow(&self, from: usize, to: usize) -> Arrow {
        [self.uvs[from], self.uvs[to]]
    }

    /// The ends of the image of a half-edge.
    pub(crate) fn image(&self, h: usize) -> Arrow {
        self.arrow(h, self.mesh.next(h))
    }

    /// The ends of both images of an edge: of the half-edge in its face, then in that of its twin.
    pub(crate) fn images(&self, h: usize, t: usize) -> [Point; 4] {
        let ([a, b], [d, c]) = (self.image(h), self.image(t));
        [a, b, c, d]
    }

    /// The sum of the angles of corners, quarter turns; those of a flipped triangle are negative.
    pub(crate) fn angle_sum(&self, corners: &[usize]) -> f64 {
        let angle_at = |&corner: &usize| {
            let corners = [corner, self.mesh.next(corner), self.mesh.prev(corner)];
            let [at, right, left] = scaled(corners.map(|corner| self.uvs[corner])).0;
            angle(difference(right, at), difference(left, at))
        };
        corners.iter().map(angle_at).sum::<f64>() / FRAC_PI_2
    }

    /// The orientation of a face: greater than equal if it is positive.
    pub(crate) fn orientation(&self, face: usize) -> Ordering {
        let [a, b, c] = [0, 1, 2].map(|k| self.uvs[3 * face + k]);
        side([a, b], [a, c])
    }

    /// By how many quadrants the edges around a vertex turn, followed from the first to the last and at an interior
    /// vertex back to the first; and whether a boundary vertex turns by more than a full turn.
    ///
    /// The angle of a triangle that is not flipped is less than a half turn, so that the quadrants of its sides tell
    /// how many axes lie between them; across an edge that fits, rounding moves an image by at most one quadrant.
    /// Around an interior vertex the sum is its angle in quarters, a whole number by itself.
    pub(crate) fn turning(&self, star: &Star) -> (i32, bool) {
        // Quarters from the chart of the first face to the one at hand.
        let (mut quadrants, mut chart, mut last) = (0, 0, [[0.0; 2]; 2]);
        for &corner in &star.corners {
            let before = self.mesh.prev(corner);
            last = self.arrow(corner, before);
            let [right, left] = [self.image(corner), last].map(quadrant);
            last = last.map(|end| turned(end, -chart));
            quadrants += match self.orientation(corner / 3) {
                Ordering::Less => -(right - left).rem_euclid(4),
                _ => (left - right).rem_euclid(4),
            };
            if let Some(twin) = self.mesh.twin[before] {
                let moved = quadrant(self.image(twin)) - self.quarters[before] - left;
                quadrants += (moved + 1).rem_euclid(4) - 1;
                chart += self.quarters[before];
            }
        }
        let is_past = || side(self.image(star.corners[0]), last) == Ordering::Greater;
        (quadrants, !star.is_closed && (quadrants > 4 || quadrants == 4 && is_past()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f64) -> Point {
        [degrees.to_radians().cos(), degrees.to_radians().sin()]
    }

    /// The turning around vertex 0.
    fn turning_at_first(map: &Map<'_>) -> (i32, bool) {
        map.turning(&map.mesh.stars().next().unwrap())
    }

    /// What the turning around the middle of an open fan is, whose rim lies at some points: the same with its faces in
    /// charts of their own.
    fn turning_to(rim: &[Point]) -> (i32, bool) {
        let n = rim.len() as u32;
        let faces: Vec<_> = (1..n).map(|k| [0, k, k + 1]).collect();
        let turning = |chart: i32| {
            let triangles = rim.windows(2).map(|ends| [[0.0; 2], ends[0], ends[1]]).zip(0..);
            let uvs: Vec<Point> =
                triangles.flat_map(|(points, k)| points.map(|p| turned(p, k * chart))).collect();
            turning_at_first(&Map::new(n as usize + 1, &faces, &uvs).unwrap())
        };
        let found = turning(0);
        assert_eq!([1, 2, 3].map(turning), [found; 3]);
        found
    }

    #[test]
    fn open_fans_of_all_angles() {
        for start in [0.0, 17.0, 89.0, 200.0] {
            for step in [1.0, 50.0, 90.0, 119.0, 179.0] {
                for n in 1..=12 {
                    let rim: Vec<_> = (0..=n).map(|k| at(start + step * f64::from(k))).collect();
                    let (quadrants, is_past) = turning_to(&rim);
                    let angle = step * f64::from(n);
                    assert!((f64::from(quadrants) - angle / 90.0).abs() < 1.001, "{n} of {step}");
                    assert!(
                        angle == 360.0 || is_past == (angle > 360.0),
                        "{n} of {step} from {start}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_full_turn_is_told_from_a_little_more() {
        let rim = |last| [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], last];
        assert_eq!(turning_to(&rim([2.0, 0.0])), (4, false));
        assert_eq!(turning_to(&rim([2.0, -1e-300])), (3, false));
        assert_eq!(turning_to(&rim([2.0, 1e-300])), (4, true));
    }

    /// A closed fan whose faces lie in charts of their own, each turned by `chart` quarters more than the last.
    fn closed_fan(n: u32, degrees: f64, chart: i32) -> i32 {
        let faces: Vec<_> = (0..n).map(|k| [0, 1 + k, 1 + (k + 1) % n]).collect();
        let uvs: Vec<Point> = (0..n as i32)
            .flat_map(|k| {
                let from = 10.0 + degrees * f64::from(k);
                [[0.0; 2], at(from), at(from + degrees)].map(|p| turned(p, k * chart))
            })
            .collect();
        turning_at_first(&Map::new(n as usize + 1, &faces, &uvs).unwrap()).0
    }

    #[test]
    fn closed_fans_in_all_charts() {
        for chart in 0..4 {
            assert_eq!(closed_fan(5, 72.0, chart), 4);
            assert_eq!(closed_fan(3, 30.0, chart), 1);
            assert_eq!(closed_fan(7, 360.0 * 2.0 / 7.0, chart), 8, "wound twice");
            assert_eq!(closed_fan(5, -72.0, chart), -4);
        }
    }

    #[test]
    fn an_image_may_pass_an_axis_by_rounding() {
        // A quarter, a little more, and a little less than a half turn; the two images of the edge along the axis lie on either side of it.
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1]];
        for [one, other] in [[1e-17, 0.0], [0.0, 1e-17], [1e-17, -1e-17], [-1e-17, 1e-17]] {
            let [east, north, west] = [[1.0, 0.0], [0.0, 1.0], [-1.0, -1e-9]];
            let (one, other) = ([one, north[1]], [other, north[1]]);
            let uvs = [[0.0; 2], east, one, [0.0; 2], other, west, [0.0; 2], west, [1.0, -0.0]];
            assert_eq!(turning_at_first(&Map::new(4, &faces, &uvs).unwrap()).0, 4);
        }
    }
}
