//! Regions of the plane made of blocks, with or without a round hole, and solids over them.

use super::PolygonSoup;
use std::collections::{BTreeMap, BTreeSet};

/// Points closer than this are one.
const SAME: f64 = 1e-6;

/// Faces in the plane, counter-clockwise, that share their points.
#[derive(Default)]
pub(crate) struct Planar {
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) faces: Vec<Vec<u32>>,
    numbers: BTreeMap<[i64; 2], u32>,
}

impl Planar {
    pub(crate) fn face(&mut self, corners: &[[f64; 2]]) {
        let face = corners.iter().map(|&p| self.number(p)).collect();
        self.faces.push(face);
    }

    fn number(&mut self, point: [f64; 2]) -> u32 {
        let key = point.map(|x| (x / SAME).round() as i64);
        *self.numbers.entry(key).or_insert_with(|| {
            self.points.push(point);
            self.points.len() as u32 - 1
        })
    }

    /// Unit blocks of `k` by `k` squares each; `hole` gives the radius of the hole in the middle of a block.
    pub(crate) fn blocks(
        [columns, rows]: [u32; 2],
        k: u32,
        hole: impl Fn(u32, u32) -> Option<f64>,
    ) -> Self {
        let mut planar = Self::default();
        for x in 0..columns {
            for y in 0..rows {
                let corner = [f64::from(x), f64::from(y)];
                match hole(x, y) {
                    Some(radius) => planar.ring_block(corner, k, radius),
                    None => planar.square_block(corner, k),
                }
            }
        }
        planar
    }

    fn square_block(&mut self, [x, y]: [f64; 2], k: u32) {
        let at =
            |i: u32, j: u32| [x + f64::from(i) / f64::from(k), y + f64::from(j) / f64::from(k)];
        for i in 0..k {
            for j in 0..k {
                self.face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }

    /// Rings that lead from the sides of the block to a circle.
    fn ring_block(&mut self, [x, y]: [f64; 2], k: u32, radius: f64) {
        const RINGS: u32 = 2;
        let n = 4 * k;
        let on_square = |t: u32| {
            let along = f64::from(t % k) / f64::from(k) - 0.5;
            match t % n / k {
                0 => [along, -0.5],
                1 => [0.5, along],
                2 => [-along, 0.5],
                _ => [-0.5, -along],
            }
        };
        let at = |t: u32, ring: u32| {
            let angle = (f64::from(t % n) / f64::from(n) - 0.375) * std::f64::consts::TAU;
            let circle = [radius * angle.cos(), radius * angle.sin()];
            let (square, part) = (on_square(t), f64::from(ring) / f64::from(RINGS));
            let mix = |c: usize| square[c] + part * (circle[c] - square[c]);
            [x + 0.5 + mix(0), y + 0.5 + mix(1)]
        };
        for t in 0..n {
            for ring in 0..RINGS {
                self.face(&[at(t, ring), at(t + 1, ring), at(t + 1, ring + 1), at(t, ring + 1)]);
            }
        }
    }

    /// The surface over the region, each point moved to its place in space.
    pub(crate) fn lifted(&self, place: impl Fn([f64; 2]) -> [f64; 3]) -> PolygonSoup {
        let positions = self.points.iter().map(|&p| place(p)).collect();
        PolygonSoup { positions, polygons: self.faces.clone() }
    }

    /// The solid between the first and the last height, its walls divided at the others.
    pub(crate) fn extruded(&self, heights: &[f64]) -> PolygonSoup {
        let sides = |face: &[u32]| -> Vec<(u32, u32)> {
            (0..face.len()).map(|k| (face[k], face[(k + 1) % face.len()])).collect()
        };
        let all: BTreeSet<(u32, u32)> = self.faces.iter().flat_map(|face| sides(face)).collect();
        let rim: Vec<(u32, u32)> =
            all.iter().copied().filter(|&(a, b)| !all.contains(&(b, a))).collect();
        let mut solid = PolygonSoup::default();
        let mut numbers = BTreeMap::new();
        let last = heights.len() - 1;
        let mut number = |point: u32, level: usize, positions: &mut Vec<[f64; 3]>| {
            *numbers.entry((level, point)).or_insert_with(|| {
                let [x, y] = self.points[point as usize];
                positions.push([x, y, heights[level]]);
                positions.len() as u32 - 1
            })
        };
        for face in &self.faces {
            let positions = &mut solid.positions;
            let bottom = face.iter().rev().map(|&p| number(p, 0, positions)).collect();
            let top = face.iter().map(|&p| number(p, last, positions)).collect();
            solid.polygons.extend([bottom, top]);
        }
        for (a, b) in rim {
            for level in 0..last {
                let corners = [(a, level), (b, level), (b, level + 1), (a, level + 1)];
                let wall = corners.map(|(p, level)| number(p, level, &mut solid.positions));
                solid.polygons.push(wall.to_vec());
            }
        }
        solid
    }
}
