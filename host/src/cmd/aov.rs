//! The channels that `render --aov` writes: all as OpenEXR, or one as a heat map.

use std::path::{Path, PathBuf};

use super::{Failure, progress_in_rows};
use crate::channels::heat::{self, Scale};
use crate::channels::{exr, seen};
use crate::output;
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::scene::nearest::did_you_mean;
use crate::settings::Settings;

/// Channels to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Aov {
    /// All, as OpenEXR.
    All(PathBuf),
    /// The channel of a name, as a picture.
    Heat(&'static str, PathBuf),
}

impl Aov {
    /// Where to.
    pub fn path(&self) -> &Path {
        match self {
            Aov::All(path) | Aov::Heat(_, path) => path,
        }
    }
}

/// `FILE.exr`, or `NAME=FILE.png`.
pub fn parse(text: &str) -> Result<Aov, String> {
    let ends = |path: &str, with| Path::new(path).extension().is_some_and(|end| end.eq_ignore_ascii_case(with));
    match text.split_once('=') {
        Some((name, _)) if ends(text, "exr") && seen::names().any(|known| known == name) => {
            Err(format!("OpenEXR holds all channels: write FILE.exr, or {name}=FILE.png for `{name}` as a heat map"))
        }
        _ if ends(text, "exr") => Ok(Aov::All(text.into())),
        Some((name, path)) if ends(path, "png") => match seen::names().find(|known| *known == name) {
            Some(name) => Ok(Aov::Heat(name, path.into())),
            None => {
                let names: Vec<_> = seen::names().collect();
                let near = did_you_mean(name, &names).unwrap_or_default();
                Err(format!("there is no channel `{name}`{near}; there are {}", names.join(", ")))
            }
        },
        _ => Err("write FILE.exr for all channels, or NAME=FILE.png for one as a heat map".to_owned()),
    }
}

/// Traces the view's channels and writes them.
///
/// # Errors
/// Too little memory, or an output that cannot be written.
pub fn write(aovs: &[Aov], model: &Model, settings: &Settings, view: &View, quiet: bool) -> Result<(), Failure> {
    let bar = progress_in_rows(u64::from(view.size[1]), u64::from(view.size[0]), "channels", quiet);
    let channels = seen::of_view(model, settings, view, &bar)?;
    bar.finish_and_clear();
    let bounds = model.control_box().ok_or_else(|| Failure::Internal("a scene without surfaces".to_owned()))?;
    for aov in aovs {
        match aov {
            Aov::All(path) => output::write(path, |file| exr::write(&channels, file))?,
            Aov::Heat(name, path) => {
                let scale = Scale::of(name, &bounds, view);
                let Some(picture) = heat::picture(&channels, name, &scale) else {
                    return Err(Failure::Usage {
                        message: format!("this method has no channel `{name}`"),
                        help: "patches are of Newton's methods and the coherent ones".to_owned(),
                    });
                };
                output::write(path, |file| picture.write_png(file))?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_are_told_apart() {
        assert_eq!(parse("a=b.exr"), Ok(Aov::All("a=b.exr".into())));
        assert_eq!(parse("newton_steps=s.PNG"), Ok(Aov::Heat("newton_steps", "s.PNG".into())));
        assert!(parse("newton_step=s.png").is_err_and(|message| message.contains("did you mean `newton_steps`")));
        for wrong in ["", "s.png", "u=s.exr.txt", "u"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
