//! Points of the plane, quarter turns, quadrants, and units that fit a few points.

/// A point or vector of the plane.
pub(crate) type Point = [f64; 2];

/// The two ends of a vector.
pub(crate) type Arrow = [Point; 2];

/// Turned by quarters counter-clockwise, exactly.
pub(crate) fn turned([x, y]: Point, quarters: i32) -> Point {
    match quarters.rem_euclid(4) {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

/// The quadrant that an arrow points into, from 0 to 3 counter-clockwise, with the axis on its right; 3 if it is a
/// point. It takes comparisons alone, so that it is exact.
pub(crate) fn quadrant([from, to]: Arrow) -> i32 {
    if to[0] > from[0] && to[1] >= from[1] {
        0
    } else if to[1] > from[1] {
        1
    } else if to[0] < from[0] {
        2
    } else {
        3
    }
}

pub(crate) fn difference(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn length([x, y]: Point) -> f64 {
    x.hypot(y)
}

/// `conj(a) b`, whose argument is the angle from one vector to the other.
pub(crate) fn between(a: Point, b: Point) -> Point {
    [a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0]]
}

/// The angle from one vector to another, radians from -π to π.
pub(crate) fn angle(a: Point, b: Point) -> f64 {
    let [cos, sin] = between(a, b);
    sin.atan2(cos)
}

/// Exponent of two to which the largest coordinate of an element is brought: products of two, and their
/// rounding errors down to a part in 10^290 of it, are in range.
const EXPONENT: i32 = 400;

/// Points of one element in a unit of their own, a power of two, so that what is computed from them
/// depends on no other element, and no product overflows or vanishes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InUnit<const N: usize> {
    pub(crate) points: [Point; N],
    /// Exponent of the unit.
    exponent: i32,
}

impl<const N: usize> InUnit<N> {
    pub(crate) fn new(points: [Point; N]) -> Self {
        let exponent = exponent(largest(&points)) - EXPONENT;
        Self { points: points.map(|p| p.map(|x| shifted(x, -exponent))), exponent }
    }

    /// The largest coordinate, in this unit.
    pub(crate) fn reach(&self) -> f64 {
        largest(&self.points)
    }

    /// A vector in the unit of the points that were given.
    pub(crate) fn in_given_unit(&self, vector: Point) -> Point {
        vector.map(|x| shifted(x, self.exponent))
    }
}

/// The largest coordinate.
fn largest(points: &[Point]) -> f64 {
    points.iter().flatten().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// Exponent of two of a number, 0 of zero; those of subnormal numbers count as the smallest.
fn exponent(x: f64) -> i32 {
    let fraction_bits = f64::MANTISSA_DIGITS - 1;
    if x == 0.0 { 0 } else { ((x.to_bits() >> fraction_bits) & 0x7ff) as i32 - (f64::MAX_EXP - 1) }
}

/// `x 2^k`, in two factors: one may be out of range.
pub(crate) fn shifted(x: f64, k: i32) -> f64 {
    let half = k / 2;
    x * f64::from(half).exp2() * f64::from(k - half).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrants_turn_with_their_arrows() {
        let quadrants = [([3.0, 0.0], 0), ([2.0, 1e-300], 0), ([1.0, 5.0], 0), ([-1e-300, 5.0], 1)];
        for (vector, expected) in quadrants {
            for quarters in -5..6 {
                let found = quadrant([turned([0.0; 2], quarters), turned(vector, quarters)]);
                assert_eq!(found, (expected + quarters).rem_euclid(4), "{vector:?} {quarters}");
            }
        }
        // Of points far from the origin.
        assert_eq!(quadrant([[1e300, 1.0], [1e300, 1.0f64.next_up()]]), 1);
        assert_eq!(quadrant([[1e300, 1.0], [1e300, 1.0f64.next_down()]]), 3);
    }

    #[test]
    fn units_undo_themselves() {
        for x in [5e-324, 1e-310, 3.7, 1e308] {
            let unit = InUnit::new([[x, -x], [0.25 * x, 0.0]]);
            assert!((340.0..=401.0).contains(&unit.reach().log2()), "{x}");
            assert_eq!(unit.in_given_unit(unit.points[0]), [x, -x]);
        }
        assert_eq!(InUnit::new([[0.0; 2]; 3]).points, [[0.0; 2]; 3]);
    }

    #[test]
    fn angles_by_hand() {
        assert_eq!(angle([2.0, 0.0], [0.0, 3.0]), std::f64::consts::FRAC_PI_2);
        assert_eq!(angle([0.0, 3.0], [2.0, 2.0]), -std::f64::consts::FRAC_PI_4);
        assert_eq!(length(difference([4.0, 6.0], [1.0, 2.0])), 5.0);
    }
}
