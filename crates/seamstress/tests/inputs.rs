//! Kinds of inputs that have gone wrong somewhere, each with what is right for it.
#![allow(clippy::unwrap_used, reason = "a test, with helpers")]

use seamstress::{MapOptions, QuadMesh, QuadOptions, Surface};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_testkit as testkit;

fn surface(soup: &TriangleSoup) -> Surface {
    Surface::from_triangles(&soup.positions, &soup.faces).unwrap()
}

/// Quads as anybody asks for them.
fn quads(soup: &TriangleSoup, asked: u32) -> QuadMesh {
    surface(soup).quad_mesh(&QuadOptions::count(asked)).unwrap()
}

/// By what part the number of quads is off.
fn off(quads: &QuadMesh, asked: u32) -> f64 {
    (quads.quads().len() as f64 / f64::from(asked) - 1.0).abs()
}

/// How many feature edges there are, and how many are dropped.
fn features(quads: &QuadMesh) -> (usize, usize) {
    let report = quads.report().features.as_ref().unwrap();
    (report.edges, report.dropped.as_ref().unwrap().len())
}

fn part(name: &str) -> TriangleSoup {
    testkit::parts().into_iter().find(|(of, _)| of == name).unwrap().1
}

fn polygon(n: u32, radius: impl Fn(u32) -> f64) -> Vec<[f64; 2]> {
    let corner = |k: u32| {
        let (sin, cos) = (f64::from(k) / f64::from(n) * std::f64::consts::TAU).sin_cos();
        [radius(k) * cos, radius(k) * sin]
    };
    (0..n).map(corner).collect()
}

#[test]
fn a_thin_plate_has_one_cell_across() {
    let plate = testkit::extruded(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], 0.002);
    let quads = quads(&plate, 500);
    assert!(off(&quads, 500) < 0.05, "{} quads", quads.quads().len());
    assert_eq!(features(&quads), (12, 0));
}

#[test]
fn a_speck_has_quads_of_its_own_and_does_not_spoil_the_count() {
    let speck = testkit::scale(&testkit::cube(), 1e-4);
    let quads = quads(&testkit::disjoint_union(&[testkit::cube(), speck]), 300);
    assert!(off(&quads, 300) < 0.1, "{} quads", quads.quads().len());
    assert_eq!(quads.report().quads.topology.as_ref().unwrap().components, 2);
}

#[test]
fn edges_of_no_length_do_not_change_the_count() {
    let ball = testkit::with_copied_vertices(&testkit::icosphere(3), 1, 5);
    for asked in [100, 200, 400] {
        let quads = quads(&ball, asked);
        assert!(off(&quads, asked) < 0.1, "{} of {asked} quads", quads.quads().len());
    }
}

#[test]
fn a_ball_with_two_triangles_without_area_has_the_map_of_a_ball() {
    let ball = testkit::with_vertices_on_edges(&testkit::uv_sphere(24, 16), 2, 5);
    let map = surface(&ball).parametrize(&MapOptions::default()).unwrap();
    let (tau, cones) = (map.distortion().tau, map.cones().len());
    assert!(tau < 1.5, "tau {tau}");
    assert!((8..=24).contains(&cones), "{cones} cones");
    for asked in [100, 300, 1000] {
        assert!(off(&quads(&ball, asked), asked) < 0.1, "{asked}");
    }
}

#[test]
fn coarse_parts_keep_all_their_edges() {
    let house =
        testkit::extruded(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.8], [0.5, 1.2], [0.0, 0.8]], 1.4);
    let corner = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let star = polygon(10, |k| if k % 2 == 0 { 1.0 } else { 0.5 });
    let shapes = [
        ("box", testkit::cube(), 12),
        ("house", house, 15),
        ("cylinder of few sides", testkit::extruded(&polygon(32, |_| 1.0), 2.0), 64),
        ("cylinder of many sides", testkit::extruded(&polygon(256, |_| 1.0), 2.0), 512),
        ("star", testkit::extruded(&star, 0.5), 30),
        ("corner", testkit::extruded(&corner, 1.0), 18),
    ];
    for (name, soup, edges) in shapes {
        let quads = quads(&soup, 500);
        assert_eq!(features(&quads), (edges, 0), "{name}");
        assert!(off(&quads, 500) < 0.1, "{name}: {} quads", quads.quads().len());
    }
}

#[test]
fn round_corners_are_followed_without_distortion() {
    let quads = quads(&part("round_rectangle_16"), 500);
    assert_eq!(features(&quads).1, 0);
    let tau = quads.report().distortion.unwrap().tau;
    assert!(tau < 3.0, "tau {tau}");
}

#[test]
fn vertices_around_a_hole_are_even_and_on_it() {
    let quads = quads(&part("plate_hole_32_0.6"), 800);
    assert_eq!(features(&quads).1, 0);
    // The hole is the loop of creases nearest to the axis.
    let radius = |v: u32| {
        let [x, y, _] = quads.positions()[v as usize];
        x.hypot(y)
    };
    let sides = quads.quads().iter().flat_map(|q| (0..4).map(|k| [q[k], q[(k + 1) % 4]]));
    let hole = (0..quads.positions().len() as u32).map(radius).fold(f64::INFINITY, f64::min);
    let at_hole = |v: u32| radius(v) < 1.03 * hole;
    let level = |v: u32| quads.positions()[v as usize][2];
    let lengths: Vec<f64> = sides
        .filter(|&[a, b]| at_hole(a) && at_hole(b) && (level(a) - level(b)).abs() < 1e-9)
        .map(|[a, b]| {
            let [p, q] = [a, b].map(|v| quads.positions()[v as usize]);
            (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt()
        })
        .collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let shortest = lengths.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(lengths.len() > 8 && longest < 3.0 * shortest, "{shortest} to {longest}");
}

#[test]
fn holes_that_are_small_against_the_cells_are_round() {
    // A plate with a hole that gets narrower on a flat step: without cones there both circles have as many cells.
    let profile = [[0.3, 0.0], [3.0, 0.0], [3.0, 1.0], [0.6, 1.0], [0.6, 0.5], [0.3, 0.5]];
    let plate = testkit::ring(&profile, 48);
    for asked in [250, 300, 350] {
        let quads = quads(&plate, asked);
        assert!(off(&quads, asked) < 0.1, "{} quads", quads.quads().len());
        assert_eq!(features(&quads).1, 0);
        let (cell, radius) = (quads.report().grid.as_ref().unwrap().edge_length, 0.6);
        let is_on_circle = |&&[x, y, z]: &&[f64; 3]| {
            (z - 1.0f64).abs() < 1e-9 && (x.hypot(y) - radius).abs() < 0.01 * radius
        };
        let n = quads.positions().iter().filter(is_on_circle).count() as f64;
        let sag = radius * (1.0 - (std::f64::consts::PI / n).cos());
        // How many cells a circle has is a wish, which the integers may miss by one.
        assert!(sag < 0.13 * cell, "{asked} quads: {n} cells, {} of one", sag / cell);
    }
}
