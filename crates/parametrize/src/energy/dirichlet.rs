//! The symmetric Dirichlet energy and its powers.

use super::{Energy, Jet};

/// Symmetric Dirichlet energy `s1^2 + s2^2 + 1/s1^2 + 1/s2^2`, 4 at an isometry.
///
/// Eq. (5) of Levi 2021 lost the squares of the inverses in print: as printed its minimum is not at 1.
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
