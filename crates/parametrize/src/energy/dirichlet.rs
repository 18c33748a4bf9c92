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
