//! No good result is refused.
#![allow(clippy::unwrap_used, reason = "a test")]

mod common;

use common::Case;
use seamstress_certify::{Map, Tolerance};
use seamstress_testkit::{Rng, random_voxels, squares};
use std::f64::consts::TAU;

/// Surfaces of random cubes: as integer-grid maps with their features and quads, and with moved vertices, finer faces,
/// turned by any angle, of any size, and rounded.
#[test]
fn a_thousand_good_results_pass() {
    for seed in 0..500u64 {
        let coarse = squares(&random_voxels(1 + seed as usize % 12, seed), 1);
        let case = Case::new(&coarse, seed);
        assert_eq!(case.violations(), [], "seed {seed}");

        let mut rng = Rng::new(seed);
        let mut map = coarse.with_random_charts(20, seed).with_random_points(seed);
        map = map.with_moved_vertices(0.4, seed);
        let (sin, cos) = (TAU * rng.unit()).sin_cos();
        let size = 10f64.powi(rng.below(200) as i32 - 100);
        for [u, v] in &mut map.corner_uvs {
            [*u, *v] = [size * (cos * *u - sin * *v), size * (sin * *u + cos * *v)];
        }
        let map = map.with_noise(1e-14 * size, seed);
        let checked = Map::new(map.soup.positions.len(), &map.soup.faces, &map.corner_uvs).unwrap();
        let found = checked.seamless(&Tolerance::default()).unwrap();
        let mut indices: Vec<i32> = found.cones.iter().map(|cone| cone.index).collect();
        let mut expected = case.cones;
        indices.sort_unstable();
        expected.sort_unstable();
        assert_eq!(indices, expected, "seed {seed}");
    }
}
