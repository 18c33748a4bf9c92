//! Triangles without area do no harm.
#![allow(clippy::unwrap_used, reason = "a test, with helpers")]

use seamstress::{Features, IntegerMapOptions, MapOptions, QuadOptions, Surface};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_testkit as testkit;

/// A closed smooth surface and one with creases, and the same with vertices on edges, and in two places.
fn shapes() -> Vec<(&'static str, TriangleSoup, Vec<TriangleSoup>)> {
    let torus = testkit::torus(24, 12, 2.0, 0.8);
    let bracket = testkit::subdivide(&testkit::subdivide(&testkit::l_bracket()));
    let with = |soup: &TriangleSoup| {
        let [one, five] = [1, 5].map(|n| {
            let on_edges = testkit::with_vertices_on_edges(soup, n, 3);
            [on_edges, testkit::with_copied_vertices(soup, n, 3)]
        });
        [one, five].concat()
    };
    let shapes = [("torus", torus), ("bracket", bracket)];
    shapes.map(|(name, soup)| (name, soup.clone(), with(&soup))).into()
}

fn surface(soup: &TriangleSoup) -> Surface {
    Surface::from_triangles(&soup.positions, &soup.faces).unwrap()
}

#[test]
fn maps_are_as_without_them() {
    for (name, clean, others) in shapes() {
        let options = MapOptions::default().features(Features::angle(40.0));
        let map = surface(&clean).parametrize(&options).unwrap();
        for (k, soup) in others.iter().enumerate() {
            let other = surface(soup).parametrize(&options).unwrap();
            let (d, e) = (map.distortion(), other.distortion());
            assert!(e.degenerate > 0, "{name} {k}");
            assert!(e.tau < d.tau + 0.15, "{name} {k}: tau {} was {}", e.tau, d.tau);
            let (sd, se) = (d.symmetric_dirichlet, e.symmetric_dirichlet);
            assert!((se - sd).abs() < 0.08, "{name} {k}: energy {se} was {sd}");
            // Where creases say where they are; on a torus many places do as well.
            if name == "bracket" {
                assert_eq!(map.cones().len(), other.cones().len(), "{name} {k}");
            }
            assert!(other.dropped_features().is_empty(), "{name} {k}");
        }
    }
}

#[test]
fn grids_and_quads_are_as_without_them() {
    for (name, clean, others) in shapes() {
        let map = surface(&clean).integer_map(&IntegerMapOptions::count(600)).unwrap();
        for (k, soup) in others.iter().enumerate() {
            let surface = surface(soup);
            let other = surface.integer_map(&IntegerMapOptions::count(600)).unwrap();
            let (tau, was) = (other.distortion().tau, map.distortion().tau);
            assert!(tau < 1.5 * was, "{name} {k}: tau {tau} was {was}");
            let count = other.report().grid.quads;
            assert!((570.0..=630.0).contains(&count), "{name} {k}: {count} quads");
            assert!(other.dropped_features().is_empty(), "{name} {k}");
            let quads = surface.quad_mesh(&QuadOptions::count(600)).unwrap();
            assert!((570..=630).contains(&quads.quads().len()), "{name} {k}");
            let features = quads.report().features.as_ref().unwrap();
            assert_eq!(features.dropped.as_deref(), Some(&[][..]), "{name} {k}");
        }
    }
}
