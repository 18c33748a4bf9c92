//! Quality metrics of quad meshes: what they must not depend on.
#![allow(clippy::unwrap_used, reason = "helpers of a test")]

use proptest::prelude::*;
use seamstress_quads::quality::{ComparisonError, angle_deviations, compare, measure};
use seamstress_testkit as kit;

/// A random complex of quads with corners anywhere nearby: no quad is flat, and diagonals differ.
fn bumpy_quads(genus: u32, seed: u64) -> kit::QuadSoup {
    let mut soup = kit::random_quads(genus, 30, seed);
    let mut rng = kit::Rng::new(seed);
    for x in soup.positions.as_flattened_mut() {
        *x += 0.3 * (rng.below(1000) as f64 / 1000.0);
    }
    soup
}

fn slices(polygons: &[Vec<u32>]) -> impl Iterator<Item = &[u32]> + Clone {
    polygons.iter().map(Vec::as_slice)
}

/// The same polygons, each listed from another corner.
fn turned(polygons: &[Vec<u32>], seed: u64) -> Vec<Vec<u32>> {
    let mut rng = kit::Rng::new(seed);
    let mut turn = |polygon: &Vec<u32>| {
        let mut turned = polygon.clone();
        turned.rotate_left(rng.below(polygon.len()));
        turned
    };
    polygons.iter().map(&mut turn).collect()
}

/// All metrics, with every digit.
fn metrics(
    (positions, polygons): (&[[f64; 3]], &[Vec<u32>]),
    (source_positions, source): (&[[f64; 3]], &[Vec<u32>]),
) -> [String; 3] {
    let quality = measure(positions, slices(polygons));
    let compared =
        compare((positions, slices(polygons)), (source_positions, slices(source)), 500).unwrap();
    let deviations = angle_deviations(positions, slices(polygons));
    [format!("{quality:?}"), format!("{compared:?}"), format!("{deviations:?}")]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]

    #[test]
    fn the_corner_a_polygon_is_listed_from_does_not_matter(
        genus in 0u32..2, seed in 0u64..1000, turns in any::<u64>(),
    ) {
        let soup = bumpy_quads(genus, seed);
        let source = bumpy_quads(genus, seed + 1);
        let mut quads: Vec<Vec<u32>> = soup.quads.iter().map(|q| q.to_vec()).collect();
        let mut reference: Vec<Vec<u32>> = source.quads.iter().map(|q| q.to_vec()).collect();
        // Triangles and larger polygons count as well: half a quad, and two in one.
        let half = reference.pop().unwrap();
        reference.push(half[..3].to_vec());
        for mixed in [false, true] {
            if mixed {
                quads.clone_from(&reference);
            }
            let positions = if mixed { &source.positions } else { &soup.positions };
            let before = metrics((positions, &quads), (&source.positions, &reference));
            let (a, b) = (turned(&quads, turns), turned(&reference, turns.wrapping_add(1)));
            let after = metrics((positions, &a), (&source.positions, &b));
            prop_assert_eq!(before, after);
        }
    }
}

#[test]
fn quads_are_split_along_their_shorter_diagonal_on_both_sides() {
    // A tent whose ridge is the shorter diagonal: over the other one it would be a trough, half a unit off.
    let tent = [[0.0, -2.0, 0.0], [1.0, 0.0, 1.0], [0.0, 2.0, 0.0], [-1.0, 0.0, 1.0]];
    let ridge: [&[u32]; 2] = [&[0, 1, 3], &[1, 2, 3]];
    for turn in 0..4 {
        let mut quad = vec![0, 1, 2, 3];
        quad.rotate_left(turn);
        let quads = || std::iter::once(quad.as_slice());
        let there = compare((&tent, quads()), (&tent, ridge.into_iter()), 100).unwrap();
        let back = compare((&tent, ridge.into_iter()), (&tent, quads()), 100).unwrap();
        assert!(there.distance.hausdorff < 1e-12 && back.distance.hausdorff < 1e-12, "{turn}");
    }
}

#[test]
fn polygons_at_fault_are_named() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let good: [&[u32]; 1] = [&[0, 1, 2]];
    let bad: [&[u32]; 2] = [&[0, 1, 2], &[0, 1]];
    let with = |mesh: &'static [&'static [u32]], source: &'static [&'static [u32]]| {
        let (mesh, source) = (mesh.iter().copied(), source.iter().copied());
        compare((&positions, mesh), (&positions, source), 10).unwrap_err()
    };
    let (good, bad): (&[&[u32]], &[&[u32]]) = (Vec::leak(good.to_vec()), Vec::leak(bad.to_vec()));
    assert!(matches!(with(bad, good), ComparisonError::BadMesh(_)));
    let error = with(good, bad);
    assert!(matches!(error, ComparisonError::BadSource(_)) && error.to_string().contains("face 1"));
}
