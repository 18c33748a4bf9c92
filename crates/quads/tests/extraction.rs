//! Quads from exact integer maps, whose quads are known beforehand.
#![allow(clippy::unwrap_used, clippy::panic)]

use proptest::prelude::*;
use seamstress_mesh::TriMesh;
use seamstress_mesh::features::sharp_edges;
use seamstress_parallel::with_threads;
use seamstress_parametrize::progress::{Cancelled, Progress, go_on};
use seamstress_quads::extract::MapFault;
use seamstress_quads::{ExtractError, ExtractOptions, Extraction, QuadConnectivity, extract};
use seamstress_testkit::{
    IntegerMap, annulus, cube, cylinder, disk_grid, l_bracket, random_voxels, slab_with_holes,
    squares, torus,
};
use std::ops::ControlFlow;

fn mesh_of(map: &IntegerMap) -> TriMesh {
    TriMesh::from_faces(map.soup.positions.len(), &map.soup.faces).unwrap()
}

fn try_extract(map: &IntegerMap, options: &ExtractOptions) -> Result<Extraction, ExtractError> {
    extract(&mesh_of(map), &map.soup.positions, &map.corner_uvs, options, &mut go_on)
}

fn extracted(map: &IntegerMap) -> Extraction {
    try_extract(map, &ExtractOptions::default()).unwrap()
}

/// What must hold of every result: manifold, the source's topology, cones where irregular, and
/// vertices on the source.
fn check(map: &IntegerMap, found: &Extraction) -> QuadConnectivity {
    let source = mesh_of(map);
    let quads = found.mesh.connectivity().unwrap();
    assert_eq!(quads.euler_characteristic(), source.euler_characteristic());
    assert_eq!(quads.n_boundary_loops(), source.n_boundary_loops());
    assert_eq!(quads.connected_quads().1, source.connected_faces().1);
    assert_eq!(quads.n_quads() as f64, map.area().round());
    assert!((found.uv_area - map.area()).abs() < 1e-6);
    assert_eq!((found.trimmed, found.split_vertices, &found.folds), (0, 0, &None));
    let irregular: Vec<(u32, i32)> =
        quads.irregular_vertices().iter().map(|v| (v.vertex, v.index)).collect();
    let cones: Vec<(u32, i32)> = found.cones.iter().map(|c| (c.vertex, c.index)).collect();
    assert_eq!(irregular, cones);
    for cone in &found.cones {
        let at = map.soup.positions[cone.source.unwrap() as usize];
        assert_eq!(found.mesh.positions()[cone.vertex as usize], at);
    }
    for at in &found.sources {
        assert!((at.barycentric.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(at.barycentric.iter().all(|&w| w >= 0.0));
    }
    quads
}

/// Quads as sorted rings of positions, which tell them whatever their order.
fn rings(quads: impl Iterator<Item = [[f64; 3]; 4]>, n: f64) -> Vec<[[i64; 3]; 4]> {
    let ring = |quad: [[f64; 3]; 4]| {
        let mut ring = quad.map(|p| p.map(|x| (x * n).round() as i64));
        let first = (0..4).min_by_key(|&k| ring[k]).unwrap();
        ring.rotate_left(first);
        ring
    };
    let mut rings: Vec<_> = quads.map(ring).collect();
    rings.sort_unstable();
    rings
}

fn found_rings(found: &Extraction, n: u32) -> Vec<[[i64; 3]; 4]> {
    let positions = found.mesh.positions();
    rings(found.mesh.quads().iter().map(|q| q.map(|v| positions[v as usize])), f64::from(n))
}

/// Every square of a surface of unit squares, cut into `n` by `n`.
fn expected_rings(map: &IntegerMap, n: u32) -> Vec<[[i64; 3]; 4]> {
    let mut quads = Vec::new();
    for pair in map.soup.faces.chunks(2) {
        let [a, b, _, d] = [pair[0][0], pair[0][1], pair[0][2], pair[1][2]]
            .map(|v| map.soup.positions[v as usize]);
        let at = |i: u32, j: u32| {
            let (s, t) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
            [0, 1, 2].map(|k| a[k] + s * (b[k] - a[k]) + t * (d[k] - a[k]))
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            quads.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    rings(quads.into_iter(), f64::from(n))
}

#[test]
fn it_stops_when_the_observer_breaks() {
    let map = squares(&torus(6, 6, 2.0, 0.7), 1);
    let mut seen = Vec::new();
    for calls in 0..7 {
        let mut left = calls;
        let mut observer = |progress: Progress| {
            seen.push(progress.fraction);
            left -= 1;
            if left < 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let options = ExtractOptions::default();
        let (positions, uvs) = (&map.soup.positions, &map.corner_uvs);
        let found = extract(&mesh_of(&map), positions, uvs, &options, &mut observer);
        match calls {
            6 => assert!(found.is_ok()),
            _ => assert_eq!(found, Err(ExtractError::Cancelled(Cancelled)), "{calls}"),
        }
    }
    assert_eq!(seen[seen.len() - 6..], [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
}

#[test]
fn a_cube_is_six_quads() {
    let map = squares(&cube(), 1);
    let found = extracted(&map);
    check(&map, &found);
    assert_eq!(found.mesh.quads().len(), 6);
    assert_eq!(found.cones.iter().map(|c| c.index).collect::<Vec<_>>(), [1; 8]);
    assert_eq!(found_rings(&found, 1), expected_rings(&map, 1));
}

#[test]
fn squares_are_cut_into_squares_whatever_triangles_lie_below() {
    for (soup, n) in
        [(cube(), 3), (l_bracket(), 2), (slab_with_holes(1), 4), (slab_with_holes(2), 5)]
    {
        let map = squares(&soup, n);
        let expected = expected_rings(&map, n);
        let finer = map.subdivided();
        let variants = [
            map.clone(),
            map.clone().with_random_charts(100, 1),
            finer.clone(),
            finer.subdivided().with_random_charts(3, 2),
            map.with_random_points(3),
            finer.with_random_points(4).with_random_charts(7, 5),
        ];
        for map in variants {
            let found = extracted(&map);
            check(&map, &found);
            assert_eq!(found_rings(&found, n), expected);
        }
    }
}

#[test]
fn aligned_boundaries_are_quads_up_to_the_rim() {
    for soup in [disk_grid(3, 2), annulus(5, 2), cylinder(4, 3)] {
        for n in [1, 3] {
            let map = squares(&soup, n).subdivided().with_random_charts(9, 6);
            let quads = check(&map, &extracted(&map));
            assert!(quads.has_boundary());
        }
    }
}

#[test]
fn vertices_on_features_stay_on_their_curves() {
    for (soup, n, n_nodes, n_curves) in
        [(cube(), 3, 8, 12), (disk_grid(3, 2), 2, 4, 4), (cylinder(8, 3), 2, 0, 2)]
    {
        let map = squares(&soup, n).subdivided();
        let source = mesh_of(&map);
        let found = extracted(&map);
        let edges = sharp_edges(&source, &map.soup.positions, 1.0).vertex_pairs(&source);
        let constraints = found.constraints(&source, (&map.soup.positions).into(), &edges);
        assert_eq!((constraints.fixed.len(), constraints.curves.len()), (n_nodes, n_curves));
        let at = |v: u32| found.mesh.positions()[v as usize];
        let quads = found.mesh.connectivity().unwrap();
        let mut held = constraints.fixed.clone();
        for curve in &constraints.curves {
            held.extend(&curve.vertices);
            for &v in &curve.vertices {
                // On a segment of the curve: as far from its ends as they are apart.
                let gap = |pair: &[[f64; 3]]| {
                    let [a, b] = [distance(pair[0], at(v)), distance(pair[1], at(v))];
                    (a + b - distance(pair[0], pair[1])).abs()
                };
                assert!(curve.points.windows(2).any(|pair| gap(pair) < 1e-12));
            }
        }
        held.sort_unstable();
        held.dedup();
        let on_features: Vec<u32> = match n_nodes {
            // All vertices with two coordinates of the cube's sides.
            8 => (0..quads.n_vertices() as u32)
                .filter(|&v| at(v).iter().filter(|x| x.fract() == 0.0).count() > 1)
                .collect(),
            _ => (0..quads.n_vertices() as u32).filter(|&v| quads.is_boundary(v)).collect(),
        };
        assert_eq!(held, on_features);
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The square `[-1, 1]²` as a map of itself, turned and scaled.
fn turned_square(angle: f64, scale: f64) -> IntegerMap {
    let soup = disk_grid(4, 4);
    let (sin, cos) = angle.sin_cos();
    let image = |[x, y, _]: [f64; 3]| [scale * (cos * x - sin * y), scale * (sin * x + cos * y)];
    let corners = soup.faces.as_flattened().iter();
    let corner_uvs = corners.map(|&v| image(soup.positions[v as usize])).collect();
    IntegerMap { soup, corner_uvs }
}

#[test]
fn cells_cut_by_the_boundary_are_left_out_and_counted() {
    for (angle, scale) in [(0.3, 4.0), (0.7, 5.5), (0.0, 3.5), (1.1, 10.2)] {
        let found = extracted(&turned_square(angle, scale));
        // A cell is in the convex square if its corners are.
        let (sin, cos) = f64::sin_cos(angle);
        let is_inside = |i: i32, j: i32| {
            let (u, v) = (f64::from(i), f64::from(j));
            (cos * u + sin * v).abs() <= scale && (cos * v - sin * u).abs() <= scale
        };
        let cells = (-20..20).flat_map(|i| (-20..20).map(move |j| (i, j)));
        let corners = |(i, j)| [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)];
        let whole = cells.filter(|&cell| corners(cell).iter().all(|&(i, j)| is_inside(i, j)));
        assert_eq!(found.mesh.quads().len(), whole.count(), "{angle}, {scale}");
        assert!(found.trimmed > 0);
        let quads = found.mesh.connectivity().unwrap();
        assert_eq!(quads.irregular_vertices(), []);
    }
}

#[test]
fn too_coarse_a_map_has_no_quads() {
    let error = try_extract(&turned_square(0.3, 0.4), &ExtractOptions::default()).unwrap_err();
    assert_eq!(error, ExtractError::NoQuads { partial: 4 });
}

#[test]
fn a_needle_of_the_last_place_changes_nothing() {
    // A vertex inside a square, a hair from its side.
    let map = squares(&cube(), 2);
    for hair in [1e-3, 1e-9, 1e-13] {
        let mut map = map.with_random_points(1);
        let middle = map.corner_uvs[2];
        for uv in map.corner_uvs[..9].iter_mut().filter(|uv| **uv == middle) {
            *uv = [1.0, hair];
        }
        let found = extracted(&map);
        assert_eq!(check(&map, &found).n_quads(), 24);
    }
}

#[test]
fn every_fault_of_a_map_is_named() {
    let map = squares(&torus(4, 3, 2.0, 0.7), 2);
    let error = |change: &dyn Fn(&mut Vec<[f64; 2]>)| {
        let mut map = map.clone();
        change(&mut map.corner_uvs);
        try_extract(&map, &ExtractOptions::default()).unwrap_err()
    };
    assert!(matches!(
        error(&|uv| {
            uv.pop();
        }),
        ExtractError::WrongCount { expected: 72, found: 71, .. }
    ));
    assert_eq!(error(&|uv| uv[10][1] = f64::NAN), ExtractError::NonFiniteUv { face: 3 });
    assert!(matches!(error(&|uv| uv[13][0] = 1e300), ExtractError::TooLarge { face: 4, .. }));
    let ExtractError::NotInteger(faults) = error(&|uv| uv[4][0] += 0.25) else { panic!("open") };
    assert!(!faults.is_seamless() && faults.0.len() == 2, "{faults}");
    assert!(
        faults
            .0
            .iter()
            .all(|f| matches!(f, MapFault::OpenEdge { faces, .. } if faces.contains(&1)))
    );
    // A whole chart moved by half: seamless, not integral.
    let shift = |uv: &mut Vec<[f64; 2]>| uv[..6].iter_mut().for_each(|uv| uv[0] += 0.5);
    let ExtractError::NotInteger(faults) = error(&shift) else { panic!("half") };
    assert!(faults.is_seamless() && faults.0.len() == 4, "{faults}");
    assert!(faults.to_string().contains("has the translation"), "{faults}");
    assert!(matches!(
        error(&|uv| uv.iter_mut().flatten().for_each(|x| *x *= 1e7)),
        ExtractError::TooFine { .. }
    ));
}

#[test]
fn cones_between_grid_points_are_named() {
    // A cube mapped by squares of side one, then moved by a half in every chart: translations of seams
    // with a turn become integral or not, cones are off.
    let mut map = squares(&cube(), 2);
    for x in map.corner_uvs.as_flattened_mut() {
        *x *= 0.5;
        *x += 0.5;
    }
    let error = try_extract(&map, &ExtractOptions::default()).unwrap_err();
    let ExtractError::NotInteger(faults) = error else { panic!("{error}") };
    let cones = faults.0.iter().filter(|f| matches!(f, MapFault::ConeOffGrid { index: 1, .. }));
    assert_eq!(cones.count(), 8, "{faults}");
}

#[test]
fn folds_are_refused_by_name_and_worked_around_on_request() {
    // A vertex inside a face of the split cube is pushed over its opposite side.
    let mut map = squares(&cube(), 4).with_random_points(1);
    let middle = map.corner_uvs[2];
    for uv in map.corner_uvs[..9].iter_mut().filter(|uv| **uv == middle) {
        *uv = [1.9, 2.4];
    }
    let error = try_extract(&map, &ExtractOptions::default()).unwrap_err();
    assert_eq!(error, ExtractError::Folds { flipped: vec![2], collapsed: vec![] });
    let options = ExtractOptions { best_effort: true, ..ExtractOptions::default() };
    let found = try_extract(&map, &options).unwrap();
    let quads = found.mesh.connectivity().unwrap();
    assert_eq!((quads.n_quads(), quads.euler_characteristic()), (96, 2));
    assert_eq!(quads.irregular_vertices().len(), 8);
    let folds = found.folds.unwrap();
    assert_eq!((folds.flipped, folds.lost), (vec![2], 0));
}

#[test]
fn threads_leave_no_trace() {
    let map = squares(&slab_with_holes(2), 4).subdivided().with_random_points(8);
    let all = extracted(&map);
    assert_eq!(with_threads(1, || extracted(&map)).unwrap(), all);
}

fn random_map(genus: u32, n: u32, seed: u64) -> IntegerMap {
    let soup = if genus == 0 { random_voxels(10, seed) } else { slab_with_holes(genus) };
    let map = squares(&soup, n);
    match seed % 3 {
        0 => map,
        1 => map.with_random_points(seed),
        _ => map.subdivided(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn random_quads_come_back(genus in 0u32..3, n in 1u32..4, seed in any::<u64>()) {
        let map = random_map(genus, n, seed).with_random_charts(50, seed);
        let expected = squares(&if genus == 0 { random_voxels(10, seed) } else { slab_with_holes(genus) }, n);
        let found = extracted(&map);
        check(&map, &found);
        prop_assert_eq!(found_rings(&found, n), expected_rings(&expected, n));
        for cone in &found.cones {
            prop_assert_eq!(4 - cone.index, expected.quad_valences()[&cone.source.unwrap()] as i32);
        }
    }

    #[test]
    fn moving_regular_vertices_moves_no_quad_away(genus in 0u32..3, n in 1u32..4, seed in any::<u64>()) {
        let map = random_map(genus, n, seed).with_random_charts(5, seed).with_moved_vertices(0.4, seed);
        let found = extracted(&map);
        check(&map, &found);
    }

    #[test]
    fn noise_is_removed_and_reported(genus in 0u32..3, seed in any::<u64>()) {
        let exact = random_map(genus, 2, seed).with_random_charts(5, seed);
        let noisy = exact.clone().with_noise(1e-6, seed);
        let found = extracted(&noisy);
        prop_assert!(found.snapping.gap > 0.0 && found.snapping.largest_change < 3e-6);
        let (a, b) = (extracted(&exact).mesh, found.mesh);
        prop_assert_eq!(a.connectivity().unwrap().irregular_vertices().len(), b.connectivity().unwrap().irregular_vertices().len());
        prop_assert_eq!(a.quads().len(), b.quads().len());
    }
}
