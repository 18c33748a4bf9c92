//! The certificate of a seamless map.

use crate::manifold::Manifold;
use crate::map::Map;
use crate::plane::{InUnit, angle, difference, length, turned};
use crate::tolerance::{Tolerance, within};
use crate::violation::{Violation, Violations};
use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_2;

/// Units in the last place of the largest coordinate of its four ends by which a seam may be open: each
/// image of an edge is a difference of two coordinates that were rounded, scaled and moved. The maps of
/// Seamstress need up to 5.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// An interior vertex whose angle is not a full turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Cone {
    /// The vertex.
    pub vertex: u32,
    /// Field index in quarters: angle `(4 - index) pi / 2`; positive for fewer than four quads.
    pub index: i32,
}

/// An interior edge across which the UVs jump.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Seam {
    /// The corner at which its half-edge in the face on the left starts: three per face.
    pub left: u32,
    /// Ends of the edge.
    pub vertices: [u32; 2],
    /// Quarter turns from left to right, 0 to 3: `uv_right = i^matching uv_left + translation`.
    pub matching: i32,
    /// Translation from left to right, UV units.
    pub translation: [f64; 2],
}

/// What was checked, and what was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Certificate {
    /// Triangles, all of positive orientation by an exact test on the given numbers.
    pub faces: usize,
    /// Interior edges with a jump.
    pub seam_edges: usize,
    /// Largest seam mismatch, in lengths of the edge that does not fit: of the longer of its two images.
    pub seam_residual: f64,
    /// Largest error of an interior angle sum, radians.
    pub angle_error: f64,
    /// Number of cones.
    pub cones: usize,
    /// Sum of the indices over all components, quarters; 4 chi.
    pub index_sum: f64,
    /// Euler characteristic.
    pub euler_characteristic: i64,
    /// Boundary vertices around which the map turns by more than a full turn, by an exact test: it is not
    /// locally injective there.
    pub overwound_boundary_vertices: usize,
}

/// What a seamless map is made of.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Seamless {
    /// Interior vertices with an angle other than a full turn, ascending.
    pub cones: Vec<Cone>,
    /// Interior edges across which the UVs jump.
    pub seams: Vec<Seam>,
    /// The figures.
    pub certificate: Certificate,
}

/// How the two images of an edge fit.
struct Fit {
    /// The larger of the lengths of the two images. Like the other lengths it is in a unit of the edge's own.
    length: f64,
    /// What the turned left image lacks to the right one.
    mismatch: f64,
    /// The rounding of the four ends.
    rounding: f64,
    /// Length of the translation.
    shift: f64,
    /// From left to right, UV units.
    translation: [f64; 2],
}

impl Map<'_> {
    /// Certifies that the map is seamless: every triangle of positive orientation, by an exact test; the two images
    /// of every interior edge equal up to a quarter turn and a shift; around every interior vertex a positive number
    /// of quarter turns; indices that add up to 4χ on every component.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn seamless(&self, tolerance: &Tolerance) -> Result<Seamless, Violations> {
        let mut violations: Vec<_> =
            (0..self.mesh.n_faces()).filter_map(|face| self.misoriented(face)).collect();
        let (seams, seam_residual) = self.seams(tolerance.seam(), &mut violations);
        let (cones, angle_error) = self.cones(tolerance.angle(), &mut violations);
        let (index_sum, euler_characteristic) = self.indices(&mut violations);
        Violations::unless_none(violations)?;
        let boundary = self.mesh.vertices().filter(|&v| self.mesh.is_boundary(v));
        let certificate = Certificate {
            faces: self.mesh.n_faces(),
            seam_edges: seams.len(),
            seam_residual,
            angle_error,
            cones: cones.len(),
            index_sum,
            euler_characteristic,
            overwound_boundary_vertices: boundary.filter(|&v| self.turning(v).1).count(),
        };
        Ok(Seamless { cones, seams, certificate })
    }

    fn misoriented(&self, face: usize) -> Option<Violation> {
        let number = face as u32;
        match self.orientation(face) {
            Ordering::Greater => None,
            Ordering::Equal => Some(Violation::CollapsedTriangle { face: number }),
            Ordering::Less => Some(Violation::FlippedTriangle { face: number }),
        }
    }

    /// How the image of an edge in the face of a half-edge fits that in the face of its twin.
    fn fit(&self, h: usize, t: usize) -> Fit {
        let ends = self.images(h, t);
        let [a, b, c, d] = ends.points;
        let (left, right) = (difference(b, a), difference(d, c));
        let translation = difference(c, turned(a, self.quarters(h)));
        Fit {
            length: length(left).max(length(right)),
            mismatch: length(difference(right, turned(left, self.quarters(h)))),
            rounding: ROUNDING * ends.reach(),
            shift: length(translation),
            translation: ends.in_given_unit(translation),
        }
    }

    fn seams(&self, tolerance: f64, violations: &mut Vec<Violation>) -> (Vec<Seam>, f64) {
        let mut seams = Vec::new();
        let mut largest = 0.0f64;
        for (h, t) in self.mesh.interior_edges() {
            let fit = self.fit(h, t);
            // An image that is collapsed is a violation by itself; the other one counts then.
            let residual = if fit.length > 0.0 { fit.mismatch / fit.length } else { 0.0 };
            let allowed = tolerance * fit.length + fit.rounding;
            let vertices = self.mesh.ends(h);
            largest = largest.max(residual);
            if !within(fit.mismatch, allowed) || !within(residual, Tolerance::LARGEST_SEAM) {
                let faces = [h, t].map(Manifold::<3>::face);
                violations.push(Violation::OpenSeam { vertices, faces, residual });
            }
            let matching = self.quarters(h).rem_euclid(4);
            if matching != 0 || fit.shift > allowed {
                let translation = fit.translation;
                seams.push(Seam { left: h as u32, vertices, matching, translation });
            }
        }
        (seams, largest)
    }

    /// The sum of the angles at every vertex, radians; those of a flipped triangle are negative.
    fn angle_sums(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.mesh.vertices().count()];
        for face in 0..self.mesh.n_faces() {
            let corners = self.face_corners(face);
            let at = InUnit::new(corners.map(|corner| self.uv(corner))).points;
            for (k, corner) in corners.into_iter().enumerate() {
                let [next, prev] = [(k + 1) % 3, (k + 2) % 3].map(|j| difference(at[j], at[k]));
                sums[self.mesh.origin(corner) as usize] += angle(next, prev);
            }
        }
        sums
    }

    /// The cones of the map, and the largest error of an interior angle.
    fn cones(&self, tolerance: f64, violations: &mut Vec<Violation>) -> (Vec<Cone>, f64) {
        let angles = self.angle_sums();
        let (mut cones, mut error) = (Vec::new(), 0.0f64);
        for vertex in self.mesh.vertices() {
            let Some(index) = self.interior_index(vertex) else { continue };
            let (angle, turns) = (angles[vertex as usize], f64::from(4 - index));
            let off = (angle - turns * FRAC_PI_2).abs();
            error = error.max(off);
            if !within(off, tolerance) || turns < 1.0 {
                violations.push(Violation::ConeAngle { vertex, quarters: angle / FRAC_PI_2 });
            }
            if index != 0 {
                cones.push(Cone { vertex, index });
            }
        }
        (cones, error)
    }

    /// The index of a vertex off the boundary, by the exact number of its quarter turns.
    pub(crate) fn interior_index(&self, vertex: u32) -> Option<i32> {
        let is_interior = !self.mesh.is_boundary(vertex) && self.mesh.fan(vertex).next().is_some();
        is_interior.then(|| 4 - self.turning(vertex).0)
    }

    /// The sum of all indices, and the Euler characteristic; on every component the former is four times the latter.
    /// At the boundary, what edges lack to the next axis counts at one end and against it at the other.
    fn indices(&self, violations: &mut Vec<Violation>) -> (f64, i64) {
        let (component_of, characteristics) = self.mesh.components();
        let mut sums = vec![0i64; characteristics.len()];
        for vertex in self.mesh.vertices() {
            let Some(corner) = self.mesh.fan(vertex).next() else { continue };
            let regular = if self.mesh.is_boundary(vertex) { 2 } else { 4 };
            sums[component_of[corner / 3]] += i64::from(regular - self.turning(vertex).0);
        }
        for (component, (&sum, chi)) in sums.iter().zip(&characteristics).enumerate() {
            if sum != 4 * chi {
                let (sum, expected) = (sum as f64, 4 * chi);
                violations.push(Violation::PoincareHopf { component, sum, expected });
            }
        }
        (sums.iter().sum::<i64>() as f64, characteristics.iter().sum())
    }
}
