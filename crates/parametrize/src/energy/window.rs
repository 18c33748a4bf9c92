//! The symmetric Dirichlet energy with all singular values kept in a window.

use super::{Energy, Jet, SymmetricDirichlet};

/// `E - weight (log(1 - s1 / highest) + log(1 - lowest / s2))` with E the symmetric Dirichlet energy: infinite
/// outside `lowest < s2 <= s1 < highest`.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// Bound on the singular values from below.
    pub lowest: f64,
    /// Bound from above.
    pub highest: f64,
    /// Weight of the barriers.
    pub weight: f64,
}

impl Energy for Window {
    #[inline]
    fn value(&self, s1: f64, s2: f64) -> f64 {
        if s1 >= self.highest || s2 <= self.lowest {
            return f64::INFINITY;
        }
        let room = (1.0 - s1 / self.highest) * (1.0 - self.lowest / s2);
        SymmetricDirichlet.value(s1, s2) - self.weight * room.ln()
    }

    #[inline]
    fn jet(&self, s1: f64, s2: f64) -> Jet {
        let mut jet = SymmetricDirichlet.jet(s1, s2);
        let (above, below, inverse) =
            (1.0 / (self.highest - s1), 1.0 / (s2 - self.lowest), 1.0 / s2);
        jet.value = self.value(s1, s2);
        jet.d[0] += self.weight * above;
        jet.d[1] -= self.weight * (below - inverse);
        jet.dd[0] += self.weight * above * above;
        jet.dd[2] += self.weight * (below * below - inverse * inverse);
        jet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_differences() {
        let energy = Window { lowest: 0.5, highest: 2.0, weight: 0.3 };
        let (s1, s2, h) = (1.6, 0.7, 1e-5);
        let jet = energy.jet(s1, s2);
        assert_eq!(jet.value, energy.value(s1, s2));
        let [up, down] = [h, -h].map(|h| energy.jet(s1 + h, s2));
        assert!(((up.value - down.value) / (2.0 * h) - jet.d[0]).abs() < 1e-7);
        assert!(((up.d[0] - down.d[0]) / (2.0 * h) - jet.dd[0]).abs() < 1e-5);
        let [up, down] = [h, -h].map(|h| energy.jet(s1, s2 + h));
        assert!(((up.value - down.value) / (2.0 * h) - jet.d[1]).abs() < 1e-7);
        assert!(((up.d[1] - down.d[1]) / (2.0 * h) - jet.dd[2]).abs() < 1e-5);
        assert!(((up.d[0] - down.d[0]) / (2.0 * h) - jet.dd[1]).abs() < 1e-9);
    }

    #[test]
    fn outside_the_window_the_energy_is_infinite() {
        let energy = Window { lowest: 0.5, highest: 2.0, weight: 0.3 };
        assert!(energy.value(2.0, 1.0).is_infinite() && energy.value(1.0, 0.5).is_infinite());
        assert!(energy.value(1.9, 0.6).is_finite());
    }
}
