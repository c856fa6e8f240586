//! Where things are put: translations, rotations and scalings, one after another.
use serde::Deserialize;
use toml::{Spanned, Value};

use super::check::Check;
use super::error::InputError;
use crate::vector::length;

/// An affine map of points. It is applied to every point alike, so that points with the same bits keep the same bits: where
/// surfaces join, they still do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// The linear part, by rows, and what is added behind it. `None` where nothing is moved, which leaves all bits.
    map: Option<([[f64; 3]; 3], [f64; 3])>,
}

/// What a point is without a transform.
const UNMOVED: ([[f64; 3]; 3], [f64; 3]) = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]);

impl Transform {
    /// Moves nothing.
    pub const IDENTITY: Self = Transform { map: None };

    /// Adds `by` to every point.
    pub fn translation(by: [f64; 3]) -> Self {
        Transform { map: Some((UNMOVED.0, by)) }
    }

    /// Multiplies every coordinate about the origin by its factor.
    pub fn scaling(factors: [f64; 3]) -> Self {
        let rows = [0, 1, 2].map(|row| UNMOVED.0[row].map(|entry| entry * factors[row]));
        Transform { map: Some((rows, UNMOVED.1)) }
    }

    /// Turns about `axis` through the origin, which has to have a length, by `degrees`: counterclockwise for who looks against
    /// the axis. Quarter turns about a coordinate axis are exact.
    ///
    /// Source: O. Rodrigues' formula, `cos θ I + sin θ [a]ₓ + (1 − cos θ) a aᵀ` for a unit axis a.
    pub fn rotation(axis: [f64; 3], degrees: f64) -> Self {
        let length = length(axis);
        let a = axis.map(|x| x / length);
        let [cos, sin] = cos_sin(degrees);
        let cross = [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]];
        let rows = [0, 1, 2].map(|row| {
            [0, 1, 2].map(|k| cos * UNMOVED.0[row][k] + sin * cross[row][k] + (1.0 - cos) * (a[row] * a[k]))
        });
        Transform { map: Some((rows, UNMOVED.1)) }
    }

    /// This transform, and then `next`.
    pub fn then(self, next: Transform) -> Transform {
        let (Some((rows, by)), Some((next_rows, _))) = (self.map, next.map) else {
            return if self.map.is_some() { self } else { next };
        };
        let product = [0, 1, 2]
            .map(|row| [0, 1, 2].map(|k| (0..3).map(|inner| next_rows[row][inner] * rows[inner][k]).sum::<f64>()));
        Transform { map: Some((product, next.point(by))) }
    }

    /// Where `point` is put.
    pub fn point(&self, point: [f64; 3]) -> [f64; 3] {
        let Some((rows, by)) = self.map else {
            return point;
        };
        [0, 1, 2].map(|row| dot(rows[row], point) + by[row])
    }

    /// Whether every number in it is finite.
    fn is_finite(&self) -> bool {
        self.map.is_none_or(|(rows, by)| rows.iter().flatten().chain(&by).all(|x| x.is_finite()))
    }

    /// Whether a direction is lost, as by a scaling by 0. Of steps that lose none, the product does where it is too small for
    /// a number.
    pub(super) fn collapses(&self) -> bool {
        self.map.is_some_and(|(rows, _)| {
            rows.contains(&[0.0; 3]) || (0..3).any(|column| rows.iter().all(|row| row[column] == 0.0))
        })
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cosine and sine of an angle in degrees, exact at multiples of 90.
pub(super) fn cos_sin(degrees: f64) -> [f64; 2] {
    let turned = degrees.rem_euclid(360.0);
    match (turned / 90.0) as u8 {
        quarter if f64::from(quarter) * 90.0 == turned => {
            [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][usize::from(quarter) % 4]
        }
        _ => {
            let (sin, cos) = turned.to_radians().sin_cos();
            [cos, sin]
        }
    }
}

/// A step of a list `transform` as written: one of its fields.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StepTable {
    translate: Option<Spanned<Vec<f64>>>,
    rotate: Option<RotationTable>,
    scale: Option<Spanned<Value>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RotationTable {
    axis: Spanned<Vec<f64>>,
    degrees: Spanned<f64>,
}

/// The steps of a list `transform`, in their order.
pub(super) fn check(steps: &[Spanned<StepTable>], check: &Check) -> Result<Transform, InputError> {
    let mut all = Transform::IDENTITY;
    for step in steps {
        all = all.then(check_step(step, check)?);
        if !all.is_finite() {
            let help = "write smaller numbers";
            return Err(check.source.refuse(step.span(), "the transform moves points to infinity", "up to here", help));
        }
        if all.collapses() {
            let message = "the factors of `scale` multiply to 0, which leaves nothing to see";
            return Err(check.source.refuse(step.span(), message, "up to here", "write larger factors"));
        }
    }
    Ok(all)
}

fn check_step(step: &Spanned<StepTable>, check: &Check) -> Result<Transform, InputError> {
    match step.get_ref() {
        StepTable { translate: Some(by), rotate: None, scale: None } => {
            Ok(Transform::translation(check.triple("`translate`", by)?))
        }
        StepTable { translate: None, rotate: Some(RotationTable { axis, degrees }), scale: None } => {
            let direction = check.vector("`axis`", axis)?;
            if direction == [0.0; 3] {
                let help = "write the direction about which to turn, such as `axis = [0, 0, 1]`";
                return Err(check.source.refuse(axis.span(), "the axis of a rotation has no direction", "zero", help));
            }
            Ok(Transform::rotation(direction, check.finite("`degrees`", degrees)?))
        }
        StepTable { translate: None, rotate: None, scale: Some(scale) } => {
            let refuse = |message: &str| {
                let help = "write a number that is not 0, or three for x, y and z, such as `scale = [1, 1, 2]`";
                Err(check.source.refuse(scale.span(), message, "this scale", help))
            };
            let factors = match scale.get_ref() {
                Value::Array(list) => list.iter().map(number).collect::<Option<Vec<f64>>>(),
                one => number(one).map(|factor| vec![factor; 3]),
            };
            let Some(Ok(factors)) = factors.map(<[f64; 3]>::try_from) else {
                return refuse("`scale` is neither a number nor three numbers");
            };
            if factors.contains(&0.0) {
                return refuse("`scale` is 0, which leaves nothing to see");
            }
            if !factors.iter().all(|factor| factor.is_finite()) {
                return refuse("`scale` is not finite");
            }
            Ok(Transform::scaling(factors))
        }
        _ => Err(check.source.refuse(
            step.span(),
            "a step of a transform is one of `translate`, `rotate` and `scale`",
            "this step",
            "write a table for each step, in their order: `[{ scale = 2 }, { translate = [0, 0, 1] }]`",
        )),
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|whole| whole as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    const Z: [f64; 3] = [0.0, 0.0, 1.0];

    fn assert_near(a: [f64; 3], b: [f64; 3]) {
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-14), "{a:?} {b:?}");
    }

    #[test]
    fn steps_are_applied_in_their_order() {
        let (turn, away) = (Transform::rotation(Z, 90.0), Transform::translation([2.0, 0.0, 0.0]));
        assert_eq!(turn.then(away).point([1.0, 0.0, 0.0]), [2.0, 1.0, 0.0]);
        assert_eq!(away.then(turn).point([1.0, 0.0, 0.0]), [0.0, 3.0, 0.0]);
        let flat = Transform::scaling([3.0, 1.0, 0.5]);
        assert_eq!(turn.then(away).then(flat).point([1.0, 0.0, 8.0]), [6.0, 1.0, 4.0]);
    }

    #[test]
    fn nothing_to_do_leaves_the_bits() {
        let point = [-0.0, 1e-310, 0.1];
        assert_eq!(Transform::IDENTITY.point(point).map(f64::to_bits), point.map(f64::to_bits));
        let there = Transform::translation([0.1; 3]);
        assert_eq!(Transform::IDENTITY.then(there), there);
        assert_eq!(there.then(Transform::IDENTITY), there);
    }

    #[test]
    fn a_third_of_a_turn_about_the_diagonal_exchanges_the_axes() {
        let turn = Transform::rotation([2.0; 3], 120.0);
        assert_near(turn.point([1.0, 2.0, 3.0]), [3.0, 1.0, 2.0]);
        assert_near(turn.then(turn).then(turn).point([1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn quarters_are_exact_and_others_are_not_taken_for_them() {
        assert_eq!(
            [-90.0, 0.0, 90.0, 180.0, 630.0].map(cos_sin),
            [[0., -1.], [1., 0.], [0., 1.], [-1., 0.], [0., -1.]]
        );
        let [cos, sin] = cos_sin(-30.0);
        assert!((cos - 0.75f64.sqrt()).abs() < 1e-15 && (sin + 0.5).abs() < 1e-15);
        // So near to a whole turn that the rest of the division is the turn itself.
        assert_eq!(cos_sin(-1e-20), [1.0, 0.0]);
    }
}
