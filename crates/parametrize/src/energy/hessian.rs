//! Hessians of energies, made positive semi-definite.

use super::{Energy, Jacobian};
use crate::quarter::direction;
use num_complex::Complex64;

/// Gradient and projected (positive semi-definite) Hessian with respect to the Jacobian's entries
/// `(j00, j01, j10, j11)`, by the closed-form eigensystem of energies of the singular values.
///
/// The Hessian is returned as four eigenvalues (negative ones cut to zero) with orthonormal
/// eigenvectors.
pub struct ProjectedHessian {
    /// Energy.
    pub value: f64,
    /// Gradient.
    pub gradient: [f64; 4],
    /// Eigenvalues, none negative.
    pub eigenvalues: [f64; 4],
    /// Eigenvectors.
    pub eigenvectors: [[f64; 4]; 4],
}

impl ProjectedHessian {
    /// At a Jacobian with positive determinant.
    #[inline]
    pub fn new(energy: &impl Energy, jacobian: &Jacobian) -> Self {
        let (s1, s2) = jacobian.singular_values();
        let jet = energy.jet(s1, s2);
        // J = U diag(s1, s2) V^T with U, V rotations by u, v: half angles, whose common sign is free.
        let similar = direction(jacobian.similar);
        let u = half_angle(similar * direction(jacobian.anti));
        let v = u * similar.conj();
        let outer = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
        let (u1, u2, v1, v2) = ([u.re, u.im], [-u.im, u.re], [v.re, v.im], [-v.im, v.re]);
        let (d1, d2) = (outer(u1, v1), outer(u2, v2));
        let (a21, a12) = (outer(u2, v1), outer(u1, v2));
        let combine =
            |x: f64, a: [f64; 4], y: f64, b: [f64; 4]| [0, 1, 2, 3].map(|k| x * a[k] + y * b[k]);
        let [f1, f2] = jet.d;
        let [f11, f12, f22] = jet.dd;
        let (mean, half) = ((f11 + f22) / 2.0, (f11 - f22) / 2.0);
        let radius = half.hypot(f12);
        let Complex64 { re: c, im: s } = half_angle(direction(Complex64::new(half, f12)));
        let (sum, difference) = (s1 + s2, s1 - s2);
        let twist = if sum > 1e-9 { (f1 + f2) / sum } else { 0.0 };
        let flip = if difference > 1e-7 { (f1 - f2) / difference } else { f11 - f12 };
        const R: f64 = std::f64::consts::FRAC_1_SQRT_2;
        Self {
            value: jet.value,
            gradient: combine(f1, d1, f2, d2),
            eigenvalues: [mean + radius, mean - radius, twist, flip].map(|x| x.max(0.0)),
            eigenvectors: [
                combine(c, d1, s, d2),
                combine(-s, d1, c, d2),
                combine(R, a21, -R, a12),
                combine(R, a21, R, a12),
            ],
        }
    }

    /// The matrix itself.
    #[inline]
    pub fn matrix(&self) -> [[f64; 4]; 4] {
        let mut matrix = [[0.0; 4]; 4];
        for (value, vector) in self.eigenvalues.iter().zip(&self.eigenvectors) {
            for (row, x) in matrix.iter_mut().zip(vector) {
                row.iter_mut().zip(vector).for_each(|(entry, y)| *entry += value * x * y);
            }
        }
        matrix
    }
}

/// A square root of a unit complex number.
#[inline]
fn half_angle(z: Complex64) -> Complex64 {
    let larger = ((1.0 + z.re.abs()) / 2.0).sqrt();
    let smaller = z.im / (2.0 * larger);
    if z.re >= 0.0 { Complex64::new(larger, smaller) } else { Complex64::new(smaller, larger) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Arap, Asap, Guarded, SymmetricDirichlet, Untangling};

    fn at(j: [f64; 4]) -> Jacobian {
        Jacobian::from_rows([[j[0], j[1]], [j[2], j[3]]])
    }

    /// Gradient and Hessian in the entries of J by central differences.
    fn differences(energy: &impl Energy, j: [f64; 4]) -> ([f64; 4], [[f64; 4]; 4]) {
        let value = |j: [f64; 4]| {
            let (s1, s2) = at(j).singular_values();
            energy.value(s1, s2)
        };
        let shifted = |k: usize, step: f64| {
            let mut j = j;
            j[k] += step;
            j
        };
        let step = 1e-5;
        let slope = |k| (value(shifted(k, step)) - value(shifted(k, -step))) / (2.0 * step);
        let second = |k| {
            let gradient = |step| ProjectedHessian::new(energy, &at(shifted(k, step))).gradient;
            let (up, down) = (gradient(step), gradient(-step));
            [0, 1, 2, 3].map(|l| (up[l] - down[l]) / (2.0 * step))
        };
        ([0, 1, 2, 3].map(slope), [0, 1, 2, 3].map(second))
    }

    fn check_derivatives(energy: &impl Energy) {
        let points = [[1.3, 0.2, -0.4, 0.9], [0.7, -1.1, 1.0, 0.3], [0.4, 0.1, 0.2, 0.5]];
        for j in points {
            let hessian = ProjectedHessian::new(energy, &at(j));
            let (slope, second) = differences(energy, j);
            for (k, (slope, gradient)) in slope.iter().zip(hessian.gradient).enumerate() {
                let error = (slope - gradient).abs();
                assert!(error < 1e-7 * (1.0 + slope.abs()), "{j:?} {k}");
            }
            // The eigenvectors diagonalise the true Hessian; negative eigenvalues are cut off.
            let size = second.iter().flatten().fold(1.0f64, |m, x| m.max(x.abs()));
            for (a, v) in hessian.eigenvectors.iter().enumerate() {
                for (b, w) in hessian.eigenvectors.iter().enumerate() {
                    let form: f64 = (0..4)
                        .map(|k| (0..4).map(|l| v[k] * second[k][l] * w[l]).sum::<f64>())
                        .sum();
                    let expected = if a == b { hessian.eigenvalues[a] } else { 0.0 };
                    let found = if a == b { form.max(0.0) } else { form };
                    assert!((found - expected).abs() < 1e-5 * size, "{j:?} {a} {b}: {form}");
                }
            }
        }
    }

    fn check_jet(energy: &impl Energy) {
        for (s1, s2) in [(1.4, 0.8), (2.0, 0.3), (0.6, 0.5)] {
            let jet = energy.jet(s1, s2);
            let step = 1e-6;
            let slopes = |of: &dyn Fn(f64, f64) -> f64| {
                [
                    (of(s1 + step, s2) - of(s1 - step, s2)) / (2.0 * step),
                    (of(s1, s2 + step) - of(s1, s2 - step)) / (2.0 * step),
                ]
            };
            let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * (1.0 + b.abs());
            assert!(near(jet.value, energy.value(s1, s2)));
            let d = slopes(&|a, b| energy.value(a, b));
            assert!(near(d[0], jet.d[0]) && near(d[1], jet.d[1]), "{d:?} {:?}", jet.d);
            let d1 = slopes(&|a, b| energy.jet(a, b).d[0]);
            let d2 = slopes(&|a, b| energy.jet(a, b).d[1]);
            assert!(near(d1[0], jet.dd[0]) && near(d1[1], jet.dd[1]), "{d1:?} {:?}", jet.dd);
            assert!(near(d2[0], jet.dd[1]) && near(d2[1], jet.dd[2]), "{d2:?} {:?}", jet.dd);
        }
    }

    #[test]
    fn derivatives_match_differences() {
        fn check(energy: &impl Energy) {
            check_jet(energy);
            check_derivatives(energy);
        }
        check(&SymmetricDirichlet);
        check(&Untangling { eps: 0.3 });
        check(&Arap);
        check(&Asap { reward: 0.2 });
        check(&Guarded { energy: Arap, weight: 0.1 });
        check(&Guarded { energy: Asap { reward: 0.1 }, weight: 0.05 });
    }

    #[test]
    fn some_eigenvalues_of_arap_are_cut_off() {
        // Pressed together, a triangle would rather buckle: the twist has negative curvature.
        let hessian = ProjectedHessian::new(&Arap, &at([0.4, 0.0, 0.0, 0.5]));
        assert!(hessian.eigenvalues.contains(&0.0));
    }

    #[test]
    fn hessian_is_positive_semidefinite_far_away() {
        let hessian = ProjectedHessian::new(&SymmetricDirichlet, &at([9.0, 0.0, 0.0, 7.0]));
        assert!(hessian.eigenvalues.iter().all(|&l| l >= 0.0));
    }
}
