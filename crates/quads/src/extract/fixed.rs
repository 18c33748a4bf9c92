//! The plane in fixed point: every sum, quarter turn and orientation is exact.

/// Bits of the largest coordinate. A product of two differences has at most 114 bits, and what the
/// sweeps compute from it fits into an `i128`.
const COORDINATE_BITS: u32 = 56;
/// The most bits after the point: finer than the rounding of a coordinate of 16 in an `f64`.
const MOST_FRACTION_BITS: u32 = 48;
/// The largest coordinate that is taken, grid units. Cells are numbered by `i64`, far from overflow.
pub(super) const LARGEST_COORDINATE: f64 = (1u64 << 30) as f64;

/// A point, in units of `2^-bits` of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Point {
    pub(super) u: i64,
    pub(super) v: i64,
}

/// The unit of the fixed point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Unit {
    bits: u32,
}

impl Unit {
    /// The finest that is safe for coordinates up to `span` in size.
    pub(super) fn for_span(span: f64) -> Self {
        let integer_bits = (span.clamp(1.0, LARGEST_COORDINATE).log2().floor() as u32) + 2;
        Self { bits: (COORDINATE_BITS - integer_bits).min(MOST_FRACTION_BITS) }
    }

    /// One grid unit.
    pub(super) fn one(self) -> i64 {
        1 << self.bits
    }

    /// The nearest point.
    pub(super) fn round(self, uv: [f64; 2]) -> Point {
        let one = self.one() as f64;
        Point { u: (uv[0] * one).round() as i64, v: (uv[1] * one).round() as i64 }
    }

    /// A point of the grid.
    pub(super) fn grid_point(self, [i, j]: [i64; 2]) -> Point {
        Point { u: i << self.bits, v: j << self.bits }
    }

    /// The grid point here, if there is one.
    pub(super) fn as_grid_point(self, p: Point) -> Option<[i64; 2]> {
        let mask = self.one() - 1;
        ((p.u | p.v) & mask == 0).then_some([p.u >> self.bits, p.v >> self.bits])
    }

    /// Whether two points lie on one line of the grid.
    pub(super) fn is_on_line(self, a: Point, b: Point) -> bool {
        let is_line = |x: i64, y: i64| x == y && x & (self.one() - 1) == 0;
        is_line(a.u, b.u) || is_line(a.v, b.v)
    }

    /// Grid units.
    pub(super) fn to_f64(self, p: Point) -> [f64; 2] {
        let one = self.one() as f64;
        [p.u as f64 / one, p.v as f64 / one]
    }

    /// The largest integer not above `x`.
    pub(super) fn floor(self, x: i64) -> i64 {
        x >> self.bits
    }

    /// The smallest integer not below `x`.
    pub(super) fn ceil(self, x: i64) -> i64 {
        -((-x) >> self.bits)
    }
}

impl Point {
    /// Twice the signed area of a triangle: positive counter-clockwise.
    pub(super) fn orientation(a: Point, b: Point, c: Point) -> i128 {
        let [bu, bv] = [b.u - a.u, b.v - a.v].map(i128::from);
        let [cu, cv] = [c.u - a.u, c.v - a.v].map(i128::from);
        bu * cv - bv * cu
    }
}

/// A change of chart: a turn by quarters and a shift by whole grid units.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Transition {
    /// 0 to 3.
    pub(super) turns: u8,
    pub(super) shift: [i64; 2],
}

/// `i^turns` times a vector.
pub(super) fn turned<T: std::ops::Neg<Output = T>>(turns: u8, [x, y]: [T; 2]) -> [T; 2] {
    match turns % 4 {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

impl Transition {
    pub(super) const IDENTITY: Self = Self { turns: 0, shift: [0, 0] };

    /// The image of a point.
    pub(super) fn point(self, unit: Unit, p: Point) -> Point {
        let [u, v] = turned(self.turns, [p.u, p.v]);
        let shift = unit.grid_point(self.shift);
        Point { u: u + shift.u, v: v + shift.v }
    }

    /// The image of a grid point.
    pub(super) fn grid_point(self, p: [i64; 2]) -> [i64; 2] {
        let [i, j] = turned(self.turns, p);
        [i + self.shift[0], j + self.shift[1]]
    }

    /// The image of a cell; cells are named by their lowest corner.
    pub(super) fn cell(self, [i, j]: [i64; 2]) -> [i64; 2] {
        // Twice the centre is odd, and stays so.
        let [x, y] = turned(self.turns, [2 * i + 1, 2 * j + 1]);
        [(x - 1) / 2 + self.shift[0], (y - 1) / 2 + self.shift[1]]
    }

    /// This one, then another.
    pub(super) fn then(self, next: Self) -> Self {
        Self { turns: (self.turns + next.turns) % 4, shift: next.grid_point(self.shift) }
    }

    /// The way back.
    pub(super) fn inverse(self) -> Self {
        let turns = (4 - self.turns) % 4;
        let [i, j] = turned(turns, self.shift);
        Self { turns, shift: [-i, -j] }
    }

    /// The grid point that stays where it is, if there is just one and it is of the grid.
    pub(super) fn fixed_point(self) -> Option<[i64; 2]> {
        let [a, b] = self.shift;
        // (1 - i^turns) p = shift
        let doubled = match self.turns {
            0 => return None,
            1 => [a - b, a + b],
            2 => [a, b],
            _ => [a + b, b - a],
        };
        let is_even = doubled.iter().all(|x| x % 2 == 0);
        is_even.then_some(doubled.map(|x| x / 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transitions() -> Vec<Transition> {
        let shifts = [[0, 0], [3, -2], [-5, 1], [4, 4]];
        (0..4).flat_map(|turns| shifts.map(|shift| Transition { turns, shift })).collect()
    }

    #[test]
    fn transitions_are_a_group_that_moves_points_and_cells_alike() {
        let unit = Unit::for_span(100.0);
        let p = unit.round([2.25, -7.125]);
        for a in transitions() {
            assert_eq!(a.then(a.inverse()), Transition::IDENTITY);
            for b in transitions() {
                assert_eq!(a.then(b).point(unit, p), b.point(unit, a.point(unit, p)));
            }
            let [u, v] = unit.to_f64(a.point(unit, p));
            assert_eq!(a.cell([2, -8]), [u.floor() as i64, v.floor() as i64]);
            assert_eq!(
                unit.grid_point(a.grid_point([3, 5])),
                a.point(unit, unit.grid_point([3, 5]))
            );
        }
    }

    #[test]
    fn fixed_points_stay() {
        for a in transitions() {
            if let Some(p) = a.fixed_point() {
                assert_eq!(a.grid_point(p), p);
            }
        }
        let odd = Transition { turns: 1, shift: [1, 0] };
        assert_eq!(odd.fixed_point(), None, "(1 + i) / 2");
        let half = Transition { turns: 2, shift: [2, 1] };
        assert_eq!(half.fixed_point(), None, "1 + i / 2");
        assert_eq!(Transition { turns: 1, shift: [0, 2] }.fixed_point(), Some([-1, 1]));
    }

    #[test]
    fn rounding_and_integers() {
        for span in [0.5, 1.0, 700.0, LARGEST_COORDINATE] {
            let unit = Unit::for_span(span);
            assert!(span * (unit.one() as f64) < 2f64.powi(COORDINATE_BITS as i32));
            let p = unit.round([-1.25, 3.0]);
            assert_eq!(
                (unit.floor(p.u), unit.ceil(p.u), unit.floor(p.v), unit.ceil(p.v)),
                (-2, -1, 3, 3)
            );
            assert_eq!(unit.as_grid_point(p), None);
            assert_eq!(unit.as_grid_point(unit.round([-4.0, 3.0])), Some([-4, 3]));
            assert_eq!(unit.to_f64(p), [-1.25, 3.0]);
        }
    }
}
