//! A map of a triangle mesh: its corners in the plane, across edges and around vertices.

use crate::exact::side;
use crate::manifold::Manifold;
use crate::plane::{Arrow, InUnit, Point, between, difference, quadrant, turned};
use crate::violation::{Violation, Violations};
use std::cmp::Ordering;

/// A map of a triangle mesh, with one UV per corner, about which nothing is known yet but that its faces form an
/// oriented manifold and its UVs are finite.
#[derive(Debug)]
pub struct Map<'a> {
    pub(crate) mesh: Manifold<3>,
    uvs: &'a [Point],
    /// Quarter turns from the face of each half-edge to that of its twin, the nearest; 0 at the boundary.
    quarters: Vec<i32>,
}

impl<'a> Map<'a> {
    /// Takes the faces by their vertices, and three UVs for each.
    ///
    /// # Errors
    /// Faces that are no oriented manifold, and UVs that are missing or not finite.
    pub fn new(
        n_vertices: usize,
        faces: &[[u32; 3]],
        uvs: &'a [[f64; 2]],
    ) -> Result<Self, Violations> {
        let (expected, found) = (3 * faces.len(), uvs.len());
        if expected != found {
            return Err(Violations(vec![Violation::UvCount { expected, found }]));
        }
        let is_finite = |uvs: &[Point]| uvs.as_flattened().iter().all(|x| x.is_finite());
        let strange = uvs.chunks(3).zip(0..).filter(|(uvs, _)| !is_finite(uvs));
        Violations::unless_none(
            strange.map(|(_, face)| Violation::NonFiniteUv { face }).collect(),
        )?;
        let mesh = Manifold::new(n_vertices, faces)?;
        let mut map = Self { quarters: vec![0; uvs.len()], mesh, uvs };
        let fits: Vec<_> =
            map.mesh.interior_edges().map(|(h, t)| (h, t, map.nearest_quarters(h, t))).collect();
        for (h, t, quarters) in fits {
            (map.quarters[h], map.quarters[t]) = (quarters, -quarters);
        }
        Ok(map)
    }

    pub(crate) fn uv(&self, corner: usize) -> Point {
        self.uvs[corner]
    }

    /// Quarter turns from the face of a half-edge to that of its twin.
    pub(crate) fn quarters(&self, h: usize) -> i32 {
        self.quarters[h]
    }

    pub(crate) fn face_corners(&self, face: usize) -> [usize; 3] {
        [3 * face, 3 * face + 1, 3 * face + 2]
    }

    /// The ends of both images of an edge, in a unit of their own: of the half-edge in its face, then in that of its
    /// twin.
    pub(crate) fn images(&self, h: usize, t: usize) -> InUnit<4> {
        InUnit::new([h, self.mesh.next(h), self.mesh.next(t), t].map(|corner| self.uv(corner)))
    }

    fn nearest_quarters(&self, h: usize, t: usize) -> i32 {
        let [a, b, c, d] = self.images(h, t).points;
        let [cos, sin] = between(difference(b, a), difference(d, c));
        match (cos.abs() >= sin.abs(), cos >= 0.0, sin >= 0.0) {
            (true, true, _) => 0,
            (true, false, _) => 2,
            (false, _, true) => 1,
            (false, _, false) => -1,
        }
    }

    /// The image of a half-edge, by the corners at its ends.
    fn arrow(&self, from: usize, to: usize) -> Arrow {
        [self.uv(from), self.uv(to)]
    }

    /// The orientation of a face: greater than equal if it is positive.
    pub(crate) fn orientation(&self, face: usize) -> Ordering {
        let [a, b, c] = self.face_corners(face);
        side(self.arrow(a, b), self.arrow(a, c))
    }

    /// By how many quadrants the edges around a vertex turn, followed from the first to the last and at an interior
    /// vertex back to the first; and whether a boundary vertex turns by more than a full turn.
    ///
    /// The angle of a triangle that is not flipped is less than a half turn, so that the quadrants of its sides tell
    /// how many axes lie between them; across an edge that fits, rounding moves an image by at most one quadrant.
    /// Around an interior vertex the sum is its angle in quarters, a whole number by itself.
    pub(crate) fn turning(&self, vertex: u32) -> (i32, bool) {
        // Quarters from the chart of the first face to the one at hand.
        let (mut quadrants, mut chart) = (0, 0);
        let (mut first, mut last) = (None, None);
        for corner in self.mesh.fan(vertex) {
            let before = self.mesh.prev(corner);
            let sides = [self.mesh.next(corner), before].map(|end| self.arrow(corner, end));
            let [right, left] = sides.map(quadrant);
            quadrants += match self.orientation(corner / 3) {
                Ordering::Less => -(right - left).rem_euclid(4),
                _ => (left - right).rem_euclid(4),
            };
            first.get_or_insert(sides[0]);
            last = Some(sides[1].map(|end| turned(end, -chart)));
            if let Some(twin) = self.mesh.twin(before) {
                let seen = quadrant(self.arrow(twin, self.mesh.next(twin)));
                let moved = seen - self.quarters(before) - left;
                quadrants += (moved + 1).rem_euclid(4) - 1;
                chart += self.quarters(before);
            }
        }
        let is_past =
            || first.zip(last).is_some_and(|(first, last)| side(first, last) == Ordering::Greater);
        (quadrants, quadrants > 4 || quadrants == 4 && is_past())
    }
}
