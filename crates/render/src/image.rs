//! The finished picture, and the way from linear light to bytes.

use std::io::Write;
use std::sync::LazyLock;

use crate::RenderError;

/// A picture: 8-bit sRGB, three bytes a pixel, rows from top to bottom.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Image {
    /// Wraps rows of bytes; the caller guarantees `3 * width * height` of them.
    pub(crate) fn from_rows(width: u32, height: u32, pixels: Vec<u8>) -> Self {
        Self { width, height, pixels }
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All bytes: red, green, blue of each pixel, rows from top to bottom.
    pub fn rgb8(&self) -> &[u8] {
        &self.pixels
    }

    /// Red, green and blue of the pixel in column `x` and row `y`, counted from the top left;
    /// `None` outside the picture.
    pub fn get(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 3 * (y as usize * self.width as usize + x as usize);
        Some([self.pixels[at], self.pixels[at + 1], self.pixels[at + 2]])
    }

    /// Like [`get`](Self::get), and black outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 3] {
        self.get(x, y).unwrap_or_default()
    }

    /// This picture with another of the same height to its right.
    ///
    /// # Errors
    /// [`RenderError::BadOption`] if the heights differ.
    pub fn beside(&self, right: &Image) -> Result<Image, RenderError> {
        if self.height != right.height {
            return Err(RenderError::BadOption { name: "height", requirement: "equal" });
        }
        let rows = |image: &Image| 3 * image.width as usize;
        let (a, b) = (rows(self), rows(right));
        let lines = self.pixels.chunks(a.max(1)).zip(right.pixels.chunks(b.max(1)));
        let pixels = lines.flat_map(|(left, right)| left.iter().chain(right).copied()).collect();
        Ok(Self::from_rows(self.width + right.width, self.height, pixels))
    }

    /// Writes the picture as a PNG.
    ///
    /// # Errors
    /// [`RenderError::Png`] if the writer fails.
    pub fn write_png(&self, w: impl Write) -> Result<(), RenderError> {
        let mut encoder = png::Encoder::new(w, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        // Drawing is so quick that better compression would take most of the time.
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        Ok(writer.finish()?)
    }
}

/// From linear light to bytes of sRGB (IEC 61966-2-1), by a table: powers cost more than all else of a pixel.
pub(crate) struct Srgb {
    /// The least linear light of each byte.
    least: [f32; 256],
    /// The byte at the lower end of each of as many equal parts of `0..=1`.
    at_part: [u8; PARTS + 1],
}

/// Parts of the table: more would save no step, and less cost some in the dark.
const PARTS: usize = 1024;

/// The table, made when it is first asked for.
pub(crate) static SRGB: LazyLock<Srgb> = LazyLock::new(|| {
    let least = std::array::from_fn(|byte| match byte {
        0 => f32::NEG_INFINITY,
        _ => linear((byte as f64 - 0.5) / 255.0) as f32,
    });
    let below = |part: usize| least.partition_point(|&c| c <= part as f32 / PARTS as f32);
    Srgb { least, at_part: std::array::from_fn(|part| (below(part) - 1) as u8) }
});

impl Srgb {
    pub(crate) fn byte(&self, light: f32) -> u8 {
        let part = (light.clamp(0.0, 1.0) * PARTS as f32) as usize;
        let mut byte = self.at_part[part];
        while byte < u8::MAX && self.least[usize::from(byte) + 1] <= light {
            byte += 1;
        }
        byte
    }
}

/// One value of sRGB in `0..=1` to linear light.
fn linear(s: f64) -> f64 {
    if s <= 0.040_45 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) }
}

/// A display colour, sRGB in `0..=1`, to linear light.
pub(crate) fn to_linear(srgb: [f64; 3]) -> [f32; 3] {
    srgb.map(|s| linear(s.clamp(0.0, 1.0)) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_the_way_to_linear_light_and_back() {
        for byte in 0..=255_u8 {
            let linear = to_linear([f64::from(byte) / 255.0; 3]);
            assert_eq!(SRGB.byte(linear[0]), byte);
        }
    }

    #[test]
    fn light_becomes_the_nearest_byte() {
        for k in -1000..=201_000 {
            let light = k as f32 / 200_000.0;
            let c = f64::from(light).clamp(0.0, 1.0);
            let s = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
            let off = 255.0 * s - f64::from(SRGB.byte(light));
            assert!(off.abs() < 0.5001, "{light}: {off}");
        }
        assert_eq!([f32::NAN, f32::INFINITY].map(|c| SRGB.byte(c)), [0, 255]);
    }

    #[test]
    fn png_decodes_to_the_same_pixels() {
        let (width, height) = (7, 5);
        let pixels: Vec<u8> = (0..3 * width * height).map(|i| (i * 37 % 256) as u8).collect();
        let image = Image::from_rows(width, height, pixels.clone());
        let mut bytes = Vec::new();
        image.write_png(&mut bytes).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut decoded = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut decoded).unwrap();
        assert_eq!((info.width, info.height), (width, height));
        assert_eq!(decoded[..info.buffer_size()], pixels[..]);
        assert_eq!(image.pixel(6, 4), [pixels[102], pixels[103], pixels[104]]);
        assert_eq!(image.get(7, 0), None);
    }
}
