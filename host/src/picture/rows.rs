//! Sets of a picture's rows, the top one being row 0.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Some rows of a picture, written as `A..B,C..D`: from row A up to B, which is not among them, and so on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rows {
    /// In rising order, none empty, and a gap between each and the next.
    runs: Vec<Range<u32>>,
}

impl Rows {
    /// All rows of a picture of this height.
    pub fn all(height: u32) -> Self {
        Rows::from(0..height)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.runs.iter().map(Range::len).sum()
    }

    /// Each of them, from the top.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        self.runs.iter().cloned().flatten()
    }

    /// Whether a row is among them.
    pub fn contains(&self, row: u32) -> bool {
        self.runs.iter().any(|run| run.contains(&row))
    }

    /// Those that are among both.
    pub fn within(&self, other: &Rows) -> Self {
        let common = |a: &Range<u32>, b: &Range<u32>| a.start.max(b.start)..a.end.min(b.end);
        let runs = self.runs.iter().flat_map(|a| other.runs.iter().map(move |b| common(a, b)));
        Rows { runs: runs.filter(|run| !run.is_empty()).collect() }
    }

    /// Those that are not among others.
    pub fn without(&self, other: &Rows) -> Self {
        let starts = std::iter::once(0).chain(other.runs.iter().map(|run| run.end));
        let ends = other.runs.iter().map(|run| run.start).chain(std::iter::once(u32::MAX));
        let gaps = starts.zip(ends).map(|(start, end)| start..end).filter(|run| !run.is_empty());
        self.within(&Rows { runs: gaps.collect() })
    }

    /// These, and others.
    pub fn with(&self, other: &Rows) -> Self {
        let mut all: Vec<_> = self.runs.iter().chain(&other.runs).cloned().collect();
        all.sort_unstable_by_key(|run| run.start);
        let mut runs: Vec<Range<u32>> = Vec::new();
        for run in all {
            match runs.last_mut() {
                Some(last) if run.start <= last.end => last.end = last.end.max(run.end),
                _ => runs.push(run),
            }
        }
        Rows { runs }
    }
}

impl From<Range<u32>> for Rows {
    fn from(run: Range<u32>) -> Self {
        Rows { runs: if run.is_empty() { Vec::new() } else { vec![run] } }
    }
}

impl FromIterator<u32> for Rows {
    fn from_iter<I: IntoIterator<Item = u32>>(rows: I) -> Self {
        rows.into_iter().fold(Rows::default(), |rows, row| rows.with(&Rows::from(row..row.saturating_add(1))))
    }
}

impl FromStr for Rows {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.trim().parse::<u32>().ok();
        let run = |part: &str| {
            let (from, to) = part.split_once("..")?;
            Some(number(from)?..number(to)?).filter(|run| !run.is_empty())
        };
        let runs: Option<Vec<_>> = text.split(',').map(run).collect();
        let runs =
            runs.ok_or("write A..B for the rows from A up to and without B, such as 0..512; several with commas")?;
        Ok(runs.into_iter().fold(Rows::default(), |rows, run| rows.with(&Rows::from(run))))
    }
}

impl fmt::Display for Rows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, Range { start, end }) in self.runs.iter().enumerate() {
            write!(f, "{}{start}..{end}", if k > 0 { "," } else { "" })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Rows {
        text.parse().expect("rows")
    }

    #[test]
    fn what_is_written_reads_back_joined_and_in_order() {
        for (text, joined) in [("0..4", "0..4"), ("7..9, 0..4", "0..4,7..9"), ("0..4,4..6,5..7", "0..7")] {
            assert_eq!(rows(text).to_string(), joined);
            assert_eq!(rows(joined), rows(text));
        }
        for text in ["", "4", "4..4", "5..4", "..4", "0..4,", "-1..4", "0..99999999999"] {
            assert!(text.parse::<Rows>().is_err(), "{text}");
        }
    }

    #[test]
    fn sets_are_joined_and_cut() {
        let (a, b) = (rows("0..4,8..12"), rows("2..10"));
        assert_eq!(a.with(&b), rows("0..12"));
        assert_eq!(a.without(&b), rows("0..2,10..12"));
        assert_eq!(a.within(&b), rows("2..4,8..10"));
        assert_eq!((a.len(), a.iter().max()), (8, Some(11)));
        assert!(a.without(&Rows::all(12)).is_empty());
        assert!(a.contains(8) && !a.contains(4));
    }
}
