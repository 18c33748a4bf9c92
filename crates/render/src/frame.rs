//! The loop over bands of rows, and the mean from samples to pixels.

use seamstress_parallel::prelude::*;

use crate::image::to_srgb8;
use crate::raster::{Band, EMPTY, FIRST_OVERLAY, Window};
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
    /// What colours patches of samples, in linear light, by the id that they show.
    fn shader(&self) -> impl FnMut(u32, Patch) -> [f32; 3];
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
            let mut shader = painter.shader();
            let mut ids = vec![EMPTY; factor * factor];
            for (index, pixel) in bytes.chunks_mut(3).enumerate() {
                let corner = [index % width * factor, index / width * factor];
                for (row, ids) in ids.chunks_mut(factor).enumerate() {
                    let samples = &band.ids(corner[1] + row)[corner[0]..];
                    ids.copy_from_slice(&samples[..factor]);
                }
                let corner = [corner[0] as f64, band.centre(corner[1]) - 0.5];
                let color = pixel_color(&ids, factor, corner, &mut shader);
                pixel.copy_from_slice(&color.map(to_srgb8));
            }
        });
        Image::from_rows(self.size[0], self.size[1], pixels)
    }
}

/// The mean colour of a pixel, of which `ids` has `factor` rows of samples and `corner` is the upper left corner.
///
/// Light and texture change little within a pixel, so the samples that show one face get one colour; those of overlays,
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
