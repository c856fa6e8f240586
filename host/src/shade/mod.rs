//! Light on surfaces: point lights, evenly scattered and as a highlight; surfaces have two sides.
//!
//! Source: J. F. Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977 (the highlight by the
//! half-way vector). The highlight of a metal is what it mirrors of the light at the angle to the half-way vector, as in R. L.
//! Cook and K. E. Torrance, "A reflectance model for computer graphics", ACM Transactions on Graphics 1 (1982), 7-24.
//!
//! Light has N parts: red, green and blue, or nine samples of its spectrum in a scene with a metal (see [`spectrum`]).

use std::array;

use crate::scene::light::Light;
use crate::vector::{dot, subtract, unit};
use finish::Finish;
use shadows::Facing;
use spectrum::Basis;

pub mod display;
mod face;
pub mod finish;
pub mod fresnel;
pub mod map;
pub mod metal;
pub mod observer;
pub mod painter;
pub mod shadows;
pub mod spectrum;

/// The lights of a scene, ready to shade points.
#[derive(Clone, Debug, PartialEq)]
pub struct Shader<const N: usize> {
    /// Each light's place and colour.
    lights: Vec<([f64; 3], [f64; N])>,
}

/// A light at a point: what it does there by angles alone.
#[derive(Clone, Copy, Debug)]
struct Lamp {
    /// The cosine between the normal and the light, or 0 if it is behind.
    facing: f64,
    /// The strength of the highlight.
    spot: f64,
    /// The cosine between the light and the half-way vector.
    half: f64,
}

/// The part of a light's colour that is not missed: where less of it comes from a point than this, it is not asked whether
/// the light reaches the point. By thirty times that, a dark pixel changes by one of 255 steps.
const UNSEEN: f64 = 1e-5;

impl<const N: usize> Shader<N> {
    /// The shader of a scene's lights; a light without a place is at the eye.
    pub fn new(eye: [f64; 3], lights: &[Light], basis: &impl Basis<N>) -> Self {
        let placed = |light: &Light| (light.position.unwrap_or(eye), basis.parts(light.colour));
        Shader { lights: lights.iter().map(placed).collect() }
    }

    /// The number of lights.
    pub fn lights(&self) -> usize {
        self.lights.len()
    }

    /// The light of a point with the unit normal `normal`, either side of it, as seen from `eye`; parts may exceed 1. A point
    /// without a normal is taken to face the eye. Of each light so much arrives as `shares` says, and all where it says
    /// nothing; `None` if that is not known of one.
    pub fn colour(
        &self,
        eye: [f64; 3],
        point: [f64; 3],
        normal: Option<[f64; 3]>,
        finish: &Finish<N>,
        shares: &[Option<f64>],
    ) -> Option<[f64; N]> {
        let Finish { colour, ambient, diffuse, metal, .. } = *finish;
        let (to_eye, normal) = turned(eye, point, normal);
        let mut sum = colour.map(|part| part * ambient);
        for (number, &(light, light_colour)) in self.lights.iter().enumerate() {
            let share = shares.get(number).copied().unwrap_or(Some(1.0))?;
            if share == 0.0 {
                continue;
            }
            let Lamp { facing, spot, half } = lamp(light, point, to_eye, normal, finish);
            sum = match metal {
                None => array::from_fn(|k| sum[k] + share * light_colour[k] * (colour[k] * diffuse * facing + spot)),
                Some(metal) if spot > 0.0 => {
                    array::from_fn(|k| sum[k] + share * light_colour[k] * spot * metal[k].reflectance(half))
                }
                Some(_) => sum,
            };
        }
        Some(sum)
    }

    /// The point as the light with this number sees it, if anything is seen of that light there.
    pub fn facing(
        &self,
        number: usize,
        eye: [f64; 3],
        point: [f64; 3],
        normal: Option<[f64; 3]>,
        finish: &Finish<N>,
    ) -> Option<Facing> {
        let &(light, _) = self.lights.get(number)?;
        let (to_eye, normal) = turned(eye, point, normal);
        let Lamp { facing, spot, .. } = lamp(light, point, to_eye, normal, finish);
        let scattered = if finish.metal.is_some() { 0.0 } else { finish.diffuse * facing };
        (scattered + spot > UNSEEN).then_some(Facing { point, normal, light, cosine: facing })
    }
}

/// The direction to the eye, and the normal on its side.
fn turned(eye: [f64; 3], point: [f64; 3], normal: Option<[f64; 3]>) -> ([f64; 3], [f64; 3]) {
    let to_eye = unit(subtract(eye, point));
    let normal = normal.unwrap_or(to_eye);
    (to_eye, if dot(normal, to_eye) < 0.0 { normal.map(|c| -c) } else { normal })
}

fn lamp<const N: usize>(
    light: [f64; 3],
    point: [f64; 3],
    to_eye: [f64; 3],
    normal: [f64; 3],
    finish: &Finish<N>,
) -> Lamp {
    let to_light = unit(subtract(light, point));
    // A light behind the surface, as seen from the eye, lights its other side.
    let facing = dot(normal, to_light).max(0.0);
    let half_way = unit([0, 1, 2].map(|k| to_eye[k] + to_light[k]));
    let spot =
        if facing > 0.0 { finish.highlight * dot(normal, half_way).max(0.0).powf(finish.shininess) } else { 0.0 };
    Lamp { facing, spot, half: dot(half_way, to_light) }
}

#[cfg(test)]
mod tests {
    use super::spectrum::{Rgb, Sampled};
    use super::*;
    use crate::scene::appearance::{Material, Metal};

    const EYE: [f64; 3] = [0.0, 0.0, 5.0];

    /// The colour of the origin under white lights at these places.
    fn colour(lights: &[[f64; 3]], normal: Option<[f64; 3]>) -> [f64; 3] {
        let base = Material { colour: [1.0, 0.5, 0.0], ambient: 0.1, diffuse: 0.6, ..Material::default() };
        let material = Material { highlight: 0.2, shininess: 8.0, ..base };
        let lights: Vec<_> = lights.iter().map(|&at| Light { position: Some(at), ..Light::default() }).collect();
        Shader::new(EYE, &lights, &Rgb)
            .colour(EYE, [0.0; 3], normal, &Finish::new(&material, &Rgb), &[])
            .expect("no share is missing")
    }

    fn assert_near(found: [f64; 3], expected: [f64; 3]) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    }

    #[test]
    fn straight_light_is_ambient_diffuse_and_highlight() {
        let up = Some([0.0, 0.0, 1.0]);
        assert_near(colour(&[EYE], up), [0.9, 0.55, 0.2]);
        assert_near(colour(&[EYE], None), [0.9, 0.55, 0.2]);
        // Both sides are alike.
        assert_near(colour(&[EYE], Some([0.0, 0.0, -1.0])), [0.9, 0.55, 0.2]);
    }

    #[test]
    fn a_light_behind_leaves_the_ambient_part() {
        assert_near(colour(&[[0.0, 0.0, -5.0]], Some([0.0, 0.0, 1.0])), [0.1, 0.05, 0.0]);
    }

    #[test]
    fn lights_add_up_and_the_ambient_part_does_not() {
        let up = Some([0.0, 0.0, 1.0]);
        assert_near(colour(&[EYE, EYE], up), [1.7, 1.05, 0.4]);
        assert_near(colour(&[], up), [0.1, 0.05, 0.0]);
    }

    /// White evenly scattered, under a white light: in nine samples the grey that it is in red, green and blue.
    #[test]
    fn white_under_white_light_stays_neutral() {
        let material = Material { colour: [1.0; 3], ambient: 0.1, diffuse: 0.6, highlight: 0.0, ..Material::default() };
        let light = Light { position: Some([3.0, 0.0, 4.0]), ..Light::default() };
        let basis = Sampled::new();
        let shader = Shader::new(EYE, &[light], &basis);
        let found = shader.colour(EYE, [0.0; 3], Some([0.0, 0.0, 1.0]), &Finish::new(&material, &basis), &[]);
        let shown = basis.display(found.expect("no share is missing"));
        assert!(shown.iter().all(|part| (part - (0.1 + 0.6 * 0.8)).abs() < 1e-8), "{shown:?}");
    }

    /// Of a metal only the highlight is seen, as strong as what the metal mirrors at the half of the angle.
    #[test]
    fn the_highlight_of_a_metal_is_what_it_mirrors() {
        let material = Material { metal: Some(Metal::Gold), highlight: 0.5, shininess: 1.0, ..Material::default() };
        let basis = Sampled::new();
        let finish = Finish::new(&material, &basis);
        // Toward the eye and toward the light it is 53.13 degrees, of which the half has the cosine √0.8.
        let light = Light { position: Some([4.0, 0.0, 3.0]), ..Light::default() };
        let found = Shader::new(EYE, &[light], &basis).colour(EYE, [0.0; 3], Some([0.0, 0.0, 1.0]), &finish, &[]);
        let gold = finish.metal.expect("gold is a metal");
        for (found, index) in found.expect("no share is missing").into_iter().zip(gold) {
            let cosine = 0.8f64.sqrt();
            assert!((found - 0.5 * cosine * index.reflectance(cosine)).abs() < 1e-12);
        }
        let dark = Shader::new(EYE, &[], &basis).colour(EYE, [0.0; 3], None, &finish, &[]);
        assert_eq!(dark, Some([0.0; 9]));
    }

    #[test]
    fn a_light_at_the_point_is_no_light_but_a_colour() {
        assert!(colour(&[[0.0; 3]], None).iter().all(|c| c.is_finite()));
    }
}
