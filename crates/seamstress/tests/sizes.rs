//! Quads whose sizes vary over the surface.
#![cfg(all(feature = "io", feature = "parallel"))]
#![allow(clippy::unwrap_used)]

use seamstress::{
    Attribute, AttributeDomain, AttributeKind, Attributes, MapOptions, QuadMesh, QuadOptions,
    SizeSource, Surface,
};
use seamstress_testkit::torus;

/// A ring flattened to a fifth, whose top and bottom bend little and whose rims bend much.
fn flat_ring() -> Surface {
    let ring = torus(96, 48, 3.0, 1.0);
    let positions: Vec<[f64; 3]> =
        ring.positions.iter().map(|p| [p[0], p[1], 0.2 * p[2]]).collect();
    Surface::from_triangles(&positions, &ring.faces).unwrap()
}

fn options(change: impl FnOnce(&mut MapOptions)) -> QuadOptions {
    let mut options = QuadOptions::count(1500);
    change(&mut options.map);
    options
}

/// The mean length of edges whose middle is somewhere.
fn mean_edge(quads: &QuadMesh, is_there: impl Fn([f64; 3]) -> bool) -> f64 {
    let at = |v: u32| quads.positions()[v as usize];
    let sides = quads.quads().iter().flat_map(|&[a, b, c, d]| [[a, b], [b, c], [c, d], [d, a]]);
    let sides = sides.map(|[a, b]| {
        let middle = [0, 1, 2].map(|k| 0.5 * (at(a)[k] + at(b)[k]));
        let long = (0..3).map(|k| (at(a)[k] - at(b)[k]).powi(2)).sum::<f64>().sqrt();
        (middle, long)
    });
    let there = sides.filter(|&(middle, _)| is_there(middle));
    let (sum, n) = there.fold((0.0, 0.0), |(sum, n), (_, long)| (sum + long, n + 1.0));
    sum / n
}

/// Makes quads whose sizes are those asked for, as their report says.
fn made(surface: &Surface, options: &QuadOptions) -> QuadMesh {
    let quads = surface.quad_mesh(options).unwrap();
    let count = quads.quads().len();
    assert!((1350..=1650).contains(&count), "{count} quads");
    let sizes = quads.report().sizes.unwrap();
    let (ratio, off) = (sizes.median_ratio.unwrap(), sizes.off_95.unwrap());
    assert!((0.94..=1.06).contains(&ratio) && off < 0.3, "{ratio} {off}");
    // In its own metric the map is nearer to an isometry than on the surface.
    let on_surface = quads.report().distortion.unwrap();
    assert!(on_surface.symmetric_dirichlet > sizes.distortion.symmetric_dirichlet);
    quads
}

#[test]
fn quads_are_small_where_the_surface_bends() {
    let surface = flat_ring();
    let quads = made(&surface, &options(|map| map.adaptive = 1.0));
    let radius = |p: [f64; 3]| p[0].hypot(p[1]);
    let rim = mean_edge(&quads, |p| radius(p) > 3.9);
    let top = mean_edge(&quads, |p| (2.8..3.2).contains(&radius(p)));
    assert!(rim < 0.8 * top, "{rim} {top}");
}

#[test]
fn sizes_come_from_what_the_mesh_carries() {
    let surface = flat_ring();
    let n = surface.positions().len();
    let (domain, kind) = (AttributeDomain::Vertex, AttributeKind::Number);
    let half = |p: &[f64; 3]| if p[0] > 0.0 { 0.5 } else { 1.0 };
    let size =
        Attribute::new("size", domain, kind, 1, surface.positions().iter().map(half).collect());
    // The same as a colour: green is 1 for half an edge, and 1/2 for a whole one.
    let green = |p: &[f64; 3]| [0.0, if p[0] > 0.0 { 1.0 } else { 0.5 }, 0.0];
    let color = surface.positions().iter().flat_map(green).collect();
    let color = Attribute::new("paint", domain, AttributeKind::Color, 3, color);
    let surface = surface.with_attributes(Attributes::from(vec![size, color])).unwrap();
    let file = std::env::temp_dir().join(format!("seamstress-sizes-{}.csv", std::process::id()));
    let lines: Vec<String> =
        surface.positions().iter().map(|p| (3.0 * half(p)).to_string()).collect();
    std::fs::write(&file, lines.join("\n")).unwrap();
    let from = |source| options(|map| map.sizes = vec![source]);
    let quads = made(&surface, &from(SizeSource::Property("size".into())));
    let [left, right] = [-1.0, 1.0].map(|side| mean_edge(&quads, |p| side * p[0] > 1.0));
    assert!((1.8..2.2).contains(&(left / right)), "{left} {right}");
    for source in [SizeSource::Color(1), SizeSource::Csv(file.clone())] {
        let same = surface.quad_mesh(&from(source)).unwrap();
        let [left, right] = [-1.0, 1.0].map(|side| mean_edge(&same, |p| side * p[0] > 1.0));
        assert!((1.8..2.2).contains(&(left / right)), "{left} {right}");
    }
    std::fs::remove_file(&file).unwrap();
    assert_eq!(n, surface.positions().len());

    let refused = |source| surface.quad_mesh(&from(source)).unwrap_err().to_string();
    assert_eq!(
        refused(SizeSource::Property("width".into())),
        "sizes: the mesh has no property `width` of vertices"
    );
    assert_eq!(refused(SizeSource::Color(3)), "sizes: the mesh has no such channel of colours");
    let red = refused(SizeSource::Csv("nowhere.csv".into()));
    assert!(red.starts_with("nowhere.csv"), "{red}");
}

#[test]
fn bounds_hold_and_are_refused_where_the_count_cannot() {
    let surface = flat_ring();
    let bounded = options(|map| (map.adaptive, map.max_edge) = (1.0, Some(0.25)));
    let quads = made(&surface, &bounded);
    assert!(quads.report().sizes.unwrap().largest < 0.26);
    let too_small = options(|map| (map.adaptive, map.max_edge) = (1.0, Some(0.01)));
    let error = surface.quad_mesh(&too_small).unwrap_err();
    assert_eq!(error.code(), "options");
    assert!(error.to_string().starts_with("max_edge: "), "{error}");
}

#[test]
fn a_map_takes_sizes_too() {
    let surface = flat_ring();
    let with = |adaptive| {
        let mut options = MapOptions::default();
        options.adaptive = adaptive;
        surface.parametrize(&options).unwrap()
    };
    assert!(with(0.0).report().sizes.is_none());
    let map = with(1.0);
    let sizes = map.report().sizes.unwrap();
    assert!(sizes.distortion.symmetric_dirichlet < map.distortion().symmetric_dirichlet);
    assert!(sizes.median_ratio.is_none());
}
