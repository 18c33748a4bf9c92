//! The certificate of a seamless map.

use crate::map::Map;
use crate::plane::{difference, largest, length, scaled, turned};
use crate::verdict::{ANGLE, Checked, Tolerance, Violation, Violations};
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
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
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
pub struct Seamless {
    /// Interior vertices with an angle other than a full turn, ascending.
    pub cones: Vec<Cone>,
    /// Interior edges across which the UVs jump.
    pub seams: Vec<Seam>,
    /// The figures.
    pub certificate: Certificate,
}

impl Map<'_> {
    /// Certifies that the map is seamless: every triangle of positive orientation, by an exact test; the two images
    /// of every interior edge equal up to a quarter turn and a shift; around every interior vertex a positive number
    /// of quarter turns; indices that add up to 4χ on every component.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn seamless(&self, tolerance: &Tolerance) -> Checked<Seamless> {
        let faces = self.uvs.len() / 3;
        let misoriented = |face: u32| match self.orientation(face as usize) {
            Ordering::Greater => None,
            Ordering::Equal => Some(Violation::CollapsedTriangle { face }),
            Ordering::Less => Some(Violation::FlippedTriangle { face }),
        };
        let mut violations: Vec<_> = (0..faces as u32).filter_map(misoriented).collect();
        let (seams, seam_residual) = self.seams(tolerance, &mut violations);
        let mut figures = Certificate { faces, seam_residual, ..Certificate::default() };
        let (component_of, components) = self.mesh.components();
        let mut index_sums = vec![0i64; components.len()];
        let mut cones = Vec::new();
        for star in self.mesh.stars() {
            let (turned, is_overwound) = self.turning(&star);
            // At the boundary, what edges lack to the next axis counts at one end and against it at the other.
            let index = if star.is_closed { 4 } else { 2 } - turned;
            index_sums[component_of[star.corners[0] / 3]] += i64::from(index);
            figures.overwound_boundary_vertices += usize::from(is_overwound);
            if !star.is_closed {
                continue;
            }
            let (vertex, quarters) = (star.vertex, self.angle_sum(&star.corners));
            let off = (quarters - f64::from(turned)).abs() * FRAC_PI_2;
            figures.angle_error = figures.angle_error.max(off);
            let is_wrong = !(off <= ANGLE && turned >= 1);
            violations.extend(is_wrong.then_some(Violation::ConeAngle { vertex, quarters }));
            cones.extend((index != 0).then_some(Cone { vertex, index }));
        }
        for (component, (&sum, (chi, _))) in index_sums.iter().zip(&components).enumerate() {
            let (sum, expected) = (sum as f64, 4 * chi);
            if sum != expected as f64 {
                violations.push(Violation::PoincareHopf { component, sum, expected });
            }
            figures.index_sum += sum;
            figures.euler_characteristic += chi;
        }
        Violations::unless_none(violations)?;
        (figures.cones, figures.seam_edges) = (cones.len(), seams.len());
        Ok(Seamless { cones, seams, certificate: figures })
    }

    /// The edges across which the map jumps, and the largest mismatch.
    fn seams(&self, tolerance: &Tolerance, violations: &mut Vec<Violation>) -> (Vec<Seam>, f64) {
        let (mut seams, mut worst) = (Vec::new(), 0.0f64);
        for (h, t) in self.mesh.interior_edges() {
            let (ends, factor) = scaled(self.images(h, t));
            let [a, b, c, d] = ends;
            let (left, right) = (difference(b, a), difference(d, c));
            let longer = length(left).max(length(right));
            let mismatch = length(difference(right, turned(left, self.quarters[h])));
            let translation = difference(c, turned(a, self.quarters[h]));
            // An image that is collapsed is a violation by itself; the other one counts then.
            let residual = if longer > 0.0 { mismatch / longer } else { 0.0 };
            let allowed = tolerance.seams * longer + ROUNDING * largest(&ends);
            let vertices = self.mesh.ends(h);
            worst = worst.max(residual);
            if !(mismatch <= allowed && residual <= Tolerance::LARGEST.seams) {
                let faces = [h, t].map(|h| (h / 3) as u32);
                violations.push(Violation::OpenSeam { vertices, faces, residual });
            }
            let matching = self.quarters[h].rem_euclid(4);
            if matching != 0 || length(translation) > allowed {
                let translation = translation.map(|x| x / factor);
                seams.push(Seam { left: h as u32, vertices, matching, translation });
            }
        }
        (seams, worst)
    }
}
