//! Plain quads of parts as drawing programs export them.
#![cfg(feature = "parallel")]
#![allow(clippy::unwrap_used)]

use seamstress::{QuadOptions, Surface};

#[test]
fn counts_and_creases_are_kept_by_default() {
    // Every third, for time; threads are finer than the cells.
    let parts = seamstress_testkit::parts().into_iter().step_by(3);
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
