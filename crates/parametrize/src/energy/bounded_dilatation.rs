//! The symmetric Dirichlet energy with the dilatation of every triangle kept below a bound.

use super::{Energy, Jet, SymmetricDirichlet};

/// `E - weight log(1 - p / P)` with E the symmetric Dirichlet energy and `p = s1 / s2 + s2 / s1 - 2`, which grows
/// with the dilatation `K = s1 / s2` and is P at the bound: infinite where K reaches it, smooth where K = 1.
#[derive(Debug, Clone, Copy)]
pub struct BoundedDilatation {
    largest: f64,
    weight: f64,
}

impl BoundedDilatation {
    /// For a bound on K above 1, and the weight of the barrier.
    pub fn new(bound: f64, weight: f64) -> Self {
        Self { largest: (bound - 1.0).powi(2) / bound, weight }
    }

    /// What is left up to the bound, as a part of it; not positive beyond it or where the triangle is flipped.
    fn room(&self, s1: f64, s2: f64) -> f64 {
        let area = s1 * s2;
        // Without the difference of numbers near 2: a bound may be close to 1.
        if area > 0.0 { 1.0 - (s1 - s2).powi(2) / (area * self.largest) } else { -1.0 }
    }
}

impl Energy for BoundedDilatation {
    #[inline]
    fn value(&self, s1: f64, s2: f64) -> f64 {
        let room = self.room(s1, s2);
        if room <= 0.0 {
            return f64::INFINITY;
        }
        SymmetricDirichlet.value(s1, s2) - self.weight * room.ln()
    }

    #[inline]
    fn jet(&self, s1: f64, s2: f64) -> Jet {
        let mut jet = SymmetricDirichlet.jet(s1, s2);
        let (difference, sum, area) = (s1 - s2, s1 + s2, s1 * s2);
        let d = [difference * sum / (s1 * area), -difference * sum / (s2 * area)];
        let dd = [2.0 * s2 / s1.powi(3), -1.0 / (s1 * s1) - 1.0 / (s2 * s2), 2.0 * s1 / s2.powi(3)];
        // -log(1 - p / P) has the first derivative 1 / (P - p), and its square as the second one.
        let first = 1.0 / (self.largest * self.room(s1, s2));
        let w = self.weight;
        jet.value = self.value(s1, s2);
        jet.d[0] += w * first * d[0];
        jet.d[1] += w * first * d[1];
        jet.dd[0] += w * first * (dd[0] + first * d[0] * d[0]);
        jet.dd[1] += w * first * (dd[1] + first * d[0] * d[1]);
        jet.dd[2] += w * first * (dd[2] + first * d[1] * d[1]);
        jet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_differences() {
        let energy = BoundedDilatation::new(2.5, 0.3);
        let (s1, s2, h) = (1.6, 0.7, 1e-5);
        let jet = energy.jet(s1, s2);
        assert_eq!(jet.value, energy.value(s1, s2));
        let [up, down] = [h, -h].map(|h| energy.jet(s1 + h, s2));
        assert!(((up.value - down.value) / (2.0 * h) - jet.d[0]).abs() < 1e-6);
        assert!(((up.d[0] - down.d[0]) / (2.0 * h) - jet.dd[0]).abs() < 1e-4);
        assert!(((up.d[1] - down.d[1]) / (2.0 * h) - jet.dd[1]).abs() < 1e-4);
        let [up, down] = [h, -h].map(|h| energy.jet(s1, s2 + h));
        assert!(((up.value - down.value) / (2.0 * h) - jet.d[1]).abs() < 1e-6);
        assert!(((up.d[1] - down.d[1]) / (2.0 * h) - jet.dd[2]).abs() < 1e-4);
    }

    #[test]
    fn the_barrier_stands_at_the_bound_whatever_the_size() {
        for bound in [1.0 + 1e-6, 1.5, 20.0] {
            let energy = BoundedDilatation::new(bound, 0.3);
            for size in [0.1, 1.0, 8.0] {
                let inside = 1.0 + (bound - 1.0) * 0.999;
                assert!(energy.value(inside * size, size).is_finite(), "{bound}");
                let outside = 1.0 + (bound - 1.0) * 1.001;
                assert!(energy.value(outside * size, size).is_infinite(), "{bound}");
            }
        }
        assert!(BoundedDilatation::new(2.0, 0.3).value(1.0, -0.9).is_infinite());
    }
}
