//! Channels: numbers by pixel, one picture's worth for each name.

pub mod difference;
pub mod exr;
pub mod heat;
pub mod read;
pub mod seen;

/// The numbers of a channel, from the left of the top row.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Measures.
    Real(Vec<f32>),
    /// Counts, numbers of things, and codes.
    Count(Vec<u32>),
}

impl Values {
    /// The number of a pixel, 0 being the left one of the top row; NaN where there is none.
    pub fn get(&self, pixel: usize) -> f64 {
        match self {
            Values::Real(all) => all.get(pixel).map_or(f64::NAN, |&value| f64::from(value)),
            Values::Count(all) => all.get(pixel).map_or(f64::NAN, |&value| f64::from(value)),
        }
    }
}

/// A channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name, such as `newton_steps` or `P.X`.
    pub name: String,
    /// Its numbers, one for each pixel.
    pub values: Values,
}

/// Channels of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Channels {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The channels, no two of one name.
    pub all: Vec<Channel>,
}

impl Channels {
    /// The channel of a name.
    pub fn named(&self, name: &str) -> Option<&Channel> {
        self.all.iter().find(|channel| channel.name == name)
    }

    /// How many pixels there are.
    pub fn pixels(&self) -> usize {
        self.size.iter().map(|&side| side as usize).product()
    }
}
