//! The pull of a triangle towards wanted directions.

use super::{Jacobian, Triangle};
use crate::quarter::{direction, nearest_quarter};
use num_complex::Complex64;

/// Mean energy of a map that lies at 45 degrees to directions that count fully: three times what an isometry has.
pub const DIRECTION_ENERGY: f64 = 12.0;

/// Pulls triangles towards the directions that they have in a layout, as those of a guide that count by `strength`.
pub fn keep_directions(triangles: &mut [Triangle], z: &[Complex64], strength: f64) {
    for t in triangles {
        t.wanted = direction(t.jacobian(z).similar) * (DIRECTION_ENERGY * strength);
    }
}

/// `weight (j01^2 + j10^2)` of the Jacobian seen from the nearest of four wanted rotations: zero when the wanted directions go
/// to the axes, whatever the lengths along them; `2 weight sin^2 x` for a rotation by x from there.
pub struct Alignment {
    /// The two off-diagonal entries as forms of `(j00, j01, j10, j11)`.
    forms: [[f64; 4]; 2],
    weight: f64,
}

impl Alignment {
    /// That of a triangle, if it has any.
    #[inline]
    pub fn new(triangle: &Triangle, jacobian: &Jacobian) -> Option<Self> {
        if triangle.wanted == Complex64::ZERO {
            return None;
        }
        let weight = triangle.wanted.norm();
        let Complex64 { re: c, im: s } =
            nearest_quarter(triangle.wanted / weight, jacobian.similar);
        Some(Self { forms: [[0.0, c, 0.0, s], [-s, 0.0, c, 0.0]], weight })
    }

    /// The energy.
    #[inline]
    pub fn value(&self, jacobian: &Jacobian) -> f64 {
        let entries = jacobian.entries();
        self.weight * self.forms.iter().map(|form| dot(form, &entries).powi(2)).sum::<f64>()
    }

    /// Adds its derivatives by the entries of the Jacobian.
    #[inline]
    pub fn add_to(&self, jacobian: &Jacobian, gradient: &mut [f64; 4], matrix: &mut [[f64; 4]; 4]) {
        let entries = jacobian.entries();
        for form in &self.forms {
            let slope = 2.0 * self.weight * dot(form, &entries);
            for (i, &a) in form.iter().enumerate() {
                gradient[i] += slope * a;
                for (j, &b) in form.iter().enumerate() {
                    matrix[i][j] += 2.0 * self.weight * a * b;
                }
            }
        }
    }
}

#[inline]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(wanted: Complex64) -> Triangle {
        let gradients = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
        Triangle { wedges: [0, 1, 2], gradients, weight: 1.0, wanted }
    }

    fn at([a, b, c, d]: [f64; 4]) -> Jacobian {
        Jacobian::from_rows([[a, b], [c, d]])
    }

    fn value(wanted: Complex64, j: [f64; 4]) -> f64 {
        Alignment::new(&triangle(wanted), &at(j)).unwrap().value(&at(j))
    }

    #[test]
    fn nothing_wanted_costs_nothing() {
        assert!(Alignment::new(&triangle(Complex64::ZERO), &at([1.0, 0.3, 0.0, 1.0])).is_none());
    }

    #[test]
    fn counts_the_square_of_the_sine_and_no_lengths() {
        for quarters in -3..=3 {
            for off in [-40.0f64, -10.0, 0.0, 25.0] {
                let angle = off.to_radians() + f64::from(quarters) * std::f64::consts::FRAC_PI_2;
                let (s, c) = angle.sin_cos();
                let expected = 2.0 * 0.7 * off.to_radians().sin().powi(2);
                let found = value(Complex64::new(0.7, 0.0), [c, -s, s, c]);
                assert!((found - expected).abs() < 1e-12);
            }
        }
        // Stretched along the axes, with them or across.
        assert!(value(Complex64::ONE, [3.0, 0.0, 0.0, 0.5]) < 1e-24);
        assert!(value(Complex64::I, [3.0, 0.0, 0.0, 0.5]) < 1e-24);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let wanted = Complex64::from_polar(0.8, 0.4);
        let j = [1.1, -0.2, 0.5, 0.9];
        let derivatives = |j: [f64; 4]| {
            let (mut gradient, mut matrix) = ([0.0; 4], [[0.0; 4]; 4]);
            let pull = Alignment::new(&triangle(wanted), &at(j)).unwrap();
            pull.add_to(&at(j), &mut gradient, &mut matrix);
            (gradient, matrix)
        };
        let shifted = |k: usize, by: f64| {
            let mut j = j;
            j[k] += by;
            j
        };
        let (gradient, matrix) = derivatives(j);
        for k in 0..4 {
            let [up, down] = [1e-5, -1e-5].map(|by| shifted(k, by));
            let slope = (value(wanted, up) - value(wanted, down)) / 2e-5;
            assert!((slope - gradient[k]).abs() < 1e-8);
            let (up, down) = (derivatives(up).0, derivatives(down).0);
            for l in 0..4 {
                assert!(((up[l] - down[l]) / 2e-5 - matrix[k][l]).abs() < 1e-8);
            }
        }
    }
}
