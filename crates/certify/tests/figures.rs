//! Figures and verdicts of small results by hand, at both sides of every limit.
#![allow(clippy::unwrap_used, reason = "a test")]

use seamstress_certify::{Cone, Map, Quads, Tolerance, Violation};
use seamstress_testkit::{annulus, torus};

/// Two triangles that make a square.
const SQUARE: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const RIM: [[u32; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];

/// The square of side two, its second half moved.
fn square(by: [f64; 2]) -> Vec<[f64; 2]> {
    let [a, b, c, d] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let moved = |p: [f64; 2]| [p[0] + by[0], p[1] + by[1]];
    vec![a, b, c, moved(a), moved(c), moved(d)]
}

fn at(radians: f64) -> [f64; 2] {
    [radians.cos(), radians.sin()]
}

#[test]
fn figures_of_a_square_in_two_charts() {
    let uvs = square([5.0, -7.0]);
    let map = Map::new(4, &SQUARE, &uvs).unwrap();
    let found = map.seamless(&Tolerance::default()).unwrap();
    assert_eq!((found.cones.len(), found.seams.len()), (0, 1));
    assert_eq!((found.seams[0].matching, found.seams[0].translation), (0, [5.0, -7.0]));
    let figures = found.certificate;
    assert_eq!((figures.faces, figures.seam_edges, figures.cones), (2, 1, 0));
    assert_eq!((figures.index_sum, figures.euler_characteristic), (4.0, 1));
    assert_eq!((figures.seam_residual, figures.overwound_boundary_vertices), (0.0, 0));
    let figures = map.integers(&RIM, &Tolerance::default()).unwrap();
    assert_eq!((figures.edges, figures.exact_edges, figures.isoline_edges), (1, 1, 4));
    assert_eq!((figures.integral_cones, figures.integral_corners), (0, 4));
    assert_eq!((figures.integral_error, figures.largest_translation), (0.0, 7.0));
    assert_eq!(figures.area, 4.0);
}

#[test]
fn only_cones_and_corners_have_to_be_grid_points() {
    let uvs: Vec<_> = square([3.0, 0.0]).iter().map(|[u, v]| [u + 0.5, v + 0.25]).collect();
    let map = Map::new(4, &SQUARE, &uvs).unwrap();
    assert_eq!(map.integers(&[], &Tolerance::default()).unwrap().integral_error, 0.0);
    let found = map.integers(&RIM[..2], &Tolerance::default()).unwrap_err().0;
    let off = |vertices| Violation::OffIsoline { vertices, face: 0 };
    let corner = Violation::FractionalCorner { vertex: 1, uv: [2.5, 0.25] };
    assert_eq!(found, [off([0, 1]), off([1, 2]), corner]);
}

/// Triangles around the vertex 0, which lies at a point, in one chart; the others at quarters of a turn around it.
fn fan(quarters: u32, [u, v]: [f64; 2]) -> (Vec<[u32; 3]>, Vec<[f64; 2]>) {
    let arm = |k: u32| [[2.0, 0.0], [0.0, 2.0], [-2.0, 0.0], [0.0, -2.0]][k as usize % 4];
    let at = |k| [u + arm(k)[0], v + arm(k)[1]];
    let faces = (0..quarters).map(|k| [0, 1 + k, 1 + (k + 1) % quarters]).collect();
    (faces, (0..quarters).flat_map(|k| [[u, v], at(k), at(k + 1)]).collect())
}

#[test]
fn a_cone_is_a_grid_point_and_a_regular_vertex_need_not_be() {
    let check = |quarters, at, aligned: &[[u32; 2]]| {
        let (faces, uvs) = fan(quarters, at);
        let map = Map::new(1 + quarters as usize, &faces, &uvs).unwrap();
        map.integers(aligned, &Tolerance::default()).map_err(|found| found.0)
    };
    assert_eq!(check(4, [0.5, 0.25], &[]).unwrap().integral_cones, 0);
    assert_eq!(check(3, [1.0, -2.0], &[]).unwrap().integral_cones, 1);
    let cone = Violation::FractionalCone { vertex: 0, uv: [0.5, 0.0] };
    assert!(check(3, [0.5, 0.0], &[]).unwrap_err().contains(&cone));
    // Where one aligned edge ends on its isoline, nothing turns; where two meet at a right angle, something does.
    assert_eq!(check(4, [0.5, 1.0], &[[0, 1]]).unwrap().integral_corners, 0);
    let corner = Violation::FractionalCorner { vertex: 0, uv: [0.5, 1.0] };
    assert!(check(4, [0.5, 1.0], &[[0, 1], [0, 2]]).unwrap_err().contains(&corner));
    assert_eq!(check(4, [0.0, 1.0], &[[0, 1], [0, 2]]).unwrap().integral_corners, 1);
}

#[test]
fn what_rounding_takes_of_a_translation_counts() {
    let [a, b, c] = [[1e-30, 0.0], [2.0, 0.0], [2.0, 2.0]];
    let uvs = [a, b, c, [1.0, 0.0], [3.0, 2.0], [1.0, 2.0]];
    let map = Map::new(4, &SQUARE, &uvs).unwrap();
    let found = map.integers(&[], &Tolerance::default()).unwrap_err().0;
    assert_eq!(found, [Violation::InexactEdge { vertices: [2, 0], faces: [0, 1] }]);
}

#[test]
fn an_edge_off_the_axes_is_named_with_its_face() {
    let mut uvs = square([0.0; 2]);
    uvs[5] = [1.0, 2.0];
    let map = Map::new(4, &SQUARE, &uvs).unwrap();
    let found = map.alignment(&[[3, 0]], &Tolerance::default()).unwrap_err().0;
    let [Violation::OffAxis { vertices: [3, 0], face: 1, degrees }] = found[..] else {
        panic!("{found:?}");
    };
    assert!((degrees - 0.5f64.atan().to_degrees()).abs() < 1e-12);
}

#[test]
fn translations_that_are_no_integers_are_told_by_their_size() {
    let integers = |by: f64, tolerance: f64| {
        let uvs = square([by, 3.0]);
        let map = Map::new(4, &SQUARE, &uvs).unwrap();
        map.integers(&[], &Tolerance { integers: tolerance, ..Tolerance::default() })
            .map_err(|found| found.0)
    };
    let (vertices, faces) = ([2, 0], [0, 1]);
    let inexact = Violation::InexactEdge { vertices, faces };
    let fractional =
        |by: f64| Violation::FractionalTranslation { vertices, faces, translation: [by, 3.0] };
    // The two ends differ by rounding.
    assert_eq!(integers(0.005, 0.0), Err(vec![inexact]));
    let found = integers(0.005, 0.001).unwrap_err();
    assert!(matches!(found[..], [Violation::FractionalTranslation { .. }]), "{found:?}");
    let figures = integers(0.005, 0.01).unwrap();
    assert_eq!((figures.edges, figures.exact_edges, figures.largest_translation), (1, 0, 3.0));
    assert!((figures.integral_error - 0.005).abs() < 1e-15, "{}", figures.integral_error);
    // They do not, near an integer and far from one.
    assert_eq!(integers(0.5f64.powi(10), 0.0), Err(vec![fractional(0.5f64.powi(10))]));
    assert_eq!(integers(0.25, 0.01), Err(vec![fractional(0.25)]));
}

#[test]
fn a_translation_that_no_double_holds_is_no_integer() {
    // Seams that fit, of charts so far apart that their distance overflows.
    let (far, side) = (1.5e308, 2f64.powi(1018));
    let corner = |x: f64, k: usize| [x + [0.0, side, side, 0.0][k], [0.0, 0.0, side, side][k]];
    let uvs = [(-far, 0), (-far, 1), (-far, 2), (far, 0), (far, 2), (far, 3)];
    let uvs = uvs.map(|(x, k)| corner(x, k));
    let map = Map::new(4, &SQUARE, &uvs).unwrap();
    assert_eq!(map.seamless(&Tolerance::default()).unwrap().certificate.seam_residual, 0.0);
    for integers in [0.0, 0.01] {
        let found = map.integers(&[], &Tolerance { integers, ..Tolerance::default() });
        let found = found.unwrap_err().0;
        assert!(matches!(found[..], [Violation::FractionalTranslation { .. }]), "{found:?}");
    }
}

#[test]
fn faces_and_pairs_of_vertices_that_do_not_fit() {
    let repeated = Map::new(4, &[[0, 1, 2], [0, 1, 3]], &square([0.0; 2])).unwrap_err();
    assert_eq!(repeated.0, [Violation::RepeatedEdge { vertices: [0, 1] }]);
    let uvs = square([0.0; 2]);
    let map = Map::new(4, &SQUARE, &uvs).unwrap();
    for vertices in [[0, 4], [4, 0], [1, 3], [2, 2]] {
        let found = map.alignment(&[vertices], &Tolerance::default()).unwrap_err();
        assert_eq!(found.0, [Violation::NotAnEdge { vertices }]);
    }
}

#[test]
fn angles_around_a_vertex_are_off_by_a_thousandth_at_most() {
    // Forty corners laid 63 degrees apart that lack a little each.
    let laid = |lack: f64| -> Vec<[f64; 2]> {
        let step = f64::to_radians(63.0);
        let from = |k: u32| step * f64::from(k);
        (0..40).flat_map(|k| [[0.0; 2], at(from(k)), at(from(k) + step - lack / 40.0)]).collect()
    };
    let faces: Vec<_> = (0..40).map(|k| [0, 1 + k, 1 + (k + 1) % 40]).collect();
    let check = |lack: f64| {
        let uvs = laid(lack);
        Map::new(41, &faces, &uvs).unwrap().seamless(&Tolerance::of_seams(1e-4))
    };
    let found = check(0.8e-3).unwrap();
    assert_eq!(found.cones, [Cone { vertex: 0, index: 4 - 28 }]);
    assert!((found.certificate.angle_error - 0.8e-3).abs() < 1e-10);
    assert!((found.certificate.seam_residual - 2e-5).abs() < 1e-10);
    let found = check(1.2e-3).unwrap_err().0;
    assert!(matches!(found[..], [Violation::ConeAngle { vertex: 0, .. }]), "{found:?}");
}

#[test]
fn angles_between_aligned_edges_are_off_by_a_thousandth_at_most() {
    let check = |off: f64| {
        let uvs = [[0.0; 2], [1.0, 0.0], [-off.sin(), off.cos()]];
        let map = Map::new(3, &[[0, 1, 2]], &uvs).unwrap();
        map.alignment(&[[0, 1], [2, 0]], &Tolerance { axes: 1.0, ..Tolerance::default() })
    };
    let found = check(0.8e-3).unwrap();
    assert_eq!((found.edges, found.sides, found.exact_sides, found.sectors), (2, 2, 1, 1));
    assert!((found.sector_error - 0.8e-3).abs() < 1e-12);
    assert!((found.axis_error - 0.8e-3f64.to_degrees()).abs() < 1e-12);
    let found = check(1.2e-3).unwrap_err().0;
    let [Violation::SectorAngle { vertex: 0, between: [1, 2], .. }] = found[..] else {
        panic!("{found:?}");
    };
}

#[test]
fn a_cone_may_be_a_quarter() {
    let corner =
        |k: f64| [[0.0; 2], at((30.0 * k).to_radians()), at((30.0 * (k + 1.0)).to_radians())];
    let uvs = [0.0, 1.0, 2.0].map(corner).concat();
    let map = Map::new(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]], &uvs).unwrap();
    let found = map.seamless(&Tolerance::default()).unwrap();
    assert_eq!(found.cones, [Cone { vertex: 0, index: 3 }]);
    assert_eq!((found.certificate.cones, found.certificate.index_sum), (1, 4.0));
}

#[test]
fn a_map_in_a_point_has_collapsed_faces_and_no_open_seam() {
    let found = Map::new(4, &SQUARE, &[[1.0; 2]; 6]).unwrap().seamless(&Tolerance::default());
    let found = found.unwrap_err().0;
    let collapsed = [0, 1].map(|face| Violation::CollapsedTriangle { face });
    assert_eq!(found[..2], collapsed);
    assert!(!found.iter().any(|v| matches!(v, Violation::OpenSeam { .. })), "{found:?}");
}

/// Nine quads of a torus of as many vertices, from a first one.
fn closed_quads(first: u32) -> Vec<[u32; 4]> {
    let at = |i: u32, j: u32| first + 3 * (i % 3) + j % 3;
    let quad = |i, j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    (0..3).flat_map(|i| (0..3).map(move |j| quad(i, j))).collect()
}

/// Four quads of a ring of eight vertices, from a first one.
fn open_quads(first: u32) -> Vec<[u32; 4]> {
    let quad = |k: u32| [k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4].map(|v| first + v);
    (0..4).map(quad).collect()
}

#[test]
fn quads_are_closed_where_their_surface_is() {
    let (closed, open) = (torus(3, 3, 2.0, 0.5).faces, annulus(3, 1).faces);
    let check = |faces: &[[u32; 3]], quads: &[[u32; 4]], is_trimmed| {
        let sources = vec![0; 1 + *quads.as_flattened().iter().max().unwrap() as usize];
        let n_vertices = 1 + *faces.as_flattened().iter().max().unwrap() as usize;
        let found = Quads { quads, sources: &sources, n_vertices, faces, is_trimmed }.check();
        found.map(|found| found.components).map_err(|found| found.0)
    };
    let wrong = Err(vec![Violation::QuadBoundary { component: 0 }]);
    for is_trimmed in [false, true] {
        let counted = usize::from(!is_trimmed);
        assert_eq!(check(&closed, &closed_quads(0), is_trimmed), Ok(1));
        assert_eq!(check(&closed, &open_quads(0), is_trimmed), wrong);
        assert_eq!(check(&open, &open_quads(0), is_trimmed), Ok(counted));
        let of_open = check(&open, &closed_quads(0), is_trimmed);
        assert_eq!(of_open, if is_trimmed { Ok(0) } else { wrong.clone() });
    }
}

#[test]
fn quads_of_two_components() {
    let (closed, open) = (torus(3, 3, 2.0, 0.5), annulus(3, 1));
    for is_closed_first in [true, false] {
        let [first, second] = if is_closed_first { [&closed, &open] } else { [&open, &closed] };
        let n = first.positions.len() as u32;
        let moved = second.faces.iter().map(|face| face.map(|v| v + n));
        let faces: Vec<_> = first.faces.iter().copied().chain(moved).collect();
        // Nine vertices on the closed component, and eight on the open one.
        let (on_first, on_second) = (0, first.faces.len() as u32);
        let (on_closed, on_open) =
            if is_closed_first { (on_first, on_second) } else { (on_second, on_first) };
        let sources = [vec![on_closed; 9], vec![on_open; 8]].concat();
        let quads = [closed_quads(0), open_quads(9)].concat();
        let n_vertices = n as usize + second.positions.len();
        let all = Quads {
            quads: &quads,
            sources: &sources,
            n_vertices,
            faces: &faces,
            is_trimmed: false,
        };
        let found = all.check().unwrap();
        assert_eq!((found.quads, found.components, found.irregular), (13, 2, 0));
        assert_eq!(Quads { is_trimmed: true, ..all }.check().unwrap().components, 1);
        assert_eq!(all.agree_with(&[], 13.4), Ok(()));
        let count = Violation::QuadCount { quads: 13, area: 13.6 };
        assert_eq!(all.agree_with(&[], 13.6).unwrap_err().0, [count]);
        let index = Violation::QuadIndex { index: 1, irregular: 0, cones: 2 };
        assert_eq!(all.agree_with(&[1, 1], 13.0).unwrap_err().0, [index]);
    }
}
