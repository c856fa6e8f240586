//! Where in its pixels a view is sampled, and how samples lie in scan lines.
//!
//! With four samples a pixel is divided into four subpixels, two by two, with a sample in each. A row of pixels is then two
//! scan lines of twice its pixels, so that from one sample to the next is half a pixel and never a row back.
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

use super::shapes::Random;

/// How many samples a pixel has, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// One, at the pixel's centre.
    #[default]
    One,
    /// Four, at the centres of the pixel's four subpixels.
    Uniform,
    /// Four, each at a random place of its subpixel: always the same place for the same subpixel.
    Jittered,
}

impl Sampling {
    /// How many samples a pixel is wide, and high.
    pub fn side(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Uniform | Self::Jittered => 2,
        }
    }

    /// How many samples a pixel has.
    pub fn per_pixel(self) -> u32 {
        self.side() * self.side()
    }
}

/// The samples of a scan line.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanLine {
    /// Image coordinates [sx, sy] of each sample, from left to right; see [`View`](super::camera::View).
    pub samples: Vec<[f64; 2]>,
    /// The least and the largest sy that a sample of this line can have, both included.
    pub sy: [f64; 2],
}

/// The samples of scan line `line` (0 is the top one) of an image of `size`: width and height in pixels.
pub(super) fn scan_line(sampling: Sampling, size: [u32; 2], line: u32) -> ScanLine {
    let [width, height] = size.map(f64::from);
    let longer = width.max(height);
    let row = f64::from(line);
    if sampling == Sampling::One {
        let sy = ((height - 1.0) - 2.0 * row) / longer;
        let sx = |px| (2.0 * f64::from(px) - (width - 1.0)) / longer;
        return ScanLine { samples: (0..size[0]).map(|px| [sx(px), sy]).collect(), sy: [sy, sy] };
    }
    // Subpixels are 1 / S wide and high, and the middle of the image is that of 2 W × 2 H of them.
    let (sx, sy) = (|x: f64| (x - width) / longer, |y: f64| (height - y) / longer);
    let sample = |column: u32| {
        let [x, y] = if sampling == Sampling::Jittered { jitter(column, line) } else { [0.5; 2] };
        [sx(f64::from(column) + x), sy(row + y)]
    };
    let between = if sampling == Sampling::Jittered { [1.0, 0.0] } else { [0.5; 2] };
    ScanLine { samples: (0..2 * size[0]).map(sample).collect(), sy: between.map(|y| sy(row + y)) }
}

/// The place of the sample in a subpixel, rightward and downward, each above 0 and below 1. It depends on the pixel and on
/// which of its samples this is, and on nothing else.
fn jitter(column: u32, line: u32) -> [f64; 2] {
    let (pixel, sample) = ([column / 2, line / 2], 2 * (line % 2) + column % 2);
    let seed = [pixel[0], sample].into_iter().fold(u64::from(pixel[1]), |key, part| key << 16 | u64::from(part));
    let bits = Random(seed).bits();
    // 32 bits each, so that adding them to the subpixel's number is exact and stays inside.
    [bits >> 32, bits & 0xffff_ffff].map(|part| (part as f64 + 0.5) / (1u64 << 32) as f64)
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use proptest::prelude::*;

    use super::super::appearance::MAX_SIDE;
    use super::*;

    #[test]
    fn uniform_samples_are_those_of_an_image_twice_as_large() {
        for size in [[3, 2], [2, 3], [1, 1], [640, 480]] {
            for line in [0, 1, 2 * size[1] - 1] {
                let fine = scan_line(Sampling::One, size.map(|side| 2 * side), line);
                let uniform = scan_line(Sampling::Uniform, size, line);
                assert_eq!(uniform.samples.len(), fine.samples.len());
                for (a, b) in uniform.samples.iter().flatten().zip(fine.samples.iter().flatten()) {
                    assert!((a - b).abs() < 1e-15, "{size:?} {line}: {a} {b}");
                }
                assert_eq!(uniform.sy, [uniform.samples[0][1]; 2]);
            }
        }
    }

    #[test]
    fn no_two_pixels_and_no_two_samples_are_alike() {
        let places: HashSet<_> =
            (0..200).flat_map(|line| (0..200).map(move |column| jitter(column, line).map(f64::to_bits))).collect();
        assert_eq!(places.len(), 200 * 200);
    }

    #[test]
    fn jitter_has_its_mean_in_the_middle_and_fills_the_subpixel() {
        let (mut sum, mut cells) = ([0.0; 2], [0u32; 16]);
        for (line, column) in (0..256).flat_map(|line| (0..256).map(move |column| (line, column))) {
            let [x, y] = jitter(column, line);
            sum = [sum[0] + x, sum[1] + y];
            cells[4 * (4.0 * x) as usize + (4.0 * y) as usize] += 1;
        }
        assert!(sum.iter().all(|sum| (sum / 65536.0 - 0.5).abs() < 0.005), "{sum:?}");
        // 4096 each on average, with a standard deviation of 62.
        assert!(cells.iter().all(|&count| (3780..4412).contains(&count)), "{cells:?}");
    }

    proptest! {
        #[test]
        fn a_sample_stays_in_its_subpixel_whatever_the_image(
            (width, height) in (1..=MAX_SIDE, 1..=MAX_SIDE),
            (right, down) in (0.0..1.0, 0.0..1.0),
        ) {
            let line = (right * f64::from(2 * height)) as u32;
            let column = (down * f64::from(2 * width)) as usize;
            let lines = scan_line(Sampling::Jittered, [width, height], line);
            let [sx, sy] = lines.samples[column];
            let longer = f64::from(width.max(height));
            // Of an image with one sample per subpixel, half the distance between samples to either side.
            let middle = scan_line(Sampling::Uniform, [width, height], line).samples[column];
            prop_assert!((sx - middle[0]).abs() * longer < 0.5 && (sy - middle[1]).abs() * longer < 0.5);
            prop_assert!(lines.sy[0] < sy && sy < lines.sy[1]);
            // The image's size does not move it, nor does the order in which samples are asked for.
            let alone = jitter(column as u32, line);
            let place = [sx * longer + f64::from(width) - column as f64, f64::from(height) - sy * longer - f64::from(line)];
            prop_assert!(alone.iter().zip(place).all(|(a, b)| (a - b).abs() < 1e-10));
        }
    }
}
