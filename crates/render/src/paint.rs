//! Where the colour of a surface comes from.

use crate::RenderError;
use crate::checker::{Pattern, in_checks};
use crate::image::to_linear;
use crate::interpolate::{Weights, blend};
use crate::normalize::Normalizer;
use crate::palette::hex;
use crate::scene::{Scene, check_finite};
use crate::vec3::{Vec3, area_normal, dot, sub};

/// The colour of a surface before light falls on it; colours are sRGB in `0..=1`.
#[derive(Debug, Clone, PartialEq)]
pub enum Paint {
    /// One colour everywhere.
    Plain([f64; 3]),
    /// A checkerboard in the UVs, with thin lines between the checks.
    Checker {
        /// Side of a check, in units of the UVs. `None`: about forty checks would span the
        /// diagonal of the bounding box if the map stretched evenly.
        period: Option<f64>,
        /// The two colours of the checks.
        checks: [[f64; 3]; 2],
        /// The colour of the lines.
        line: [f64; 3],
        /// Width of the lines as a fraction of a check; zero for none.
        line_width: f64,
    },
    /// One colour for each face.
    PerFace(Vec<[f64; 3]>),
}

/// Checks along the diagonal of the bounding box, by default.
const CHECKS_PER_DIAGONAL: f64 = 40.0;

impl Paint {
    /// A quiet colour that lets light and lines speak.
    pub fn plain() -> Self {
        Self::Plain(hex(0xe8dfd1))
    }

    /// The checkerboard in its default colours and the given period.
    pub fn checker(period: Option<f64>) -> Self {
        Self::Checker {
            period,
            checks: [hex(0xf6f1e6), hex(0xc9_bf_a8)],
            line: hex(0x847864),
            line_width: 0.045,
        }
    }

    /// Readies the paint for a scene that has passed its check.
    pub(crate) fn prepare<'a>(
        &self,
        scene: &Scene<'a>,
        positions: &[Vec3],
    ) -> Result<Coat<'a>, RenderError> {
        match self {
            Self::Plain(color) => {
                check_finite("colour", &[*color])?;
                Ok(Coat::Plain(to_linear(*color)))
            }
            Self::PerFace(colors) => {
                if colors.len() != scene.faces.len() {
                    return Err(RenderError::WrongCount {
                        what: "colours of faces",
                        expected: scene.faces.len(),
                        found: colors.len(),
                    });
                }
                check_finite("the colour of face", colors)?;
                Ok(Coat::PerFace(colors.iter().map(|&c| to_linear(c)).collect()))
            }
            Self::Checker { period, checks, line, line_width } => {
                let uvs = scene.corner_uvs.ok_or(RenderError::MissingUvs)?;
                check_finite("colour", &[checks[0], checks[1], *line])?;
                if !(0.0..=1.0).contains(line_width) {
                    return Err(RenderError::BadOption {
                        name: "line_width",
                        requirement: "between 0 and 1",
                    });
                }
                let period = period.unwrap_or_else(|| even_period(uvs, scene.faces, positions));
                if !(period > 0.0 && period.is_finite()) {
                    return Err(RenderError::BadOption {
                        name: "period",
                        requirement: "positive and finite",
                    });
                }
                let pattern = Pattern {
                    checks: checks.map(to_linear),
                    line: to_linear(*line),
                    line_width: *line_width,
                };
                Ok(Coat::Checker { pattern, period, uvs })
            }
        }
    }
}

/// The period of the default number of checks, from the areas in the plane and in space.
fn even_period(uvs: &[[f64; 2]], faces: &[[u32; 3]], positions: &[Vec3]) -> f64 {
    let Some(plane) = Normalizer::fit(uvs.iter().copied()) else {
        return 1.0;
    };
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let (mut uv_area, mut area) = (0.0, 0.0);
    for (face, uv) in faces.iter().zip(uvs.chunks_exact(3)) {
        let corners = face.map(|v| positions[v as usize]);
        let normal = area_normal(corners);
        area += dot(normal, normal).sqrt();
        uv_area += signed_area([uv[0], uv[1], uv[2]].map(|p| plane.apply(p))).abs();
        for corner in corners {
            for k in 0..3 {
                low[k] = low[k].min(corner[k]);
                high[k] = high[k].max(corner[k]);
            }
        }
    }
    let diagonal = sub(high, low);
    let stretch = (uv_area / area).sqrt();
    let period = dot(diagonal, diagonal).sqrt() * stretch / CHECKS_PER_DIAGONAL;
    if period > 0.0 && period.is_finite() {
        plane.length_back(period)
    } else {
        plane.length_back(1.0 / CHECKS_PER_DIAGONAL)
    }
}

/// Twice the area of a triangle in the plane, positive if anticlockwise.
pub(crate) fn signed_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A paint ready for use, in linear light.
#[derive(Debug, Clone)]
pub(crate) enum Coat<'a> {
    Plain([f32; 3]),
    Checker { pattern: Pattern, period: f64, uvs: &'a [[f64; 2]] },
    PerFace(Vec<[f32; 3]>),
}

/// The paint of one face.
#[derive(Debug, Clone, Copy)]
pub(crate) enum FaceCoat<'a> {
    Plain([f32; 3]),
    Checker { pattern: &'a Pattern, checks: [[f64; 2]; 3] },
}

/// Textures that are apart by less than this, in checks, go on.
const SAME_CHECK: f64 = 1e-3;

impl Coat<'_> {
    /// Whether the paint goes on smoothly from one face to another where these corners of theirs meet.
    pub(crate) fn goes_on(&self, corners: [u32; 2]) -> bool {
        match self {
            Self::Plain(_) => true,
            Self::PerFace(colors) => {
                let [a, b] = corners.map(|corner| colors[corner as usize / 3]);
                a == b
            }
            Self::Checker { period, uvs, .. } => {
                let [a, b] = corners.map(|corner| uvs[corner as usize]);
                (0..2).all(|k| (a[k] - b[k]).abs() <= SAME_CHECK * period)
            }
        }
    }

    pub(crate) fn on_face(&self, face: usize) -> FaceCoat<'_> {
        match self {
            Self::Plain(color) => FaceCoat::Plain(*color),
            Self::PerFace(colors) => FaceCoat::Plain(colors[face]),
            Self::Checker { pattern, period, uvs } => FaceCoat::Checker {
                pattern,
                checks: in_checks(std::array::from_fn(|k| uvs[3 * face + k]), *period),
            },
        }
    }
}

impl FaceCoat<'_> {
    /// The mean colour over a square of the given side, in samples, around a point with the given weights.
    pub(crate) fn color(&self, weights: &Weights, side: f64) -> [f32; 3] {
        match self {
            Self::Plain(color) => *color,
            Self::Checker { pattern, checks } => {
                let at = blend(weights.value, checks);
                let by_x = blend(weights.by_x, checks);
                let by_y = blend(weights.by_y, checks);
                pattern.color(at, std::array::from_fn(|k| side * (by_x[k].abs() + by_y[k].abs())))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_period_puts_forty_checks_on_the_diagonal() {
        let positions = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
        let faces = [[0, 1, 2], [0, 2, 3]];
        for scale in [1e-200, 1.0, 1e200] {
            let uvs = faces
                .as_flattened()
                .iter()
                .map(|&v| [positions[v as usize][0] * scale, positions[v as usize][1] * scale])
                .collect::<Vec<_>>();
            let period = even_period(&uvs, &faces, &positions);
            assert!((period / scale - 5.0 / 40.0).abs() < 1e-12);
        }
    }
}
