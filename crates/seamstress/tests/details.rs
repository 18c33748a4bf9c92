//! Details that are smaller than the quads asked for.
#![cfg(feature = "parallel")]
#![allow(clippy::unwrap_used)]

use seamstress::{Features, QuadOptions, Surface};
use seamstress_testkit::{extruded, parts, voxel_surface};

/// A ball of unit cubes.
fn voxel_ball(radius: i32) -> Surface {
    let range = -radius..radius;
    let middle = |x: i32| 2 * x + 1;
    let is_inside =
        |cell: &[i32; 3]| cell.iter().map(|&x| middle(x).pow(2)).sum::<i32>() < (2 * radius).pow(2);
    let all = range.clone().flat_map(|x| {
        let range = range.clone();
        range.clone().flat_map(move |y| range.clone().map(move |z| [x, y, z]))
    });
    let ball = voxel_surface(&all.filter(is_inside).collect::<Vec<_>>());
    Surface::from_triangles(&ball.positions, &ball.faces).unwrap()
}

#[test]
fn stairs_smaller_than_a_cell_are_no_reason_for_a_finer_grid() {
    for radius in [4, 6] {
        let made = voxel_ball(radius).quad_mesh(&QuadOptions::count(200)).unwrap();
        let count = made.quads().len();
        assert!((180..=220).contains(&count), "radius {radius}: {count} quads");
        // Each of several hundred voxel corners has been a cone.
        assert!(made.irregular().len() <= 60, "{} irregular", made.irregular().len());
    }
}

#[test]
fn features_that_are_too_close_together_are_given_up_and_named() {
    let (_, thread) = parts().into_iter().find(|(name, _)| name == "thread_2_16").unwrap();
    let surface = Surface::from_triangles(&thread.positions, &thread.faces).unwrap();
    let options = QuadOptions::count(100).features(Features::angle(30.0));
    let made = surface.quad_mesh(&options).unwrap();
    let count = made.quads().len();
    assert!((85..=125).contains(&count), "{count} quads");
    let report = serde_json::to_value(made.report()).unwrap();
    let dropped = report["features"]["dropped"].as_array().unwrap();
    assert!(dropped.iter().any(|edge| edge["reason"] == "crowded"), "{dropped:?}");
    let kept = report["features"]["kept"].as_u64().unwrap();
    assert_eq!(kept + dropped.len() as u64, report["features"]["edges"].as_u64().unwrap());
}

/// A block of some height, one of whose upright edges has a chamfer.
fn chamfered(chamfer: f64, height: f64) -> Surface {
    let far = 1.0 - chamfer;
    let outline = [[0.0, 0.0], [1.0, 0.0], [1.0, far], [far, 1.0], [0.0, 1.0]];
    let solid = extruded(&outline, height);
    Surface::from_triangles(&solid.positions, &solid.faces).unwrap()
}

#[test]
fn corners_that_might_be_either_agree_across_a_solid() {
    // Above and below, one of the two corners of 135 degrees is a corner of the grid, and it has to be the same one.
    for (chamfer, height) in [(0.02, 0.6), (0.02, 1.0), (0.025, 0.6), (0.05, 0.6)] {
        let options = QuadOptions::count(150).features(Features::angle(30.0));
        let made = chamfered(chamfer, height).quad_mesh(&options).unwrap();
        let report = serde_json::to_value(made.report()).unwrap();
        assert_eq!(report["features"]["kept"], 15, "chamfer {chamfer}, height {height}");
    }
}

#[test]
fn of_a_tiny_chamfer_one_side_is_enough() {
    let surface = chamfered(0.01, 1.0);
    let options = QuadOptions::count(150).features(Features::angle(30.0));
    let made = surface.quad_mesh(&options).unwrap();
    let report = serde_json::to_value(made.report()).unwrap();
    let dropped = report["features"]["dropped"].as_array().unwrap();
    assert_eq!(dropped.len(), 1, "{dropped:?}");
    assert_eq!(dropped[0]["reason"], "crowded");
    // Creases of its own accord are none of those that would be dropped.
    let made = surface.quad_mesh(&QuadOptions::count(150)).unwrap();
    let report = serde_json::to_value(made.report()).unwrap();
    assert_eq!(report["features"]["edges"], 14);
    assert_eq!(report["features"]["kept"], 14);
}
