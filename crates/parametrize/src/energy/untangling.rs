//! An energy that pulls flipped triangles open.

use super::{Energy, Jet};

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
