//! The certificate of an integer-grid map.

use crate::area::area;
use crate::isolines::turning_points;
use num_complex::Complex64;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Halfedge, TriMesh, Vertex};
use seamstress_parametrize::map::{
    Alignment, AlignmentTolerance, SeamlessMap, Tolerance, ToleranceError, Violation, Violations,
};
use seamstress_parametrize::quarter::{direction, turn, within};
use std::f64::consts::FRAC_PI_2;

/// How far from an integer may be what has to be integral, grid units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegralTolerance(f64);

impl IntegralTolerance {
    /// Integers are integers, and the two images of an edge fit to the last bit.
    pub const EXACT: Self = Self(0.0);
    /// Largest distance that can be allowed: a hundredth of a cell, as much as a seam may be open by in
    /// lengths of an edge. A number that has nothing to do with integers is that close to one in one of 50
    /// cases, and no map is without a dozen of them.
    pub const LARGEST: f64 = 0.01;

    /// A tolerance for maps written with few digits.
    ///
    /// # Errors
    /// A value below 0 or above [`IntegralTolerance::LARGEST`].
    pub fn new(distance: f64) -> Result<Self, ToleranceError> {
        ToleranceError::unless_within(distance, Self::LARGEST, "integers", "grid units").map(Self)
    }

    /// Grid units; 0 is [`IntegralTolerance::EXACT`].
    pub fn distance(self) -> f64 {
        self.0
    }
}

/// What was checked beyond the certificate of the seamless map, and what was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IntegerCertificate {
    /// Interior edges, all with an integer translation.
    pub edges: usize,
    /// Those of them across which a quarter turn and the integer translation are exact in doubles: all of an
    /// [`IntegerGridMap`].
    pub exact_edges: usize,
    /// Cones, all of them at grid points in every face around them.
    pub integral_cones: usize,
    /// Aligned edges, both ends of all of them at the same integer on either side.
    pub isoline_edges: usize,
    /// Vertices without a cone at which aligned edges turn, all of them at grid points.
    pub integral_corners: usize,
    /// Largest distance from an integer of what is integral, grid units: 0 of an [`IntegerGridMap`].
    pub integral_error: f64,
    /// The largest coordinate of a translation.
    pub largest_translation: f64,
    /// Area in the plane, grid units: the number of quads, exactly, of a mesh that is closed or whose boundary lies on
    /// grid lines.
    pub area: f64,
}

impl IntegerCertificate {
    /// Checks that a seamless map in grid units, of any program, is an integer-grid map: translations
    /// across edges and the places of cones are integers, and the two ends of every aligned edge lie at the
    /// same integer on either side, with grid points where these edges turn.
    ///
    /// Whether the edges, given by their end vertices, run along the axes at all is for [`Alignment::certify`]
    /// to say.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn check(
        mesh: &TriMesh,
        map: &SeamlessMap,
        aligned: &[[u32; 2]],
        tolerance: IntegralTolerance,
    ) -> Result<Self, Violations> {
        let (expected, found) = (mesh.n_halfedges(), map.corner_uvs().len());
        if expected != found {
            return Err(Violations(vec![Violation::UvCount { expected, found }]));
        }
        let mut check = Check {
            mesh,
            uvs: map.corner_uvs(),
            tolerance: tolerance.distance(),
            violations: Vec::new(),
            error: 0.0,
        };
        let mut exact_edges = 0;
        let mut largest_translation = 0.0f64;
        for h in mesh.interior_edges() {
            let translation = check.translation(h);
            exact_edges += usize::from(translation.error == 0.0);
            largest_translation =
                translation.nearest.iter().fold(largest_translation, |m, x| m.max(x.abs()));
        }
        for cone in map.cones() {
            let vertex = cone.vertex;
            check.grid_point(Vertex(vertex), |uv| Violation::FractionalCone { vertex, uv });
        }
        let ends = aligned.iter().filter_map(|&[a, b]| mesh.edge_between(Vertex(a), Vertex(b)));
        let aligned = EdgeSet::new(mesh, ends);
        for &edge in aligned.edges() {
            check.isoline(edge);
        }
        let mut is_corner = turning_points(mesh, &aligned, |h| check.at(h));
        map.cones().iter().for_each(|cone| is_corner[Vertex(cone.vertex)] = false);
        let corners: Vec<Vertex> = mesh.vertices().filter(|&v| is_corner[v]).collect();
        for &Vertex(vertex) in &corners {
            check.grid_point(Vertex(vertex), |uv| Violation::FractionalCorner { vertex, uv });
        }
        if !check.violations.is_empty() {
            return Err(Violations(check.violations));
        }
        Ok(Self {
            edges: mesh.interior_edges().count(),
            exact_edges,
            integral_cones: map.cones().len(),
            isoline_edges: aligned.len(),
            integral_corners: corners.len(),
            integral_error: check.error,
            largest_translation,
            area: area(mesh.faces().map(|f| f.halfedges().map(|h| check.at(h)))),
        })
    }
}

/// A seamless map whose grid of unit squares closes up over the whole surface.
///
/// Translations between the two sides of every edge and the positions of cones are integers, and the quarter
/// turns are exact, all of it in the doubles themselves. It can only be had by passing
/// [`IntegerGridMap::certify`].
///
/// Two cones are never closer than one grid unit along the surface: a straight line between them is laid
/// out without a flip as a segment between grid points that is not a point.
#[derive(Debug, Clone)]
pub struct IntegerGridMap {
    map: SeamlessMap,
    certificate: IntegerCertificate,
}

impl IntegerGridMap {
    /// Checks a map given by one UV per corner, in grid units.
    ///
    /// # Errors
    /// Every violation, each naming its element: those of [`SeamlessMap::certify`] first, and if there
    /// are none, edges that do not fit to the last bit and what is not integral.
    pub fn certify(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        Self::certify_aligned(mesh, corner_uvs, &[], tolerance)
    }

    /// Checks a map, in grid units, whose isolines at integers hold edges given by their end vertices.
    ///
    /// Beyond everything [`IntegerGridMap::certify`] checks, on either side of each such edge both ends have the
    /// same integer as one coordinate, and where these edges turn they are at a grid point. The grid's quads
    /// then have these edges along theirs.
    ///
    /// # Errors
    /// As [`IntegerGridMap::certify`], and those of [`Alignment::certify`].
    pub fn certify_aligned(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        aligned: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        let map = SeamlessMap::certify(mesh, corner_uvs, tolerance)?;
        Alignment::certify(mesh, &map, aligned, &AlignmentTolerance::default())?;
        let certificate = IntegerCertificate::check(mesh, &map, aligned, IntegralTolerance::EXACT)?;
        Ok(Self { map, certificate })
    }

    /// The seamless map; UVs in grid units.
    pub fn seamless(&self) -> &SeamlessMap {
        &self.map
    }

    /// One UV per corner, three per face, in grid units.
    pub fn corner_uvs(&self) -> &[[f64; 2]] {
        self.map.corner_uvs()
    }

    /// The figures of the certificate beyond those of the seamless map.
    pub fn certificate(&self) -> &IntegerCertificate {
        &self.certificate
    }
}

struct Check<'a> {
    mesh: &'a TriMesh,
    uvs: &'a [[f64; 2]],
    /// Allowed distance from an integer.
    tolerance: f64,
    violations: Vec<Violation>,
    /// Largest distance from an integer.
    error: f64,
}

/// A translation across an edge, from the left of a half-edge to its right.
struct Translation {
    nearest: [f64; 2],
    /// Largest distance from it at an end of the edge; 0 if it is exact in doubles.
    error: f64,
}

impl Check<'_> {
    fn at(&self, h: Halfedge) -> Complex64 {
        let [u, v] = self.uvs[h.at()];
        Complex64::new(u, v)
    }

    /// Looks at the translation across an interior edge.
    fn translation(&mut self, h: Halfedge) -> Translation {
        let Some(t) = self.mesh.twin(h) else {
            return Translation { nearest: [0.0; 2], error: 0.0 };
        };
        let (a, b) = (self.at(h), self.at(h.next()));
        let (c, d) = (self.at(t.next()), self.at(t));
        let between = direction(d - c) * direction(b - a).conj();
        let quarters = (between.arg() / FRAC_PI_2).round() as i32;
        let [first, second] =
            [(a, c), (b, d)].map(|(left, right)| differences(right, turn(left, quarters)));
        let nearest = first.map(|[rounded, _]| rounded.round());
        let off = |end: [[f64; 2]; 2]| {
            let parts = end.into_iter().zip(nearest);
            parts.map(|([rounded, rest], x)| (rounded - x).abs() + rest.abs()).fold(0.0, f64::max)
        };
        let error = off(first).max(off(second));
        self.error = self.error.max(error);
        if !within(error, self.tolerance) {
            let vertices = [self.mesh.origin(h).0, self.mesh.tip(h).0];
            let faces = [h.face().0, t.face().0];
            let is_exact = first == second && first.iter().all(|[_, rest]| *rest == 0.0);
            let is_rounding = self.tolerance == 0.0 && error < IntegralTolerance::LARGEST;
            self.violations.push(if is_rounding && !is_exact {
                Violation::InexactEdge { vertices, faces }
            } else {
                let translation = first.map(|[rounded, _]| rounded);
                Violation::FractionalTranslation { vertices, faces, translation }
            });
        }
        Translation { nearest, error }
    }

    /// Looks at a vertex that has to be a grid point in every face around it.
    fn grid_point(&mut self, v: Vertex, violation: impl FnOnce([f64; 2]) -> Violation) {
        let off = |&[u, v]: &[f64; 2]| from_integer(u).max(from_integer(v));
        let places = self.mesh.outgoing(v).map(|h| self.uvs[h.at()]);
        let Some(worst) = places.max_by(|a, b| off(a).total_cmp(&off(b))) else { return };
        self.error = self.error.max(off(&worst));
        if !within(off(&worst), self.tolerance) {
            self.violations.push(violation(worst));
        }
    }

    /// Looks at an aligned edge, which on both of its sides has to lie on an isoline at an integer.
    fn isoline(&mut self, edge: Halfedge) {
        for side in std::iter::once(edge).chain(self.mesh.twin(edge)) {
            let [a, b] = [side, side.next()].map(|corner| self.uvs[corner.at()]);
            let off = |k: usize| match a[k].round() == b[k].round() {
                true => from_integer(a[k]).max(from_integer(b[k])),
                false => f64::INFINITY,
            };
            let off = off(0).min(off(1));
            if within(off, self.tolerance) {
                self.error = self.error.max(off);
            } else {
                let vertices = [self.mesh.origin(edge).0, self.mesh.tip(edge).0];
                self.violations.push(Violation::OffIsoline { vertices, face: side.face().0 });
                break;
            }
        }
    }
}

/// `a - b` in both coordinates, each as the nearest double and what it lacks.
fn differences(a: Complex64, b: Complex64) -> [[f64; 2]; 2] {
    [difference(a.re, b.re), difference(a.im, b.im)]
}

/// `a - b` as the nearest double and what it lacks (Knuth's two-sum).
fn difference(a: f64, b: f64) -> [f64; 2] {
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
        assert_eq!(difference(0.75, 0.25), [0.5, 0.0]);
        assert_eq!(difference(3.0 + 0.5f64.powi(40), 0.5f64.powi(40)), [3.0, 0.0]);
        assert_eq!(difference(1.0, 1e-30), [1.0, -1e-30]);
        assert_eq!(difference(1e-30, 1.0), [-1.0, 1e-30]);
        assert!(difference(1000.1, 0.1)[1] != 0.0);
    }

    #[test]
    fn tolerances_have_a_ceiling() {
        assert_eq!(IntegralTolerance::new(0.0), Ok(IntegralTolerance::EXACT));
        assert!(IntegralTolerance::new(0.01).is_ok());
        for distance in [-1e-9, 0.02, 0.5, f64::NAN] {
            assert!(IntegralTolerance::new(distance).is_err(), "{distance}");
        }
    }
}
