//! The loop over bands of rows, and the average from samples to pixels.

use seamstress_parallel::prelude::*;

use crate::image::to_srgb8;
use crate::raster::{Band, Window};
use crate::{Image, RenderError};

/// The longest side of a picture, in pixels.
const MAX_SIDE: u32 = 8192;
/// The most samples along a side of a pixel.
const MAX_SUPERSAMPLING: u32 = 8;
/// Samples in a band, unless a single row of pixels has more.
const BAND_SAMPLES: usize = 1 << 20;
/// Bands in a picture at least, as far as there are rows.
const MIN_BANDS: usize = 32;

/// The raster of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raster {
    size: [u32; 2],
    supersampling: u32,
}

/// What fills the samples.
pub(crate) trait Painter: Sync {
    /// Decides what each sample of the band shows.
    fn draw(&self, band: &mut Band);
    /// The colours of one row of samples, in linear light.
    fn shade(&self, band: &Band, row: usize, colors: &mut [[f32; 3]]);
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

    /// Draws all bands, each on its own, so that the threads leave no trace in the result.
    pub(crate) fn compose(&self, painter: &impl Painter) -> Image {
        let [width, height] = self.size.map(|s| s as usize);
        let factor = self.supersampling as usize;
        let rows = (BAND_SAMPLES / (width * factor * factor)).clamp(1, height.div_ceil(MIN_BANDS));
        let mut pixels = vec![0; 3 * width * height];
        pixels.par_chunks_mut(3 * width * rows).enumerate().for_each(|(index, bytes)| {
            let count = bytes.len() / (3 * width);
            let mut band = Band::new(Window {
                width: width * factor,
                first_row: index * rows * factor,
                rows: count * factor,
            });
            painter.draw(&mut band);
            let mut colors = vec![[0.0; 3]; width * factor];
            let mut sums = vec![[0.0; 3]; width];
            for (pixel_row, out) in bytes.chunks_mut(3 * width).enumerate() {
                sums.fill([0.0; 3]);
                for row in pixel_row * factor..(pixel_row + 1) * factor {
                    painter.shade(&band, row, &mut colors);
                    for (sum, samples) in sums.iter_mut().zip(colors.chunks(factor)) {
                        for color in samples {
                            (0..3).for_each(|c| sum[c] += color[c]);
                        }
                    }
                }
                let weight = 1.0 / (factor * factor) as f32;
                for (pixel, sum) in out.chunks_mut(3).zip(&sums) {
                    (0..3).for_each(|c| pixel[c] = to_srgb8(sum[c] * weight));
                }
            }
        });
        Image::from_rows(self.size[0], self.size[1], pixels)
    }
}
