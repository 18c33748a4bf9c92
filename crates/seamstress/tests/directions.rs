//! Quads that follow the directions of principal curvature.
#![cfg(all(feature = "io", feature = "parallel"))]
#![allow(clippy::unwrap_used)]

use seamstress::{DirectionSource, FeatureSource, Features, QuadMesh, QuadOptions, Surface};
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

/// A flat square of two by two, whose lines may lie anyhow.
fn square() -> Surface {
    let grid = seamstress_testkit::disk_grid(24, 24);
    Surface::from_triangles(&grid.positions, &grid.faces).unwrap()
}

/// Mean angle in degrees between edges of quads and a direction of the plane, or the one at right angles.
fn plane_deviation(quads: &QuadMesh, direction: f64) -> f64 {
    let at = |v: u32| quads.positions()[v as usize];
    let sides = quads.quads().iter().flat_map(|&[a, b, c, d]| [[a, b], [b, c], [c, d], [d, a]]);
    let off = sides.map(|[a, b]| {
        let angle = (at(b)[1] - at(a)[1]).atan2(at(b)[0] - at(a)[0]).to_degrees() - direction;
        let angle = angle.rem_euclid(90.0);
        angle.min(90.0 - angle)
    });
    let off: Vec<f64> = off.collect();
    off.iter().sum::<f64>() / off.len() as f64
}

#[test]
fn any_direction_in_a_plane_is_followed() {
    let surface = square();
    let name = format!("seamstress-{}-turned.rosy", std::process::id());
    let file = std::env::temp_dir().join(name);
    // The surface is unfolded along its sides: 45 degrees are as far from there as can be.
    for degrees in [0.0, 15.0, 30.0, 45.0, 60.0] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let rows = vec![format!("{cos} {sin} 0\n"); surface.faces().len()].concat();
        std::fs::write(&file, format!("{}\n4\n{rows}", surface.faces().len())).unwrap();
        let mut options = QuadOptions::count(400).features(Features::none());
        options.map.directions = vec![DirectionSource::Field(file.clone())];
        let found = plane_deviation(&surface.quad_mesh(&options).unwrap(), degrees);
        assert!(found < 0.5, "{found} from {degrees} degrees");
    }
    std::fs::remove_file(file).unwrap();
}

#[test]
fn strokes_fields_and_edges_are_followed() {
    let surface = square();
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let folder = std::env::temp_dir();
    let file = |name: &str| folder.join(format!("seamstress-{}-{name}", std::process::id()));
    // Two strokes somewhat above the surface.
    let strokes = file("strokes.obj");
    let [x, y] = [0.7 * cos, 0.7 * sin];
    let lines = format!(
        "v {0} {1} 0.01\nv {2} {3} 0.01\nv {4} {1} 0.01\nv {5} {3} 0.01\nl 1 2\nl 3 4\n",
        -x,
        -y,
        x,
        y,
        -x - 0.3,
        x - 0.3
    );
    std::fs::write(&strokes, lines).unwrap();
    let field = file("square.rosy");
    let rows = vec![format!("{cos} {sin} 0\n"); surface.faces().len()].concat();
    std::fs::write(&field, format!("{}\n4\n{rows}", surface.faces().len())).unwrap();
    let along = |source: DirectionSource| {
        let mut options = QuadOptions::count(400).features(Features::none());
        options.map.directions = vec![source];
        plane_deviation(&surface.quad_mesh(&options).unwrap(), 30.0)
    };
    let found = [
        along(DirectionSource::Strokes(strokes.clone())),
        along(DirectionSource::Field(field.clone())),
    ];
    assert!(found.iter().all(|&off| off < 3.0), "{found:?}");
    // Edges of the diagonal of the grid.
    let diagonal = (0..24).map(|k| [25 * k + k, 25 * (k + 1) + k + 1]).collect();
    let mut options = QuadOptions::count(400).features(Features::none());
    options.map.directions = vec![DirectionSource::Edges(FeatureSource::Edges(diagonal))];
    let found = plane_deviation(&surface.quad_mesh(&options).unwrap(), 45.0);
    assert!(found < 3.0, "{found}");

    let mut options = QuadOptions::count(400);
    options.map.directions = vec![DirectionSource::Field(strokes.clone())];
    let error = surface.quad_mesh(&options).unwrap_err();
    assert_eq!(error.code(), "unreadable", "{error}");
    for file in [strokes, field] {
        std::fs::remove_file(file).unwrap();
    }
}
