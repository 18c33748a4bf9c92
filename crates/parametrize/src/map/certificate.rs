//! The certificate of a seamless map.

use super::exact::{InUnit, Point};
use super::fan::is_overwound;
use super::tolerance::Tolerance;
use super::violation::{Violation, Violations};
use crate::quarter::{direction, turn, within};
use seamstress_mesh::{Halfedge, TriMesh, Vertex, VertexData};
use std::f64::consts::{FRAC_PI_2, PI};

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
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct SeamEdge {
    /// Left half-edge; its twin is on the right.
    #[serde(skip)]
    pub left: Halfedge,
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

/// A locally injective, seamless map with cones at multiples of a quarter turn.
///
/// It can only be had by passing [`SeamlessMap::certify`], so whoever holds one needs no further check.
#[derive(Debug, Clone)]
pub struct SeamlessMap {
    corner_uvs: Vec<[f64; 2]>,
    cones: Vec<Cone>,
    seams: Vec<SeamEdge>,
    certificate: Certificate,
}

impl SeamlessMap {
    /// Checks a map given by one UV per corner (three per face, in the faces' order): finite UVs; every triangle of
    /// positive orientation, by an exact test; the two images of every interior edge equal up to a quarter turn and a
    /// shift; every interior angle sum a multiple of a quarter turn; indices that add up to 4χ on every component.
    ///
    /// See `docs/theory/03-certificate.md` for the tolerances.
    ///
    /// # Errors
    /// Every violation, each naming its element.
    pub fn certify(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        let (expected, found) = (mesh.n_halfedges(), corner_uvs.len());
        if expected != found {
            return Err(Violations(vec![Violation::UvCount { expected, found }]));
        }
        let check = Check::new(mesh, &corner_uvs);
        if !check.violations.is_empty() {
            return Err(Violations(check.violations));
        }
        let (seams, cones, certificate) = check.run(tolerance)?;
        Ok(Self { corner_uvs, cones, seams, certificate })
    }

    /// One UV per corner, three per face.
    pub fn corner_uvs(&self) -> &[[f64; 2]] {
        &self.corner_uvs
    }

    /// Interior vertices with an angle other than a full turn, ascending.
    pub fn cones(&self) -> &[Cone] {
        &self.cones
    }

    /// Interior edges across which the UVs jump.
    pub fn seams(&self) -> &[SeamEdge] {
        &self.seams
    }

    /// The figures of the certificate.
    pub fn certificate(&self) -> &Certificate {
        &self.certificate
    }
}

struct Check<'a> {
    mesh: &'a TriMesh,
    corner_uvs: &'a [Point],
    violations: Vec<Violation>,
}

/// How the two images of an edge fit.
struct Fit {
    /// The nearest number of quarter turns from left to right.
    quarters: i32,
    /// The larger of the lengths of the two images. Like the other lengths it is in a unit of the edge's own.
    length: f64,
    /// What the rotated left image lacks to the right one.
    mismatch: f64,
    /// The rounding of the four ends.
    rounding: f64,
    /// Length of the translation.
    shift: f64,
    /// From left to right, UV units.
    translation: Point,
}

impl<'a> Check<'a> {
    fn new(mesh: &'a TriMesh, corner_uvs: &'a [Point]) -> Self {
        let violations = mesh
            .faces()
            .filter(|f| f.halfedges().iter().any(|h| !is_finite(corner_uvs[h.at()])))
            .map(|f| Violation::NonFiniteUv { face: f.0 })
            .collect();
        Self { mesh, corner_uvs, violations }
    }

    fn run(
        mut self,
        tolerance: &Tolerance,
    ) -> Result<(Vec<SeamEdge>, Vec<Cone>, Certificate), Violations> {
        self.check_orientation();
        let (seams, seam_residual) = self.check_seams(tolerance.seam());
        let (cones, angle_error, index_sum) = self.check_indices(tolerance.angle());
        if !self.violations.is_empty() {
            return Err(Violations(self.violations));
        }
        let certificate = Certificate {
            faces: self.mesh.n_faces(),
            seam_edges: seams.len(),
            seam_residual,
            angle_error,
            cones: cones.len(),
            index_sum,
            euler_characteristic: self.mesh.euler_characteristic(),
            overwound_boundary_vertices: self.overwound(),
        };
        Ok((seams, cones, certificate))
    }

    /// The images of corners in a unit of their own.
    fn corners<const N: usize>(&self, corners: [Halfedge; N]) -> InUnit<N> {
        InUnit::new(corners.map(|h| self.corner_uvs[h.at()]))
    }

    fn check_orientation(&mut self) {
        for f in self.mesh.faces() {
            let orientation = self.corners(f.halfedges()).orientation();
            if orientation < 0.0 {
                self.violations.push(Violation::FlippedTriangle { face: f.0 });
            } else if orientation == 0.0 || orientation.is_nan() {
                self.violations.push(Violation::CollapsedTriangle { face: f.0 });
            }
        }
    }

    /// How the image of an edge left of a half-edge fits the one right of it.
    fn fit(&self, h: Halfedge, t: Halfedge) -> Fit {
        let ends = self.corners([h, h.next(), t.next(), t]);
        let [a, b, c, d] = ends.points;
        let (left, right) = (b - a, d - c);
        let between = direction(right) * direction(left).conj();
        let quarters = (between.arg() / FRAC_PI_2).round() as i32;
        let translation = c - turn(a, quarters);
        Fit {
            quarters,
            length: left.norm().max(right.norm()),
            mismatch: (right - turn(left, quarters)).norm(),
            rounding: ROUNDING * ends.reach(),
            shift: translation.norm(),
            translation: ends.in_given_unit(translation),
        }
    }

    fn check_seams(&mut self, tolerance: f64) -> (Vec<SeamEdge>, f64) {
        let mut seams = Vec::new();
        let mut largest = 0.0f64;
        for h in self.mesh.interior_edges() {
            let Some(t) = self.mesh.twin(h) else { continue };
            let fit = self.fit(h, t);
            // An image that is collapsed is a violation by itself; the other one counts then.
            let residual = if fit.length > 0.0 { fit.mismatch / fit.length } else { 0.0 };
            let allowed = tolerance * fit.length + fit.rounding;
            let vertices = [self.mesh.origin(h).0, self.mesh.tip(h).0];
            largest = largest.max(residual);
            if !within(fit.mismatch, allowed) || !within(residual, Tolerance::LARGEST_SEAM) {
                let faces = [h.face().0, t.face().0];
                self.violations.push(Violation::OpenSeam { vertices, faces, residual });
            }
            if fit.quarters != 0 || fit.shift > allowed {
                let matching = fit.quarters.rem_euclid(4);
                let translation = fit.translation;
                seams.push(SeamEdge { left: h, vertices, matching, translation });
            }
        }
        (seams, largest)
    }

    /// The sum of the angles at every vertex, radians; those of a flipped triangle are negative.
    fn angle_sums(&self) -> VertexData<f64> {
        let mut sums = VertexData::filled(self.mesh.n_vertices(), 0.0);
        for f in self.mesh.faces() {
            let corners = f.halfedges();
            let at = self.corners(corners).points;
            for k in 0..3 {
                let [here, next, prev] = [at[k], at[(k + 1) % 3], at[(k + 2) % 3]];
                let w = (next - here).conj() * (prev - here);
                sums[self.mesh.origin(corners[k])] += w.im.atan2(w.re);
            }
        }
        sums
    }

    fn check_indices(&mut self, tolerance: f64) -> (Vec<Cone>, f64, f64) {
        let angle = self.angle_sums();
        let (labels, n_components) = self.mesh.connected_faces();
        let mut sums = vec![0.0; n_components];
        let mut characteristic = vec![0i64; n_components];
        for f in self.mesh.faces() {
            characteristic[labels[f] as usize] += 1;
        }
        for h in self.mesh.edges() {
            characteristic[labels[h.face()] as usize] -= 1;
        }
        let (mut cones, mut error) = (Vec::new(), 0.0f64);
        for v in self.mesh.vertices() {
            let Some(h) = self.mesh.outgoing(v).next() else {
                continue;
            };
            let component = labels[h.face()] as usize;
            characteristic[component] += 1;
            sums[component] += if self.mesh.is_boundary(v) {
                (PI - angle[v]) / FRAC_PI_2
            } else {
                self.interior_index(v, angle[v], tolerance, &mut cones, &mut error)
            };
        }
        for (component, (&sum, chi)) in sums.iter().zip(characteristic).enumerate() {
            let expected = 4 * chi;
            // The boundary's share is a sum of angles; all the rest are integers.
            if !within((sum - expected as f64).abs(), 0.5) {
                self.violations.push(Violation::PoincareHopf { component, sum, expected });
            }
        }
        (cones, error, sums.iter().sum())
    }

    fn interior_index(
        &mut self,
        v: Vertex,
        angle: f64,
        tolerance: f64,
        cones: &mut Vec<Cone>,
        error: &mut f64,
    ) -> f64 {
        let quarters = angle / FRAC_PI_2;
        let nearest = quarters.round();
        let off = (angle - nearest * FRAC_PI_2).abs();
        *error = error.max(off);
        if !within(off, tolerance) || nearest < 1.0 {
            self.violations.push(Violation::ConeAngle { vertex: v.0, quarters });
        }
        let index = 4 - nearest as i32;
        if index != 0 {
            cones.push(Cone { vertex: v.0, index });
        }
        f64::from(index)
    }

    /// The number of boundary vertices around which a map without violations turns by more than a full
    /// turn.
    fn overwound(&self) -> usize {
        let across = |h| self.mesh.twin(h).map_or(0, |t| self.fit(h, t).quarters);
        let boundary = self.mesh.vertices().filter(|&v| self.mesh.is_boundary(v));
        boundary.filter(|&v| is_overwound(self.mesh, self.corner_uvs, across, v)).count()
    }
}

fn is_finite(uv: Point) -> bool {
    uv.iter().all(|x| x.is_finite())
}
