//! The cells of a grid that triangles, lines and discs cover.

use std::ops::Range;

/// A projected point, in units of samples; `y` grows downwards.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ScreenPoint {
    pub(crate) x: f64,
    pub(crate) y: f64,
    /// Greater is nearer; linear on the screen over any plane of space.
    pub(crate) depth: f64,
    /// One over the distance along the view, for perspective-correct interpolation.
    pub(crate) inverse_w: f64,
}

/// Whole rows of a grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub(crate) width: usize,
    /// The first row, counted from the top of the picture.
    pub(crate) first_row: usize,
    pub(crate) rows: usize,
}

/// The depths of a triangle along a row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ramp {
    first: f64,
    slope: f64,
    low: f64,
    high: f64,
}

impl Ramp {
    /// The depth so many samples after the first.
    pub(crate) fn at(&self, after: u32) -> f32 {
        let depth = self.first + self.slope * f64::from(after);
        let depth = if depth < self.low { self.low } else { depth };
        (if depth > self.high { self.high } else { depth }) as f32
    }
}

/// A side of a triangle, from its upper end.
#[derive(Clone, Copy)]
struct Side {
    x: f64,
    y: f64,
    slope: f64,
}

impl Side {
    fn new([p, q]: [ScreenPoint; 2]) -> Self {
        Self { x: p.x, y: p.y, slope: (q.x - p.x) / (q.y - p.y) }
    }

    fn at(self, y: f64) -> f64 {
        self.x + (y - self.y) * self.slope
    }
}

/// The corners of a triangle from top to bottom; of equal height, as they come.
fn from_top([a, b, c]: [ScreenPoint; 3]) -> [ScreenPoint; 3] {
    let [a, b] = if b.y < a.y { [b, a] } else { [a, b] };
    let [b, c] = if c.y < b.y { [c, b] } else { [b, c] };
    let [a, b] = if b.y < a.y { [b, a] } else { [a, b] };
    [a, b, c]
}

impl Window {
    /// Visits the cells whose centres lie in a triangle, row by row: the row, counted within the window, its columns
    /// and the depths of the triangle there.
    ///
    /// An edge shared by two triangles crosses each row at the same place in both, so no centre
    /// falls between them.
    pub(crate) fn scan(
        &self,
        points: [ScreenPoint; 3],
        mut visit: impl FnMut(usize, Range<usize>, Ramp),
    ) {
        let [a, b, c] = points;
        let (low, high) = range(points.map(|p| p.y));
        let rows = centres_within(low, high, self.first_row, self.rows);
        if rows.is_empty() {
            return;
        }
        let (left, right) = range(points.map(|p| p.x));
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if centres_within(left, right, 0, self.width).is_empty() || area == 0.0 {
            return;
        }
        let (near_low, near_high) = range(points.map(|p| p.depth));
        let (db, dc) = (b.depth - a.depth, c.depth - a.depth);
        let slope_x = (db * (c.y - a.y) - dc * (b.y - a.y)) / area;
        let slope_y = (dc * (b.x - a.x) - db * (c.x - a.x)) / area;
        let [top, middle, bottom] = from_top(points);
        let [long, upper, lower] = [[top, bottom], [top, middle], [middle, bottom]].map(Side::new);
        for row in rows {
            let y = (self.first_row + row) as f64 + 0.5;
            let upper_half = y < middle.y || middle.y == bottom.y;
            let ends = [long.at(y), if upper_half { upper } else { lower }.at(y)];
            let (left, right) = if ends[0] <= ends[1] { (0, 1) } else { (1, 0) };
            let columns = centres_within(ends[left], ends[right], 0, self.width);
            if columns.is_empty() {
                continue;
            }
            let ramp = Ramp {
                first: a.depth + slope_y * (y - a.y) + slope_x * (columns.start as f64 + 0.5 - a.x),
                slope: slope_x,
                low: near_low,
                high: near_high,
            };
            visit(row, columns, ramp);
        }
    }

    /// The height of the centres of a row, counted within the window.
    fn centre(&self, row: usize) -> f64 {
        (self.first_row + row) as f64 + 0.5
    }

    pub(crate) fn rows_within(&self, low: f64, high: f64) -> Range<usize> {
        centres_within(low, high, self.first_row, self.rows)
    }

    pub(crate) fn columns_within(&self, low: f64, high: f64) -> Range<usize> {
        centres_within(low, high, 0, self.width)
    }

    /// Visits the cells whose centres are near a line: row and column, how far along the line from 0 to 1 their nearest
    /// point of it is, and how far from it they are, `x` and `y`.
    pub(crate) fn trace_line(
        &self,
        [a, b]: [ScreenPoint; 2],
        half_width: f64,
        mut visit: impl FnMut([usize; 2], f64, [f64; 2]),
    ) {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let length2 = dx * dx + dy * dy;
        let along = |t: f64| a.x + t.clamp(0.0, 1.0) * dx;
        for row in self.rows_within(a.y.min(b.y) - half_width, a.y.max(b.y) + half_width) {
            let y = self.centre(row);
            let reach = if dy.abs() > half_width * 1e-6 {
                [along((y - half_width - a.y) / dy), along((y + half_width - a.y) / dy)]
            } else {
                [a.x, b.x]
            };
            let [low, high] = [reach[0].min(reach[1]), reach[0].max(reach[1])];
            for column in self.columns_within(low - half_width, high + half_width) {
                let x = column as f64 + 0.5;
                let t = if length2 > 0.0 {
                    (((x - a.x) * dx + (y - a.y) * dy) / length2).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let off = [x - a.x - t * dx, y - a.y - t * dy];
                if off[0] * off[0] + off[1] * off[1] <= half_width * half_width {
                    visit([row, column], t, off);
                }
            }
        }
    }

    /// Visits the cells whose centres lie in a disc: row and column, and how high a ball of radius 1 is there.
    pub(crate) fn trace_ball(
        &self,
        centre: ScreenPoint,
        radius: f64,
        mut visit: impl FnMut([usize; 2], f64),
    ) {
        for row in self.rows_within(centre.y - radius, centre.y + radius) {
            let dy = self.centre(row) - centre.y;
            let half = (radius * radius - dy * dy).max(0.0).sqrt();
            for column in self.columns_within(centre.x - half, centre.x + half) {
                let dx = column as f64 + 0.5 - centre.x;
                let height = (1.0 - (dx * dx + dy * dy) / (radius * radius)).max(0.0).sqrt();
                visit([row, column], height);
            }
        }
    }
}

/// The centres that lie in `[low, high]`, cut to `[first, first + count)`, relative to it.
fn centres_within(low: f64, high: f64, first: usize, count: usize) -> Range<usize> {
    // By conversions to integers: without SSE 4.1 rounding is a call.
    let clamp = |x: f64| (x - 0.5 - first as f64).clamp(-1.0, count as f64);
    let (low, high) = (clamp(low), clamp(high));
    let up = low as u32;
    let start = up + u32::from(f64::from(up) < low);
    let end = if high < 0.0 { 0 } else { (high as u32 + 1).min(count as u32) };
    start as usize..end as usize
}

/// The least and the greatest of three.
pub(crate) fn range([a, b, c]: [f64; 3]) -> (f64, f64) {
    let (low, high) = if b < a { (b, a) } else { (a, b) };
    (if c < low { c } else { low }, if c > high { c } else { high })
}
