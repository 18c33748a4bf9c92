//! One case for each repair, and for what no repair touches.

use super::{Repair, Repaired, TriangleSoup, repair};
use crate::soup::{Fault, check};

fn soup(n_vertices: usize, faces: &[[u32; 3]]) -> TriangleSoup {
    let point = |i: usize| [i as f64, (i * i) as f64, (i * i * i) as f64];
    TriangleSoup { positions: (0..n_vertices).map(point).collect(), faces: faces.to_vec() }
}

/// Repairs, and asserts what holds of every repair.
fn repaired(soup: TriangleSoup) -> Repaired {
    let before = soup.clone();
    let done = repair(soup);
    assert_eq!(done.vertex_origin.len(), done.soup.positions.len());
    assert_eq!(done.face_origin.len(), done.soup.faces.len());
    for (&origin, position) in done.vertex_origin.iter().zip(&done.soup.positions) {
        assert_eq!(before.positions[origin as usize], *position, "vertices stay in place");
    }
    for (&origin, triple) in done.face_origin.iter().zip(&done.soup.faces) {
        let mut now = triple.map(|v| done.vertex_origin[v as usize]);
        let mut was = before.faces[origin as usize];
        now.sort_unstable();
        was.sort_unstable();
        assert_eq!(now, was, "faces keep their vertices");
    }
    assert_eq!(repair(done.soup.clone()).repairs, [], "nothing is left to repair");
    done
}

#[test]
fn a_sound_mesh_is_left_alone() {
    let tetrahedron = soup(4, &[[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]);
    let done = repaired(tetrahedron.clone());
    assert_eq!(done.repairs, []);
    assert_eq!(done.soup, tetrahedron);
}

#[test]
fn faces_that_say_nothing_new_are_dropped() {
    let done = repaired(soup(4, &[[0, 1, 2], [1, 1, 2], [1, 2, 0], [2, 1, 3]]));
    let expected = [
        Repair::DroppedRepeatedVertexFace { face: 1, vertex: 1 },
        Repair::DroppedDuplicateFace { face: 2, first: 0 },
    ];
    assert_eq!(done.repairs, expected);
    assert_eq!(done.face_origin, [0, 3]);
    assert_eq!(check(&done.soup).faults, []);
}

#[test]
fn a_reverse_is_dropped_where_it_crowds_an_edge() {
    let crowded = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0], [2, 1, 0]];
    let done = repaired(soup(4, &crowded));
    assert_eq!(done.repairs, [Repair::DroppedOppositeFace { face: 4, first: 0 }]);
    assert_eq!(check(&done.soup).faults, []);
    // Alone the two are a closed surface.
    assert_eq!(repaired(soup(3, &[[0, 1, 2], [2, 1, 0]])).repairs, []);
}

#[test]
fn reverses_of_neighbours_are_dropped_together() {
    let done = repaired(soup(4, &[[0, 1, 2], [2, 1, 3], [2, 1, 0], [3, 1, 2]]));
    let expected =
        [(2, 0), (3, 1)].map(|(face, first)| Repair::DroppedOppositeFace { face, first });
    assert_eq!(done.repairs, expected);
    assert_eq!(check(&done.soup).faults, []);
}

#[test]
fn a_flap_of_two_opposite_faces_stays() {
    // It hangs on edge 0-1 of a tetrahedron; one of its two faces would be a fin.
    let flap = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0], [0, 1, 4], [1, 0, 4]];
    let done = repaired(soup(5, &flap));
    assert_eq!(done.repairs, []);
    let expected = [
        Fault::OppositeFace { face: 5, first: 4 },
        Fault::NonManifoldEdge { vertices: [0, 1], faces: vec![0, 1, 4, 5] },
    ];
    assert_eq!(check(&done.soup).faults, expected);
}

#[test]
fn the_reverse_that_came_first_is_turned_with_the_rest() {
    let crowded = [[2, 1, 0], [0, 3, 1], [1, 3, 2], [2, 3, 0], [0, 1, 2]];
    let done = repaired(soup(4, &crowded));
    let expected =
        [Repair::DroppedOppositeFace { face: 4, first: 0 }, Repair::Reoriented { faces: vec![0] }];
    assert_eq!(done.repairs, expected);
    assert_eq!(check(&done.soup).faults, []);
}

#[test]
fn the_fewer_faces_are_turned() {
    // A strip of three, and a strip of two far from it.
    let strips = [[1, 0, 2], [2, 1, 3], [2, 3, 4], [5, 6, 7], [6, 7, 8]];
    let done = repaired(soup(9, &strips));
    let expected = [Repair::Reoriented { faces: vec![0] }, Repair::Reoriented { faces: vec![4] }];
    assert_eq!(done.repairs, expected);
    assert_eq!(done.soup.faces[0], [1, 2, 0]);
    assert_eq!(check(&done.soup).faults, []);
    // The majority wins even against the lowest face.
    let done = repaired(soup(5, &[[0, 1, 2], [1, 2, 3], [4, 3, 2]]));
    assert_eq!(done.repairs, [Repair::Reoriented { faces: vec![0] }]);
}

#[test]
fn every_fan_gets_a_vertex() {
    let done = repaired(soup(8, &[[0, 1, 2], [2, 3, 4], [7, 5, 2], [5, 7, 6]]));
    assert_eq!(done.repairs, [Repair::SplitVertex { vertex: 2, copies: vec![8, 9] }]);
    assert_eq!(done.soup.faces, [[0, 1, 2], [8, 3, 4], [7, 5, 9], [5, 7, 6]]);
    assert_eq!(done.vertex_origin, [0, 1, 2, 3, 4, 5, 6, 7, 2, 2]);
    assert_eq!(check(&done.soup).faults, []);
}

#[test]
fn spare_vertices_are_dropped() {
    let mut spare = soup(6, &[[1, 2, 4]]);
    spare.positions[5] = [f64::NAN; 3];
    let done = repaired(spare);
    let vertices = vec![0, 3, 5];
    assert_eq!(done.repairs, [Repair::DroppedUnreferencedVertices { vertices }]);
    assert_eq!(done.soup.faces, [[0, 1, 2]]);
    assert_eq!(done.vertex_origin, [1, 2, 4]);
}

#[test]
fn spare_vertices_and_split_ones_keep_their_old_names() {
    let done = repaired(soup(6, &[[1, 2, 3], [3, 4, 5]]));
    let expected = [
        Repair::DroppedUnreferencedVertices { vertices: vec![0] },
        Repair::SplitVertex { vertex: 3, copies: vec![5] },
    ];
    assert_eq!(done.repairs, expected);
    assert_eq!(done.vertex_origin, [1, 2, 3, 4, 5, 3]);
}

#[test]
fn what_needs_a_decision_stays() {
    let fins = soup(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    assert_eq!(repaired(fins.clone()).soup, fins);
    let moebius = soup(5, &[[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 0], [4, 0, 1]]);
    assert_eq!(repaired(moebius.clone()).soup, moebius);
    let faulty = soup(4, &[[0, 1, 9], [0, 1, 2], [0, 1, 2]]);
    let done = repair(faulty.clone());
    assert_eq!(done.soup, faulty);
    let expected = Fault::IndexOutOfRange { face: 0, index: 9, n_vertices: 4 };
    assert_eq!(check(&done.soup).faults[0], expected);
}

#[test]
fn messages_name_their_elements() {
    let turned = Repair::Reoriented { faces: vec![3] };
    assert_eq!(turned.to_string(), "turned over face 3");
    let split = Repair::SplitVertex { vertex: 7, copies: vec![20, 21] };
    assert_eq!(split.to_string(), "split vertex 7 into 3, one for each fan of faces");
    let dropped = Repair::DroppedUnreferencedVertices { vertices: vec![1, 2] };
    assert_eq!(dropped.to_string(), "dropped vertices 1, 2 in no face");
}
