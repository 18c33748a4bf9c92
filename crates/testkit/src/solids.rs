//! Closed surfaces of genus 0.

use crate::modify::subdivide;
use seamstress_mesh::soup::TriangleSoup;
use std::f64::consts::{PI, TAU};

fn soup(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> TriangleSoup {
    TriangleSoup { positions: positions.to_vec(), faces: faces.to_vec() }
}

/// The regular tetrahedron on four corners of the cube `[-1, 1]³`.
#[must_use]
pub fn tetrahedron() -> TriangleSoup {
    let positions = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    soup(&positions, &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

/// The unit cube `[0, 1]³`, each side split along a diagonal: 8 vertices, 12 faces.
#[must_use]
pub fn cube() -> TriangleSoup {
    crate::voxel_surface(&[[0, 0, 0]])
}

/// The regular octahedron with corners on the unit sphere.
#[must_use]
pub fn octahedron() -> TriangleSoup {
    let positions = [
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let upper = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]];
    let lower = [[2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    soup(&positions, &[upper, lower].concat())
}

/// The regular icosahedron with corners on the unit sphere.
#[must_use]
pub fn icosahedron() -> TriangleSoup {
    // Two poles and two rings of five, the lower one turned by half a step.
    let height = 1.0 / 5f64.sqrt();
    let ring = |z: f64, turn: f64| {
        (0..5).map(move |i| {
            let angle = TAU * (f64::from(i) + turn) / 5.0;
            [2.0 * height * angle.cos(), 2.0 * height * angle.sin(), z]
        })
    };
    let mut positions = vec![[0.0, 0.0, 1.0]];
    positions.extend(ring(height, 0.0));
    positions.extend(ring(-height, 0.5));
    positions.push([0.0, 0.0, -1.0]);
    let mut faces = Vec::new();
    for i in 0..5 {
        let (a, b) = (1 + i, 1 + (i + 1) % 5);
        let (c, d) = (a + 5, b + 5);
        faces.extend([[0, a, b], [a, c, b], [b, c, d], [11, d, c]]);
    }
    TriangleSoup { positions, faces }
}

/// The unit sphere from the icosahedron split `n` times: 20·4ⁿ faces.
#[must_use]
pub fn icosphere(n: u32) -> TriangleSoup {
    let mut sphere = icosahedron();
    for _ in 0..n {
        sphere = subdivide(&sphere);
        for p in &mut sphere.positions {
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            *p = p.map(|x| x / length);
        }
    }
    sphere
}

/// The unit sphere in `n` ≥ 3 slices and `m` ≥ 2 stacks, with poles of valence `n`.
#[must_use]
pub fn uv_sphere(n: u32, m: u32) -> TriangleSoup {
    assert!(n >= 3 && m >= 2, "a sphere needs 3 slices and 2 stacks");
    let mut positions = vec![[0.0, 0.0, 1.0]];
    for j in 1..m {
        let polar = PI * f64::from(j) / f64::from(m);
        for i in 0..n {
            let around = TAU * f64::from(i) / f64::from(n);
            let radius = polar.sin();
            positions.push([radius * around.cos(), radius * around.sin(), polar.cos()]);
        }
    }
    let south = positions.len() as u32;
    positions.push([0.0, 0.0, -1.0]);
    let at = |i: u32, j: u32| 1 + (j - 1) * n + i % n;
    let mut faces = Vec::new();
    for i in 0..n {
        faces.push([0, at(i, 1), at(i + 1, 1)]);
        for j in 1..m - 1 {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
        faces.push([south, at(i + 1, m - 1), at(i, m - 1)]);
    }
    TriangleSoup { positions, faces }
}

/// Two cones of height 3 over a zigzag of `n` ≥ 3 points, even, on the unit circle: poles of valence `n`
/// and next to no angle, so that the layout of a smooth field folds.
#[must_use]
pub fn crown(n: u32) -> TriangleSoup {
    let mut crown = uv_sphere(n, 2);
    for (i, p) in crown.positions.iter_mut().enumerate() {
        let is_pole = p[2].abs() > 0.5;
        p[2] = if is_pole { 3.0 * p[2] } else { 0.3 * if i % 2 == 0 { 1.0 } else { -1.0 } };
    }
    crown
}

#[cfg(test)]
mod tests {
    use super::{crown, cube, icosahedron, icosphere, octahedron, tetrahedron, uv_sphere};
    use crate::testing::{six_volumes, sound, topology};
    use std::f64::consts::FRAC_PI_3;

    #[test]
    fn solids_are_spheres_that_look_outwards() {
        let solids =
            [tetrahedron(), cube(), octahedron(), icosahedron(), icosphere(2), uv_sphere(7, 5)];
        for solid in solids {
            assert_eq!(topology(&solid), (2, 0, 0));
            assert!(six_volumes(&solid) > 0.0);
        }
    }

    #[test]
    fn counts_and_shapes_by_hand() {
        assert_eq!((cube().positions.len(), cube().faces.len()), (8, 12));
        assert_eq!(icosphere(2).faces.len(), 320);
        // Two caps of n and n·(m−2) quads.
        assert_eq!(uv_sphere(7, 5).faces.len(), 2 * 7 + 2 * 7 * 3);
        for regular in [tetrahedron(), octahedron(), icosahedron()] {
            let facts = sound(&regular);
            assert!((facts.min_angle.unwrap() - FRAC_PI_3).abs() < 1e-14);
            let (short, long) = (facts.min_edge_length.unwrap(), facts.max_edge_length.unwrap());
            assert!(long - short < 1e-14);
        }
    }

    #[test]
    fn a_crown_is_a_sphere() {
        assert_eq!(topology(&crown(8)), (2, 0, 0));
        assert_eq!(crown(8).faces.len(), 16);
    }

    #[test]
    fn the_smallest_sphere_of_slices() {
        let smallest = uv_sphere(3, 2);
        assert_eq!(smallest.faces.len(), 6);
        assert_eq!(topology(&smallest), (2, 0, 0));
    }
}
