//! The certificate: every kind of broken map is refused by name, and good ones pass at any size.
//!
//! The good map is laid by hand: the twelve triangles of a cube, its six squares side by side and
//! turned, so that all eight corners are cones of index 1 and all twelve edges seams.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod meshes;

use meshes::{SeamlessMap, mesh_of};
use seamstress_certify::{Tolerance, Violation};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Halfedge, TriMesh};
use seamstress_testkit::{cube, disjoint_union, disk_grid, fan};

type Uvs = Vec<[f64; 2]>;

/// Squares of side 1, three units apart, each turned by one quarter more than the last.
fn cube_by_hand() -> (TriMesh, Uvs) {
    let mut uvs = Uvs::new();
    for square in 0..6 {
        let turn = |[x, y]: [f64; 2]| [[x, y], [-y, x], [-x, -y], [y, -x]][square % 4];
        let at = |x, y| turn([x, y]).map(|c| c + 3.0 * square as f64);
        let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
        uvs.extend([a, b, c, a, c, d]);
    }
    (mesh_of(&cube()), uvs)
}

/// The planar map of a flat soup: its own x and y.
fn planar(soup: &TriangleSoup) -> (TriMesh, Uvs) {
    let corner = |&v: &u32| [soup.positions[v as usize][0], soup.positions[v as usize][1]];
    (mesh_of(soup), soup.faces.iter().flatten().map(corner).collect())
}

/// A closed fan of `n` triangles, all laid with an angle of `degrees` at the middle (vertex 0).
fn fan_laid(n: u32, degrees: &[f64]) -> (TriMesh, Uvs) {
    let mut uvs = Uvs::new();
    let mut from = 0.0f64;
    for angle in degrees.iter().cycle().take(n as usize) {
        let to = from + angle.to_radians();
        uvs.extend([[0.0; 2], [from.cos(), from.sin()], [to.cos(), to.sin()]]);
        from = to;
    }
    (mesh_of(&fan(n, 0.0, true)), uvs)
}

#[track_caller]
fn certified((mesh, uvs): &(TriMesh, Uvs)) -> SeamlessMap {
    SeamlessMap::certify(mesh, uvs.clone(), &Tolerance::default()).unwrap()
}

#[track_caller]
fn violations((mesh, uvs): &(TriMesh, Uvs)) -> Vec<Violation> {
    SeamlessMap::certify(mesh, uvs.clone(), &Tolerance::default()).err().unwrap().0
}

fn moved(map: &(TriMesh, Uvs), how: impl Fn([f64; 2]) -> [f64; 2]) -> (TriMesh, Uvs) {
    (map.0.clone(), map.1.iter().map(|&p| how(p)).collect())
}

#[test]
fn a_cube_laid_by_hand_is_seamless() {
    let map = certified(&cube_by_hand());
    let cones: Vec<_> = map.cones().iter().map(|c| (c.vertex, c.index)).collect();
    assert_eq!(cones, (0..8).map(|v| (v, 1)).collect::<Vec<_>>());
    assert_eq!(map.seams().len(), 12);
    let certificate = map.certificate();
    assert_eq!((certificate.faces, certificate.cones, certificate.seam_edges), (12, 8, 12));
    assert_eq!((certificate.index_sum, certificate.euler_characteristic), (8.0, 2));
    assert!(certificate.seam_residual < 1e-14 && certificate.angle_error < 1e-14);
}

#[test]
fn seams_carry_left_to_right() {
    let (mesh, uvs) = cube_by_hand();
    for seam in certified(&(mesh.clone(), uvs.clone())).seams() {
        let left = Halfedge(seam.left);
        let right = mesh.twin(left).unwrap();
        let ends = [(left, right.next()), (left.next(), right)];
        assert_eq!(seam.vertices, [mesh.origin(left).0, mesh.tip(left).0]);
        for (here, there) in ends.map(|(l, r)| (uvs[l.at()], uvs[r.at()])) {
            let [x, y] = here;
            let turned = [[x, y], [-y, x], [-x, -y], [y, -x]][seam.matching as usize];
            assert_eq!([0, 1].map(|k| turned[k] + seam.translation[k]), there);
        }
    }
}

#[test]
fn a_planar_map_has_neither_seam_nor_cone() {
    let map = certified(&planar(&disk_grid(4, 4)));
    assert_eq!((map.seams().len(), map.cones().len()), (0, 0));
    assert!((map.certificate().index_sum - 4.0).abs() < 1e-12);
}

#[test]
fn every_mirrored_triangle_is_named_as_flipped() {
    for face in 0..12u32 {
        let (mesh, mut uvs) = cube_by_hand();
        for uv in &mut uvs[3 * face as usize..][..3] {
            uv.swap(0, 1);
        }
        let found = violations(&(mesh, uvs));
        let flips = found.iter().filter(|v| matches!(v, Violation::FlippedTriangle { .. }));
        assert_eq!(flips.collect::<Vec<_>>(), [&Violation::FlippedTriangle { face }]);
    }
}

/// Corner of the grid that lies in one face alone, and that face.
const EAR: (u32, u32) = (4, 6);

fn grid_with_ear_at(uv: [f64; 2]) -> (TriMesh, Uvs) {
    let (mesh, mut uvs) = planar(&disk_grid(4, 4));
    let (vertex, face) = EAR;
    let corners: Vec<_> =
        mesh.halfedges().filter(|&h| mesh.origin(h).0 == vertex).map(|h| h.at()).collect();
    assert_eq!(corners.len(), 1);
    assert_eq!(corners[0] / 3, face as usize);
    uvs[corners[0]] = uv;
    (mesh, uvs)
}

#[test]
fn an_ear_folded_over_is_the_only_flip() {
    let found = violations(&grid_with_ear_at([0.5, -0.5]));
    assert_eq!(found[0], Violation::FlippedTriangle { face: EAR.1 });
    // Its angles count backwards, so that the sum of the indices is off by four.
    let [_, Violation::PoincareHopf { component: 0, sum, expected: 4 }] = found[..] else {
        panic!("{found:?}");
    };
    assert!((sum - 8.0).abs() < 1e-12);
}

#[test]
fn a_triangle_of_exactly_no_area_is_collapsed() {
    // Onto the middle of the opposite side, and onto one of its ends.
    let found = violations(&grid_with_ear_at([0.75, -0.75]));
    assert_eq!(found, [Violation::CollapsedTriangle { face: EAR.1 }]);
    let found = violations(&grid_with_ear_at([1.0, -0.5]));
    assert!(found.contains(&Violation::CollapsedTriangle { face: EAR.1 }));
}

#[test]
fn orientation_is_decided_to_the_last_bit() {
    let mesh = mesh_of(&fan(1, 0.0, false));
    let with = |y| (mesh.clone(), vec![[0.1, 0.1], [0.3, y], [0.7, 0.7]]);
    certified(&with(0.3f64.next_down()));
    assert_eq!(violations(&with(0.3)), [Violation::CollapsedTriangle { face: 0 }]);
    assert_eq!(violations(&with(0.3f64.next_up()))[0], Violation::FlippedTriangle { face: 0 });
}

/// The hand-laid cube with corner 1 of face 0 moved along u: edges 0-1 and 1-2 of that face open.
fn cube_opened_by(shift: f64) -> (TriMesh, Uvs) {
    let (mesh, mut uvs) = cube_by_hand();
    uvs[1][0] += shift;
    (mesh, uvs)
}

#[test]
fn seams_off_by_a_millionth_of_an_edge_are_named() {
    let (mesh, uvs) = cube_opened_by(1e-6);
    let [a, b, c] = mesh.face_vertices(seamstress_mesh::Face(0)).map(|v| v.0);
    let mut opened: Vec<_> = violations(&(mesh, uvs))
        .into_iter()
        .map(|violation| {
            let Violation::OpenSeam { mut vertices, faces, residual } = violation else {
                panic!("{violation:?}");
            };
            // The edge 0-1 is a side of the square, the edge 1-2 another: both have length 1.
            assert!((residual / 1e-6 - 1.0).abs() < 1e-5);
            assert!(faces.contains(&0));
            vertices.sort_unstable();
            vertices
        })
        .collect();
    opened.sort_unstable();
    let mut expected = [[a.min(b), a.max(b)], [b.min(c), b.max(c)]];
    expected.sort_unstable();
    assert_eq!(opened, expected);
}

#[test]
fn the_tolerance_of_seams_is_in_lengths_of_the_edge() {
    certified(&cube_opened_by(1e-11));
    let (mesh, uvs) = cube_opened_by(1e-6);
    let loose = Tolerance::of_seams(1e-5);
    let map = SeamlessMap::certify(&mesh, uvs, &loose).unwrap();
    assert!(map.certificate().seam_residual > 1e-7);
}

#[test]
fn an_angle_of_five_sixths_of_a_turn_is_no_cone() {
    let map = fan_laid(5, &[60.0]);
    let found = violations(&map);
    assert!(
        found
            .iter()
            .any(|v| matches!(v, Violation::OpenSeam { vertices, .. } if vertices.contains(&0)))
    );
    let wrong_angle = |v: &Violation| matches!(v, Violation::ConeAngle { vertex: 0, quarters } if (quarters - 300.0 / 90.0).abs() < 1e-12);
    assert!(found.iter().any(wrong_angle), "{found:?}");
}

#[test]
fn an_angle_is_refused_where_all_seams_fit() {
    // Forty corners of 62.9 degrees laid 63 degrees apart: every seam is open by 0.17 % of an edge, and the
    // angle lacks four degrees to 28 quarters.
    let at = |degrees: f64| [degrees.to_radians().cos(), degrees.to_radians().sin()];
    let corner = |k: u32| [[0.0; 2], at(63.0 * f64::from(k)), at(63.0 * f64::from(k) + 62.9)];
    let map = (mesh_of(&fan(40, 0.0, true)), (0..40).flat_map(corner).collect::<Uvs>());
    let loose = Tolerance::of_seams(0.01);
    let found = SeamlessMap::certify(&map.0, map.1, &loose).err().unwrap().0;
    let [Violation::ConeAngle { vertex: 0, quarters }] = found[..] else { panic!("{found:?}") };
    assert!((quarters - 40.0 * 62.9 / 90.0).abs() < 1e-12);
}

#[test]
fn vertices_of_the_boundary_that_turn_by_more_than_a_full_turn_are_counted() {
    let count = |map: &(TriMesh, Uvs)| certified(map).certificate().overwound_boundary_vertices;
    // An open fan of five quarters, and of four: its ends then come to lie on each other.
    let star = |n: u32| {
        let ends = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        let uvs = (0..n as usize).flat_map(|k| [[0.0; 2], ends[k % 4], ends[(k + 1) % 4]]);
        (mesh_of(&fan(n, 0.0, false)), uvs.collect::<Uvs>())
    };
    assert_eq!([3, 4, 5, 8, 9].map(|n| count(&star(n))), [0, 0, 1, 1, 1]);
    let (mesh, mut uvs) = star(4);
    uvs[11] = [1.0, 1e-300];
    assert_eq!(count(&(mesh, uvs)), 1, "a full turn and a little");
    // The same in charts of their own, each turned by a quarter more than the last and moved.
    let (mesh, uvs) = star(5);
    let chart = |(corner, [x, y]): (usize, &[f64; 2])| match corner / 3 % 4 {
        0 => [*x, *y],
        1 => [y - 9.0, -x],
        2 => [-x, 7.0 - y],
        _ => [-y, x + 0.5],
    };
    let charts: Uvs = uvs.iter().enumerate().map(chart).collect();
    assert_eq!(count(&(mesh.clone(), charts.clone())), 1);
    assert!(certified(&(mesh, charts)).seams().len() == 4);
    assert_eq!(count(&planar(&disk_grid(4, 4))) + count(&cube_by_hand()), 0);
}

#[test]
fn quarter_turns_of_all_sizes_are_cones() {
    for (n, degrees, index) in
        [(3, 30.0, 3), (3, 60.0, 2), (6, 45.0, 1), (6, 75.0, -1), (12, 60.0, -4), (40, 63.0, -24)]
    {
        let map = certified(&fan_laid(n, &[degrees]));
        let cones: Vec<_> = map.cones().iter().map(|c| (c.vertex, c.index)).collect();
        assert_eq!(cones, [(0, index)], "{n} corners of {degrees} degrees");
        assert!((map.certificate().index_sum - 4.0).abs() < 1e-9);
    }
}

#[test]
fn a_vertex_that_is_not_wound_at_all_is_refused() {
    // Forth and back: two corners of 60 degrees forward, two backward.
    let found = violations(&fan_laid(4, &[60.0, 60.0, -60.0, -60.0]));
    for face in [2, 3] {
        assert!(found.contains(&Violation::FlippedTriangle { face }));
    }
    let not_wound = |v: &Violation| matches!(v, Violation::ConeAngle { vertex: 0, quarters } if quarters.abs() < 1e-12);
    assert!(found.iter().any(not_wound), "{found:?}");
    // And once backwards.
    let found = violations(&fan_laid(4, &[-90.0]));
    let backwards = |v: &Violation| matches!(v, Violation::ConeAngle { vertex: 0, quarters } if (quarters + 4.0).abs() < 1e-12);
    assert!(found.iter().any(backwards), "{found:?}");
}

#[test]
fn the_sum_of_indices_is_checked_by_component() {
    let (mesh, mut uvs) = planar(&disjoint_union(&[disk_grid(2, 2), disk_grid(3, 3)]));
    // Mirror the second grid.
    for uv in &mut uvs[3 * 8..] {
        uv[0] = -uv[0];
    }
    let found = violations(&(mesh, uvs));
    let sums: Vec<_> = found
        .iter()
        .filter_map(|v| match v {
            Violation::PoincareHopf { component, expected, .. } => Some((*component, *expected)),
            _ => None,
        })
        .collect();
    assert_eq!(sums, [(1, 4)]);
}

#[test]
fn missing_and_strange_numbers_are_refused() {
    let (mesh, uvs) = cube_by_hand();
    let short = (mesh.clone(), uvs[..35].to_vec());
    assert_eq!(violations(&short), [Violation::UvCount { expected: 36, found: 35 }]);
    let long = (mesh.clone(), [uvs.clone(), vec![[0.0; 2]]].concat());
    assert_eq!(violations(&long), [Violation::UvCount { expected: 36, found: 37 }]);
    for strange in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (corner, k) in [(0, 0), (16, 1), (35, 0)] {
            let mut uvs = uvs.clone();
            uvs[corner][k] = strange;
            let face = corner as u32 / 3;
            assert_eq!(violations(&(mesh.clone(), uvs)), [Violation::NonFiniteUv { face }]);
        }
    }
    let nowhere = moved(&(mesh, uvs), |_| [0.0, 0.0]);
    assert!(violations(&nowhere).contains(&Violation::CollapsedTriangle { face: 11 }));
}

#[test]
fn motions_and_scales_keep_the_certificate() {
    let good = cube_by_hand();
    let reference = certified(&good);
    let matchings = |map: &SeamlessMap| {
        map.seams().iter().map(|s| (s.vertices, s.matching)).collect::<Vec<_>>()
    };
    let same = |other: &SeamlessMap| {
        assert_eq!(other.cones(), reference.cones());
        assert_eq!(matchings(other), matchings(&reference));
    };
    let (sin, cos) = 0.3f64.sin_cos();
    let turned =
        |[x, y]: [f64; 2]| [2.7 * (cos * x - sin * y) + 4e3, 2.7 * (sin * x + cos * y) - 7.0];
    same(&certified(&moved(&good, turned)));
    for scale in [1e-300, 1e-200, 1e-12, 3.0, 1e30, 1e200, 1e306] {
        let map = certified(&moved(&good, |p| p.map(|x| scale * x)));
        same(&map);
        for (seam, original) in map.seams().iter().zip(reference.seams()) {
            for k in 0..2 {
                let expected = scale * original.translation[k];
                assert!((seam.translation[k] - expected).abs() <= 1e-12 * 20.0 * scale);
            }
        }
    }
    // A turn by 45 degrees puts the edges of the squares halfway between the axes.
    same(&certified(&moved(&good, |[x, y]| [x - y, x + y])));
}

#[test]
fn components_may_be_turned_by_quarters_each() {
    let one = cube();
    let two = disjoint_union(&[one.clone(), one]);
    let (_, uvs) = cube_by_hand();
    let turned = uvs.iter().map(|&[x, y]| [-y + 50.0, x]);
    let all: Uvs = uvs.iter().copied().chain(turned).collect();
    let map = certified(&(mesh_of(&two), all));
    assert_eq!((map.cones().len(), map.seams().len()), (16, 24));
    assert_eq!(map.certificate().index_sum, 16.0);
}

#[test]
fn violations_name_their_elements() {
    let (mesh, mut uvs) = cube_by_hand();
    uvs[1][0] += 0.5;
    uvs[3][1] = f64::NAN;
    let error = SeamlessMap::certify(&mesh, uvs, &Tolerance::default()).err().unwrap();
    assert_eq!(error.0, [Violation::NonFiniteUv { face: 1 }]);
    assert_eq!(error.to_string(), "[NonFiniteUv { face: 1 }]");
    let error = SeamlessMap::certify(&mesh, cube_opened_by(0.5).1, &Tolerance::default());
    let found = error.err().unwrap().0;
    let is_at_first = |v: &Violation| matches!(v, Violation::OpenSeam { faces: [0, _], .. });
    assert!(found.len() > 1 && is_at_first(&found[0]), "{found:?}");
}
