//! Brings coordinates of any scale to about one, by powers of two alone.

/// The map `x -> (x * 2^a - center) * 2^b` that brings a set of points to the box around the
/// origin whose longest side lies in `[1, 2]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Normalizer<const N: usize> {
    first: i32,
    center: [f64; N],
    second: i32,
}

impl<const N: usize> Normalizer<N> {
    /// `None` if the points all coincide (or there is none).
    pub(crate) fn fit(points: impl Iterator<Item = [f64; N]> + Clone) -> Option<Self> {
        let largest = points.clone().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        if largest == 0.0 {
            return None;
        }
        let first = -exponent(largest);
        let (mut low, mut high) = ([f64::INFINITY; N], [f64::NEG_INFINITY; N]);
        for point in points {
            for k in 0..N {
                let x = times_power_of_two(point[k], first);
                low[k] = low[k].min(x);
                high[k] = high[k].max(x);
            }
        }
        let extent = (0..N).fold(0.0_f64, |m, k| m.max(high[k] - low[k]));
        (extent > 0.0).then(|| Self {
            first,
            center: std::array::from_fn(|k| 0.5 * (low[k] + high[k])),
            second: -exponent(extent),
        })
    }

    pub(crate) fn apply(&self, point: [f64; N]) -> [f64; N] {
        std::array::from_fn(|k| {
            let x = times_power_of_two(point[k], self.first);
            times_power_of_two(x - self.center[k], self.second)
        })
    }

    /// The length, in the original units, of a normalised length.
    pub(crate) fn length_back(&self, length: f64) -> f64 {
        times_power_of_two(length, -(self.first + self.second))
    }
}

/// The exponent of the power of two near a positive finite number.
fn exponent(x: f64) -> i32 {
    x.log2().floor() as i32
}

/// `x * 2^e` without an overflow on the way.
fn times_power_of_two(x: f64, e: i32) -> f64 {
    let half = e / 2;
    x * 2.0_f64.powi(half) * 2.0_f64.powi(e - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_by_powers_of_two_change_nothing() {
        let square = [[0.25, 0.5], [1.25, 0.5], [1.25, 1.5]];
        let reference = Normalizer::fit(square.iter().copied()).unwrap();
        for e in [-1000, -660, 0, 660, 1000] {
            let scaled = square.map(|p| p.map(|x| times_power_of_two(x, e)));
            let normalizer = Normalizer::fit(scaled.iter().copied()).unwrap();
            for (p, q) in square.iter().zip(scaled) {
                assert_eq!(reference.apply(*p), normalizer.apply(q));
            }
            assert_eq!(normalizer.length_back(1.0), times_power_of_two(1.0, e));
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
