//! Numbers on faces as colours, with a legend.

use crate::canvas::{Canvas, INK};
use crate::palette::{Palette, hex};
use crate::{Image, Paint, RenderError};

/// Ten steps of viridis (van der Walt and Smith 2015): even to the eye, in grey and for colour-blind
/// readers too.
const VIRIDIS: [u32; 10] = [
    0x44_01_54, 0x48_28_78, 0x3e_49_89, 0x31_68_8e, 0x26_82_8e, 0x1f_9e_89, 0x35_b7_79, 0x6e_ce_58,
    0xb5_de_2b, 0xfd_e7_25,
];
/// Faces without a number.
const BLANK: u32 = 0xb8b8b8;

/// The colour of a share between 0 and 1; beyond, that of the nearer end.
fn viridis(share: f64) -> [f64; 3] {
    let at = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let k = (at as usize).min(VIRIDIS.len() - 2);
    let (low, high) = (hex(VIRIDIS[k]), hex(VIRIDIS[k + 1]));
    let t = at - k as f64;
    [0, 1, 2].map(|c| low[c] + t * (high[c] - low[c]))
}

/// A scale of colours between two numbers; dark is low.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// The number at the dark end.
    pub low: f64,
    /// The number at the bright end; larger ones look the same.
    pub high: f64,
    /// What is shown, above the bar: small letters, digits and punctuation.
    pub title: String,
}

impl HeatMap {
    /// Colours of faces: infinite numbers in the colour of flipped triangles, missing ones (not a number) grey.
    pub fn paint(&self, values: &[f64]) -> Paint {
        Paint::PerFace(values.iter().map(|&x| self.color(x)).collect())
    }

    fn color(&self, value: f64) -> [f64; 3] {
        if value.is_nan() {
            hex(BLANK)
        } else if value == f64::INFINITY {
            Palette::default().flipped
        } else if self.high > self.low {
            viridis((value - self.low) / (self.high - self.low))
        } else {
            viridis(0.0)
        }
    }

    /// The picture with a band below it: title, bar of colours with numbers, and what else occurs.
    ///
    /// # Errors
    /// [`RenderError::BadOption`] if the ends are not finite.
    pub fn with_legend(&self, picture: &Image, values: &[f64]) -> Result<Image, RenderError> {
        if !(self.low.is_finite() && self.high.is_finite()) {
            return Err(RenderError::BadOption { name: "heat map", requirement: "finite" });
        }
        let mut canvas = Canvas::below(picture);
        let unit = canvas.unit;
        let (left, width) = (5.0 * unit, canvas.width - 10.0 * unit);
        canvas.text(&self.title, [left, 1.2 * unit], 2.0);
        let bar = [left, 5.0 * unit, left + width, 8.0 * unit];
        canvas.fill(bar, |x| viridis((x - left) / width));
        let clipped = values.iter().any(|&x| x.is_finite() && x > self.high);
        for (k, (value, label)) in ticks(self.low, self.high).into_iter().enumerate() {
            let share = if self.high > self.low {
                (value - self.low) / (self.high - self.low)
            } else {
                0.0
            };
            let x = left + width * share;
            canvas.fill([x - 0.09 * unit, bar[3], x + 0.09 * unit, bar[3] + 0.7 * unit], |_| INK);
            let half = 0.5 * canvas.text_width(&label, 1.5);
            let start = if k == 0 { x - 0.09 * unit } else { x - half };
            canvas.text(&label, [start, bar[3] + 1.1 * unit], 1.5);
        }
        if clipped {
            let text = format!("bright end = {} and more", number(self.high));
            let start = left + width - canvas.text_width(&text, 1.5);
            canvas.text(&text, [start, 1.5 * unit], 1.5);
        }
        self.swatches(&mut canvas, values, [left, bar[3] + 4.0 * unit]);
        Ok(canvas.finish())
    }

    /// Explains the colours off the bar, where they occur.
    fn swatches(&self, canvas: &mut Canvas, values: &[f64], [mut x, y]: [f64; 2]) {
        let unit = canvas.unit;
        let kinds = [
            (values.contains(&f64::INFINITY), f64::INFINITY, "infinite (flipped or collapsed)"),
            (values.iter().any(|v| v.is_nan()), f64::NAN, "no area on the surface"),
        ];
        for (_, value, text) in kinds.into_iter().filter(|(occurs, ..)| *occurs) {
            let color = self.color(value);
            canvas.fill([x, y, x + 2.0 * unit, y + 1.6 * unit], |_| color);
            canvas.text(text, [x + 2.8 * unit, y], 1.5);
            x += 5.0 * unit + canvas.text_width(text, 1.5);
        }
    }
}

/// A number with about four digits.
fn number(x: f64) -> String {
    if (1e-2..1e6).contains(&x.abs()) { format!("{x:.4}") } else { format!("{x:.2e}") }
}

/// About this many numbers stand below the bar.
const TICKS: f64 = 5.0;

/// The lower end, and round numbers up to the upper one, with their texts.
fn ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let span = high - low;
    if span <= 0.0 {
        return vec![(low, format!("{low}"))];
    }
    let raw = span / TICKS;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|&s| s >= raw);
    let step = step.unwrap_or(10.0 * power);
    let label = |x: f64| {
        let digits = (-step.log10().floor()).max(0.0) as usize;
        if (1e-4..1e6).contains(&high.abs()) { format!("{x:.digits$}") } else { format!("{x:.1e}") }
    };
    let first = (low / step).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    let mut ticks: Vec<_> =
        (first..=last).map(|k| k as f64 * step).map(|x| (x, label(x))).collect();
    // The end without distortion is worth a number unless another stands close by.
    if ticks.first().is_none_or(|(x, _)| x - low > 0.6 * step) {
        ticks.insert(0, (low, label(low)));
    }
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_follow_the_numbers() {
        let heat = HeatMap { low: 1.0, high: 3.0, title: "tau".into() };
        assert_eq!(heat.color(1.0), hex(VIRIDIS[0]));
        assert_eq!(heat.color(3.0), hex(VIRIDIS[9]));
        assert_eq!(heat.color(9.0), heat.color(3.0));
        assert_eq!(heat.color(f64::NAN), hex(BLANK));
        assert_eq!(heat.color(f64::INFINITY), Palette::default().flipped);
        let brightness = |x| heat.color(x).iter().sum::<f64>();
        assert!(
            (0..10).all(
                |k| brightness(1.0 + 0.2 * f64::from(k)) < brightness(1.2 + 0.2 * f64::from(k))
            )
        );
    }

    #[test]
    fn ticks_are_round_and_inside() {
        let texts = |low, high| ticks(low, high).into_iter().map(|(_, s)| s).collect::<Vec<_>>();
        assert_eq!(texts(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(1.0, 1.42), ["1.0", "1.1", "1.2", "1.3", "1.4"]);
        assert_eq!(texts(4.0, 4.0), ["4"]);
        assert_eq!(texts(3.97, 6.0), ["4.0", "4.5", "5.0", "5.5", "6.0"]);
    }

    #[test]
    fn the_legend_is_a_band_below_with_bar_and_ink() {
        let picture = Image::from_rows(200, 10, vec![7; 6000]);
        let heat = HeatMap { low: 0.0, high: 1.0, title: "arap".into() };
        let image = heat.with_legend(&picture, &[0.5]).unwrap();
        assert_eq!((image.width(), image.height()), (200, 40));
        assert_eq!(image.pixel(3, 3), [7; 3]);
        // The ends of the bar have the ends' colours; five per cent of the width are free beside it.
        assert_eq!(image.pixel(3, 23), [255; 3]);
        let [left, right] = [image.pixel(11, 23), image.pixel(188, 23)];
        assert!(left[2] > left[1] && right[0] > 230 && right[1] > 200, "{left:?} {right:?}");
        let dark = (0..200).flat_map(|x| (11..18).map(move |y| (x, y)));
        assert!(dark.filter(|&(x, y)| image.pixel(x, y)[1] < 128).count() > 10, "no title");
        let bad = HeatMap { high: f64::NAN, ..heat };
        assert!(bad.with_legend(&picture, &[]).is_err());
    }
}
