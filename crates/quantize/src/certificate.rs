//! The certificate of an integer map.

use super::isolines::turning_points;
use num_complex::Complex64;
use seamstress_mesh::features::EdgeSet;
use seamstress_mesh::{Halfedge, TriMesh, Vertex};
use seamstress_parametrize::map::{
    Alignment, AlignmentTolerance, SeamlessMap, Tolerance, Violation, Violations,
};
use seamstress_parametrize::quarter::turn;
use std::f64::consts::FRAC_PI_2;

/// What was checked beyond the certificate of the seamless map, and what was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IntegerCertificate {
    /// Interior edges, all with an exact quarter turn and an exact integer translation.
    pub exact_edges: usize,
    /// Cones, all of them at grid points in every face around them.
    pub integral_cones: usize,
    /// Aligned edges, both ends of all of them at the same integer on either side.
    pub isoline_edges: usize,
    /// Vertices without a cone at which aligned edges turn, all of them at grid points.
    pub integral_corners: usize,
    /// The largest coordinate of a translation.
    pub largest_translation: f64,
    /// Area in the plane, grid units: the number of quads of a closed mesh.
    pub area: f64,
}

/// A seamless map whose grid of unit squares closes up over the whole surface.
///
/// Translations between the two sides of every edge and the positions of cones are integers, and the quarter
/// turns are exact, all of it in the doubles themselves. It can only be had by passing
/// [`IntegerMap::certify`].
///
/// Two cones are never closer than one grid unit along the surface: a straight line between them is laid
/// out without a flip as a segment between grid points that is not a point.
#[derive(Debug, Clone)]
pub struct IntegerMap {
    map: SeamlessMap,
    certificate: IntegerCertificate,
}

impl IntegerMap {
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
    /// Beyond everything [`IntegerMap::certify`] checks, on either side of each such edge both ends have the
    /// same integer as one coordinate, and where these edges turn they are at a grid point. The grid's quads
    /// then have these edges along theirs.
    ///
    /// # Errors
    /// As [`IntegerMap::certify`], and those of [`Alignment::certify`].
    pub fn certify_aligned(
        mesh: &TriMesh,
        corner_uvs: Vec<[f64; 2]>,
        aligned: &[[u32; 2]],
        tolerance: &Tolerance,
    ) -> Result<Self, Violations> {
        let map = SeamlessMap::certify(mesh, corner_uvs, tolerance)?;
        Alignment::certify(mesh, &map, aligned, &AlignmentTolerance::default())?;
        let check = Check { mesh, uvs: map.corner_uvs() };
        let mut violations = Vec::new();
        let mut largest = 0.0f64;
        for h in mesh.interior_edges() {
            match check.translation(h) {
                Ok([u, v]) => largest = largest.max(u.abs()).max(v.abs()),
                Err(violation) => violations.push(violation),
            }
        }
        for cone in map.cones() {
            violations.extend(check.cone(Vertex(cone.vertex)));
        }
        let ends = aligned.iter().filter_map(|&[a, b]| mesh.edge_between(Vertex(a), Vertex(b)));
        let aligned = EdgeSet::new(mesh, ends);
        for &edge in aligned.edges() {
            violations.extend(check.isoline(edge));
        }
        let mut is_corner = turning_points(mesh, &aligned, |h| check.at(h));
        map.cones().iter().for_each(|cone| is_corner[Vertex(cone.vertex)] = false);
        let corners: Vec<Vertex> = mesh.vertices().filter(|&v| is_corner[v]).collect();
        for &corner in &corners {
            violations.extend(check.corner(corner));
        }
        if !violations.is_empty() {
            return Err(Violations(violations));
        }
        let certificate = IntegerCertificate {
            exact_edges: mesh.interior_edges().count(),
            integral_cones: map.cones().len(),
            isoline_edges: aligned.len(),
            integral_corners: corners.len(),
            largest_translation: largest,
            area: check.area(),
        };
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
}

impl Check<'_> {
    fn at(&self, h: Halfedge) -> Complex64 {
        let [u, v] = self.uvs[h.at()];
        Complex64::new(u, v)
    }

    /// The translation across an edge, from the left of the half-edge to its right.
    fn translation(&self, h: Halfedge) -> Result<[f64; 2], Violation> {
        let Some(t) = self.mesh.twin(h) else { return Ok([0.0; 2]) };
        let (a, b) = (self.at(h), self.at(h.next()));
        let (c, d) = (self.at(t.next()), self.at(t));
        let quarters = (((d - c) * (b - a).conj()).arg() / FRAC_PI_2).round() as i32;
        let vertices = [self.mesh.origin(h).0, self.mesh.tip(h).0];
        let faces = [h.face().0, t.face().0];
        let ends = [(a, c), (b, d)].map(|(left, right)| exact(right, turn(left, quarters)));
        let [Some(first), Some(second)] = ends else {
            return Err(Violation::InexactEdge { vertices, faces });
        };
        if first != second {
            return Err(Violation::InexactEdge { vertices, faces });
        }
        if !is_integral(first) {
            return Err(Violation::FractionalTranslation { vertices, faces, translation: first });
        }
        Ok(first)
    }

    fn cone(&self, v: Vertex) -> Option<Violation> {
        self.fractional(v).map(|uv| Violation::FractionalCone { vertex: v.0, uv })
    }

    fn corner(&self, v: Vertex) -> Option<Violation> {
        self.fractional(v).map(|uv| Violation::FractionalCorner { vertex: v.0, uv })
    }

    /// A place of a vertex that is no grid point.
    fn fractional(&self, v: Vertex) -> Option<[f64; 2]> {
        self.mesh.outgoing(v).map(|h| self.uvs[h.at()]).find(|&uv| !is_integral(uv))
    }

    /// An aligned edge that on one of its sides does not lie on an isoline at an integer.
    fn isoline(&self, edge: Halfedge) -> Option<Violation> {
        let is_off = |side: &Halfedge| {
            let [a, b] = [*side, side.next()].map(|corner| self.uvs[corner.at()]);
            !(0..2).any(|k| a[k] == b[k] && a[k].fract() == 0.0)
        };
        let side = std::iter::once(edge).chain(self.mesh.twin(edge)).find(is_off)?;
        let vertices = [self.mesh.origin(edge).0, self.mesh.tip(edge).0];
        Some(Violation::OffIsoline { vertices, face: side.face().0 })
    }

    fn area(&self) -> f64 {
        let doubled = |[a, b, c]: [Complex64; 3]| ((b - a).conj() * (c - a)).im;
        let areas = self.mesh.faces().map(|f| doubled(f.halfedges().map(|h| self.at(h))));
        areas.sum::<f64>() / 2.0
    }
}

/// `a - b` if both differences are doubles.
fn exact(a: Complex64, b: Complex64) -> Option<[f64; 2]> {
    Some([exact_difference(a.re, b.re)?, exact_difference(a.im, b.im)?])
}

/// `a - b` if that is a double: the rounding error by Knuth's two-sum is zero.
fn exact_difference(a: f64, b: f64) -> Option<f64> {
    let difference = a - b;
    let b_part = a - difference;
    let a_part = difference + b_part;
    let error = (a - a_part) + (b_part - b);
    (error == 0.0).then_some(difference)
}

fn is_integral(uv: [f64; 2]) -> bool {
    uv.iter().all(|x| x.fract() == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_that_round_are_told() {
        assert_eq!(exact_difference(0.75, 0.25), Some(0.5));
        assert_eq!(exact_difference(3.0 + 0.5f64.powi(40), 0.5f64.powi(40)), Some(3.0));
        assert_eq!(exact_difference(1.0, 1e-30), None);
        assert_eq!(exact_difference(1000.1, 0.1), None);
        assert_eq!(exact_difference(1e-30, 1.0), None);
    }
}
