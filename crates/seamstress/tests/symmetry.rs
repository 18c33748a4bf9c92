//! What must be true of quads that are to be symmetric.
#![allow(clippy::unwrap_used)]

use seamstress::{
    Attribute, AttributeDomain, AttributeKind, Features, MapOptions, QuadMesh, QuadOptions,
    Surface, Symmetry,
};
use seamstress_testkit::{
    bumpy, cube, cylinder, disk_grid, double_torus, icosphere, l_bracket, remove_faces, ring,
    slab_with_holes, stretch, subdivide, torus, uv_sphere,
};
use std::collections::{BTreeMap, BTreeSet};

type Soup = seamstress_mesh::soup::TriangleSoup;

fn surface(soup: &Soup) -> Surface {
    Surface::from_triangles(&soup.positions, &soup.faces).unwrap()
}

fn options(count: u32, symmetry: &str) -> QuadOptions {
    let map = MapOptions::default().symmetry(symmetry.parse().unwrap());
    QuadOptions::count(count).map(map)
}

/// A place, to the bit; both zeros are one.
fn place(p: &[f64; 3]) -> [u64; 3] {
    p.map(|x| (x + 0.0).to_bits())
}

/// Every vertex and every quad has its image, to the bit, at every plane.
fn assert_symmetric(made: &QuadMesh, name: &str) {
    let quads = |image: &dyn Fn(&[f64; 3]) -> [f64; 3]| -> BTreeSet<Vec<[u64; 3]>> {
        let places = |quad: &[u32; 4]| {
            let mut places: Vec<_> =
                quad.iter().map(|&v| place(&image(&made.positions()[v as usize]))).collect();
            places.sort_unstable();
            places
        };
        made.quads().iter().map(places).collect()
    };
    let report = made.report().symmetry.as_ref().unwrap();
    for plane in &report.planes {
        let axis = plane.normal.iter().position(|&x| x == 1.0).unwrap();
        let image = |p: &[f64; 3]| {
            let mut image = *p;
            image[axis] -= 2.0 * (p[axis] - plane.offset);
            image
        };
        assert_eq!(quads(&|p| *p), quads(&image), "{name}: {plane}");
    }
}

#[test]
fn quads_are_symmetric_to_the_bit_and_nothing_is_lost() {
    let moved = |mut soup: Soup| {
        soup.positions.iter_mut().for_each(|p| p[0] += 0.7);
        soup
    };
    let open = remove_faces(&uv_sphere(16, 9), &(0..16).collect::<Vec<_>>());
    let shapes: [(&str, Soup, &str, u32); 10] = [
        ("ball", icosphere(4), "xyz", 600),
        ("ellipsoid", moved(stretch(&uv_sphere(17, 12), [1.0, 2.0, 0.7])), "yz", 500),
        ("torus", torus(24, 12, 2.0, 0.7), "xyz", 800),
        ("torus of other triangles", torus(23, 11, 2.0, 0.7), "y", 800),
        ("cube", subdivide(&cube()), "auto", 300),
        ("double torus", double_torus(), "auto", 600),
        ("slab", slab_with_holes(2), "auto", 700),
        ("bracket", l_bracket(), "auto", 400),
        ("open ball", open, "auto", 400),
        ("ring", ring(&[[2.0, 0.0], [3.0, 0.0], [3.0, 0.5], [2.0, 0.5]], 32), "auto", 500),
    ];
    for (name, soup, symmetry, count) in &shapes {
        let surface = surface(soup);
        let made = surface.quad_mesh(&options(*count, symmetry)).unwrap();
        assert_symmetric(&made, name);
        let (report, plain) = (made.report(), surface.report());
        let topology = report.quads.topology.as_ref().unwrap();
        assert_eq!(topology.euler_characteristic, plain.euler_characteristic, "{name}");
        assert_eq!(topology.boundary_loops, plain.boundary_loops, "{name}");
        assert_eq!(topology.components, plain.components.len(), "{name}");
        let share = made.quads().len() as f64 / f64::from(*count);
        assert!((0.9..1.1).contains(&share), "{name}: {} quads", made.quads().len());
        let dropped = report.features.as_ref().and_then(|features| features.dropped.clone());
        assert_eq!(dropped.unwrap_or_default(), [], "{name}");
        assert_eq!(report.grid.as_ref().unwrap().quads, made.quads().len() as f64, "{name}");
        // A row of edges in each plane: the rest is on one side or the other.
        for plane in &report.symmetry.as_ref().unwrap().planes {
            let axis = plane.normal.iter().position(|&x| x == 1.0).unwrap();
            let heights: Vec<f64> =
                made.positions().iter().map(|p| p[axis] - plane.offset).collect();
            for quad in made.quads() {
                let sides: BTreeSet<bool> = quad
                    .iter()
                    .map(|&v| heights[v as usize])
                    .filter(|&height| height != 0.0)
                    .map(|height| height > 0.0)
                    .collect();
                assert_eq!(sides.len(), 1, "{name}: a quad crosses {plane}");
            }
        }
        // Sources are where the vertices come from.
        for (point, position) in made.sources().iter().zip(made.positions()) {
            let at = point.position(surface.positions(), surface.faces());
            let away = (0..3).map(|k| at[k] - position[k]).fold(0.0, f64::hypot);
            assert!(away < 0.3, "{name}: {away}");
        }
    }
}

#[test]
fn without_symmetry_nothing_changes() {
    let surface = surface(&torus(16, 8, 2.0, 0.7));
    let [plain, none] = [QuadOptions::count(300), options(300, "none")]
        .map(|options| surface.quad_mesh(&options).unwrap());
    assert_eq!(plain.positions(), none.positions());
    assert_eq!(plain.report().symmetry, None);
    // Nothing is found where nothing is symmetric.
    let bumpy = bumpy(&icosphere(2), 0.25, 3);
    let surface = self::surface(&bumpy);
    let [plain, auto] = [QuadOptions::count(200), options(200, "auto")]
        .map(|options| surface.quad_mesh(&options).unwrap());
    assert_eq!((plain.positions(), plain.quads()), (auto.positions(), auto.quads()));
}

#[test]
fn a_plane_that_is_given_is_mirrored_at() {
    let ball = surface(&icosphere(4));
    let made = ball.quad_mesh(&options(400, "plane:1,1,0,0")).unwrap();
    let image = |p: &[f64; 3]| [-p[1], -p[0], p[2]];
    let gap = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| a[k] - b[k]).fold(0.0, f64::hypot);
    for p in made.positions() {
        let nearest = made.positions().iter().map(|q| gap(q, &image(p)));
        assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-14, "{p:?}");
    }
    let error = ball.quad_mesh(&options(400, "plane:1,1,0,0.2")).unwrap_err();
    assert_eq!(error.code(), "not-symmetric");
}

#[test]
fn features_of_one_side_alone_are_dropped_and_named() {
    let surface = surface(&subdivide(&subdivide(&cube())));
    let at = |p: [f64; 3]| surface.positions().iter().position(|q| *q == p).unwrap() as u32;
    // Halfway along two edges of the cube, one on each side of the plane in its middle; one turned around.
    let (over, under) = ([[1.0, 0.0, 0.0], [1.0, 0.25, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.25, 0.0]]);
    let edge = |ends: [[f64; 3]; 2]| ends.map(at);
    for (edges, n_dropped) in [(vec![over, under], 0), (vec![over], 0), (vec![under], 1)] {
        let features = Features::edges(edges.iter().copied().map(edge).collect::<Vec<_>>());
        let options = options(200, "x").features(features);
        let made = surface.quad_mesh(&options).unwrap();
        let features = made.report().features.clone().unwrap();
        let dropped = features.dropped.unwrap();
        assert_eq!(dropped.len(), n_dropped, "{edges:?}");
        assert_eq!(features.kept, Some(edges.len() - n_dropped), "{edges:?}");
        let mut strict = options;
        strict.map.features_strict = true;
        let made = surface.quad_mesh(&strict);
        assert_eq!(made.is_ok(), n_dropped == 0, "{edges:?}");
        assert!(made.err().is_none_or(|error| error.code() == "dropped-features"));
    }
}

#[test]
fn attributes_come_over_on_both_sides() {
    let soup = torus(24, 12, 2.0, 0.7);
    let surface = surface(&soup);
    let heights: Vec<f64> = soup.positions.iter().map(|p| p[0]).collect();
    let sides: Vec<f64> = soup
        .faces
        .iter()
        .map(|face| face.iter().map(|&v| soup.positions[v as usize][0]).sum::<f64>())
        .map(|x| if x > 0.0 { 1.0 } else { 0.0 })
        .collect();
    let of =
        |name: &str, domain, kind, values: Vec<f64>| Attribute::new(name, domain, kind, 1, values);
    let made = surface.quad_mesh(&options(600, "x")).unwrap();
    let given = [
        of("height", AttributeDomain::Vertex, AttributeKind::Number, heights),
        of("side", AttributeDomain::Face, AttributeKind::Label, sides),
    ];
    let carried = made.transfer(&given).unwrap();
    for (v, p) in made.positions().iter().enumerate() {
        let height = carried[0].of(v)[0];
        assert!((p[0] - height).abs() < 0.1, "{p:?}: {height}");
    }
    for (q, quad) in made.quads().iter().enumerate() {
        let middle: f64 = quad.iter().map(|&v| made.positions()[v as usize][0]).sum();
        assert_eq!(carried[1].of(q)[0] > 0.5, middle > 0.0);
    }
}

#[test]
fn cones_and_parts_are_those_of_the_whole() {
    // Two cylinders beside the plane, and one across it.
    let beside = |x: f64| {
        let mut soup = cylinder(12, 6);
        soup.positions.iter_mut().for_each(|p| p[0] += x);
        soup
    };
    let all = seamstress_testkit::disjoint_union(&[beside(5.0), beside(0.0), beside(-5.0)]);
    let made = surface(&all).quad_mesh(&options(600, "x")).unwrap();
    assert_symmetric(&made, "cylinders");
    let topology = made.report().quads.topology.clone().unwrap();
    assert_eq!((topology.components, topology.boundary_loops), (3, 6));
    assert!(made.report().quads.components_without_quads.is_empty());

    let made = surface(&icosphere(4)).quad_mesh(&options(600, "xyz")).unwrap();
    let cones: BTreeMap<u32, i32> =
        made.report().map.cones.iter().map(|cone| (cone.vertex, cone.index)).collect();
    let irregular: BTreeMap<u32, i32> =
        made.irregular().iter().map(|found| (found.vertex, found.index)).collect();
    assert_eq!(cones, irregular);
    assert_eq!(cones.values().sum::<i32>(), 8);
    assert_eq!("auto".parse::<Symmetry>(), Ok(Symmetry::Auto));
}

#[test]
fn small_folds_in_the_plane_are_left_out_and_sheets_there_refused() {
    let mut soup = roof(16);
    let at = |x: f64, y: f64| {
        let is_at = |p: &[f64; 3]| p[0] == x / 16.0 && p[1] == 1.5 * (y / 16.0);
        soup.positions.iter().position(is_at).unwrap() as u32
    };
    let (beside, on_plane) =
        ([-1.0, 0.0, 1.0].map(|y| at(1.0, y)), [-1.0, 0.0, 1.0].map(|y| at(0.0, y)));
    let ([d, e, f], [a, b, c]) = (beside, on_plane);
    let is_near = |face: &[u32; 3]| face.iter().all(|v| beside.contains(v) || on_plane.contains(v));
    soup.faces.retain(|face| !is_near(face));
    soup.faces.extend([[a, d, e], [a, e, c], [c, e, f], [a, c, b]]);
    let made = surface(&soup).quad_mesh(&options(300, "x")).unwrap();
    assert_symmetric(&made, "fold");
    let topology = made.report().quads.topology.clone().unwrap();
    assert_eq!((topology.euler_characteristic, topology.boundary_loops), (1, 1));

    let error = surface(&disk_grid(4, 4)).quad_mesh(&options(100, "z")).unwrap_err();
    assert_eq!(error.code(), "not-symmetric");
    assert!(error.message().contains("in the plane"), "{error}");
}

/// The mean length of edges whose middle is somewhere.
fn mean_edge(made: &QuadMesh, is_there: impl Fn([f64; 3]) -> bool) -> f64 {
    let at = |v: u32| made.positions()[v as usize];
    let sides = made.quads().iter().flat_map(|&[a, b, c, d]| [[a, b], [b, c], [c, d], [d, a]]);
    let there = sides.map(|ends| ends.map(at)).filter(|[a, b]| {
        let middle = [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]));
        is_there(middle)
    });
    let lengths: Vec<f64> =
        there.map(|[a, b]| (0..3).map(|k| a[k] - b[k]).fold(0.0, f64::hypot)).collect();
    lengths.iter().sum::<f64>() / lengths.len() as f64
}

#[test]
fn sizes_of_one_side_count_on_both() {
    let soup = icosphere(4);
    let half = |p: &[f64; 3]| if p[1] > 0.0 && p[0] < 0.0 { 0.5 } else { 1.0 };
    let values = soup.positions.iter().map(half).collect();
    let (domain, kind) = (AttributeDomain::Vertex, AttributeKind::Number);
    let painted = vec![Attribute::new("size", domain, kind, 1, values)];
    let surface = surface(&soup).with_attributes(painted.into()).unwrap();
    let mut options = options(1000, "x");
    options.map.sizes = vec!["property:size".parse().unwrap()];
    let made = surface.quad_mesh(&options).unwrap();
    assert_symmetric(&made, "painted ball");
    let count = made.quads().len();
    assert!((900..1100).contains(&count), "{count} quads");
    let [back, front] = [-1.0, 1.0].map(|side| mean_edge(&made, |p| side * p[1] > 0.5));
    assert!((1.7..2.3).contains(&(back / front)), "{back} {front}");
}

#[test]
fn edges_in_the_plane_are_no_boundary_of_the_surface() {
    let mut options = options(500, "xy");
    options.map.sizes = vec!["boundary:0.3".parse().unwrap(), "features:0.3".parse().unwrap()];
    let made = surface(&icosphere(4)).quad_mesh(&options).unwrap();
    let sizes = made.report().sizes.unwrap();
    assert!(sizes.largest < sizes.least * 1.001, "{sizes}");
}

#[test]
fn curvature_and_directions_go_with_symmetry() {
    let soup = stretch(&torus(48, 24, 2.0, 0.7), [1.0, 1.0, 0.4]);
    let mut options = options(800, "xz");
    options.map.adaptive = 1.0;
    options.map.directions = vec!["edges:0-1".parse().unwrap()];
    let made = surface(&soup).quad_mesh(&options).unwrap();
    assert_symmetric(&made, "flat ring");
    let radius = |p: [f64; 3]| p[0].hypot(p[1]);
    let rim = mean_edge(&made, |p| radius(p) > 2.6);
    let top = mean_edge(&made, |p| (1.8..2.2).contains(&radius(p)));
    assert!(rim < 0.85 * top, "{rim} {top}");
}

#[test]
fn maps_of_symmetric_triangles_are_symmetric() {
    let symmetric = |axes: &str| MapOptions::default().symmetry(axes.parse().unwrap());
    let soup = roof(8);
    let surface = surface(&soup);
    let map = surface.parametrize(&symmetric("xy")).unwrap();
    surface.certify(map.uvs(), map.face_uvs()).unwrap();
    // Twice the area in UVs of each triangle, by the place of its middle.
    let area = |f: usize| {
        let [a, b, c] = map.face_uvs()[f].map(|k| map.uvs()[k as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let middle = |f: usize, signs: [f64; 3]| {
        let corners = soup.faces[f].map(|v| soup.positions[v as usize]);
        [0, 1, 2].map(|k| {
            (signs[k] * 1e6 * (corners[0][k] + corners[1][k] + corners[2][k])).round() as i64
        })
    };
    let n = soup.faces.len();
    let areas: BTreeMap<[i64; 3], f64> = (0..n).map(|f| (middle(f, [1.0; 3]), area(f))).collect();
    assert_eq!(areas.len(), n);
    for signs in [[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0]] {
        for f in 0..n {
            let gap = areas[&middle(f, signs)] - area(f);
            assert!(gap.abs() < 1e-12 * area(f), "{gap}");
        }
    }
    // Triangles of a torus are not symmetric: quads can be, a map cannot.
    let torus = self::surface(&torus(24, 12, 2.0, 0.7));
    let error = torus.parametrize(&symmetric("x")).unwrap_err();
    assert_eq!(error.code(), "not-symmetric", "{error}");
}

/// A square over the plane, higher in its middle, in four times `n` by `n` cells with diagonals that are images of each
/// other.
fn roof(n: u32) -> Soup {
    let n = n as i32;
    let side = 2 * n + 1;
    let at = |i: i32, j: i32| ((i + n) * side + j + n) as u32;
    let mut soup = Soup::default();
    for i in -n..=n {
        for j in -n..=n {
            let [x, y] = [i, j].map(|k| f64::from(k) / f64::from(n));
            soup.positions.push([x, 1.5 * y, 1.0 - x * x - 0.5 * y * y]);
        }
    }
    for i in -n..n {
        for j in -n..n {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            soup.faces.extend(match (i < 0) == (j < 0) {
                true => [[a, b, c], [a, c, d]],
                false => [[a, b, d], [b, c, d]],
            });
        }
    }
    soup
}
