//! Which shapes have creases, and which.
#![allow(clippy::unwrap_used)]

use seamstress_mesh::features::{EdgeSet, creases, sharp_edges};
use seamstress_mesh::soup::TriangleSoup;
use seamstress_mesh::{Metric, TriMesh};
use seamstress_testkit::{
    bumpy, cube, cylinder, extruded, graph, icosphere, l_bracket, octahedron, pyramid, relabel,
    scale, subdivide, tetrahedron, torus, uv_sphere, voxel_surface,
};
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

fn mesh(soup: &TriangleSoup) -> (TriMesh, Metric) {
    let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces).unwrap();
    let metric = Metric::from_positions(&mesh, &soup.positions);
    (mesh, metric)
}

/// The creases for a grid of so many cells.
fn found(soup: &TriangleSoup, cells: f64) -> (TriMesh, EdgeSet) {
    let (mesh, metric) = mesh(soup);
    let edges = creases(&mesh, &soup.positions, &metric, metric.side() / cells.sqrt());
    (mesh, edges)
}

fn count(soup: &TriangleSoup) -> usize {
    found(soup, 1000.0).1.len()
}

/// An upright cylinder of height 2 and radius 1 with `n` sides in `m` rows, and its lids.
fn drum(n: u32, m: u32) -> TriangleSoup {
    let mut drum = cylinder(n, m);
    drum.positions.iter_mut().for_each(|p| p[2] *= 2.0);
    let lids: Vec<(u32, bool)> = vec![(0, false), (m * n, true)];
    for (first, is_top) in lids {
        let centre = drum.positions.len() as u32;
        let height = drum.positions[first as usize][2];
        drum.positions.push([0.0, 0.0, height]);
        for i in 0..n {
            let (a, b) = (first + i, first + (i + 1) % n);
            drum.faces.push(if is_top { [centre, a, b] } else { [centre, b, a] });
        }
    }
    drum
}

#[test]
fn a_prism_of_up_to_nine_sides_has_all_its_edges() {
    for n in 3..=9 {
        for m in [1, 4] {
            assert_eq!(count(&drum(n, m)), (n * m + 2 * n) as usize, "{n} sides, {m} rows");
        }
    }
}

#[test]
fn a_cylinder_keeps_its_rims_alone() {
    for n in [10, 12, 16, 24, 32, 64] {
        for m in [1, 4] {
            assert_eq!(count(&drum(n, m)), 2 * n as usize, "{n} sides, {m} rows");
        }
        assert_eq!(count(&cylinder(n, 4)), 0, "{n} sides, open");
    }
}

#[test]
fn slivers_along_a_rim_do_not_break_it() {
    // At every other edge of the upper rim the lid has a sliver, folded down.
    let n = 24;
    let mut drum = drum(n, 1);
    let middle = drum.positions.len() as u32 - 1;
    for a in (n..2 * n).step_by(2) {
        let b = a + 1;
        let tip = drum.positions.len() as u32;
        let [p, q] = [a, b].map(|v| drum.positions[v as usize]);
        drum.positions.push([0.495 * (p[0] + q[0]), 0.495 * (p[1] + q[1]), p[2] - 0.01]);
        let lid = drum.faces.iter_mut().find(|face| **face == [middle, a, b]).unwrap();
        *lid = [middle, a, tip];
        drum.faces.extend([[middle, tip, b], [a, b, tip]]);
    }
    // On the coarsest of these grids an edge of the rim, between two slivers, is shorter than half a cell.
    for cells in [52.0, 200.0, 1000.0] {
        assert_eq!(found(&drum, cells).1.len(), 2 * n as usize, "{cells} cells");
    }
}

#[test]
fn round_shapes_have_none() {
    for n in 1..5 {
        assert_eq!(count(&icosphere(n)), 0, "icosphere {n}");
    }
    for n in [10, 16, 32] {
        assert_eq!(count(&uv_sphere(n, n / 2)), 0, "sphere of {n} slices");
    }
    for n in [9, 16, 40] {
        assert_eq!(count(&torus(2 * n, n, 3.0, 1.0)), 0, "torus {n}");
    }
}

#[test]
fn polyhedra_have_all_their_sharp_edges() {
    assert_eq!(count(&tetrahedron()), 6);
    assert_eq!(count(&octahedron()), 12);
    assert_eq!(count(&icosphere(0)), 30);
    for n in 3..33u32 {
        // The base, and the sides where they meet at 40 degrees or more.
        let side = {
            let (angle, slope) = (TAU / f64::from(n), 1.5f64 / (PI / f64::from(n)).cos());
            let normal_z = 1.0 / (1.0 + slope * slope).sqrt();
            let across = 1.0 - normal_z * normal_z;
            (across * angle.cos() + normal_z * normal_z).acos()
        };
        let expected = if side.to_degrees() > 40.0 { 2 * n } else { n };
        assert_eq!(count(&pyramid(n, 1.5)), expected as usize, "{n} sides");
    }
    let wedge = extruded(&[[0.0, 0.0], [1.0, 0.0], [0.9, 0.2]], 0.5);
    assert_eq!(count(&wedge), 9);
}

#[test]
fn blocks_have_all_edges_at_any_scale_and_numbering() {
    let block = subdivide(&subdivide(&l_bracket()));
    for soup in [cube(), subdivide(&cube()), l_bracket(), block.clone()] {
        let (mesh, edges) = found(&soup, 1000.0);
        assert_eq!(edges, sharp_edges(&mesh, &soup.positions, 1.0));
        assert!(!edges.is_empty());
    }
    for factor in [1e-150, 1e-3, 1e150] {
        assert_eq!(count(&scale(&block, factor)), count(&block), "times {factor}");
    }
    let length = |soup: &TriangleSoup| {
        let (mesh, edges) = found(soup, 1000.0);
        let at = |v: u32| soup.positions[v as usize].map(|x| (x * 1024.0).round() as i64);
        let ends = edges.vertex_pairs(&mesh).into_iter().map(|pair| {
            let mut ends = pair.map(at);
            ends.sort_unstable();
            ends
        });
        ends.collect::<BTreeSet<_>>()
    };
    for seed in 0..5 {
        assert_eq!(length(&relabel(&block, seed)), length(&block));
    }
}

#[test]
fn noise_has_none_and_hides_none() {
    for seed in 0..5 {
        // Its edges bend by 25 degrees and more in hundreds of places.
        let rough = bumpy(&icosphere(4), 0.25, seed);
        let (mesh, edges) = found(&rough, 1000.0);
        assert!(sharp_edges(&mesh, &rough.positions, 25f64.to_radians()).len() > 300);
        assert_eq!(edges.len(), 0, "seed {seed}");
        // A cast block: its edges bend by a right angle, its faces by some degrees.
        let block = (0..3).fold(cube(), |block, _| subdivide(&block));
        let cast = bumpy(&block, 0.03, seed);
        let (_, all) = found(&block, 1000.0);
        assert_eq!(found(&cast, 1000.0).1, all, "seed {seed}");
    }
}

#[test]
fn what_is_small_for_a_grid_is_left_out() {
    // A plate of 8 by 8 squares with a fold that begins in its middle and ends at its rim.
    let depth = |y: f64| (1.0 - 2.0 * y).max(0.0);
    let plate = graph(8, 8, |x, y| depth(y) * (x - 0.5).abs());
    let (mesh, fine) = found(&plate, 4096.0);
    assert!(fine.len() >= 3);
    for &v in fine.vertex_pairs(&mesh).as_flattened() {
        assert_eq!(plate.positions[v as usize][0], 0.5);
    }
    assert!(found(&plate, 16.0).1.is_empty());
}

#[test]
fn steps_of_voxels_are_creases_of_a_grid_as_fine() {
    let range = -4..=4i32;
    let cube = range
        .clone()
        .flat_map(|x| range.clone().flat_map(move |y| (-4..=4).map(move |z| [x, y, z])));
    let ball: Vec<[i32; 3]> = cube.filter(|c| c.iter().map(|x| x * x).sum::<i32>() <= 18).collect();
    let ball = voxel_surface(&ball);
    let (mesh, all) = found(&ball, 5000.0);
    assert_eq!(all, sharp_edges(&mesh, &ball.positions, 1.0));
    assert!(found(&ball, 60.0).1.is_empty());
}
