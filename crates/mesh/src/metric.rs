//! Intrinsic geometry: edge lengths and what follows from them.

use crate::ids::{Face, FaceData, Halfedge, HalfedgeData, Vertex, VertexData};
use crate::mesh::TriMesh;
use crate::vector::{cross, dot, norm};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Lengths, flat triangles, angles and areas of a mesh, in units of its mean edge length.
///
/// The unit makes every later constant scale-free. (Levi 2021, suppl. sec. 11, asks for a scale that balances
/// the singular values of the embedding; the factor it prints does not depend on the scale at all, and
/// what matters is that there is a unit.) [`Metric::unit`] leads back to mesh units.
#[derive(Debug, Clone)]
pub struct Metric {
    /// Length per half-edge, equal on twins.
    pub length: HalfedgeData<f64>,
    /// Each triangle laid in the plane, counter-clockwise, first corner at 0, second on the real axis.
    pub flat: FaceData<[Complex64; 3]>,
    /// Area per face; positive.
    pub area: FaceData<f64>,
    /// Angle per corner, radians; the three of a face sum to pi.
    pub angle: HalfedgeData<f64>,
    /// Mesh length of one unit of this metric.
    pub unit: f64,
}

/// Flat triangles thinner than this fraction of their longest side are widened to it.
const MIN_RELATIVE_HEIGHT: f64 = 1e-14;

/// A triangle whose height is below this part of its longest side has no area to speak of.
const NO_AREA: f64 = 1e-12;
/// What the sides of triangles without area are lengthened by, of the longest edge around them: one over an edge gets a height
/// of some hundredths of it, and copies of a vertex come apart by less.
const OPENING: f64 = 5e-4;

impl Metric {
    /// The metric of a mesh embedded in space.
    ///
    /// Coordinates of any finite size work: they are scaled by a power of two first. A triangle without
    /// area gets a height of `1e-14` times its longest side, an edge without length is given `1e-14` of
    /// the mean; see [`Metric::lengthened`] for solving such meshes.
    pub fn from_positions(mesh: &TriMesh, positions: &[[f64; 3]]) -> Self {
        let extent = mesh
            .halfedges()
            .flat_map(|h| positions[mesh.origin(h).at()])
            .fold(0.0f64, |m, x| m.max(x.abs()))
            .min(f64::MAX);
        let scale = if extent > f64::MIN_POSITIVE {
            power_of_two_near(1.0 / (extent * 0.5).max(f64::MIN_POSITIVE))
        } else {
            1.0
        };
        let edge = |h: Halfedge| {
            let (a, b) = (positions[mesh.origin(h).at()], positions[mesh.tip(h).at()]);
            [0, 1, 2].map(|k| b[k] * scale - a[k] * scale)
        };
        let mut length: HalfedgeData<f64> = mesh.halfedges().map(|h| norm(edge(h))).collect();
        for h in mesh.halfedges() {
            if let Some(t) = mesh.twin(h).filter(|t| t.0 < h.0) {
                length[h] = length[t];
            }
        }
        let mean = length.iter().sum::<f64>() / length.len() as f64;
        let mean = if mean > 0.0 { mean } else { 1.0 };
        length.iter_mut().for_each(|l| *l = (*l / mean).max(MIN_RELATIVE_HEIGHT));
        let flat = mesh
            .faces()
            .map(|f| {
                let [h0, h1, h2] = f.halfedges();
                let (e1, e2) = (edge(h0), edge(h2).map(|x| -x));
                let base = length[h0];
                let longest = base.max(length[h1]).max(length[h2]);
                let along = dot(e1, e2) / (mean * mean) / base;
                let height = norm(cross(e1, e2)) / (mean * mean) / base;
                let height = height.max(MIN_RELATIVE_HEIGHT * longest);
                triangle(base, Complex64::new(along, height))
            })
            .collect();
        Self::assemble(length, flat, mean / scale)
    }

    /// By how much every edge would have to be longer, in mean edge lengths, for any two sides of a triangle together to
    /// exceed the third by `slack` at least.
    pub fn lengthening(&self, mesh: &TriMesh, slack: f64) -> f64 {
        let missing = |f: Face| {
            let [a, b, c] = f.halfedges().map(|h| self.length[h]);
            slack + (2.0 * a.max(b).max(c) - a - b - c)
        };
        mesh.faces().map(missing).fold(0.0, f64::max)
    }

    /// The metric whose edges are all longer by the same length, in units of the new mean: thin triangles open up and
    /// coincident vertices come apart, while others keep their shapes almost ("intrinsic mollification", Sharp and
    /// Crane 2020).
    pub fn lengthened(&self, mesh: &TriMesh, by: f64) -> Self {
        Self { unit: self.unit, ..self.with_lengths(mesh, |h| self.length[h] + by) }
    }

    /// The metric with other lengths, equal on twins, in units of the new mean.
    pub(crate) fn with_lengths(&self, mesh: &TriMesh, new: impl Fn(Halfedge) -> f64) -> Self {
        let mut length: HalfedgeData<f64> = mesh.halfedges().map(new).collect();
        let mean = length.iter().sum::<f64>() / length.len() as f64;
        length.iter_mut().for_each(|l| *l /= mean);
        let flat =
            mesh.faces().map(|f| flat_from_lengths(f.halfedges().map(|h| length[h]))).collect();
        Self::assemble(length, flat, self.unit * mean)
    }

    /// The metric in which triangles without area, and they alone, have some: their sides are longer by a small part of
    /// the longest edge around them. None if all have an area.
    ///
    /// Sides of such a triangle are then longer than those of its neighbours, which keep their shapes: what is made in
    /// this metric is, beside these triangles, nearly what the surface without them gives.
    pub fn opened(&self, mesh: &TriMesh) -> Option<Self> {
        let mut around = VertexData::filled(mesh.n_vertices(), 0.0f64);
        for h in mesh.halfedges() {
            for v in [mesh.origin(h), mesh.tip(h)] {
                around[v] = around[v].max(self.length[h]);
            }
        }
        let mut flat = self.flat.clone();
        let mut is_any = false;
        for f in mesh.faces() {
            let sides = f.halfedges().map(|h| self.length[h]);
            let longest = sides.into_iter().fold(0.0, f64::max);
            if 2.0 * self.area[f] > NO_AREA * longest * longest {
                continue;
            }
            let by = mesh.face_vertices(f).map(|v| OPENING * around[v]);
            let by = by.into_iter().fold(MIN_RELATIVE_HEIGHT, f64::max);
            flat[f] = flat_from_lengths(sides.map(|side| side + by));
            is_any = true;
        }
        is_any.then(|| Self::assemble(self.length.clone(), flat, self.unit))
    }

    fn assemble(length: HalfedgeData<f64>, flat: FaceData<[Complex64; 3]>, unit: f64) -> Self {
        let area = flat.iter().map(|z| 0.5 * z[1].re * z[2].im).collect();
        let angle = flat.iter().flat_map(|z| corner_angles(*z)).collect();
        Self { length, flat, area, angle, unit }
    }

    /// Angle defect per vertex, radians: 2 pi minus the angle sum, at the boundary pi minus it.
    ///
    /// Sums to 2 pi times the Euler characteristic.
    pub fn curvature(&self, mesh: &TriMesh) -> VertexData<f64> {
        let full = |v| if mesh.is_boundary(v) { PI } else { 2.0 * PI };
        let mut defect: VertexData<f64> = mesh.vertices().map(full).collect();
        for h in mesh.halfedges() {
            defect[mesh.origin(h)] -= self.angle[h];
        }
        defect
    }

    /// Cotangent of the angle opposite to each half-edge.
    pub fn cotangent(&self) -> HalfedgeData<f64> {
        let cot = |z: [Complex64; 3], k: usize| {
            let w = (z[k] - z[(k + 2) % 3]).conj() * (z[(k + 1) % 3] - z[(k + 2) % 3]);
            w.re / w.im
        };
        self.flat.iter().flat_map(|&z| [cot(z, 0), cot(z, 1), cot(z, 2)]).collect()
    }

    /// A third of the area around each vertex.
    pub fn vertex_area(&self, mesh: &TriMesh) -> VertexData<f64> {
        let mut area = VertexData::filled(mesh.n_vertices(), 0.0);
        for h in mesh.halfedges() {
            area[mesh.origin(h)] += self.area[h.face()] / 3.0;
        }
        area
    }

    /// Total area.
    pub fn total_area(&self) -> f64 {
        self.area.iter().sum()
    }

    /// Side of a square with the total area, in the unit of the positions: unlike the area itself it cannot
    /// overflow.
    pub fn side(&self) -> f64 {
        self.total_area().sqrt() * self.unit
    }

    /// The smallest angle, radians, and the corner it is at.
    pub fn smallest_angle(&self) -> (f64, Halfedge) {
        self.angle
            .enumerate()
            .map(|(h, &a)| (a, h))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((0.0, Halfedge(0)))
    }

    /// Angle sum around a vertex, radians.
    pub fn angle_sum(&self, mesh: &TriMesh, v: Vertex) -> f64 {
        mesh.outgoing(v).map(|h| self.angle[h]).sum()
    }
}

fn triangle(base: f64, apex: Complex64) -> [Complex64; 3] {
    [Complex64::ZERO, Complex64::new(base, 0.0), apex]
}

/// Flat triangle with sides 0-1, 1-2, 2-0 of these lengths; the area by Kahan's stable formula.
fn flat_from_lengths([l01, l12, l20]: [f64; 3]) -> [Complex64; 3] {
    let mut s = [l01, l12, l20];
    s.sort_by(|x, y| y.total_cmp(x));
    let [a, b, c] = s;
    let squared = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    let area = squared.max(0.0).sqrt() / 4.0;
    let height = (2.0 * area / l01).max(MIN_RELATIVE_HEIGHT * a);
    let along = (l01 * l01 + (l20 - l12) * (l20 + l12)) / (2.0 * l01);
    triangle(l01, Complex64::new(along, height))
}

fn corner_angles(z: [Complex64; 3]) -> [f64; 3] {
    let at = |k: usize| {
        let w = (z[(k + 1) % 3] - z[k]).conj() * (z[(k + 2) % 3] - z[k]);
        w.im.atan2(w.re)
    };
    let angles = [at(0), at(1), at(2)];
    let correction = PI / (angles[0] + angles[1] + angles[2]);
    angles.map(|a| a * correction)
}

/// The power of two nearest below a positive number, kept within the normal range.
fn power_of_two_near(x: f64) -> f64 {
    x.log2().floor().clamp(-1022.0, 1023.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (TriMesh, Vec<[f64; 3]>) {
        let mesh = TriMesh::from_faces(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let at = |x, y| [x, y, 0.0];
        (mesh, vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)])
    }

    #[test]
    fn unit_square_by_hand() {
        let (mesh, positions) = square();
        let metric = Metric::from_positions(&mesh, &positions);
        let mean = (4.0 + 2.0 * 2f64.sqrt()) / 6.0;
        assert!((metric.unit - mean).abs() < 1e-15);
        assert!((metric.side() - 1.0).abs() < 1e-14);
        assert!((metric.angle[Halfedge(0)] - PI / 4.0).abs() < 1e-14);
        assert!((metric.angle[Halfedge(1)] - PI / 2.0).abs() < 1e-14);
        let curvature = metric.curvature(&mesh);
        assert!(curvature.iter().all(|k| (k - PI / 2.0).abs() < 1e-14));
        // opposite to half-edge 2 (the diagonal) is the right angle, to the others 45 degrees
        let cot = metric.cotangent();
        assert!(cot[Halfedge(2)].abs() < 1e-14 && (cot[Halfedge(0)] - 1.0).abs() < 1e-14);
    }

    #[test]
    fn any_scale_gives_the_same_metric() {
        let (mesh, positions) = square();
        let one = Metric::from_positions(&mesh, &positions);
        for scale in [1e-200, 1e-12, 3.0, 1e30, 1e200] {
            let scaled: Vec<_> = positions.iter().map(|p| p.map(|x| x * scale)).collect();
            let other = Metric::from_positions(&mesh, &scaled);
            assert!((other.unit / scale - one.unit).abs() < 1e-12);
            for (a, b) in one.angle.iter().zip(other.angle.iter()) {
                assert!((a - b).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn longer_edges_open_thin_triangles() {
        let mesh = TriMesh::from_faces(3, &[[0, 1, 2]]).unwrap();
        let slack = |metric: &Metric| {
            let [a, b, c] = [0, 1, 2].map(|h| metric.length[Halfedge(h)]);
            (a + b - c).min(b + c - a).min(c + a - b)
        };
        let needle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1e-9, 0.0]];
        let cap = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.4, 0.0, 0.0]];
        for positions in [needle, cap, [[2.0, 1.0, 0.0]; 3]] {
            let metric = Metric::from_positions(&mesh, &positions);
            let by = metric.lengthening(&mesh, 0.01);
            let longer = metric.lengthened(&mesh, by);
            // Lengths are in units of the new mean, which is longer by as much.
            let mean = metric.length.iter().sum::<f64>() / 3.0 + by;
            assert!((slack(&longer) * mean - 0.01).abs() < 1e-12, "{positions:?}");
            // A needle of two long sides opens by the slack over their length.
            assert!(longer.smallest_angle().0 > 0.005, "{positions:?}");
        }
        let (mesh, positions) = square();
        let square = Metric::from_positions(&mesh, &positions);
        assert_eq!(square.lengthening(&mesh, 0.01), 0.0);
        assert_eq!(square.lengthened(&mesh, 0.0).length, square.length);
    }

    #[test]
    fn flat_triangle_from_lengths_is_right() {
        let z = flat_from_lengths([3.0, 5.0, 4.0]);
        assert!((z[2] - Complex64::new(0.0, 4.0)).norm() < 1e-14);
    }
}
