//! A picture with room below it for bars and words.

use crate::Image;
use crate::font::{BASE, CAPITAL, text_segments, text_width};
use crate::image::{SRGB, to_linear};
use crate::palette::hex;

/// The colour of words and marks.
pub(crate) const INK: [f64; 3] = hex(0x2b2b33);
/// Height of the band, in units.
const BAND: f64 = 15.0;
/// Units across a picture.
const UNITS: f64 = 100.0;
/// Width of a stroke of text, on the grid of the font.
const STROKE: f64 = 1.7;

/// A picture with a white band below, drawn on in linear light.
pub(crate) struct Canvas {
    size: [u32; 2],
    picture: Image,
    /// Pixels of the band.
    band: Vec<[f32; 3]>,
    /// A hundredth of the width, in pixels.
    pub(crate) unit: f64,
    pub(crate) width: f64,
}

impl Canvas {
    pub(crate) fn below(picture: &Image) -> Self {
        let width = f64::from(picture.width());
        let unit = width / UNITS;
        let rows = (BAND * unit).ceil().max(1.0) as u32;
        let white = to_linear([1.0; 3]);
        Self {
            size: [picture.width(), rows],
            picture: picture.clone(),
            band: vec![white; picture.width() as usize * rows as usize],
            unit,
            width,
        }
    }

    /// Mixes a colour into the pixels of a box, by coverage at their centres.
    fn blend(
        &mut self,
        [left, top, right, bottom]: [f64; 4],
        coverage: impl Fn(f64, f64) -> f64,
        color: impl Fn(f64) -> [f64; 3],
    ) {
        let clamp = |x: f64, limit: u32| x.clamp(0.0, f64::from(limit)) as u32;
        let [columns, rows] = self.size;
        for row in clamp(top.floor(), rows)..clamp(bottom.ceil(), rows) {
            for column in clamp(left.floor(), columns)..clamp(right.ceil(), columns) {
                let (x, y) = (f64::from(column) + 0.5, f64::from(row) + 0.5);
                let share = coverage(x, y) as f32;
                if share > 0.0 {
                    let ink = to_linear(color(x));
                    let pixel = &mut self.band[row as usize * columns as usize + column as usize];
                    (0..3).for_each(|c| pixel[c] += share * (ink[c] - pixel[c]));
                }
            }
        }
    }

    /// Fills a box (left, top, right, bottom) with a colour by column.
    pub(crate) fn fill(&mut self, area: [f64; 4], color: impl Fn(f64) -> [f64; 3]) {
        let [left, top, right, bottom] = area;
        let overlap = |low: f64, high: f64, at: f64| {
            ((at + 0.5).min(high) - (at - 0.5).max(low)).clamp(0.0, 1.0)
        };
        let coverage = |x, y| overlap(left, right, x) * overlap(top, bottom, y);
        self.blend(area, coverage, color);
    }

    fn grid(&self, height: f64) -> f64 {
        height * self.unit / CAPITAL
    }

    /// Width of a text whose capitals are `height` units high.
    pub(crate) fn text_width(&self, text: &str, height: f64) -> f64 {
        text_width(text) * self.grid(height)
    }

    /// Writes a text; `at` is the upper left corner of a capital.
    pub(crate) fn text(&mut self, text: &str, at: [f64; 2], height: f64) {
        let grid = self.grid(height);
        let half = 0.5 * STROKE * grid;
        for segment in text_segments(text) {
            let [p, q] =
                segment.map(|[x, y]| [at[0] + grid * x, at[1] + grid * (CAPITAL + BASE - y)]);
            let reach = half + 1.0;
            let area = [
                p[0].min(q[0]) - reach,
                p[1].min(q[1]) - reach,
                p[0].max(q[0]) + reach,
                p[1].max(q[1]) + reach,
            ];
            let coverage = |x, y| (half + 0.5 - distance([x, y], p, q)).clamp(0.0, 1.0);
            self.blend(area, coverage, |_| INK);
        }
    }

    pub(crate) fn finish(self) -> Image {
        let mut bytes = self.picture.rgb8().to_vec();
        bytes.extend(self.band.iter().flatten().map(|&c| SRGB.byte(c)));
        Image::from_rows(self.size[0], self.picture.height() + self.size[1], bytes)
    }
}

/// Distance of a point from a segment.
fn distance([x, y]: [f64; 2], p: [f64; 2], q: [f64; 2]) -> f64 {
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let square = dx * dx + dy * dy;
    let t = if square > 0.0 { ((x - p[0]) * dx + (y - p[1]) * dy) / square } else { 0.0 };
    let t = t.clamp(0.0, 1.0);
    (x - p[0] - t * dx).hypot(y - p[1] - t * dy)
}
