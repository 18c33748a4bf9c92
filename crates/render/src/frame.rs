//! The loop over bands of rows, and the mean from samples to pixels.

use seamstress_parallel::prelude::*;

use crate::band::{Band, EMPTY, FIRST_OVERLAY, Marks, Seen};
use crate::image::{SRGB, Srgb};
use crate::raster::Window;
use crate::{Image, RenderError};

/// The longest side of a picture, in pixels.
const MAX_SIDE: u32 = 8192;
/// The most samples along a side of a pixel.
const MAX_SUPERSAMPLING: u32 = 8;
/// Samples in a band, unless a single row of pixels has more.
const BAND_SAMPLES: usize = 1 << 20;
/// Bands in a picture at least, as far as there are rows.
const MIN_BANDS: usize = 64;

/// The raster of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raster {
    size: [u32; 2],
    supersampling: u32,
}

/// What fills the samples.
pub(crate) trait Painter: Sync {
    /// Marks the pixels of a band that one colour is too little for: the others are looked at in their middle alone.
    fn mark(&self, index: usize, marks: &mut Marks);
    /// Decides what each sample of the band shows.
    fn draw(&self, index: usize, band: &mut Band);
    /// What colours patches of samples, in linear light, by the id that they show.
    fn shader(&self) -> impl FnMut(u32, Patch) -> [f32; 3];
}

/// The items that may touch each band, in ascending order.
#[derive(Debug)]
pub(crate) struct ByBand {
    /// Where the items of each band start; one more than there are bands.
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl ByBand {
    pub(crate) fn of(&self, band: usize) -> &[u32] {
        &self.items[self.starts[band]..self.starts[band + 1]]
    }
}

/// Samples of a pixel that are coloured together.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch {
    /// The mean of their centres.
    pub(crate) at: [f64; 2],
    /// The side of the square that the colour is a mean over, in samples.
    pub(crate) side: f64,
}

impl Raster {
    pub(crate) fn new(size: [u32; 2], supersampling: u32) -> Result<Self, RenderError> {
        if size.iter().any(|s| !(1..=MAX_SIDE).contains(s)) {
            return Err(RenderError::BadSize { width: size[0], height: size[1], limit: MAX_SIDE });
        }
        if !(1..=MAX_SUPERSAMPLING).contains(&supersampling) {
            return Err(RenderError::BadOption {
                name: "supersampling",
                requirement: "between 1 and 8",
            });
        }
        Ok(Self { size, supersampling })
    }

    /// Width and height in samples.
    pub(crate) fn samples(&self) -> [f64; 2] {
        self.size.map(|s| f64::from(s * self.supersampling))
    }

    /// The shorter side in samples.
    pub(crate) fn shorter_side(&self) -> f64 {
        let [width, height] = self.samples();
        width.min(height)
    }

    /// Samples along the side of a pixel.
    pub(crate) fn per_pixel(&self) -> u32 {
        self.supersampling
    }

    /// Rows of pixels in a band.
    fn rows_per_band(&self) -> usize {
        let [width, height] = self.size.map(|s| s as usize);
        let samples = width * self.supersampling.pow(2) as usize;
        (BAND_SAMPLES / samples).clamp(1, height.div_ceil(MIN_BANDS))
    }

    /// Sorts items by the bands that they may touch, by their least and greatest heights in samples.
    pub(crate) fn by_band(&self, spans: impl Iterator<Item = (f64, f64)> + Clone) -> ByBand {
        let rows = self.rows_per_band();
        let bands = (self.size[1] as usize).div_ceil(rows);
        let per_sample = 1.0 / (rows * self.supersampling as usize) as f64;
        let band = |height: f64| ((height * per_sample) as usize).min(bands - 1);
        let touched = move |(low, high): (f64, f64)| band(low)..=band(high);
        let mut starts = vec![0; bands + 1];
        for span in spans.clone() {
            touched(span).for_each(|band| starts[band + 1] += 1);
        }
        for band in 0..bands {
            starts[band + 1] += starts[band];
        }
        let mut next = starts.clone();
        let mut items = vec![0; starts[bands]];
        for (item, span) in (0..).zip(spans) {
            for band in touched(span) {
                items[next[band]] = item;
                next[band] += 1;
            }
        }
        ByBand { starts, items }
    }

    /// Draws all bands, each on its own, so that the threads leave no trace in the result.
    pub(crate) fn compose(&self, painter: &impl Painter) -> Image {
        let [width, height] = self.size.map(|s| s as usize);
        let rows = self.rows_per_band();
        let factor = self.supersampling as usize;
        let side = factor as f64;
        let srgb: &Srgb = &SRGB;
        let mut pixels = vec![0; 3 * width * height];
        pixels.par_chunks_mut(3 * width * rows).enumerate().for_each(|(index, bytes)| {
            let rows = bytes.len() / (3 * width);
            let window = Window { width, first_row: index * self.rows_per_band(), rows };
            let mut marks = Marks::new(window, factor);
            painter.mark(index, &mut marks);
            let mut band = Band::new(marks);
            painter.draw(index, &mut band);
            let mut shader = painter.shader();
            let empty = shader(EMPTY, Patch { at: [0.0; 2], side }).map(|c| srgb.byte(c));
            for (row, line) in bytes.chunks_exact_mut(3 * width).enumerate() {
                let top = band.top(row);
                let seen = band.row(row).zip(line.as_chunks_mut::<3>().0);
                for (column, (seen, pixel)) in seen.enumerate() {
                    let corner = [(column * factor) as f64, top];
                    let color = match seen {
                        Seen::One(EMPTY) => {
                            *pixel = empty;
                            continue;
                        }
                        Seen::One(id) => {
                            shader(id, Patch { at: corner.map(|x| x + 0.5 * side), side })
                        }
                        Seen::Samples(ids) => pixel_color(ids, factor, corner, &mut shader),
                    };
                    *pixel = color.map(|c| srgb.byte(c));
                }
            }
        });
        Image::from_rows(self.size[0], self.size[1], pixels)
    }
}

/// The mean colour of a pixel, of which `ids` has `factor` rows of samples and `corner` is the upper left corner.
///
/// Light and texture change little within a face, so the samples that show one get one colour; those of overlays,
/// which may be smaller than a pixel, get one each.
fn pixel_color(
    ids: &[u32],
    factor: usize,
    corner: [f64; 2],
    shader: &mut impl FnMut(u32, Patch) -> [f32; 3],
) -> [f32; 3] {
    let side = factor as f64;
    let first = ids[0];
    if (first < FIRST_OVERLAY || first == EMPTY) && ids.iter().all(|&id| id == first) {
        return shader(first, Patch { at: corner.map(|x| x + 0.5 * side), side });
    }
    let centre =
        |k: usize| [corner[0] + (k % factor) as f64 + 0.5, corner[1] + (k / factor) as f64 + 0.5];
    let mut sum = [0.0; 3];
    for (k, &id) in ids.iter().enumerate() {
        let (patch, count) = if id >= FIRST_OVERLAY {
            (Patch { at: centre(k), side: 1.0 }, 1.0)
        } else if ids[..k].contains(&id) {
            continue;
        } else {
            let same = (k..ids.len()).filter(|&l| ids[l] == id).map(centre);
            let (total, count) =
                same.fold(([0.0; 2], 0.0), |([x, y], n), [a, b]| ([x + a, y + b], n + 1.0));
            (Patch { at: total.map(|x| x / count), side }, count)
        };
        let color = shader(id, patch);
        (0..3).for_each(|c| sum[c] += color[c] * count as f32);
    }
    sum.map(|c| c / ids.len() as f32)
}
