//! A coarser mesh of nearly the same surface, to try on it what takes long on the mesh itself.
//!
//! Edges are collapsed into one of their ends, those first that move the surface least by its quadrics (Garland and
//! Heckbert 1997). This goes in rounds: in each, collapses that do not touch each other are done together. No vertex
//! moves, and the topology stays.

use crate::directed::Directed;
use crate::vector::{Point, cross, dot, norm, sub};
use seamstress_parallel::prelude::*;

/// A mesh whose vertices are some of another.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Coarsening {
    /// The vertices that are left, ascending.
    pub vertices: Vec<u32>,
    /// Faces, by positions in that list.
    pub faces: Vec<[u32; 3]>,
    /// For each face the one that it was.
    pub face_origin: Vec<u32>,
}

/// Collapses that are done in a round: the better half.
const SHARE: usize = 2;
/// Cosine of the largest turn of a face in one collapse: 60 degrees.
const LEAST_COSINE: f64 = 0.5;
/// Twice the area of a face over the square of its longest edge; a collapse makes none worse than both this and what was.
const LEAST_SHAPE: f64 = 0.1;
/// Vertices whose collapses are looked for in one go.
const CHUNK: usize = 1024;
/// Weight of planes that hold the boundary, where those of faces have their areas.
const RIM: f64 = 10.0;
/// Weight of the length of an edge, which decides where the surface is flat.
const LENGTH: f64 = 1e-3;

/// A mesh of about so many faces, or as few as there can be, with the vertices of an oriented manifold; those of `kept` stay.
pub fn coarsen(
    positions: &[[f64; 3]],
    faces: &[[u32; 3]],
    n_faces: usize,
    kept: &[u32],
) -> Coarsening {
    let (mut quadrics, on_boundary) = quadrics(positions, faces);
    let mut is_kept = vec![false; positions.len()];
    kept.iter().for_each(|&vertex| is_kept[vertex as usize] = true);
    let mut faces: Vec<(u32, [u32; 3])> = (0..).zip(faces.iter().copied()).collect();
    while faces.len() > n_faces {
        let before = faces.len();
        let round = Round::new(positions, &faces, &quadrics, &on_boundary);
        let target = round.collapses(&is_kept, (faces.len() - n_faces).div_ceil(2));
        for (from, &to) in target.iter().enumerate().filter(|&(from, &to)| from != to as usize) {
            let moved = quadrics[from];
            quadrics[to as usize].add(&moved);
        }
        faces.iter_mut().flat_map(|(_, face)| face).for_each(|v| *v = target[*v as usize]);
        faces.retain(|(_, [a, b, c])| a != b && b != c && c != a);
        if faces.len() == before {
            break;
        }
    }
    let mut vertices: Vec<u32> = faces.iter().flat_map(|&(_, face)| face).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let renumbered = |v: u32| vertices.binary_search(&v).unwrap_or_default() as u32;
    Coarsening {
        faces: faces.iter().map(|(_, face)| face.map(renumbered)).collect(),
        face_origin: faces.iter().map(|&(face, _)| face).collect(),
        vertices,
    }
}

/// The squared distance to planes, weighted and summed: `n n'`, `n d` and `d d` of planes `n x + d = 0`.
#[derive(Debug, Clone, Copy, Default)]
struct Quadric {
    square: [f64; 6],
    linear: Point,
    constant: f64,
}

impl Quadric {
    fn of_plane(normal: Point, through: Point, weight: f64) -> Self {
        let [x, y, z] = normal;
        let d = -dot(normal, through);
        Self {
            square: [x * x, x * y, x * z, y * y, y * z, z * z].map(|value| weight * value),
            linear: normal.map(|value| weight * d * value),
            constant: weight * d * d,
        }
    }

    fn add(&mut self, other: &Self) {
        self.square.iter_mut().zip(other.square).for_each(|(a, b)| *a += b);
        self.linear.iter_mut().zip(other.linear).for_each(|(a, b)| *a += b);
        self.constant += other.constant;
    }

    fn at(&self, point: Point) -> f64 {
        let ([x, y, z], [xx, xy, xz, yy, yz, zz]) = (point, self.square);
        let square = xx * x * x + yy * y * y + zz * z * z;
        let mixed = xy * x * y + xz * x * z + yz * y * z;
        square + 2.0 * (mixed + dot(self.linear, point)) + self.constant
    }
}

/// The planes of the faces around each vertex, and planes across the boundary; and which vertices lie on it.
fn quadrics(positions: &[[f64; 3]], faces: &[[u32; 3]]) -> (Vec<Quadric>, Vec<bool>) {
    let directed = Directed::new(positions.len(), faces);
    let mut quadrics = vec![Quadric::default(); positions.len()];
    let mut on_boundary = vec![false; positions.len()];
    for face in faces {
        let [a, b, c] = face.map(|v| positions[v as usize]);
        let normal = cross(sub(b, a), sub(c, a));
        let size = norm(normal);
        let unit = normal.map(|x| x / size);
        let plane = (size > 0.0).then(|| Quadric::of_plane(unit, a, size / 2.0));
        for k in 0..3 {
            let [from, to] = [face[k], face[(k + 1) % 3]];
            let on_rim = directed.find(to, from).is_none();
            if on_rim {
                [from, to].iter().for_each(|&v| on_boundary[v as usize] = true);
            }
            let Some(plane) = &plane else { continue };
            quadrics[from as usize].add(plane);
            if on_rim {
                let along = sub(positions[to as usize], positions[from as usize]);
                let across = cross(along, unit);
                let length = norm(across);
                let rim = Quadric::of_plane(
                    across.map(|x| x / length),
                    positions[to as usize],
                    RIM * length * length,
                );
                [from, to].iter().for_each(|&v| quadrics[v as usize].add(&rim));
            }
        }
    }
    (quadrics, on_boundary)
}

/// Room for the rings of two vertices, and for what it costs to go to those of the first.
#[derive(Default)]
struct Rings {
    ring: Vec<u32>,
    other: Vec<u32>,
    costs: Vec<(f64, u32)>,
}

/// A mesh between two rounds.
struct Round<'a> {
    positions: &'a [[f64; 3]],
    faces: &'a [(u32, [u32; 3])],
    quadrics: &'a [Quadric],
    on_boundary: &'a [bool],
    /// The faces around each vertex, one list after the other, and where each starts.
    around: Vec<u32>,
    starts: Vec<u32>,
}

impl<'a> Round<'a> {
    fn new(
        positions: &'a [[f64; 3]],
        faces: &'a [(u32, [u32; 3])],
        quadrics: &'a [Quadric],
        on_boundary: &'a [bool],
    ) -> Self {
        let mut starts = vec![0u32; positions.len() + 1];
        faces.iter().flat_map(|(_, face)| face).for_each(|&v| starts[v as usize + 1] += 1);
        (0..positions.len()).for_each(|v| starts[v + 1] += starts[v]);
        let mut next = starts.clone();
        let mut around = vec![0; 3 * faces.len()];
        for (k, (_, face)) in faces.iter().enumerate() {
            for &v in face {
                around[next[v as usize] as usize] = k as u32;
                next[v as usize] += 1;
            }
        }
        Self { positions, faces, quadrics, on_boundary, around, starts }
    }

    fn star(&self, vertex: u32) -> &[u32] {
        &self.around
            [self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }

    fn face(&self, face: u32) -> [u32; 3] {
        self.faces[face as usize].1
    }

    /// The vertices that share an edge with one, ascending.
    fn ring(&self, vertex: u32, ring: &mut Vec<u32>) {
        let others = |&face: &u32| match self.face(face) {
            [a, b, c] if a == vertex => [b, c],
            [a, b, c] if b == vertex => [c, a],
            [a, b, _] => [a, b],
        };
        let sides = self.star(vertex).iter().map(others);
        ring.clear();
        // A neighbour across an inner edge comes first in one face and last in another.
        ring.extend(sides.clone().map(|[first, _]| first));
        if self.on_boundary[vertex as usize] {
            ring.extend(sides.map(|[_, last]| last));
        }
        ring.sort_unstable();
        ring.dedup();
    }

    /// Where each vertex goes: at most so many to a neighbour, no two of which share a face with another.
    fn collapses(&self, is_kept: &[bool], at_most: usize) -> Vec<u32> {
        let vertices = 0..self.positions.len() as u32;
        let is_free = |&v: &u32| !is_kept[v as usize] && !self.star(v).is_empty();
        let free: Vec<u32> = vertices.clone().filter(is_free).collect();
        let best_of = |some: &[u32]| -> Vec<(f64, u32, u32)> {
            let mut rings = Rings::default();
            some.iter().filter_map(|&v| self.best(v, &mut rings)).collect()
        };
        let mut best: Vec<(f64, u32, u32)> =
            free.par_chunks(CHUNK).flat_map_iter(best_of).collect();
        best.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        best.truncate(best.len().div_ceil(SHARE));
        let mut target: Vec<u32> = vertices.collect();
        let mut is_changed = vec![false; self.faces.len()];
        let mut left = at_most;
        for (_, from, to) in best {
            let mut touched = self.star(from).iter().chain(self.star(to));
            if left == 0 || touched.any(|&face| is_changed[face as usize]) {
                continue;
            }
            self.star(from).iter().for_each(|&face| is_changed[face as usize] = true);
            target[from as usize] = to;
            left -= 1;
        }
        target
    }

    /// The cheapest collapse of a vertex into a neighbour that may be done.
    fn best(&self, from: u32, rings: &mut Rings) -> Option<(f64, u32, u32)> {
        let Rings { ring, other, costs } = rings;
        self.ring(from, ring);
        costs.clear();
        costs.extend(ring.iter().map(|&to| (self.cost(from, to), to)));
        costs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let found = costs.iter().find(|&&(_, to)| {
            self.ring(to, other);
            self.may_collapse(from, to, ring, other)
        });
        found.map(|&(cost, to)| (cost, from, to))
    }

    fn cost(&self, from: u32, to: u32) -> f64 {
        let [p, q] = [from, to].map(|v| self.positions[v as usize]);
        let mut quadric = self.quadrics[from as usize];
        quadric.add(&self.quadrics[to as usize]);
        let edge = sub(q, p);
        quadric.at(q).max(0.0) + LENGTH * dot(edge, edge).powi(2)
    }

    /// Whether a collapse leaves a manifold of the same topology, and turns no face much.
    fn may_collapse(&self, from: u32, to: u32, ring: &[u32], other: &[u32]) -> bool {
        let is_boundary = self.on_boundary[from as usize];
        let is_in = |v: &u32, ring: &[u32]| ring.binary_search(v).is_ok();
        let is_common = |v: &u32| is_in(v, ring) && is_in(v, other);
        let has_to = |&&face: &&u32| self.face(face).contains(&to);
        let n_shared = self.star(from).iter().filter(has_to).count();
        let n_common = ring.iter().filter(|v| is_in(v, other)).count();
        if n_shared != if is_boundary { 1 } else { 2 } || n_common != n_shared {
            return false;
        }
        let mut moved = self
            .star(from)
            .iter()
            .map(|&face| self.face(face))
            .filter(|face| !face.contains(&to))
            .peekable();
        moved.peek().is_some()
            && moved.all(|face| {
                let is_new = face.iter().filter(|v| is_common(v)).count() < 2;
                is_new && self.may_become(face, face.map(|v| if v == from { to } else { v }))
            })
    }

    fn may_become(&self, before: [u32; 3], after: [u32; 3]) -> bool {
        let normal_and_shape = |face: [u32; 3]| {
            let [a, b, c] = face.map(|v| self.positions[v as usize]);
            let edges = [sub(b, a), sub(c, b), sub(a, c)];
            let normal = cross(edges[0], edges[1]);
            let longest = edges.map(|edge| dot(edge, edge)).into_iter().fold(0.0, f64::max);
            (normal, norm(normal) / longest)
        };
        let ((old, old_shape), (new, new_shape)) =
            (normal_and_shape(before), normal_and_shape(after));
        dot(old, new) > LEAST_COSINE * norm(old) * norm(new)
            && new_shape >= LEAST_SHAPE.min(old_shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriMesh;
    use std::f64::consts::TAU;

    /// A grid of squares, each cut in two; closed both ways, it is a torus.
    fn grid(
        n: u32,
        is_closed: bool,
        at: impl Fn(f64, f64) -> Point,
    ) -> (Vec<Point>, Vec<[u32; 3]>) {
        let m = if is_closed { n } else { n + 1 };
        let share = |k: u32| f64::from(k) / f64::from(n);
        let positions = (0..m * m).map(|k| at(share(k % m), share(k / m))).collect();
        let id = |i: u32, j: u32| j % m * m + i % m;
        let square = |k: u32| {
            let (i, j) = (k % n, k / n);
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        (positions, (0..n * n).flat_map(square).collect())
    }

    fn mesh(coarse: &Coarsening) -> TriMesh {
        TriMesh::from_faces(coarse.vertices.len(), &coarse.faces).unwrap()
    }

    #[test]
    fn a_torus_stays_one_and_keeps_its_shape() {
        let (positions, faces) = grid(40, true, |s, t| {
            let (a, b) = (TAU * s, TAU * t);
            let r = 2.0 + 0.7 * b.cos();
            [r * a.cos(), r * a.sin(), 0.7 * b.sin()]
        });
        let kept = [3, 4, 700];
        let coarse = coarsen(&positions, &faces, 400, &kept);
        assert!((390..=400).contains(&coarse.faces.len()), "{}", coarse.faces.len());
        let mesh = mesh(&coarse);
        assert!(mesh.genus() == 1 && !mesh.has_boundary());
        assert!(kept.iter().all(|v| coarse.vertices.contains(v)));
        // The volume of a torus of these radii is 2 pi^2 R r^2.
        let volume: f64 = coarse
            .faces
            .iter()
            .map(|face| {
                let [a, b, c] = face.map(|k| positions[coarse.vertices[k as usize] as usize]);
                dot(a, cross(b, c)) / 6.0
            })
            .sum();
        let exact = TAU * TAU / 2.0 * 2.0 * 0.49;
        assert!((volume / exact - 1.0).abs() < 0.08, "{volume} of {exact}");
        // Twice the same.
        assert_eq!(coarsen(&positions, &faces, 400, &kept), coarse);
    }

    #[test]
    fn a_square_keeps_its_corners_and_its_rim() {
        let (positions, faces) = grid(20, false, |s, t| [s, t, 0.0]);
        let coarse = coarsen(&positions, &faces, 60, &[]);
        assert!(coarse.faces.len() <= 60);
        assert!([0, 20, 420, 440].iter().all(|corner| coarse.vertices.contains(corner)));
        let area: f64 = coarse
            .faces
            .iter()
            .map(|face| {
                let [a, b, c] = face.map(|k| positions[coarse.vertices[k as usize] as usize]);
                cross(sub(b, a), sub(c, a))[2] / 2.0
            })
            .sum();
        assert!((area - 1.0).abs() < 1e-12);
        assert_eq!(mesh(&coarse).n_boundary_loops(), 1);
        // A face is one of those before, with other corners.
        assert!(coarse.face_origin.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn what_cannot_be_coarser_stays() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert_eq!(coarsen(&positions, &faces, 1, &[]).faces, faces);
        assert_eq!(coarsen(&positions, &faces[..1], 0, &[]).faces, faces[..1]);
    }
}
