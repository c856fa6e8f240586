//! Pictures: rows of RGB, 8 bits a channel, written as PNG.

pub mod part;
pub mod rows;

use std::io::{self, Write};

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbImage};

/// A colour of 8 bits a channel, in sRGB.
pub type Rgb = [u8; 3];

/// What a pixel is whose ray was given up: a colour that no scene has by chance, since giving up is neither hit nor miss.
pub const GAVE_UP: Rgb = [255, 0, 255];

/// A picture, from its top row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    size: [u32; 2],
    bytes: Vec<u8>,
}

impl Picture {
    /// A picture without rows, `size` being width and height.
    pub fn new(size: [u32; 2]) -> Self {
        Picture { size, bytes: Vec::new() }
    }

    /// Adds the next row, of as many pixels as the picture is wide.
    pub fn push_row(&mut self, row: &[Rgb]) {
        self.bytes.extend(row.iter().flatten());
    }

    /// Its rows so far, from the top.
    pub fn rows(&self) -> impl Iterator<Item = &[Rgb]> {
        self.bytes.as_chunks::<3>().0.chunks(self.size[0].max(1) as usize)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The same as the library of pictures has it; of no pixels, if its rows do not fill it.
    pub fn to_image(&self) -> RgbImage {
        let [width, height] = self.size;
        RgbImage::from_raw(width, height, self.bytes.clone()).unwrap_or_default()
    }

    /// Writes the picture as PNG. The same picture gives the same bytes.
    ///
    /// # Errors
    /// What `output` ran into, or rows that do not fill the picture.
    pub fn write_png(&self, output: impl Write) -> io::Result<()> {
        let [width, height] = self.size;
        let wanted = 3 * u64::from(width) * u64::from(height);
        if self.bytes.len() as u64 != wanted {
            return Err(io::Error::other(format!("the picture has {} of its {wanted} bytes", self.bytes.len())));
        }
        let encoder = PngEncoder::new(output);
        encoder.write_image(&self.bytes, width, height, ExtendedColorType::Rgb8).map_err(|error| match error {
            image::ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })
    }
}

/// A linear colour, each part 0 to 1, in 8 bits of sRGB; parts outside are cut off. Source: IEC 61966-2-1.
pub fn encode(linear: [f64; 3]) -> Rgb {
    linear.map(|part| {
        let part = part.clamp(0.0, 1.0);
        let curved = if part <= 0.003_130_8 { 12.92 * part } else { 1.055 * part.powf(1.0 / 2.4) - 0.055 };
        // Within 0 to 255.
        (255.0 * curved + 0.5) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_png_reads_back() {
        let mut picture = Picture::new([2, 1]);
        assert!(picture.write_png(&mut Vec::new()).is_err());
        picture.push_row(&[[1, 2, 3], GAVE_UP]);
        let mut png = Vec::new();
        picture.write_png(&mut png).expect("written");
        let read = image::load_from_memory(&png).expect("a picture").to_rgb8();
        assert_eq!((read.width(), read.height(), read.as_raw().as_slice()), (2, 1, &[1, 2, 3, 255, 0, 255][..]));
    }

    #[test]
    fn ends_of_the_scale_stay() {
        assert_eq!(encode([0.0, 1.0, -3.0]), [0, 255, 0]);
        assert_eq!(encode([2.0, f64::NAN, 0.2159]), [255, 0, 128]);
    }
}
