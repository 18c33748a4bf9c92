//! Inputs that once went wrong.

mod common;

use common::{mapped, mesh_of};
use seamstress_parametrize::{MapError, MapOptions, MapSolution, make_map};
use seamstress_testkit as kit;
use std::ops::ControlFlow;

/// Ties: every rotation of a slab is a whole number, and with whole coordinates the map is isometric.
/// With coordinates rounded (times 3.7) tau was 1.31, because an annihilated pair of cones and a turn
/// by 1e-16 cost the same at a bias of 0.5.
#[test]
fn boxes_of_any_size_are_isometric() {
    for g in 0..4 {
        let slab = kit::slab_with_holes(g);
        for factor in [3.7, 0.1, 1e-12, 1e30] {
            let tau = mapped(&kit::scale(&slab, factor)).distortion.tau;
            assert!(tau < 1.0 + 1e-6, "{g} holes times {factor}: tau {tau}");
        }
    }
}

/// The same ties on random surfaces: 40 in 100 got other cones when scaled by 3.7.
#[test]
fn rounding_errors_decide_nothing() {
    for seed in 0..16 {
        let soup = kit::random_surface(seed);
        let (one, other) = (mapped(&soup), mapped(&kit::scale(&soup, 3.7)));
        assert_eq!(one.map.cones(), other.map.cones(), "seed {seed}");
    }
}

/// A position that is not finite: the rounding loop never chose a seam (no cost is below any
/// threshold) and ran for ever.
#[test]
fn strange_positions_end_in_an_error() {
    for strange in [f64::NAN, f64::INFINITY] {
        let mut soup = kit::tetrahedron();
        soup.positions[0] = [strange; 3];
        let mut calls = 0;
        let mut observer = |_| {
            calls += 1;
            if calls < 100_000 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let result =
            make_map(&mesh_of(&soup), &soup.positions, &MapOptions::default(), &mut observer);
        assert!(result.is_err() && calls < 100_000, "still running after {calls} calls");
    }
}

fn solve(soup: &seamstress_mesh::soup::TriangleSoup) -> Result<MapSolution, MapError> {
    let mut observer = |_| ControlFlow::Continue(());
    make_map(&mesh_of(soup), &soup.positions, &MapOptions::default(), &mut observer)
}

/// All vertices at one point: the map was made in the subnormal range.
#[test]
fn a_point_has_a_map_of_no_distortion_to_speak_of() {
    let solution = solve(&kit::scale(&kit::icosphere(1), 0.0)).ok();
    assert!(solution.is_some_and(|s| s.distortion.tau.is_nan() && s.distortion.degenerate == 80));
}

/// The largest coordinates: the UVs would overflow, and the error says so.
#[test]
fn the_largest_numbers_are_refused() {
    let error = solve(&kit::scale(&kit::icosphere(2), 8e307)).err();
    assert!(error.is_some_and(|e| e.to_string().contains("not finite")));
}

/// Positions that do not fit the mesh.
#[test]
fn missing_positions_are_refused() {
    let soup = kit::tetrahedron();
    let mut observer = |_| ControlFlow::Continue(());
    let options = MapOptions::default();
    let result = make_map(&mesh_of(&soup), &soup.positions[..3], &options, &mut observer);
    assert!(matches!(result, Err(MapError::PositionCount { expected: 4, found: 3 })));
}

/// A cube without height: the map failed its certificate (face 3 was flipped).
#[test]
fn a_flat_cube_has_a_map() {
    mapped(&kit::stretch(&kit::cube(), [1.0, 1.0, 0.0]));
}

/// Every third vertex of a grid at the origin: the map failed its certificate (vertex 21 had 4.98
/// quarter turns).
#[test]
fn a_grid_with_coincident_vertices_has_a_map() {
    let mut soup = kit::disk_grid(5, 5);
    soup.positions.iter_mut().step_by(3).for_each(|p| *p = [0.0; 3]);
    mapped(&soup);
}
