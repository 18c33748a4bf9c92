//! Random edge flips.

use crate::rng::Rng;
use seamstress_mesh::soup::TriangleSoup;
use std::collections::HashMap;

/// Smallest corner angle, in radians, that a flip may make, unless there was a smaller one before.
const MIN_ANGLE: f64 = 0.1;

/// Tries for each flip before giving up: some meshes, such as the torus of seven vertices, have
/// no edge that can be flipped.
const TRIES_PER_FLIP: usize = 20;

/// Flips `n` random edges one after the other, fewer if it has no luck in 20 tries for each.
///
/// A flip keeps the surface a simple manifold: it never makes an edge that exists, leaves inner
/// vertices of valence 3 alone, and makes no corner angle below a twentieth of a half turn or the
/// smallest of the two faces before. The soup must be a mesh.
#[must_use]
pub fn random_flips(soup: &TriangleSoup, n: usize, seed: u64) -> TriangleSoup {
    let mut soup = soup.clone();
    let mut rng = Rng::new(seed);
    let mut face_of_side = HashMap::new();
    for (&[a, b, c], face) in soup.faces.iter().zip(0u32..) {
        face_of_side.extend([([a, b], face), ([b, c], face), ([c, a], face)]);
    }
    let mut n_flips = 0;
    for _ in 0..n * TRIES_PER_FLIP {
        if n_flips == n || soup.faces.is_empty() {
            break;
        }
        let (face, k) = (rng.below(soup.faces.len()), rng.below(3));
        n_flips += usize::from(flip(&mut soup, &mut face_of_side, face, k));
    }
    soup
}

/// Replaces the side of `face` from its corner `k` by the other diagonal of its two faces.
/// Whether that was possible.
fn flip(
    soup: &mut TriangleSoup,
    face_of_side: &mut HashMap<[u32; 2], u32>,
    face: usize,
    k: usize,
) -> bool {
    let corner = |face: &[u32; 3], k: usize| face[k % 3];
    let triple = soup.faces[face];
    let [a, b, c] = [0, 1, 2].map(|step| corner(&triple, k + step));
    let Some(&across) = face_of_side.get(&[b, a]) else {
        return false;
    };
    let other = soup.faces[across as usize];
    let Some(d) = other.into_iter().find(|&v| v != a && v != b) else {
        return false;
    };
    if face_of_side.contains_key(&[c, d]) || face_of_side.contains_key(&[d, c]) || c == d {
        return false;
    }
    let new_faces = [[c, d, b], [d, c, a]];
    let min_angle = |faces: [[u32; 3]; 2]| {
        let angles = faces.map(|face| min_angle(face.map(|v| soup.positions[v as usize])));
        angles[0].min(angles[1])
    };
    if min_angle(new_faces) < MIN_ANGLE.min(min_angle([triple, other])) {
        return false;
    }
    soup.faces[face] = new_faces[0];
    soup.faces[across as usize] = new_faces[1];
    face_of_side.remove(&[a, b]);
    face_of_side.remove(&[b, a]);
    for (&[p, q, r], face) in new_faces.iter().zip([face as u32, across]) {
        face_of_side.extend([([p, q], face), ([q, r], face), ([r, p], face)]);
    }
    true
}

fn min_angle(corners: [[f64; 3]; 3]) -> f64 {
    let angle = |k: usize| {
        let [at, p, q] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
        let (u, v) = ([0, 1, 2].map(|i| p[i] - at[i]), [0, 1, 2].map(|i| q[i] - at[i]));
        let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
        let cosine = dot(u, v) / (dot(u, u) * dot(v, v)).sqrt();
        cosine.clamp(-1.0, 1.0).acos()
    };
    angle(0).min(angle(1)).min(angle(2))
}

#[cfg(test)]
mod tests {
    use super::random_flips;
    use crate::testing::{sound, topology};
    use crate::{
        annulus, bumpy, disk_grid, double_torus, icosphere, seven_vertex_torus, tetrahedron, torus,
    };

    #[test]
    fn flips_keep_topology() {
        let shapes =
            [icosphere(2), torus(8, 6, 2.0, 1.0), double_torus(), disk_grid(6, 6), annulus(9, 3)];
        for (shape, seed) in shapes.iter().zip(0..) {
            let shape = bumpy(shape, 0.1, seed);
            let flipped = random_flips(&shape, 200, seed);
            assert_eq!(topology(&flipped), topology(&shape));
            let (before, after) = (sound(&shape), sound(&flipped));
            assert_eq!((after.n_edges, after.n_faces), (before.n_edges, before.n_faces));
            let changed = flipped.faces.iter().zip(&shape.faces).filter(|(a, b)| a != b).count();
            assert!(2 * changed > shape.faces.len(), "{changed} of {} faces", shape.faces.len());
        }
    }

    #[test]
    fn complete_graphs_have_no_flip() {
        for complete in [tetrahedron(), seven_vertex_torus()] {
            assert_eq!(random_flips(&complete, 50, 3), complete);
        }
    }
}
