//! Results that are good by construction: squares of surfaces of cubes, each laid out as a square of the plane.
#![allow(clippy::unwrap_used, dead_code, unreachable_pub, reason = "helpers of tests")]

pub mod mutations;

use seamstress_certify::{Map, Quads, Tolerance, Violation, Violations, compare_source};
use seamstress_testkit::Rng;
use seamstress_testkit::{IntegerMap, disjoint_union, squares};
use seamstress_testkit::{cube, double_torus, l_bracket, random_voxels, slab_with_holes};
use std::collections::BTreeSet;

/// A result, of which every part may be spoiled.
#[derive(Debug, Clone)]
pub struct Case {
    pub source: (Vec<[f64; 3]>, Vec<[u32; 3]>),
    pub positions: Vec<[f64; 3]>,
    pub faces: Vec<[u32; 3]>,
    pub uvs: Vec<[f64; 2]>,
    /// Edges on isolines.
    pub aligned: Vec<[u32; 2]>,
    pub quads: Vec<[u32; 4]>,
    /// A face of `quad_surface` at each vertex of the quads.
    pub sources: Vec<u32>,
    /// The halves of the quads.
    pub quad_surface: Vec<[u32; 3]>,
    pub cones: Vec<i32>,
    pub area: f64,
}

impl Case {
    /// Squares of side two, so that their middles are grid points; every face in a chart of its own.
    pub fn new(map: &IntegerMap, seed: u64) -> Self {
        let coarse = map;
        let map = squares_of(coarse, 2.0).subdivided().with_random_charts(9, seed);
        let IntegerMap { soup, corner_uvs: uvs } = map;
        let halves = coarse.soup.faces.clone();
        let quads = halves.chunks(2).map(|q| [q[0][0], q[0][1], q[0][2], q[1][2]]).collect();
        let n = coarse.soup.positions.len() as u32;
        let face_at = |v| halves.iter().position(|face| face.contains(&v)).unwrap() as u32;
        let on_axis = |(k, _): &(usize, &u32)| {
            let (from, to) = (uvs[*k], uvs[next(*k)]);
            from[0] == to[0] || from[1] == to[1]
        };
        let corners = soup.faces.as_flattened();
        let edge = |(k, &from): (usize, &u32)| {
            let to = corners[next(k)];
            [from.min(to), from.max(to)]
        };
        let aligned: BTreeSet<_> = corners.iter().enumerate().filter(on_axis).map(edge).collect();
        let quads: Vec<[u32; 4]> = quads;
        Self {
            source: (soup.positions.clone(), soup.faces.clone()),
            cones: indices(n, &quads),
            area: quads.len() as f64,
            sources: (0..n).map(face_at).collect(),
            quad_surface: halves,
            aligned: aligned.into_iter().collect(),
            positions: soup.positions,
            faces: soup.faces,
            uvs,
            quads,
        }
    }

    pub fn map(&self) -> Result<Map<'_>, Violations> {
        Map::new(self.positions.len(), &self.faces, &self.uvs)
    }

    /// All that is wrong with it: with later checks only where earlier ones find nothing, as those who call them do.
    pub fn violations(&self) -> Vec<Violation> {
        let found =
            compare_source((&self.source.0, &self.source.1), (&self.positions, &self.faces));
        if !found.is_empty() {
            return found;
        }
        match self.of_map().and_then(|()| self.of_quads()) {
            Ok(()) => Vec::new(),
            Err(Violations(found)) => found,
        }
    }

    fn of_map(&self) -> Result<(), Violations> {
        let map = self.map()?;
        map.seamless(&Tolerance::default())?;
        let aligned = map.alignment(&self.aligned, &Tolerance::default()).err();
        let integral = map.integers(&self.aligned, &Tolerance::default()).err();
        let found: Vec<_> = aligned.into_iter().chain(integral).flat_map(|v| v.0).collect();
        if found.is_empty() { Ok(()) } else { Err(Violations(found)) }
    }

    fn of_quads(&self) -> Result<(), Violations> {
        let quads = Quads {
            quads: &self.quads,
            sources: &self.sources,
            n_vertices: self.positions.len(),
            faces: &self.quad_surface,
            is_trimmed: false,
        };
        quads.check()?;
        quads.agree_with(&self.cones, self.area)
    }

    /// The corners of the map at each vertex.
    pub fn corners_at(&self, vertex: u32) -> Vec<usize> {
        let corners = self.faces.as_flattened().iter().enumerate();
        corners.filter(|(_, v)| **v == vertex).map(|(k, _)| k).collect()
    }

    /// The corner counter-clockwise next to one of a vertex off the boundary.
    pub fn next_around(&self, corner: usize) -> usize {
        let vertices = self.faces.as_flattened();
        let across = vertices[prev(corner)];
        let is_next = |k: &usize| vertices[*k] == vertices[corner] && vertices[next(*k)] == across;
        (0..vertices.len()).find(is_next).unwrap()
    }

    /// Moves the UVs at a vertex without a cone off the boundary, by a step in the chart of its first face.
    pub fn move_vertex(&mut self, vertex: u32, step: [f64; 2]) {
        let before = self.uvs.clone();
        let arrow = |from: usize, to: usize| [0, 1].map(|i| before[to][i] - before[from][i]);
        let (mut corner, mut step) = (self.corners_at(vertex)[0], step);
        for _ in self.corners_at(vertex) {
            self.uvs[corner] = [0, 1].map(|i| before[corner][i] + step[i]);
            let left = arrow(corner, prev(corner));
            corner = self.next_around(corner);
            let right = arrow(corner, next(corner));
            let quarters = (0..4).find(|&quarters| turned(left, quarters) == right).unwrap();
            step = turned(step, quarters);
        }
    }

    /// A vertex off the boundary with a full turn of angle.
    pub fn ordinary_vertex(&self, rng: &mut Rng) -> u32 {
        let is_ordinary = |v: u32| {
            let faces = self.faces.iter().filter(|face| face.contains(&v));
            let around: Vec<u32> = faces.flatten().copied().filter(|&w| w != v).collect();
            let count = |w: &u32| around.iter().filter(|other| *other == w).count();
            around.iter().all(|w| count(w) == 2)
                && (self.angle_at(v) - std::f64::consts::TAU).abs() < 1e-6
        };
        loop {
            let vertex = rng.below(self.positions.len()) as u32;
            if is_ordinary(vertex) {
                return vertex;
            }
        }
    }

    pub fn angle_at(&self, vertex: u32) -> f64 {
        let angle = |k: usize| {
            let [at, next, prev] = [0, 1, 2].map(|j| self.uvs[k - k % 3 + (k + j) % 3]);
            let [p, q] = [next, prev].map(|end| [end[0] - at[0], end[1] - at[1]]);
            (p[0] * q[1] - p[1] * q[0]).atan2(p[0] * q[0] + p[1] * q[1])
        };
        self.corners_at(vertex).into_iter().map(angle).sum()
    }
}

pub fn next(corner: usize) -> usize {
    corner - corner % 3 + (corner + 1) % 3
}

fn prev(corner: usize) -> usize {
    next(next(corner))
}

pub fn turned([x, y]: [f64; 2], quarters: usize) -> [f64; 2] {
    [[x, y], [-y, x], [-x, -y], [y, -x]][quarters % 4]
}

fn squares_of(map: &IntegerMap, side: f64) -> IntegerMap {
    let mut map = map.clone();
    map.corner_uvs.iter_mut().flatten().for_each(|x| *x *= side);
    map
}

/// The indices of interior vertices other than 0, by counting.
fn indices(n_vertices: u32, quads: &[[u32; 4]]) -> Vec<i32> {
    let sides = |q: &[u32; 4]| [0, 1, 2, 3].map(|k| [q[k], q[(k + 1) % 4]]);
    let all: BTreeSet<[u32; 2]> = quads.iter().flat_map(sides).collect();
    let is_open = |v: u32| all.iter().any(|&[a, b]| (a == v || b == v) && !all.contains(&[b, a]));
    let index = |v: u32| 4 - quads.iter().filter(|quad| quad.contains(&v)).count() as i32;
    (0..n_vertices).filter(|&v| !is_open(v)).map(index).filter(|&index| index != 0).collect()
}

/// Without the two halves of a quad.
fn opened(map: &IntegerMap, quad: usize) -> IntegerMap {
    let mut map = map.clone();
    map.soup.faces.drain(2 * quad..2 * quad + 2);
    map.corner_uvs.drain(6 * quad..6 * quad + 6);
    map
}

/// Ten good results: closed and open, of genus 0 to 3, in one piece and in two.
pub fn ten() -> Vec<Case> {
    let two = disjoint_union(&[cube(), slab_with_holes(1)]);
    let maps = [
        squares(&cube(), 1),
        squares(&l_bracket(), 1),
        squares(&double_torus(), 1),
        squares(&slab_with_holes(1), 1),
        squares(&slab_with_holes(3), 1),
        squares(&random_voxels(9, 1), 1),
        squares(&random_voxels(14, 2), 1),
        opened(&squares(&l_bracket(), 1), 3),
        opened(&squares(&slab_with_holes(2), 1), 5),
        squares(&two, 1),
    ];
    maps.iter().zip(0..).map(|(map, seed)| Case::new(map, seed)).collect()
}

/// The name of what a violation is.
pub fn kind(violation: &Violation) -> String {
    let text = format!("{violation:?}");
    text.split([' ', '{']).next().unwrap().into()
}
