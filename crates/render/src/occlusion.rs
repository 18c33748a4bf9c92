//! How open a point of the surface lies to the sky all around: hollows get less light.
//!
//! The surface is seen from far away along many axes. A point is open towards a direction if
//! nothing lies beyond it on the map of depths of that direction.

use seamstress_parallel::prelude::*;

use crate::raster::{ScreenPoint, Window};
use crate::vec3::{Vec3, add, cross, dot, scale, unit};

/// Axes of view; each serves two directions.
const AXES: usize = 16;
/// Side of a map, in texels.
const SIDE: usize = 360;
/// Points are lifted off the surface by this many texels, lest it hides itself.
const LIFT: f64 = 1.5;
/// Depths, in texels, over which light fades to shade.
const SOFTNESS: f64 = 3.0;
/// What hides a direction from afar, in units of the surface's size, counts for less.
const NEAR: f64 = 0.25;
/// The least it counts for.
const FAR_WEIGHT: f64 = 0.4;

#[derive(Debug)]
pub(crate) struct Occlusion {
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
    pub(crate) fn new(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
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
    ///
    /// Asks one in `turns` of the directions, beginning with `turn`: the mean over all turns asks
    /// them all.
    pub(crate) fn openness(&self, at: Vec3, normal: Vec3, turn: usize, turns: usize) -> f64 {
        let lifted = add(at, scale(normal, LIFT * self.texel));
        let (mut open, mut all) = (0.0, 0.0);
        let step = turns.clamp(1, MAX_TURNS);
        for direction in (turn % step..2 * AXES).step_by(step) {
            let (map, sign) = match self.maps.get(direction) {
                Some(map) => (map, 1.0),
                None => (&self.maps[2 * AXES - 1 - direction], -1.0),
            };
            let cosine = sign * dot(normal, map.axis);
            if cosine > 0.0 {
                let beyond = map.beyond(lifted, sign, self.texel);
                open += cosine * (1.0 - self.shade(beyond));
                all += cosine;
            }
        }
        if all > 0.0 { open / all } else { 1.0 }
    }
}

/// However many rows of samples a pixel has, each asks several directions.
const MAX_TURNS: usize = 3;

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
        let mean = |at, normal| {
            let turns = (0..9).map(|turn| occlusion.openness(at, normal, turn, 9));
            turns.sum::<f64>() / 9.0
        };
        assert!(mean([0.0, -0.03, 0.0], [0.0, 1.0, 0.0]) < 0.2);
        assert!(mean([0.0, 0.03, 0.0], [0.0, -1.0, 0.0]) < 0.2);
        assert!(mean([0.0, 0.03, 0.0], [0.0, 1.0, 0.0]) > 0.99);
        assert!(mean([0.0, -0.03, 0.0], [0.0, -1.0, 0.0]) > 0.99);
        let edge = mean([0.99, -0.03, 0.0], [0.0, 1.0, 0.0]);
        assert!((0.3..0.7).contains(&edge), "{edge}");
    }
}
