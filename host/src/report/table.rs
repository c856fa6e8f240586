//! A table of words and numbers, as text or as Markdown.

use std::fmt::Write as _;

/// A table. All rows have as many cells as there are columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// What stands above it.
    pub title: String,
    /// The columns: their heads, and whether what is in them is numbers, which stand to the right.
    pub columns: Vec<(&'static str, bool)>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// For reading as it is.
    Text,
    /// For a Markdown file.
    Markdown,
}

impl Table {
    /// The table as lines of text, each with its end.
    pub fn to_text(&self, style: Style) -> String {
        let heads: Vec<String> = self.columns.iter().map(|(head, _)| (*head).to_owned()).collect();
        let length = |text: &String| text.chars().count();
        let widths: Vec<usize> = (0..self.columns.len())
            .map(|k| {
                let cells = self.rows.iter().chain([&heads]).filter_map(|row| row.get(k));
                cells.map(length).max().unwrap_or(0)
            })
            .collect();
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = match style {
            Style::Text => writeln!(text, "{}", self.title),
            Style::Markdown => writeln!(text, "**{}**\n", self.title),
        };
        let row = |cells: &[String]| {
            let cells =
                cells.iter().zip(&widths).zip(&self.columns).map(|((cell, &width), &(_, number))| match style {
                    Style::Text if number => format!("{cell:>width$}"),
                    Style::Text => format!("{cell:<width$}"),
                    Style::Markdown => cell.replace('|', "\\|"),
                });
            let cells: Vec<String> = cells.collect();
            match style {
                Style::Text => cells.join("  ").trim_end().to_owned(),
                Style::Markdown => format!("| {} |", cells.join(" | ")),
            }
        };
        let _ = writeln!(text, "{}", row(&heads));
        if style == Style::Markdown {
            let sides = self.columns.iter().map(|&(_, number)| if number { "---:" } else { "---" });
            let _ = writeln!(text, "| {} |", sides.collect::<Vec<_>>().join(" | "));
        }
        for cells in &self.rows {
            let _ = writeln!(text, "{}", row(cells));
        }
        text
    }
}

/// 1234567 as `1,234,567`.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A share in percent, without a fraction: 0.204 as `20`, and -0.014 as `-1`.
pub fn percent(share: f64) -> String {
    let rounded = (100.0 * share).round();
    // Not "-0".
    format!("{:.0}", if rounded == 0.0 { 0.0 } else { rounded })
}

/// Seconds with three digits that count: 10.7, 8.57, 0.0431.
pub fn seconds(number: f64) -> String {
    let before = if number > 0.0 { number.log10().floor() as i32 + 1 } else { 1 };
    let after = (3 - before).clamp(0, 6) as usize;
    format!("{number:.after$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers() {
        assert_eq!([0, 999, 1000, 1234567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        assert_eq!([0.204, -0.014, -0.004, 1.0].map(percent), ["20", "-1", "0", "100"]);
        assert_eq!(
            [10.7, 8.57, 0.04312, 128.0, 0.0, 1.5].map(seconds),
            ["10.7", "8.57", "0.0431", "128", "0.00", "1.50"]
        );
    }

    #[test]
    fn text_and_markdown() {
        let table = Table {
            title: "Times".to_owned(),
            columns: vec![("what", false), ("s", true)],
            rows: vec![vec!["größer".to_owned(), "1".to_owned()], vec!["a|b".to_owned(), "234".to_owned()]],
        };
        assert_eq!(table.to_text(Style::Text), "Times\nwhat      s\ngrößer    1\na|b     234\n");
        let markdown = "**Times**\n\n| what | s |\n| --- | ---: |\n| größer | 1 |\n| a\\|b | 234 |\n";
        assert_eq!(table.to_text(Style::Markdown), markdown);
    }
}
