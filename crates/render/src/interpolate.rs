//! Values at the corners of a projected triangle, carried to its samples.

use crate::raster::ScreenPoint;

/// Barycentric coordinates over a triangle on the screen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Barycentric {
    origin: [f64; 2],
    /// Derivatives of the three screen-linear coordinates by `x` and by `y`.
    gradient: [[f64; 2]; 3],
    inverse_w: [f64; 3],
}

/// Perspective-correct weights of the corners at a sample, and how they change per sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    pub(crate) value: [f64; 3],
    pub(crate) by_x: [f64; 3],
    pub(crate) by_y: [f64; 3],
}

impl Barycentric {
    /// `None` for a triangle without area on the screen.
    pub(crate) fn new([a, b, c]: [ScreenPoint; 3]) -> Option<Self> {
        let (bx, by, cx, cy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
        let inverse_area = 1.0 / (bx * cy - by * cx);
        if !inverse_area.is_finite() {
            return None;
        }
        let second = [cy * inverse_area, -cx * inverse_area];
        let third = [-by * inverse_area, bx * inverse_area];
        let first = [-second[0] - third[0], -second[1] - third[1]];
        Some(Self {
            origin: [a.x, a.y],
            gradient: [first, second, third],
            inverse_w: [a.inverse_w, b.inverse_w, c.inverse_w],
        })
    }

    /// How a screen-linear value with the given corners changes per sample.
    pub(crate) fn slope(&self, corners: [f64; 3]) -> [f64; 2] {
        std::array::from_fn(|k| (0..3).map(|i| self.gradient[i][k] * corners[i]).sum())
    }

    /// The heights of the triangle over its three edges, in samples.
    pub(crate) fn heights(&self) -> [f64; 3] {
        self.gradient.map(|[x, y]| 1.0 / (x * x + y * y).sqrt())
    }

    pub(crate) fn at(&self, x: f64, y: f64) -> Weights {
        let (dx, dy) = (x - self.origin[0], y - self.origin[1]);
        let g = &self.gradient;
        let second = (g[1][0] * dx + g[1][1] * dy).clamp(0.0, 1.0);
        let third = (g[2][0] * dx + g[2][1] * dy).clamp(0.0, 1.0 - second);
        let q = self.inverse_w;
        let flat = [(1.0 - second - third) * q[0], second * q[1], third * q[2]];
        let inverse_sum = 1.0 / (flat[0] + flat[1] + flat[2]);
        let value = flat.map(|f| f * inverse_sum);
        let derivative = |axis: usize| {
            let change: [f64; 3] = std::array::from_fn(|i| g[i][axis] * q[i]);
            let sum = change[0] + change[1] + change[2];
            std::array::from_fn(|i| (change[i] - value[i] * sum) * inverse_sum)
        };
        Weights { value, by_x: derivative(0), by_y: derivative(1) }
    }
}

/// The weighted sum of corner values.
pub(crate) fn blend<const N: usize>(weights: [f64; 3], corners: &[[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|k| {
        weights[0] * corners[0][k] + weights[1] * corners[1][k] + weights[2] * corners[2][k]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perspective_weights_and_their_derivatives_agree() {
        let point = |x, y, w: f64| ScreenPoint { x, y, depth: 0.0, inverse_w: 1.0 / w };
        let triangle = [point(0.0, 0.0, 1.0), point(10.0, 1.0, 3.0), point(2.0, 8.0, 2.0)];
        let barycentric = Barycentric::new(triangle).unwrap();
        // Halfway along the first edge on the screen lies three quarters nearer the near end.
        let middle = barycentric.at(5.0, 0.5).value;
        assert!((middle[0] - 0.75).abs() < 1e-12 && (middle[1] - 0.25).abs() < 1e-12);
        let (here, step) = (barycentric.at(4.0, 3.0), 1e-6);
        let (right, below) = (barycentric.at(4.0 + step, 3.0), barycentric.at(4.0, 3.0 + step));
        for i in 0..3 {
            assert!(((right.value[i] - here.value[i]) / step - here.by_x[i]).abs() < 1e-6);
            assert!(((below.value[i] - here.value[i]) / step - here.by_y[i]).abs() < 1e-6);
        }
    }
}
