//! The certificate of an integer-grid map.

use crate::exact::area;
use crate::manifold::Manifold;
use crate::map::Map;
use crate::plane::{Point, turned};
use crate::tolerance::{IntegralTolerance, within};
use crate::violation::{Violation, Violations};

/// What was checked beyond the certificate of the seamless map, and what was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
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
        let mut found =
            Found { tolerance: tolerance.distance(), error: 0.0, violations: Vec::new() };
        let (mut edges, mut exact_edges, mut largest_translation) = (0, 0, 0.0f64);
        for (h, t) in self.mesh.interior_edges() {
            let (translation, error) = self.translation(h, t, &mut found);
            edges += 1;
            exact_edges += usize::from(error == 0.0);
            largest_translation =
                translation.iter().fold(largest_translation, |m, x| m.max(x.abs()));
        }
        let is_cone = |&v: &u32| self.interior_index(v).is_some_and(|index| index != 0);
        let cones: Vec<u32> = self.mesh.vertices().filter(is_cone).collect();
        for &vertex in &cones {
            self.grid_point(vertex, &mut found, |uv| Violation::FractionalCone { vertex, uv });
        }
        let aligned = self.edges_between(aligned).0;
        for &edge in &aligned.edges {
            self.isoline(edge, &mut found);
        }
        let is_corner = |v: &u32| !is_cone(v) && self.is_turning_point(*v, &aligned);
        let corners: Vec<u32> = self.mesh.vertices().filter(is_corner).collect();
        for &vertex in &corners {
            self.grid_point(vertex, &mut found, |uv| Violation::FractionalCorner { vertex, uv });
        }
        Violations::unless_none(found.violations)?;
        let faces = 0..self.mesh.n_faces();
        Ok(IntegerCertificate {
            edges,
            exact_edges,
            integral_cones: cones.len(),
            isoline_edges: aligned.edges.len(),
            integral_corners: corners.len(),
            integral_error: found.error,
            largest_translation,
            area: area(faces.map(|f| self.face_corners(f).map(|corner| self.uv(corner)))),
        })
    }

    /// Looks at the translation across an interior edge; it and its largest distance from integers at an end of the
    /// edge, 0 if it is exact in doubles.
    fn translation(&self, h: usize, t: usize, found: &mut Found) -> (Point, f64) {
        let ends = [(h, self.mesh.next(t)), (self.mesh.next(h), t)];
        let [first, second] = ends.map(|(left, right)| {
            let (left, right) = (turned(self.uv(left), self.quarters(h)), self.uv(right));
            [0, 1].map(|k| exact_difference(right[k], left[k]))
        });
        let nearest = first.map(|[rounded, _]| rounded.round());
        let off = |end: [[f64; 2]; 2]| {
            let parts = end.into_iter().zip(nearest);
            parts.map(|([rounded, rest], x)| (rounded - x).abs() + rest.abs()).fold(0.0, f64::max)
        };
        let error = off(first).max(off(second));
        if !found.allows(error) {
            let (vertices, faces) = (self.mesh.ends(h), [h, t].map(Manifold::<3>::face));
            let is_exact = first == second && first.iter().all(|[_, rest]| *rest == 0.0);
            let is_rounding = found.tolerance == 0.0 && error < IntegralTolerance::LARGEST;
            found.violations.push(if is_rounding && !is_exact {
                Violation::InexactEdge { vertices, faces }
            } else {
                let translation = first.map(|[rounded, _]| rounded);
                Violation::FractionalTranslation { vertices, faces, translation }
            });
        }
        (nearest, error)
    }

    /// Looks at a vertex that has to be a grid point in every face around it.
    fn grid_point(
        &self,
        vertex: u32,
        found: &mut Found,
        violation: impl FnOnce(Point) -> Violation,
    ) {
        let off = |uv: &Point| from_integer(uv[0]).max(from_integer(uv[1]));
        let places = self.mesh.fan(vertex).map(|corner| self.uv(corner));
        let Some(worst) = places.max_by(|a, b| off(a).total_cmp(&off(b))) else { return };
        if !found.allows(off(&worst)) {
            found.violations.push(violation(worst));
        }
    }

    /// Looks at an aligned edge, which on both of its sides has to lie on an isoline at an integer.
    fn isoline(&self, edge: usize, found: &mut Found) {
        for side in std::iter::once(edge).chain(self.mesh.twin(edge)) {
            let [a, b] = [side, self.mesh.next(side)].map(|corner| self.uv(corner));
            let off = |k: usize| match a[k].round() == b[k].round() {
                true => from_integer(a[k]).max(from_integer(b[k])),
                false => f64::INFINITY,
            };
            let off = off(0).min(off(1));
            if within(off, found.tolerance) {
                found.error = found.error.max(off);
            } else {
                let (vertices, face) = (self.mesh.ends(edge), Manifold::<3>::face(side));
                found.violations.push(Violation::OffIsoline { vertices, face });
                break;
            }
        }
    }
}

/// What was found of the integers of a map so far.
struct Found {
    /// Allowed distance from an integer.
    tolerance: f64,
    /// Largest distance from an integer.
    error: f64,
    violations: Vec<Violation>,
}

impl Found {
    /// Whether a distance from an integer is allowed.
    fn allows(&mut self, distance: f64) -> bool {
        self.error = self.error.max(distance);
        within(distance, self.tolerance)
    }
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
