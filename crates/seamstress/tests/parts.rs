//! Plain quads of parts as drawing programs export them, and of meshes of several parts.
#![cfg(feature = "parallel")]
#![allow(clippy::unwrap_used)]

use seamstress::{GridRounding, GridSize, IntegerMapOptions, QuadOptions, SmallParts, Surface};
use seamstress_testkit as testkit;

#[test]
fn counts_and_creases_are_kept_by_default() {
    // Every third, for time; threads are finer than the cells.
    let parts = testkit::parts().into_iter().step_by(3);
    let (mut edges, mut dropped, mut far_off) = (0, 0, Vec::new());
    for (name, part) in parts.filter(|(name, _)| !name.starts_with("thread")) {
        let surface = Surface::from_triangles(&part.positions, &part.faces).unwrap();
        let quads = surface.quad_mesh(&QuadOptions::count(500)).unwrap();
        let count = quads.quads().len();
        assert!((350..=650).contains(&count), "{name}: {count} quads");
        far_off.extend((!(450..=550).contains(&count)).then(|| format!("{name}: {count}")));
        let report = serde_json::to_value(quads.report()).unwrap();
        assert_eq!(report["orientation"]["inverted"], 0, "{name}");
        let features = &report["features"];
        edges += features["edges"].as_u64().unwrap();
        dropped += features["dropped"].as_array().unwrap().len() as u64;
    }
    assert!(far_off.len() <= 1, "{far_off:?}");
    assert!(100 * dropped < edges, "{dropped} of {edges} feature edges dropped");
}

/// A speck, a box and a speck.
fn box_with_specks() -> Surface {
    let speck = testkit::scale(&testkit::cube(), 0.01);
    let soup = testkit::disjoint_union(&[speck.clone(), testkit::cube(), speck]);
    Surface::from_triangles(&soup.positions, &soup.faces).unwrap()
}

#[test]
fn a_part_that_fails_does_not_sink_the_others() {
    let surface = box_with_specks();
    // Without any heed to its corners a speck is rounded to a point.
    let mut options = IntegerMapOptions::count(600);
    options.rounding = GridRounding::Greedy;
    let error = surface.integer_map(&options).unwrap_err();
    let failed = error.failed_parts().to_vec();
    let named: Vec<_> = failed.iter().map(|f| (f.component, f.first_face, f.faces)).collect();
    assert_eq!(named, [(0, 0, 12), (2, 24, 12)]);
    assert_eq!((failed[0].code, error.code()), ("no-integer-map", "no-integer-map"));
    assert!(error.message().contains("of 2 of 3 components"), "{error:?}");
    assert!(error.message().contains("component 2 (12 faces from face 24): "), "{error:?}");
    assert!(error.hint().unwrap().contains("`partial`"), "{error:?}");

    options.parts.partial = true;
    let map = surface.integer_map(&options).unwrap();
    assert_eq!(map.report().parts.failed, failed);
    assert_eq!((map.face_uvs().len(), map.surface().faces().len()), (12, 12));
    assert_eq!((map.surface().input_face(0), map.surface().input_vertex(0)), (Some(12), Some(8)));
    // As many as the box has in a mesh of all of them.
    assert_eq!(map.report().grid.quads, 600.0);
    assert!(map.report().components_without_quads.is_empty());
    // All fail: there is nothing to make.
    let speck = testkit::cube();
    let speck = Surface::from_triangles(&speck.positions, &speck.faces).unwrap();
    options.size = GridSize::EdgeLength(100.0);
    assert_eq!(speck.integer_map(&options).unwrap_err().code(), "no-integer-map");
}

#[test]
fn small_parts_are_kept_or_left_out_and_counted() {
    let surface = box_with_specks();
    let mut options = QuadOptions::count(600);
    let quads = surface.quad_mesh(&options).unwrap();
    let parts = quads.report().parts.clone().unwrap();
    assert_eq!((parts.small, parts.small_faces, parts.small_left_out), (2, 24, false));
    assert_eq!(quads.report().quads.topology.as_ref().unwrap().components, 3);

    options.parts.small_parts = SmallParts::Drop;
    let quads = surface.quad_mesh(&options).unwrap();
    let report = quads.report();
    let parts = report.parts.clone().unwrap();
    assert_eq!((parts.small, parts.small_faces, parts.small_left_out), (2, 24, true));
    assert_eq!(quads.quads().len(), 600);
    // All that is named is of the surface that was given.
    assert!(quads.sources().iter().all(|point| (12..24).contains(&point.face)));
    let features = report.features.as_ref().unwrap();
    assert_eq!((features.edges, features.dropped.as_deref()), (12, Some(&[][..])));
    assert!(features.nodes.iter().all(|node| (8..16).contains(&node.vertex)));
    assert!(report.map.cones.iter().all(|cone| (8..16).contains(&cone.source.unwrap())));
    assert!(report.quads.components_without_quads.is_empty());

    options.size = GridSize::Quads(1.0);
    assert_eq!(surface.quad_mesh(&options).unwrap_err().code(), "options");
}
