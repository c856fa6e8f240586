//! Parts of a picture: some of its rows, to be put together with those of other runs.
//!
//! A part is a PNG of the whole picture's size, transparent where rows are missing. Two texts in the file say which rows it has,
//! and of which job it is, so that rows of different pictures are never put together.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::Path;

use thiserror::Error;

use super::{Picture, Rgb};
use crate::picture::rows::Rows;
use crate::scene::appearance::MAX_SIDE;

/// The names of the file's texts.
const JOB: &str = "patchray job";
const ROWS: &str = "patchray rows";

/// Some rows of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    size: [u32; 2],
    job: String,
    rows: BTreeMap<u32, Vec<Rgb>>,
}

/// Why a file is no part, or does not belong to another one.
#[derive(Debug, Error)]
pub enum PartError {
    /// It cannot be read.
    #[error("it cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// It is no PNG.
    #[error("it is no PNG: {0}")]
    NotPng(#[from] png::DecodingError),
    /// It does not say, as parts do, which rows it has.
    #[error(
        "it does not say which rows it has: it was not drawn with --rows, and is not what an interrupted run has left"
    )]
    NotPart,
    /// It is one, and damaged.
    #[error("it is damaged: {0}")]
    Damaged(&'static str),
    /// The two are of different pictures.
    #[error("it is of another picture: scene, size, samples, method, precision, limits or version differ")]
    OtherJob,
    /// Both have a row, and not the same.
    #[error("its row {0} is not what another part has drawn")]
    Differs(u32),
}

impl Part {
    /// A part without rows of a picture of this size: width and height. Parts of equal `job` are of one picture.
    pub fn new(size: [u32; 2], job: String) -> Self {
        Part { size, job, rows: BTreeMap::new() }
    }

    /// Which rows it has.
    pub fn rows(&self) -> Rows {
        self.rows.keys().copied().collect()
    }

    /// Those that it has not.
    pub fn missing(&self) -> Rows {
        Rows::all(self.size[1]).without(&self.rows())
    }

    /// Adds rows that were drawn: all those of `picture`, which are these of the whole.
    pub fn add(&mut self, rows: &Rows, picture: &Picture) {
        self.rows.extend(rows.iter().zip(picture.rows().map(<[Rgb]>::to_vec)));
    }

    /// Adds what another part has.
    ///
    /// # Errors
    /// It is of another picture, or both have a row that is not the same; nothing is added then.
    pub fn join(&mut self, other: Part) -> Result<(), PartError> {
        if (self.size, &self.job) != (other.size, &other.job) {
            return Err(PartError::OtherJob);
        }
        let differs = |(row, theirs): &(&u32, &Vec<Rgb>)| self.rows.get(row).is_some_and(|own| own != *theirs);
        if let Some((&row, _)) = other.rows.iter().find(differs) {
            return Err(PartError::Differs(row));
        }
        self.rows.extend(other.rows);
        Ok(())
    }

    /// The picture, if no row is missing.
    pub fn whole(&self) -> Option<Picture> {
        let mut picture = Picture::new(self.size);
        self.rows.values().for_each(|row| picture.push_row(row));
        self.missing().is_empty().then_some(picture)
    }

    /// Reads a part.
    ///
    /// # Errors
    /// The file is none.
    pub fn read(path: &Path) -> Result<Self, PartError> {
        let mut reader = png::Decoder::new(BufReader::new(File::open(path)?)).read_info()?;
        let info = reader.info();
        let text = |name| {
            let found = info.uncompressed_latin1_text.iter().find(|text| text.keyword == name);
            found.map(|found| found.text.clone()).ok_or(PartError::NotPart)
        };
        let (job, rows, size) = (text(JOB)?, text(ROWS)?, [info.width, info.height]);
        if (info.color_type, info.bit_depth) != (png::ColorType::Rgba, png::BitDepth::Eight) {
            return Err(PartError::Damaged("its pixels are not of 8 bits with transparency"));
        }
        if size.iter().any(|side| *side > MAX_SIDE) {
            return Err(PartError::Damaged("it is larger than any picture"));
        }
        let rows = if rows.is_empty() { Ok(Rows::default()) } else { rows.parse::<Rows>() };
        let rows = rows.map_err(|_| PartError::Damaged("its list of rows is none"))?;
        if !rows.without(&Rows::all(size[1])).is_empty() {
            return Err(PartError::Damaged("it lists rows below its last one"));
        }
        let mut bytes = vec![0; reader.output_buffer_size().unwrap_or(0)];
        reader.next_frame(&mut bytes)?;
        let mut part = Part::new(size, job);
        for (row, pixels) in (0..).zip(bytes.chunks_exact(4 * size[0] as usize)) {
            if rows.contains(row) {
                let pixels = pixels.as_chunks::<4>().0;
                if pixels.iter().any(|pixel| pixel[3] != OPAQUE) {
                    return Err(PartError::Damaged("a row that it lists is not there"));
                }
                part.rows.insert(row, pixels.iter().map(|&[r, g, b, _]| [r, g, b]).collect());
            }
        }
        Ok(part)
    }

    /// Writes the part as PNG. The same part gives the same bytes.
    ///
    /// # Errors
    /// What `output` ran into.
    pub fn write_png(&self, output: impl Write) -> io::Result<()> {
        let [width, height] = self.size;
        let mut encoder = png::Encoder::new(output, width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.add_text_chunk(JOB.to_owned(), self.job.clone())?;
        encoder.add_text_chunk(ROWS.to_owned(), self.rows().to_string())?;
        let mut bytes = Vec::new();
        let nothing = vec![0; 4 * width as usize];
        for row in 0..height {
            match self.rows.get(&row) {
                Some(pixels) => bytes.extend(pixels.iter().flat_map(|&[r, g, b]| [r, g, b, OPAQUE])),
                None => bytes.extend(&nothing),
            }
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&bytes)?;
        Ok(writer.finish()?)
    }
}

/// A pixel's fourth byte where it was drawn.
const OPAQUE: u8 = 255;

#[cfg(test)]
mod tests {
    use super::*;

    /// A part of a picture of 2 × 4 pixels, whose rows are of this shade.
    fn part(rows: &str, shade: u8) -> Part {
        let rows: Rows = rows.parse().expect("rows");
        let mut picture = Picture::new([2, rows.len() as u32]);
        rows.iter().for_each(|row| picture.push_row(&[[row as u8, shade, 0]; 2]));
        let mut part = Part::new([2, 4], "a job".to_owned());
        part.add(&rows, &picture);
        part
    }

    fn written(bytes: &[u8]) -> Result<Part, PartError> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("part.png");
        std::fs::write(&path, bytes).expect("written");
        Part::read(&path)
    }

    fn png(part: &Part) -> Vec<u8> {
        let mut png = Vec::new();
        part.write_png(&mut png).expect("memory does not fail");
        png
    }

    #[test]
    fn a_part_reads_back() {
        for part in [part("1..2,3..4", 7), Part::new([2, 4], "another".to_owned())] {
            assert_eq!(written(&png(&part)).expect("a part"), part);
        }
        let shown = image::load_from_memory(&png(&part("1..2", 7))).expect("a picture").to_rgba8();
        assert_eq!((shown.get_pixel(0, 1).0, shown.get_pixel(0, 2).0), ([1, 7, 0, 255], [0; 4]));
    }

    #[test]
    fn parts_make_the_whole() {
        let mut all = part("0..1,3..4", 7);
        assert_eq!((all.missing().to_string().as_str(), all.whole()), ("1..3", None));
        // A row may come twice.
        all.join(part("1..4", 7)).expect("it is of the same picture");
        let shades: Vec<u8> = all.whole().expect("it is").rows().map(|row| row[0][0]).collect();
        assert_eq!(shades, [0, 1, 2, 3]);
    }

    #[test]
    fn what_does_not_belong_together_is_refused() {
        let mut own = part("0..2", 7);
        assert!(matches!(own.join(part("1..3", 8)), Err(PartError::Differs(1))));
        assert!(matches!(own.join(Part::new([2, 4], "another".to_owned())), Err(PartError::OtherJob)));
        assert!(matches!(own.join(Part::new([4, 2], "a job".to_owned())), Err(PartError::OtherJob)));
        assert_eq!(own, part("0..2", 7));
    }

    #[test]
    fn other_files_are_refused() {
        let mut whole = Vec::new();
        let mut picture = Picture::new([1, 1]);
        picture.push_row(&[[1, 2, 3]]);
        picture.write_png(&mut whole).expect("memory does not fail");
        assert!(matches!(written(&whole), Err(PartError::NotPart)));
        assert!(matches!(written(b"P6 1 1"), Err(PartError::NotPng(_))));
        let mut cut = png(&part("0..4", 7));
        cut.truncate(cut.len() - 30);
        assert!(matches!(written(&cut), Err(PartError::NotPng(_))));
        assert!(matches!(Part::read(Path::new("/nowhere/part.png")), Err(PartError::Unreadable(_))));
    }
}
