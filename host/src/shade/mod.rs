//! Light on surfaces: point lights, evenly scattered and as a highlight; surfaces have two sides.
//!
//! Source: J. F. Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977 (the highlight by the
//! half-way vector).

use crate::scene::appearance::{Light, Material};

pub mod painter;

/// The lights of a scene, ready to shade points.
#[derive(Clone, Debug, PartialEq)]
pub struct Shader {
    /// Each light's place and colour.
    lights: Vec<([f64; 3], [f64; 3])>,
}

impl Shader {
    /// The shader of a scene's lights; a light without a place is at the eye.
    pub fn new(eye: [f64; 3], lights: &[Light]) -> Self {
        Shader { lights: lights.iter().map(|light| (light.position.unwrap_or(eye), light.colour)).collect() }
    }

    /// The linear colour of a point with the unit normal `normal`, either side of it, as seen from `eye`; parts may exceed 1.
    /// A point without a normal is taken to face the eye.
    pub fn colour(&self, eye: [f64; 3], point: [f64; 3], normal: Option<[f64; 3]>, material: &Material) -> [f64; 3] {
        let Material { colour, ambient, diffuse, highlight, shininess, .. } = *material;
        let to_eye = unit(subtract(eye, point));
        let mut normal = normal.unwrap_or(to_eye);
        if dot(normal, to_eye) < 0.0 {
            normal = normal.map(|c| -c);
        }
        let mut sum = colour.map(|part| part * ambient);
        for &(light, light_colour) in &self.lights {
            let to_light = unit(subtract(light, point));
            // A light behind the surface, as seen from the eye, lights its other side.
            let facing = dot(normal, to_light).max(0.0);
            let half_way = unit([0, 1, 2].map(|k| to_eye[k] + to_light[k]));
            let spot = if facing > 0.0 { highlight * dot(normal, half_way).max(0.0).powf(shininess) } else { 0.0 };
            sum = [0, 1, 2].map(|k| sum[k] + light_colour[k] * (colour[k] * diffuse * facing + spot));
        }
        sum
    }
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector over its length; zero for a zero vector.
fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = vector[0].hypot(vector[1]).hypot(vector[2]);
    if length > 0.0 { vector.map(|c| c / length) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYE: [f64; 3] = [0.0, 0.0, 5.0];

    /// The colour of the origin under white lights at these places.
    fn colour(lights: &[[f64; 3]], normal: Option<[f64; 3]>) -> [f64; 3] {
        let base = Material { colour: [1.0, 0.5, 0.0], ambient: 0.1, diffuse: 0.6, ..Material::default() };
        let material = Material { highlight: 0.2, shininess: 8.0, ..base };
        let lights: Vec<_> = lights.iter().map(|&at| Light { position: Some(at), colour: [1.0; 3] }).collect();
        Shader::new(EYE, &lights).colour(EYE, [0.0; 3], normal, &material)
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

    #[test]
    fn a_light_at_the_point_is_no_light_but_a_colour() {
        assert!(colour(&[[0.0; 3]], None).iter().all(|c| c.is_finite()));
    }
}
