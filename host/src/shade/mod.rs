//! Light on surfaces: one point light, evenly scattered and as a highlight; surfaces have two sides.
//!
//! Source: J. F. Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977 (the highlight by the
//! half-way vector).

use crate::scene::appearance::{Light, Material};

/// A light and a material, ready to shade points seen from `eye`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shader {
    eye: [f64; 3],
    light: [f64; 3],
    light_colour: [f64; 3],
    material: Material,
}

impl Shader {
    /// The shader of a scene's tables; a light without a place is at the eye.
    pub fn new(eye: [f64; 3], light: &Light, material: &Material) -> Self {
        let position = light.position.unwrap_or(eye);
        Shader { eye, light: position, light_colour: light.colour, material: *material }
    }

    /// The linear colour of a point with the unit normal `normal`, either side of it; parts may exceed 1. A point without a
    /// normal is taken to face the eye.
    pub fn colour(&self, point: [f64; 3], normal: Option<[f64; 3]>) -> [f64; 3] {
        let Material { colour, ambient, diffuse, highlight, shininess } = self.material;
        let to_eye = unit(subtract(self.eye, point));
        let to_light = unit(subtract(self.light, point));
        let mut normal = normal.unwrap_or(to_eye);
        if dot(normal, to_eye) < 0.0 {
            normal = normal.map(|c| -c);
        }
        // A light behind the surface, as seen from the eye, lights its other side.
        let facing = dot(normal, to_light).max(0.0);
        let half_way = unit([0, 1, 2].map(|k| to_eye[k] + to_light[k]));
        let spot = if facing > 0.0 { highlight * dot(normal, half_way).max(0.0).powf(shininess) } else { 0.0 };
        [0, 1, 2].map(|k| colour[k] * ambient + self.light_colour[k] * (colour[k] * diffuse * facing + spot))
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

    fn shader(light: [f64; 3]) -> Shader {
        let material = Material { colour: [1.0, 0.5, 0.0], ambient: 0.1, diffuse: 0.6, highlight: 0.2, shininess: 8.0 };
        Shader::new(EYE, &Light { position: Some(light), colour: [1.0; 3] }, &material)
    }

    fn assert_near(found: [f64; 3], expected: [f64; 3]) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    }

    #[test]
    fn straight_light_is_ambient_diffuse_and_highlight() {
        let up = Some([0.0, 0.0, 1.0]);
        assert_near(shader(EYE).colour([0.0; 3], up), [0.9, 0.55, 0.2]);
        assert_near(shader(EYE).colour([0.0; 3], None), [0.9, 0.55, 0.2]);
        // Both sides are alike.
        assert_near(shader(EYE).colour([0.0; 3], Some([0.0, 0.0, -1.0])), [0.9, 0.55, 0.2]);
    }

    #[test]
    fn a_light_behind_leaves_the_ambient_part() {
        assert_near(shader([0.0, 0.0, -5.0]).colour([0.0; 3], Some([0.0, 0.0, 1.0])), [0.1, 0.05, 0.0]);
    }

    #[test]
    fn a_light_at_the_point_is_no_light_but_a_colour() {
        assert!(shader([0.0; 3]).colour([0.0; 3], None).iter().all(|c| c.is_finite()));
    }
}
