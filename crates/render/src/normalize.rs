//! Brings coordinates of any scale to about one, by powers of two alone.

/// The map `x -> (x * 2^a - center) * 2^b` that brings a set of points to the box around the
/// origin whose longest side lies in `[1, 2]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Normalizer<const N: usize> {
    first: PowerOfTwo,
    center: [f64; N],
    second: PowerOfTwo,
    /// The exponent of both.
    exponent: i32,
}

impl<const N: usize> Normalizer<N> {
    /// `None` if the points all coincide (or there is none).
    pub(crate) fn fit(points: impl Iterator<Item = [f64; N]> + Clone) -> Option<Self> {
        let largest = points.clone().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        if largest == 0.0 {
            return None;
        }
        let first_exponent = -exponent(largest);
        let first = PowerOfTwo::new(first_exponent);
        let (mut low, mut high) = ([f64::INFINITY; N], [f64::NEG_INFINITY; N]);
        for point in points {
            for k in 0..N {
                let x = first.times(point[k]);
                low[k] = low[k].min(x);
                high[k] = high[k].max(x);
            }
        }
        let extent = (0..N).fold(0.0_f64, |m, k| m.max(high[k] - low[k]));
        (extent > 0.0).then(|| {
            let second_exponent = -exponent(extent);
            Self {
                first,
                center: std::array::from_fn(|k| 0.5 * (low[k] + high[k])),
                second: PowerOfTwo::new(second_exponent),
                exponent: first_exponent + second_exponent,
            }
        })
    }

    pub(crate) fn apply(&self, point: [f64; N]) -> [f64; N] {
        std::array::from_fn(|k| self.second.times(self.first.times(point[k]) - self.center[k]))
    }

    /// The length, in the original units, of a normalised length.
    pub(crate) fn length_back(&self, length: f64) -> f64 {
        PowerOfTwo::new(-self.exponent).times(length)
    }
}

/// The exponent of the power of two near a positive finite number.
fn exponent(x: f64) -> i32 {
    x.log2().floor() as i32
}

/// A power of two as two factors, so that none overflows.
#[derive(Debug, Clone, Copy)]
struct PowerOfTwo([f64; 2]);

impl PowerOfTwo {
    fn new(exponent: i32) -> Self {
        let half = exponent / 2;
        Self([2.0_f64.powi(half), 2.0_f64.powi(exponent - half)])
    }

    fn times(self, x: f64) -> f64 {
        x * self.0[0] * self.0[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_by_powers_of_two_change_nothing() {
        let square = [[0.25, 0.5], [1.25, 0.5], [1.25, 1.5]];
        let reference = Normalizer::fit(square.iter().copied()).unwrap();
        for e in [-1000, -660, 0, 660, 1000] {
            let scaled = square.map(|p| p.map(|x| PowerOfTwo::new(e).times(x)));
            let normalizer = Normalizer::fit(scaled.iter().copied()).unwrap();
            for (p, q) in square.iter().zip(scaled) {
                assert_eq!(reference.apply(*p), normalizer.apply(q));
            }
            assert_eq!(normalizer.length_back(1.0), PowerOfTwo::new(e).times(1.0));
        }
    }

    #[test]
    fn the_widest_range_does_not_overflow() {
        let points = [[f64::MAX, 0.0], [-f64::MAX, f64::MIN_POSITIVE]];
        let normalizer = Normalizer::fit(points.iter().copied()).unwrap();
        for p in points {
            assert!(normalizer.apply(p).iter().all(|x| x.abs() <= 1.0));
        }
    }

    #[test]
    fn coincident_points_have_no_frame() {
        assert!(Normalizer::fit([[3.0, 1.0]; 4].into_iter()).is_none());
        assert!(Normalizer::fit([[0.0, 0.0]; 4].into_iter()).is_none());
    }
}
