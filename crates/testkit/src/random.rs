//! A surface from a seed.

use crate::modify::{bumpy, relabel, stretch, subdivide, with_boundaries};
use crate::rng::Rng;
use crate::{icosphere, random_flips, slab_with_holes, torus, uv_sphere};
use seamstress_mesh::soup::TriangleSoup;

/// A surface in one piece of genus 0 to 3 with 0 to 3 boundary loops and 100 to 2000 faces:
/// oriented, manifold, bumpy, irregular and in random order.
#[must_use]
pub fn random_surface(seed: u64) -> TriangleSoup {
    let mut rng = Rng::new(seed);
    let genus = rng.below(4) as u32;
    let n_loops = rng.below(4);
    let is_round = rng.below(2) == 1;
    let mut surface = match (genus, is_round) {
        (0, true) => icosphere(2 + rng.below(2) as u32),
        (1, true) => torus(10 + rng.below(20) as u32, 8 + rng.below(15) as u32, 2.0, 0.8),
        _ => fine_slab(genus, &mut rng),
    };
    let factors = [(); 3].map(|()| 0.5 + 1.5 * rng.unit());
    surface = bumpy(&stretch(&surface, factors), 0.2, rng.bits());
    let n_flips = rng.below(surface.faces.len());
    surface = random_flips(&surface, n_flips, rng.bits());
    relabel(&with_boundaries(&surface, n_loops, rng.bits()), rng.bits())
}

/// A sphere of 20 vertices with random positions, valences and order.
#[must_use]
pub fn small_sphere(seed: u64) -> TriangleSoup {
    let mut rng = Rng::new(seed);
    let sphere = random_flips(&uv_sphere(6, 4), rng.below(60), rng.bits());
    relabel(&bumpy(&sphere, 0.5 * rng.unit(), rng.bits()), rng.bits())
}

/// A slab of 256 to 1600 faces: fine enough for three holes.
fn fine_slab(genus: u32, rng: &mut Rng) -> TriangleSoup {
    let slab = subdivide(&slab_with_holes(genus));
    let splits_again = match genus {
        0 => true,
        1 | 2 => rng.below(2) == 1,
        _ => false,
    };
    if splits_again { subdivide(&slab) } else { slab }
}

#[cfg(test)]
mod tests {
    use super::random_surface;
    use crate::testing::topology;
    use std::collections::BTreeSet;

    #[test]
    fn random_surfaces_are_what_they_promise() {
        let mut kinds = BTreeSet::new();
        for seed in 0..300 {
            let surface = random_surface(seed);
            let (euler, genus, loops) = topology(&surface);
            assert_eq!(euler, 2 - 2 * genus as i64 - loops as i64);
            assert!(genus <= 3 && loops <= 3, "seed {seed}");
            assert!((100..=2000).contains(&surface.faces.len()), "seed {seed}");
            kinds.insert((genus, loops));
        }
        assert_eq!(kinds.len(), 16, "every genus comes with every number of loops");
        assert_eq!(random_surface(17), random_surface(17));
    }
}
