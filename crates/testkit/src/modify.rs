//! New surfaces from given ones.

use crate::rng::Rng;
use seamstress_mesh::soup::TriangleSoup;
use std::collections::HashMap;

type Point = [f64; 3];

fn distance(p: Point, q: Point) -> f64 {
    (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt()
}

/// Splits every face into four at the midpoints of its sides. Old vertices keep their numbers.
#[must_use]
pub fn subdivide(soup: &TriangleSoup) -> TriangleSoup {
    let mut positions = soup.positions.clone();
    let mut midpoints = HashMap::new();
    let mut midpoint = |a: u32, b: u32| {
        *midpoints.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let (p, q) = (soup.positions[a as usize], soup.positions[b as usize]);
            positions.push([0, 1, 2].map(|i| 0.5 * p[i] + 0.5 * q[i]));
            positions.len() as u32 - 1
        })
    };
    let mut faces = Vec::with_capacity(4 * soup.faces.len());
    for &[a, b, c] in &soup.faces {
        let [ab, bc, ca] = [midpoint(a, b), midpoint(b, c), midpoint(c, a)];
        faces.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    TriangleSoup { positions, faces }
}

/// Scales each axis by a factor of its own.
#[must_use]
pub fn stretch(soup: &TriangleSoup, factors: [f64; 3]) -> TriangleSoup {
    let positions = soup.positions.iter().map(|p| [0, 1, 2].map(|i| factors[i] * p[i])).collect();
    TriangleSoup { positions, faces: soup.faces.clone() }
}

/// Scales by one factor.
#[must_use]
pub fn scale(soup: &TriangleSoup, factor: f64) -> TriangleSoup {
    stretch(soup, [factor; 3])
}

/// Moves every vertex at random, by at most `amplitude` times its shortest edge. Up to 0.25 no two
/// neighbours can meet.
#[must_use]
pub fn bumpy(soup: &TriangleSoup, amplitude: f64, seed: u64) -> TriangleSoup {
    let mut shortest = vec![f64::INFINITY; soup.positions.len()];
    for face in &soup.faces {
        for k in 0..3 {
            let (a, b) = (face[k] as usize, face[(k + 1) % 3] as usize);
            let length = distance(soup.positions[a], soup.positions[b]);
            shortest[a] = shortest[a].min(length);
            shortest[b] = shortest[b].min(length);
        }
    }
    let mut rng = Rng::new(seed);
    let mut bumped = soup.clone();
    for (p, &length) in bumped.positions.iter_mut().zip(&shortest) {
        let step = rng.in_ball();
        if length.is_finite() {
            *p = [0, 1, 2].map(|i| p[i] + amplitude * length * step[i]);
        }
    }
    bumped
}

/// Gives vertices and faces new numbers at random, and faces another first corner.
#[must_use]
pub fn relabel(soup: &TriangleSoup, seed: u64) -> TriangleSoup {
    let mut rng = Rng::new(seed);
    let new_vertex = rng.permutation(soup.positions.len());
    let mut positions = soup.positions.clone();
    for (&new, &p) in new_vertex.iter().zip(&soup.positions) {
        positions[new as usize] = p;
    }
    let order = rng.permutation(soup.faces.len());
    let mut renamed = |old: u32| {
        let mut face = soup.faces[old as usize].map(|v| new_vertex[v as usize]);
        face.rotate_left(rng.below(3));
        face
    };
    let faces = order.into_iter().map(&mut renamed).collect();
    TriangleSoup { positions, faces }
}

/// Raises a pyramid on every face, its apex above the barycentre by `height` times the longest
/// side of the face. Old vertices keep their numbers.
#[must_use]
pub fn klee(soup: &TriangleSoup, height: f64) -> TriangleSoup {
    let mut positions = soup.positions.clone();
    let mut faces = Vec::with_capacity(3 * soup.faces.len());
    for &[a, b, c] in &soup.faces {
        let [p, q, r] = [a, b, c].map(|v| soup.positions[v as usize]);
        let longest = distance(p, q).max(distance(q, r)).max(distance(r, p));
        let (u, v) = ([0, 1, 2].map(|i| q[i] - p[i]), [0, 1, 2].map(|i| r[i] - p[i]));
        let normal = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            u[j] * v[k] - u[k] * v[j]
        });
        let lift = height * longest / distance(normal, [0.0; 3]);
        let apex = positions.len() as u32;
        positions.push([0, 1, 2].map(|i| (p[i] + q[i] + r[i]) / 3.0 + lift * normal[i]));
        faces.extend([[a, b, apex], [b, c, apex], [c, a, apex]]);
    }
    TriangleSoup { positions, faces }
}

/// Several soups side by side in one, none touching another's vertices. They stay where they are.
#[must_use]
pub fn disjoint_union(soups: &[TriangleSoup]) -> TriangleSoup {
    let mut union = TriangleSoup::default();
    for soup in soups {
        let offset = union.positions.len() as u32;
        union.positions.extend(&soup.positions);
        union.faces.extend(soup.faces.iter().map(|face| face.map(|v| v + offset)));
    }
    union
}

/// Removes the faces listed, and the vertices that are in no face then.
#[must_use]
pub fn remove_faces(soup: &TriangleSoup, faces: &[u32]) -> TriangleSoup {
    let mut new_vertex = vec![None; soup.positions.len()];
    let mut is_removed = vec![false; soup.faces.len()];
    for &face in faces {
        is_removed[face as usize] = true;
    }
    let kept = || soup.faces.iter().zip(&is_removed).filter(|&(_, &removed)| !removed);
    for &v in kept().flat_map(|(face, _)| face) {
        new_vertex[v as usize] = Some(0);
    }
    let mut positions = Vec::new();
    for (new, &p) in new_vertex.iter_mut().zip(&soup.positions).filter(|(new, _)| new.is_some()) {
        *new = Some(positions.len() as u32);
        positions.push(p);
    }
    let faces = kept().map(|(face, _)| face.map(|v| new_vertex[v as usize].unwrap())).collect();
    TriangleSoup { positions, faces }
}

/// Cuts `n` holes into a surface, each the star of a random vertex, apart from each other and from
/// the boundary. Panics if there is no room.
#[must_use]
pub fn with_boundaries(soup: &TriangleSoup, n: usize, seed: u64) -> TriangleSoup {
    let mut stars = vec![Vec::new(); soup.positions.len()];
    for (face, f) in soup.faces.iter().zip(0u32..) {
        for &v in face {
            stars[v as usize].push(f);
        }
    }
    // A vertex is taken if it is on the boundary or on the rim of a hole.
    let mut is_taken = boundary_vertices(soup);
    let mut holes = Vec::new();
    let mut n_holes = 0;
    for centre in Rng::new(seed).permutation(soup.positions.len()) {
        let star = &stars[centre as usize];
        let rim = || star.iter().flat_map(|&f| soup.faces[f as usize]);
        if n_holes == n {
            break;
        }
        if star.is_empty() || rim().any(|v| is_taken[v as usize]) {
            continue;
        }
        // Neighbours of the rim are taken too: no face may have all its corners on rims.
        for v in rim().flat_map(|v| &stars[v as usize]).flat_map(|&f| soup.faces[f as usize]) {
            is_taken[v as usize] = true;
        }
        holes.extend(star);
        n_holes += 1;
    }
    assert!(n_holes == n, "no room for {n} holes");
    remove_faces(soup, &holes)
}

fn boundary_vertices(soup: &TriangleSoup) -> Vec<bool> {
    let sides = |face: &[u32; 3]| [0, 1, 2].map(|k| [face[k], face[(k + 1) % 3]]);
    let mut n_faces = HashMap::new();
    for [a, b] in soup.faces.iter().flat_map(sides) {
        *n_faces.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
    }
    let mut on_boundary = vec![false; soup.positions.len()];
    for (edge, _) in n_faces.into_iter().filter(|&(_, n)| n == 1) {
        for v in edge {
            on_boundary[v as usize] = true;
        }
    }
    on_boundary
}

#[cfg(test)]
mod tests {
    use super::{
        bumpy, disjoint_union, klee, relabel, remove_faces, scale, stretch, subdivide,
        with_boundaries,
    };
    use crate::testing::{six_volumes, sound, topology};
    use crate::{cube, disk_grid, double_torus, icosphere, octahedron, slab_with_holes, torus};

    #[test]
    fn subdivision_keeps_topology_and_volume() {
        let fine = subdivide(&double_torus());
        assert_eq!(topology(&fine), (-2, 2, 0));
        assert_eq!(fine.faces.len(), 4 * double_torus().faces.len());
        assert_eq!(six_volumes(&fine), six_volumes(&double_torus()));
    }

    #[test]
    fn scaling_scales() {
        assert_eq!(six_volumes(&stretch(&cube(), [2.0, 3.0, 0.5])), 18.0);
        assert_eq!(sound(&scale(&cube(), 1e200)).min_edge_length, Some(1e200));
    }

    #[test]
    fn bumps_come_from_the_seed_alone() {
        let bumped = bumpy(&torus(9, 7, 2.0, 1.0), 0.2, 5);
        assert_eq!(topology(&bumped), (0, 1, 0));
        assert_eq!(bumped, bumpy(&torus(9, 7, 2.0, 1.0), 0.2, 5));
        assert_ne!(bumped, bumpy(&torus(9, 7, 2.0, 1.0), 0.2, 6));
    }

    #[test]
    fn relabelling_keeps_all_facts() {
        for (shape, seed) in [slab_with_holes(3), disk_grid(5, 4), octahedron()].iter().zip(1..) {
            let other = relabel(shape, seed);
            assert_ne!(other.faces, shape.faces);
            assert_eq!(sound(&other), sound(shape));
        }
    }

    #[test]
    fn klee_triples_the_faces() {
        let spiky = klee(&octahedron(), 1.0);
        assert_eq!(topology(&spiky), (2, 0, 0));
        assert_eq!(spiky.faces.len(), 24);
        // Each spike adds a third of its base √3/2 times its height √2.
        let added = 8.0 * 3f64.sqrt() / 2.0 * 2f64.sqrt() / 3.0;
        let volume = six_volumes(&octahedron()) / 6.0 + added;
        assert!((six_volumes(&spiky) / 6.0 - volume).abs() < 1e-14);
    }

    #[test]
    fn a_union_counts_its_parts() {
        let facts = sound(&disjoint_union(&[cube(), disk_grid(2, 2), double_torus()]));
        let parts: Vec<_> =
            facts.components.iter().map(|c| (c.genus, c.boundary_loops, c.n_faces)).collect();
        let n = double_torus().faces.len();
        assert_eq!(parts, [(Some(0), 0, 12), (Some(0), 1, 8), (Some(2), 0, n)]);
    }

    #[test]
    fn removing_faces_drops_their_vertices() {
        // The star of a corner of the octahedron leaves the lower half.
        let half = remove_faces(&octahedron(), &[0, 1, 2, 3]);
        assert_eq!(half.positions.len(), 5);
        assert_eq!(topology(&half), (1, 0, 1));
    }

    #[test]
    fn holes_are_apart() {
        for seed in 0..20 {
            let sphere = with_boundaries(&icosphere(2), 3, seed);
            assert_eq!(topology(&sphere), (-1, 0, 3));
            let disk = with_boundaries(&disk_grid(12, 12), 2, seed);
            assert_eq!(topology(&disk), (-1, 0, 3));
        }
    }
}
