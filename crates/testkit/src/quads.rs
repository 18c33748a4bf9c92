//! Random quad complexes.

use crate::rng::Rng;
use crate::{random_voxels, slab_with_holes};
use std::collections::HashMap;

/// Quads, closed and oriented, and positions for them.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadSoup {
    /// One per vertex.
    pub positions: Vec<[f64; 3]>,
    /// Counter-clockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
}

/// A random manifold of quads of the given genus: squares of cubes, changed `steps` times.
///
/// A step puts a quad into the middle of another one, with four around it, or turns the edge between two quads by a
/// step around their hexagon. Vertices of any valence from three on come about.
#[must_use]
pub fn random_quads(genus: u32, steps: usize, seed: u64) -> QuadSoup {
    let soup = if genus == 0 { random_voxels(8, seed) } else { slab_with_holes(genus) };
    let pairs = soup.faces.chunks_exact(2);
    let quads = pairs.map(|pair| [pair[0][0], pair[0][1], pair[0][2], pair[1][2]]).collect();
    let mut found = QuadSoup { positions: soup.positions, quads };
    let mut rng = Rng::new(seed);
    for _ in 0..steps {
        let quad = rng.below(found.quads.len());
        match rng.below(3) {
            0 => found.inset(quad),
            _ => found.turn_edge(quad, rng.below(4)),
        }
    }
    for quad in &mut found.quads {
        quad.rotate_left(rng.below(4));
    }
    found
}

impl QuadSoup {
    /// Puts a quad into the middle of another one.
    fn inset(&mut self, quad: usize) {
        let outer = self.quads[quad];
        let corners = outer.map(|v| self.positions[v as usize]);
        let first = self.positions.len() as u32;
        let inner = [0, 1, 2, 3].map(|k| first + k);
        for k in 0..4 {
            let towards = |i: usize| 0.6 * corners[k][i] + 0.4 * corners[(k + 2) % 4][i];
            self.positions.push([0, 1, 2].map(towards));
        }
        self.quads[quad] = inner;
        let ring = (0..4).map(|k| {
            let next = (k + 1) % 4;
            [outer[k], outer[next], inner[next], inner[k]]
        });
        self.quads.extend(ring);
    }

    /// Turns the edge `k` of a quad around the hexagon of its two quads, unless that makes no manifold.
    fn turn_edge(&mut self, quad: usize, k: usize) {
        let at = |q: [u32; 4], k: usize| q[k % 4];
        let here = self.quads[quad];
        let (a, b) = (at(here, k), at(here, k + 1));
        let across = self.quads.iter().enumerate().find_map(|(other, corners)| {
            let j = (0..4).find(|&j| at(*corners, j) == b && at(*corners, j + 1) == a)?;
            Some((other, *corners, j))
        });
        let Some((other, there, j)) = across else { return };
        // The hexagon a, e, f, b, c, d; the edge a-b becomes e-c.
        let (c, d) = (at(here, k + 2), at(here, k + 3));
        let (e, f) = (at(there, j + 2), at(there, j + 3));
        let valence = |v: u32| self.quads.iter().flatten().filter(|&&w| w == v).count();
        let is_open = |x: u32, y: u32| !self.sides().contains_key(&(x, y));
        let are_apart = [a, b, c, d].iter().all(|v| ![e, f].contains(v));
        let is_free = is_open(c, e) && is_open(e, c);
        if !(are_apart && is_free && valence(a) > 3 && valence(b) > 3) {
            return;
        }
        self.quads[quad] = [c, d, a, e];
        self.quads[other] = [e, f, b, c];
    }

    fn sides(&self) -> HashMap<(u32, u32), usize> {
        let quads = self.quads.iter().enumerate();
        quads.flat_map(|(q, c)| (0..4).map(move |k| ((c[k], c[(k + 1) % 4]), q))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::random_quads;
    use std::collections::BTreeSet;

    #[test]
    fn complexes_are_closed_manifolds_of_their_genus_and_of_many_valences() {
        let mut valences = BTreeSet::new();
        for seed in 0..30 {
            let genus = (seed % 3) as u32;
            let found = random_quads(genus, 40, seed);
            let sides = found.sides();
            assert_eq!(sides.len(), 4 * found.quads.len(), "a side of two quads");
            assert!(sides.keys().all(|&(a, b)| sides.contains_key(&(b, a))), "open");
            let euler =
                found.positions.len() as i64 - sides.len() as i64 / 2 + found.quads.len() as i64;
            if genus > 0 {
                assert_eq!(euler, 2 - 2 * i64::from(genus));
            }
            let mut counts = vec![0; found.positions.len()];
            found.quads.iter().flatten().for_each(|&v| counts[v as usize] += 1);
            valences.extend(counts);
        }
        assert!(
            valences.contains(&3) && valences.contains(&5) && valences.len() >= 5,
            "{valences:?}"
        );
    }
}
