//! Bytes as surfaces, rays, cameras and limits.

use crate::bytes::Bytes;
use crate::common::Kind;
use crate::shapes;
use patchray::frame::PADDING;
use patchray::limits::{Acceptance, Limits};
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray::view::Camera;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;

/// Which numbers a case is made of. All are numbers of the precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Numbers {
    /// Sixteenths, below 8: much falls together.
    Coarse,
    /// Of sixteen bits, below 8.
    Fine,
    /// The same times a power of two.
    Scaled(i32),
    /// Any bits.
    Any,
}

impl Numbers {
    fn drawn(bytes: &mut Bytes<'_>) -> Self {
        match bytes.below(8) {
            0..3 => Numbers::Coarse,
            3..6 => Numbers::Fine,
            6 => Numbers::Scaled(i32::from(bytes.byte() as i8) / 2),
            _ => Numbers::Any,
        }
    }

    /// The same, but never of any bits.
    fn tame(bytes: &mut Bytes<'_>) -> Self {
        match Numbers::drawn(bytes) {
            Numbers::Any => Numbers::Fine,
            numbers => numbers,
        }
    }

    /// One of them.
    pub(crate) fn draw(self, bytes: &mut Bytes<'_>, precision: Precision) -> f64 {
        match self {
            Numbers::Coarse => f64::from(bytes.byte() as i8) / 16.0,
            Numbers::Fine => f64::from(bytes.u16() as i16) / 4096.0,
            Numbers::Scaled(exponent) => f64::from(bytes.u16() as i16) / 4096.0 * f64::from(exponent).exp2(),
            Numbers::Any => match precision {
                Precision::F32 => f64::from(f32::from_bits(bytes.u32())),
                Precision::F64 => f64::from_bits(bytes.u64()),
            },
        }
    }

    fn point(self, bytes: &mut Bytes<'_>, precision: Precision) -> [f64; 3] {
        std::array::from_fn(|_| self.draw(bytes, precision))
    }

    /// How large most are.
    pub(crate) fn size(self) -> f64 {
        match self {
            Numbers::Scaled(exponent) => f64::from(exponent).exp2(),
            _ => 1.0,
        }
    }
}

/// The number that the precision holds.
pub(crate) fn in_precision(number: f64, precision: Precision) -> f64 {
    match precision {
        Precision::F32 => f64::from(number as f32),
        Precision::F64 => number,
    }
}

/// Surfaces, and the types that they are traced in.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) model: Model,
    pub(crate) precision: Precision,
    pub(crate) weighted: bool,
    pub(crate) numbers: Numbers,
    /// Whether its surfaces are those of [`crate::shapes`].
    pub(crate) shaped: bool,
}

/// The bits of a case's first byte that are all set if its surfaces are those of [`crate::shapes`].
const SHAPED: u8 = 0xa0;

impl Case {
    /// Up to so many surfaces, in any numbers.
    pub(crate) fn any(bytes: &mut Bytes<'_>, surfaces: u8) -> Self {
        Self::of(bytes, surfaces, Numbers::drawn, 15)
    }

    /// Up to so many surfaces of degrees up to `degree`, in numbers that any scene may have.
    pub(crate) fn tame(bytes: &mut Bytes<'_>, surfaces: u8, degree: u8) -> Self {
        Self::of(bytes, surfaces, Numbers::tame, degree)
    }

    fn of(bytes: &mut Bytes<'_>, surfaces: u8, numbers: fn(&mut Bytes<'_>) -> Numbers, degree: u8) -> Self {
        let kind = bytes.byte();
        let precision = if kind & 1 == 0 { Precision::F64 } else { Precision::F32 };
        let weighted = kind & 2 != 0;
        if kind & SHAPED == SHAPED {
            return shapes::case(bytes, precision, weighted, degree);
        }
        let numbers = numbers(bytes);
        let count = 1 + bytes.below(surfaces);
        let surfaces = (0..count).map(|_| surface(bytes, numbers, precision, weighted, degree)).collect();
        Case { model: Model::numbered(surfaces), precision, weighted, numbers, shaped: false }
    }

    /// Whether its numbers are such as any scene may have.
    pub(crate) fn is_tame(&self) -> bool {
        self.numbers != Numbers::Any
    }

    /// A number of the precision, of the size of the case's.
    pub(crate) fn number(&self, bytes: &mut Bytes<'_>) -> f64 {
        self.numbers.draw(bytes, self.precision)
    }

    fn point(&self, bytes: &mut Bytes<'_>) -> [f64; 3] {
        self.numbers.point(bytes, self.precision)
    }

    /// A point of a surface, or of its net, or any other.
    fn target(&self, bytes: &mut Bytes<'_>) -> [f64; 3] {
        if self.shaped {
            return shapes::target(self, bytes);
        }
        let surfaces = &self.model.surfaces;
        let surface = &surfaces[bytes.below(8) % surfaces.len()];
        let point = match bytes.below(8) {
            0..5 => surface.point(f64::from(bytes.byte()) / 255.0, f64::from(bytes.byte()) / 255.0),
            5 | 6 => {
                let [x, y, z, _] = surface.points[usize::from(bytes.byte()) % surface.points.len()];
                [x, y, z]
            }
            _ => self.point(bytes),
        };
        point.map(|c| in_precision(c, self.precision))
    }

    /// A ray, mostly at a surface.
    pub(crate) fn ray(&self, bytes: &mut Bytes<'_>) -> RayLine {
        if self.shaped {
            return shapes::ray(self, bytes);
        }
        let kind = bytes.byte();
        let origin = self.point(bytes);
        let direction = if kind & 3 == 3 {
            self.point(bytes)
        } else {
            let target = self.target(bytes);
            let mut to = [0, 1, 2].map(|k| in_precision(target[k] - origin[k], self.precision));
            if kind & 4 != 0 {
                // Along an axis, or in a plane of two.
                to[bytes.below(3)] = 0.0;
            }
            to
        };
        let (t_min, t_max) = if kind & 8 == 0 {
            (0.0, f64::INFINITY)
        } else {
            let [a, b] = [0; 2].map(|_| Numbers::Coarse.draw(bytes, self.precision));
            (a.min(b), a.max(b))
        };
        RayLine { origin, direction, t_min, t_max, scan_line: 0, valid: true }
    }

    /// An eye with the vectors of an image, mostly looking at a surface.
    pub(crate) fn camera(&self, bytes: &mut Bytes<'_>) -> Camera<f64> {
        let eye = self.point(bytes);
        let at = self.target(bytes);
        let forward = [0, 1, 2].map(|k| in_precision(at[k] - eye[k], self.precision));
        let length = forward.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        let mut across = || match bytes.below(4) {
            // Across the steepest axis, so that it is not flat.
            0 | 1 => {
                let steepest = (0..3).fold(0, |most, k| if forward[k].abs() > forward[most].abs() { k } else { most });
                let mut vector = [0.0; 3];
                vector[(steepest + 1 + bytes.below(2)) % 3] = length / f64::from(1 << bytes.below(8));
                vector
            }
            2 => Numbers::Coarse.point(bytes, self.precision).map(|c| c * self.numbers.size()),
            _ => self.point(bytes),
        };
        let (right, up) = (across(), across());
        Camera { eye, forward, right, up }
    }
}

fn surface(bytes: &mut Bytes<'_>, numbers: Numbers, precision: Precision, weighted: bool, degree: u8) -> ModelSurface {
    let mut degrees = [0; 2].map(|_| 1 + bytes.below(3));
    if bytes.rarely(4) {
        degrees = degrees.map(|_| 1 + bytes.below(degree));
    }
    let [n, m] = degrees;
    let kind = bytes.byte();
    // Over a square, so that few bytes make a surface with extent; or wherever the numbers are.
    let over_square = kind & 3 != 3 && numbers != Numbers::Any;
    let flat = kind & 12 == 12;
    let weights = weighted && kind & 16 != 0;
    let mut points = Vec::with_capacity((n + 1) * (m + 1));
    for i in 0..=n {
        for j in 0..=m {
            let [x, y, z] = if over_square {
                let height = if flat { 0.0 } else { numbers.draw(bytes, precision) };
                let size = numbers.size();
                [(i as f64 - 1.0) * size, (j as f64 - 1.0) * size, height]
            } else {
                numbers.point(bytes, precision)
            };
            let weight = match numbers {
                _ if !weights => 1.0,
                Numbers::Any => numbers.draw(bytes, precision),
                // Products with a number of sixteen bits are exact in either precision.
                _ => (1.0 + f64::from(bytes.byte())) / 64.0,
            };
            points.push([x, y, z, weight]);
        }
    }
    if !flat && bytes.rarely(8) {
        // An edge drawn together to a point.
        let corner = points[0];
        points[..=m].fill(corner);
    }
    ModelSurface { number: 0, degree_u: n, degree_v: m, rational: weighted, points, knots: None }
}

/// A number that any scene may hold, or one of any bits.
pub(crate) fn number<S: Scalar>(bytes: &mut Bytes<'_>) -> S {
    match bytes.below(8) {
        0 => S::ZERO,
        1 => S::from_f64(f64::NAN),
        2 => S::INFINITY,
        3 => S::from_f64(f64::from(f32::from_bits(bytes.u32()))),
        4 => S::from_f64(f64::from_bits(bytes.u64())),
        5 => S::ONE.times_power_of_two(i32::from(bytes.byte() as i8)),
        _ => S::from_f64(f64::from(bytes.u16() as i16) / 4096.0),
    }
}

/// Budgets that end any call within a fraction of a millisecond: an input is to be done with soon, whatever it is. More would
/// decide a few more rays of many roots, and halve the number of inputs in a given time.
fn usual<S: Scalar>() -> Limits<S> {
    Limits {
        surfaces: 1000,
        nodes: 2000,
        patches: 1000,
        voxels: 4000,
        spans: 4000,
        newton_steps: 300,
        clip_steps: 300,
        bisections: 100,
        ..Limits::default()
    }
}

/// The same limits, with the budgets that a person gets who asks for none.
pub(crate) fn with_default_budgets<S: Scalar>(limits: &Limits<S>) -> Limits<S> {
    let mut limits = *limits;
    let mut defaults = Limits::<S>::default();
    for (budget, default) in budgets_of(&mut limits).into_iter().zip(budgets_of(&mut defaults)) {
        *budget = *default;
    }
    limits
}

/// Limits with the usual parameters, by the one rule of acceptance or the other, and budgets that honest rays do not meet.
pub(crate) fn limits<S: Scalar>(bytes: &mut Bytes<'_>) -> Limits<S> {
    let acceptance = if bytes.byte() & 1 == 0 { Acceptance::Proved } else { Acceptance::Paper };
    Limits { acceptance, ..usual() }
}

/// Limits of any numbers, where a bit says so; budgets are at most the usual ones.
pub(crate) fn any_limits<S: Scalar>(bytes: &mut Bytes<'_>) -> Limits<S> {
    let mut limits = limits::<S>(bytes);
    for (k, budget) in budgets_of(&mut limits).into_iter().enumerate() {
        if bytes.rarely(4) {
            *budget = bytes.count().min(if k == 8 { u32::MAX } else { *budget });
        }
    }
    for parameter in [&mut limits.newton_iterations, &mut limits.newton_starts, &mut limits.newton_halvings] {
        if bytes.rarely(4) {
            *parameter = bytes.count();
        }
    }
    for parameter in [&mut limits.tolerance, &mut limits.critical_factor, &mut limits.clip_threshold] {
        if bytes.rarely(4) {
            *parameter = number(bytes);
        }
    }
    limits
}

/// The budgets, that of waiting domains last.
pub(crate) fn budgets_of<S>(limits: &mut Limits<S>) -> [&mut u32; 9] {
    let Limits {
        surfaces, nodes, patches, voxels, spans, newton_steps, clip_steps, bisections, pending_domains, ..
    } = limits;
    [surfaces, nodes, patches, voxels, spans, newton_steps, clip_steps, bisections, pending_domains]
}

/// How finely surfaces are subdivided: few patches, so that an input is done with soon.
pub(crate) fn subdivision<S: Scalar>(bytes: &mut Bytes<'_>) -> Subdivision<S> {
    let flatness = S::from_f64([0.05, 0.2, 0.01, 1.0][bytes.below(4)]);
    let depth = [2, 14, 3, 1, 0][bytes.below(5)];
    Subdivision { flatness, depth, patches_per_surface: 100, padding: PADDING }
}

/// The same by any numbers.
pub(crate) fn any_subdivision<S: Scalar>(bytes: &mut Bytes<'_>) -> Subdivision<S> {
    let mut options = subdivision(bytes);
    if bytes.rarely(4) {
        options.flatness = number(bytes);
    }
    if bytes.rarely(4) {
        options.depth = bytes.count();
    }
    if bytes.rarely(4) {
        options.padding = bytes.count();
    }
    if bytes.rarely(4) {
        options.patches_per_surface = bytes.count().min(100);
    }
    options
}

/// The range of t of a ray, as the kernel takes it.
pub(crate) fn interval<S: Scalar>(ray: &RayLine) -> Option<Interval<S>> {
    Interval::new(S::from_f64(ray.t_min), S::from_f64(ray.t_max))
}

/// A camera in a number type.
pub(crate) fn in_kernel<S: Scalar>(camera: &Camera<f64>) -> Camera<S> {
    let Camera { eye, forward, right, up } = *camera;
    let [eye, forward, right, up] = [eye, forward, right, up].map(|v| v.map(S::from_f64));
    Camera { eye, forward, right, up }
}

/// A check for each kind of point.
pub(crate) trait OfKind {
    /// The check, of this kind.
    fn run<P: Kind>(self, case: &Case, bytes: Bytes<'_>);
}

/// Runs a check with the kind of point that the case says.
pub(crate) fn with_kind(case: &Case, bytes: Bytes<'_>, check: impl OfKind) {
    match (case.precision, case.weighted) {
        (Precision::F64, false) => check.run::<Plain<f64>>(case, bytes),
        (Precision::F32, false) => check.run::<Plain<f32>>(case, bytes),
        (Precision::F64, true) => check.run::<Weighted<f64>>(case, bytes),
        (Precision::F32, true) => check.run::<Weighted<f32>>(case, bytes),
    }
}
