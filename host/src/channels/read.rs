//! Pictures and channels from files: PNG of 8 bits a channel, and OpenEXR.

use std::fs;
use std::io::{self, Cursor};
use std::path::Path;

use image::{DynamicImage, ImageFormat};

use super::{Channel, Channels, Values, exr};

/// How an OpenEXR file begins.
const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Reads a picture; what it is, its first bytes say.
///
/// # Errors
/// It cannot be read, or is neither.
pub fn read(path: &Path) -> io::Result<Channels> {
    let bytes = fs::read(path)?;
    if bytes.starts_with(&EXR) {
        return exr::decode(Cursor::new(bytes));
    }
    let image = image::load_from_memory_with_format(&bytes, ImageFormat::Png);
    let image = image.map_err(|reason| io::Error::other(format!("it is neither OpenEXR nor a PNG: {reason}")))?;
    let (names, size, pixels) = match image {
        DynamicImage::ImageRgb8(image) => ("RGB", image.dimensions(), image.into_raw()),
        DynamicImage::ImageRgba8(image) => ("RGBA", image.dimensions(), image.into_raw()),
        DynamicImage::ImageLuma8(image) => ("Y", image.dimensions(), image.into_raw()),
        _ => return Err(io::Error::other("it is a PNG, but not of grey, RGB or RGBA of 8 bits a channel")),
    };
    let of = |k: usize| pixels.iter().skip(k).step_by(names.len()).map(|&byte| u32::from(byte)).collect();
    let all = names.chars().enumerate();
    let all = all.map(|(k, name)| Channel { name: name.to_string(), values: Values::Count(of(k)) }).collect();
    Ok(Channels { size: [size.0, size.1], all })
}
