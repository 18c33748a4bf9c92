//! Files are read as they stand, and a map keeps its source: every vertex and face that was touched is named.
#![allow(clippy::unwrap_used, reason = "a test")]

use seamstress_certify::{Map, Obj, Tolerance, Violation, compare_source};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_testkit::cube;

#[test]
fn a_map_must_not_touch_its_source() {
    let source = cube();
    let compare = |map: &TriangleSoup| {
        compare_source((&source.positions, &source.faces), (&map.positions, &map.faces))
    };
    assert_eq!(compare(&source), []);
    let changed = |change: &dyn Fn(&mut TriangleSoup)| {
        let mut map = source.clone();
        change(&mut map);
        compare(&map)
    };
    let found = changed(&|map| map.positions[5][1] += 0.25);
    assert_eq!(found, [Violation::MovedVertex { vertex: 5, distance: 0.25 }]);
    let found = changed(&|map| map.positions[2][0] = map.positions[2][0].next_up());
    assert!(matches!(found[..], [Violation::MovedVertex { vertex: 2, .. }]));
    let found = changed(&|map| map.positions[3][2] = f64::NAN);
    assert!(matches!(found[..], [Violation::MovedVertex { vertex: 3, .. }]));
    let found = changed(&|map| map.faces[7][0] = (map.faces[7][0] + 1) % 8);
    assert_eq!(found, [Violation::ChangedFace { face: 7 }]);
    let found = changed(&|map| map.faces[4].rotate_left(1));
    assert_eq!(found, [Violation::ChangedFace { face: 4 }]);
    let found = changed(&|map| map.faces.swap(0, 11));
    assert_eq!(found, [0, 11].map(|face| Violation::ChangedFace { face }));
    let found = changed(&|map| map.positions.push([0.0; 3]));
    assert_eq!(found, [Violation::VertexCount { source_count: 8, map: 9 }]);
    let found = changed(&|map| map.faces.truncate(11));
    assert_eq!(found, [Violation::FaceCount { source_count: 12, map: 11 }]);
}

/// A square of two triangles in two charts.
const SQUARE: &str = "# by hand
v 0 0 0
v 1 0 0
v 1.0 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 5 0
vt 6 1
vt 5 1
f 1/1 2/2 3/3
f 1/4 3/5 4/6
";

#[test]
fn a_file_is_certified_by_the_checker_alone() {
    let file = Obj::<3>::read(SQUARE).unwrap();
    let uvs: Vec<_> = file.face_uvs.as_flattened().iter().map(|&k| file.uvs[k as usize]).collect();
    let map = Map::new(file.positions.len(), &file.faces, &uvs).unwrap();
    let seams = map.seamless(&Tolerance::default()).unwrap().seams;
    assert_eq!((seams.len(), seams[0].translation), (1, [5.0, 0.0]));
    assert_eq!(map.integers(&[], &Tolerance::default()).unwrap().area, 1.0);
}

#[test]
fn statements_in_all_their_forms() {
    let square = Obj::<3>::read(SQUARE).unwrap();
    assert_eq!((square.faces[1], square.face_uvs[1]), ([0, 2, 3], [3, 4, 5]));
    for (from, to) in [
        ("\n", "\r\n"),
        ("\n", "\r"),
        ("\n", " # of f 7 7 7\n"),
        ("# by hand", "\u{feff}# \\"),
        ("# by hand", "g v 1\nusemtl f\nvn x\n\ns off\nl 1 2"),
        ("f 1/1 2/2 3/3", "f 1/1 \\\n2/2 3/3"),
        ("f 1/1 2/2 3/3", "\tfo  1/1/1\t2/2/ 3/3/9 "),
        ("f 1/1 2/2 3/3", "f -4/-6 -3/-5 -2/-4"),
        ("v 1.0 1 0", "v 1e0 +1 0.0 0.5 0.5 0.5"),
        ("vt 1 0\n", "vt 1\n"),
        ("vt 1 1\n", "vt 1 1 7\n"),
    ] {
        let text = SQUARE.replace(from, to);
        assert_ne!(text, SQUARE);
        assert_eq!(Obj::read(&text), Ok(square.clone()), "{text}");
    }
    let quad = Obj::<4>::read("v 0 0 0\nf 1 2 3 4\nf 4//1 3/ 2 1\n").unwrap();
    assert_eq!((quad.faces, quad.face_uvs), (vec![[0, 1, 2, 3], [3, 2, 1, 0]], vec![]));
}

#[test]
fn decimals_are_the_nearest_doubles() {
    let text = "v 0.1 9007199254740993 1e-320\nv -2.5E3 1e400 nan";
    let Obj::<3> { positions, .. } = Obj::read(text).unwrap();
    assert_eq!(positions[0], [0.1, 9_007_199_254_740_992.0, 1e-320]);
    assert_eq!(positions[1][..2], [-2500.0, f64::INFINITY]);
    assert!(positions[1][2].is_nan());
}

#[test]
fn lines_that_cannot_be_read_are_named() {
    for (line, is_whole) in [
        ("v 0 0", false),
        ("v 0 0 x", false),
        ("vt", false),
        ("vt 0 y", false),
        ("f 1 2", false),
        ("f 1 2 3 4", false),
        ("f 0 1 2", false),
        ("f 1 2 -5", false),
        ("f 1 2 x", false),
        ("f 1 2 -9223372036854775808", false),
        ("f 1 2 4294967297", false),
        ("f 1 2 4294967296", true),
        ("f 1/x 2/1 3/1", true),
    ] {
        let found = Obj::<3>::read(&format!("{SQUARE}\n{line}\nv 0 0 0"));
        assert_eq!(found.err(), (!is_whole).then_some(15), "{line}");
    }
}
