//! Where the viewer stands, and where points fall on the picture.

use crate::RenderError;
use crate::raster::ScreenPoint;
use crate::vec3::{Vec3, add, area_normal, cross, dot, scale, sub, unit};

/// The side from which a surface is seen, once its axes are turned so that `y` points up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum View {
    /// Three-quarter view from the front: the positive `z` side, or the broad side of a mesh that
    /// is clearly elongated.
    #[default]
    Front,
    /// The same from behind.
    Back,
    /// From the side this vector points to, seen from the mesh.
    Direction([f64; 3]),
}

/// The axis of a mesh that points up in the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Up {
    /// `z` is level and points to the front.
    X,
    /// `z` is level and points to the front.
    #[default]
    Y,
    /// `y` is level and points to the back.
    Z,
}

impl Up {
    /// Turns space so that this axis becomes `y`.
    pub(crate) fn turn(self, [x, y, z]: Vec3) -> Vec3 {
        match self {
            Self::X => [-y, x, z],
            Self::Y => [x, y, z],
            Self::Z => [x, z, -y],
        }
    }
}

/// How depth foreshortens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// From an eye that sees the shorter side of the picture under this angle, in degrees.
    Perspective(f64),
    /// From infinitely far.
    Orthographic,
}

impl Default for Projection {
    /// A long lens: depth shows, proportions survive.
    fn default() -> Self {
        Self::Perspective(24.0)
    }
}

const UP: Vec3 = [0.0, 1.0, 0.0];
/// Turn of the three-quarter views away from the front, in degrees.
const AZIMUTH: f64 = 32.0;
/// Elevation of the eye over upright meshes and over flat ones, in degrees.
const ELEVATION: [f64; 2] = [16.0, 42.0];
/// A mesh is elongated if the horizontal variances differ by this factor.
const ELONGATED: f64 = 1.5;

impl View {
    /// The unit vector from the mesh to the viewer.
    fn direction(self, positions: &[Vec3], faces: &[[u32; 3]]) -> Result<Vec3, RenderError> {
        let behind = match self {
            Self::Front => 0.0,
            Self::Back => 180.0,
            Self::Direction(d) => {
                return unit(d).ok_or(RenderError::BadOption {
                    name: "view",
                    requirement: "a finite direction other than zero",
                });
            }
        };
        let spread = Spread::of(positions, faces);
        let azimuth = spread.front() + f64::to_radians(AZIMUTH + behind);
        let flatness = (1.0 - 2.0 * spread.height_ratio).clamp(0.0, 1.0);
        let elevation = (ELEVATION[0] + flatness * (ELEVATION[1] - ELEVATION[0])).to_radians();
        let level = elevation.cos();
        Ok([level * azimuth.sin(), elevation.sin(), level * azimuth.cos()])
    }
}

/// How the area of a surface spreads over the horizontal plane.
struct Spread {
    /// Covariances `xx`, `xz`, `zz`.
    covariance: [f64; 3],
    /// Height of the bounding box over its longest horizontal side.
    height_ratio: f64,
}

impl Spread {
    fn of(positions: &[Vec3], faces: &[[u32; 3]]) -> Self {
        let (mut area, mut mean, mut moments) = (0.0, [0.0; 2], [0.0; 3]);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for face in faces {
            let corners = face.map(|v| positions[v as usize]);
            let normal = area_normal(corners);
            let weight = dot(normal, normal).sqrt();
            let [x, _, z] = scale(add(add(corners[0], corners[1]), corners[2]), 1.0 / 3.0);
            area += weight;
            mean = [mean[0] + weight * x, mean[1] + weight * z];
            moments[0] += weight * x * x;
            moments[1] += weight * x * z;
            moments[2] += weight * z * z;
            for corner in corners {
                for k in 0..3 {
                    low[k] = low[k].min(corner[k]);
                    high[k] = high[k].max(corner[k]);
                }
            }
        }
        let area = if area > 0.0 { area } else { 1.0 };
        let [x, z] = mean.map(|m| m / area);
        let [xx, xz, zz] = moments.map(|m| m / area);
        let sides = sub(high, low);
        Self {
            covariance: [xx - x * x, xz - x * z, zz - z * z],
            height_ratio: sides[1] / sides[0].max(sides[2]).max(f64::MIN_POSITIVE),
        }
    }

    /// The direction of the broad side, as an angle from `z` towards `x` within a quarter turn.
    fn front(&self) -> f64 {
        let [xx, xz, zz] = self.covariance;
        let (mean, radius) = (0.5 * (xx + zz), (0.5 * (xx - zz)).hypot(xz));
        if mean + radius < ELONGATED * (mean - radius) {
            return 0.0;
        }
        // The long axis has the angle `along` from `x` towards `z`; the broad side faces across.
        let along = 0.5 * (2.0 * xz).atan2(xx - zz);
        -along
    }
}

/// A projection fitted to a mesh.
#[derive(Debug, Clone)]
pub(crate) struct Camera {
    pub(crate) right: Vec3,
    pub(crate) up: Vec3,
    /// From the mesh to the viewer.
    pub(crate) back: Vec3,
    /// The eye in the axes `right`, `up` and `-back`; without the last when orthographic.
    eye: [f64; 3],
    /// Samples per unit of length, at distance one if there is perspective.
    focal: f64,
    /// The distance whose depths are measured in units of length; `None` when orthographic.
    reference: Option<f64>,
    middle: [f64; 2],
}

impl Camera {
    /// Fits the whole mesh into `samples`, leaving `margin` of it free on each side.
    pub(crate) fn fit(
        view: View,
        projection: Projection,
        (positions, faces): (&[Vec3], &[[u32; 3]]),
        used: impl Iterator<Item = Vec3> + Clone,
        samples: [f64; 2],
        margin: f64,
    ) -> Result<Self, RenderError> {
        let back = view.direction(positions, faces)?;
        let right = unit(cross(UP, back))
            .filter(|_| cross(UP, back).iter().any(|x| x.abs() > 1e-9))
            .unwrap_or([1.0, 0.0, 0.0]);
        let up = cross(back, right);
        let mut camera = Self {
            right,
            up,
            back,
            eye: [0.0; 3],
            focal: 1.0,
            reference: None,
            middle: samples.map(|s| 0.5 * s),
        };
        let points = used.map(|p| camera.axes(p));
        let usable = samples.map(|s| 0.5 * s * (1.0 - 2.0 * margin));
        match projection {
            Projection::Orthographic => {
                let (low, high) = bounds(points);
                camera.focal = (0..2).fold(f64::INFINITY, |f, k| {
                    f.min(2.0 * usable[k] / (high[k] - low[k]).max(1e-6))
                });
                camera.eye = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.0];
            }
            Projection::Perspective(degrees) => {
                if !(1.0..=120.0).contains(&degrees) {
                    return Err(RenderError::BadOption {
                        name: "projection",
                        requirement: "an angle between 1 and 120 degrees",
                    });
                }
                let focal = 0.5 * samples[0].min(samples[1]) / (0.5 * degrees).to_radians().tan();
                let (eye, middle) = eye_seeing_all(points, usable.map(|u| u / focal));
                camera.focal = focal;
                camera.eye = eye;
                camera.reference = Some(middle - eye[2]);
            }
        }
        Ok(camera)
    }

    fn axes(&self, p: Vec3) -> [f64; 3] {
        [dot(self.right, p), dot(self.up, p), -dot(self.back, p)]
    }

    pub(crate) fn project(&self, p: Vec3) -> ScreenPoint {
        let [x, y, z] = sub(self.axes(p), self.eye);
        let (inverse_w, depth) = match self.reference {
            Some(reference) => (1.0 / z, reference * (reference / z - 1.0)),
            None => (1.0, -z),
        };
        ScreenPoint {
            x: self.middle[0] + self.focal * inverse_w * x,
            y: self.middle[1] - self.focal * inverse_w * y,
            depth,
            inverse_w,
        }
    }

    /// The depth by which a ball of the given radius in samples bulges towards the viewer.
    pub(crate) fn bulge(&self, at: ScreenPoint, radius: f64) -> f64 {
        let length = radius / (self.focal * at.inverse_w);
        let per_length = self.reference.map_or(1.0, |r| (r * at.inverse_w).powi(2));
        length * per_length
    }
}

fn bounds(points: impl Iterator<Item = [f64; 3]>) -> ([f64; 3], [f64; 3]) {
    let start = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    points.fold(start, |(mut low, mut high), p| {
        for k in 0..3 {
            low[k] = low[k].min(p[k]);
            high[k] = high[k].max(p[k]);
        }
        (low, high)
    })
}

/// The nearest eye from which all points lie within the given slopes of the axis of view, and the
/// middle of the depths of the points.
fn eye_seeing_all(
    points: impl Iterator<Item = [f64; 3]> + Clone,
    slopes: [f64; 2],
) -> ([f64; 3], f64) {
    let (low, high) = bounds(points.clone());
    // A point is within the slope `t` if `x - t z <= eye_x - t eye_z` and `-x - t z <= -eye_x - t eye_z`.
    let mut reach = [[f64::NEG_INFINITY; 2]; 2];
    for p in points {
        for k in 0..2 {
            reach[k][0] = reach[k][0].max(p[k] - slopes[k] * p[2]);
            reach[k][1] = reach[k][1].max(-p[k] - slopes[k] * p[2]);
        }
    }
    let clearance = 0.05 * (high[2] - low[2]) + 0.01;
    let distance = (0..2)
        .fold(low[2] - clearance, |z, k| z.min(-(reach[k][0] + reach[k][1]) / (2.0 * slopes[k])));
    let across = reach.map(|[a, b]| 0.5 * (a - b));
    ([across[0], across[1], distance], 0.5 * (low[2] + high[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: [Vec3; 4] =
        [[-1.0, -0.5, -0.3], [1.0, 0.5, 0.3], [-0.7, 0.5, -0.3], [1.0, -0.5, 0.3]];
    const FACES: [[u32; 3]; 2] = [[0, 1, 2], [0, 3, 1]];

    fn fit(
        view: View,
        projection: Projection,
        samples: [f64; 2],
        margin: f64,
    ) -> Result<Camera, RenderError> {
        Camera::fit(view, projection, (&BOX, &FACES), BOX.into_iter(), samples, margin)
    }

    #[test]
    fn every_view_fills_the_frame_and_no_more() {
        for projection in [Projection::default(), Projection::Orthographic] {
            for view in [
                View::Front,
                View::Back,
                View::Direction([0.0, 1.0, 0.0]),
                View::Direction([0.0, -1e-200, 0.0]),
                View::Direction([1.0, 2.0, -3.0]),
            ] {
                let camera = fit(view, projection, [300.0, 200.0], 0.05).unwrap();
                let seen = BOX.map(|p| camera.project(p));
                let slack = [[15.0, 285.0], [10.0, 190.0]];
                let mut touches = 0;
                for p in seen {
                    for (x, [low, high]) in [p.x, p.y].into_iter().zip(slack) {
                        assert!(low - 1e-6 <= x && x <= high + 1e-6, "{view:?}: {p:?}");
                        touches += usize::from(x - low < 1e-6 || high - x < 1e-6);
                    }
                }
                assert!(touches >= 2, "{view:?} {projection:?} leaves room");
            }
        }
    }

    #[test]
    fn up_stays_up_and_near_is_near() {
        for projection in [Projection::default(), Projection::Orthographic] {
            let view = View::Direction([0.0, 0.0, 1.0]);
            let camera = fit(view, projection, [300.0, 200.0], 0.05).unwrap();
            let origin = camera.project([0.0; 3]);
            assert!(camera.project([0.0, 0.1, 0.0]).y < origin.y);
            assert!(camera.project([0.1, 0.0, 0.0]).x > origin.x);
            assert!(camera.project([0.0, 0.0, 0.1]).depth > origin.depth);
        }
    }

    #[test]
    fn elongated_meshes_show_their_broad_side() {
        // A wall that runs along z, and one along the diagonal.
        for (x, z, expected) in [(0.0, 1.0, 90.0), (1.0, 1.0, -45.0), (1.0, 0.0, 0.0)] {
            let wall = [[-x, -0.5, -z], [x, -0.5, z], [x, 0.5, z], [-x, 0.5, -z]];
            let front = Spread::of(&wall, &[[0, 1, 2], [0, 2, 3]]).front().to_degrees();
            let off = (front - expected).rem_euclid(180.0);
            assert!(off.min(180.0 - off) < 1e-6, "{front} is not {expected}");
        }
    }

    #[test]
    fn turns_bring_their_axis_up_and_keep_handedness() {
        for (up, axis) in
            [(Up::X, [1.0, 0.0, 0.0]), (Up::Y, [0.0, 1.0, 0.0]), (Up::Z, [0.0, 0.0, 1.0])]
        {
            assert_eq!(up.turn(axis), UP);
            let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|a| up.turn(a));
            assert_eq!(cross(x, y), z, "{up:?}");
        }
    }

    #[test]
    fn no_direction_is_an_error() {
        for bad in [[0.0; 3], [f64::NAN, 0.0, 1.0]] {
            let fit = fit(View::Direction(bad), Projection::Orthographic, [9.0, 9.0], 0.0);
            assert!(matches!(fit, Err(RenderError::BadOption { name: "view", .. })));
        }
    }
}
