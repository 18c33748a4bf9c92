//! Sharp edges by the angle between faces.

use super::EdgeSet;
use crate::ids::{Face, Halfedge};
use crate::mesh::TriMesh;
use crate::vector::{cross, dot};

/// A triangle whose height is at most this part of its longest side has no normal.
const MIN_RELATIVE_HEIGHT: f64 = 1e-12;

/// The angle between the normals of the two faces at an edge, radians: 0 where the surface is flat.
///
/// `None` on the boundary and beside a triangle without area.
pub fn dihedral_angle(mesh: &TriMesh, positions: &[[f64; 3]], h: Halfedge) -> Option<f64> {
    let twin = mesh.twin(h)?;
    let a = normal(mesh, positions, h.face())?;
    let b = normal(mesh, positions, twin.face())?;
    let c = cross(a, b);
    Some(dot(c, c).sqrt().atan2(dot(a, b)))
}

/// The edges at which the surface bends by at least `min_angle` radians.
pub fn sharp_edges(mesh: &TriMesh, positions: &[[f64; 3]], min_angle: f64) -> EdgeSet {
    let is_sharp =
        |h: &Halfedge| dihedral_angle(mesh, positions, *h).is_some_and(|angle| angle >= min_angle);
    EdgeSet::new(mesh, mesh.interior_edges().filter(is_sharp))
}

/// The unit normal of a face, at any scale.
pub(super) fn normal(mesh: &TriMesh, positions: &[[f64; 3]], f: Face) -> Option<[f64; 3]> {
    let corners = mesh.face_vertices(f).map(|v| positions[v.at()]);
    // Halved first, so that no difference overflows.
    let side = |k: usize| [0, 1, 2].map(|i| 0.5 * corners[(k + 1) % 3][i] - 0.5 * corners[k][i]);
    let sides = [side(0), side(1), side(2)];
    let largest = sides.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest == 0.0 {
        return None;
    }
    let sides = sides.map(|s| s.map(|x| x / largest));
    let squares = sides.map(|s| dot(s, s));
    let longest = (0..3).fold(0, |l, k| if squares[k] > squares[l] { k } else { l });
    // The two shorter sides lose the fewest digits.
    let n = cross(sides[(longest + 1) % 3], sides[(longest + 2) % 3]);
    let size = dot(n, n).sqrt();
    (size > MIN_RELATIVE_HEIGHT * squares[longest]).then(|| n.map(|x| x / size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Two triangles on the edge 0-1, the second lifted by an angle out of the plane of the first.
    fn book(lift: f64, scale: f64) -> (TriMesh, Vec<[f64; 3]>) {
        let mesh = TriMesh::from_faces(4, &[[0, 1, 2], [1, 0, 3]]).unwrap();
        let (sin, cos) = lift.sin_cos();
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.3, -cos, sin]];
        (mesh, positions.map(|p| p.map(|x| x * scale)).to_vec())
    }

    #[test]
    fn a_book_opens_by_the_angle_it_was_given() {
        for lift in [0.0, 1e-9, 0.3, FRAC_PI_2, 3.0, PI] {
            for scale in [1e-200, 1.0, 1e300] {
                let (mesh, positions) = book(lift, scale);
                let angle = dihedral_angle(&mesh, &positions, Halfedge(0)).unwrap();
                assert!((angle - lift).abs() < 1e-14, "{lift} at {scale}: {angle}");
                assert_eq!(dihedral_angle(&mesh, &positions, Halfedge(1)), None);
            }
        }
    }

    #[test]
    fn edges_are_sharp_from_the_angle_on() {
        let (mesh, positions) = book(FRAC_PI_2, 1.0);
        let count = |degrees: f64| sharp_edges(&mesh, &positions, degrees.to_radians()).len();
        assert_eq!([count(40.0), count(90.0), count(90.1)], [1, 1, 0]);
    }

    #[test]
    fn beside_a_triangle_without_area_there_is_no_angle() {
        let (mesh, mut positions) = book(1.0, 1.0);
        for flat in [[0.5, 0.0, 0.0], [0.5, 1e-13, 0.0], [0.0; 3]] {
            positions[2] = flat;
            assert_eq!(dihedral_angle(&mesh, &positions, Halfedge(0)), None);
            assert!(sharp_edges(&mesh, &positions, 0.1).is_empty());
        }
    }
}
