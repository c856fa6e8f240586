//! One pixel of a picture: what became of its rays, and on request how.

use std::io::Write as _;
use std::path::Path;

use super::Failure;
use super::load::Loaded;
use crate::explain::of_pixel;
use crate::output::Output;
use crate::scene::camera::View;

/// Prints the answers of a pixel's rays, `pixel` being its place from the left and the top; with `explain` the story of each.
///
/// # Errors
/// There is no such pixel, too little memory, or nobody reads what is printed.
pub fn run(loaded: &Loaded, view: &View, pixel: [u32; 2], explain: bool) -> Result<(), Failure> {
    let [px, py] = pixel;
    let [width, height] = view.size;
    if px >= width || py >= height {
        return Err(Failure::Usage {
            message: format!("there is no pixel {px},{py}: the picture has {width} x {height}"),
            help: "count from 0, from the left and from the top".to_owned(),
        });
    }
    let settings = &loaded.settings;
    let name = |surface| {
        let file = loaded.file_of(surface).map_or(String::new(), |file| format!(" ({})", file.name));
        format!("surface {surface}{file}")
    };
    let stories = of_pixel(&loaded.model, settings, view, pixel)?;
    let mut text = String::new();
    for (number, story) in (1..).zip(&stories) {
        let of = if stories.len() > 1 { format!(", sample {number} of {}", stories.len()) } else { String::new() };
        let (method, precision) = (settings.method.name(), format!("{:?}", settings.precision).to_lowercase());
        text += &format!("pixel {px},{py}{of}, by {method} in {precision}:\n");
        let words = story.words(&loaded.model, name);
        if explain {
            text += &words;
        } else {
            text.extend(words.lines().rev().nth(1).map(|answer| format!("{answer}\n")));
        }
        if let Some(residual) = story.residual(&loaded.model) {
            text += &format!("the surface's point there is {residual:.3e} off the ray's\n");
        }
    }
    let mut out = Output::create(Path::new("-"))?;
    out.write_all(text.as_bytes()).map_err(|reason| out.failed(reason))?;
    Ok(out.finish()?)
}

/// `X,Y`
pub fn parse(text: &str) -> Result<[u32; 2], String> {
    let place = text.split_once(',').and_then(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]));
    place.ok_or("write X,Y: counted from 0, from the left and from the top".to_owned())
}
