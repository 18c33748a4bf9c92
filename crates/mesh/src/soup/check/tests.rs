//! Each fault in the smallest soup that has it.

use super::{Fault, TriangleSoup, check, size_faults};

/// A soup on points of a curve with no three in line, with the faults `check` finds in it.
fn faults(n_vertices: usize, faces: &[[u32; 3]]) -> Vec<Fault> {
    let point = |i: usize| [i as f64, (i * i) as f64, (i * i * i) as f64];
    let positions = (0..n_vertices).map(point).collect();
    check(&TriangleSoup { positions, faces: faces.to_vec() }).faults
}

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];

#[test]
fn sound_meshes_have_no_faults() {
    assert_eq!(faults(4, &TETRAHEDRON), []);
    assert_eq!(faults(3, &[[0, 1, 2]]), []);
    assert_eq!(faults(4, &[[0, 1, 2], [2, 1, 3]]), []);
}

#[test]
fn no_faces() {
    assert_eq!(faults(0, &[]), [Fault::NoFaces]);
    assert_eq!(faults(1, &[]), [Fault::NoFaces, Fault::UnreferencedVertex { vertex: 0 }]);
}

#[test]
fn too_large_for_32_bits() {
    assert_eq!(size_faults(1 << 31, 1 << 29), []);
    let [Fault::TooManyFaces { .. }, Fault::TooManyVertices { .. }] =
        size_faults(1 << 32, 1 << 30)[..]
    else {
        panic!("both counts exceed their limits");
    };
}

#[test]
fn index_out_of_range() {
    let expected = [
        Fault::IndexOutOfRange { face: 1, index: 7, n_vertices: 3 },
        Fault::IndexOutOfRange { face: 1, index: 3, n_vertices: 3 },
    ];
    assert_eq!(faults(3, &[[0, 1, 2], [7, 1, 3]]), expected);
}

#[test]
fn non_finite_coordinate() {
    let positions = vec![[0.0; 3], [1.0, 0.0, f64::NAN], [0.0, f64::INFINITY, 0.0]];
    let found = check(&TriangleSoup { positions, faces: vec![[0, 1, 2]] });
    let expected = [1, 2].map(|vertex| Fault::NonFiniteCoordinate { vertex });
    assert_eq!(found.faults, expected);
    assert_eq!(found.facts.bounding_box, None);
}

#[test]
fn repeated_vertex() {
    let found = faults(3, &[[0, 1, 2], [1, 2, 2], [0, 1, 0]]);
    let expected = [(1, 2), (2, 0)].map(|(face, vertex)| Fault::RepeatedVertex { face, vertex });
    assert_eq!(found, expected);
}

#[test]
fn a_copy_is_named_once_and_not_as_edges() {
    let found = faults(3, &[[0, 1, 2], [1, 2, 0], [2, 0, 1]]);
    let expected = [1, 2].map(|face| Fault::DuplicateFace { face, first: 0 });
    assert_eq!(found, expected);
}

#[test]
fn a_pillow_alone_is_a_sphere() {
    assert_eq!(faults(3, &[[0, 1, 2], [0, 2, 1]]), []);
}

#[test]
fn a_reversed_face_on_a_closed_mesh_crowds_its_edges() {
    let mut faces = TETRAHEDRON.to_vec();
    faces.push([2, 1, 0]);
    let found = faults(4, &faces);
    assert_eq!(found[0], Fault::OppositeFace { face: 4, first: 0 });
    assert_eq!(found[1], Fault::NonManifoldEdge { vertices: [0, 1], faces: vec![0, 1, 4] });
    assert_eq!(found.len(), 4, "three edges are crowded: {found:?}");
}

#[test]
fn three_faces_on_an_edge() {
    let found = faults(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    assert_eq!(found, [Fault::NonManifoldEdge { vertices: [0, 1], faces: vec![0, 1, 2] }]);
}

#[test]
fn two_fans_meet_in_a_vertex() {
    let found = faults(5, &[[0, 1, 2], [2, 3, 4]]);
    assert_eq!(found, [Fault::NonManifoldVertex { vertex: 2, fans: 2 }]);
}

#[test]
fn neighbours_that_run_the_same_way() {
    let found = faults(4, &[[0, 1, 2], [1, 2, 3]]);
    assert_eq!(found, [Fault::InconsistentOrientation { edge: [1, 2], faces: [0, 1] }]);
}

#[test]
fn a_moebius_band_cannot_be_oriented() {
    // Five triangles i, i+1, i+2 around a circle of five vertices.
    let found = faults(5, &[[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 0], [4, 0, 1]]);
    let expected = [
        Fault::InconsistentOrientation { edge: [0, 1], faces: [0, 4] },
        Fault::NonOrientable { face: 0, edge: [3, 4] },
    ];
    assert_eq!(found, expected);
}

#[test]
fn flat_faces_and_coinciding_ends_are_warnings() {
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0]];
    let soup = TriangleSoup { positions, faces: vec![[0, 1, 2], [4, 0, 3]] };
    let report = check(&soup);
    let expected = [
        Fault::NonManifoldVertex { vertex: 0, fans: 2 },
        Fault::ZeroAreaFace { face: 0 },
        Fault::ZeroAreaFace { face: 1 },
        Fault::ZeroLengthEdge { vertices: [0, 3] },
    ];
    assert_eq!(report.faults, expected);
    assert_eq!(report.errors().count(), 1);
    assert_eq!(report.warnings().count(), 3);
    assert!(!report.is_mesh());
}

#[test]
fn extreme_units_are_no_fault() {
    for scale in [1e200, 1e-200, 1e308, 1e-300] {
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|p: [f64; 3]| p.map(|x| x * scale));
        let soup = TriangleSoup { positions: positions.into(), faces: TETRAHEDRON.into() };
        let report = check(&soup);
        assert_eq!(report.faults, []);
        let length = report.facts.max_edge_length.unwrap();
        assert!((length / scale - 2f64.sqrt()).abs() < 1e-15 || scale == 1e308);
    }
}
