//! How open a point of the surface lies to the sky all around: hollows get less light.
//!
//! The surface is seen from far away along many axes. A point is open towards a direction if
//! nothing lies beyond it on the map of depths of that direction.

use seamstress_parallel::prelude::*;

use crate::interpolate::blend;
use crate::raster::{ScreenPoint, Window};
use crate::vec3::{Vec3, add, area_normal, cross, dot, scale, unit};

/// Axes of view; each serves two directions.
const AXES: usize = 16;
/// Side of a map, in texels.
const SIDE: usize = 256;
/// Points are lifted off the surface by this many texels, lest it hides itself.
const LIFT: f64 = 1.2;
/// Depths, in texels, over which light fades to shade.
const SOFTNESS: f64 = 2.5;
/// What hides a direction from afar, in units of the surface's size, counts for less.
const NEAR: f64 = 0.25;
/// The least it counts for.
const FAR_WEIGHT: f64 = 0.4;

#[derive(Debug)]
struct Occlusion {
    maps: Vec<Map>,
    texel: f64,
}

/// The least and the greatest depth of the surface along an axis.
#[derive(Debug)]
struct Map {
    right: Vec3,
    up: Vec3,
    axis: Vec3,
    depths: Vec<[f32; 2]>,
}

impl Occlusion {
    fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let used = faces.iter().flatten().map(|&v| positions[v as usize]);
        let radius = used.map(|p| dot(p, p)).fold(0.0, f64::max).sqrt();
        let texel = 2.0 * radius * (1.0 + 1e-6) / SIDE as f64;
        let maps =
            (0..AXES).into_par_iter().map(|k| Map::new(axis(k), positions, faces, texel)).collect();
        Self { maps, texel }
    }

    /// How much a direction is hidden by a surface that reaches so far beyond a point.
    fn shade(&self, beyond: f64) -> f64 {
        let distance = beyond / NEAR;
        let weight = FAR_WEIGHT + (1.0 - FAR_WEIGHT) / (1.0 + distance * distance);
        weight * (beyond / (SOFTNESS * self.texel)).min(1.0)
    }

    /// The part of the half-space over a point, weighted by the cosine, that is open.
    fn openness(&self, at: Vec3, normal: Vec3) -> f64 {
        let lifted = add(at, scale(normal, LIFT * self.texel));
        let (mut open, mut all) = (0.0, 0.0);
        for map in &self.maps {
            let cosine = dot(normal, map.axis);
            let beyond = map.beyond(lifted, cosine.signum(), self.texel);
            open += cosine.abs() * (1.0 - self.shade(beyond));
            all += cosine.abs();
        }
        if all > 0.0 { open / all } else { 1.0 }
    }
}

/// How open the surface lies at the nodes of a grid on each face. It changes slowly, so values in between are blended.
#[derive(Debug)]
pub(crate) struct Openness {
    /// The place of the first value of each face, and the parts into which its sides are cut.
    grids: Vec<(usize, u32)>,
    values: Vec<f32>,
}

/// Sides of a face as large as an equilateral one are cut into parts of about this length, in units of the surface's
/// size.
const SPACING: f64 = 0.02;
/// More nodes than about this are too many, however large the area of a surface that goes through itself.
const MOST_NODES: f64 = 1e6;
/// Faces that are prepared together.
const BLOCK: usize = 1024;

impl Openness {
    /// For faces whose unit normals at the corners are turned to the viewer.
    pub(crate) fn new(positions: &[Vec3], faces: &[[u32; 3]], normals: &[[[f32; 3]; 3]]) -> Self {
        let occlusion = Occlusion::new(positions, faces);
        let corners = |face: usize| faces[face].map(|v| positions[v as usize]);
        let areas = (0..faces.len()).map(|face| {
            let normal = area_normal(corners(face));
            dot(normal, normal).sqrt()
        });
        let spacing = SPACING.max((areas.clone().sum::<f64>() / (2.0 * MOST_NODES)).sqrt());
        let mut first = 0;
        let mut grids = Vec::with_capacity(faces.len());
        for area in areas {
            let parts = (area.sqrt() / spacing).round() as u32;
            grids.push((first, parts));
            first += nodes(parts).count();
        }
        let on_face = |face: usize| {
            let normals = normals[face].map(|n| n.map(f64::from));
            let (corners, occlusion) = (corners(face), &occlusion);
            nodes(grids[face].1).map(move |weights| {
                let normal = unit(blend(weights, &normals)).unwrap_or(normals[0]);
                occlusion.openness(blend(weights, &corners), normal) as f32
            })
        };
        let blocks: Vec<Vec<f32>> = (0..faces.len().div_ceil(BLOCK))
            .into_par_iter()
            .map(|k| (k * BLOCK..faces.len().min((k + 1) * BLOCK)).flat_map(on_face).collect())
            .collect();
        Self { values: blocks.concat(), grids }
    }

    /// The value at a point of a face with the given weights.
    pub(crate) fn at(&self, face: usize, [_, second, third]: [f64; 3]) -> f64 {
        let (first, parts) = self.grids[face];
        let Some(last) = parts.checked_sub(1) else { return f64::from(self.values[first]) };
        let (x, y) = (second * f64::from(parts), third * f64::from(parts));
        let i = (x as u32).min(last);
        let j = (y as u32).min(last - i);
        let value = |i: u32, j: u32| {
            // Rows before `i` have `parts + 1`, `parts`, ... nodes.
            let node = i * (parts + 1) - i * i.saturating_sub(1) / 2 + j;
            f64::from(self.values[first + node as usize])
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

/// The weights of the nodes of a triangle with sides cut into parts, row by row; its centre if there is no part.
fn nodes(parts: u32) -> impl Iterator<Item = [f64; 3]> {
    let step = 1.0 / f64::from(parts.max(1));
    (0..=parts).flat_map(move |i| {
        (0..=parts - i).map(move |j| match parts {
            0 => [1.0 / 3.0; 3],
            _ => [f64::from(parts - i - j) * step, f64::from(i) * step, f64::from(j) * step],
        })
    })
}

/// Axes spread evenly over half a sphere, along a spiral.
fn axis(k: usize) -> Vec3 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let height = 1.0 - (k as f64 + 0.5) / AXES as f64;
    let (sin, cos) = (golden * k as f64).sin_cos();
    let level = (1.0 - height * height).sqrt();
    [level * cos, height, level * sin]
}

impl Map {
    fn new(axis: Vec3, positions: &[Vec3], faces: &[[u32; 3]], texel: f64) -> Self {
        let aside = if axis[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 0.0, 1.0] };
        let right = unit(cross(aside, axis)).unwrap_or(aside);
        let mut map = Self {
            right,
            up: cross(axis, right),
            axis,
            depths: vec![[f32::INFINITY, f32::NEG_INFINITY]; SIDE * SIDE],
        };
        let points: Vec<ScreenPoint> = positions.iter().map(|&p| map.project(p, texel)).collect();
        let window = Window { width: SIDE, first_row: 0, rows: SIDE };
        for face in faces {
            window.scan(face.map(|v| points[v as usize]), |at, depth| {
                let [low, high] = &mut map.depths[at];
                *low = low.min(depth);
                *high = high.max(depth);
            });
        }
        map
    }

    fn project(&self, p: Vec3, texel: f64) -> ScreenPoint {
        ScreenPoint {
            x: 0.5 * SIDE as f64 + dot(self.right, p) / texel,
            y: 0.5 * SIDE as f64 + dot(self.up, p) / texel,
            depth: dot(self.axis, p),
            inverse_w: 1.0,
        }
    }

    /// How far the surface reaches beyond a point, along the axis or against it.
    fn beyond(&self, p: Vec3, sign: f64, texel: f64) -> f64 {
        let seen = self.project(p, texel);
        let inside = |t: f64| (0.0..SIDE as f64).contains(&t);
        if !(inside(seen.x) && inside(seen.y)) {
            return 0.0;
        }
        let [low, high] = self.depths[seen.y as usize * SIDE + seen.x as usize];
        let farthest = if sign > 0.0 { high } else { -low };
        (f64::from(farthest) - sign * seen.depth).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let up = [[0.0, 1.0, 0.0]; 3];
        let openness = Openness::new(&positions, &[[0, 1, 2], [3, 4, 5]], &[up, up]);
        let parts = openness.grids[0].1;
        assert!(parts > 50, "{parts}");
        for (k, weights) in nodes(parts).enumerate() {
            let value = f64::from(openness.values[k]);
            assert!((openness.at(0, weights) - value).abs() < 1e-6, "node {k}");
        }
        assert!(openness.at(0, [0.7, 0.15, 0.15]) < 0.2);
        assert!(openness.at(0, [0.2, 0.1, 0.7]) > 0.8);
        let between = [0.4, 0.3, 0.3];
        let around = [[0.41, 0.29, 0.3], [0.39, 0.3, 0.31]].map(|w| openness.at(0, w));
        assert!((openness.at(0, between) - 0.5 * (around[0] + around[1])).abs() < 0.1);
    }
}
