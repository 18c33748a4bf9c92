//! Smooth cross fields by rounding, and the classical maps that follow them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of a test")]

mod common;

use common::{assert_seamless, mesh_of, surface, unwatched};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parametrize::cut::{DualTree, FramedCut, MatchedCut, Unfolding};
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::field::{smooth_field, smooth_frames};
use seamstress_parametrize::layout::route::Route;
use seamstress_parametrize::{
    FieldMap, FieldMapOptions, MapOptions, Start, Violation, make_field_map, make_map_from,
};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

fn classical(soup: &TriangleSoup, options: &FieldMapOptions) -> FieldMap {
    let mut go_on = |_| ControlFlow::Continue(());
    make_field_map(&mesh_of(soup), &soup.positions, options, &mut go_on).unwrap()
}

/// Sum over edges of squared rotation, for any matchings and the frames that suit them best.
fn energy(soup: &TriangleSoup, matched: &MatchedCut) -> f64 {
    let (mesh, metric) = surface(soup);
    let frames = smooth_frames(&mesh, &metric, matched).unwrap();
    let full = matched.matching_per_halfedge(&Sectors::unaligned(&mesh));
    let term = |h: seamstress_mesh::Halfedge| {
        let t = mesh.twin(h).unwrap();
        let edge = |g: seamstress_mesh::Halfedge| {
            let flat = metric.flat[g.face()];
            frames[g.face().at()] * (flat[g.next().side()] - flat[g.side()])
        };
        let turn = (-edge(t) * edge(h).conj()).arg() / std::f64::consts::FRAC_PI_2;
        let off = f64::from(full[h]) - turn;
        (off - 4.0 * (off / 4.0).round()).powi(2)
    };
    let edges: Vec<_> = mesh.interior_edges().collect();
    edges.iter().map(|&h| term(h)).sum::<f64>() / edges.len() as f64
}

fn cut(soup: &TriangleSoup) -> Unfolding {
    let (mesh, metric) = surface(soup);
    let tree = DualTree::lightest(&mesh, |h| metric.length[h]);
    Unfolding::new(&Sectors::unaligned(&mesh), &metric, tree)
}

#[test]
fn the_energy_is_that_of_the_frames_and_below_that_of_rounding_at_once() {
    for soup in [kit::bumpy(&kit::icosphere(3), 0.1, 1), kit::random_surface(3)] {
        let (mesh, metric) = surface(&soup);
        let at_once = MatchedCut::nearest(cut(&soup));
        let (FramedCut { matched, frames }, stats) =
            unwatched(|watch| smooth_field(&mesh, &metric, cut(&soup), watch)).unwrap();
        assert_eq!(frames.len(), mesh.n_faces());
        assert!((energy(&soup, &matched) - stats.energy).abs() < 1e-6 * stats.energy.max(1e-3));
        assert!(stats.energy < energy(&soup, &at_once));
        let index: i32 = matched.sector_indices(&Sectors::unaligned(&mesh), &metric).iter().sum();
        if !mesh.has_boundary() {
            assert_eq!(i64::from(index), 4 * mesh.euler_characteristic());
        }
    }
}

#[test]
fn flat_and_boxy_surfaces_have_parallel_fields() {
    for soup in [kit::cube(), kit::subdivide(&kit::l_bracket()), kit::annulus(12, 4)] {
        let (mesh, metric) = surface(&soup);
        let (_, stats) =
            unwatched(|watch| smooth_field(&mesh, &metric, cut(&soup), watch)).unwrap();
        assert!(stats.energy < 1e-12, "{stats:?}");
        let map = classical(&soup, &FieldMapOptions::default());
        assert!(map.map.is_ok());
        assert!(map.distortion.tau < 1.0 + 1e-6);
    }
}

#[test]
fn a_classical_map_is_certified_or_says_what_is_wrong() {
    let (mut certified, mut flipped) = (0, 0);
    let smooth = |seed| kit::random_surface(seed);
    for soup in [40, 60].map(kit::crown).into_iter().chain((0..4).map(smooth)) {
        let result = classical(&soup, &FieldMapOptions::default());
        let faces = soup.faces.len();
        assert!(result.components.iter().all(|c| c.route == Route::Poisson));
        match result.map {
            Ok(map) => {
                certified += 1;
                assert!(common::checker::check(&soup.faces, map.corner_uvs()).is_ok());
                assert_eq!(map.cones(), result.field_cones);
            }
            Err(uncertified) => {
                assert!(common::checker::check(&soup.faces, &uncertified.corner_uvs).is_err());
                assert_eq!(uncertified.corner_uvs.len(), 3 * faces);
                let violations = &uncertified.violations.0;
                let is_flip = |v: &&Violation| matches!(v, Violation::FlippedTriangle { .. });
                flipped += usize::from(violations.iter().any(|v| is_flip(&v)));
                // The seams are exact whatever flips.
                assert!(!violations.iter().any(|v| matches!(v, Violation::OpenSeam { .. })));
            }
        }
    }
    assert!(certified > 0 && flipped > 0, "{certified} certified, {flipped} with flips");
}

#[test]
fn local_global_iterations_lower_the_distortion_of_the_layout() {
    let soup = kit::bumpy(&kit::icosphere(3), 0.1, 1);
    let arap = |iterations| {
        let options = FieldMapOptions { iterations, ..FieldMapOptions::default() };
        classical(&soup, &options).distortion.arap
    };
    let (before, after) = (arap(0), arap(20));
    assert!(after < before, "{before} to {after}");
}

#[test]
fn exact_layouts_of_smooth_fields_are_certified() {
    for seed in 0..8 {
        let soup = kit::random_surface(seed);
        let mut go_on = |_| ControlFlow::Continue(());
        let mesh = mesh_of(&soup);
        let options = MapOptions::default();
        let solution =
            make_map_from(&mesh, &soup.positions, &Start::SmoothField, &options, &mut go_on);
        assert_seamless(&soup, &solution.unwrap());
    }
}
