//! Quads that follow the directions of principal curvature.
#![cfg(feature = "parallel")]
#![allow(clippy::unwrap_used)]

use seamstress::{QuadMesh, QuadOptions, Surface};
use seamstress_testkit::torus;

/// Mean angle in degrees between the edges of quads on a torus around the third axis and its circles: 22.5 if they lie
/// anyhow.
fn deviation(quads: &QuadMesh) -> f64 {
    let at = |v: u32| quads.positions()[v as usize];
    let sides = quads.quads().iter().flat_map(|&[a, b, c, d]| [[a, b], [b, c], [c, d], [d, a]]);
    let (mut sum, mut length) = (0.0, 0.0);
    for [a, b] in sides {
        let (a, b) = (at(a), at(b));
        let along = [0, 1, 2].map(|k| b[k] - a[k]);
        let long = along.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (x, y) = (a[0] + b[0], a[1] + b[1]);
        let around = (along[1] * x - along[0] * y).abs() / (x.hypot(y) * long);
        let angle = around.min(1.0).asin().to_degrees();
        sum += long * angle.min(90.0 - angle);
        length += long;
    }
    sum / length
}

#[test]
fn quads_run_around_and_along_a_ring() {
    let ring = torus(128, 16, 10.0, 1.0);
    let surface = Surface::from_triangles(&ring.positions, &ring.faces).unwrap();
    let made = surface.quad_mesh(&QuadOptions::count(600)).unwrap();
    let found = deviation(&made);
    assert!(found < 2.0, "{found} degrees");
    assert_eq!(made.irregular().len(), 0);
    let count = made.quads().len();
    assert!((570..=630).contains(&count), "{count} quads");
}

#[test]
fn directions_can_be_left_out() {
    let ring = torus(128, 16, 10.0, 1.0);
    let surface = Surface::from_triangles(&ring.positions, &ring.faces).unwrap();
    let with = |align| {
        let mut options = QuadOptions::count(600);
        options.map.align = align;
        surface.quad_mesh(&options).unwrap()
    };
    assert_eq!(with(None).positions(), with(Some(1.0)).positions());
    assert_ne!(with(None).positions(), with(Some(0.0)).positions());
    assert_eq!(with(Some(0.0)).report().options.as_ref().unwrap().map.align, Some(0.0));
}
