//! What light is counted in: red, green and blue, or nine samples over the visible range where a metal needs them.
//!
//! Spectral sampling after R. Hall, Illumination and Color in Computer Generated Imagery, Springer 1988: a sample
//! stands for all wavelengths that are nearer to it than to any other, as if the spectrum were flat there, and so has a
//! fixed part in X, Y and Z. The samples lie 30 nm apart, from 434 nm on. The first one's place decides how well steep
//! spectra are met: from here the colours of the four metals, and of one mirrored in another, are within 0.8 % of those by
//! steps of 1 nm; with samples at 400, 440, .. 720 nm 4 % would be reached.
//!
//! Colours of red, green and blue become spectra as sums of three base spectra, after I. Mallett and C. Yuksel, "Spectral
//! primary decomposition for rendering with sRGB reflectance", EGSR 2019. They lie within 0 and 1 and add up to 1, so that a
//! colour returns no more light than its parts say and white is a flat spectrum; and they come back as the colours that they
//! are made of, to within 1e-8. What is lit by coloured light, or mirrored in a metal, is the product of spectra and not of
//! colours.

use std::array;

use super::fresnel::Index;
use super::metal;
use super::{display, observer};
use crate::scene::appearance::Metal;

/// How light is counted, in N parts.
pub trait Basis<const N: usize>: Copy + Sync {
    /// The parts of a linear colour: red, green and blue.
    fn parts(&self, colour: [f64; 3]) -> [f64; N];
    /// The linear colour, for the display, of light in parts. It may lie outside 0 to 1.
    fn display(&self, light: [f64; N]) -> [f64; 3];
    /// A metal's index for each part; `None` where parts have no wavelength.
    fn indices(&self, metal: Metal) -> Option<[Index; N]>;
}

/// Light as red, green and blue.
#[derive(Clone, Copy, Debug)]
pub struct Rgb;

impl Basis<3> for Rgb {
    fn parts(&self, colour: [f64; 3]) -> [f64; 3] {
        colour
    }

    fn display(&self, light: [f64; 3]) -> [f64; 3] {
        light
    }

    fn indices(&self, _: Metal) -> Option<[Index; 3]> {
        None
    }
}

/// The number of samples, that of the paper.
pub const SAMPLES: usize = 9;

/// The wavelength of the first sample, and the step to the next, in nanometres.
const FIRST: u32 = 434;
const STEP: u32 = 30;

/// Light as nine samples over the visible range.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// For red, green and blue of the display the part that each sample has in it.
    to_display: [[f64; SAMPLES]; 3],
}

impl Sampled {
    /// Nine samples, each with its part of the colour matching functions.
    pub fn new() -> Self {
        let mut bands = [[0.0; 3]; SAMPLES];
        let mut sums = [0.0; 3];
        for nanometres in observer::FIRST..=observer::LAST {
            // The nearest sample; of two as near, the lower.
            let nearest = (nanometres + (STEP - 1) / 2).saturating_sub(FIRST) / STEP;
            let band = &mut bands[SAMPLES.min(nearest as usize + 1) - 1];
            let matching = observer::matching(nanometres);
            for k in 0..3 {
                band[k] += matching[k];
                sums[k] += matching[k];
            }
        }
        let matrix = display::matrix();
        let colours = bands.map(|band| display::times(&matrix, [0, 1, 2].map(|k| band[k] / sums[k])));
        Sampled { to_display: [0, 1, 2].map(|k| colours.map(|colour| colour[k])) }
    }
}

impl Default for Sampled {
    fn default() -> Self {
        Sampled::new()
    }
}

/// The base spectra of red, green and blue: of all that lie within 0 and 1, add up to 1 and are the primaries on the display,
/// those with the least sum of squared steps from sample to sample.
#[rustfmt::skip]
const BASE: [[f64; SAMPLES]; 3] = [
    [0.037_508_645, 0.0, 0.0, 0.0, 0.0, 0.231_901_138, 0.942_207_199, 1.0, 0.946_579_967],
    [0.053_592_721, 0.0, 0.550_889_821, 1.0, 1.0, 0.768_098_862, 0.0, 0.0, 0.053_420_033],
    [0.908_898_634, 1.0, 0.449_110_179, 0.0, 0.0, 0.0, 0.057_792_801, 0.0, 0.0],
];

impl Basis<SAMPLES> for Sampled {
    fn parts(&self, [red, green, blue]: [f64; 3]) -> [f64; SAMPLES] {
        array::from_fn(|k| red * BASE[0][k] + green * BASE[1][k] + blue * BASE[2][k])
    }

    fn display(&self, light: [f64; SAMPLES]) -> [f64; 3] {
        self.to_display.map(|parts| parts.iter().zip(light).map(|(part, light)| part * light).sum())
    }

    fn indices(&self, metal: Metal) -> Option<[Index; SAMPLES]> {
        Some(array::from_fn(|k| metal::index(metal, f64::from(FIRST + STEP * k as u32))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The display's colour of a spectrum by steps of 1 nm.
    fn finely(spectrum: impl Fn(f64) -> f64) -> [f64; 3] {
        let (mut sum, mut white) = ([0.0; 3], [0.0; 3]);
        for nanometres in observer::FIRST..=observer::LAST {
            let (matching, share) = (observer::matching(nanometres), spectrum(f64::from(nanometres)));
            for k in 0..3 {
                sum[k] += share * matching[k];
                white[k] += matching[k];
            }
        }
        display::times(&display::matrix(), [0, 1, 2].map(|k| sum[k] / white[k]))
    }

    /// The colour of a metal at this cosine by nine samples.
    fn sampled(metal: Metal, cosine: f64) -> [f64; 3] {
        let basis = Sampled::new();
        basis.display(basis.indices(metal).expect("samples have wavelengths").map(|index| index.reflectance(cosine)))
    }

    /// The largest difference of two colours, as a part of the second's channels.
    fn differ(found: [f64; 3], expected: [f64; 3]) -> f64 {
        (0..3).map(|k| ((found[k] - expected[k]) / expected[k]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn white_under_equal_energy_light_is_neutral() {
        let basis = Sampled::new();
        for white in [basis.display([1.0; SAMPLES]), basis.display(basis.parts([1.0; 3])), finely(|_| 1.0)] {
            assert!(white.iter().all(|part| (part - 1.0).abs() < 1e-12), "{white:?}");
        }
    }

    #[test]
    fn colours_come_back_and_their_spectra_are_reflectances() {
        let basis = Sampled::new();
        for step in 0..11 * 11 * 11 {
            let colour = [step / 121, step / 11 % 11, step % 11].map(|part| f64::from(part) / 10.0);
            let spectrum = basis.parts(colour);
            assert!(spectrum.iter().all(|part| (0.0..=1.0).contains(part)), "{colour:?} {spectrum:?}");
            let back = basis.display(spectrum);
            assert!((0..3).all(|k| (back[k] - colour[k]).abs() < 1e-8), "{colour:?} {back:?}");
        }
    }

    #[test]
    fn each_metal_has_the_colour_of_its_whole_table() {
        for metal in Metal::ALL {
            for cosine in [1.0, 0.7, 0.3, 0.1] {
                let expected = finely(|nanometres| metal::index(metal, nanometres).reflectance(cosine));
                let found = sampled(metal, cosine);
                assert!(differ(found, expected) < 0.005, "{metal:?} at {cosine}: {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn a_metal_mirrored_in_a_metal_has_the_colour_of_their_tables() {
        let basis = Sampled::new();
        let spectrum =
            |metal| basis.indices(metal).expect("samples have wavelengths").map(|index| index.reflectance(1.0));
        let share = |metal, nanometres| metal::index(metal, nanometres).reflectance(1.0);
        for one in Metal::ALL {
            for other in Metal::ALL {
                let (a, b) = (spectrum(one), spectrum(other));
                let found = basis.display(array::from_fn(|k| a[k] * b[k]));
                let expected = finely(|nanometres| share(one, nanometres) * share(other, nanometres));
                assert!(differ(found, expected) < 0.01, "{one:?} in {other:?}: {found:?} {expected:?}");
            }
        }
    }

    /// Published colours come from other measurements: S. Lagarde, "Feeding a physically based shading model", 2011, cut off
    /// at 1. Of aluminium those agree, of the others each film was its own; that of gold and silver differs most in blue.
    #[test]
    fn metals_have_about_the_colours_that_others_publish() {
        for (metal, published, within) in [
            (Metal::Aluminium, [0.913_183, 0.921_494, 0.924_524], 0.01),
            (Metal::Copper, [0.955_008, 0.637_427, 0.538_163], 0.035),
            (Metal::Silver, [0.971_519, 0.959_915, 0.915_324], 0.07),
            (Metal::Gold, [1.0, 0.765_557, 0.336_057], 0.085),
        ] {
            let found = sampled(metal, 1.0).map(|part| part.min(1.0));
            assert!(differ(found, published) < within, "{metal:?} {found:?} {published:?}");
        }
    }
}
