//! Integer maps made from quads: exact by construction.

use crate::rng::Rng;
use crate::voxels::voxel_surface;
use seamstress_mesh::TriMesh;
use seamstress_mesh::soup::TriangleSoup;
use std::collections::{BTreeSet, HashMap};

type Uv = [f64; 2];

/// A mesh with a UV per corner, three per face.
#[derive(Debug, Clone, PartialEq)]
pub struct IntegerMap {
    /// The mesh.
    pub soup: TriangleSoup,
    /// The map, in grid units.
    pub corner_uvs: Vec<Uv>,
}

/// Every pair of faces, the two halves of a quad, laid out as a square of side `n`.
///
/// The soup must have been made from quads `[a, b, c, d]` as `[a, b, c], [a, c, d]`, as grids, tori and
/// voxel surfaces are.
#[must_use]
pub fn squares(soup: &TriangleSoup, n: u32) -> IntegerMap {
    let n = f64::from(n);
    let square = [[0.0, 0.0], [n, 0.0], [n, n], [0.0, n]];
    let mut corner_uvs = Vec::new();
    for pair in soup.faces.chunks(2) {
        assert!(pair.len() == 2 && pair[0][0] == pair[1][0] && pair[0][2] == pair[1][1], "no quad");
        corner_uvs.extend([0, 1, 2, 0, 2, 3].map(|k| square[k]));
    }
    IntegerMap { soup: soup.clone(), corner_uvs }
}

/// The surface of a random union of up to `n` cubes, a manifold.
#[must_use]
pub fn random_voxels(n: usize, seed: u64) -> TriangleSoup {
    let mut rng = Rng::new(seed);
    let mut cells = BTreeSet::from([[0, 0, 0]]);
    for _ in 0..n {
        let all: Vec<[i32; 3]> = cells.iter().copied().collect();
        let mut cell = all[rng.below(all.len())];
        cell[rng.below(3)] += if rng.below(2) == 0 { 1 } else { -1 };
        if cells.insert(cell) {
            let soup = voxel_surface(&cells.iter().copied().collect::<Vec<_>>());
            if TriMesh::from_faces(soup.positions.len(), &soup.faces).is_err() {
                cells.remove(&cell);
            }
        }
    }
    voxel_surface(&cells.into_iter().collect::<Vec<_>>())
}

/// `i^turns` times a point.
fn turned(turns: usize, [u, v]: Uv) -> Uv {
    match turns % 4 {
        0 => [u, v],
        1 => [-v, u],
        2 => [-u, -v],
        _ => [v, -u],
    }
}

impl IntegerMap {
    /// Gives every face a chart of its own, turned by quarters and moved by integers up to `reach`.
    #[must_use]
    pub fn with_random_charts(mut self, reach: usize, seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        for triangle in self.corner_uvs.chunks_exact_mut(3) {
            let turns = rng.below(4);
            let shift = [(); 2].map(|()| rng.below(2 * reach + 1) as f64 - reach as f64);
            for uv in triangle {
                let [u, v] = turned(turns, *uv);
                *uv = [u + shift[0], v + shift[1]];
            }
        }
        self
    }

    /// Splits every face into four at the midpoints of its sides.
    #[must_use]
    pub fn subdivided(&self) -> Self {
        let soup = crate::subdivide(&self.soup);
        let mid = |a: Uv, b: Uv| [0, 1].map(|k| 0.5 * (a[k] + b[k]));
        let split = |uv: &[Uv]| {
            let [a, b, c] = [uv[0], uv[1], uv[2]];
            let [ab, bc, ca] = [mid(a, b), mid(b, c), mid(c, a)];
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        };
        let corner_uvs = self.corner_uvs.chunks_exact(3).flat_map(split).flatten().collect();
        Self { soup, corner_uvs }
    }

    /// Splits every face into three at a random point inside.
    #[must_use]
    pub fn with_random_points(&self, seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        let mut map = Self { soup: self.soup.clone(), corner_uvs: Vec::new() };
        map.soup.faces.clear();
        for (&[a, b, c], uv) in self.soup.faces.iter().zip(self.corner_uvs.chunks_exact(3)) {
            let weights = [(); 3].map(|()| 0.1 + rng.unit());
            let total: f64 = weights.iter().sum();
            let weights = weights.map(|w| w / total);
            let at =
                |points: [&[f64]; 3], k: usize| (0..3).map(|i| weights[i] * points[i][k]).sum();
            let corners = [a, b, c].map(|v| &self.soup.positions[v as usize][..]);
            let images = [&uv[0][..], &uv[1][..], &uv[2][..]];
            let image: Uv = [at(images, 0), at(images, 1)];
            let middle = map.soup.positions.len() as u32;
            map.soup.positions.push([at(corners, 0), at(corners, 1), at(corners, 2)]);
            map.soup.faces.extend([[a, b, middle], [b, c, middle], [c, a, middle]]);
            map.corner_uvs.extend([uv[0], uv[1], image, uv[1], uv[2], image, uv[2], uv[0], image]);
        }
        map
    }

    /// Moves interior vertices with a full turn of angle by up to `reach` in the plane, as far as no
    /// face turns over. Positions stay.
    #[must_use]
    pub fn with_moved_vertices(mut self, reach: f64, seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        let mesh = TriMesh::from_faces(self.soup.positions.len(), &self.soup.faces).unwrap();
        for v in mesh.vertices().filter(|&v| !mesh.is_boundary(v)) {
            let direction = 4.0 * rng.unit();
            let (sin, cos) = (direction * std::f64::consts::FRAC_PI_2).sin_cos();
            let length = reach * rng.unit();
            let mut step = [length * cos, length * sin];
            let before = self.corner_uvs.clone();
            let corners: Vec<usize> = mesh.outgoing(v).map(|h| h.at()).collect();
            let mut quarters = 0;
            for h in mesh.outgoing(v) {
                for (at, x) in self.corner_uvs[h.at()].iter_mut().zip(step) {
                    *at += x;
                }
                // Across the edge to the next face: how its image there is turned.
                let twin = mesh.twin(h.prev()).unwrap();
                let here = difference(before[h.prev().at()], before[h.at()]);
                let there = difference(before[twin.next().at()], before[twin.at()]);
                let turns = (0..4).find(|&r| close(turned(r, here), there)).unwrap();
                step = turned(turns, step);
                quarters += turns;
            }
            let is_bad = corners.iter().any(|&c| area(&self.corner_uvs[c / 3 * 3..][..3]) <= 1e-9);
            if quarters % 4 != 0 || is_bad || angle(&before, &corners) > 6.3 {
                self.corner_uvs = before;
            }
        }
        self
    }

    /// Adds noise of up to `size` to every coordinate.
    #[must_use]
    pub fn with_noise(mut self, size: f64, seed: u64) -> Self {
        let mut rng = Rng::new(seed);
        for x in self.corner_uvs.as_flattened_mut() {
            *x += size * (2.0 * rng.unit() - 1.0);
        }
        self
    }

    /// Number of quads the map stands for: its area.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.corner_uvs.chunks_exact(3).map(area).sum()
    }

    /// Faces at each vertex of the quads whose halves the faces are.
    #[must_use]
    pub fn quad_valences(&self) -> HashMap<u32, usize> {
        let mut valences = HashMap::new();
        for pair in self.soup.faces.chunks(2) {
            for v in [pair[0][0], pair[0][1], pair[0][2], pair[1][2]] {
                *valences.entry(v).or_default() += 1;
            }
        }
        valences
    }
}

fn difference(a: Uv, b: Uv) -> Uv {
    [a[0] - b[0], a[1] - b[1]]
}

fn close(a: Uv, b: Uv) -> bool {
    (0..2).all(|k| (a[k] - b[k]).abs() < 1e-9)
}

fn area(uv: &[Uv]) -> f64 {
    let (p, q) = (difference(uv[1], uv[0]), difference(uv[2], uv[0]));
    0.5 * (p[0] * q[1] - p[1] * q[0])
}

fn angle(uvs: &[Uv], corners: &[usize]) -> f64 {
    let at = |&c: &usize| {
        let uv = &uvs[c / 3 * 3..][..3];
        let (p, q) =
            (difference(uv[(c + 1) % 3], uv[c % 3]), difference(uv[(c + 2) % 3], uv[c % 3]));
        (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1])
    };
    corners.iter().map(at).sum()
}

#[cfg(test)]
mod tests {
    use super::{random_voxels, squares};
    use crate::testing::topology;
    use crate::{slab_with_holes, torus};

    #[test]
    fn areas_are_quads() {
        let map = squares(&slab_with_holes(2), 3);
        let n = map.soup.faces.len() as f64 / 2.0;
        for map in
            [map.clone().with_random_charts(5, 1), map.subdivided(), map.with_random_points(2)]
        {
            assert!((map.area() - 9.0 * n).abs() < 1e-9);
            topology(&map.soup);
        }
    }

    #[test]
    fn vertices_move_in_all_their_charts() {
        let map = squares(&torus(5, 4, 2.0, 0.7), 2).with_random_charts(3, 4);
        let moved = map.clone().with_moved_vertices(0.3, 5);
        let changed = map.corner_uvs.iter().zip(&moved.corner_uvs).filter(|(a, b)| a != b).count();
        assert!(changed > 60, "{changed} of 120 corners");
        assert!((moved.area() - map.area()).abs() < 1e-9);
    }

    #[test]
    fn random_voxels_are_manifold() {
        for seed in 0..20 {
            topology(&random_voxels(12, seed));
        }
    }
}
