//! Soft light on matt surfaces.

use crate::camera::Camera;
use crate::vec3::{Vec3, add, dot, scale, unit};

/// Two lights that go with the viewer, and a sky that stays above.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lights {
    key: Vec3,
    fill: Vec3,
    back: Vec3,
}

/// Strength of the key light, from the upper left behind the viewer.
const KEY: f64 = 0.80;
/// Strength of the fill light, from the right.
const FILL: f64 = 0.14;
/// Light from the sky and from the ground.
const SKY: f64 = 0.27;
const GROUND: f64 = 0.10;
/// How far the lights reach around the terminator, as a cosine.
const WRAP: f64 = 0.12;

impl Lights {
    pub(crate) fn new(camera: &Camera) -> Self {
        let towards = |right: f64, up: f64, back: f64| {
            let sum = add(scale(camera.right, right), scale(camera.up, up));
            unit(add(sum, scale(camera.back, back))).unwrap_or(camera.back)
        };
        Self { key: towards(-0.55, 0.65, 0.75), fill: towards(0.9, 0.1, 0.45), back: camera.back }
    }

    /// The light on a surface whose unit normal is turned to the viewer.
    pub(crate) fn on(&self, normal: Vec3) -> f32 {
        const SCALE: f64 = 1.0 / (1.0 + WRAP);
        let wrapped = |light: Vec3| ((dot(normal, light) + WRAP) * SCALE).max(0.0);
        let sky = 0.5 + 0.5 * normal[1];
        let ambient = GROUND + (SKY - GROUND) * sky;
        // Edges that turn away darken a little, which sets them off against white.
        let facing = dot(normal, self.back).clamp(0.0, 1.0);
        let rim = 0.72 + 0.28 * (1.0 - (1.0 - facing).powi(4));
        ((ambient + KEY * wrapped(self.key) + FILL * wrapped(self.fill)) * rim) as f32
    }

    /// The glint on a small polished ball.
    pub(crate) fn glint(&self, normal: Vec3) -> f32 {
        let half = unit(add(self.key, self.back)).unwrap_or(self.back);
        (0.35 * dot(normal, half).max(0.0).powi(48)) as f32
    }
}
