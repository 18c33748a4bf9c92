//! The Chebyshev iteration, which makes local and global steps converge in half of their number or less.

use crate::quarter::direction;
use num_complex::Complex64;

/// The least part of their way to the limit that local and global steps go by themselves, for the rotations that matter;
/// measured on layouts of organic shapes.
const SLOWEST: f64 = 0.14;

/// One step of a fixed-point iteration, with a memory of the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    length: f64,
    memory: f64,
}

impl Step {
    /// All the way, and no more.
    pub(crate) const PLAIN: Self = Self { length: 1.0, memory: 0.0 };

    /// Where the step leads from `x`, which came from `before`, if the iteration by itself leads to `image`.
    fn from(self, x: Complex64, before: Complex64, image: Complex64) -> Complex64 {
        x + self.length * (image - x) + self.memory * (x - before)
    }

    /// Takes the step with a rotation, which came from `before`, if the iteration by itself leads to `best`.
    pub(crate) fn turn(self, rotation: &mut Complex64, before: &mut Complex64, best: Complex64) {
        let last = std::mem::replace(before, *rotation);
        *rotation = direction(self.from(*rotation, last, best));
    }
}

/// The steps of local and global iterations in turn.
pub(crate) fn accelerated() -> impl Iterator<Item = Step> {
    steps(SLOWEST)
}

/// The steps for a symmetric linear iteration that takes every error to some part of it between zero and one less `slowest`
/// (Golub and Varga 1961).
fn steps(slowest: f64) -> impl Iterator<Item = Step> {
    let (middle, radius) = (0.5 * (1.0 + slowest), 0.5 * (1.0 - slowest));
    let first = Step { length: 1.0 / middle, memory: 0.0 };
    std::iter::successors(Some(first), move |last| {
        let share = if *last == first { 0.5 } else { 0.25 } * (radius * last.length).powi(2);
        let length = 1.0 / (middle - share / last.length);
        Some(Step { length, memory: length * share / last.length })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_fall_as_the_square_root_of_the_condition_has_it() {
        let slowest: f64 = 0.1;
        let rate = (1.0 - slowest.sqrt()) / (1.0 + slowest.sqrt());
        for kept in [0.0, 0.3, 0.6, 1.0 - slowest] {
            let limit = Complex64::new(2.0, -1.0);
            let (mut x, mut before) = (Complex64::ZERO, Complex64::ZERO);
            for (k, step) in steps(slowest).take(12).enumerate() {
                let next = step.from(x, before, limit + kept * (x - limit));
                (before, x) = (x, next);
                let bound = 2.0 * rate.powi(k as i32 + 1) * limit.norm();
                assert!((x - limit).norm() <= bound + 1e-12, "{kept} {k}");
            }
        }
        assert_eq!(Step::PLAIN.from(Complex64::ONE, Complex64::ZERO, Complex64::I), Complex64::I);
    }
}
