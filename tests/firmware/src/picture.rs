//! Which rays are traced: those of some scan lines of a picture.

use patchray::scalar::Scalar;
use patchray::view::Camera;

/// An even sample of a picture's scan lines.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    /// Where all rays start, and forward, right and up: see [`Camera`].
    pub vectors: [[f32; 3]; 4],
    /// Pixels along a line, and lines.
    pub size: [u32; 2],
    /// Every how many lines one is traced, the first of them in the middle of as many.
    pub every: u32,
}

/// The camera of `fixtures/scenes/teapot-common.toml`.
const COMMON: [[f32; 3]; 4] =
    [[7.6171875, -9.3203125, 7.59375], [-222.75, 297.0, -198.0], [68.0, 51.0, 0.0], [-24.0, 32.0, 75.0]];

/// A camera that has the surface of `fixtures/scenes/hill.toml` fill the picture.
const OF_HILL: [[f32; 3]; 4] = [[3.0, -5.0, 4.0], [-3.0, 5.0, -3.5], [2.0, 1.25, 0.0], [-0.5, 0.75, 1.5]];

impl Picture {
    /// Of that name; the program's choice when it is built.
    pub const fn named(name: &str) -> Self {
        match name.as_bytes() {
            b"common" => Picture { vectors: COMMON, size: [512, 512], every: 32 },
            b"few" => Picture { vectors: COMMON, size: [64, 64], every: 16 },
            _ => Picture { vectors: OF_HILL, size: [64, 64], every: 16 },
        }
    }

    /// Its camera.
    pub fn camera<S: Scalar>(&self) -> Camera<S> {
        let [eye, forward, right, up] = self.vectors.map(|vector| vector.map(|c| S::from_f64(f64::from(c))));
        Camera { eye, forward, right, up }
    }

    /// The lines to trace.
    pub fn lines(&self) -> impl Iterator<Item = u32> {
        (self.every / 2..self.size[1]).step_by(self.every.max(1) as usize)
    }

    /// The x of a column.
    pub fn x<S: Scalar>(&self, column: u32) -> S {
        let width = S::from_u32(self.size[0]);
        (S::from_u32(2 * column + 1) - width) / width
    }

    /// The y of a line, of which the first is at the top.
    pub fn y<S: Scalar>(&self, line: u32) -> S {
        let height = S::from_u32(self.size[1]);
        (height - S::from_u32(2 * line + 1)) / height
    }
}
