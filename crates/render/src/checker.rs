//! A checkerboard with grid lines, averaged exactly over the footprint of a sample.

/// A pattern of unit checks with lines on the integers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pattern {
    /// Colours of the checks in linear light; the first holds the check right above the origin.
    pub(crate) checks: [[f32; 3]; 2],
    pub(crate) line: [f32; 3],
    /// Width of a line, as a fraction of a check.
    pub(crate) line_width: f64,
}

/// Footprints narrower than this are sampled as if they had this width, in checks.
const NARROWEST: f64 = 1e-6;
/// Footprints wider than this see the mean, in checks.
const WIDEST: f64 = 64.0;

impl Pattern {
    /// The mean colour over the box of the given sides around `at`, in units of checks.
    pub(crate) fn color(&self, at: [f64; 2], sides: [f64; 2]) -> [f32; 3] {
        let (mut sign, mut bare) = (1.0, 1.0);
        for k in 0..2 {
            // A NaN width fails the comparison and sees the mean as well.
            if sides[k] < WIDEST && at[k].is_finite() {
                let half = 0.5 * sides[k].max(NARROWEST);
                let (low, high) = (at[k] - half, at[k] + half);
                let per_width = 1.0 / (high - low);
                sign *= (signs_up_to(high) - signs_up_to(low)) * per_width;
                bare *= 1.0
                    - (lines_up_to(high, self.line_width) - lines_up_to(low, self.line_width))
                        * per_width;
            } else {
                sign = 0.0;
                bare *= 1.0 - self.line_width;
            }
        }
        let (first, covered) = ((0.5 + 0.5 * sign) as f32, (1.0 - bare) as f32);
        std::array::from_fn(|c| {
            let check = self.checks[1][c] + first * (self.checks[0][c] - self.checks[1][c]);
            check + covered * (self.line[c] - check)
        })
    }
}

/// The integral from zero of the wave that is +1 on `[0, 1)` and -1 on `[1, 2)`.
fn signs_up_to(x: f64) -> f64 {
    1.0 - (x - 2.0 * whole(0.5 * x) - 1.0).abs()
}

/// The integral, up to a constant, of the indicator of lines of the given width on the integers.
fn lines_up_to(x: f64, width: f64) -> f64 {
    let shifted = x + 0.5 * width;
    let whole = whole(shifted);
    whole * width + (shifted - whole).min(width)
}

/// The greatest whole number up to `x`, for numbers that fit: a conversion, where rounding is a call without SSE 4.1.
fn whole(x: f64) -> f64 {
    let toward_zero = f64::from(x as i32);
    if toward_zero > x { toward_zero - 1.0 } else { toward_zero }
}

/// UVs of a face in units of checks, moved by whole periods to where numbers are fine.
pub(crate) fn in_checks(uvs: [[f64; 2]; 3], side: f64) -> [[f64; 2]; 3] {
    let mut checks = uvs.map(|uv| uv.map(|x| x / side));
    for k in 0..2 {
        let base = 2.0 * (0.5 * checks[0][k].min(checks[1][k]).min(checks[2][k])).floor();
        for corner in &mut checks {
            corner[k] -= base;
        }
    }
    checks
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATTERN: Pattern = Pattern {
        checks: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        line: [0.0, 0.0, 1.0],
        line_width: 0.1,
    };

    #[test]
    fn small_footprints_see_single_checks_and_lines() {
        let near = |at, expected: [f32; 3]| {
            let color = PATTERN.color(at, [1e-3; 2]);
            let off = (0..3).map(|c| (color[c] - expected[c]).abs());
            assert!(off.fold(0.0, f32::max) < 1e-5, "{color:?} at {at:?}");
        };
        near([0.5, 0.5], [1.0, 0.0, 0.0]);
        near([1.5, 0.5], [0.0, 1.0, 0.0]);
        near([-0.5, -0.5], [1.0, 0.0, 0.0]);
        near([3.0, 0.5], [0.0, 0.0, 1.0]);
        near([0.5, -0.04], [0.0, 0.0, 1.0]);
        near([0.06, 0.06], [1.0, 0.0, 0.0]);
    }

    #[test]
    fn the_box_average_is_exact() {
        let pattern = Pattern { line_width: 0.0, ..PATTERN };
        // A quarter of the box reaches over the border between two checks.
        let color = pattern.color([0.75, 0.5], [1.0, 0.25]);
        assert!((color[0] - 0.75).abs() < 1e-6);
        assert!((color[1] - 0.25).abs() < 1e-6);
    }

    #[test]
    fn wide_footprints_fade_to_the_mean() {
        for sides in [[200.0; 2], [f64::NAN; 2], [f64::INFINITY; 2]] {
            let color = PATTERN.color([0.3, 0.7], sides);
            assert!((color[0] - color[1]).abs() < 1e-6);
            assert!((color[2] - 0.19).abs() < 1e-6);
        }
        let near = PATTERN.color([0.3, 0.7], [63.3, 63.9]);
        assert!((near[0] - near[1]).abs() < 1e-3);
    }

    #[test]
    fn far_uvs_keep_their_phase() {
        let far = 2.0_f64.powi(40);
        let checks = in_checks([[far + 0.5, -far - 1.5], [far + 1.0, -far], [far, -far]], 0.5);
        assert_eq!(checks, [[1.0, 1.0], [2.0, 4.0], [0.0, 4.0]]);
    }
}
