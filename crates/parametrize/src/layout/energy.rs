//! Energies of the two signed singular values of a triangle's Jacobian.

use crate::quarter::direction;
use num_complex::Complex64;

/// Value, gradient and Hessian of an energy at `(sigma_1, sigma_2)`.
#[derive(Debug, Clone, Copy)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivatives.
    pub d: [f64; 2],
    /// Second derivatives: 11, 12, 22.
    pub dd: [f64; 3],
}

/// An energy per triangle; most grow without bound as the triangle collapses.
pub trait Energy: Sync {
    /// Value at singular values, with `s2 > 0` unless flips are allowed.
    fn value(&self, s1: f64, s2: f64) -> f64;
    /// Value and derivatives.
    fn jet(&self, s1: f64, s2: f64) -> Jet;
    /// Whether flipped triangles have a finite energy too.
    fn allows_flips(&self) -> bool {
        false
    }
}

/// Symmetric Dirichlet energy `s1^2 + s2^2 + 1/s1^2 + 1/s2^2`, 4 at an isometry.
///
/// The seed's (5) lost the squares of the inverses in print: as printed it is not smallest at 1.
#[derive(Debug, Clone, Copy, Default)]
pub struct SymmetricDirichlet;

impl Energy for SymmetricDirichlet {
    #[inline]
    fn value(&self, s1: f64, s2: f64) -> f64 {
        let (a, b) = (s1 * s1, s2 * s2);
        a + b + 1.0 / a + 1.0 / b
    }

    #[inline]
    fn jet(&self, s1: f64, s2: f64) -> Jet {
        let (a, b) = (s1 * s1, s2 * s2);
        Jet {
            value: a + b + 1.0 / a + 1.0 / b,
            d: [2.0 * (s1 - 1.0 / (a * s1)), 2.0 * (s2 - 1.0 / (b * s2))],
            dd: [2.0 + 6.0 / (a * a), 0.0, 2.0 + 6.0 / (b * b)],
        }
    }
}

/// `(E / bound)^p / p` with E the symmetric Dirichlet energy: for growing p it looks at the worst
/// triangles only.
#[derive(Debug, Clone, Copy)]
pub struct PowerOfDirichlet {
    /// The exponent.
    pub p: i32,
    /// The largest energy of a triangle when the optimisation starts.
    pub bound: f64,
}

impl Energy for PowerOfDirichlet {
    #[inline]
    fn value(&self, s1: f64, s2: f64) -> f64 {
        (SymmetricDirichlet.value(s1, s2) / self.bound).powi(self.p) / f64::from(self.p)
    }

    #[inline]
    fn jet(&self, s1: f64, s2: f64) -> Jet {
        let inner = SymmetricDirichlet.jet(s1, s2);
        let p = f64::from(self.p);
        let q = inner.value / self.bound;
        let second = q.powi(self.p - 2);
        let (g1, g2) = (q * second / self.bound, (p - 1.0) * second / (self.bound * self.bound));
        let [d1, d2] = inner.d;
        Jet {
            value: q * q * second / p,
            d: [g1 * d1, g1 * d2],
            dd: [g1 * inner.dd[0] + g2 * d1 * d1, g2 * d1 * d2, g1 * inner.dd[2] + g2 * d2 * d2],
        }
    }
}

/// `(s1^2 + s2^2 + 1 + (s1 s2)^2) / chi(s1 s2)` with `chi(D) = (D + sqrt(eps^2 + D^2)) / 2`: finite for
/// flipped triangles, and a barrier against them as eps goes to zero (Garanzha et al. 2021).
#[derive(Debug, Clone, Copy)]
pub struct Untangling {
    /// Width of the regularisation, in units of the determinant.
    pub eps: f64,
}

impl Untangling {
    /// `chi` and its first two derivatives.
    #[inline]
    pub fn chi(&self, d: f64) -> [f64; 3] {
        let q = self.eps.hypot(d);
        let value = if d >= 0.0 { 0.5 * (d + q) } else { 0.5 * self.eps * self.eps / (q - d) };
        [value, value / q, 0.5 * self.eps * self.eps / (q * q * q)]
    }
}

impl Energy for Untangling {
    fn value(&self, s1: f64, s2: f64) -> f64 {
        let d = s1 * s2;
        (s1 * s1 + s2 * s2 + 1.0 + d * d) / self.chi(d)[0]
    }

    fn jet(&self, s1: f64, s2: f64) -> Jet {
        let d = s1 * s2;
        let [chi, c1, c2] = self.chi(d);
        let value = (s1 * s1 + s2 * s2 + 1.0 + d * d) / chi;
        let (n1, n2) = (2.0 * s1 + 2.0 * d * s2, 2.0 * s2 + 2.0 * d * s1);
        let (n11, n12, n22) = (2.0 + 2.0 * s2 * s2, 4.0 * d, 2.0 + 2.0 * s1 * s1);
        let (x1, x2) = (c1 * s2, c1 * s1);
        let (x11, x12, x22) = (c2 * s2 * s2, c2 * d + c1, c2 * s1 * s1);
        let (f1, f2) = ((n1 - value * x1) / chi, (n2 - value * x2) / chi);
        Jet {
            value,
            d: [f1, f2],
            dd: [
                (n11 - 2.0 * f1 * x1 - value * x11) / chi,
                (n12 - f1 * x2 - f2 * x1 - value * x12) / chi,
                (n22 - 2.0 * f2 * x2 - value * x22) / chi,
            ],
        }
    }

    fn allows_flips(&self) -> bool {
        true
    }
}

/// A Jacobian split in similarity and anti-similarity, `J v = similar v + anti conj(v)`.
#[derive(Debug, Clone, Copy)]
pub struct Jacobian {
    /// Similarity part.
    pub similar: Complex64,
    /// Anti-similarity part.
    pub anti: Complex64,
}

impl Jacobian {
    /// From the rows of the 2 x 2 matrix.
    #[inline]
    pub fn from_rows(j: [[f64; 2]; 2]) -> Self {
        Self {
            similar: Complex64::new(j[0][0] + j[1][1], j[1][0] - j[0][1]) / 2.0,
            anti: Complex64::new(j[0][0] - j[1][1], j[1][0] + j[0][1]) / 2.0,
        }
    }

    /// Signed singular values, the larger first; the second is negative for a flipped triangle.
    #[inline]
    pub fn singular_values(&self) -> (f64, f64) {
        let (a, b) = (self.similar.norm_sqr().sqrt(), self.anti.norm_sqr().sqrt());
        (a + b, a - b)
    }
}

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
    use crate::layout::distance::{Arap, Asap, Guarded};

    fn at(j: [f64; 4]) -> Jacobian {
        Jacobian::from_rows([[j[0], j[1]], [j[2], j[3]]])
    }

    #[test]
    fn singular_values_of_known_maps() {
        let (s1, s2) = at([3.0, 0.0, 0.0, 0.5]).singular_values();
        assert!((s1 - 3.0).abs() < 1e-15 && (s2 - 0.5).abs() < 1e-15);
        let (s1, s2) = at([0.0, 1.0, 1.0, 0.0]).singular_values();
        assert_eq!((s1, s2), (1.0, -1.0));
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
        check(&PowerOfDirichlet { p: 4, bound: 5.0 });
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
