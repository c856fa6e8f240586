//! Lights: points that shine, and how their shadows are found.
use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::error::InputError;

/// The table `[light]`, or one of `[[lights]]`: a point that shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is, in the units of the surfaces. By default at the camera's eye: `None`.
    pub position: Option<[f64; 3]>,
    /// Its colour: red, green and blue, linear, 0 to 1. By default white.
    pub colour: [f64; 3],
    /// How its shadows are found. By default it casts none.
    pub shadow: Shadow,
}

impl Default for Light {
    fn default() -> Self {
        Self { position: None, colour: [1.0; 3], shadow: Shadow::None }
    }
}

/// How the shadows of a light are found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shadow {
    /// It casts none: it shines through everything.
    #[default]
    None,
    /// By a ray from each lit point to the light.
    Rays,
    /// By a map of what the light sees.
    Map(MapOptions),
}

/// How a shadow map is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapOptions {
    /// Its width and height in texels, 1 to [`MAX_MAP_SIDE`]. By default 1024. More make the edges of shadows sharper and
    /// take more time and memory, both by the square.
    pub size: u32,
    /// How far above itself, along its normal, a surface is held against the map, in widths of a texel there. By default 0.5.
    /// Less lets curved surfaces darken themselves in specks where the light grazes them, since the map knows them at
    /// the middles of its texels alone; more lets light in where a shadow begins, below what lies on a surface.
    pub bias: f64,
}

impl Default for MapOptions {
    fn default() -> Self {
        Self { size: 1024, bias: 0.5 }
    }
}

/// The most texels along a side of a shadow map: one takes 12 bytes, so that the largest takes 800 MB, and six times that where
/// it has six faces.
pub const MAX_MAP_SIDE: u32 = 8192;

/// How the shadows of a light are found, as written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ShadowKind {
    #[default]
    None,
    Rays,
    Map,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    position: Option<Spanned<Vec<f64>>>,
    colour: Option<Spanned<Vec<f64>>>,
    shadow: Option<ShadowKind>,
    map_size: Option<Spanned<i128>>,
    map_bias: Option<Spanned<f64>>,
}

impl LightTable {
    pub(super) fn check(&self, check: &Check) -> Result<Light, InputError> {
        let mut light = Light::default();
        if let Some(position) = &self.position {
            light.position = Some(check.triple("`position` of the light", position)?);
        }
        if let Some(colour) = &self.colour {
            light.colour = check.colour("`colour` of the light", colour)?;
        }
        light.shadow = match self.shadow.unwrap_or_default() {
            ShadowKind::Map => Shadow::Map(self.map(check)?),
            other => {
                self.has_no_map(check)?;
                if other == ShadowKind::Rays { Shadow::Rays } else { Shadow::None }
            }
        };
        Ok(light)
    }

    fn map(&self, check: &Check) -> Result<MapOptions, InputError> {
        let mut map = MapOptions::default();
        if let Some(size) = &self.map_size {
            map.size = check.whole("`map_size`", size, 1..=MAX_MAP_SIDE)?;
        }
        if let Some(bias) = &self.map_bias {
            map.bias = check.amount("`map_bias`", bias)?;
        }
        Ok(map)
    }

    /// Refuses what a light without a map does not have.
    fn has_no_map(&self, check: &Check) -> Result<(), InputError> {
        let size = self.map_size.as_ref().map(|size| ("map_size", size.span()));
        let bias = self.map_bias.as_ref().map(|bias| ("map_bias", bias.span()));
        let Some((name, span)) = size.or(bias) else {
            return Ok(());
        };
        let help = "write `shadow = \"map\"` beside it, or leave it out";
        Err(check.source.refuse(span, format!("`{name}` means nothing without a shadow map"), "of this light", help))
    }
}
