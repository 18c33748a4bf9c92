//! Sums of products of doubles without rounding, and the signs that follow from them.

use crate::plane::{Arrow, Point};
use std::cmp::Ordering;

/// Exponent of two of the last bit of the smallest product of two doubles.
const LAST_BIT: i32 = 2 * (f64::MIN_EXP - f64::MANTISSA_DIGITS as i32);
/// Bits of a digit. Each is kept in twice as many, so that no carry is lost in 2^62 sums.
const DIGIT: usize = u64::BITS as usize;
/// Digits of all products of two doubles, and room for their sum.
const DIGITS: usize = (2 * f64::MAX_EXP - LAST_BIT) as usize / DIGIT + 3;

/// A sum of products of finite doubles, as a fixed-point number that holds every bit of any of them.
pub(crate) struct ExactSum([i128; DIGITS]);

impl ExactSum {
    pub(crate) fn new() -> Self {
        Self([0; DIGITS])
    }

    /// Adds `a b`.
    pub(crate) fn add(&mut self, a: f64, b: f64) {
        let ([a, a_place], [b, b_place]) = (parts(a), parts(b));
        let product = i128::from(a) * i128::from(b);
        let (size, sign, place) =
            (product.unsigned_abs(), product.signum(), (a_place + b_place) as usize);
        let (digit, shift) = (place / DIGIT, place % DIGIT);
        for (k, half) in [size as u64, (size >> DIGIT) as u64].into_iter().enumerate() {
            let shifted = u128::from(half) << shift;
            self.0[digit + k] += sign * i128::from(shifted as u64);
            self.0[digit + k + 1] += sign * (shifted >> DIGIT) as i128;
        }
    }

    /// Its digits other than zero and their places, from the first to the last. Each is at most half of a unit of the digit
    /// before, of either sign, so that the first has the sign of the number.
    fn digits(mut self) -> impl Iterator<Item = (usize, i128)> {
        for k in 1..DIGITS {
            let carry = (self.0[k - 1] + (1 << (DIGIT - 1))) >> DIGIT;
            self.0[k - 1] -= carry << DIGIT;
            self.0[k] += carry;
        }
        self.0.into_iter().enumerate().rev().filter(|&(_, digit)| digit != 0)
    }

    /// Its sign, as its order to zero.
    pub(crate) fn sign(self) -> Ordering {
        self.digits().next().map_or(Ordering::Equal, |(_, digit)| digit.cmp(&0))
    }

    /// A double next to it; itself if it is one.
    pub(crate) fn value(self) -> f64 {
        self.digits().fold(0.0, |sum, (k, digit)| {
            // In two factors: one may be out of range.
            let exponent = (DIGIT * k) as i32 + LAST_BIT;
            let [half, rest] = [exponent / 2, exponent - exponent / 2].map(|k| f64::from(k).exp2());
            sum + digit as f64 * half * rest
        })
    }
}

/// A double as a whole number times 2 to the power of the second, counted from the last bit of the smallest double.
fn parts(x: f64) -> [i64; 2] {
    let fraction_bits = f64::MANTISSA_DIGITS - 1;
    let exponent = (x.abs().to_bits() >> fraction_bits) as i64;
    let fraction = (x.to_bits() & ((1 << fraction_bits) - 1)) as i64;
    let size = fraction | i64::from(exponent > 0) << fraction_bits;
    [if x < 0.0 { -size } else { size }, exponent.max(1) - 1]
}

/// On which side of an arrow another one points: left is greater.
///
/// The sign of the cross product, by doubles where their rounding cannot change it, and else without rounding.
pub(crate) fn side(of: Arrow, other: Arrow) -> Ordering {
    let ([a, b], [c, d]) = (of, other);
    let (left, right) = ((b[0] - a[0]) * (d[1] - c[1]), (b[1] - a[1]) * (d[0] - c[0]));
    let (rounded, size) = (left - right, left.abs() + right.abs());
    if size > SMALLEST && rounded.abs() > ROUNDING * size && size.is_finite() {
        return if rounded > 0.0 { Ordering::Greater } else { Ordering::Less };
    }
    let mut sum = ExactSum::new();
    for (x, y) in [(b, d), (c, b), (d, a), (a, c)] {
        add_cross(&mut sum, x, y);
    }
    sum.sign()
}

/// More than the rounding of a cross product, relative to the sum of its two terms: `3 ε + 16 ε²` with ε = 2^-53
/// (Shewchuk 1997).
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// Above this size of the terms nothing that underflows counts.
const SMALLEST: f64 = 1e-280;

/// Adds the cross product of two points.
fn add_cross(sum: &mut ExactSum, a: Point, b: Point) {
    sum.add(a[0], b[1]);
    sum.add(-a[1], b[0]);
}

/// The area of triangles of the plane, counter-clockwise positive, without rounding but of the result.
pub(crate) fn area(triangles: impl Iterator<Item = [Point; 3]>) -> f64 {
    let mut doubled = ExactSum::new();
    for [a, b, c] in triangles {
        [(a, b), (b, c), (c, a)].into_iter().for_each(|(x, y)| add_cross(&mut doubled, x, y));
    }
    0.5 * doubled.value()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(terms: &[[f64; 2]]) -> ExactSum {
        let mut sum = ExactSum::new();
        terms.iter().for_each(|&[a, b]| sum.add(a, b));
        sum
    }

    #[test]
    fn sums_have_exact_signs() {
        let (tiny, huge) = (f64::from_bits(1), f64::MAX);
        let cases: [(&[[f64; 2]], Ordering); 9] = [
            (&[], Ordering::Equal),
            (&[[tiny, tiny]], Ordering::Greater),
            (&[[tiny, -tiny]], Ordering::Less),
            (&[[huge, huge], [-huge, huge]], Ordering::Equal),
            (&[[huge, huge], [tiny, tiny], [huge, -huge]], Ordering::Greater),
            (&[[huge, huge], [tiny, -tiny], [huge, -huge]], Ordering::Less),
            (&[[huge, -huge], [tiny, tiny]], Ordering::Less),
            (&[[1e16, 1.0], [1.0, 1.0], [-1e16, 1.0], [-1.0, 1.0]], Ordering::Equal),
            (&[[-0.0, 3.0], [0.0, -3.0]], Ordering::Equal),
        ];
        for (terms, sign) in cases {
            assert_eq!(sum(terms).sign(), sign, "{terms:?}");
        }
    }

    #[test]
    fn sums_of_doubles_are_themselves() {
        for x in
            [0.0, 1.0, -1.0, 0.1, -1e300, 3e-200, 9_007_199_254_740_993.0, 1e-320, 2f64.powi(75)]
        {
            assert_eq!(sum(&[[x, 1.0]]).value(), x);
            assert_eq!(sum(&[[x, 1.0], [1e9, 1e9], [-1.0, 1e18]]).value(), x);
            assert_eq!(sum(&[[x, 0.5], [0.5, x]]).value(), x);
        }
        // Of all bits and sizes, across every place where one digit ends.
        for exponent in -1022..1023 {
            for x in [1.0, 1.0f64.next_up(), 2.0f64.next_down(), 1.0 + 0.5f64.powi(26)] {
                let x = x * f64::from(exponent).exp2();
                assert_eq!(sum(&[[x, 1.0]]).value(), x);
                assert_eq!(sum(&[[-1.0, x]]).value(), -x);
                assert_eq!(sum(&[[x, 1.0], [-1.0, x]]).value(), 0.0);
                assert_eq!(sum(&[[x, 1.0], [-1.0, x.next_up()]]).sign(), Ordering::Less);
                assert_eq!(sum(&[[x, 1.0], [-1.0, x.next_down()]]).sign(), Ordering::Greater);
            }
        }
        let mut many = ExactSum::new();
        (0..1000).for_each(|_| many.add(-1e308, 1e308));
        (0..1000).for_each(|_| many.add(1e308, 1e308));
        many.add(0.1, 0.1);
        assert_eq!(many.value(), 0.1 * 0.1);
    }

    #[test]
    fn sides_are_decided_to_the_last_bit() {
        let diagonal = [[0.1, 0.1], [0.7, 0.7]];
        let with = |y: f64| side(diagonal, [[0.0, 0.0], [0.3, y]]);
        assert_eq!(with(0.3), Ordering::Equal);
        assert_eq!(with(0.3f64.next_up()), Ordering::Greater);
        assert_eq!(with(0.3f64.next_down()), Ordering::Less);
        // Of any size: doubles alone would decide otherwise.
        for scale in [-200, -100, 30, 100, 400].map(|k| f64::from(k).exp2()) {
            let by = |arrow: Arrow| arrow.map(|p| p.map(|x| x * scale));
            for (y, expected) in [
                (0.3, Ordering::Equal),
                (0.3f64.next_up(), Ordering::Greater),
                (0.3f64.next_down(), Ordering::Less),
            ] {
                assert_eq!(side(by(diagonal), by([[0.0, 0.0], [0.3, y]])), expected, "{scale}");
            }
            // Its rounded cross product is positive.
            let (one, other) = ([[0.1, 0.3], [0.4, 0.8]], [[0.0, 0.0], [0.3, 0.5]]);
            assert_eq!(side(by(one), by(other)), Ordering::Less, "{scale}");
        }
        // Less than any difference of doubles would say.
        let flat = [[0.0, 0.0], [1.0, 0.0]];
        assert_eq!(side(flat, [[5.0, 1e-320], [6.0, 0.0]]), Ordering::Less);
        assert_eq!(side([[0.0; 2], [1.0; 2]], [[1.0, 1e-30], [2.0, 1.0]]), Ordering::Less);
        assert_eq!(side([[0.0; 2], [1.0; 2]], [[1.0, -1e-30], [2.0, 1.0]]), Ordering::Greater);
        for scale in [5e-324, 1e-200, 1e-140, 1.0, 1e140, 1e300] {
            let arrow = |x: f64, y: f64| [[0.0; 2], [x * scale, y * scale]];
            assert_eq!(side(arrow(4.0, 2.0), arrow(2.0, 1.0)), Ordering::Equal, "{scale}");
            assert_eq!(side(arrow(4.0, 2.0), arrow(3.0, 2.0)), Ordering::Greater, "{scale}");
            assert_eq!(side(arrow(4.0, 2.0), arrow(3.0, 1.0)), Ordering::Less, "{scale}");
        }
    }

    /// Triangles around the point `(x, y)` over the square from 0 to `n`.
    fn fan(n: f64, x: f64, y: f64) -> [[Point; 3]; 4] {
        let corners = [[0.0, 0.0], [n, 0.0], [n, n], [0.0, n]];
        [0, 1, 2, 3].map(|k| [[x, y], corners[k], corners[(k + 1) % 4]])
    }

    #[test]
    fn whole_cells_add_up_to_whole_numbers() {
        // One square far from the origin of many triangles, and many of few.
        let fans = (1..200).flat_map(|k| fan(3.0, 0.37 * f64::from(k), 1.0 / f64::from(k)));
        assert_eq!(area(fans), 199.0 * 9.0);
        let [first, ..] = fan(1.0, 0.5, 0.3);
        assert_eq!(area([first].into_iter()), 0.15);
        assert_eq!(area([first, [first[0], first[2], first[1]]].into_iter()), 0.0);
    }
}
