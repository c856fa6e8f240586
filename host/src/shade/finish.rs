//! How a surface returns light, by the parts in which the scene's light is counted.

use super::fresnel::Index;
use super::spectrum::Basis;
use crate::scene::appearance::Material;

/// A material, its colours in N parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish<const N: usize> {
    /// The colour; nothing for a metal, which scatters no light.
    pub colour: [f64; N],
    /// As [`Material::ambient`].
    pub ambient: f64,
    /// As [`Material::diffuse`].
    pub diffuse: f64,
    /// As [`Material::highlight`].
    pub highlight: f64,
    /// As [`Material::shininess`].
    pub shininess: f64,
    /// As [`Material::reflect`].
    pub reflect: f64,
    /// Of a metal, its index for each part.
    pub metal: Option<[Index; N]>,
}

/// What a mirror makes of a point's own light and its picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror<const N: usize> {
    /// The share of its own light that is seen.
    pub own: f64,
    /// The share of its picture that is seen.
    pub picture: [f64; N],
}

impl<const N: usize> Finish<N> {
    /// A material in the parts of `basis`.
    pub fn new(material: &Material, basis: &impl Basis<N>) -> Self {
        let Material { colour, ambient, diffuse, highlight, shininess, reflect, metal } = *material;
        let metal = metal.and_then(|metal| basis.indices(metal));
        let colour = if metal.is_some() { [0.0; N] } else { basis.parts(colour) };
        Finish { colour, ambient, diffuse, highlight, shininess, reflect, metal }
    }

    /// What the surface mirrors of a ray that comes at this cosine to its normal; `None` for a surface that is no mirror.
    pub fn mirror(&self, cosine: f64) -> Option<Mirror<N>> {
        let reflect = self.reflect;
        (reflect > 0.0).then(|| match self.metal {
            // Its own light is but the highlight, which is mirrored light too.
            Some(metal) => Mirror { own: 1.0, picture: metal.map(|index| reflect * index.reflectance(cosine)) },
            None => Mirror { own: 1.0 - reflect, picture: [reflect; N] },
        })
    }
}

impl<const N: usize> Mirror<N> {
    /// A point's own light with the mirror's picture.
    pub fn with(&self, own: [f64; N], picture: [f64; N]) -> [f64; N] {
        std::array::from_fn(|k| self.own * own[k] + self.picture[k] * picture[k])
    }
}
