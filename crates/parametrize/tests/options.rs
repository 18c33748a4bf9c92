//! What options do to a map, and what is reported about it.

mod common;

use common::{assert_seamless, mapped, mapped_with};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parametrize::MapOptions;
use seamstress_parametrize::rounding::RoundingStrategy;
use seamstress_testkit as kit;

#[test]
fn every_setting_gives_a_map() {
    let surface = kit::bumpy(&kit::torus(14, 10, 2.0, 0.8), 0.2, 4);
    let with = |change: &dyn Fn(&mut MapOptions)| {
        let mut options = MapOptions::default();
        change(&mut options);
        mapped_with(&surface, &options)
    };
    for bias in [0.0, 0.25, 4.0] {
        with(&|options| options.rounding.cone_bias = bias);
    }
    for rounds in [0, 1, 5] {
        with(&|options| options.rounding.rounds = rounds);
    }
    for iterations in [0, 1] {
        with(&|options| options.rounding.layout_iterations = iterations);
    }
    for strategy in [RoundingStrategy::ConeBias, RoundingStrategy::LocalEstimation] {
        with(&|options| options.rounding.strategy = strategy);
    }
    let as_rounded = with(&|options| options.cone_price = Some(0.0));
    let cleaned = with(&|options| options.cone_price = Some(1.0));
    assert!(cleaned.map.cones().len() <= as_rounded.map.cones().len());
}

#[test]
fn paying_for_cones_never_makes_more_and_can_make_fewer() {
    let mut saved = 0;
    for seed in [2, 4, 5, 9] {
        let surface = kit::random_surface(seed);
        let cones = |cone_price| {
            let options = MapOptions { cone_price: Some(cone_price), ..MapOptions::default() };
            mapped_with(&surface, &options).map.cones().len()
        };
        let as_rounded = cones(0.0);
        for price in [0.0006, 0.005, 0.01] {
            let cleaned = cones(price);
            assert!(cleaned <= as_rounded);
            saved += as_rounded - cleaned;
        }
    }
    assert!(saved > 0);
}

#[test]
fn the_distortion_is_that_of_the_map() {
    let soup = kit::random_surface(4);
    let solution = mapped(&soup);
    let (mesh, metric) = common::surface(&soup);
    let again =
        seamstress_parametrize::quality::distortion(&mesh, &metric, solution.map.corner_uvs());
    assert_eq!(again, solution.distortion);
    // UVs come at the scale of least symmetric Dirichlet energy: means of squares and of inverse
    // squares agree there, so that no other scale is better.
    let energy = |scale: f64| {
        let uvs: Vec<[f64; 2]> =
            solution.map.corner_uvs().iter().map(|p| p.map(|x| x * scale)).collect();
        fixed_scale_energy(&soup, &uvs)
    };
    assert!((energy(1.0) - solution.distortion.symmetric_dirichlet).abs() < 1e-6);
    assert!(energy(1.01) > energy(1.0) && energy(0.99) > energy(1.0));
    assert_seamless(&soup, &solution);
}

/// Mean symmetric Dirichlet energy, from the edge vectors in space and in the plane.
fn fixed_scale_energy(soup: &TriangleSoup, uvs: &[[f64; 2]]) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (f, face) in soup.faces.iter().enumerate() {
        let [p, q, r] = face.map(|v| soup.positions[v as usize]);
        let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let (e, g) = (minus(q, p), minus(r, p));
        let (ee, eg, gg) = (dot(e, e), dot(e, g), dot(g, g));
        let determinant = ee * gg - eg * eg;
        let [a, b, c] = [0, 1, 2].map(|k| uvs[3 * f + k]);
        let (x, y) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let flat = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let (xx, xy, yy) = (flat(x, x), flat(x, y), flat(y, y));
        // Traces of the first fundamental forms against each other, both ways.
        let forth = (xx * gg - 2.0 * xy * eg + yy * ee) / determinant;
        let back = (ee * yy - 2.0 * eg * xy + gg * xx) / (xx * yy - xy * xy);
        let area = determinant.sqrt() / 2.0;
        sum += area * (forth + back);
        total += area;
    }
    sum / total
}
