//! How far a falling sequence of values still has to fall.

/// Values of a measure, round after round.
///
/// They fall about geometrically in the end: after a fall `d` that is the part `q` of the fall before, `d q / (1 - q)`
/// is still to come. A single small fall says little, so the larger one of the last two parts counts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settling {
    value: f64,
    /// The last fall, and the last two parts, the newest first.
    fall: f64,
    parts: [f64; 2],
}

/// Parts count as this at least: the first falls may shrink faster, but where scales are renewed each round ends up
/// leaving half of what is left; and a margin.
const FASTEST: f64 = 0.6;
/// Parts count as this at most, so that the estimate is finite where falls do not shrink.
const SLOWEST: f64 = 0.99;
/// The part that is assumed before it is known.
const ASSUMED: f64 = 0.9;
/// Below this (8) and (11) are zero: programs find them to the square of their gap.
const ZERO: f64 = 1e-14;

impl Settling {
    pub(super) fn new(value: f64) -> Self {
        Self { value, fall: f64::INFINITY, parts: [ASSUMED; 2] }
    }

    /// The value after another round.
    pub(super) fn push(&mut self, value: f64) {
        let fall = (self.value - value).max(0.0);
        if self.fall.is_finite() {
            let part = if self.fall > 0.0 { fall / self.fall } else { SLOWEST };
            let part = part.clamp(FASTEST, SLOWEST);
            self.parts = [part, self.parts[0]];
        }
        (self.value, self.fall) = (value, fall);
    }

    /// The estimated fall still to come, as a part of the value; infinite before the first round.
    pub(super) fn remaining(&self) -> f64 {
        let [a, b] = self.parts;
        let part = a.max(b);
        match self.value > ZERO {
            true => self.fall * part / (1.0 - part) / self.value,
            false => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(values: impl IntoIterator<Item = f64>) -> Settling {
        let mut values = values.into_iter();
        let mut settling = Settling::new(values.next().unwrap());
        values.for_each(|value| settling.push(value));
        settling
    }

    #[test]
    fn geometric_falls_are_extrapolated() {
        let estimate_and_truth = |part: f64| {
            let value = |k: i32| 2.0 + part.powi(k);
            (after((0..=6).map(value)).remaining(), (value(6) - 2.0) / value(6))
        };
        for part in [0.7, 0.9] {
            let (estimate, left) = estimate_and_truth(part);
            assert!((estimate / left - 1.0).abs() < 1e-9, "{part}");
        }
        for part in [0.1, 0.5] {
            let (estimate, left) = estimate_and_truth(part);
            assert!(estimate > 1.2 * left, "{part}");
        }
    }

    #[test]
    fn one_small_fall_is_no_proof() {
        assert_eq!(after([3.0]).remaining(), f64::INFINITY);
        // A tenth of a thousandth, but it may be the first of many.
        assert!(after([2.0002, 2.0]).remaining() > 5e-4);
        assert!(after([2.004, 2.002, 2.0001, 2.0]).remaining() > 5e-4);
        assert_eq!(after([2.0, 2.0]).remaining(), 0.0);
        assert_eq!(after([1e-10, 1e-15]).remaining(), 0.0);
    }
}
