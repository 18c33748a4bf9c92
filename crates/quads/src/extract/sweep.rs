//! Which cells and grid points a triangle or an edge meets, decided exactly.

use super::fixed::{Point, Unit};
use std::ops::Range;

/// The rows of cells whose inside meets that of the convex hull.
pub(super) fn rows(unit: Unit, hull: &[Point]) -> Range<i64> {
    let (low, high) = extent(hull.iter().map(|p| p.v));
    // A level segment between two rows meets one, on an isoline none.
    unit.floor(low)..unit.ceil(high).max(unit.floor(low))
}

/// The cells of a row of [`rows`] whose inside meets that of the hull: a triangle, an edge, or a point.
pub(super) fn cells_in_row(unit: Unit, hull: &[Point], row: i64) -> Range<i64> {
    let (bottom, top) = (row * unit.one(), (row + 1) * unit.one());
    let (mut first, mut end) = (i64::MAX, i64::MIN);
    for (k, &a) in hull.iter().enumerate() {
        if (bottom..=top).contains(&a.v) {
            first = first.min(unit.floor(a.u));
            end = end.max(unit.ceil(a.u));
        }
        let b = hull[(k + 1) % hull.len()];
        for level in [bottom, top] {
            if let Some(crossing) = Crossing::new(a, b, level) {
                first = first.min(crossing.floor(unit));
                end = end.max(crossing.ceil(unit));
            }
        }
    }
    first..end.max(first)
}

/// The grid points strictly inside a triangle, row by row.
pub(super) fn points_inside(unit: Unit, triangle: &[Point; 3]) -> Vec<[i64; 2]> {
    let (low, high) = extent(triangle.iter().map(|p| p.v));
    let mut points = Vec::new();
    for j in unit.floor(low) + 1..unit.ceil(high) {
        let level = j * unit.one();
        let (mut first, mut end) = (i64::MAX, i64::MIN);
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            if a.v == level {
                first = first.min(unit.floor(a.u));
                end = end.max(unit.ceil(a.u));
            }
            if let Some(crossing) = Crossing::new(a, b, level) {
                first = first.min(crossing.floor(unit));
                end = end.max(crossing.ceil(unit));
            }
        }
        points.extend((first.saturating_add(1)..end).map(|i| [i, j]));
    }
    points
}

/// The grid points strictly between the ends of an edge, from the first to the last.
pub(super) fn points_between(unit: Unit, [a, b]: [Point; 2]) -> Vec<[i64; 2]> {
    let mut points = Vec::new();
    if a.v == b.v {
        if a.v & (unit.one() - 1) == 0 {
            let (low, high) = (a.u.min(b.u), a.u.max(b.u));
            points.extend((unit.floor(low) + 1..unit.ceil(high)).map(|i| [i, unit.floor(a.v)]));
        }
    } else {
        let (low, high) = (a.v.min(b.v), a.v.max(b.v));
        for j in unit.floor(low) + 1..unit.ceil(high) {
            let crossing = Crossing::new(a, b, j * unit.one());
            points.extend(crossing.and_then(|c| c.integer(unit)).map(|i| [i, j]));
        }
    }
    if (b.v, b.u) < (a.v, a.u) {
        points.reverse();
    }
    points
}

fn extent(values: impl Iterator<Item = i64>) -> (i64, i64) {
    values.fold((i64::MAX, i64::MIN), |(low, high), x| (low.min(x), high.max(x)))
}

/// Where an edge strictly crosses a level: `u` is a fraction.
struct Crossing {
    numerator: i128,
    /// Positive.
    denominator: i128,
}

impl Crossing {
    fn new(a: Point, b: Point, level: i64) -> Option<Self> {
        let (a, b) = if a.v <= b.v { (a, b) } else { (b, a) };
        (a.v < level && level < b.v).then(|| {
            let (du, dv) = (i128::from(b.u - a.u), i128::from(b.v - a.v));
            Self { numerator: i128::from(a.u) * dv + i128::from(level - a.v) * du, denominator: dv }
        })
    }

    /// Of the crossing in grid units.
    fn floor(&self, unit: Unit) -> i64 {
        self.numerator.div_euclid(self.denominator * i128::from(unit.one())) as i64
    }

    fn ceil(&self, unit: Unit) -> i64 {
        -((-self.numerator).div_euclid(self.denominator * i128::from(unit.one()))) as i64
    }

    fn integer(&self, unit: Unit) -> Option<i64> {
        let floor = self.floor(unit);
        let is_integer = i128::from(floor) * self.denominator * i128::from(unit.one());
        (is_integer == self.numerator).then_some(floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> Unit {
        Unit::for_span(16.0)
    }

    fn hull<const N: usize>(points: [[f64; 2]; N]) -> [Point; N] {
        points.map(|p| unit().round(p))
    }

    fn cells(hull: &[Point]) -> Vec<[i64; 2]> {
        let in_row = |j| cells_in_row(unit(), hull, j).map(move |i| [i, j]);
        rows(unit(), hull).flat_map(in_row).collect()
    }

    #[test]
    fn cells_of_triangles() {
        // Half of a square of four cells: the diagonal goes through corners, and parts no cell off.
        let half = hull([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]);
        assert_eq!(cells(&half), [[0, 0], [1, 0], [0, 1]]);
        assert_eq!(cells(&hull([[0.1, 0.1], [0.9, 0.2], [0.4, 0.8]])), [[0, 0]]);
        assert_eq!(
            cells(&hull([[-0.5, -0.5], [0.5, -0.5], [0.0, 0.5]])),
            [[-1, -1], [0, -1], [-1, 0], [0, 0]]
        );
        // A needle along an isoline, and one across.
        assert_eq!(cells(&hull([[0.0, 1.0], [3.0, 1.0], [3.0, 1.001]])), [[0, 1], [1, 1], [2, 1]]);
        assert_eq!(cells(&hull([[0.5, 0.5], [0.5, 2.5], [0.499, 2.5]])), [[0, 0], [0, 1], [0, 2]]);
    }

    #[test]
    fn cells_of_edges_and_points() {
        assert_eq!(cells(&hull([[0.5, 0.5], [2.5, 0.5]])), [[0, 0], [1, 0], [2, 0]]);
        assert_eq!(cells(&hull([[0.0, 0.0], [2.0, 2.0]])), [[0, 0], [1, 1]]);
        assert_eq!(cells(&hull([[0.0, 1.0], [3.0, 1.0]])), [[0i64; 2]; 0]);
        assert_eq!(cells(&hull([[1.0, 0.0], [1.0, 3.0]])), [[0i64; 2]; 0]);
        assert_eq!(cells(&hull([[1.5, 0.0], [1.5, 2.0]])), [[1, 0], [1, 1]]);
        assert_eq!(cells(&hull([[1.5, 2.5]; 3])), [[1, 2]]);
        assert_eq!(cells(&hull([[1.5, 2.0]; 3])), [[0i64; 2]; 0]);
    }

    #[test]
    fn points_of_triangles_and_edges() {
        let big = hull([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]]);
        assert_eq!(points_inside(unit(), &big), [[1, 1], [2, 1], [1, 2]]);
        let between = |a, b| points_between(unit(), hull([a, b]));
        assert_eq!(between([4.0, 0.0], [0.0, 4.0]), [[3, 1], [2, 2], [1, 3]]);
        assert_eq!(between([0.0, 4.0], [4.0, 0.0]), [[1, 3], [2, 2], [3, 1]]);
        assert_eq!(between([2.5, 1.0], [-0.5, 1.0]), [[2, 1], [1, 1], [0, 1]]);
        assert_eq!(between([1.0, -1.5], [1.0, 1.0]), [[1, -1], [1, 0]]);
        assert_eq!(between([0.5, 0.0], [0.5, 3.0]), [[0i64; 2]; 0]);
        assert_eq!(between([0.0, 0.5], [3.0, 0.5]), [[0i64; 2]; 0]);
    }

    #[test]
    fn one_part_in_the_last_place_decides() {
        let one = unit().one();
        let at = |u, v| Point { u, v };
        // A side of the triangle passes to the left of (1, 1), through it, and to the right of it.
        for (apex, is_inside, is_between) in [(0, true, false), (1, false, true), (2, false, false)]
        {
            let apex = at(2 * (one + apex), 2 * (one + 1));
            let inside = points_inside(unit(), &[at(0, 0), at(4 * one, 0), apex]);
            assert_eq!(inside.contains(&[1, 1]), is_inside);
            assert_eq!(points_between(unit(), [at(0, 0), apex]).contains(&[1, 1]), is_between);
        }
    }
}
