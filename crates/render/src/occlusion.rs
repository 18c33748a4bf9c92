//! How open a point of the surface lies to the sky all around: hollows get less light.
//!
//! The surface is seen from far away along many axes. A point is open towards a direction if
//! nothing lies beyond it on the map of depths of that direction.

use std::sync::atomic::{AtomicU32, Ordering};

use seamstress_parallel::prelude::*;

use crate::raster::{ScreenPoint, Window};
use crate::vec3::{Vec3, add, area_normal, cross, dot, scale, unit};

/// Axes of view; each serves two directions.
const AXES: usize = 16;
/// Side of a map, in texels.
const SIDE: usize = 256;
/// Points are lifted off the surface by this many texels, lest it hides itself.
const LIFT: f64 = 1.2;
/// Depths, in texels, over which light fades to shade.
const SOFTNESS: f32 = 2.5;
/// What hides a direction from afar, in units of the surface's size, counts for less.
const NEAR: f32 = 0.25;
/// The least it counts for.
const FAR_WEIGHT: f32 = 0.4;

/// The least and the greatest depths of the surface along the axes.
#[derive(Debug)]
struct Occlusion {
    maps: Vec<Vec<[f32; 2]>>,
    /// The directions of columns, of rows and of depth of all maps at once, coordinate by coordinate. A texel is one
    /// unit along the first two.
    frames: [[[f32; AXES]; 3]; 3],
    texel: f64,
}

/// Half the side of a map.
const HALF: f64 = 0.5 * SIDE as f64;

impl Occlusion {
    fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let used = faces.iter().flatten().map(|&v| positions[v as usize]);
        let radius = used.map(|p| dot(p, p)).fold(0.0, f64::max).sqrt();
        let texel = radius * (1.0 + 1e-6) / HALF;
        let frames: [[Vec3; 3]; AXES] = std::array::from_fn(|k| frame(axis(k), texel));
        let maps = frames.into_par_iter().map(|frame| depth_map(frame, positions, faces)).collect();
        let of = |direction: usize, coordinate: usize| {
            frames.map(|frame| frame[direction][coordinate] as f32)
        };
        let frames = std::array::from_fn(|d| std::array::from_fn(|c| of(d, c)));
        Self { maps, frames, texel }
    }

    /// How much a direction is hidden by a surface that reaches so far beyond a point.
    fn shade(&self, beyond: f32) -> f32 {
        let distance = beyond / NEAR;
        let weight = FAR_WEIGHT + (1.0 - FAR_WEIGHT) / (1.0 + distance * distance);
        weight * (beyond / (SOFTNESS * self.texel as f32)).min(1.0)
    }

    /// The part of the half-space over a point, weighted by the cosine, that is open.
    fn openness(&self, at: Vec3, normal: Vec3) -> f32 {
        let lifted = add(at, scale(normal, LIFT * self.texel));
        let [right, up, axis] = &self.frames;
        let [columns, rows] = [right, up].map(|direction| along(direction, lifted));
        let (depths, cosines) = (along(axis, lifted), along(axis, normal));
        let (mut open, mut all) = (0.0, 0.0);
        for (k, map) in self.maps.iter().enumerate() {
            let [x, y] = [columns[k], rows[k]].map(|t| t + HALF as f32);
            let cosine = cosines[k].abs();
            all += cosine;
            open += cosine;
            if !(x >= 0.0 && y >= 0.0 && x < SIDE as f32 && y < SIDE as f32) {
                continue;
            }
            // How far the surface reaches beyond the point.
            let [low, high] = map[y as u32 as usize * SIDE + x as u32 as usize];
            let beyond = if cosines[k] > 0.0 { high - depths[k] } else { depths[k] - low };
            if beyond > 0.0 {
                open -= cosine * self.shade(beyond);
            }
        }
        if all > 0.0 { open / all } else { 1.0 }
    }
}

/// A vector's coordinates along one direction of all maps.
fn along(direction: &[[f32; AXES]; 3], vector: Vec3) -> [f32; AXES] {
    let [x, y, z] = vector.map(|c| c as f32);
    std::array::from_fn(|k| direction[0][k] * x + direction[1][k] * y + direction[2][k] * z)
}

/// A surface with the nodes of a grid on each face. How open it lies changes slowly, so values in between are blended.
#[derive(Debug)]
pub(crate) struct Sky {
    occlusion: Occlusion,
    /// The place of the first node of each face, and the parts into which its sides are cut.
    grids: Vec<(usize, u32)>,
    nodes: usize,
}

/// How open a surface lies at its nodes, from one side of every face. A value is found when it is first asked for, as
/// most are of faces that nobody sees; threads that ask at once find the same.
#[derive(Debug)]
pub(crate) struct Openness<'a> {
    sky: &'a Sky,
    /// Bits of numbers, [`UNKNOWN`] at first.
    values: Vec<AtomicU32>,
}

/// The bits of no value that is found: of a NaN.
const UNKNOWN: u32 = u32::MAX;

/// Sides of a face as large as an equilateral one are cut into parts of about this length, in units of the surface's
/// size.
const SPACING: f64 = 0.02;
/// More nodes than about this are too many, however large the area of a surface that goes through itself.
const MOST_NODES: f64 = 1e6;
impl Sky {
    pub(crate) fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let areas = faces.iter().map(|face| {
            let normal = area_normal(face.map(|v| positions[v as usize]));
            dot(normal, normal).sqrt()
        });
        let spacing = SPACING.max((areas.clone().sum::<f64>() / (2.0 * MOST_NODES)).sqrt());
        let mut nodes = 0;
        let grid = |area: f64| {
            let parts = (area.sqrt() / spacing + 0.5) as u32;
            let first = nodes;
            nodes += (parts as usize + 1) * (parts as usize + 2) / 2;
            (first, parts)
        };
        Self {
            grids: areas.map(grid).collect(),
            occlusion: Occlusion::new(positions, faces),
            nodes,
        }
    }

    /// All of it yet to be looked at.
    pub(crate) fn openness(&self) -> Openness<'_> {
        Openness { sky: self, values: (0..self.nodes).map(|_| UNKNOWN.into()).collect() }
    }
}

impl Openness<'_> {
    /// The value at a point of a face with the given weights; `place` says of weights where that is, and the unit
    /// normal turned to the viewer.
    pub(crate) fn at(
        &self,
        face: usize,
        [_, second, third]: [f64; 3],
        place: impl Fn([f64; 3]) -> (Vec3, Vec3),
    ) -> f64 {
        let (first, parts) = self.sky.grids[face];
        let find = |node: usize, weights: [f64; 3]| {
            let value = &self.values[first + node];
            let known = value.load(Ordering::Relaxed);
            f64::from(if known == UNKNOWN {
                let (at, normal) = place(weights);
                let found = self.sky.occlusion.openness(at, normal);
                value.store(found.to_bits(), Ordering::Relaxed);
                found
            } else {
                f32::from_bits(known)
            })
        };
        let Some(last) = parts.checked_sub(1) else { return find(0, [1.0 / 3.0; 3]) };
        let (x, y) = (second * f64::from(parts), third * f64::from(parts));
        let i = (x as u32).min(last);
        let j = (y as u32).min(last - i);
        let step = 1.0 / f64::from(parts);
        let value = |i: u32, j: u32| {
            // Rows before `i` have `parts + 1`, `parts`, ... nodes.
            let node = i * (parts + 1) - i * i.saturating_sub(1) / 2 + j;
            find(node as usize, [parts - i - j, i, j].map(|k| f64::from(k) * step))
        };
        let (x, y) = (x - f64::from(i), y - f64::from(j));
        let (right, up) = (value(i + 1, j), value(i, j + 1));
        if x + y > 1.0 && i + j < last {
            let far = value(i + 1, j + 1);
            far + (1.0 - x) * (up - far) + (1.0 - y) * (right - far)
        } else {
            let near = value(i, j);
            near + x * (right - near) + y * (up - near)
        }
    }
}

/// Axes spread evenly over half a sphere, along a spiral.
fn axis(k: usize) -> Vec3 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let height = 1.0 - (k as f64 + 0.5) / AXES as f64;
    let (sin, cos) = (golden * k as f64).sin_cos();
    let level = (1.0 - height * height).sqrt();
    [level * cos, height, level * sin]
}

/// The directions of columns, rows and depth of the map along an axis.
fn frame(axis: Vec3, texel: f64) -> [Vec3; 3] {
    let aside = if axis[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let right = unit(cross(aside, axis)).unwrap_or(aside);
    [scale(right, 1.0 / texel), scale(cross(axis, right), 1.0 / texel), axis]
}

fn depth_map(
    [right, up, axis]: [Vec3; 3],
    positions: &[Vec3],
    faces: &[[u32; 3]],
) -> Vec<[f32; 2]> {
    let project = |&p: &Vec3| {
        let (x, y) = (HALF + dot(right, p), HALF + dot(up, p));
        ScreenPoint { x, y, depth: dot(axis, p), inverse_w: 1.0 }
    };
    let points: Vec<ScreenPoint> = positions.iter().map(project).collect();
    // Most faces of a fine surface lie between the centres of texels.
    let nearest = |p: &ScreenPoint| [p.x, p.y].map(|t| (t + 0.5) as u16);
    let nearest: Vec<[u16; 2]> = points.iter().map(nearest).collect();
    let window = Window { width: SIDE, first_row: 0, rows: SIDE };
    let mut map = vec![[f32::INFINITY, f32::NEG_INFINITY]; SIDE * SIDE];
    for face in faces {
        let [a, b, c] = face.map(|v| nearest[v as usize]);
        if (0..2).any(|k| a[k] == b[k] && b[k] == c[k]) {
            continue;
        }
        window.scan(face.map(|v| points[v as usize]), |row, columns, ramp| {
            let start = row * SIDE;
            let texels = &mut map[start + columns.start..start + columns.end];
            for (k, [low, high]) in (0..).zip(texels) {
                let depth = ramp.at(k);
                *low = if depth < *low { depth } else { *low };
                *high = if depth > *high { depth } else { *high };
            }
        });
    }
    map
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolate::blend;

    const UP: Vec3 = [0.0, 1.0, 0.0];

    #[test]
    fn a_roof_shades_the_ground_and_not_itself() {
        // A floor, and a roof of the same size close above it.
        let sheet = |y: f64| [[-1.0, y, -1.0], [-1.0, y, 1.0], [1.0, y, 1.0], [1.0, y, -1.0]];
        let positions = [sheet(-0.03), sheet(0.03)].concat();
        let faces = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
        let occlusion = Occlusion::new(&positions, &faces);
        assert!(occlusion.openness([0.0, -0.03, 0.0], [0.0, 1.0, 0.0]) < 0.2);
        assert!(occlusion.openness([0.0, 0.03, 0.0], [0.0, -1.0, 0.0]) < 0.2);
        assert!(occlusion.openness([0.0, 0.03, 0.0], [0.0, 1.0, 0.0]) > 0.99);
        assert!(occlusion.openness([0.0, -0.03, 0.0], [0.0, -1.0, 0.0]) > 0.99);
        let edge = occlusion.openness([0.99, -0.03, 0.0], [0.0, 1.0, 0.0]);
        assert!((0.3..0.7).contains(&edge), "{edge}");
    }

    #[test]
    fn values_between_nodes_are_blended() {
        // The roof covers half of a floor that is one face.
        let sheet = |y: f64, right: f64| [[-1.0, y, -1.0], [-1.0, y, 1.0], [right, y, -1.0]];
        let positions = [sheet(-0.03, 1.0), sheet(0.03, 0.0)].concat();
        let sky = Sky::new(&positions, &[[0, 1, 2], [3, 4, 5]]);
        let openness = sky.openness();
        let at = |weights| {
            openness.at(0, weights, |w| (blend(w, &[positions[0], positions[1], positions[2]]), UP))
        };
        let parts = sky.grids[0].1;
        assert!(parts > 50, "{parts}");
        for [i, j] in [[0, 0], [0, parts], [parts, 0], [3, 5], [20, 30]] {
            let weights = [parts - i - j, i, j].map(|k| f64::from(k) / f64::from(parts));
            let point = blend(weights, &[positions[0], positions[1], positions[2]]);
            let expected = f64::from(sky.occlusion.openness(point, UP));
            // Found, then remembered.
            for _ in 0..2 {
                assert!((at(weights) - expected).abs() < 1e-6, "node {i}, {j}");
            }
        }
        assert!(at([0.7, 0.15, 0.15]) < 0.2);
        assert!(at([0.2, 0.1, 0.7]) > 0.8);
        let between = [0.4, 0.3, 0.3];
        let around = [[0.41, 0.29, 0.3], [0.39, 0.3, 0.31]].map(at);
        assert!((at(between) - 0.5 * (around[0] + around[1])).abs() < 0.1);
    }
}
