//! Mixed-integer rounding against enumeration, and what holds of every run.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

mod common;

use common::{mapped_with, surface, unwatched};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_parametrize::MapOptions;
use seamstress_parametrize::cut::{
    DualTree, MatchedCut, Unfolding, curvature_weight, frames_of_angles,
};
use seamstress_parametrize::features::Sectors;
use seamstress_parametrize::layout::conic::{
    Outcome, Program, ProgramKind, SolverOptions, reference,
};
use seamstress_parametrize::layout::exact::ExactLayout;
use seamstress_parametrize::mixed_integer::{
    MixedIntegerOptions, MixedIntegerStats, round_mixed_integer,
};
use seamstress_parametrize::progress::Watch;
use seamstress_parametrize::quarter::turn;
use seamstress_parametrize::rounding::RoundingStrategy;
use seamstress_testkit as kit;
use std::ops::ControlFlow;
use std::time::Duration;

fn cut(mesh: &TriMesh, metric: &Metric) -> Unfolding {
    let tree = DualTree::lightest(mesh, curvature_weight(mesh, metric));
    Unfolding::new(&Sectors::unaligned(mesh), metric, tree)
}

fn round(soup: &TriangleSoup, options: &MixedIntegerOptions) -> (Vec<i32>, MixedIntegerStats) {
    let (mesh, metric) = surface(soup);
    let unfolding = cut(&mesh, &metric);
    let rounded = unwatched(|watch| round_mixed_integer(&mesh, &metric, unfolding, options, watch));
    let (start, stats) = rounded.unwrap();
    (start.matched.matching, stats)
}

/// The least tau of program (9) with the isometric frames over all choices of the integers on both sides of
/// each isometric rotation, one program by the reference solver for each; with the integers.
fn enumerated(soup: &TriangleSoup) -> (f64, Vec<i32>) {
    let (mesh, metric) = surface(soup);
    let sectors = Sectors::unaligned(&mesh);
    let mut matched = MatchedCut::nearest(cut(&mesh, &metric));
    let frames = frames_of_angles(&mesh, &metric, &metric.angle, &matched.unfolding.tree);
    let seams = matched.matching.len();
    let mut best = (f64::INFINITY, Vec::new());
    for bits in 0..1usize << seams {
        for s in 0..seams {
            matched.matching[s] =
                matched.unfolding.isometric[s].floor() as i32 + (bits >> s & 1) as i32;
        }
        let layout = ExactLayout::new(&sectors, &metric, &matched).unwrap();
        let turned = frames.iter().zip(layout.gauge.iter()).map(|(&r, &k)| turn(r, k));
        let program =
            Program { kind: ProgramKind::Stretch, frames: turned.collect(), scales: None };
        let options = SolverOptions { tolerance: 1e-8, max_iterations: 100 };
        let solved =
            unwatched(|watch| reference::solve(layout.problem(), &program, &options, watch));
        let solved = solved.unwrap();
        if solved.outcome == Outcome::Solved && solved.objective.sqrt() < best.0 {
            best = (solved.objective.sqrt(), matched.matching.clone());
        }
    }
    best
}

#[test]
fn the_proven_optimum_is_that_of_enumeration() {
    let options = MixedIntegerOptions { nodes: usize::MAX, tolerance: 1e-6, ..Default::default() };
    for soup in [
        kit::bumpy(&kit::tetrahedron(), 0.3, 2),
        kit::bumpy(&kit::octahedron(), 0.3, 5),
        kit::bumpy(&kit::octahedron(), 0.5, 8),
        kit::bumpy(&kit::cube(), 0.2, 3),
        kit::fan(5, 0.6, true),
    ] {
        let (best, integers) = enumerated(&soup);
        let (matching, stats) = round(&soup, &options);
        assert_eq!(stats.batches.len(), 1);
        let batch = &stats.batches[0];
        let tau = batch.tau.unwrap();
        assert!(batch.proven && batch.integers == integers.len(), "{stats:?}");
        assert!((tau - best).abs() < 1e-4 * best, "{tau} found, {best} by enumeration");
        assert!(batch.bound <= tau && batch.bound > best * (1.0 - 1e-4));
        assert!(batch.nodes < 3 << integers.len(), "{} nodes", batch.nodes);
        assert_eq!(matching.len(), integers.len());
    }
}

#[test]
fn every_batch_has_a_bound_below_its_incumbent_and_the_same_result_twice() {
    for (soup, batch) in [
        (kit::bumpy(&kit::icosphere(2), 0.15, 4), 60),
        (kit::bumpy(&kit::torus(14, 10, 2.0, 0.8), 0.2, 4), 800),
        (kit::with_boundaries(&kit::subdivide(&kit::double_torus()), 3, 5), 50),
    ] {
        let options = MixedIntegerOptions { batch, nodes: 25, ..Default::default() };
        let (matching, stats) = round(&soup, &options);
        let seams: usize = matching.len();
        let decided: usize =
            stats.batches.iter().filter(|b| b.tau.is_some()).map(|b| b.integers).sum();
        assert!(decided + stats.left_to_nearest <= seams);
        assert!(decided > seams / 2, "{stats:?}");
        for b in &stats.batches {
            assert!(b.integers <= batch && b.nodes <= 25 + 60);
            assert!(b.tau.is_none_or(|tau| b.bound <= tau && tau.is_finite()), "{b:?}");
        }
        let (again, other) = round(&soup, &options);
        assert_eq!(again, matching);
        assert_eq!(other.nodes(), stats.nodes());
    }
}

#[test]
fn more_nodes_are_never_worse() {
    let soup = kit::bumpy(&kit::icosphere(1), 0.2, 9);
    let tau = |nodes| {
        let options = MixedIntegerOptions { nodes, ..Default::default() };
        round(&soup, &options).1.batches[0].tau.unwrap_or(f64::INFINITY)
    };
    let [few, more, many] = [12, 40, 160].map(tau);
    assert!(many <= more && more <= few && many.is_finite(), "{few} {more} {many}");
}

#[test]
fn maps_by_mixed_integers_are_certified() {
    let mut options = MapOptions::default();
    options.rounding.strategy = RoundingStrategy::MixedInteger;
    options.rounding.mixed_integer.nodes = 20;
    for soup in [
        kit::disk_grid(4, 3),
        kit::cube(),
        kit::bumpy(&kit::torus(12, 8, 2.0, 0.8), 0.2, 4),
        kit::disjoint_union(&[kit::icosphere(1), kit::annulus(12, 3)]),
    ] {
        let solution = mapped_with(&soup, &options);
        assert!(solution.components.iter().all(|c| c.mixed_integer.is_some()));
    }
}

#[test]
fn what_is_open_when_time_is_up_is_rounded_to_the_nearest() {
    let soup = kit::bumpy(&kit::icosphere(2), 0.15, 4);
    let time_limit = Some(Duration::ZERO);
    let options = MixedIntegerOptions { time_limit, ..Default::default() };
    let (matching, stats) = round(&soup, &options);
    assert_eq!((stats.left_to_nearest, stats.nodes()), (matching.len(), 0));
    let (mesh, metric) = surface(&soup);
    assert_eq!(matching, MatchedCut::nearest(cut(&mesh, &metric)).matching);
}

#[test]
fn it_can_be_stopped() {
    let (mesh, metric) = surface(&kit::bumpy(&kit::icosphere(2), 0.15, 4));
    let unfolding = cut(&mesh, &metric);
    let mut calls = 0;
    let mut stop = |_| {
        calls += 1;
        if calls > 20 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut watch = Watch::new(&mut stop, 0, 1);
    let options = MixedIntegerOptions::default();
    assert!(round_mixed_integer(&mesh, &metric, unfolding, &options, &mut watch).is_err());
    assert!(calls < 30);
}
