//! What a guest may rely on: surfaces, errors with their elements, contexts, ids of the input.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test, with helpers")]

use seamstress::{
    CancelToken, Context, ErrorCategory, ExtractionOptions, Features, Inspection,
    IntegerMapOptions, MapOptions, QuadOptions, Stage, Surface, SurfaceOptions, Weld,
};
use seamstress_testkit as testkit;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

fn torus() -> Surface {
    let soup = testkit::torus(16, 8, 2.0, 0.7);
    Surface::from_triangles(&soup.positions, &soup.faces).unwrap()
}

#[test]
fn a_map_has_a_uv_for_every_corner_and_is_certified_again() {
    let surface = torus();
    let map = surface.parametrize(&MapOptions::default()).unwrap();
    assert_eq!(map.face_uvs().len(), surface.faces().len());
    let corners: Vec<[f64; 2]> =
        map.face_uvs().as_flattened().iter().map(|&uv| map.uvs()[uv as usize]).collect();
    assert_eq!(corners, map.corner_uvs());
    let certificate = surface.certify(map.uvs(), map.face_uvs()).unwrap();
    assert_eq!(&certificate, map.certificate());
    assert_eq!(certificate.faces, 256);
    assert_eq!(map.report().input.genus, Some(1));
}

#[test]
fn a_broken_map_is_refused_with_its_elements() {
    let surface = torus();
    let map = surface.parametrize(&MapOptions::default()).unwrap();
    // Turn a triangle over by giving two of its corners each other's UVs.
    let mut face_uvs = map.face_uvs().to_vec();
    face_uvs[7].swap(0, 1);
    let error = surface.certify(map.uvs(), &face_uvs).unwrap_err();
    assert_eq!((error.code(), error.kind().category()), ("not-a-map", ErrorCategory::Input));
    assert!(error.elements().faces.contains(&7), "{:?}", error.elements());
    let kinds: Vec<&str> = error.findings().iter().map(|f| f.kind.as_str()).collect();
    assert!(kinds.contains(&"flipped-triangle"), "{kinds:?}");
    assert_eq!(error.stage(), Some(Stage::Certificate));
}

#[test]
fn uvs_of_another_mesh_are_refused() {
    let error = torus().certify(&[[0.0; 2]; 3], &[[0, 1, 2]]).unwrap_err();
    assert_eq!(error.to_string(), "UVs for 1 faces; the surface has 256");
    let error = torus().certify(&[], &vec![[0, 0, 9]; 256]).unwrap_err();
    assert_eq!(error.to_string(), "face 0 names UV 0; there are 0");
}

#[test]
fn what_is_no_surface_is_refused_with_its_elements() {
    // Three triangles at one edge.
    let positions =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    let error =
        Surface::from_triangles(&positions, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap_err();
    assert_eq!(error.code(), "not-a-surface");
    assert_eq!(error.elements().edges, [[0, 1]]);
    assert_eq!(error.elements().faces, [0, 1, 2]);
    assert!(error.to_string().contains("edge 0-1 has 3 faces"), "{error}");
    assert!(error.hint().is_some());
}

#[test]
fn ids_of_the_input_are_kept_through_polygons_and_repairs() {
    // A quad, a triangle given twice, another quad, and a vertex in no face.
    let positions: Vec<[f64; 3]> = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [1, 2], [9, 9]]
        .map(|[x, y]| [f64::from(x), f64::from(y), 0.0])
        .to_vec();
    let polygons = [vec![0, 1, 4, 3], vec![3, 4, 6], vec![3, 4, 6], vec![1, 2, 5, 4]];
    let refused = Surface::from_polygons(&positions, &polygons).unwrap_err();
    assert_eq!(refused.hint(), Some("all of them can be repaired: add `repair`"));
    let options = SurfaceOptions::default().repair(true);
    let inspection = Inspection::of_polygons(&positions, &polygons, &options);
    assert_eq!(inspection.report().polygons_read, 4);
    assert!(!inspection.report().repairs.is_empty());
    let surface = inspection.surface().unwrap();
    let origins: Vec<Option<u32>> = (0..5).map(|face| surface.input_face(face)).collect();
    assert_eq!(origins, [Some(0), Some(0), Some(1), Some(3), Some(3)]);
    assert_eq!(surface.positions().len(), 7);
    assert_eq!(surface.input_vertex(6), Some(6));
    assert_eq!((surface.input_vertex(7), surface.input_face(5)), (None, None));
}

/// A flat grid of `n` by `n` unit squares, every corner a vertex of its own and moved by up to `noise`.
fn unwelded_grid(n: u32, noise: f64) -> (Vec<[f64; 3]>, Vec<[u32; 4]>) {
    let mut positions = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        for [x, y] in [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]] {
            let wave = noise * (positions.len() as f64 * 1.7).sin();
            positions.push([f64::from(x) + wave, f64::from(y), wave]);
        }
    }
    let quads = (0..n * n).map(|q| [0, 1, 2, 3].map(|k| 4 * q + k)).collect();
    (positions, quads)
}

#[test]
fn soups_are_welded_and_say_so() {
    for noise in [0.0, 1e-6] {
        let (positions, quads) = unwelded_grid(5, noise);
        let open = |weld| {
            let options = SurfaceOptions::default().weld(weld);
            Inspection::of_polygons(&positions, &quads, &options)
        };
        for weld in [Weld::Soups, Weld::Auto, Weld::Within(1e-3)] {
            let inspection = open(weld);
            let report = inspection.report();
            assert_eq!(
                (report.vertices, report.components.len(), report.welded_vertices),
                (36, 1, 64)
            );
            assert!(report.notes.iter().any(|note| note.starts_with("merged 64 vertices")));
            let surface = inspection.surface().unwrap();
            // Edges by any of the names that their ends had: 1 of the first quad is 0 of the sixth.
            let features = |edge| surface.features(&Features::edges([edge])).unwrap();
            assert_eq!(features([1, 2]).edges(), features([20, 23]).edges());
        }
        assert_eq!(open(Weld::Off).report().components.len(), 25);
        let exact = if noise > 0.0 { 25 } else { 1 };
        assert_eq!(open(Weld::Within(0.0)).report().components.len(), exact);
    }
}

#[test]
fn components_without_quads_are_named() {
    // A map of a square of two by two cells, and of a triangle smaller than one.
    let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let uvs = [square.as_slice(), &[[5.2, 0.2], [5.7, 0.2], [5.2, 0.7]]].concat();
    let positions: Vec<[f64; 3]> = uvs.iter().map(|&[u, v]| [u, v, 0.0]).collect();
    let faces = [[0, 1, 2], [0, 2, 3], [4, 5, 6]];
    let surface = Surface::from_triangles(&positions, &faces).unwrap();
    let (features, options) = (Features::none(), ExtractionOptions::default());
    let quads = surface.extract_quads(&uvs, &faces, &features, &options).unwrap();
    assert_eq!(quads.quads().len(), 4);
    assert_eq!(quads.report().quads.components_without_quads, [1]);
}

/// What repairs make of polygons.
fn repaired<P: AsRef<[u32]>>(positions: &[[f64; 3]], polygons: &[P]) -> (Vec<String>, Surface) {
    let options = SurfaceOptions::default().repair(true);
    let inspection = Inspection::of_polygons(positions, polygons, &options);
    (inspection.report().repairs.clone(), inspection.surface().unwrap())
}

/// The corners of a unit cube, x fastest.
fn corners_of_a_cube() -> Vec<[f64; 3]> {
    (0..8u8).map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(f64::from)).collect()
}

const CUBE: [[u32; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

#[test]
fn polygons_given_twice_are_dropped_whatever_corner_they_begin_with() {
    let cube = corners_of_a_cube();
    for again in [[3, 1, 0, 2], [1, 3, 2, 0], [0, 2, 3, 1]] {
        let polygons = [CUBE.as_slice(), &[again]].concat();
        let refused = Surface::from_polygons(&cube, &polygons).unwrap_err();
        assert_eq!(refused.hint(), Some("all of them can be repaired: add `repair`"));
        let (repairs, surface) = repaired(&cube, &polygons);
        let [repair] = &repairs[..] else { panic!("{repairs:?}") };
        assert!(repair.starts_with("dropped face 6, "), "{repair}");
        assert_eq!((surface.faces().len(), surface.report().boundary_loops), (12, 0));
    }
}

#[test]
fn repeated_corners_and_edges_of_no_length_are_mended() {
    let mut cube = corners_of_a_cube();
    // The lid as two triangles, one given as a quad; a copy of corner 0 beside it in one side.
    cube.push(cube[0]);
    let mut polygons: Vec<Vec<u32>> = CUBE.iter().map(|quad| quad.to_vec()).collect();
    polygons[1] = vec![4, 5, 7, 7];
    polygons.push(vec![4, 7, 6]);
    polygons[0] = vec![8, 0, 2, 3, 1];
    polygons[2] = vec![8, 1, 5, 4, 0];
    let (repairs, surface) = repaired(&cube, &polygons);
    let expected = [
        "made one of vertices 0, 8, joined by sides of length zero",
        "left 4 corners of face 0; the others repeated them",
        "left 3 corners of face 1; the others repeated them",
        "left 4 corners of face 2; the others repeated them",
    ];
    assert_eq!(repairs, expected);
    let report = surface.report();
    assert_eq!((report.vertices, report.faces, report.boundary_loops), (8, 12, 0));
    assert_eq!(report.genus, Some(0));
}

#[test]
fn edges_of_more_faces_are_cut_and_kept_as_junctions() {
    // A cube with a wall inside, which divides it in two.
    let mut positions = corners_of_a_cube();
    positions.extend([[0.5, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, 0.0, 1.0], [0.5, 1.0, 1.0]]);
    let (a, b, c, d) = (8, 9, 10, 11);
    let polygons = [
        [0, 2, b, a],
        [a, b, 3, 1],
        [4, c, d, 6],
        [c, 5, 7, d],
        [0, a, c, 4],
        [a, 1, 5, c],
        [2, 6, d, b],
        [b, d, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [a, c, d, b],
    ];
    let (_, surface) = repaired(&positions, &polygons);
    let report = surface.report();
    let mut junctions = report.junction_edges.clone();
    junctions.sort_unstable();
    assert_eq!(junctions, [[8, 9], [8, 10], [9, 11], [10, 11]]);
    // The box, and the wall by itself: both have the curve on them.
    assert_eq!((report.components.len(), report.boundary_loops), (2, 1));
    let curve = surface.features(&Features::edges(junctions)).unwrap();
    assert_eq!((curve.edges().len(), curve.report().boundary_edges), (8, 4));
}

#[test]
fn work_reports_progress_and_stops_on_request() {
    let stages = Arc::new(Mutex::new(Vec::new()));
    let seen = Arc::clone(&stages);
    let watched = Context::new().observer(move |progress| {
        assert!((0.0..=1.0).contains(&progress.fraction));
        seen.lock().unwrap().push(progress.stage);
        ControlFlow::Continue(())
    });
    torus().with_context(watched).parametrize(&MapOptions::default()).unwrap();
    let stages = stages.lock().unwrap();
    for stage in [Stage::Rounding, Stage::Layout, Stage::Certificate] {
        assert!(stages.contains(&stage), "{stage:?} in {stages:?}");
    }

    let calls = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&calls);
    let third = Context::new().observer(move |_| match counted.fetch_add(1, Ordering::Relaxed) {
        0 | 1 => ControlFlow::Continue(()),
        _ => ControlFlow::Break(()),
    });
    let stopped = torus().with_context(third).parametrize(&MapOptions::default()).unwrap_err();
    assert_eq!((stopped.code(), stopped.kind().category()), ("cancelled", ErrorCategory::Stopped));
    assert!(stopped.stage().is_some());
    assert_eq!(calls.load(Ordering::Relaxed), 3);
}

#[test]
fn a_token_and_a_time_limit_stop_work() {
    let token = CancelToken::new();
    let surface = torus().with_context(Context::new().cancel_token(&token));
    token.cancel();
    let error = surface.parametrize(&MapOptions::default()).unwrap_err();
    assert_eq!(error.code(), "cancelled");

    let late = torus().with_context(Context::new().time_limit(Duration::ZERO));
    let error = late.quad_mesh(&QuadOptions::count(100)).unwrap_err();
    assert_eq!(error.code(), "time-limit");
    assert_eq!(error.hint(), Some("allow more with `time_limit`"));
}

#[test]
fn work_that_needs_more_memory_than_allowed_is_refused_before_it_starts() {
    let expected = Arc::new(AtomicU64::new(0));
    let seen = Arc::clone(&expected);
    let observed = torus().with_context(Context::new().observer(move |progress| {
        seen.store(progress.expected_memory, Ordering::Relaxed);
        assert!((1..1000).contains(&progress.expected_time.as_millis()), "{progress:?}");
        ControlFlow::Continue(())
    }));
    observed.parametrize(&MapOptions::default()).unwrap();
    let expected = expected.load(Ordering::Relaxed);
    assert!(expected > 1_000_000, "{expected}");

    let limited = |limit| torus().with_context(Context::new().memory_limit(limit));
    assert!(limited(expected).parametrize(&MapOptions::default()).is_ok());
    let refused = limited(expected - 1).parametrize(&MapOptions::default()).unwrap_err();
    assert_eq!(
        (refused.code(), refused.kind().category()),
        ("memory-limit", ErrorCategory::Stopped)
    );
    assert_eq!(refused.stage(), None);
    // Many cells take more than few.
    let limited = limited(1_000_000_000);
    assert!(limited.quad_mesh(&QuadOptions::count(100)).is_ok());
    for refused in [
        limited.quad_mesh(&QuadOptions::count(10_000_000)).unwrap_err(),
        limited.integer_map(&IntegerMapOptions::count(10_000_000)).unwrap_err(),
    ] {
        assert_eq!(refused.code(), "memory-limit");
        let hint = "allow more with `memory_limit`, or take a coarser mesh or fewer quads";
        assert_eq!(refused.hint(), Some(hint));
    }
}

#[test]
fn the_map_does_not_depend_on_threads() {
    let on = |threads| {
        let surface = torus().with_context(Context::new().threads(threads));
        surface.parametrize(&MapOptions::default()).unwrap().uvs().to_vec()
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn features_are_named_by_edges_of_the_input() {
    let soup = testkit::cube();
    let cube = Surface::from_triangles(&soup.positions, &soup.faces).unwrap();
    let curves = cube.features(&Features::angle(40.0)).unwrap();
    assert_eq!((curves.edges().len(), curves.report().junctions), (12, 8));
    let named = cube.features(&Features::edges(curves.edges().to_vec())).unwrap();
    assert_eq!(named.edges(), curves.edges());

    let error = cube.features(&Features::edges([[0, 99]])).unwrap_err();
    assert_eq!((error.code(), error.stage()), ("bad-features", Some(Stage::Features)));
    assert_eq!(error.elements().edges, [[0, 99]]);
    assert!(error.to_string().contains("edge 0-99: "), "{error}");
}

#[test]
fn impossible_options_are_refused_before_any_work() {
    let observed = Context::new().observer(|_| panic!("no work may be done"));
    let surface = torus().with_context(observed);
    let options = MapOptions::default().cone_bias(-1.0);
    assert_eq!(surface.parametrize(&options).unwrap_err().code(), "options");
    assert_eq!(surface.quad_mesh(&QuadOptions::count(0)).unwrap_err().code(), "options");
}

#[test]
fn quads_know_where_they_come_from() {
    let surface = torus();
    let quads = surface.quad_mesh(&QuadOptions::count(120).raw(true)).unwrap();
    assert_eq!(quads.sources().len(), quads.positions().len());
    let n_faces = surface.faces().len() as u32;
    assert!(quads.sources().iter().all(|source| source.face < n_faces));
    let report = quads.report();
    assert!(report.quads.is_manifold && report.quads.count == quads.quads().len());
    let topology = report.quads.topology.as_ref().unwrap();
    assert_eq!((topology.euler_characteristic, topology.boundary_loops), (0, 0));
    // Index sum of a torus.
    assert_eq!(quads.irregular().iter().map(|v| v.index).sum::<i32>(), 0);
}

#[test]
fn sheets_that_were_cut_apart_keep_their_common_curve() {
    // Three plane rectangles at one edge: two of them go on into each other, the third stands on them.
    let wing = |[x, y]: [f64; 2]| {
        let mut wing = testkit::disk_grid(4, 4);
        wing.positions.iter_mut().for_each(|p| *p = [x * (p[0] + 1.0), y * (p[0] + 1.0), p[1]]);
        wing
    };
    let soup = testkit::disjoint_union(&[[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]].map(wing));
    let options = SurfaceOptions::default().repair(true).weld(Weld::Within(1e-9));
    let surface =
        Inspection::of_polygons(&soup.positions, &soup.faces, &options).surface().unwrap();
    assert_eq!(surface.report().junction_edges.len(), 4);
    let quads = surface.quad_mesh(&QuadOptions::count(300)).unwrap();
    let features = quads.report().features.as_ref().unwrap();
    assert_eq!(features.dropped.as_deref(), Some(&[][..]));
    // Along the curve run edges of quads, on both sheets.
    let is_on_curve = |v: u32| {
        let [x, y, _] = quads.positions()[v as usize];
        x.abs().max(y.abs()) < 1e-9
    };
    let sides = quads.quads().iter().flat_map(|q| (0..4).map(|k| [q[k], q[(k + 1) % 4]]));
    let mut on_curve: Vec<[u32; 2]> = sides
        .filter(|side| side.iter().all(|&v| is_on_curve(v)))
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    on_curve.sort_unstable();
    on_curve.dedup();
    let height = |v: u32| quads.positions()[v as usize][2];
    let length: f64 = on_curve.iter().map(|&[a, b]| (height(a) - height(b)).abs()).sum();
    assert!((length - 4.0).abs() < 1e-9, "{length}");
}
