//! Feature edges and boundaries along the axes: what is aligned is, and what is not is named.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of a test")]

mod common;

use common::{mesh_of, surface, unwatched};
use seamstress_mesh::features::{EdgeFinder, EdgeSet, sharp_edges};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Halfedge, TriMesh, Vertex};
use seamstress_parallel::with_threads;
use seamstress_parametrize::cut::{MatchedCut, Unfolding};
use seamstress_parametrize::rounding::{RoundingOptions, repair, round};
use seamstress_parametrize::{
    MapError, MapOptions, MapSolution, Objective, RelayoutOptions, ReleaseReason, Sectors,
    make_aligned_map, relayout,
};
use seamstress_testkit as kit;
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_4;
use std::ops::ControlFlow;

/// Pairs of the edges at which the surface bends by half a right angle at least.
fn creases(soup: &TriangleSoup) -> Vec<[u32; 2]> {
    let mesh = mesh_of(soup);
    sharp_edges(&mesh, &soup.positions, FRAC_PI_4).vertex_pairs(&mesh)
}

/// A shortest path of edges between two vertices.
fn path(mesh: &TriMesh, from: u32, to: u32) -> Vec<[u32; 2]> {
    let mut previous = vec![None; mesh.n_vertices()];
    let mut queue = VecDeque::from([from]);
    while let Some(v) = queue.pop_front() {
        for w in mesh.outgoing(Vertex(v)).map(|h| mesh.tip(h).0) {
            if w != from && previous[w as usize].is_none() {
                previous[w as usize] = Some(v);
                queue.push_back(w);
            }
        }
    }
    let mut edges = Vec::new();
    let mut at = to;
    while at != from {
        let before = previous[at as usize].unwrap();
        edges.push([before, at]);
        at = before;
    }
    edges
}

/// Edges between the faces of a set and the others.
fn rim(mesh: &TriMesh, inside: impl Fn(usize) -> bool) -> Vec<[u32; 2]> {
    let splits = |h: &Halfedge| {
        let t = mesh.twin(*h).unwrap();
        inside(h.face().at()) != inside(t.face().at())
    };
    let pair = |h: Halfedge| [mesh.origin(h).0, mesh.tip(h).0];
    mesh.interior_edges().filter(splits).map(pair).collect()
}

/// The largest deviation of the given edges from an axis, degrees, and of the angles between them from
/// multiples of a right one. Works on the numbers of the map alone.
fn misalignment(mesh: &TriMesh, corner_uvs: &[[f64; 2]], edges: &EdgeSet) -> [f64; 2] {
    let side = |h: Halfedge| {
        let (a, b) = (corner_uvs[h.at()], corner_uvs[h.next().at()]);
        [b[0] - a[0], b[1] - a[1]]
    };
    let off_axis = |h: Halfedge| {
        let [x, y] = side(h).map(f64::abs);
        x.min(y).atan2(x.max(y)).to_degrees()
    };
    let aligned = mesh.halfedges().filter(|&h| edges.contains(h));
    let axis = aligned.map(off_axis).fold(0.0, f64::max);
    let corner = |h: Halfedge| {
        let ([a, b], [c, d]) = (side(h), side(h.prev()));
        (a * -d - b * -c).atan2(a * -c + b * -d).to_degrees()
    };
    let mut angle = 0.0f64;
    for v in mesh.vertices() {
        let fan: Vec<Halfedge> = mesh.outgoing(v).collect();
        let Some(first) = fan.iter().position(|&h| edges.contains(h)) else { continue };
        let (mut sum, mut closed) = (0.0, !mesh.is_boundary(v) || first == 0);
        for k in 0..fan.len() {
            let h = fan[(first + k) % fan.len()];
            if mesh.is_boundary(v) && first + k >= fan.len() {
                closed = false;
            }
            sum += corner(h);
            if edges.contains(h.prev()) && closed {
                let off = (sum / 90.0 - (sum / 90.0).round()).abs() * 90.0;
                angle = angle.max(if sum > 45.0 { off } else { 90.0 });
                sum = 0.0;
            }
        }
    }
    [axis, angle]
}

fn aligned_with(
    soup: &TriangleSoup,
    features: &EdgeSet,
    options: &MapOptions,
) -> Result<MapSolution, MapError> {
    let mut go_on = |_| ControlFlow::Continue(());
    make_aligned_map(&mesh_of(soup), &soup.positions, features, options, &mut go_on)
}

/// The map with features aligned, checked in every way; nothing but the kept features may be missing.
#[track_caller]
fn aligned(soup: &TriangleSoup, features: &EdgeSet) -> MapSolution {
    let solution = aligned_with(soup, features, &MapOptions::default()).unwrap();
    common::assert_seamless(soup, &solution);
    let mesh = mesh_of(soup);
    let [axis, angle] = misalignment(&mesh, solution.map.corner_uvs(), &solution.features);
    assert!(axis < 1e-9, "{axis} degrees off the axes");
    assert!(angle < 1e-6, "a sector {angle} degrees off");
    let mut named = solution.features.clone();
    for released in &solution.released {
        let one = of_pairs(soup, &[released.vertices], false);
        let both = solution.features.contains(one.edges()[0]);
        assert!(!both, "an edge both kept and released");
        named = named.union(&mesh, &one);
    }
    assert_eq!(&named, features, "every feature is either kept or released");
    solution
}

fn of_pairs(soup: &TriangleSoup, pairs: &[[u32; 2]], boundary: bool) -> EdgeSet {
    let mesh = mesh_of(soup);
    let finder = EdgeFinder::new(&mesh);
    let edges = EdgeSet::new(&mesh, pairs.iter().flat_map(|&pair| finder.find(pair).unwrap()));
    if boundary { edges.union(&mesh, &EdgeSet::boundary(&mesh)) } else { edges }
}

#[test]
fn the_checker_sees_what_is_not_aligned() {
    let soup = kit::disk_grid(4, 4);
    let features = of_pairs(&soup, &[], true);
    let solution = aligned(&soup, &features);
    let mesh = mesh_of(&soup);
    let turned: Vec<[f64; 2]> =
        solution.map.corner_uvs().iter().map(|[u, v]| [u - 0.01 * v, v + 0.01 * u]).collect();
    assert!(misalignment(&mesh, &turned, &features)[0] > 0.5);
    let sheared: Vec<[f64; 2]> = turned.iter().map(|[u, v]| [u + 0.3 * v, *v]).collect();
    assert!(misalignment(&mesh, &sheared, &features)[1] > 0.5);
}

#[test]
fn boxes_map_isometrically_with_the_expected_cones() {
    let frame: Vec<[i32; 3]> = (0..9).filter(|k| *k != 4).map(|k| [k / 3, k % 3, 0]).collect();
    let three_way = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [0, 2, 0], [0, 0, 1], [0, 0, 2]];
    let shapes: [(&[[i32; 3]], usize); 4] = [
        (&[[0, 0, 0]], 8),
        (&[[0, 0, 0], [1, 0, 0], [0, 1, 0]], 12),
        (&frame, 16),
        (&three_way, 17),
    ];
    for (cells, cones) in shapes {
        let soup = kit::subdivide(&kit::subdivide(&kit::voxel_surface(cells)));
        let solution = aligned(&soup, &of_pairs(&soup, &creases(&soup), false));
        assert_eq!(solution.map.cones().len(), cones);
        assert!(solution.released.is_empty());
        assert!(solution.distortion.tau < 1.0 + 1e-9, "tau {}", solution.distortion.tau);
    }
}

#[test]
fn boundaries_of_disks_and_annuli_run_along_the_axes() {
    for soup in [kit::disk_grid(6, 5), kit::annulus(12, 4), kit::cylinder(10, 4)] {
        let solution = aligned(&soup, &of_pairs(&soup, &[], true));
        assert!(!solution.features.is_empty());
    }
    // A rectangle is one already.
    let soup = kit::disk_grid(6, 5);
    let solution = aligned(&soup, &of_pairs(&soup, &[], true));
    assert!(solution.released.is_empty() && solution.map.cones().is_empty());
    assert!(solution.distortion.tau < 1.0 + 1e-9);
}

#[test]
fn open_curves_loops_and_crossings_on_smooth_surfaces() {
    let sphere = kit::bumpy(&kit::icosphere(3), 0.05, 2);
    let mesh = mesh_of(&sphere);
    let far = mesh.n_vertices() as u32 - 1;
    let curve = path(&mesh, 0, far);
    let crossing = [path(&mesh, 0, 5), path(&mesh, 3, 8), path(&mesh, 0, 8)].concat();
    let loop_around = rim(&mesh, |f| {
        let corners = sphere.faces[f].map(|v| sphere.positions[v as usize][2]);
        corners.iter().sum::<f64>() > 0.6
    });
    for pairs in [&curve[..6], &crossing, &loop_around] {
        let features = of_pairs(&sphere, pairs, false);
        let solution = aligned(&sphere, &features);
        let kept = solution.features.len();
        assert!(2 * kept > pairs.len(), "{kept} of {} kept", pairs.len());
    }
    let torus = kit::bumpy(&kit::torus(16, 10, 2.0, 0.8), 0.05, 1);
    let around = rim(&mesh_of(&torus), |f| torus.faces[f].iter().all(|&v| v % 10 < 5));
    aligned(&torus, &of_pairs(&torus, &around, false));
}

#[test]
fn an_open_end_may_be_one_edge() {
    let soup = kit::icosphere(2);
    let mesh = mesh_of(&soup);
    let h = mesh.edges().nth(77).unwrap();
    let solution = aligned(&soup, &of_pairs(&soup, &[[mesh.origin(h).0, mesh.tip(h).0]], false));
    assert!(solution.released.is_empty());
}

#[test]
fn features_that_contradict_each_other_are_named() {
    let soup = kit::icosphere(1);
    let mesh = mesh_of(&soup);
    let all: Vec<[u32; 2]> = mesh.edges().map(|h| [mesh.origin(h).0, mesh.tip(h).0]).collect();
    let features = of_pairs(&soup, &all, false);
    let solution = aligned(&soup, &features);
    assert!(solution.released.iter().any(|r| r.reason == ReleaseReason::ThreeInTriangle));
    let strict = MapOptions { strict_features: true, ..MapOptions::default() };
    match aligned_with(&soup, &features, &strict) {
        Err(MapError::Released { released }) => assert_eq!(released, solution.released),
        other => panic!("expected released features, got {other:?}"),
    }
}

#[test]
fn the_same_bytes_on_one_and_two_threads() {
    let soup = kit::bumpy(&kit::subdivide(&kit::subdivide(&kit::l_bracket())), 0.02, 4);
    let features = of_pairs(&soup, &creases(&soup), false);
    let run = |threads| {
        let map = || aligned_with(&soup, &features, &MapOptions::default()).unwrap();
        with_threads(threads, map).unwrap()
    };
    let (one, two) = (run(1), run(2));
    assert_eq!(one.map.corner_uvs(), two.map.corner_uvs());
    assert_eq!((one.features, one.released), (two.features, two.released));
}

#[test]
fn indices_of_sectors_are_integers_with_the_right_sum() {
    for seed in 0..6 {
        let soup = kit::random_surface(seed);
        let (mesh, metric) = surface(&soup);
        let mut rng = kit::Rng::new(seed);
        let pairs: Vec<[u32; 2]> = mesh
            .edges()
            .filter(|_| rng.unit() < 0.05)
            .map(|h| [mesh.origin(h).0, mesh.tip(h).0])
            .collect();
        let features = of_pairs(&soup, &pairs, true);
        let sectors = Sectors::new(&mesh, &metric, &features);
        let unfolding = Unfolding::through_curved_sectors(&sectors, &metric);
        let options = RoundingOptions::default();
        let rounding =
            unwatched(|watch| round(&sectors, &metric, unfolding, None, &options, watch));
        let matched = repair(&sectors, &metric, rounding.unwrap().start.matched).matched;
        let index = matched.unfolding.indices(&sectors, &metric, &matched.rotations());
        let off = index.iter().map(|k| (k - k.round()).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "an index {off} off an integer");
        let sum: f64 = index.iter().sum();
        let chi = sectors.slit().euler_characteristic() as f64;
        assert!((sum - 4.0 * chi).abs() < 1e-6, "sum {sum} at characteristic {chi}");
        // Around an interior vertex the sectors make up the whole: an integer of the mesh itself.
        let full = sectors.glue(&matched.matching_per_halfedge(&sectors));
        for h in mesh.halfedges() {
            assert_eq!(full[h], mesh.twin(h).map_or(0, |t| -full[t]));
        }
    }
}

/// A bent box with a map that follows its creases.
fn mapped_box(options: &MapOptions) -> (TriangleSoup, EdgeSet, MapSolution) {
    let soup = kit::bumpy(&kit::subdivide(&kit::l_bracket()), 0.04, 5);
    let features = of_pairs(&soup, &creases(&soup), false);
    let solution = aligned_with(&soup, &features, options).unwrap();
    (soup, features, solution)
}

#[test]
fn every_objective_keeps_features_on_the_axes() {
    let (soup, features, solution) = mapped_box(&MapOptions::default());
    assert!(solution.released.is_empty());
    let mesh = mesh_of(&soup);
    for objective in Objective::ALL {
        let mut options = RelayoutOptions::new(objective);
        options.features = Some(features.clone());
        options.strict_features = true;
        let mut go_on = |_| ControlFlow::Continue(());
        let laid = relayout(&mesh, &soup.positions, &solution.map, &options, &mut go_on).unwrap();
        let stats = laid.components[0];
        assert!(stats.after <= stats.before, "{objective}: {stats:?}");
        assert_eq!(laid.features, features, "{objective}");
        let [off_axis, off_quarter] = misalignment(&mesh, laid.map.corner_uvs(), &features);
        assert!(off_axis < 1e-9 && off_quarter < 1e-6, "{objective}: {off_axis}, {off_quarter}");
        assert_eq!(laid.map.cones(), solution.map.cones(), "{objective}");
    }
}

#[test]
fn maps_made_for_an_objective_keep_features_on_the_axes() {
    for objective in Objective::ALL {
        let options = MapOptions { objective: Some(objective), ..MapOptions::default() };
        let (soup, features, solution) = mapped_box(&options);
        assert_eq!(solution.features, features, "{objective}");
        let mesh = mesh_of(&soup);
        let [off_axis, off_quarter] = misalignment(&mesh, solution.map.corner_uvs(), &features);
        assert!(off_axis < 1e-9 && off_quarter < 1e-6, "{objective}: {off_axis}, {off_quarter}");
    }
}

#[test]
fn layouts_name_the_features_that_their_map_does_not_follow() {
    let (soup, features, _) = mapped_box(&MapOptions::default());
    let mesh = mesh_of(&soup);
    let free = aligned_with(&soup, &EdgeSet::new(&mesh, []), &MapOptions::default()).unwrap();
    let mut options = RelayoutOptions::new(Objective::Arap);
    options.features = Some(features.clone());
    let mut go_on = |_| ControlFlow::Continue(());
    let laid = relayout(&mesh, &soup.positions, &free.map, &options, &mut go_on).unwrap();
    assert!(laid.released.iter().all(|r| r.reason == ReleaseReason::NotInMap));
    assert_eq!(laid.released.len() + laid.features.len(), features.len());
    options.strict_features = true;
    match relayout(&mesh, &soup.positions, &free.map, &options, &mut go_on) {
        Err(MapError::Released { released }) => assert_eq!(released, laid.released),
        other => panic!("expected released features, got {other:?}"),
    }
}

#[test]
fn matchings_outlive_the_release_of_features() {
    for seed in 0..4 {
        let soup = kit::random_surface(seed);
        let (mesh, metric) = surface(&soup);
        let mut rng = kit::Rng::new(seed);
        let mut some = |share: f64| -> Vec<[u32; 2]> {
            let edges = mesh.edges().filter(|_| rng.unit() < share);
            edges.map(|h| [mesh.origin(h).0, mesh.tip(h).0]).collect()
        };
        let (kept, released) = (some(0.04), some(0.04));
        let few = of_pairs(&soup, &kept, false);
        let many = few.union(&mesh, &of_pairs(&soup, &released, true));
        let from = Sectors::new(&mesh, &metric, &many);
        let to = Sectors::new(&mesh, &metric, &few);
        let unfolding = Unfolding::through_curved_sectors(&from, &metric);
        let options = RoundingOptions::default();
        let rounding = unwatched(|watch| round(&from, &metric, unfolding, None, &options, watch));
        let matched = rounding.unwrap().start.matched;
        let (fewer, _) = matched.with_fewer_aligned(&from, &to, &metric);
        // The angle around each vertex stays what it is.
        let around = |sectors: &Sectors<'_>, matched: &MatchedCut| {
            let index = matched.sector_indices(sectors, &metric);
            let mut sum = vec![0.0; mesh.n_vertices()];
            for s in sectors.slit().vertices() {
                sum[sectors.vertex(s).at()] += sectors.quarters(s, f64::from(index[s]));
            }
            sum
        };
        let free = |v: &Vertex| !mesh.is_boundary(*v);
        let (before, after) = (around(&from, &matched), around(&to, &fewer));
        for v in mesh.vertices().filter(free) {
            assert_eq!(before[v.at()], after[v.at()], "vertex {v:?}");
        }
        // Rotations and indices still agree.
        let index = fewer.unfolding.indices(&to, &metric, &fewer.rotations());
        let off = to.slit().vertices().filter(|&s| !to.is_free(s));
        let off = off.map(|s| (index[s] - index[s].round()).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "an index {off} off an integer");
    }
}

#[test]
fn a_crease_that_fades_out_ends_openly() {
    // A roof whose ridge sinks into the plane, as the creases of a fan blade do.
    let mut soup = kit::subdivide(&kit::disk_grid(8, 8));
    for p in &mut soup.positions {
        p[2] = -p[0].min(0.0).powi(2) * p[1].abs();
    }
    let mesh = mesh_of(&soup);
    let ridge = sharp_edges(&mesh, &soup.positions, 40f64.to_radians());
    let on_ridge = |h: &Halfedge| soup.positions[mesh.origin(*h).at()][1].abs() < 1e-12;
    assert!(ridge.len() >= 3 && ridge.edges().iter().all(on_ridge), "{} edges", ridge.len());
    let solution = aligned(&soup, &ridge.union(&mesh, &EdgeSet::boundary(&mesh)));
    assert!(solution.released.is_empty());
    assert!(solution.distortion.tau < 2.0, "tau {}", solution.distortion.tau);
}
