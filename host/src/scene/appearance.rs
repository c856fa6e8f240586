//! What a picture looks like: its size and samples, materials, the background.
use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::error::InputError;
use super::light::{Light, Shadow};
use super::polygon::Polygon;
use super::sampling::Sampling;

/// The most pixels along a side of an image. More would let a slip of the pen ask for terabytes.
pub const MAX_SIDE: u32 = 32_768;

/// The table `[image]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width and height in pixels, each from 1 to [`MAX_SIDE`]. By default 512 × 512.
    pub size: [u32; 2],
    /// How many samples a pixel has, and where. By default one.
    pub samples: Sampling,
}

impl Default for Image {
    fn default() -> Self {
        Self { size: [512, 512], samples: Sampling::default() }
    }
}

/// A metal, whose measured optical constants say how it mirrors light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Metal {
    /// Aluminium.
    Aluminium,
    /// Copper.
    Copper,
    /// Gold.
    Gold,
    /// Silver.
    Silver,
}

impl Metal {
    /// All metals, by name.
    pub const ALL: [Metal; 4] = [Metal::Aluminium, Metal::Copper, Metal::Gold, Metal::Silver];
}

/// The table `[material]`, or one of `[materials]`: how surfaces and polygons return the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Red, green and blue, linear, 0 to 1. By default a light grey.
    pub colour: [f64; 3],
    /// The part of the colour that is seen without light. By default 0.15.
    pub ambient: f64,
    /// The part of the light that is scattered evenly. By default 0.7.
    pub diffuse: f64,
    /// The strength of the highlight. By default 0.3.
    pub highlight: f64,
    /// The exponent of the highlight, above 0: the larger, the smaller the spot. By default 40.
    pub shininess: f64,
    /// The share of what is seen that is a mirror's picture, 0 to 1; the rest is the other fields'. By default 0. Of a
    /// metal, what remains of the light that Fresnel's equations let it mirror; the rest is lost. By default 1.
    pub reflect: f64,
    /// The metal that it is, if any: it mirrors by its optical constants, also its highlight, and scatters no light, so that
    /// `colour`, `ambient` and `diffuse` mean nothing.
    pub metal: Option<Metal>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            colour: [0.8; 3],
            ambient: 0.15,
            diffuse: 0.7,
            highlight: 0.3,
            shininess: 40.0,
            reflect: 0.0,
            metal: None,
        }
    }
}

/// All that a picture needs beside what rays meet on surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Appearance {
    /// The lights.
    pub lights: Vec<Light>,
    /// The materials, the first of which is that of the scene itself.
    pub materials: Vec<Material>,
    /// For each surface, by its index in the model, the index of its material. A surface without an entry has the first.
    pub surfaces: Vec<usize>,
    /// The polygons, each with the index of its material.
    pub polygons: Vec<(Polygon, usize)>,
    /// The colour where there is nothing: red, green and blue, linear, 0 to 1.
    pub background: [f64; 3],
}

impl Appearance {
    /// Whether a surface or a polygon is of metal, for which red, green and blue do not do.
    pub fn has_metal(&self) -> bool {
        let polygons = self.polygons.iter().map(|(_, material)| material);
        let mut used = self.surfaces.iter().chain(polygons).filter_map(|&index| self.materials.get(index));
        used.any(|material| material.metal.is_some())
    }

    /// Whether a light's shadows are found by rays.
    pub fn has_shadow_rays(&self) -> bool {
        self.lights.iter().any(|light| light.shadow == Shadow::Rays)
    }
}

/// The background where a scene file gives none: white.
pub(super) const BACKGROUND: [f64; 3] = [1.0; 3];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImageTable {
    size: Option<Spanned<Vec<i128>>>,
    samples: Option<Sampling>,
}

impl ImageTable {
    pub(super) fn check(&self, check: &Check) -> Result<Image, InputError> {
        let samples = self.samples.unwrap_or_default();
        let Some(size) = &self.size else {
            return Ok(Image { samples, ..Image::default() });
        };
        let side = |side: i128| u32::try_from(side).ok().filter(|side| (1..=MAX_SIDE).contains(side));
        match size.get_ref().iter().map(|&given| side(given)).collect::<Vec<_>>()[..] {
            [Some(width), Some(height)] => Ok(Image { size: [width, height], samples }),
            _ => Err(check.source.refuse(
                size.span(),
                "this is not the size of an image",
                format!("not two numbers from 1 to {MAX_SIDE}"),
                "write width and height in pixels, such as `size = [512, 512]`",
            )),
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    colour: Option<Spanned<Vec<f64>>>,
    ambient: Option<Spanned<f64>>,
    diffuse: Option<Spanned<f64>>,
    highlight: Option<Spanned<f64>>,
    shininess: Option<Spanned<f64>>,
    reflect: Option<Spanned<f64>>,
    metal: Option<Metal>,
}

impl MaterialTable {
    pub(super) fn check(&self, check: &Check) -> Result<Material, InputError> {
        let mut material = Material::default();
        if let Some(metal) = self.metal {
            self.scatters_nothing(check)?;
            material = Material { metal: Some(metal), reflect: 1.0, ..material };
        }
        if let Some(colour) = &self.colour {
            material.colour = check.colour("`colour` of the material", colour)?;
        }
        for (name, given, value) in [
            ("`ambient`", &self.ambient, &mut material.ambient),
            ("`diffuse`", &self.diffuse, &mut material.diffuse),
            ("`highlight`", &self.highlight, &mut material.highlight),
        ] {
            if let Some(given) = given {
                *value = check.amount(name, given)?;
            }
        }
        if let Some(shininess) = &self.shininess {
            material.shininess = check.positive("`shininess`", shininess)?;
        }
        if let Some(reflect) = &self.reflect {
            material.reflect = check.part("`reflect`", reflect)?;
        }
        Ok(material)
    }

    /// Refuses what a metal does not have.
    fn scatters_nothing(&self, check: &Check) -> Result<(), InputError> {
        let colour = self.colour.as_ref().map(|colour| ("colour", colour.span()));
        let ambient = self.ambient.as_ref().map(|ambient| ("ambient", ambient.span()));
        let diffuse = self.diffuse.as_ref().map(|diffuse| ("diffuse", diffuse.span()));
        let Some((name, span)) = colour.or(ambient).or(diffuse) else {
            return Ok(());
        };
        Err(check.source.refuse(
            span,
            format!("`{name}` means nothing for a metal"),
            "beside `metal`",
            format!("leave `{name}` out: a metal scatters no light, and its colour is that of its optical constants"),
        ))
    }
}
