//! A picture in the terminal: two pixels a character, in 24-bit colour.

use std::fmt::Write;

use console::Term;
use image::imageops;

use crate::picture::Picture;

/// As wide as this where there is no terminal.
const COLUMNS: u16 = 80;

/// The picture as text, as large as the terminal at standard error shows it whole.
pub(crate) fn of(picture: &Picture) -> String {
    let (rows, columns) = Term::stderr().size_checked().unwrap_or((COLUMNS / 2, COLUMNS));
    // A line is left for the prompt.
    in_characters(picture, [u32::from(columns), u32::from(rows.saturating_sub(1))])
}

/// The picture in at most so many columns and rows: the upper half block, its colour above and that of its ground below.
fn in_characters(picture: &Picture, [columns, rows]: [u32; 2]) -> String {
    let image = picture.to_image();
    let (width, height) = image.dimensions();
    if width == 0 || height == 0 {
        return String::new();
    }
    // Of the picture's shape, and never larger than it is.
    let scale = [(columns, width), (2 * rows, height)].map(|(room, side)| f64::from(room) / f64::from(side));
    let scale = scale[0].min(scale[1]).min(1.0);
    let [width, height] = [width, height].map(|side| ((f64::from(side) * scale).round() as u32).max(1));
    let small = imageops::thumbnail(&image, width, height);
    let mut text = String::new();
    for y in (0..height).step_by(2) {
        for x in 0..width {
            let [r, g, b] = small.get_pixel(x, y).0;
            // Writing to a string cannot fail.
            let _ = write!(text, "\x1b[38;2;{r};{g};{b}m");
            match small.get_pixel_checked(x, y + 1) {
                Some(image::Rgb([r, g, b])) => drop(write!(text, "\x1b[48;2;{r};{g};{b}m▀")),
                None => text.push_str("\x1b[49m▀"),
            }
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pixels_are_a_character() {
        let mut picture = Picture::new([1, 3]);
        [[1, 2, 3], [4, 5, 6], [7, 8, 9]].iter().for_each(|&pixel| picture.push_row(&[pixel]));
        let text = "\x1b[38;2;1;2;3m\x1b[48;2;4;5;6m▀\x1b[0m\n\x1b[38;2;7;8;9m\x1b[49m▀\x1b[0m\n";
        assert_eq!(in_characters(&picture, [80, 40]), text);
    }

    #[test]
    fn it_is_as_large_as_its_room_and_keeps_its_shape() {
        let mut picture = Picture::new([200, 100]);
        (0..100).for_each(|_| picture.push_row(&[[9; 3]; 200]));
        let shape = |room| {
            let text = in_characters(&picture, room);
            (text.lines().count(), text.lines().map(|line| line.matches('▀').count()).max())
        };
        assert_eq!(shape([80, 40]), (20, Some(80)));
        assert_eq!(shape([300, 10]), (10, Some(40)));
        assert_eq!(in_characters(&Picture::new([4, 0]), [80, 40]), "");
    }
}
