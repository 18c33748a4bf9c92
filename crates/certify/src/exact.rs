//! Sums of products of doubles without rounding, and the signs that follow from them.

use crate::plane::{Arrow, Point};
use std::cmp::Ordering;

/// Exponent of two of the last bit of the smallest product of two doubles.
const LAST_BIT: i32 = 2 * (f64::MIN_EXP - f64::MANTISSA_DIGITS as i32);
/// Bits of a digit. Each is kept in twice as many, so that no carry is lost in 2^62 sums.
const DIGIT: usize = u64::BITS as usize;
/// Digits of all products of two doubles, and room for their sum.
const DIGITS: usize = (2 * f64::MAX_EXP - LAST_BIT) as usize / DIGIT + 3;

/// A sum of products of finite doubles without rounding: its order to zero, and a double next to it; itself if it is one.
pub(crate) fn exact_sum(products: impl IntoIterator<Item = [f64; 2]>) -> (Ordering, f64) {
    // A fixed-point number that holds every bit of any product.
    let mut digits = [0i128; DIGITS];
    for factors in products {
        let [[a, a_place], [b, b_place]] = factors.map(parts);
        let (product, place) = (i128::from(a) * i128::from(b), (a_place + b_place) as usize);
        let (size, sign) = (product.unsigned_abs(), product.signum());
        for (half, digit) in [size as u64, (size >> DIGIT) as u64].into_iter().zip(place / DIGIT..)
        {
            let shifted = u128::from(half) << (place % DIGIT);
            digits[digit] += sign * i128::from(shifted as u64);
            digits[digit + 1] += sign * (shifted >> DIGIT) as i128;
        }
    }
    // Then each is at most half of a unit of the next one, of either sign, so that the last has the sign of the number.
    for k in 1..DIGITS {
        let carry = (digits[k - 1] + (1 << (DIGIT - 1))) >> DIGIT;
        digits[k - 1] -= carry << DIGIT;
        digits[k] += carry;
    }
    let digits = (0..DIGITS).rev().map(|k| (digits[k], k as i32));
    let mut digits = digits.filter(|(digit, _)| *digit != 0).peekable();
    let sign = digits.peek().map_or(Ordering::Equal, |(digit, _)| digit.cmp(&0));
    let value = digits.fold(0.0, |sum, (digit, k)| {
        // In two factors: one may be out of range.
        let exponent = DIGIT as i32 * k + LAST_BIT;
        let [half, rest] = [exponent / 2, exponent - exponent / 2].map(|k| f64::from(k).exp2());
        sum + digit as f64 * half * rest
    });
    (sign, value)
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
    let pairs = [(b, d), (c, b), (d, a), (a, c)];
    exact_sum(pairs.into_iter().flat_map(|(x, y)| cross(x, y))).0
}

/// More than the rounding of a cross product, relative to the sum of its two terms: `3 ε + 16 ε²` with ε = 2^-53
/// (Shewchuk 1997).
const ROUNDING: f64 = 2.0 * f64::EPSILON;
/// Above this size of the terms nothing that underflows counts.
const SMALLEST: f64 = 1e-280;

/// The products whose sum is the cross product of two points.
fn cross(a: Point, b: Point) -> [[f64; 2]; 2] {
    [[a[0], b[1]], [-a[1], b[0]]]
}

/// The area of triangles of the plane by their corners, counter-clockwise positive, without rounding but of the result.
pub(crate) fn area(corners: &[Point]) -> f64 {
    let sides = |of: &[Point]| [[of[0], of[1]], [of[1], of[2]], [of[2], of[0]]];
    let sides = corners.chunks_exact(3).flat_map(sides);
    0.5 * exact_sum(sides.flat_map(|[a, b]| cross(a, b))).1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(terms: &[[f64; 2]]) -> (Ordering, f64) {
        exact_sum(terms.iter().copied())
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
            assert_eq!(sum(terms).0, sign, "{terms:?}");
        }
    }

    #[test]
    fn sums_of_doubles_are_themselves() {
        for x in
            [0.0, 1.0, -1.0, 0.1, -1e300, 3e-200, 9_007_199_254_740_993.0, 1e-320, 2f64.powi(75)]
        {
            assert_eq!(sum(&[[x, 1.0]]).1, x);
            assert_eq!(sum(&[[x, 1.0], [1e9, 1e9], [-1.0, 1e18]]).1, x);
            assert_eq!(sum(&[[x, 0.5], [0.5, x]]).1, x);
        }
        // Of all bits and sizes, across every place where one digit ends.
        for exponent in -1022..1023 {
            for x in [1.0, 1.0f64.next_up(), 2.0f64.next_down(), 1.0 + 0.5f64.powi(26)] {
                let x = x * f64::from(exponent).exp2();
                assert_eq!(sum(&[[x, 1.0]]).1, x);
                assert_eq!(sum(&[[-1.0, x]]).1, -x);
                assert_eq!(sum(&[[x, 1.0], [-1.0, x]]).1, 0.0);
                assert_eq!(sum(&[[x, 1.0], [-1.0, x.next_up()]]).0, Ordering::Less);
                assert_eq!(sum(&[[x, 1.0], [-1.0, x.next_down()]]).0, Ordering::Greater);
            }
        }
        let many = |a, b| std::iter::repeat_n([a, b], 1000);
        let many = many(-1e308, 1e308).chain(many(1e308, 1e308)).chain([[0.1, 0.1]]);
        assert_eq!(exact_sum(many).1, 0.1 * 0.1);
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
        assert_eq!(area(fans.collect::<Vec<_>>().as_flattened()), 199.0 * 9.0);
        let [first, ..] = fan(1.0, 0.5, 0.3);
        assert_eq!(area(&first), 0.15);
        assert_eq!(area(&[first, [first[0], first[2], first[1]]].concat()), 0.0);
    }
}
