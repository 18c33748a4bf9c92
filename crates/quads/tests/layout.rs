//! Layouts of quad meshes: integer seamless maps whose cones are the irregular vertices.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

use num_complex::Complex64;
use proptest::prelude::*;
use seamstress_mesh::Metric;
use seamstress_parametrize::progress::go_on;
use seamstress_parametrize::quality::distortion;
use seamstress_parametrize::{SeamlessMap, Tolerance};
use seamstress_quads::layout::{LayoutError, QuadLayout, lay_out_conformal, lay_out_squares};
use seamstress_quads::quality::{Topology, measure};
use seamstress_quads::{ExtractOptions, QuadMesh, extract};
use seamstress_testkit as kit;
use std::collections::BTreeMap;

/// The squares of a surface of cubes, with some taken out and corners counted from anywhere.
fn squares(genus: u32, holes: usize, seed: u64) -> QuadMesh {
    let soup = kit::slab_with_holes(genus);
    let mut rng = kit::Rng::new(seed);
    let mut quads: Vec<[u32; 4]> = soup
        .faces
        .chunks_exact(2)
        .map(|pair| [pair[0][0], pair[0][1], pair[0][2], pair[1][2]])
        .collect();
    for _ in 0..holes {
        // Taking out a square may leave squares that touch in a corner only: put it back then.
        let taken = quads.remove(rng.below(quads.len()));
        let mesh = QuadMesh::new(soup.positions.clone(), quads.clone()).unwrap();
        if lay_out_squares(&mesh).is_err() {
            quads.push(taken);
        }
    }
    for quad in &mut quads {
        quad.rotate_left(rng.below(4));
    }
    QuadMesh::new(soup.positions, quads).unwrap()
}

fn topology(quads: &QuadMesh) -> Topology {
    Topology::new(quads.positions().len(), quads.quads().iter().map(<[u32; 4]>::as_slice))
}

fn certified(layout: &QuadLayout) -> SeamlessMap {
    let tolerance = Tolerance::default();
    SeamlessMap::certify(&layout.mesh, layout.corner_uvs.clone(), &tolerance).unwrap()
}

/// Valence and number of cones with it.
fn valences(map: &SeamlessMap) -> BTreeMap<usize, usize> {
    let mut counts = BTreeMap::new();
    for cone in map.cones() {
        *counts.entry((4 - cone.index) as usize).or_insert(0) += 1;
    }
    counts
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn squares_are_an_integer_map_with_the_irregular_vertices_as_cones(
        genus in 0u32..3, holes in 0usize..4, seed in 0u64..1000,
    ) {
        let quads = squares(genus, holes, seed);
        let layout = lay_out_squares(&quads).unwrap();
        prop_assert!(layout.corner_uvs.iter().flatten().all(|x| x.fract() == 0.0));
        let map = certified(&layout);
        prop_assert_eq!(valences(&map), topology(&quads).irregular);
        // The squares of the slab are squares: nothing is distorted.
        let metric = Metric::from_positions(&layout.mesh, quads.positions());
        let d = distortion(&layout.mesh, &metric, &layout.corner_uvs);
        prop_assert!((d.tau - 1.0).abs() < 1e-12 && (d.symmetric_dirichlet - 4.0).abs() < 1e-12);
    }

    #[test]
    fn random_complexes_are_integer_maps_too(
        genus in 0u32..3, steps in 0usize..60, seed in any::<u64>(),
    ) {
        let kit::QuadSoup { positions, quads } = kit::random_quads(genus, steps, seed);
        let quads = QuadMesh::new(positions, quads).unwrap();
        let layout = lay_out_squares(&quads).unwrap();
        prop_assert!(layout.corner_uvs.iter().flatten().all(|x| x.fract() == 0.0));
        let map = certified(&layout);
        prop_assert_eq!(valences(&map), topology(&quads).irregular);
        // All quads have the same area: what is left is how many there are.
        prop_assert_eq!(quads.quads().len(), layout.corner_uvs.len() / 6);
        // The map is an integer map, and its quads are the quads it came from.
        let options = ExtractOptions::default();
        let found = extract(&layout.mesh, quads.positions(), &layout.corner_uvs, &options, &mut go_on).unwrap();
        let ring = |quad: &[u32; 4], positions: &[[f64; 3]]| {
            let corners = quad.map(|v| positions[v as usize].map(f64::to_bits));
            // Vertices may share a place: the least of all turns, not a least corner.
            (0..4).map(|k| [0, 1, 2, 3].map(|i| corners[(i + k) % 4])).min()
        };
        let rings = |mesh: &QuadMesh| {
            let rings = mesh.quads().iter().map(|quad| ring(quad, mesh.positions()));
            rings.collect::<std::collections::BTreeSet<_>>()
        };
        prop_assert_eq!(rings(&found.mesh), rings(&quads));
    }

    #[test]
    fn the_conformal_layout_is_the_same_but_for_rounding(
        genus in 0u32..3, holes in 0usize..3, seed in 0u64..1000,
    ) {
        let quads = squares(genus, holes, seed);
        let (squares, conformal) =
            (lay_out_squares(&quads).unwrap(), lay_out_conformal(&quads).unwrap());
        for (a, b) in squares.corner_uvs.iter().zip(&conformal.corner_uvs) {
            prop_assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9);
        }
    }

    #[test]
    fn a_similarity_of_the_texture_changes_neither_tau_nor_seams(
        seed in 0u64..1000, angle in 0.0..6.3, scale in 0.01..100.0, shift in -50.0..50.0,
    ) {
        let quads = squares(2, 1, seed);
        let bumpy: Vec<[f64; 3]> =
            quads.positions().iter().map(|p| [p[0] * 1.3 + 0.2 * p[1] * p[2], p[1], p[2]]).collect();
        let quads = QuadMesh::new(bumpy, quads.quads().to_vec()).unwrap();
        let layout = lay_out_squares(&quads).unwrap();
        let turn = Complex64::from_polar(scale, angle);
        let moved = |uv: &[f64; 2]| {
            let z = turn * Complex64::new(uv[0], uv[1]) + Complex64::new(shift, -shift);
            [z.re, z.im]
        };
        let turned = QuadLayout {
            corner_uvs: layout.corner_uvs.iter().map(moved).collect(),
            ..layout.clone()
        };
        let (before, after) = (certified(&layout), certified(&turned));
        let seams = |map: &SeamlessMap| {
            map.seams().iter().map(|s| (s.vertices, s.matching)).collect::<Vec<_>>()
        };
        prop_assert_eq!(seams(&before), seams(&after));
        prop_assert_eq!(before.cones(), after.cones());
        let metric = Metric::from_positions(&layout.mesh, quads.positions());
        let tau = |l: &QuadLayout| distortion(&l.mesh, &metric, &l.corner_uvs).tau;
        prop_assert!((tau(&layout) / tau(&turned) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_perfect_grid_is_an_isometry() {
    let positions: Vec<[f64; 3]> =
        (0..20).map(|i| [f64::from(i % 5) * 0.1, f64::from(i / 5) * 0.1, 7.0]).collect();
    let cell = |x: u32, y: u32| [0, 1, 6, 5].map(|k| 5 * y + x + k);
    let quads: Vec<[u32; 4]> = (0..3).flat_map(|y| (0..4).map(move |x| cell(x, y))).collect();
    let quality = measure(&positions, quads.iter().map(<[u32; 4]>::as_slice));
    let distortion = quality.distortion.unwrap();
    assert!((distortion.tau - 1.0).abs() < 1e-12 && distortion.arap < 1e-12);
    assert!((quality.angles.min - 90.0).abs() < 1e-9 && (quality.angles.max - 90.0).abs() < 1e-9);
    assert!(quality.edge_lengths.variation < 1e-12);
    assert_eq!(quality.topology.n_irregular(), 0);
    assert_eq!(quality.topology.boundary_vertices, BTreeMap::from([(1, 4), (2, 10)]));
}

#[test]
fn what_is_no_quad_manifold_is_measured_without_a_layout() {
    let positions =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.5, 0.0]];
    let with_triangle: [&[u32]; 2] = [&[0, 1, 2, 3], &[1, 4, 2]];
    let quality = measure(&positions, with_triangle.into_iter());
    assert!(quality.distortion.is_none());
    assert!(quality.no_layout.unwrap().contains("polygon 1 has 3 corners"));
    assert_eq!(quality.topology.polygons, BTreeMap::from([(3, 1), (4, 1)]));
    let twice: [&[u32]; 2] = [&[0, 1, 2, 3], &[0, 1, 2, 3]];
    let quality = measure(&positions, twice.into_iter());
    assert!(quality.no_layout.unwrap().contains("manifold"));
    assert_eq!(quality.topology.bad_edges, 4);
}

#[test]
fn quads_turned_against_each_other_have_no_layout() {
    let positions = kit::slab_with_holes(0).positions;
    let quads = QuadMesh::new(positions, vec![[0, 1, 2, 3], [0, 1, 4, 5]]).unwrap();
    assert!(matches!(lay_out_squares(&quads), Err(LayoutError::NoManifold(_))));
}
