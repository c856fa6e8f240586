//! A face of a shadow map: a picture of surfaces from a light's place, which holds how deep they lie.
//!
//! A texel holds the plane that touches the surface at its middle, and not its depth alone: of a plane, 1 over the depth grows
//! evenly along the image, so that three numbers are the plane. Ours: held against its own depth alone, a surface that stands
//! askew to the light would darken itself in stripes, unless it were raised by as much as it falls along a texel.

use rayon::prelude::*;

use crate::scanline::Outcome;
use crate::scene::camera::View;
use crate::scene::model::Model;
use crate::scene::rays::RayLine;
use crate::scene::sampling::Sampling;
use crate::vector::{cross, dot, largest, subtract, unit};

/// What the light sees in the middle of a texel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Texel {
    /// The face's unit over the depth of the nearest surface, less its base; that of 0 where there is none, NaN where that is not
    /// known.
    inverse: f32,
    /// What it grows by, along the plane that touches the surface, toward the next texel to the right, and to the one below.
    slope: [f32; 2],
}

impl Texel {
    /// What is not known.
    const UNKNOWN: Self = Texel { inverse: f32::NAN, slope: [0.0; 2] };
}

/// Bytes of a texel.
pub(super) const TEXEL_BYTES: u64 = size_of::<Texel>() as u64;

/// A picture from the light's place, a square of so many texels.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Face {
    light: [f64; 3],
    /// Where it looks, rightward, and upward: unit vectors at right angles.
    axes: [[f64; 3]; 3],
    /// The slopes, rightward and upward, of the picture's middle, and those from there to its edges.
    middle: [f64; 2],
    half: [f64; 2],
    /// What texels hold: `unit` / depth − `base`. Of a light far off all depths are nearly one, by which they are told apart in
    /// 32 bits only if that is taken off them: the unit is then the least, and the base 1. Of one among the surfaces the unit
    /// is the largest, and the base 0.
    unit: f64,
    base: f64,
    size: u32,
    texels: Vec<Texel>,
}

/// How far apart from where it looks a face may see, as a slope: a bit less than 45 degrees, beyond which the kernel takes rays
/// for those of no view.
const WIDEST: f64 = 0.95;

/// The steepest that a plane is taken to stand to the light, as the tangent of its angle. More would let the edge of a round
/// thing, continued by a texel, lie so deep that it darkens nothing near it; less darkens more of its own edge.
const STEEPEST: f64 = 8.0;

/// The least cosine to the light by which a surface's height above itself is turned into depth. Less raises more where the
/// light grazes it, and little is seen of its shadows there.
const LEAST_COSINE: f64 = 0.05;

impl Face {
    /// The face that sees all control points of `model`, so that nothing outside it is between the light and anything; `None` if
    /// the light is among them or so near that one face does not do.
    pub(super) fn around(model: &Model, light: [f64; 3], size: u32) -> Option<Self> {
        let axes = axes_of(middle_of(model, light)?);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut unit = f64::INFINITY;
        for &[x, y, z, _] in model.surfaces.iter().flat_map(|surface| &surface.points) {
            let (slopes, depth) = slopes(&axes, subtract([x, y, z], light))?;
            unit = unit.min(depth);
            if !slopes.iter().all(|slope| slope.abs() <= WIDEST) {
                return None;
            }
            for k in 0..2 {
                low[k] = low[k].min(slopes[k]);
                high[k] = high[k].max(slopes[k]);
            }
        }
        let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        // A texel more on each side, and as square as a picture has to be that has an extent.
        let wide = [0, 1].map(|k| 0.5 * (high[k] - low[k]) * (1.0 + 2.0 / f64::from(size)));
        let least = 1e-3 * wide[0].max(wide[1]).max(1e-12);
        let half = wide.map(|half| half.max(least));
        Some(Face { light, axes, middle, half, unit, base: 1.0, size, texels: Vec::new() })
    }

    /// The six faces of a cube around the light, which see everything.
    pub(super) fn cube(model: &Model, light: [f64; 3], size: u32) -> Vec<Self> {
        let points = model.surfaces.iter().flat_map(|surface| &surface.points);
        let farthest = largest(points.map(|&[x, y, z, _]| subtract([x, y, z], light)));
        let unit = if farthest > 0.0 { farthest } else { 1.0 };
        let axis = |k: usize, sign: f64| [0, 1, 2].map(|j| if j == k { sign } else { 0.0 });
        let forward = (0..3).flat_map(|k| [axis(k, 1.0), axis(k, -1.0)]);
        let face = |forward| Face {
            light,
            axes: axes_of(forward),
            middle: [0.0; 2],
            half: [1.0; 2],
            unit,
            base: 0.0,
            size,
            texels: Vec::new(),
        };
        forward.map(face).collect()
    }

    /// The picture that it is.
    pub(super) fn picture(&self) -> View {
        let [forward, right, up] = self.axes;
        let [x, y] = self.middle;
        View {
            eye: self.light,
            forward: [0, 1, 2].map(|k| forward[k] + x * right[k] + y * up[k]),
            right: right.map(|part| self.half[0] * part),
            up: up.map(|part| self.half[1] * part),
            size: [self.size; 2],
            sampling: Sampling::One,
        }
    }

    /// Draws the face: `draw` is asked for each row from the top, on rayon's current threads, for the rays of its texels and what
    /// became of them. What else it gives is returned, in order.
    pub(super) fn draw<T: Send>(&mut self, draw: impl Fn(u32) -> (Vec<RayLine>, Vec<Outcome>, T) + Sync) -> Vec<T> {
        let side = self.size as usize;
        let mut texels = vec![Texel::UNKNOWN; side * side];
        let rows = texels.par_chunks_mut(side).zip(0..self.size).map(|(texels, line)| {
            let (rays, outcomes, more) = draw(line);
            for (texel, (ray, outcome)) in texels.iter_mut().zip(rays.iter().zip(&outcomes)) {
                *texel = self.texel(outcome, ray.direction);
            }
            more
        });
        let more = rows.collect();
        self.texels = texels;
        more
    }

    fn texel(&self, outcome: &Outcome, direction: [f64; 3]) -> Texel {
        let found = match outcome {
            Outcome::Hit(found) => found,
            Outcome::Miss => return Texel { inverse: -self.base as f32, slope: [0.0; 2] },
            // Not known, and therefore neither.
            Outcome::GaveUp { .. } | Outcome::Refused(_) | Outcome::Invalid => {
                return Texel::UNKNOWN;
            }
        };
        // Directions are one deep, so that t is the depth.
        let inverse = self.unit / found.t;
        let [_, right, up] = self.axes;
        let (across, steepest) = (self.texel_slope(), STEEPEST * self.texel_slope() * inverse);
        let slope = |along: [f64; 3], half: f64| {
            let normal = found.normal.there().unwrap_or([0.0; 3]);
            // Of a plane the depths t along directions d have the same n · d t.
            let slope = inverse * dot(normal, along) * 2.0 * half / f64::from(self.size) / dot(normal, direction);
            if slope.is_nan() || across == 0.0 { 0.0 } else { slope.clamp(-steepest, steepest) }
        };
        let slope = [slope(right, self.half[0]), -slope(up, self.half[1])];
        Texel { inverse: (inverse - self.base) as f32, slope: slope.map(|slope| slope as f32) }
    }

    /// The width of a texel, of the wider side, at depth 1.
    fn texel_slope(&self) -> f64 {
        2.0 * self.half[0].max(self.half[1]) / f64::from(self.size)
    }

    /// The share of the light, 0 to 1, that no surface keeps from a point, of the four texels around it and by its distance to
    /// their middles, after W. T. Reeves, D. H. Salesin and R. L. Cook, "Rendering antialiased shadows with depth maps",
    /// SIGGRAPH 1987. The point's surface has this cosine to the light and is raised by `bias` widths of a texel. Outside is
    /// `None`; of a share that is not known, NaN.
    pub(super) fn share(&self, point: [f64; 3], cosine: f64, bias: f64) -> Option<f64> {
        let from = subtract(point, self.light);
        let (slopes, depth) = slopes(&self.axes, from)?;
        let [x, y] = [0, 1].map(|k| (slopes[k] - self.middle[k]) / self.half[k]);
        if !(x.abs() <= 1.0 && y.abs() <= 1.0) {
            return None;
        }
        // A unit of length toward the light is this much of a unit less deep.
        let shallower = depth / dot(from, from).sqrt();
        let raised = depth - bias * self.texel_slope() * depth * shallower / cosine.max(LEAST_COSINE);
        if !(raised > 0.0) {
            return Some(1.0);
        }
        let last = f64::from(self.size - 1);
        let [column, row] =
            [0.5 * (f64::from(self.size) * (1.0 + x) - 1.0), 0.5 * (f64::from(self.size) * (1.0 - y) - 1.0)];
        let [left, top] = [column.floor(), row.floor()];
        let (mut share, mut lit) = (0.0, 0);
        for [right, below] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
            // Of what lies outside the nearest is taken.
            let [i, j] = [left + right, top + below].map(|place: f64| place.clamp(0.0, last));
            let texel = self.texels.get(j as usize * self.size as usize + i as usize)?;
            let [slope_x, slope_y] = texel.slope.map(f64::from);
            let inverse = f64::from(texel.inverse) + slope_x * (column - i) + slope_y * (row - j);
            let weight = |place: f64, first: f64, second: f64| 1.0 - (place - first - second).abs();
            let weight = weight(column, left, right) * weight(row, top, below);
            if inverse.is_nan() {
                return Some(f64::NAN);
            }
            if self.unit / raised - self.base >= inverse {
                share += weight;
                lit += 1;
            }
        }
        // Four weights add up to 1 but for rounding.
        Some(if lit == 4 { 1.0 } else { share })
    }
}

/// Steps toward the middle of what the light sees. With n of them the middle is within one part in √n of the least cone's
/// angle, and often much nearer; a cone that hardly fits needs no more to be found.
const STEPS: u32 = 64;

/// The direction, of unit length, about which all control points lie in a narrow cone around the light, if not the least; `None`
/// without any points. Source: M. Bădoiu and K. L. Clarkson, "Smaller core-sets for balls", SODA 2003: a step is toward the
/// farthest, and each is smaller than the one before.
fn middle_of(model: &Model, light: [f64; 3]) -> Option<[f64; 3]> {
    let points = model.surfaces.iter().flat_map(|surface| &surface.points);
    let directions: Vec<_> = points.map(|&[x, y, z, _]| unit(subtract([x, y, z], light))).collect();
    let mut middle = *directions.first()?;
    for step in 1..=STEPS {
        let farther = |a: &&[f64; 3], b: &&[f64; 3]| dot(middle, **a).total_cmp(&dot(middle, **b));
        let farthest = directions.iter().min_by(farther)?;
        middle = unit([0, 1, 2].map(|k| middle[k] + (farthest[k] - middle[k]) / f64::from(step + 1)));
    }
    Some(middle)
}

/// Unit vectors at right angles, of which the first is `forward`.
fn axes_of(forward: [f64; 3]) -> [[f64; 3]; 3] {
    let least = (0..3).fold(0, |least, k| if forward[k].abs() < forward[least].abs() { k } else { least });
    let right = unit(cross(forward, [0, 1, 2].map(|k| f64::from(u8::from(k == least)))));
    [forward, right, cross(right, forward)]
}

/// The slopes of a vector, rightward and upward, and its depth; `None` if it does not lie ahead.
fn slopes(axes: &[[f64; 3]; 3], vector: [f64; 3]) -> Option<([f64; 2], f64)> {
    let [depth, right, up] = axes.map(|axis| dot(axis, vector));
    (depth > 0.0).then(|| ([right / depth, up / depth], depth))
}
