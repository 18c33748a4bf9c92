//! The certificate of an integer-grid map.

use crate::exact::area;
use crate::manifold::Manifold;
use crate::map::Map;
use crate::plane::{Arrow, Point, largest, turned};
use crate::tolerance::{IntegralTolerance, within};
use crate::violation::{Violation, Violations};

/// What was checked beyond the certificate of the seamless map, and what was found.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IntegerCertificate {
    /// Interior edges, all with an integer translation.
    pub edges: usize,
    /// Those of them across which a quarter turn and the integer translation are exact in doubles: all of an
    /// `IntegerGridMap`.
    pub exact_edges: usize,
    /// Cones, all of them at grid points in every face around them.
    pub integral_cones: usize,
    /// Aligned edges, both ends of all of them at the same integer on either side.
    pub isoline_edges: usize,
    /// Vertices without a cone at which aligned edges turn, all of them at grid points.
    pub integral_corners: usize,
    /// Largest distance from an integer of what is integral, grid units: 0 of an `IntegerGridMap`.
    pub integral_error: f64,
    /// The largest coordinate of a translation.
    pub largest_translation: f64,
    /// Area in the plane, grid units: the number of quads, exactly, of a mesh that is closed or whose boundary lies on
    /// grid lines.
    pub area: f64,
}

impl Map<'_> {
    /// Certifies that a seamless map in grid units is an integer-grid map: translations across edges and the places of
    /// cones are integers, and the two ends of every aligned edge lie at the same integer on either side, with grid
    /// points where these edges turn.
    ///
    /// Whether the map is seamless at all, and the edges, given by their end vertices, run along its axes, is for
    /// [`Map::seamless`] and [`Map::alignment`] to say.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn integers(
        &self,
        aligned: &[[u32; 2]],
        tolerance: IntegralTolerance,
    ) -> Result<IntegerCertificate, Violations> {
        let mut figures = IntegerCertificate::default();
        let mut violations = Vec::new();
        let mut look_at = |off: f64, violation: Violation| {
            figures.integral_error = figures.integral_error.max(off);
            if !within(off, tolerance.distance()) {
                violations.push(violation);
            }
        };
        for (h, t) in self.mesh.interior_edges() {
            let (translation, off, violation) = self.translation(h, t, tolerance);
            figures.edges += 1;
            figures.exact_edges += usize::from(off == 0.0);
            figures.largest_translation = figures.largest_translation.max(largest(&[translation]));
            look_at(off, violation);
        }
        let aligned = self.edges_between(aligned).0;
        figures.isoline_edges = aligned.edges.len();
        for (edge, side) in aligned.edges.iter().flat_map(|&edge| self.mesh.sides(edge)) {
            let (vertices, face) = (self.mesh.ends(edge), Manifold::<3>::face(side));
            look_at(off_isolines(self.image(side)), Violation::OffIsoline { vertices, face });
        }
        for vertex in self.mesh.vertices() {
            let is_cone = self.is_cone(vertex);
            let is_corner = !is_cone && self.is_turning_point(vertex, &aligned);
            figures.integral_cones += usize::from(is_cone);
            figures.integral_corners += usize::from(is_corner);
            let off = |uv: &Point| from_integer(uv[0]).max(from_integer(uv[1]));
            let places = self.mesh.fan(vertex).map(|corner| self.uv(corner));
            match places.max_by(|a, b| off(a).total_cmp(&off(b))) {
                Some(uv) if is_cone => look_at(off(&uv), Violation::FractionalCone { vertex, uv }),
                Some(uv) if is_corner => {
                    look_at(off(&uv), Violation::FractionalCorner { vertex, uv });
                }
                _ => {}
            }
        }
        Violations::unless_none(violations)?;
        figures.area = area((0..self.mesh.origin.len() / 3).map(|face| self.triangle(face)));
        Ok(figures)
    }

    /// The integers next to the translation across an interior edge, their largest distance from it at an end of the edge,
    /// 0 if it is exact in doubles, and what is wrong if that is too far.
    fn translation(
        &self,
        h: usize,
        t: usize,
        tolerance: IntegralTolerance,
    ) -> (Point, f64, Violation) {
        let [a, b, c, d] = self.images(h, t);
        let [first, second] = [(a, c), (b, d)].map(|(left, right)| {
            let left = turned(left, self.quarters(h));
            [0, 1].map(|k| exact_difference(right[k], left[k]))
        });
        let translation = first.map(|[rounded, _]| rounded);
        let nearest = translation.map(f64::round);
        let parts = [first, second].into_iter().flat_map(|end| end.into_iter().zip(nearest));
        let off = parts.map(|([rounded, rest], x)| (rounded - x).abs() + rest.abs());
        let off = off.fold(0.0, f64::max);
        let (vertices, faces) = (self.mesh.ends(h), [h, t].map(Manifold::<3>::face));
        let is_exact = first == second && first.iter().all(|[_, rest]| *rest == 0.0);
        let is_rounding = tolerance == IntegralTolerance::EXACT && off < IntegralTolerance::LARGEST;
        let violation = match is_rounding && !is_exact {
            true => Violation::InexactEdge { vertices, faces },
            false => Violation::FractionalTranslation { vertices, faces, translation },
        };
        (nearest, off, violation)
    }
}

/// The distance of an arrow from the nearest isoline at an integer: of its farther end; infinite if its ends are next to
/// different ones.
fn off_isolines([a, b]: Arrow) -> f64 {
    let off = |k: usize| match a[k].round() == b[k].round() {
        true => from_integer(a[k]).max(from_integer(b[k])),
        false => f64::INFINITY,
    };
    off(0).min(off(1))
}

/// `a - b` as the nearest double and what it lacks (Knuth's two-sum).
fn exact_difference(a: f64, b: f64) -> [f64; 2] {
    let rounded = a - b;
    let b_part = a - rounded;
    let a_part = rounded + b_part;
    [rounded, (a - a_part) + (b_part - b)]
}

/// Distance from the nearest integer.
fn from_integer(x: f64) -> f64 {
    (x - x.round()).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_keep_what_rounding_takes() {
        assert_eq!(exact_difference(0.75, 0.25), [0.5, 0.0]);
        assert_eq!(exact_difference(3.0 + 0.5f64.powi(40), 0.5f64.powi(40)), [3.0, 0.0]);
        assert_eq!(exact_difference(1.0, 1e-30), [1.0, -1e-30]);
        assert_eq!(exact_difference(1e-30, 1.0), [-1.0, 1e-30]);
        assert!(exact_difference(1000.1, 0.1)[1] != 0.0);
    }
}
