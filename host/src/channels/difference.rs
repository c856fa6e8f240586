//! How two pictures differ: by channel in numbers, and as a picture.

use serde::Serialize;

use super::{Channel, Channels, Values};
use crate::picture::{Picture, Rgb};

/// How two pictures of one size differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// How many pixels each has.
    pub pixels: u64,
    /// How many differ, in whichever channel that both have.
    pub differing: u64,
    /// The channels that both have.
    pub channels: Vec<OfChannel>,
    /// Channels that the second picture has not.
    pub only_in_first: Vec<String>,
    /// Channels that the first picture has not.
    pub only_in_second: Vec<String>,
    /// Which pixels differ.
    #[serde(skip)]
    marks: Vec<bool>,
}

/// How a channel differs, in its own units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OfChannel {
    /// Its name.
    pub name: String,
    /// How many pixels differ by more than the tolerance.
    pub differing: u64,
    /// Of these, those with a number in one of the pictures that is infinite or none, and another in the other.
    pub without_distance: u64,
    /// The largest difference of two finite numbers.
    pub largest: f64,
    /// Where it is, from the left and the top; nowhere if it is 0.
    pub at: Option<[u32; 2]>,
    /// The mean of the differences of finite numbers.
    pub mean: f64,
    /// The root of the mean of their squares.
    pub rms: f64,
}

impl Difference {
    /// Compares pictures of one size; `None` if they are of two. Numbers differ if they are farther apart than `tolerance`, or
    /// one of them is infinite or no number and the other is not the same.
    pub fn of(first: &Channels, second: &Channels, tolerance: f64) -> Option<Self> {
        if first.size != second.size {
            return None;
        }
        let mut marks = vec![false; first.pixels()];
        let mut channels = Vec::new();
        for channel in &first.all {
            if let Some(other) = second.named(&channel.name) {
                channels.push(OfChannel::of([channel, other], first.size[0], tolerance, &mut marks));
            }
        }
        let only = |a: &Channels, b: &Channels| {
            let names = a.all.iter().map(|channel| &channel.name);
            names.filter(|name| b.named(name).is_none()).cloned().collect()
        };
        Some(Difference {
            pixels: marks.len() as u64,
            differing: marks.iter().filter(|&&mark| mark).count() as u64,
            channels,
            only_in_first: only(first, second),
            only_in_second: only(second, first),
            marks,
        })
    }

    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        self.differing == 0 && self.only_in_first.is_empty() && self.only_in_second.is_empty()
    }

    /// A picture of it: what differs stands out of what the first one shows, darkened.
    pub fn picture(&self, first: &Channels) -> Picture {
        let shades: Vec<&Channel> = ["R", "G", "B"].iter().filter_map(|name| first.named(name)).collect();
        let shade = |pixel: usize| match shades.as_slice() {
            [r, g, b] => [r, g, b].map(|channel| match &channel.values {
                Values::Count(all) => all.get(pixel).map_or(0, |&value| value.min(255) as u8 / 4),
                Values::Real(_) => 0,
            }),
            _ => [0; 3],
        };
        let mut picture = Picture::new(first.size);
        let pixels: Vec<Rgb> =
            self.marks.iter().enumerate().map(|(k, &mark)| if mark { DIFFERS } else { shade(k) }).collect();
        pixels.chunks(first.size[0].max(1) as usize).for_each(|row| picture.push_row(row));
        picture
    }
}

/// What a pixel of the picture is where something differs.
pub const DIFFERS: Rgb = [255, 0, 255];

impl OfChannel {
    fn of([first, second]: [&Channel; 2], width: u32, tolerance: f64, marks: &mut [bool]) -> Self {
        let mut of = OfChannel {
            name: first.name.clone(),
            differing: 0,
            without_distance: 0,
            largest: 0.0,
            at: None,
            mean: 0.0,
            rms: 0.0,
        };
        let mut count = 0.0;
        for (pixel, mark) in marks.iter_mut().enumerate() {
            let [a, b] = [first, second].map(|channel| channel.values.get(pixel));
            let distance = (a - b).abs();
            let differs = if distance.is_finite() {
                count += 1.0;
                of.mean += distance;
                of.rms += distance * distance;
                if distance > of.largest {
                    of.largest = distance;
                    of.at = Some([pixel as u32 % width, pixel as u32 / width]);
                }
                distance > tolerance
            } else {
                let differs = a != b && !(a.is_nan() && b.is_nan());
                of.without_distance += u64::from(differs);
                differs
            };
            of.differing += u64::from(differs);
            *mark |= differs;
        }
        if count > 0.0 {
            of.mean /= count;
            of.rms = (of.rms / count).sqrt();
        }
        of
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channels(all: &[(&str, Values)]) -> Channels {
        let channel = |(name, values): &(&str, Values)| Channel { name: (*name).to_owned(), values: values.clone() };
        Channels { size: [2, 2], all: all.iter().map(channel).collect() }
    }

    #[test]
    fn what_differs_is_counted_and_placed() {
        let a = channels(&[("R", Values::Count(vec![8, 8, 8, 8])), ("Z", Values::Real(vec![1.0, 2.0, 3.0, 4.0]))]);
        let b = channels(&[("R", Values::Count(vec![8, 8, 11, 9])), ("Z", Values::Real(vec![1.0, 2.5, 3.0, 4.0]))]);
        let found = Difference::of(&a, &b, 0.0).expect("one size");
        assert_eq!((found.pixels, found.differing, found.is_none()), (4, 3, false));
        let OfChannel { differing, largest, at, mean, rms, .. } = &found.channels[0];
        assert_eq!((*differing, *largest, *at, *mean), (2, 3.0, Some([0, 1]), 1.0));
        assert!((rms - 2.5_f64.sqrt()).abs() < 1e-15);
        assert_eq!(Difference::of(&a, &b, 1.0).expect("one size").differing, 1);
        assert!(Difference::of(&a, &b, 3.0).expect("one size").is_none());
        assert!(Difference::of(&a, &a, 0.0).expect("one size").is_none());
        assert_eq!(Difference::of(&a, &Channels { size: [4, 1], ..a.clone() }, 0.0), None);
    }

    #[test]
    fn nothing_is_nothing_and_no_number() {
        let (nan, inf) = (f32::NAN, f32::INFINITY);
        let a = channels(&[("u", Values::Real(vec![nan, inf, nan, -inf]))]);
        let b = channels(&[("u", Values::Real(vec![nan, inf, 0.0, inf]))]);
        let found = Difference::of(&a, &b, 1e9).expect("one size");
        assert_eq!((found.channels[0].differing, found.channels[0].without_distance), (2, 2));
        assert_eq!(found.channels[0].at, None);
    }

    #[test]
    fn channels_of_one_picture_alone_differ() {
        let (a, b) = (channels(&[("u", Values::Count(vec![0; 4]))]), channels(&[("v", Values::Count(vec![0; 4]))]));
        let found = Difference::of(&a, &b, 0.0).expect("one size");
        assert!(!found.is_none());
        assert_eq!((found.only_in_first, found.only_in_second), (vec!["u".to_owned()], vec!["v".to_owned()]));
    }

    #[test]
    fn the_picture_shows_what_differs() {
        let grey = |shade| ["R", "G", "B"].map(|name| (name, Values::Count(vec![shade, 8, 8, 8])));
        let (a, b) = (channels(&grey(8)), channels(&grey(9)));
        let shown = Difference::of(&a, &b, 0.0).expect("one size").picture(&a);
        assert_eq!(shown.rows().map(<[Rgb]>::to_vec).collect::<Vec<_>>(), [[DIFFERS, [2; 3]], [[2; 3]; 2]]);
    }
}
