//! A map keeps its source: every vertex and face that was touched is named.

use seamstress_certify::{Violation, compare_source};
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
