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
pub(crate) fn quadrant(arrow: Arrow) -> i32 {
    let is_first = |[from, to]: Arrow| to[0] > from[0] && to[1] >= from[1];
    (0..3).find(|&quadrant| is_first(arrow.map(|end| turned(end, -quadrant)))).unwrap_or(3)
}

/// The quarter turns, from -1 to 2, that are nearest to the angle from one vector to another.
pub(crate) fn nearest_quarters(a: Point, b: Point) -> i32 {
    let is_near = |[cos, sin]: Point| cos >= sin.abs();
    let near = |&quarters: &i32| is_near(turned(between(a, b), -quarters));
    [0, 2, 1].into_iter().find(near).unwrap_or(-1)
}

pub(crate) fn difference(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn length([x, y]: Point) -> f64 {
    x.hypot(y)
}

/// `conj(a) b`, whose argument is the angle from one vector to the other.
fn between(a: Point, b: Point) -> Point {
    [a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0]]
}

/// The angle from one vector to another, radians from -π to π.
pub(crate) fn angle(a: Point, b: Point) -> f64 {
    let [cos, sin] = between(a, b);
    sin.atan2(cos)
}

/// The angle between a vector and the nearer axis, degrees.
pub(crate) fn degrees_off_axis(vector: Point) -> f64 {
    let [u, v] = vector.map(f64::abs);
    u.min(v).atan2(u.max(v)).to_degrees()
}

/// Exponent of two to which the largest coordinate of an element is brought: products of two, and their
/// rounding errors down to a part in 10^290 of it, are in range.
const EXPONENT: i32 = 400;
/// Largest exponent of a factor: it and its inverse are doubles. It brings the smallest double of all to 10^-22.
const LARGEST_FACTOR: i32 = 1000;

/// Points of one element times a power of two, and that factor, so that what is computed from them depends on no other
/// element, and no product overflows or vanishes.
pub(crate) fn scaled<const N: usize>(points: [Point; N]) -> ([Point; N], f64) {
    let biased = (largest(&points).to_bits() >> (f64::MANTISSA_DIGITS - 1)) as i32;
    let factor = f64::from((EXPONENT + f64::MAX_EXP - 1 - biased).min(LARGEST_FACTOR)).exp2();
    (points.map(|p| p.map(|x| x * factor)), factor)
}

/// The largest coordinate; no number if one of them is none.
pub(crate) fn largest(points: &[Point]) -> f64 {
    points.as_flattened().iter().map(|x| x.abs()).max_by(f64::total_cmp).unwrap_or(0.0)
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
        assert_eq!(quadrant([[1.0, 2.0], [1.0, 2.0]]), 3);
        // Of points far from the origin.
        assert_eq!(quadrant([[1e300, 1.0], [1e300, 1.0f64.next_up()]]), 1);
        assert_eq!(quadrant([[1e300, 1.0], [1e300, 1.0f64.next_down()]]), 3);
    }

    #[test]
    fn the_nearest_quarters_by_hand() {
        let from = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            nearest_quarters([2.0, 1.0], [2.0 * cos - sin, 2.0 * sin + cos])
        };
        for (degrees, quarters) in [(0.0, 0), (44.0, 0), (46.0, 1), (134.0, 1), (136.0, 2)] {
            assert_eq!(from(degrees), quarters, "{degrees}");
            let back = if quarters == 2 { 2 } else { -quarters };
            assert_eq!(from(-degrees), back, "-{degrees}");
        }
        assert_eq!([[1.0, 1.0], [-1.0, 1.0]].map(|b| nearest_quarters([1.0, 0.0], b)), [0, 2]);
    }

    #[test]
    fn factors_undo_themselves() {
        for (x, exponent) in
            [(5e-324, -74.0), (2f64.powi(-600), 400.0), (4.0, 400.0), (1e308, 400.0)]
        {
            let (points, factor) = scaled([[x, -x], [0.25 * x, 0.0]]);
            assert_eq!(largest(&points).log2().floor(), exponent, "{x}");
            assert_eq!(points[0].map(|y| y / factor), [x, -x]);
        }
        assert_eq!(scaled([[0.0; 2]; 3]).0, [[0.0; 2]; 3]);
    }

    #[test]
    fn angles_by_hand() {
        assert_eq!(angle([2.0, 0.0], [0.0, 3.0]), std::f64::consts::FRAC_PI_2);
        assert_eq!(angle([0.0, 3.0], [2.0, 2.0]), -std::f64::consts::FRAC_PI_4);
        assert_eq!(length(difference([4.0, 6.0], [1.0, 2.0])), 5.0);
    }

    #[test]
    fn the_nearer_axis_counts() {
        for (degrees, off) in
            [(0.0, 0.0), (90.0, 0.0), (180.0, 0.0), (30.0, 30.0), (100.0, 10.0), (225.0, 45.0)]
        {
            let (sin, cos) = f64::to_radians(degrees).sin_cos();
            assert!((degrees_off_axis([3.0 * cos, 3.0 * sin]) - off).abs() < 1e-13, "{degrees}");
        }
        assert_eq!(degrees_off_axis([0.0, -2.0]), 0.0);
    }
}
