//! Channels as OpenEXR: 32-bit numbers, compressed without loss.

use std::io::{self, BufRead, Cursor, Seek, Write};

use exr::meta::attribute::Text;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels, ReadLayers,
    WritableImage, read,
};

use super::{Channel, Channels, Values};

/// Writes the channels as one layer. The same channels give the same bytes.
///
/// # Errors
/// What `output` ran into, or a channel of which there are not as many numbers as pixels.
pub fn write(channels: &Channels, mut output: impl Write) -> io::Result<()> {
    let channel = |Channel { name, values }: &Channel| {
        let samples = match values {
            Values::Real(all) => FlatSamples::F32(all.clone()),
            Values::Count(all) => FlatSamples::U32(all.clone()),
        };
        // Counts and codes mean nothing in between.
        AnyChannel { quantize_linearly: false, ..AnyChannel::new(Text::from(name.as_str()), samples) }
    };
    let list = channels.all.iter().map(channel).collect();
    let size = channels.size.map(|side| side as usize);
    let attributes = LayerAttributes::default();
    let layer = Layer::new((size[0], size[1]), attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
    // The format goes back to fill in its table of places, which an output that is a pipe cannot.
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).map_err(failed)?;
    output.write_all(bytes.get_ref())
}

/// Reads all channels of all layers; those of a layer with a name are called `LAYER.CHANNEL`. Halves become floats.
///
/// # Errors
/// What is read is no such file, or has layers of different sizes.
pub fn decode(input: impl BufRead + Seek) -> io::Result<Channels> {
    let image = read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = image.from_buffered(input).map_err(failed)?;
    let mut channels = Channels { size: [0; 2], all: Vec::new() };
    for layer in image.layer_data {
        let size = [layer.size.width(), layer.size.height()].map(|side| side as u32);
        if !channels.all.is_empty() && size != channels.size {
            return Err(io::Error::other("its layers are of different sizes"));
        }
        channels.size = size;
        let prefix = layer.attributes.layer_name.map_or(String::new(), |name| format!("{name}."));
        for AnyChannel { name, sample_data, .. } in layer.channel_data.list {
            let values = match sample_data {
                FlatSamples::F16(all) => Values::Real(all.into_iter().map(|half| half.to_f32()).collect()),
                FlatSamples::F32(all) => Values::Real(all),
                FlatSamples::U32(all) => Values::Count(all),
            };
            channels.all.push(Channel { name: format!("{prefix}{name}"), values });
        }
    }
    Ok(channels)
}

fn failed(error: exr::error::Error) -> io::Error {
    match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_read_back_to_the_same_bits() {
        let real = vec![0.1, -0.0, f32::INFINITY, f32::MIN_POSITIVE, 3e38, 7.0];
        let channels = Channels {
            size: [3, 2],
            all: vec![
                Channel { name: "P.X".to_owned(), values: Values::Real(real) },
                Channel { name: "surface".to_owned(), values: Values::Count(vec![0, 1, 2, u32::MAX, 4, 5]) },
            ],
        };
        let mut bytes = Vec::new();
        write(&channels, &mut bytes).expect("memory does not fail");
        assert_eq!(decode(Cursor::new(&bytes)).expect("what was written"), channels);
        assert!(decode(Cursor::new(&bytes[..bytes.len() / 2])).is_err());
        assert!(decode(Cursor::new(b"no picture")).is_err());
    }

    #[test]
    fn what_is_no_number_stays_none() {
        let values = Values::Real(vec![f32::NAN]);
        let channels = Channels { size: [1, 1], all: vec![Channel { name: "u".to_owned(), values }] };
        let mut bytes = Vec::new();
        write(&channels, &mut bytes).expect("memory does not fail");
        assert!(decode(Cursor::new(&bytes)).expect("what was written").all[0].values.get(0).is_nan());
    }
}
