//! Surfaces with triangles that have no area.

use crate::rng::Rng;
use seamstress_mesh::soup::TriangleSoup;
use std::collections::HashMap;

/// Puts a vertex on each of `n` random edges, no two of one face: the face on one side is split there, the other is not,
/// and a triangle without area lies between. Fewer if there is no room.
#[must_use]
pub fn with_vertices_on_edges(soup: &TriangleSoup, n: usize, seed: u64) -> TriangleSoup {
    let mut rng = Rng::new(seed);
    let mut changed = soup.clone();
    let corners = soup.faces.iter().zip(0u32..);
    let sides = corners.flat_map(|(f, face)| (0..3).map(move |k| ([f[k], f[(k + 1) % 3]], face)));
    let face_of: HashMap<[u32; 2], u32> = sides.collect();
    let mut is_used = vec![false; soup.faces.len()];
    let mut left = n;
    for face in rng.permutation(soup.faces.len()) {
        let [a, b, c] = soup.faces[face as usize];
        let Some(&other) = face_of.get(&[b, a]) else { continue };
        if left == 0 || is_used[face as usize] || is_used[other as usize] {
            continue;
        }
        is_used[face as usize] = true;
        is_used[other as usize] = true;
        let [p, q] = [a, b].map(|v| soup.positions[v as usize]);
        let between = changed.positions.len() as u32;
        changed.positions.push([0, 1, 2].map(|i| 0.5 * (p[i] + q[i])));
        changed.faces[face as usize] = [a, between, c];
        changed.faces.extend([[between, b, c], [a, b, between]]);
        left -= 1;
    }
    changed
}

/// Splits `n` random vertices inside into two in the same place, no two of one face, with two triangles without area
/// between. Fewer if there is no room.
#[must_use]
pub fn with_copied_vertices(soup: &TriangleSoup, n: usize, seed: u64) -> TriangleSoup {
    let mut rng = Rng::new(seed);
    let mut changed = soup.clone();
    // For each vertex the faces around it, by the vertex that comes next.
    let mut around = vec![HashMap::new(); soup.positions.len()];
    for (f, face) in soup.faces.iter().zip(0usize..) {
        for k in 0..3 {
            around[f[k] as usize].insert(f[(k + 1) % 3], (f[(k + 2) % 3], face));
        }
    }
    let mut is_used = vec![false; soup.positions.len()];
    let mut left = n;
    for v in rng.permutation(soup.positions.len()) {
        let next = &around[v as usize];
        let is_inside = next.values().all(|(last, _)| next.contains_key(last));
        let is_free = !is_used[v as usize] && next.keys().all(|&w| !is_used[w as usize]);
        let Some(&first) = next.keys().min().filter(|_| left > 0 && is_inside && is_free) else {
            continue;
        };
        is_used[v as usize] = true;
        next.keys().for_each(|&w| is_used[w as usize] = true);
        let copy = changed.positions.len() as u32;
        changed.positions.push(soup.positions[v as usize]);
        // The first half of the faces keeps the vertex.
        let mut middle = first;
        for _ in 0..next.len() / 2 {
            middle = next[&middle].0;
        }
        let mut w = middle;
        while w != first {
            let (after, face) = next[&w];
            changed.faces[face] = [copy, w, after];
            w = after;
        }
        changed.faces.extend([[v, middle, copy], [copy, first, v]]);
        left -= 1;
    }
    changed
}
