//! What bands of pixels show: triangles, lines and balls, in samples where something ends.

use std::ops::Range;

use crate::raster::{ScreenPoint, Window, range};

/// The id of a sample that shows nothing.
pub(crate) const EMPTY: u32 = u32::MAX;
/// Ids from here on are of lines, balls and dots; those before are of faces.
pub(crate) const FIRST_OVERLAY: u32 = 1 << 31;

/// The pixels of whole rows in which something ends or lies over the surface. All are in units of samples.
#[derive(Debug)]
pub(crate) struct Marks {
    pixels: Window,
    samples: Window,
    per_pixel: usize,
    marked: Vec<bool>,
}

/// The samples nearest to a line on either side are no farther from it than this.
const BESIDE: f64 = 0.75;

/// A line on the screen.
#[derive(Debug)]
pub(crate) struct Line {
    pub(crate) ends: [ScreenPoint; 2],
    pub(crate) half_width: f64,
    pub(crate) id: u32,
}

impl Line {
    /// The least and the greatest height that it may mark.
    pub(crate) fn span(&self) -> (f64, f64) {
        let [a, b] = self.ends.map(|p| p.y);
        let beside = self.half_width.max(BESIDE);
        (a.min(b) - beside, a.max(b) + beside)
    }
}

impl Marks {
    pub(crate) fn new(pixels: Window, per_pixel: usize) -> Self {
        let samples = Window {
            width: pixels.width * per_pixel,
            first_row: pixels.first_row * per_pixel,
            rows: pixels.rows * per_pixel,
        };
        Self { pixels, samples, per_pixel, marked: vec![false; pixels.width * pixels.rows] }
    }

    /// Marks pixels of which a line parts the samples, or covers some.
    pub(crate) fn line(&mut self, ends: [ScreenPoint; 2], half_width: f64) {
        let Self { pixels, samples, per_pixel, marked } = self;
        samples.trace_line(ends, half_width.max(BESIDE), |[row, column], _, _| {
            marked[row / *per_pixel * pixels.width + column / *per_pixel] = true;
        });
    }

    pub(crate) fn ball(&mut self, centre: ScreenPoint, radius: f64) {
        let Self { pixels, samples, per_pixel, marked } = self;
        samples.trace_ball(centre, radius, |[row, column], _| {
            marked[row / *per_pixel * pixels.width + column / *per_pixel] = true;
        });
    }

    pub(crate) fn triangle(&mut self, points: [ScreenPoint; 3]) {
        let Self { pixels, samples, per_pixel, marked } = self;
        samples.scan(points, |row, columns, _| {
            let start = row / *per_pixel * pixels.width;
            let last = start + (columns.end - 1) / *per_pixel;
            marked[start + columns.start / *per_pixel..=last].fill(true);
        });
    }
}

/// What is seen in cells, and how near.
#[derive(Debug)]
struct Cells {
    ids: Vec<u32>,
    depths: Vec<f32>,
}

impl Cells {
    fn new(count: usize) -> Self {
        Self { ids: vec![EMPTY; count], depths: vec![f32::NEG_INFINITY; count] }
    }

    /// Shows an id where it is the nearest so far; of equals the first stays.
    fn fill(&mut self, cells: Range<usize>, id: u32, depth: impl Fn(u32) -> f32) {
        let seen = self.ids[cells.clone()].iter_mut().zip(&mut self.depths[cells]);
        for (k, (seen, nearest)) in (0..).zip(seen) {
            let depth = depth(k);
            if depth > *nearest {
                *nearest = depth;
                *seen = id;
            }
        }
    }
}

/// Whole rows of pixels: what is seen in the middle of each, and in all samples of marked ones.
#[derive(Debug)]
pub(crate) struct Band {
    pixels: Window,
    samples: Window,
    per_pixel: usize,
    /// Row by row, how many pixels before each one are marked, and at the end of the row.
    marked_before: Vec<u32>,
    middles: Cells,
    /// Row by row of each marked pixel in turn.
    fine: Cells,
}

/// What a pixel shows.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Seen<'a> {
    /// One thing all over.
    One(u32),
    /// Rows of samples.
    Samples(&'a [u32]),
}

impl Band {
    pub(crate) fn new(marks: Marks) -> Self {
        let Marks { pixels, samples, per_pixel, marked } = marks;
        let mut count = 0;
        let mut marked_before = Vec::with_capacity((pixels.width + 1) * pixels.rows);
        for row in marked.chunks_exact(pixels.width) {
            marked_before.push(count);
            for &marked in row {
                count += u32::from(marked);
                marked_before.push(count);
            }
        }
        let fine = Cells::new(count as usize * per_pixel * per_pixel);
        let middles = Cells::new(pixels.width * pixels.rows);
        Self { pixels, samples, per_pixel, marked_before, middles, fine }
    }

    /// The height of the upper side of a row of pixels, counted within the band.
    pub(crate) fn top(&self, row: usize) -> f64 {
        ((self.pixels.first_row + row) * self.per_pixel) as f64
    }

    /// What a row of pixels shows.
    pub(crate) fn row(&self, row: usize) -> impl Iterator<Item = Seen<'_>> {
        let Window { width, .. } = self.pixels;
        let before = self.marked_before[row * (width + 1)..][..=width].windows(2);
        before.zip(&self.middles.ids[row * width..]).map(|(before, &middle)| {
            if before[0] == before[1] {
                Seen::One(middle)
            } else {
                let count = self.per_pixel * self.per_pixel;
                Seen::Samples(&self.fine.ids[before[0] as usize * count..][..count])
            }
        })
    }

    /// Fills a triangle where it is the nearest so far; of equals the first stays.
    pub(crate) fn fill_triangle(&mut self, points: [ScreenPoint; 3], id: u32) {
        let Self { pixels, samples, per_pixel, marked_before, middles, fine } = self;
        let (width, n) = (pixels.width, *per_pixel);
        let scale = 1.0 / n as f64;
        let in_pixels = points.map(|p| ScreenPoint { x: scale * p.x, y: scale * p.y, ..p });
        pixels.scan(in_pixels, |row, columns, ramp| {
            let start = row * width;
            middles.fill(start + columns.start..start + columns.end, id, |k| ramp.at(k));
        });
        let before = |row: usize| &marked_before[row * (width + 1)..][..=width];
        let (top, bottom) = range(in_pixels.map(|p| p.y));
        let (left, right) = range(in_pixels.map(|p| p.x));
        let columns = pixels.columns_within(left - 0.5, right + 0.5);
        let mut rows = pixels.rows_within(top - 0.5, bottom + 0.5);
        let marked = |row: &usize| before(*row)[columns.start] != before(*row)[columns.end];
        let Some(first) = rows.find(marked) else { return };
        let last = rows.rfind(marked).unwrap_or(first);
        let near_marks = Window {
            first_row: samples.first_row + first * n,
            rows: (last + 1 - first) * n,
            ..*samples
        };
        near_marks.scan(points, |row, columns, ramp| {
            let before = before(first + row / n);
            for pixel in columns.start / n..=(columns.end - 1) / n {
                if before[pixel] == before[pixel + 1] {
                    continue;
                }
                let within = columns.start.max(pixel * n)..columns.end.min((pixel + 1) * n);
                let start = (before[pixel] as usize * n + row % n) * n;
                let cells = start + within.start - pixel * n..start + within.end - pixel * n;
                let first = (within.start - columns.start) as u32;
                fine.fill(cells, id, |k| ramp.at(first + k));
            }
        });
    }

    /// Draws a line with round ends over what is there, leaving the depths as they are. Its pixels must be marked.
    ///
    /// `slack(id, dx, dy)` says by how much the line may lie behind a sample that shows `id`, when
    /// the sample is off the middle of the line by `(dx, dy)`.
    pub(crate) fn draw_line(
        &mut self,
        ends: [ScreenPoint; 2],
        half_width: f64,
        id: u32,
        slack: impl Fn(u32, f64, f64) -> f64,
    ) {
        let [near, far] = ends.map(|p| p.depth);
        let Self { samples, fine, .. } = self;
        let place = Self::place(self.per_pixel, self.pixels.width, &self.marked_before);
        samples.trace_line(ends, half_width, |cell, t, [dx, dy]| {
            let Some(at) = place(cell) else { return };
            let depth = near + t * (far - near);
            if depth + slack(fine.ids[at], dx, dy) >= f64::from(fine.depths[at]) {
                fine.ids[at] = id;
            }
        });
    }

    /// Draws a ball that looks like a disc of the given radius in samples: its middle has the
    /// depth of `centre`, and it bulges towards the viewer by `bulge`. It hides what lies deeper. Its pixels must be
    /// marked.
    pub(crate) fn draw_ball(&mut self, centre: ScreenPoint, radius: f64, bulge: f64, id: u32) {
        let Self { samples, fine, .. } = self;
        let place = Self::place(self.per_pixel, self.pixels.width, &self.marked_before);
        samples.trace_ball(centre, radius, |cell, height| {
            let Some(at) = place(cell) else { return };
            let depth = (centre.depth + bulge * height) as f32;
            if depth >= fine.depths[at] {
                fine.depths[at] = depth;
                fine.ids[at] = id;
            }
        });
    }

    /// The place of a sample among the fine cells, if its pixel is marked.
    fn place(
        n: usize,
        width: usize,
        marked_before: &[u32],
    ) -> impl Fn([usize; 2]) -> Option<usize> {
        move |[row, column]| {
            let pixel = row / n * (width + 1) + column / n;
            let before = marked_before[pixel];
            (before < marked_before[pixel + 1])
                .then(|| (before as usize * n + row % n) * n + column % n)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three samples a pixel each way, with the pixels that `mark` marks.
    fn band(mark: impl Fn(&mut Marks)) -> Band {
        let mut marks = Marks::new(Window { width: 14, first_row: 0, rows: 14 }, 3);
        mark(&mut marks);
        Band::new(marks)
    }

    /// All pixels marked.
    fn samples() -> Band {
        band(|marks| marks.marked.fill(true))
    }

    fn sample(band: &Band, row: usize, column: usize) -> u32 {
        let place = Band::place(3, 14, &band.marked_before);
        band.fine.ids[place([row, column]).expect("marked")]
    }

    fn point(x: f64, y: f64, depth: f64) -> ScreenPoint {
        ScreenPoint { x, y, depth, inverse_w: 1.0 }
    }

    #[test]
    fn a_fan_leaves_no_sample_out() {
        let rim = [[1.3, 2.1], [38.7, 1.2], [37.9, 38.8], [2.2, 37.7]];
        for hub in [[20.5, 20.5], [7.1, 30.3], [20.123_456_789, 11.5]] {
            let mut band = samples();
            for k in 0..4 {
                let corners = [hub, rim[k], rim[(k + 1) % 4]];
                band.fill_triangle(corners.map(|[x, y]| point(x, y, 0.0)), k as u32);
            }
            for row in 4..36 {
                assert!((4..36).all(|column| sample(&band, row, column) < 4), "row {row}");
            }
            assert!((0..42).all(|column| sample(&band, 0, column) == EMPTY));
            let middle = |row: usize| band.middles.ids[14 * row + 2..14 * row + 12].iter();
            assert!((2..12).all(|row| middle(row).all(|&id| id < 4)));
        }
    }

    #[test]
    fn the_nearest_depth_wins_whatever_the_order() {
        // Two planes that cross in the middle of the picture.
        let rising = [point(0.0, 0.0, 0.0), point(80.0, 0.0, 80.0), point(0.0, 80.0, 0.0)];
        let level = rising.map(|p| ScreenPoint { depth: 20.0, ..p });
        for order in [[0, 1], [1, 0]] {
            let mut band = samples();
            for id in order {
                band.fill_triangle([level, rising][id], id as u32);
            }
            assert_eq!([10, 30].map(|column| sample(&band, 5, column)), [0, 1]);
            assert_eq!([3, 10].map(|column| band.middles.ids[14 + column]), [0, 1]);
        }
    }

    #[test]
    fn lines_have_their_width_and_stay_behind_what_hides_them() {
        let mut band = samples();
        let wall = [point(20.0, -50.0, 5.0), point(90.0, 20.0, 5.0), point(20.0, 90.0, 5.0)];
        band.fill_triangle(wall, 0);
        band.draw_line([point(2.0, 10.0, 0.0), point(38.0, 10.0, 0.0)], 2.0, 7, |_, _, _| 1.0);
        let column: Vec<bool> = (0..42).map(|row| sample(&band, row, 10) == 7).collect();
        assert_eq!(column.iter().filter(|&&c| c).count(), 4);
        assert!(column[8..12].iter().all(|&c| c));
        assert_eq!(sample(&band, 10, 30), 0);
        band.draw_line([point(2.0, 10.0, 0.0), point(38.0, 10.0, 0.0)], 2.0, 7, |_, _, _| 6.0);
        assert_eq!(sample(&band, 10, 30), 7);
    }

    #[test]
    fn what_is_marked_is_seen_in_samples_and_all_else_once() {
        let ends = [point(5.0, 7.0, 9.0), point(34.0, 30.0, 9.0)];
        let wall = [point(1.0, 1.0, 0.0), point(40.0, 1.0, 0.0), point(1.0, 40.0, 0.0)];
        let draw = |mut band: Band| {
            band.fill_triangle(wall, 3);
            band.draw_line(ends, 1.2, 7, |_, _, _| 0.0);
            band.draw_ball(point(30.0, 8.0, 1.0), 2.5, 1.0, 8);
            band
        };
        let all = draw(samples());
        let some = draw(band(|marks| {
            marks.line(ends, 1.2);
            marks.ball(point(30.0, 8.0, 1.0), 2.5);
            wall.iter().zip([1, 2, 0]).for_each(|(&p, k)| marks.line([p, wall[k]], 0.0));
        }));
        let mut once = 0;
        for row in 0..14 {
            for (all, some) in all.row(row).zip(some.row(row)) {
                let Seen::Samples(samples) = all else { panic!("all pixels are marked") };
                match some {
                    Seen::Samples(same) => assert_eq!(samples, same),
                    Seen::One(id) => assert!(samples.iter().all(|&s| s == id)),
                }
                once += usize::from(matches!(some, Seen::One(3)));
            }
        }
        assert!(once > 20, "{once}");
    }
}
