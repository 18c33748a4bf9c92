//! Signs that do not depend on the size of the numbers, nor on rounding.

use num_complex::Complex64;
use std::cmp::Ordering;

/// A point of the plane.
pub(super) type Point = [f64; 2];

/// Exponent of two to which the largest coordinate of an element is brought: products of two, and their
/// rounding errors down to a part in 10^290 of it, are in range.
const EXPONENT: i32 = 400;
const MANTISSA_BITS: u64 = 52;
const EXPONENT_BIAS: i32 = 1023;

/// Points of one element in a unit of their own, a power of two, so that what is computed from them
/// depends on no other element, and no product overflows or vanishes.
#[derive(Debug, Clone, Copy)]
pub(super) struct InUnit<const N: usize> {
    pub(super) points: [Complex64; N],
    /// Exponent of the unit.
    exponent: i32,
}

impl<const N: usize> InUnit<N> {
    pub(super) fn new(points: [Point; N]) -> Self {
        let exponent = exponent(largest(&points)) - EXPONENT;
        let scaled = |[u, v]: Point| Complex64::new(shifted(u, -exponent), shifted(v, -exponent));
        Self { points: points.map(scaled), exponent }
    }

    /// The largest coordinate, in this unit.
    pub(super) fn reach(&self) -> f64 {
        self.points.iter().fold(0.0, |reach, z| reach.max(z.re.abs()).max(z.im.abs()))
    }

    /// A vector in the unit of the points that were given.
    pub(super) fn in_given_unit(&self, z: Complex64) -> Point {
        [z.re, z.im].map(|x| shifted(x, self.exponent))
    }
}

impl InUnit<3> {
    /// The orientation of a triangle: positive counter-clockwise, zero if it is collapsed.
    pub(super) fn orientation(&self) -> f64 {
        let [a, b, c] = self.points.map(|z| robust::Coord { x: z.re, y: z.im });
        robust::orient2d(a, b, c)
    }
}

/// The largest coordinate.
fn largest(points: &[Point]) -> f64 {
    points.iter().flatten().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// Exponent of two of a number, 0 of zero; those of subnormal numbers count as the smallest.
fn exponent(x: f64) -> i32 {
    if x == 0.0 { 0 } else { ((x.to_bits() >> MANTISSA_BITS) & 0x7ff) as i32 - EXPONENT_BIAS }
}

/// `x 2^k`, in two factors: one may be out of range.
fn shifted(x: f64, k: i32) -> f64 {
    let half = k / 2;
    x * f64::from(half).exp2() * f64::from(k - half).exp2()
}

/// A vector given by the points it runs between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arrow {
    pub(super) from: Point,
    pub(super) to: Point,
}

impl Arrow {
    /// Turned by quarters, exactly.
    pub(super) fn turned(self, quarters: i32) -> Self {
        let turned = |[x, y]: Point| match quarters.rem_euclid(4) {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        Self { from: turned(self.from), to: turned(self.to) }
    }

    /// On which side of this vector another one points: left is greater.
    pub(super) fn side_of(&self, other: &Self) -> Ordering {
        let ([ax, ay], [bx, by]) = (self.parts(), other.parts());
        let products = [(ax, by, 1.0), (ay, bx, -1.0)];
        let terms = products.iter().flat_map(|&(a, b, sign)| {
            let pairs = [(a[0], b[0]), (a[0], b[1]), (a[1], b[0]), (a[1], b[1])];
            pairs.into_iter().flat_map(move |(x, y)| {
                let product = sign * x * y;
                [product, (sign * x).mul_add(y, -product)]
            })
        });
        sign_of_sum(terms)
    }

    /// Whether another vector of the same or the opposite direction has the same.
    pub(super) fn agrees_with(&self, other: &Self) -> bool {
        (0..2).all(|k| {
            let rises = |arrow: &Self| arrow.to[k].partial_cmp(&arrow.from[k]);
            rises(self) == rises(other)
        })
    }

    /// Both coordinates in a unit of their own, each as a sum of two doubles.
    fn parts(&self) -> [[f64; 2]; 2] {
        let [from, to] = InUnit::new([self.from, self.to]).points;
        [difference(to.re, from.re), difference(to.im, from.im)]
    }
}

/// `a - b`, rounded, and the rounding error (Knuth's two-sum).
fn difference(a: f64, b: f64) -> [f64; 2] {
    let rounded = a - b;
    let b_part = a - rounded;
    let a_part = rounded + b_part;
    [rounded, (a - a_part) + (b_part - b)]
}

/// The sign of a sum without rounding, by an expansion whose parts do not overlap (Shewchuk 1997).
fn sign_of_sum(terms: impl Iterator<Item = f64>) -> Ordering {
    let mut parts: Vec<f64> = Vec::new();
    for term in terms {
        let mut carry = term;
        for part in &mut parts {
            let [sum, error] = difference(carry, -*part);
            (*part, carry) = (error, sum);
        }
        parts.push(carry);
        parts.retain(|&part| part != 0.0);
    }
    let leading = parts.last().copied().unwrap_or_default();
    leading.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrow(from: Point, to: Point) -> Arrow {
        Arrow { from, to }
    }

    #[test]
    fn sides_are_decided_to_the_last_bit() {
        // Parallel in real numbers, with ends that no double difference holds.
        let a = arrow([1e-30, 1.0], [3.0, 1.0 + 2f64.powi(-40)]);
        for scale in [1e-290, 1.0, 1e290] {
            let scaled = |p: Point| p.map(|x| x * scale);
            let b = arrow(scaled(a.from), scaled(a.to));
            assert_eq!(a.side_of(&a), Ordering::Equal);
            assert_eq!(a.side_of(&b.turned(1)), Ordering::Greater);
            assert_eq!(a.side_of(&b.turned(-1)), Ordering::Less);
        }
        let diagonal = arrow([0.1, 0.1], [0.7, 0.7]);
        let with = |y: f64| diagonal.side_of(&arrow([0.0, 0.0], [0.3, y]));
        assert_eq!(with(0.3), Ordering::Equal);
        assert_eq!(with(0.3f64.next_up()), Ordering::Greater);
        assert_eq!(with(0.3f64.next_down()), Ordering::Less);
        // 1e-30 less than where the difference of doubles would say so.
        let flat = arrow([0.0, 0.0], [1.0, 0.0]);
        assert_eq!(flat.side_of(&arrow([5.0, 1e-30], [6.0, 0.0])), Ordering::Less);
        assert_eq!(
            arrow([0.0; 2], [1.0; 2]).side_of(&arrow([1.0, 1e-30], [2.0, 1.0])),
            Ordering::Less
        );
    }

    #[test]
    fn opposite_vectors_disagree() {
        let a = arrow([0.3, 0.2], [0.7, -0.2]);
        assert!(a.agrees_with(&a) && !a.agrees_with(&a.turned(2)));
        let level = arrow([0.0, 5.0], [1.0, 5.0]);
        assert!(level.agrees_with(&arrow([7.0, 1.0], [8.0, 1.0])));
    }

    #[test]
    fn sums_are_exact() {
        let sign = |terms: &[f64]| sign_of_sum(terms.iter().copied());
        assert_eq!(sign(&[1e16, 1.0, -1e16, -1.0, 1e-300]), Ordering::Greater);
        assert_eq!(sign(&[1e16, 1.0, -1e16, -1.0]), Ordering::Equal);
        assert_eq!(sign(&[]), Ordering::Equal);
        assert_eq!(sign(&[3.0, -1e-320, -3.0]), Ordering::Less);
    }

    #[test]
    fn units_undo_themselves() {
        for x in [5e-324, 1e-310, 3.7, 1e308] {
            let unit = InUnit::new([[x, -x], [0.25 * x, 0.0]]);
            assert!((340.0..=401.0).contains(&unit.reach().log2()), "{x}");
            assert_eq!(unit.in_given_unit(unit.points[0]), [x, -x]);
        }
        assert_eq!(InUnit::new([[0.0; 2]; 3]).orientation(), 0.0);
    }
}
