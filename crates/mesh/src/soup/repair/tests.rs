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
        Repair::DroppedDegenerateFace { face: 1 },
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
fn a_flap_of_two_opposite_faces_is_cut_off() {
    // It hangs on edge 0-1 of a tetrahedron; one of its two faces would be a fin.
    let flap = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0], [0, 1, 4], [1, 0, 4]];
    let done = repaired(soup(5, &flap));
    let faces = vec![0, 1, 4, 5];
    assert_eq!(done.repairs, [Repair::CutEdge { vertices: [0, 1], faces, sheets: 2 }]);
    let report = check(&done.soup);
    assert_eq!((report.faults, report.facts.components.len()), (vec![], 2));
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
fn sheets_at_an_edge_are_those_that_turn_the_least() {
    // A floor of two triangles along edge 0-1, and a wall on it.
    let mut room = soup(5, &[[0, 1, 2], [1, 0, 4], [1, 0, 3]]);
    room.positions =
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, -1.0, 0.0], [0.5, -0.1, 1.0]];
    let done = repaired(room);
    let faces = vec![0, 1, 2];
    assert_eq!(done.repairs, [Repair::CutEdge { vertices: [0, 1], faces, sheets: 2 }]);
    assert_eq!(done.junctions, [[0, 1]]);
    let report = check(&done.soup);
    assert_eq!((report.faults, report.facts.components.len()), (vec![], 2));
    // The wall has ends of its own.
    assert_eq!(done.soup.faces, [[0, 1, 2], [5, 6, 4], [1, 0, 3]]);
    assert_eq!(done.vertex_origin, [0, 1, 2, 3, 4, 1, 0]);
}

#[test]
fn solids_that_touch_along_an_edge_come_apart_as_solids() {
    // Two tetrahedra on opposite sides of the edge 0-1: all turns are a right angle, and those of
    // the solids are convex.
    let mut solids = soup(
        6,
        &[[0, 1, 2], [1, 0, 3], [0, 2, 3], [2, 1, 3], [0, 1, 4], [1, 0, 5], [0, 4, 5], [4, 1, 5]],
    );
    solids.positions = vec![
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.5],
        [0.0, 1.0, 0.5],
        [-1.0, 0.0, 0.5],
        [0.0, -1.0, 0.5],
    ];
    // Seen from outside.
    for face in &mut solids.faces {
        face.swap(1, 2);
    }
    let done = repaired(solids);
    let report = check(&done.soup);
    assert_eq!((report.faults, report.facts.components.len()), (vec![], 2));
    assert!(report.facts.is_closed());
    assert_eq!(done.junctions, [[0, 1]]);
}

#[test]
fn faces_that_disagree_at_an_edge_still_make_surfaces() {
    let fins = soup(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    let done = repaired(fins);
    assert_eq!(check(&done.soup).faults, []);
}

#[test]
fn a_moebius_band_is_cut_open_across() {
    let moebius = soup(5, &[[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 0], [4, 0, 1]]);
    let done = repaired(moebius);
    let [Repair::CutOpen { face: 0, edges }, ..] = &done.repairs[..] else {
        panic!("{:?}", done.repairs)
    };
    assert_eq!(edges.len(), 1);
    let report = check(&done.soup);
    assert_eq!((report.faults, report.facts.boundary_loops()), (vec![], 1));
    assert_eq!((done.junctions.len(), done.soup.positions.len()), (0, 7));
}

#[test]
fn closed_surfaces_of_one_side_are_cut_open() {
    // The projective plane of six vertices.
    let plane = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 5, 1],
        [1, 2, 4],
        [2, 3, 5],
        [3, 4, 1],
        [4, 5, 2],
        [5, 1, 3],
    ];
    let done = repaired(soup(6, &plane));
    let report = check(&done.soup);
    assert_eq!(report.faults, []);
    assert_eq!((report.facts.boundary_loops(), report.facts.genus()), (1, Some(0)));
}

#[test]
fn a_sheet_that_comes_back_to_an_edge_by_both_ends_is_parted_there() {
    // The fan around vertex 0 passes edge 0-1 twice, and so does that around 1: a closed strip of
    // two loops, pinched along the edge.
    let loops = [[0, 1, 2], [1, 0, 3], [0, 2, 3], [2, 1, 3], [0, 1, 3], [1, 0, 2]];
    let done = repaired(soup(4, &loops));
    assert_eq!(check(&done.soup).errors().count(), 0);
}

#[test]
fn what_names_no_vertex_stays() {
    let faulty = soup(4, &[[0, 1, 9], [0, 1, 2], [0, 1, 2]]);
    let done = repair(faulty.clone());
    assert_eq!(done.soup, faulty);
    let expected = Fault::IndexOutOfRange { face: 0, index: 9, n_vertices: 4 };
    assert_eq!(check(&done.soup).faults[0], expected);
}
