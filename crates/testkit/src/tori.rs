//! Closed surfaces of genus 1.

use seamstress_mesh::soup::TriangleSoup;
use std::f64::consts::TAU;

/// The torus around the z-axis with `n` ≥ 3 steps around it and `m` ≥ 3 around the tube, of
/// radius `ring` to the middle of the tube and radius `tube` of the tube: 2·n·m faces, all
/// vertices of valence 6.
#[must_use]
pub fn torus(n: u32, m: u32, ring: f64, tube: f64) -> TriangleSoup {
    assert!(n >= 3 && m >= 3, "a torus needs 3 steps both ways");
    let mut positions = Vec::new();
    for i in 0..n {
        let around = TAU * f64::from(i) / f64::from(n);
        for j in 0..m {
            let across = TAU * f64::from(j) / f64::from(m);
            let radius = ring + tube * across.cos();
            positions.push([radius * around.cos(), radius * around.sin(), tube * across.sin()]);
        }
    }
    let at = |i: u32, j: u32| (i % n) * m + j % m;
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleSoup { positions, faces }
}

/// The torus of Möbius and Császár: 7 vertices, 14 faces, every pair of vertices an edge. No edge
/// of it can be flipped. Its positions are in general position; the surface crosses itself.
#[must_use]
pub fn seven_vertex_torus() -> TriangleSoup {
    let point = |i: u32| {
        let t = TAU * f64::from(i) / 7.0;
        [t.cos(), t.sin(), (3.0 * t).cos()]
    };
    let triangles = |i: u32| {
        let at = |step: u32| (i + step) % 7;
        [[i, at(1), at(3)], [i, at(3), at(2)]]
    };
    TriangleSoup {
        positions: (0..7).map(point).collect(),
        faces: (0..7).flat_map(triangles).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::{seven_vertex_torus, torus};
    use crate::testing::{six_volumes, sound, topology};
    use std::f64::consts::PI;

    #[test]
    fn tori_have_genus_one() {
        for shape in [torus(3, 3, 1.0, 0.3), torus(12, 8, 2.0, 0.5), seven_vertex_torus()] {
            assert_eq!(topology(&shape), (0, 1, 0));
        }
    }

    #[test]
    fn a_fine_torus_has_its_volume() {
        let fine = torus(200, 100, 2.0, 0.5);
        let volume = 2.0 * PI * PI * 2.0 * 0.25;
        assert!((six_volumes(&fine) / 6.0 / volume - 1.0).abs() < 2e-3);
    }

    #[test]
    fn seven_vertices_are_all_neighbours() {
        let facts = sound(&seven_vertex_torus());
        assert_eq!((facts.n_vertices, facts.n_edges, facts.n_faces), (7, 21, 14));
    }
}
