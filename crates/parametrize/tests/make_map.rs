//! Maps of shapes whose answer is known, in figures or in structure.

mod common;

use common::{cone_sum, mapped};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_parametrize::MapSolution;
use seamstress_testkit as kit;
use std::f64::consts::{FRAC_PI_2, TAU};

/// The map of a surface that can be laid out without distortion.
#[track_caller]
fn isometric(soup: &TriangleSoup) -> MapSolution {
    let solution = mapped(soup);
    let d = &solution.distortion;
    assert!(d.tau < 1.0 + 1e-6, "tau {}", d.tau);
    assert!((d.symmetric_dirichlet - 4.0).abs() < 1e-9);
    assert!((d.sigma_1_max - 1.0).abs() < 1e-6 && (d.sigma_2_min - 1.0).abs() < 1e-6);
    solution
}

fn indices(solution: &MapSolution) -> Vec<i32> {
    let mut indices: Vec<i32> = solution.map.cones().iter().map(|c| c.index).collect();
    indices.sort_unstable();
    indices
}

/// `n` times one value.
fn times(value: i32, n: usize) -> Vec<i32> {
    vec![value; n]
}

#[test]
fn flat_disks_and_bands_are_isometric_without_cones() {
    let flat = [
        kit::disk_grid(7, 5),
        kit::disk_grid(1, 1),
        kit::annulus(12, 4),
        kit::annulus(3, 1),
        kit::bumpy(&kit::stretch(&kit::disk_grid(6, 6), [3.0, 0.2, 0.0]), 0.0, 1),
        kit::with_boundaries(&kit::disk_grid(12, 12), 4, 2),
    ];
    for soup in flat {
        let solution = isometric(&soup);
        assert_eq!(solution.map.cones(), []);
    }
}

#[test]
fn cylinders_unroll() {
    for (n, m) in [(12, 4), (3, 1), (50, 2), (5, 20)] {
        let solution = isometric(&kit::cylinder(n, m));
        assert_eq!(solution.map.cones(), []);
        // One cut from rim to rim, and across it a translation by the circumference.
        let seams = solution.map.seams();
        assert_eq!(seams.len(), m as usize);
        let circumference = f64::from(n) * 2.0 * (TAU / 2.0 / f64::from(n)).sin();
        for seam in seams {
            let [x, y] = seam.translation;
            assert_eq!(seam.matching, 0);
            assert!((x.hypot(y) - circumference).abs() < 1e-6);
        }
    }
}

#[test]
fn one_triangle_is_its_own_map() {
    let solution = isometric(&kit::fan(1, 1.0, false));
    assert_eq!((solution.map.cones().len(), solution.map.seams().len()), (0, 0));
    assert_eq!(solution.components[0].faces, 1);
}

#[test]
fn open_fans_have_no_cone() {
    for valence in [1, 2, 5, 20, 200] {
        for height in [0.1, 1.0, 5.0] {
            assert_eq!(isometric(&kit::fan(valence, height, false)).map.cones(), []);
        }
    }
}

#[test]
fn cubes_have_their_eight_corners_for_cones() {
    for soup in [kit::cube(), kit::subdivide(&kit::cube()), kit::relabel(&kit::cube(), 3)] {
        assert_eq!(indices(&isometric(&soup)), times(1, 8));
    }
    // Corners of the cube keep their numbers when it is subdivided.
    let fine = isometric(&kit::subdivide(&kit::subdivide(&kit::cube())));
    let cones: Vec<u32> = fine.map.cones().iter().map(|c| c.vertex).collect();
    assert_eq!(cones, [0, 1, 2, 3, 4, 5, 6, 7]);
}

#[test]
fn a_bracket_has_two_concave_corners() {
    for soup in [kit::l_bracket(), kit::subdivide(&kit::l_bracket())] {
        let solution = isometric(&soup);
        assert_eq!(indices(&solution), [times(-1, 2), times(1, 10)].concat());
    }
}

#[test]
fn slabs_have_eight_corners_and_eight_to_a_hole() {
    for g in 0..6usize {
        let slab = kit::slab_with_holes(g as u32);
        for soup in [kit::subdivide(&slab), slab] {
            let solution = isometric(&soup);
            assert_eq!(indices(&solution), [times(-1, 8 * g), times(1, 8)].concat());
            let stats = &solution.components[0];
            assert_eq!((stats.genus, stats.boundary_loops), (g as i64, 0));
        }
    }
}

#[test]
fn holes_in_flat_sides_change_nothing() {
    let soup = kit::with_boundaries(&kit::subdivide(&kit::double_torus()), 3, 5);
    let solution = isometric(&soup);
    let stats = &solution.components[0];
    assert_eq!((stats.genus, stats.boundary_loops), (2, 3));
    assert!(solution.map.cones().iter().all(|c| c.index.abs() == 1));
}

#[test]
fn a_regular_tetrahedron_is_isometric_with_four_half_turns() {
    // Three corners of 60 degrees make two quarters: index 2.
    assert_eq!(indices(&isometric(&kit::tetrahedron())), times(2, 4));
}

#[test]
fn regular_solids_have_cones_at_their_corners() {
    // Four corners of 60 degrees lie between two and three quarters, five between three and four.
    let octahedron = mapped(&kit::octahedron());
    assert_eq!(indices(&octahedron), [times(1, 4), times(2, 2)].concat());
    assert!(octahedron.distortion.tau < 1.25);
    let icosahedron = mapped(&kit::icosahedron());
    assert_eq!(indices(&icosahedron), times(1, 8));
    assert!(icosahedron.distortion.tau < 1.3);
}

#[test]
fn a_flat_square_torus_would_be_isometric_and_round_ones_come_close() {
    for (n, m) in [(24, 12), (12, 8), (40, 5)] {
        let solution = mapped(&kit::torus(n, m, 2.0, 0.7));
        assert_eq!(cone_sum(&solution), 0);
        assert!(solution.distortion.tau < 1.6 && solution.distortion.symmetric_dirichlet < 4.2);
    }
    for soup in [kit::torus(3, 3, 2.0, 0.7), kit::seven_vertex_torus()] {
        assert_eq!(cone_sum(&mapped(&soup)), 0);
    }
}

/// Least tau of a circular cone whose angle is rounded to quarters.
fn best_cone_tau(height: f64) -> f64 {
    let angle = TAU / height.hypot(1.0);
    let rounded = (angle / FRAC_PI_2).round().max(1.0) * FRAC_PI_2;
    (rounded / angle).max(angle / rounded).sqrt()
}

#[test]
fn a_cone_of_many_triangles_reaches_the_best_tau() {
    // Stretching all circles around the tip by one factor is best possible; 200 corners are nearly
    // a circle.
    for (height, index) in [(0.0, 0), (0.3, 0), (1.0, 1), (5.0, 3)] {
        let solution = mapped(&kit::fan(200, height, true));
        let expected = if index == 0 { vec![] } else { vec![index] };
        assert_eq!(indices(&solution), expected);
        assert!((solution.distortion.tau - best_cone_tau(height)).abs() < 1e-3);
    }
}

#[test]
fn spheres_in_slices_with_poles_of_high_valence() {
    for (n, m) in [(100, 6), (100, 2), (3, 2), (4, 3), (7, 5)] {
        let solution = mapped(&kit::uv_sphere(n, m));
        assert_eq!(cone_sum(&solution), 8);
        assert!(solution.distortion.tau < 1.5, "tau {}", solution.distortion.tau);
    }
}

#[test]
fn round_spheres_get_eight_cones() {
    for level in 1..4 {
        let solution = mapped(&kit::icosphere(level));
        assert_eq!(indices(&solution), times(1, 8));
        assert!(solution.distortion.tau < 1.35 && solution.distortion.symmetric_dirichlet < 4.15);
    }
}

#[test]
fn saddles_have_negative_cones() {
    for soup in [kit::saddle(8), kit::monkey_saddle(8)] {
        let solution = mapped(&soup);
        assert!(solution.map.cones().iter().all(|c| c.index < 0));
        assert!(solution.distortion.tau < 1.35);
    }
}

#[test]
fn spikes_on_every_face() {
    for soup in [kit::icosphere(2), kit::torus(20, 12, 2.0, 0.7), kit::double_torus()] {
        for height in [0.1, 1.0, 3.0] {
            let solution = mapped(&kit::klee(&soup, height));
            assert!(solution.distortion.tau < 1.8, "tau {}", solution.distortion.tau);
        }
    }
}

#[test]
fn stretched_boxes_stay_isometric() {
    let slab = kit::subdivide(&kit::double_torus());
    for factors in [[1e3, 1.0, 1.0], [1.0, 1.0, 1e3], [1e-3, 1.0, 1.0], [1.0, 30.0, 0.01]] {
        let solution = mapped(&kit::stretch(&slab, factors));
        assert_eq!(indices(&solution), [times(-1, 16), times(1, 8)].concat());
        assert!(solution.distortion.tau < 1.01 && solution.distortion.symmetric_dirichlet < 4.001);
    }
}

#[test]
fn needles_and_wafers_are_laid_out() {
    let shapes = [kit::icosphere(2), kit::torus(12, 8, 2.0, 0.7), kit::disk_grid(6, 6)];
    for soup in &shapes {
        for factors in [[1e3, 1.0, 1.0], [1.0, 1.0, 1e3], [1.0, 1.0, 1e-5], [1e5, 1.0, 1.0]] {
            mapped(&kit::stretch(soup, factors));
        }
    }
}

#[test]
fn irregular_meshes_are_laid_out() {
    for seed in 0..3 {
        for soup in [kit::icosphere(2), kit::torus(20, 12, 2.0, 0.7), kit::disk_grid(10, 10)] {
            let flipped = kit::random_flips(&kit::bumpy(&soup, 0.2, seed), 3000, seed);
            assert!(mapped(&flipped).distortion.symmetric_dirichlet < 5.5);
        }
    }
}

#[test]
fn components_are_mapped_one_by_one_and_lie_apart() {
    let parts = [kit::cube(), kit::torus(12, 8, 2.0, 0.5), kit::disk_grid(3, 3)];
    let union = kit::disjoint_union(&parts);
    let solution = mapped(&union);
    let faces: Vec<usize> = solution.components.iter().map(|c| c.faces).collect();
    assert_eq!(faces, parts.each_ref().map(|part| part.faces.len()));
    let mut corners = solution.map.corner_uvs();
    let mut right = f64::NEG_INFINITY;
    for part in &parts {
        let (mine, rest) = corners.split_at(3 * part.faces.len());
        corners = rest;
        let low = mine.iter().map(|p| p[0]).fold(f64::INFINITY, f64::min);
        assert!(low > right, "{low} overlaps {right}");
        right = mine.iter().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
        // The same map as alone, but for its place.
        let alone = mapped(part);
        let shift = [0, 1].map(|k| mine[0][k] - alone.map.corner_uvs()[0][k]);
        for (here, there) in mine.iter().zip(alone.map.corner_uvs()) {
            for k in 0..2 {
                assert!((here[k] - there[k] - shift[k]).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn vertices_without_a_face_do_no_harm() {
    let mut soup = kit::cube();
    soup.positions.insert(0, [f64::NAN; 3]);
    soup.positions.push([1e9; 3]);
    soup.faces.iter_mut().flatten().for_each(|v| *v += 1);
    let cones: Vec<u32> = mapped(&soup).map.cones().iter().map(|c| c.vertex).collect();
    assert_eq!(cones, [1, 2, 3, 4, 5, 6, 7, 8]);
}
