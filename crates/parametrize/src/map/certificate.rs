//! The certificate of a seamless map.

use super::violation::{Violation, Violations};
use crate::quarter::{turn, within};
use num_complex::Complex64;
use seamstress_mesh::{Halfedge, TriMesh, Vertex, VertexData};
use std::f64::consts::{FRAC_PI_2, PI};

/// How far rounding may take a map from exactness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Seam mismatch, in mean UV edge lengths. The rounding of the largest coordinate is allowed on top.
    pub seam: f64,
    /// Error of an angle sum, radians. A wrong sum is off by a quarter turn; needles lose digits.
    pub angle: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { seam: 1e-9, angle: 1e-3 }
    }
}

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
pub struct Certificate {
    /// Triangles, all of positive orientation by an exact test on the given numbers.
    pub faces: usize,
    /// Interior edges with a jump.
    pub seam_edges: usize,
    /// Largest seam mismatch, in mean UV edge lengths.
    pub seam_residual: f64,
    /// Largest error of an interior angle sum, radians.
    pub angle_error: f64,
    /// Number of cones.
    pub cones: usize,
    /// Sum of the indices over all components, quarters; 4 chi.
    pub index_sum: f64,
    /// Euler characteristic.
    pub euler_characteristic: i64,
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
    /// Checks a map given by one UV per corner (three per face, in the faces' order).
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
    /// UVs scaled by a power of two to order one, so that products neither overflow nor vanish.
    uv: Vec<Complex64>,
    /// Undoes the scaling.
    unit: f64,
    violations: Vec<Violation>,
}

impl<'a> Check<'a> {
    fn new(mesh: &'a TriMesh, corner_uvs: &[[f64; 2]]) -> Self {
        let violations = mesh
            .faces()
            .filter(|f| {
                corner_uvs[3 * f.at()..3 * f.at() + 3].iter().flatten().any(|x| !x.is_finite())
            })
            .map(|f| Violation::NonFiniteUv { face: f.0 })
            .collect();
        let span = corner_uvs.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let exponent = if span > 0.0 && span.is_finite() { span.log2().floor() } else { 0.0 };
        let exponent = exponent.clamp(-1000.0, 1000.0);
        let scale = (-exponent).exp2();
        let uv = corner_uvs.iter().map(|p| Complex64::new(p[0] * scale, p[1] * scale)).collect();
        Self { mesh, uv, unit: exponent.exp2(), violations }
    }

    fn edge(&self, h: Halfedge) -> Complex64 {
        self.uv[h.next().at()] - self.uv[h.at()]
    }

    fn run(
        mut self,
        tolerance: &Tolerance,
    ) -> Result<(Vec<SeamEdge>, Vec<Cone>, Certificate), Violations> {
        self.check_orientation();
        let (seams, seam_residual) = self.check_seams(tolerance.seam);
        let (cones, angle_error, index_sum) = self.check_indices(tolerance.angle);
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
        };
        Ok((seams, cones, certificate))
    }

    fn check_orientation(&mut self) {
        for f in self.mesh.faces() {
            let [a, b, c] = f.halfedges().map(|h| {
                let z = self.uv[h.at()];
                robust::Coord { x: z.re, y: z.im }
            });
            let orientation = robust::orient2d(a, b, c);
            if orientation < 0.0 {
                self.violations.push(Violation::FlippedTriangle { face: f.0 });
            } else if orientation == 0.0 || orientation.is_nan() {
                self.violations.push(Violation::CollapsedTriangle { face: f.0 });
            }
        }
    }

    fn check_seams(&mut self, tolerance: f64) -> (Vec<SeamEdge>, f64) {
        let edges = self.mesh.n_halfedges() as f64;
        let mean = self.mesh.halfedges().map(|h| self.edge(h).norm()).sum::<f64>() / edges;
        let span = self.uv.iter().map(|z| z.re.abs().max(z.im.abs())).fold(0.0, f64::max);
        let allowed = tolerance * mean + 16.0 * f64::EPSILON * span;
        let mut seams = Vec::new();
        let mut largest = 0.0f64;
        for h in self.mesh.interior_edges() {
            let Some(t) = self.mesh.twin(h) else { continue };
            let (left, right) = (self.edge(h), -self.edge(t));
            let quarters = ((right * left.conj()).arg() / FRAC_PI_2).round() as i32;
            let mismatch = (right - turn(left, quarters)).norm();
            let ends = [self.mesh.origin(h).0, self.mesh.tip(h).0];
            largest = largest.max(mismatch / mean);
            if !within(mismatch, allowed) {
                self.violations.push(Violation::OpenSeam {
                    vertices: ends,
                    faces: [h.face().0, t.face().0],
                    residual: mismatch / mean,
                });
            }
            let translation = self.uv[t.next().at()] - turn(self.uv[h.at()], quarters);
            if quarters != 0 || translation.norm() > allowed {
                seams.push(SeamEdge {
                    left: h,
                    vertices: ends,
                    matching: quarters.rem_euclid(4),
                    translation: [translation.re * self.unit, translation.im * self.unit],
                });
            }
        }
        (seams, largest)
    }

    fn check_indices(&mut self, tolerance: f64) -> (Vec<Cone>, f64, f64) {
        let mut angle = VertexData::filled(self.mesh.n_vertices(), 0.0);
        for h in self.mesh.halfedges() {
            let w = self.edge(h).conj() * -self.edge(h.prev());
            angle[self.mesh.origin(h)] += w.im.atan2(w.re);
        }
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
}

/// Compares a map's vertices and faces with its source; a map must not touch them.
///
/// Positions have to agree exactly: they are written with enough digits.
pub fn compare_source(
    source: (&[[f64; 3]], &[[u32; 3]]),
    map: (&[[f64; 3]], &[[u32; 3]]),
) -> Vec<Violation> {
    let mut violations = Vec::new();
    if source.0.len() != map.0.len() {
        violations.push(Violation::VertexCount { source_count: source.0.len(), map: map.0.len() });
    }
    if source.1.len() != map.1.len() {
        violations.push(Violation::FaceCount { source_count: source.1.len(), map: map.1.len() });
    }
    if !violations.is_empty() {
        return violations;
    }
    for (vertex, (a, b)) in source.0.iter().zip(map.0).enumerate() {
        if a != b {
            let distance = (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
            violations.push(Violation::MovedVertex { vertex: vertex as u32, distance });
        }
    }
    for (face, (a, b)) in source.1.iter().zip(map.1).enumerate() {
        if a != b {
            violations.push(Violation::ChangedFace { face: face as u32 });
        }
    }
    violations
}
