//! Random surfaces of genus 0 to 3 with 0 to 3 boundary loops, held to what must not depend on how
//! a surface is stored, placed or computed.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of a test")]

mod common;

use common::{mapped, mapped_with, mesh_of};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parallel::with_threads;
use seamstress_parametrize::map::Cone;
use seamstress_parametrize::{MapOptions, MapSolution, make_map};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

/// Runs a property on surfaces from the same seeds every time.
fn for_surfaces(cases: u32, property: impl Fn(u64, TriangleSoup)) {
    let config =
        Config { cases, failure_persistence: None, max_shrink_iters: 0, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let outcome = TestRunner::new_with_rng(config, rng).run(&any::<u64>(), |seed| {
        property(seed, kit::random_surface(seed));
        Ok(())
    });
    if let Err(failure) = outcome {
        panic!("{failure}");
    }
}

#[test]
fn every_surface_has_a_seamless_map() {
    for_surfaces(25, |seed, soup| {
        let solution = mapped(&soup);
        let stats = &solution.components[0];
        let characteristic = mesh_of(&soup).euler_characteristic();
        assert_eq!(2 - 2 * stats.genus - stats.boundary_loops as i64, characteristic);
        let d = &solution.distortion;
        assert!(d.tau < 8.0 && d.symmetric_dirichlet < 6.0, "seed {seed}: {d:?}");
        assert!(d.tau_t.p50 <= d.tau_t.p95 && d.tau_t.p95 <= d.tau_t.p99);
        assert!(d.tau_t.p99 <= d.tau * (1.0 + 1e-12));
        assert_eq!((d.measured, d.flipped, d.degenerate), (soup.faces.len(), 0, 0));
    });
}

#[test]
fn other_numbers_for_vertices_and_faces_give_as_good_a_map() {
    for_surfaces(8, |seed, soup| {
        let other = mapped(&kit::relabel(&soup, seed));
        assert_alike(&mapped(&soup), &other, &format!("seed {seed} relabelled"));
    });
}

/// Asserts that two maps differ by rounding errors alone.
#[track_caller]
fn assert_same(one: &MapSolution, other: &MapSolution, what: &str) {
    assert_eq!(one.map.cones(), other.map.cones(), "{what}");
    let (a, b) = (&one.distortion, &other.distortion);
    assert!((a.tau - b.tau).abs() < 1e-6, "{what}: tau {} and {}", a.tau, b.tau);
    let energies = [a, b].map(|d| d.symmetric_dirichlet);
    assert!((energies[0] - energies[1]).abs() < 1e-6, "{what}: energies {energies:?}");
}

/// Asserts that two maps are about as good. Their cones may differ, and the polish brings each to the least
/// tau its cones allow, which spreads further than the energy.
#[track_caller]
fn assert_alike(one: &MapSolution, other: &MapSolution, what: &str) {
    let (a, b) = (&one.distortion, &other.distortion);
    assert!(a.tau < 1.75 * b.tau && b.tau < 1.75 * a.tau, "{what}: tau {} and {}", a.tau, b.tau);
    let [x, y] = [a, b].map(|d| d.symmetric_dirichlet - 4.0);
    assert!(x < 2.0 * y + 0.01 && y < 2.0 * x + 0.01, "{what}: energies 4 + {x} and 4 + {y}");
}

/// The map with a bias below one half: at one half a pair of cones less and a turn by nothing cost
/// the same, and rounding errors decide.
#[track_caller]
fn mapped_without_ties(soup: &TriangleSoup) -> MapSolution {
    let mut options = MapOptions::default();
    options.rounding.cone_bias = 0.45;
    mapped_with(soup, &options)
}

/// Asserts that a change that rounding errors alone can see leaves the map as it is.
fn assert_unchanged(change: impl Fn(&TriangleSoup) -> TriangleSoup, what: &str) {
    let compare = |soup: &TriangleSoup, what: &str| {
        assert_same(&mapped_without_ties(soup), &mapped_without_ties(&change(soup)), what);
    };
    for_surfaces(6, |seed, soup| compare(&soup, &format!("seed {seed} {what}")));
    for soup in developable() {
        compare(&soup, what);
    }
}

/// Surfaces whose map is isometric, or nearly.
fn developable() -> [TriangleSoup; 5] {
    [
        kit::subdivide(&kit::cube()),
        kit::l_bracket(),
        kit::slab_with_holes(2),
        kit::cylinder(12, 3),
        kit::fan(60, 1.0, true),
    ]
}

#[test]
fn size_does_not_matter() {
    for factor in [1e-12, 3.7, 1e30] {
        assert_unchanged(|soup| kit::scale(soup, factor), &format!("times {factor:e}"));
    }
}

/// Turned about two axes and moved.
fn displaced(soup: &TriangleSoup) -> TriangleSoup {
    let ((sin, cos), (sin2, cos2)) = (1.1f64.sin_cos(), 2.3f64.sin_cos());
    let motion = |&[x, y, z]: &[f64; 3]| {
        let [x, y] = [cos * x - sin * y, sin * x + cos * y];
        let [y, z] = [cos2 * y - sin2 * z, sin2 * y + cos2 * z];
        [x + 0.7, y - 0.4, z + 0.2]
    };
    TriangleSoup {
        positions: soup.positions.iter().map(motion).collect(),
        faces: soup.faces.clone(),
    }
}

#[test]
fn place_and_direction_do_not_matter() {
    assert_unchanged(displaced, "moved");
}

#[test]
fn what_ties_cost_is_small() {
    for_surfaces(6, |seed, soup| {
        let other = mapped(&kit::scale(&soup, 3.7));
        assert_alike(&mapped(&soup), &other, &format!("seed {seed}"));
    });
}

#[test]
fn powers_of_two_change_no_digit() {
    for_surfaces(5, |_, soup| {
        let one = mapped(&soup);
        for exponent in [-600, -40, 1, 40, 600] {
            let factor = 2f64.powi(exponent);
            let other = mapped(&kit::scale(&soup, factor));
            let expected: Vec<_> =
                one.map.corner_uvs().iter().map(|p| p.map(|x| x * factor)).collect();
            assert!(other.map.corner_uvs() == expected, "times 2^{exponent}");
            assert_eq!(other.distortion.tau, one.distortion.tau);
            assert_eq!(other.map.cones(), one.map.cones());
        }
    });
}

fn mapped_on(threads: usize, soup: &TriangleSoup) -> (Vec<[u64; 2]>, Vec<Cone>) {
    let solution = with_threads(threads, || {
        let mut go_on = |_| ControlFlow::Continue(());
        make_map(&mesh_of(soup), &soup.positions, &MapOptions::default(), &mut go_on).unwrap()
    });
    let solution = solution.unwrap();
    let bits = solution.map.corner_uvs().iter().map(|p| p.map(f64::to_bits)).collect();
    (bits, solution.map.cones().to_vec())
}

#[test]
fn the_same_bits_every_time_on_any_number_of_threads() {
    for_surfaces(5, |seed, soup| {
        let one = mapped_on(1, &soup);
        for threads in [1, 2, 3] {
            assert!(mapped_on(threads, &soup) == one, "seed {seed} on {threads} threads");
        }
    });
}

#[test]
fn large_meshes_too_have_the_same_bits_on_any_number_of_threads() {
    // More faces than one parallel task takes.
    let soup = kit::bumpy(&kit::torus(90, 50, 2.0, 0.8), 0.1, 1);
    assert!(mapped_on(1, &soup) == mapped_on(2, &soup));
}
