//! What must hold of checks and repairs on surfaces of every kind.
#![allow(clippy::unwrap_used, clippy::panic)]

use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::{Facts, Fault, TriangleSoup, check, repair, triangulate};
use seamstress_testkit::{
    Rng, disjoint_union, double_torus, icosphere, octahedron, random_flips, random_surface,
    relabel, scale, torus, with_boundaries,
};

const SEEDS: std::ops::Range<u64> = 0..60;

/// Each component's Euler characteristic, genus and boundary loops, whatever their order.
fn topology(facts: &Facts) -> Vec<(i64, Option<usize>, usize)> {
    let kind = |c: &seamstress_mesh::soup::ComponentFacts| {
        (c.euler_characteristic(), c.genus, c.boundary_loops)
    };
    let mut kinds: Vec<_> = facts.components.iter().map(kind).collect();
    kinds.sort_unstable();
    kinds
}

#[test]
fn relabelling_changes_no_fact() {
    for seed in SEEDS {
        let parts = [random_surface(seed), random_surface(seed + 1000)];
        let surface = disjoint_union(&parts);
        let (one, other) = (check(&surface), check(&relabel(&surface, seed)));
        assert_eq!((&one.faults, &other.faults), (&vec![], &vec![]));
        assert_eq!(topology(&one.facts), topology(&other.facts));
        let measures = |facts: &Facts| {
            let lengths = (facts.min_edge_length, facts.max_edge_length);
            (facts.n_edges, facts.bounding_box, lengths)
        };
        assert_eq!(measures(&one.facts), measures(&other.facts));
        let angles = [one.facts.min_angle.unwrap(), other.facts.min_angle.unwrap()];
        assert!((angles[0] - angles[1]).abs() < 1e-14);
    }
}

#[test]
fn flips_change_no_topology() {
    for seed in SEEDS {
        let surface = random_surface(seed);
        let flipped = check(&random_flips(&surface, 300, seed));
        assert_eq!(flipped.faults, []);
        assert_eq!(topology(&flipped.facts), topology(&check(&surface).facts));
    }
}

#[test]
fn units_change_nothing_but_lengths() {
    for factor in [1e-250, 1e-8, 1e8, 1e250] {
        let surface = random_surface(5);
        let (one, scaled) = (check(&surface), check(&scale(&surface, factor)));
        assert_eq!(scaled.faults, []);
        let ratio = scaled.facts.max_edge_length.unwrap() / one.facts.max_edge_length.unwrap();
        assert!((ratio / factor - 1.0).abs() < 1e-12);
        let (a, b) = (one.facts.min_angle.unwrap(), scaled.facts.min_angle.unwrap());
        assert!((a - b).abs() < 1e-12);
    }
}

/// A small mesh with a few faces changed at random: indices moved, faces copied or turned over.
fn corrupted(seed: u64) -> TriangleSoup {
    let mut rng = Rng::new(seed);
    let mut soup = match rng.below(4) {
        0 => octahedron(),
        1 => torus(4, 3, 2.0, 1.0),
        2 => double_torus(),
        _ => with_boundaries(&icosphere(1), 1, seed),
    };
    for _ in 0..rng.below(4) {
        let face = rng.below(soup.faces.len());
        match rng.below(4) {
            0 => soup.faces[face][rng.below(3)] = rng.below(soup.positions.len() + 1) as u32,
            1 => soup.faces[face].swap(0, 1),
            2 => soup.faces.push(soup.faces[face]),
            _ => drop(soup.faces.swap_remove(face)),
        }
    }
    soup
}

#[test]
fn a_soup_without_errors_is_exactly_what_makes_a_mesh() {
    let mut n_meshes = 0;
    for seed in 0..3000 {
        let soup = corrupted(seed);
        let report = check(&soup);
        let mesh = TriMesh::from_faces(soup.positions.len(), &soup.faces);
        assert_eq!(report.is_mesh(), mesh.is_ok(), "seed {seed}: {:?}, {mesh:?}", report.faults);
        n_meshes += usize::from(mesh.is_ok());
    }
    assert!((500..2500).contains(&n_meshes), "{n_meshes} of 3000: the test has both sides");
}

#[test]
fn repair_leaves_a_mesh() {
    let mut n_repaired = 0;
    for seed in 0..3000 {
        let soup = corrupted(seed);
        let done = repair(soup.clone());
        let left = check(&done.soup);
        let out_of_range = |fault: &Fault| matches!(fault, Fault::IndexOutOfRange { .. });
        if check(&soup).faults.iter().any(out_of_range) {
            assert_eq!(done.soup, soup);
            continue;
        }
        for fault in left.errors() {
            assert_eq!(*fault, Fault::NoFaces, "seed {seed}");
        }
        assert_eq!(repair(done.soup.clone()).repairs, [], "seed {seed}");
        n_repaired += usize::from(left.is_mesh() && !check(&soup).is_mesh());
    }
    assert!(n_repaired > 1000, "{n_repaired}");
}

#[test]
fn any_faces_can_be_made_sheets() {
    for seed in 0..5000 {
        let mut rng = Rng::new(seed);
        let n_vertices = 4 + rng.below(8);
        let positions = (0..n_vertices).map(|_| rng.in_ball()).collect();
        let n_faces = 1 + rng.below(30);
        let faces = (0..n_faces).map(|_| [0; 3].map(|_| rng.below(n_vertices) as u32)).collect();
        let done = repair(TriangleSoup { positions, faces });
        for fault in check(&done.soup).errors() {
            assert_eq!(*fault, Fault::NoFaces, "seed {seed}");
        }
    }
}

#[test]
fn harmless_damage_is_undone() {
    for seed in SEEDS {
        let surface = random_surface(seed);
        let mut rng = Rng::new(seed);
        let mut damaged = surface.clone();
        for _ in 0..20 {
            let face = rng.below(surface.faces.len());
            damaged.faces[face].swap(1, 2);
            damaged.positions.push(rng.in_ball());
        }
        // Copies and reverses, of faces inside and at the boundary.
        for _ in 0..5 {
            let [a, b, c] = damaged.faces[rng.below(surface.faces.len())];
            damaged.faces.push(if rng.below(2) == 0 { [a, b, c] } else { [b, a, c] });
        }
        assert!(!check(&damaged).is_mesh());
        assert_eq!(repair(damaged).soup.faces, surface.faces, "seed {seed}");
    }
}

#[test]
fn quads_of_a_mesh_come_back_as_triangles() {
    for seed in SEEDS {
        // Merge pairs of faces into quads where they fit, then split them again.
        let surface = random_surface(seed);
        let mut polygons: Vec<Vec<u32>> = Vec::new();
        let mut is_used = vec![false; surface.faces.len()];
        for (f, &[a, b, c]) in surface.faces.iter().enumerate() {
            if is_used[f] {
                continue;
            }
            is_used[f] = true;
            let across = surface.faces.iter().enumerate().find_map(|(g, other)| {
                let k = other.iter().position(|&v| v == b)?;
                let is_partner = !is_used[g] && other[(k + 1) % 3] == a;
                is_partner.then_some((g, other[(k + 2) % 3]))
            });
            match across {
                Some((g, d)) => {
                    is_used[g] = true;
                    polygons.push(vec![a, d, b, c]);
                }
                None => polygons.push(vec![a, b, c]),
            }
        }
        let slices = polygons.iter().map(Vec::as_slice);
        let done = triangulate(&surface.positions, slices).unwrap();
        assert_eq!(done.faces.len(), surface.faces.len());
        assert!(done.notes.quads > 0);
        let split = TriangleSoup { positions: surface.positions.clone(), faces: done.faces };
        let report = check(&split);
        assert!(report.is_mesh(), "seed {seed}");
        assert_eq!(topology(&report.facts), topology(&check(&surface).facts));
    }
}
