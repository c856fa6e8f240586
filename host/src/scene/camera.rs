//! The camera: the ray of each sample.
use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::error::InputError;
use super::sampling::{self, Sampling, ScanLine};
use crate::vector::length;

/// A camera as a scene file gives it, in one of two ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// By the vectors that directions are made of: see [`View`], which this is but for the size of the image.
    Vectors {
        /// Where rays start, in the units of the surfaces.
        eye: [f64; 3],
        /// The direction of the middle of the image.
        forward: [f64; 3],
        /// What is added to it toward the right edge of the image.
        right: [f64; 3],
        /// What is added to it toward the top edge of the image.
        up: [f64; 3],
    },
    /// By what it looks at.
    LookAt {
        /// Where rays start, in the units of the surfaces.
        eye: [f64; 3],
        /// The point in the middle of the image.
        look_at: [f64; 3],
        /// What is upward in the image; need not be at a right angle to the view. By default [0, 0, 1].
        up: [f64; 3],
        /// The angle in degrees between the top and the bottom edge of the image, above 0 and below 180. By default 40.
        fov: f64,
    },
}

/// The rays of an image of a given size. A sample with the image coordinates (sx, sy) has the direction
/// forward + sx · right + sy · up. Pixels are square, and coordinates go from -1 to 1 over the longer side of the image from
/// edge to edge: with W and H its width and height and S the larger of the two, the centre of pixel (px, py), py = 0 being
/// the top row, is at sx = (2 px − (W − 1)) / S and sy = ((H − 1) − 2 py) / S. Which samples there are says
/// [`View::sampling`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where all rays start.
    pub eye: [f64; 3],
    /// The direction of the middle of the image.
    pub forward: [f64; 3],
    /// What is added to it toward the right.
    pub right: [f64; 3],
    /// What is added to it toward the top.
    pub up: [f64; 3],
    /// Width and height in pixels, each at least 1.
    pub size: [u32; 2],
    /// Where pixels are sampled.
    pub sampling: Sampling,
}

/// How near to flat the three vectors of a camera may be: the volume that they span, each divided by its length. More
/// refuses views of a very narrow angle; less lets through pixels whose rays have, after rounding, no direction.
const FLAT: f64 = 1e-9;

impl Camera {
    /// The rays of an image of `size`: width and height in pixels, each at least 1. One sample per pixel; for others see
    /// [`View::sampled`].
    pub fn view(&self, size: [u32; 2]) -> View {
        let sampling = Sampling::One;
        match *self {
            Self::Vectors { eye, forward, right, up } => View { eye, forward, right, up, size, sampling },
            Self::LookAt { eye, look_at, up, fov } => {
                let forward = unit([0, 1, 2].map(|axis| look_at[axis] - eye[axis]));
                let right = unit(cross(forward, unit(up)));
                let upward = cross(right, forward);
                // The top edge of the image, half a pixel above the top row, has sy = H / S.
                let [width, height] = size.map(f64::from);
                let half = (fov.to_radians() / 2.0).tan() * width.max(height) / height;
                let (right, up) = (right.map(|x| half * x), upward.map(|x| half * x));
                View { eye, forward, right, up, size, sampling }
            }
        }
    }

    /// The same camera, its eye turned about the point that it looks at: by so many degrees to the right about `up`, and by so many
    /// upward. A camera by vectors is turned about the end of `forward`.
    pub fn turned(&self, right: f64, upward: f64) -> Self {
        let view = self.view([1, 1]);
        let up = match *self {
            Self::Vectors { up, .. } | Self::LookAt { up, .. } => up,
        };
        let turn = |vector: [f64; 3]| {
            let level = about(unit(up), right.to_radians(), vector);
            about(about(unit(up), right.to_radians(), unit(view.right)), -upward.to_radians(), level)
        };
        match *self {
            Self::Vectors { eye, forward, right, up } => {
                let turned = turn(forward);
                let eye = [0, 1, 2].map(|k| eye[k] + forward[k] - turned[k]);
                Self::Vectors { eye, forward: turned, right: turn(right), up: turn(up) }
            }
            Self::LookAt { eye, look_at, up, fov } => {
                let back = turn([0, 1, 2].map(|k| eye[k] - look_at[k]));
                Self::LookAt { eye: [0, 1, 2].map(|k| look_at[k] + back[k]), look_at, up, fov }
            }
        }
    }
}

impl View {
    /// The same view with pixels sampled so.
    pub fn sampled(self, sampling: Sampling) -> View {
        View { sampling, ..self }
    }

    /// The number of scan lines: one for each row of samples.
    pub fn scan_lines(&self) -> u32 {
        self.sampling.side() * self.size[1]
    }

    /// The samples of scan line `line`, 0 being the top one.
    pub fn scan_line(&self, line: u32) -> ScanLine {
        sampling::scan_line(self.sampling, self.size, line)
    }

    /// The direction, not normalised, of the ray of the sample with these image coordinates.
    pub fn towards(&self, [sx, sy]: [f64; 2]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.forward[axis] + sx * self.right[axis] + sy * self.up[axis])
    }

    /// The direction, not normalised, of the ray through the centre of pixel (`px`, `py`), (0, 0) being the top left one.
    pub fn direction(&self, px: u32, py: u32) -> [f64; 3] {
        let [width, height] = self.size.map(f64::from);
        let longer = width.max(height);
        let sx = (2.0 * f64::from(px) - (width - 1.0)) / longer;
        let sy = ((height - 1.0) - 2.0 * f64::from(py)) / longer;
        self.towards([sx, sy])
    }
}

/// The table `[camera]` as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    eye: Option<Spanned<Vec<f64>>>,
    forward: Option<Spanned<Vec<f64>>>,
    right: Option<Spanned<Vec<f64>>>,
    up: Option<Spanned<Vec<f64>>>,
    look_at: Option<Spanned<Vec<f64>>>,
    fov: Option<Spanned<f64>>,
}

/// The two ways, for messages.
const WAYS: &str = "give `eye`, `look_at` and perhaps `up` and `fov`; or `eye`, `forward`, `right` and `up`";

impl CameraTable {
    pub(super) fn check(table: &Spanned<Self>, check: &Check) -> Result<Camera, InputError> {
        let Self { eye, forward, right, up, look_at, fov } = table.get_ref();
        let vectors = forward.as_ref().or(right.as_ref()).map(|vector| vector.span());
        let looking = look_at.as_ref().map(|point| point.span()).or(fov.as_ref().map(|fov| fov.span()));
        let missing = |name: &str| {
            let message = format!("the camera lacks `{name}`");
            check.source.refuse(table.span(), message, "this camera", WAYS)
        };
        let eye = check.triple("`eye`", eye.as_ref().ok_or_else(|| missing("eye"))?)?;
        match (vectors, looking) {
            (Some(_), Some(looking)) => Err(check.source.refuse(
                looking,
                "the camera is given in two ways: `look_at` and `fov` exclude `forward` and `right`",
                "one or the other",
                WAYS,
            )),
            (None, None) => Err(missing("look_at")),
            (Some(_), None) => {
                let vector = |name: &str, vector: &Option<Spanned<Vec<f64>>>| {
                    check.vector(&format!("`{name}`"), vector.as_ref().ok_or_else(|| missing(name))?)
                };
                let forward = vector("forward", forward)?;
                let (right, up) = (vector("right", right)?, vector("up", up)?);
                let camera = Camera::Vectors { eye, forward, right, up };
                if dot(unit(forward), cross(unit(right), unit(up))).abs() > FLAT {
                    return Ok(camera);
                }
                Err(check.source.refuse(
                    table.span(),
                    "`forward`, `right` and `up` lie in one plane, or one of them is zero",
                    "this camera",
                    "give three vectors that point in different directions",
                ))
            }
            (None, Some(_)) => {
                let point = look_at.as_ref().ok_or_else(|| missing("look_at"))?;
                let look_at = check.triple("`look_at`", point)?;
                let toward = [0, 1, 2].map(|axis| look_at[axis] - eye[axis]);
                if !length(toward).is_finite() {
                    return Err(check.source.refuse(
                        point.span(),
                        "the camera looks too far away",
                        "more than 1.7e308 from `eye`",
                        "write smaller numbers",
                    ));
                }
                let forward = unit(toward);
                // A direction that could not be found is NaN, which is not above anything.
                let directed = dot(forward, forward) > 0.5;
                if !directed {
                    return Err(check.source.refuse(
                        point.span(),
                        "the camera looks at the point where it is",
                        "the same as `eye`, or too near to tell a direction",
                        "move `eye` or `look_at`",
                    ));
                }
                let upward = up.as_ref().map_or(Ok([0.0, 0.0, 1.0]), |up| check.vector("`up`", up))?;
                let side = cross(forward, unit(upward));
                let across = dot(side, side).sqrt() > FLAT;
                if !across {
                    return Err(check.source.refuse(
                        up.as_ref().map_or(point.span(), |up| up.span()),
                        "the camera looks straight along `up`, or `up` is zero",
                        if up.is_some() { "this direction" } else { "`up` is [0, 0, 1] where it is not given" },
                        "give an `up` that is across the view, such as `up = [0, 1, 0]`",
                    ));
                }
                let angle = fov.as_ref().map_or(40.0, |fov| *fov.get_ref());
                if !(angle > 0.0 && angle < 180.0) {
                    return Err(check.source.refuse(
                        fov.as_ref().map_or(table.span(), |fov| fov.span()),
                        format!("the field of view is {angle} degrees"),
                        "not between 0 and 180",
                        "give the angle from the top to the bottom of the image in degrees, such as `fov = 40`",
                    ));
                }
                Ok(Camera::LookAt { eye, look_at, up: upward, fov: angle })
            }
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector turned about a unit axis (Rodrigues).
fn about(axis: [f64; 3], angle: f64, vector: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let (across, along) = (cross(axis, vector), dot(axis, vector) * (1.0 - cos));
    [0, 1, 2].map(|k| vector[k] * cos + across[k] * sin + axis[k] * along)
}

/// The vector divided by its length; NaN for a zero vector.
fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = length(vector);
    vector.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn look_at_spans_the_angle() {
        let camera = Camera::LookAt { eye: [0.0, -5.0, 1.0], look_at: [0.0, 0.0, 1.0], up: [0.0, 1.0, 3.0], fov: 90.0 };
        for size in [[200, 100], [100, 200], [64, 64]] {
            let view = camera.view(size);
            // From the centre of the image, half the height in pixels is one unit at distance 1.
            let pixel = 2.0 / f64::from(size[1]);
            let corner = view.direction(0, 0);
            let expected = [-(f64::from(size[0]) - 1.0) / 2.0 * pixel, 1.0, (f64::from(size[1]) - 1.0) / 2.0 * pixel];
            for axis in 0..3 {
                assert!((corner[axis] - expected[axis]).abs() < 1e-14, "{corner:?} {expected:?}");
            }
        }
    }

    #[test]
    fn a_turned_camera_looks_at_the_same_point_from_as_far() {
        let camera = Camera::LookAt { eye: [0.0, -5.0, 1.0], look_at: [0.0, 0.0, 1.0], up: [0.0, 0.0, 1.0], fov: 40.0 };
        let eye = |right, upward| camera.turned(right, upward).view([1, 1]).eye;
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12);
        assert!(near(eye(0.0, 0.0), [0.0, -5.0, 1.0]));
        assert!(near(eye(90.0, 0.0), [5.0, 0.0, 1.0]), "to the right: {:?}", eye(90.0, 0.0));
        let (sin, cos) = 30f64.to_radians().sin_cos();
        assert!(near(eye(0.0, 30.0), [0.0, -5.0 * cos, 1.0 + 5.0 * sin]), "upward: {:?}", eye(0.0, 30.0));
        assert!(near(eye(90.0, 30.0), [5.0 * cos, 0.0, 1.0 + 5.0 * sin]));
        let by_vectors = Camera::Vectors {
            eye: [0.0, -5.0, 1.0],
            forward: [0.0, 5.0, 0.0],
            right: [1.0, 0.0, 0.0],
            up: [0.0, 0.0, 1.0],
        };
        let turned = by_vectors.turned(90.0, 0.0).view([1, 1]);
        assert!(
            near(turned.eye, [5.0, 0.0, 1.0])
                && near(turned.forward, [-5.0, 0.0, 0.0])
                && near(turned.right, [0.0, 1.0, 0.0])
        );
    }

    #[test]
    fn one_sample_per_pixel_is_its_centre_to_the_bit() {
        let camera = Camera::LookAt { eye: [1.0, -5.0, 2.0], look_at: [0.3; 3], up: [0.0, 0.0, 1.0], fov: 33.0 };
        for size in [[7, 5], [5, 7], [1, 1]] {
            let view = camera.view(size);
            assert_eq!(view.scan_lines(), size[1]);
            for py in 0..size[1] {
                let line = view.scan_line(py);
                let directions: Vec<_> = line.samples.iter().map(|&sample| view.towards(sample)).collect();
                assert_eq!(directions, (0..size[0]).map(|px| view.direction(px, py)).collect::<Vec<_>>());
                assert!(line.samples.iter().all(|sample| line.sy == [sample[1]; 2]));
            }
        }
    }

    #[test]
    fn four_samples_stand_around_the_centre_of_their_pixel() {
        let camera =
            Camera::Vectors { eye: [0.0; 3], forward: [0.0, 1.0, 0.0], right: [1.0, 0.0, 0.0], up: [0.0, 0.0, 1.0] };
        let view = camera.view([6, 4]).sampled(Sampling::Uniform);
        assert_eq!(view.scan_lines(), 8);
        let lines: Vec<_> = (0..8).map(|line| view.scan_line(line)).collect();
        for (px, py) in (0..6).flat_map(|px| (0..4).map(move |py| (px, py))) {
            let (columns, rows) = (2 * px..2 * px + 2, 2 * py..2 * py + 2);
            let mut mean = [0.0; 3];
            for sample in
                rows.flat_map(|row| columns.clone().map(|column| lines[row].samples[column]).collect::<Vec<_>>())
            {
                mean = [0, 1, 2].map(|axis| mean[axis] + view.towards(sample)[axis] / 4.0);
            }
            let centre = view.direction(px as u32, py as u32);
            assert!((0..3).all(|axis| (mean[axis] - centre[axis]).abs() < 1e-15), "{mean:?} {centre:?}");
        }
        // From the top down, and from left to right.
        assert!(lines.windows(2).all(|pair| pair[0].sy[0] > pair[1].sy[1]));
        assert!(lines[0].samples.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    }

    #[test]
    fn the_middle_of_an_odd_image_is_forward() {
        let camera = Camera::Vectors { eye: [0.0; 3], forward: [1.0, 2.0, 3.0], right: [1.0; 3], up: [0.0, 0.0, 7.0] };
        assert_eq!(camera.view([3, 5]).direction(1, 2), [1.0, 2.0, 3.0]);
        assert_eq!(camera.view([1, 1]).direction(0, 0), [1.0, 2.0, 3.0]);
    }
}
