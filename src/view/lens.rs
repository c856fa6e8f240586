//! How a camera turns the frame, and where in the image it sees what.

use crate::frame::{Frame, NEAR};
use crate::outline::Outline;
use crate::ray::RayError;
use crate::scalar::{Scalar, Vector3};
use crate::surface::APART;

/// A pinhole camera, in the caller's coordinates: the ray of the image's point (x, y) starts at the eye and has the direction
/// `forward + x · right + y · up`. The four need not be of unit length nor at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera<S> {
    /// Where all rays start.
    pub eye: [S; 3],
    /// The direction of the image's middle, (0, 0).
    pub forward: [S; 3],
    /// What one unit of x adds.
    pub right: [S; 3],
    /// What one unit of y adds.
    pub up: [S; 3],
}

/// What a view holds beside its slots: plain numbers. "Turned" is: in the frame, with the third axis along `forward`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct ViewHeader<S> {
    /// The turned eye.
    pub(super) eye: [S; 3],
    /// The third turned coordinate at which depths of rays are 0: the middle of the scene.
    pub(super) middle: S,
    /// The turned vectors forward, right and up.
    pub(super) directions: [[S; 3]; 3],
    /// Units of the frame per caller's unit, and the inverse.
    pub(super) scale: S,
    pub(super) unscale: S,
    /// See [`Frame::farthest`].
    pub(super) farthest: S,
}

/// Why a camera can be no view's.
pub(super) enum Refusal {
    /// The ray of the image's middle, or one along one of its sides, cannot be traced.
    Ray(RayError),
    /// The camera's three vectors lie in a plane, or all but.
    Flat,
    /// The eye is too far away.
    Far,
}

/// How a camera turns the frame, and where in the image it sees points.
pub(super) struct Lens<S> {
    pub(super) header: ViewHeader<S>,
    /// Unit vectors, at right angles: the rows of the turn.
    pub(super) turn: [[S; 3]; 3],
    /// In the frame.
    eye: [S; 3],
    /// Of a point relative to the eye the products with these, divided by that with `along`, are its x and y.
    across: [[S; 3]; 2],
    along: [S; 3],
    /// The larger length of `across`, and that of `along`.
    lengths: [S; 2],
    /// By which powers of two x and y are then to be multiplied.
    exponents: [i32; 2],
}

/// Below this share of their lengths' product, the volume of the camera's vectors is taken for 0: it would be known to a few
/// digits only.
const LEAST_VOLUME: u32 = 1 << 10;

impl<S: Scalar> Lens<S> {
    /// Of a camera that looks at what a frame holds.
    pub(super) fn of(frame: &Frame<S>, camera: &Camera<S>) -> Result<Self, Refusal> {
        let Camera { eye, forward, right, up } = *camera;
        // The middle's ray stands for all others: theirs differ by a small factor.
        frame.ray(eye, forward).map_err(Refusal::Ray)?;
        for vector in [right, up] {
            frame.ray(eye, vector).map_err(Refusal::Ray)?;
        }
        let eye = frame.from_nets(frame.relative(eye));
        if !(S::Vec3::from_array(eye).largest() <= S::from_u32(NEAR)) {
            return Err(Refusal::Far);
        }
        // Each by a power of two of its own, so that products neither overflow nor vanish.
        let exponents = [forward, right, up].map(|vector| S::Vec3::from_array(vector).largest().binary_exponent());
        let scaled =
            |vector: [S; 3], exponent: i32| S::Vec3::from_array(vector.map(|c| c.times_power_of_two(-exponent)));
        let (f, r, u) = (scaled(forward, exponents[0]), scaled(right, exponents[1]), scaled(up, exponents[2]));
        let volume = f.dot(r.cross(u));
        let size = f.length() * r.length() * u.length();
        if !(volume.abs() > size * S::EPSILON * S::from_u32(LEAST_VOLUME)) {
            return Err(Refusal::Flat);
        }
        let sign = if volume < S::ZERO { -S::ONE } else { S::ONE };
        let (along, across) = (r.cross(u) * sign, [u.cross(f) * sign, f.cross(r) * sign]);
        let third = f.unit();
        let first = (r - third * third.dot(r)).unit();
        let second = third.cross(first);
        let turn = [first, second, third];
        let turned = |vector: [S; 3]| turn.map(|row| row.dot(S::Vec3::from_array(vector)));
        Ok(Lens {
            header: ViewHeader {
                eye: turned(eye),
                middle: S::ZERO,
                directions: [forward, right, up].map(turned),
                scale: frame.scale(),
                unscale: frame.unscale(),
                farthest: frame.farthest(camera.eye),
            },
            turn: turn.map(Vector3::to_array),
            eye,
            across: across.map(Vector3::to_array),
            along: along.to_array(),
            lengths: [across[0].length().greater(across[1].length()), along.length()],
            exponents: [exponents[0] - exponents[1], exponents[0] - exponents[2]],
        })
    }

    /// Whether the eye's coordinates are much smaller than the scene's: see [`Shape::is_apart`].
    pub(super) fn eye_is_apart(&self) -> bool {
        S::Vec3::from_array(self.eye).largest() < S::from_f32(APART)
    }

    /// Where what these points of the frame enclose is seen, and all that is as near to them as boxes are padded.
    pub(super) fn outline(&self, points: impl Iterator<Item = [S; 3]>) -> Outline<S> {
        let (mut outline, mut before, mut behind) = (Outline::NOWHERE, false, false);
        for point in points {
            let from_eye = S::Vec3::from_array(core::array::from_fn(|k| point[k] - self.eye[k]));
            let [across, along] = self.lengths;
            // What the padding and the rounding of these sums may come to.
            let off = Frame::<S>::padding() * (S::ONE + from_eye.length());
            let depth = S::Vec3::from_array(self.along).dot(from_eye);
            let least = off * along * S::TWO;
            if depth > least {
                let [x, y] = self.across.map(|row| S::Vec3::from_array(row).dot(from_eye) / depth);
                let margin = off * S::TWO * (across + x.abs().greater(y.abs()) * along) / depth;
                let [to_x, to_y] = self.exponents;
                let place = [x.times_power_of_two(to_x), y.times_power_of_two(to_y)];
                let margin = margin.times_power_of_two(to_x).greater(margin.times_power_of_two(to_y));
                outline = outline.with(place, margin);
                before = true;
            } else if depth < -least {
                behind = true;
            } else {
                (before, behind) = (true, true);
            }
        }
        // Rays look ahead only. What reaches from before the eye to behind it may be seen out to any edge.
        if before && behind { Outline::EVERYWHERE } else { outline }
    }
}
