//! Filling triangles, lines and discs into a band of samples.

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

/// The id of a sample that shows nothing.
pub(crate) const EMPTY: u32 = u32::MAX;
/// Ids from here on are of lines, balls and dots; those before are of faces.
pub(crate) const FIRST_OVERLAY: u32 = 1 << 31;

/// Whole rows of samples.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub(crate) width: usize,
    /// The first row, counted in samples from the top of the picture.
    pub(crate) first_row: usize,
    pub(crate) rows: usize,
}

impl Window {
    /// Visits the samples whose centres lie in a triangle, with their places in the window and
    /// the depths of the triangle.
    ///
    /// An edge shared by two triangles crosses each row at the same place in both, so no sample
    /// falls between them.
    pub(crate) fn scan(&self, points: [ScreenPoint; 3], mut visit: impl FnMut(usize, f32)) {
        let [a, b, c] = points;
        let (low, high) = range(points.map(|p| p.y));
        let rows = centres_within(low, high, self.first_row, self.rows);
        if rows.is_empty() {
            return;
        }
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 {
            return;
        }
        let (near_low, near_high) = range(points.map(|p| p.depth));
        let (db, dc) = (b.depth - a.depth, c.depth - a.depth);
        let slope_x = (db * (c.y - a.y) - dc * (b.y - a.y)) / area;
        let slope_y = (dc * (b.x - a.x) - db * (c.x - a.x)) / area;
        let edges = [[a, b], [b, c], [c, a]].map(|[p, q]| if p.y <= q.y { [p, q] } else { [q, p] });
        for row in rows {
            let y = (self.first_row + row) as f64 + 0.5;
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for [p, q] in edges {
                if p.y <= y && y <= q.y && p.y < q.y {
                    let x = p.x + (y - p.y) / (q.y - p.y) * (q.x - p.x);
                    left = left.min(x);
                    right = right.max(x);
                }
            }
            let start = a.depth + slope_y * (y - a.y);
            for column in centres_within(left, right, 0, self.width) {
                let depth = start + slope_x * (column as f64 + 0.5 - a.x);
                let depth = depth.max(near_low).min(near_high) as f32;
                visit(row * self.width + column, depth);
            }
        }
    }
}

/// Whole rows of samples: what is seen in each, and how near.
#[derive(Debug)]
pub(crate) struct Band {
    pub(crate) window: Window,
    ids: Vec<u32>,
    depths: Vec<f32>,
}

/// The samples whose centres lie in `[low, high]`, cut to `[first, first + count)`, relative to it.
fn centres_within(low: f64, high: f64, first: usize, count: usize) -> Range<usize> {
    let clamp = |x: f64| (x - first as f64).clamp(0.0, count as f64) as usize;
    clamp((low - 0.5).ceil())..clamp((high - 0.5).floor() + 1.0)
}

impl Band {
    pub(crate) fn new(window: Window) -> Self {
        let samples = window.width * window.rows;
        Self { window, ids: vec![EMPTY; samples], depths: vec![f32::NEG_INFINITY; samples] }
    }

    /// The ids of one row, counted within the band.
    pub(crate) fn ids(&self, row: usize) -> &[u32] {
        &self.ids[row * self.window.width..(row + 1) * self.window.width]
    }

    /// Whether a triangle between these heights may touch the band.
    pub(crate) fn meets(&self, low: f64, high: f64) -> bool {
        let first = self.window.first_row as f64;
        low <= first + self.window.rows as f64 && high >= first
    }

    /// The height of the centres of a row, counted within the band.
    pub(crate) fn centre(&self, row: usize) -> f64 {
        (self.window.first_row + row) as f64 + 0.5
    }

    fn rows_within(&self, low: f64, high: f64) -> Range<usize> {
        centres_within(low, high, self.window.first_row, self.window.rows)
    }

    fn columns_within(&self, low: f64, high: f64) -> Range<usize> {
        centres_within(low, high, 0, self.window.width)
    }

    /// Fills a triangle where it is the nearest so far; of equals the first stays.
    pub(crate) fn fill_triangle(&mut self, points: [ScreenPoint; 3], id: u32) {
        let (ids, depths) = (&mut self.ids, &mut self.depths);
        self.window.scan(points, |at, depth| {
            if depth > depths[at] {
                depths[at] = depth;
                ids[at] = id;
            }
        });
    }

    /// Draws a line with round ends over what is there, leaving the depths as they are.
    ///
    /// `slack(id, dx, dy)` says by how much the line may lie behind a sample that shows `id`, when
    /// the sample is off the middle of the line by `(dx, dy)`.
    pub(crate) fn draw_line(
        &mut self,
        [a, b]: [ScreenPoint; 2],
        half_width: f64,
        id: u32,
        slack: impl Fn(u32, f64, f64) -> f64,
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
                let (off_x, off_y) = (x - a.x - t * dx, y - a.y - t * dy);
                if off_x * off_x + off_y * off_y > half_width * half_width {
                    continue;
                }
                let at = row * self.window.width + column;
                let depth = a.depth + t * (b.depth - a.depth);
                if depth + slack(self.ids[at], off_x, off_y) >= f64::from(self.depths[at]) {
                    self.ids[at] = id;
                }
            }
        }
    }

    /// Draws a ball that looks like a disc of the given radius in samples: its middle has the
    /// depth of `centre`, and it bulges towards the viewer by `bulge`. It hides what lies deeper.
    pub(crate) fn draw_ball(&mut self, centre: ScreenPoint, radius: f64, bulge: f64, id: u32) {
        for row in self.rows_within(centre.y - radius, centre.y + radius) {
            let dy = self.centre(row) - centre.y;
            let half = (radius * radius - dy * dy).max(0.0).sqrt();
            for column in self.columns_within(centre.x - half, centre.x + half) {
                let dx = column as f64 + 0.5 - centre.x;
                let height = (1.0 - (dx * dx + dy * dy) / (radius * radius)).max(0.0).sqrt();
                let depth = (centre.depth + bulge * height) as f32;
                let at = row * self.window.width + column;
                if depth >= self.depths[at] {
                    self.depths[at] = depth;
                    self.ids[at] = id;
                }
            }
        }
    }
}

/// The least and the greatest of three.
pub(crate) fn range([a, b, c]: [f64; 3]) -> (f64, f64) {
    (a.min(b).min(c), a.max(b).max(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Window = Window { width: 40, first_row: 0, rows: 40 };

    fn point(x: f64, y: f64, depth: f64) -> ScreenPoint {
        ScreenPoint { x, y, depth, inverse_w: 1.0 }
    }

    #[test]
    fn a_fan_leaves_no_sample_out() {
        let rim = [[1.3, 2.1], [38.7, 1.2], [37.9, 38.8], [2.2, 37.7]];
        for hub in [[20.5, 20.5], [7.1, 30.3], [20.123_456_789, 11.5]] {
            let mut band = Band::new(WINDOW);
            for k in 0..4 {
                let corners = [hub, rim[k], rim[(k + 1) % 4]];
                band.fill_triangle(corners.map(|[x, y]| point(x, y, 0.0)), k as u32);
            }
            for row in 4..36 {
                assert!(band.ids(row)[4..36].iter().all(|&id| id < 4), "row {row}");
            }
            assert_eq!(band.ids(0), [EMPTY; 40]);
        }
    }

    #[test]
    fn the_nearest_depth_wins_whatever_the_order() {
        // Two planes that cross in the middle of the picture.
        let rising = [point(0.0, 0.0, 0.0), point(80.0, 0.0, 80.0), point(0.0, 80.0, 0.0)];
        let level = rising.map(|p| ScreenPoint { depth: 20.0, ..p });
        for order in [[0, 1], [1, 0]] {
            let mut band = Band::new(WINDOW);
            for id in order {
                band.fill_triangle([level, rising][id], id as u32);
            }
            assert_eq!((band.ids(5)[10], band.ids(5)[30]), (0, 1));
        }
    }

    #[test]
    fn lines_have_their_width_and_stay_behind_what_hides_them() {
        let mut band = Band::new(WINDOW);
        let wall = [point(20.0, -50.0, 5.0), point(90.0, 20.0, 5.0), point(20.0, 90.0, 5.0)];
        band.fill_triangle(wall, 0);
        band.draw_line([point(2.0, 10.0, 0.0), point(38.0, 10.0, 0.0)], 2.0, 7, |_, _, _| 1.0);
        let column: Vec<bool> = (0..40).map(|row| band.ids(row)[10] == 7).collect();
        assert_eq!(column.iter().filter(|&&c| c).count(), 4);
        assert!(column[8..12].iter().all(|&c| c));
        assert_eq!(band.ids(10)[30], 0);
        band.draw_line([point(2.0, 10.0, 0.0), point(38.0, 10.0, 0.0)], 2.0, 7, |_, _, _| 6.0);
        assert_eq!(band.ids(10)[30], 7);
    }
}
