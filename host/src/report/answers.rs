//! The answers to a batch of rays, as CSV.
//!
//! The header is `ray,hit,t,u,v,patch,nx,ny,nz,status`; then a line per ray, in order. `ray` is its number from 0, `hit` is 1
//! for the statuses `ok`, `graze` and `contact` and 0 for `miss`, `gave-up:LIMIT` and `invalid`. Numbers are the shortest text
//! that reads back to the same bits in the precision they were computed in. Without a hit they are empty, except that a ray
//! that was given up has the best so far, which is not an answer.
//!
//! Where all hits were asked for, a ray has a line per hit, in order of t, and one line if it has none. The lines of a ray
//! that was given up have the hits found by then, with `hit` 0 and the status `gave-up:LIMIT`: there may be others. If the
//! limit is `hits`, there are more, farther ones.
use std::io::{self, Write};

use crate::number::{Number, Shortest};

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found<S> {
    /// The parameter of the ray, in units of its direction.
    pub t: S,
    /// The parameter of the surface in u, 0 to 1.
    pub u: S,
    /// The parameter of the surface in v, 0 to 1.
    pub v: S,
    /// The number of the surface in its patch file, or in the scene, from 0.
    pub patch: usize,
    /// The normal there; `None`, which leaves its fields empty, where there is none, as at the apex of a cone.
    pub normal: Option<[S; 3]>,
}

/// What a line says of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer<'a, S> {
    /// A hit: status `ok`.
    Hit(Found<S>),
    /// A hit, where the ray grazes the surface: status `graze`.
    Graze(Found<S>),
    /// A hit, where a stretch begins on which the ray lies in the surface: status `contact`.
    Contact(Found<S>),
    /// No hit: status `miss`.
    Miss,
    /// Out of budget: status `gave-up:` with the name of the limit.
    GaveUp {
        /// The limit that ran out.
        limit: &'a str,
        /// The closest hit so far, or one of all of them, if there was one.
        best: Option<Found<S>>,
    },
    /// The ray could not be traced: status `invalid`.
    Invalid,
}

impl<S> Answer<'_, S> {
    fn is_hit(&self) -> bool {
        matches!(self, Self::Hit(_) | Self::Graze(_) | Self::Contact(_))
    }

    fn found(&self) -> Option<&Found<S>> {
        match self {
            Self::Hit(found) | Self::Graze(found) | Self::Contact(found) => Some(found),
            Self::GaveUp { best, .. } => best.as_ref(),
            Self::Miss | Self::Invalid => None,
        }
    }

    fn status(&self) -> (&'static str, &str) {
        match self {
            Self::Hit(_) => ("ok", ""),
            Self::Graze(_) => ("graze", ""),
            Self::Contact(_) => ("contact", ""),
            Self::Miss => ("miss", ""),
            Self::GaveUp { limit, .. } => ("gave-up:", limit),
            Self::Invalid => ("invalid", ""),
        }
    }
}

/// Writes answers ray by ray; rays are numbered in the order in which they come.
///
/// ```
/// use patchray_host::report::answers::{Answer, Answers, Found};
/// let mut text = Vec::new();
/// let mut answers = Answers::new(&mut text)?;
/// answers.push([Answer::Hit(Found { t: 4.0_f32, u: 0.1, v: 1.0, patch: 7, normal: Some([0.0, 0.0, 1.0]) })])?;
/// answers.push([Answer::<f32>::Miss])?;
/// answers.finish()?;
/// assert_eq!(
///     String::from_utf8_lossy(&text),
///     "ray,hit,t,u,v,patch,nx,ny,nz,status\n0,1,4,0.1,1,7,0,0,1,ok\n1,0,,,,,,,,miss\n",
/// );
/// # Ok::<(), std::io::Error>(())
/// ```
pub struct Answers<W: Write> {
    csv: csv::Writer<W>,
    next: u64,
    /// The text of one field, kept between fields so that it is allocated once.
    field: String,
}

impl<W: Write> Answers<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// What `output` ran into.
    pub fn new(output: W) -> io::Result<Self> {
        let mut csv = csv::Writer::from_writer(output);
        csv.write_record(["ray", "hit", "t", "u", "v", "patch", "nx", "ny", "nz", "status"]).map_err(as_io)?;
        Ok(Self { csv, next: 0, field: String::new() })
    }

    /// Writes the lines of the next ray.
    ///
    /// # Errors
    /// What the output ran into.
    pub fn push<'a, S: Number + 'a>(&mut self, lines: impl IntoIterator<Item = Answer<'a, S>>) -> io::Result<()> {
        let ray = self.next;
        self.next += 1;
        lines.into_iter().try_for_each(|line| self.line(ray, &line))
    }

    fn line<S: Number>(&mut self, ray: u64, answer: &Answer<S>) -> io::Result<()> {
        self.write(format_args!("{ray}"))?;
        self.write(format_args!("{}", u8::from(answer.is_hit())))?;
        let found = answer.found();
        for number in [found.map(|found| found.t), found.map(|found| found.u), found.map(|found| found.v)] {
            self.number(number)?;
        }
        match found {
            Some(found) => self.write(format_args!("{}", found.patch))?,
            None => self.write(format_args!(""))?,
        }
        let normal = found.and_then(|found| found.normal);
        for axis in 0..3 {
            self.number(normal.map(|normal| normal[axis]))?;
        }
        let (status, limit) = answer.status();
        self.write(format_args!("{status}{limit}"))?;
        self.csv.write_record(None::<&[u8]>).map_err(as_io)
    }

    /// Writes out what is pending.
    ///
    /// # Errors
    /// What the output ran into.
    pub fn finish(mut self) -> io::Result<()> {
        self.csv.flush()
    }

    fn number<S: Number>(&mut self, number: Option<S>) -> io::Result<()> {
        match number {
            Some(number) => self.write(format_args!("{}", Shortest(number))),
            None => self.write(format_args!("")),
        }
    }

    fn write(&mut self, field: std::fmt::Arguments) -> io::Result<()> {
        self.field.clear();
        // Writing to a string cannot fail.
        let _ = std::fmt::Write::write_fmt(&mut self.field, field);
        self.csv.write_field(&self.field).map_err(as_io)
    }
}

/// What the output ran into, of its own kind: the conversion that `csv` brings would make a broken pipe any failure.
fn as_io(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(reason) => reason,
        other => io::Error::other(format!("{other:?}")),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn lines<S: Number>(answers: &[Answer<S>]) -> Vec<String> {
        let mut text = Vec::new();
        let mut writer = Answers::new(&mut text).expect("to memory");
        for &answer in answers {
            writer.push([answer]).expect("to memory");
        }
        writer.finish().expect("to memory");
        String::from_utf8(text).expect("UTF-8").lines().skip(1).map(str::to_owned).collect()
    }

    #[test]
    fn a_line_per_status() {
        let found = Found { t: 1.5e-9_f64, u: 0.25, v: 1.0, patch: 31, normal: None };
        let answers = [
            Answer::Hit(Found { normal: Some([-0.0, 1e300, 0.1]), ..found }),
            Answer::Graze(found),
            Answer::Contact(found),
            Answer::Miss,
            Answer::GaveUp { limit: "clip-steps", best: None },
            Answer::GaveUp { limit: "voxels", best: Some(found) },
            Answer::Invalid,
        ];
        let expected = [
            "0,1,1.5e-9,0.25,1,31,-0,1e300,0.1,ok",
            "1,1,1.5e-9,0.25,1,31,,,,graze",
            "2,1,1.5e-9,0.25,1,31,,,,contact",
            "3,0,,,,,,,,miss",
            "4,0,,,,,,,,gave-up:clip-steps",
            "5,0,1.5e-9,0.25,1,31,,,,gave-up:voxels",
            "6,0,,,,,,,,invalid",
        ];
        assert_eq!(lines(&answers), expected);
    }

    #[test]
    fn the_lines_of_a_ray_have_its_number() {
        let mut text = Vec::new();
        let mut writer = Answers::new(&mut text).expect("to memory");
        let found = Found { t: 1.0_f64, u: 0.5, v: 0.5, patch: 0, normal: None };
        for lines in [vec![Answer::Miss], vec![Answer::Hit(found), Answer::Graze(found)], vec![Answer::Miss]] {
            writer.push(lines).expect("to memory");
        }
        writer.finish().expect("to memory");
        let text = String::from_utf8(text).expect("UTF-8");
        let numbers: Vec<_> = text.lines().skip(1).map(|line| &line[..4]).collect();
        assert_eq!(numbers, ["0,0,", "1,1,", "1,1,", "2,0,"]);
    }

    #[test]
    fn an_empty_batch_has_a_header() {
        let mut text = Vec::new();
        Answers::new(&mut text).and_then(Answers::finish).expect("to memory");
        assert_eq!(text, b"ray,hit,t,u,v,patch,nx,ny,nz,status\n");
    }

    #[test]
    fn a_full_disk_is_an_error() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let error = Answers::new(Full).and_then(Answers::finish).expect_err("full");
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }

    proptest! {
        #[test]
        fn numbers_read_back(numbers in any::<[f32; 6]>(), patch in any::<usize>()) {
            let [t, u, v, nx, ny, nz] = numbers;
            let line = lines(&[Answer::Hit(Found { t, u, v, patch, normal: Some([nx, ny, nz]) })]).remove(0);
            let fields: Vec<_> = line.split(',').collect();
            for (slot, number) in [2, 3, 4, 6, 7, 8].into_iter().zip(numbers) {
                prop_assert_eq!(fields[slot].parse::<f32>().map(f32::to_bits), Ok(number.to_bits()));
            }
            prop_assert_eq!(fields[5].parse(), Ok(patch));
        }
    }
}
