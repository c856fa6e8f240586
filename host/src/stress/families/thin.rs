//! Pipes and sheets so thin that the two roots of a ray through them all but fall together.

use glam::DVec3;

use crate::judge::Truth;
use crate::scene::model::Model;
use crate::scene::rays::RayLine;
use crate::scene::revolution::{Arcs, Curve, revolve};
use crate::scene::shapes::parallelogram;
use crate::scene::trace::Precision;
use crate::stress::case::{Case, Draw, FEW, Family, ray};
use crate::stress::forms::meet_pipe;
use crate::stress::truth::{clear_margin, size};

pub(super) const FAMILIES: [Family; 2] = [
    Family {
        name: "thin-pipes",
        what: "pipes 1e-1 to 1e-14 (f32: 1e-7) thick and as long as 1, met near their axis, most at 1 to 12 degrees to it",
        unjudged: FEW,
        cases: pipes,
    },
    Family {
        name: "thin-sheets",
        what: "pipes 0.3 wide, and as flat as those are thin: two sheets, all but in one place",
        unjudged: FEW,
        cases: sheets,
    },
];

/// The pipe along x from -1/2 to 1/2, of `arcs` surfaces, four or eight, with these half widths in y and z.
fn pipe([b, c]: [f64; 2], arcs: usize) -> Model {
    let profile = Curve::segment(1, [1.0, -0.5], [1.0, 0.5]);
    let mut surfaces = revolve(&profile, &Curve::circle(Arcs::Rational, 0.0, 360.0, arcs));
    for point in surfaces.iter_mut().flat_map(|surface| &mut surface.points) {
        let [y, z, x, w] = *point;
        *point = [x, b * y, c * z, w];
    }
    Model::numbered(surfaces)
}

/// The half widths of the pipe in a model, as the precision holds them: its largest coordinates across the axis are those of
/// arcs that end there.
fn half_widths(model: &Model) -> [f64; 2] {
    let ends = model.surfaces.iter().flat_map(|surface| &surface.points).filter(|point| point[3] == 1.0);
    ends.fold([0.0; 2], |[b, c]: [f64; 2], point| [b.max(point[1].abs()), c.max(point[2].abs())])
}

/// What is true of a ray through the pipe's middle. That it is met is beyond doubt, however thin it is, if it neither begins
/// within nor comes in by an open end.
fn through(model: &Model, ray: &RayLine, precision: Precision) -> Truth {
    let half_widths = half_widths(model);
    let size = size(&model.surfaces[0], model);
    let open = Truth { open: true, size, ..Truth::default() };
    let Some([first, second]) = meet_pipe(half_widths, ray) else { return open };
    let inside = |t: f64| t > 0.05 && (ray.origin[0] + t * ray.direction[0]).abs() < 0.45;
    if !(inside(first) && inside(second)) {
        return open;
    }
    // The normal there, and the ray.
    let [y, z] = [1, 2].map(|k| (ray.origin[k] + first * ray.direction[k]) / half_widths[k - 1].powi(2));
    let [dx, dy, dz] = ray.direction;
    let cosine = (y * dy + z * dz).abs() / (y.hypot(z) * dx.hypot(dy).hypot(dz));
    let thin = half_widths.iter().any(|half| 2.0 * half < clear_margin(precision) * size);
    Truth {
        closest: Some(first),
        roots: 2,
        margin: 1.0,
        size,
        leaves: Some(second).filter(|_| thin),
        cosine: Some(cosine),
        ..Truth::default()
    }
}

/// How thin, by a ladder down to the resolution of the precision.
fn thickness(draw: &mut Draw) -> f64 {
    let digits = match draw.precision {
        Precision::F64 => 14.0,
        Precision::F32 => 7.0,
    };
    10.0_f64.powf(-draw.random.within(1.0, digits))
}

/// Rays through the pipe, entering the elliptic tube around its axis of half its widths, at an angle to the axis that is small
/// for most of them.
fn shallow(draw: &mut Draw, [b, c]: [f64; 2], rays: usize) -> Vec<RayLine> {
    let ray = |draw: &mut Draw| {
        let steepest = *draw.pick(&[10.0, 10.0, 80.0]);
        // Not so shallow that what is thick is passed through from end to end.
        let least = (8.0 * c.min(b)).clamp(0.02, 0.5).asin().to_degrees();
        let (sin, cos) = (least + draw.random.within(0.0, steepest)).to_radians().sin_cos();
        // Around the axis; through sheets from above or below.
        let turn = draw.random.within(0.0, std::f64::consts::TAU);
        let (y, z) = if b == c { turn.sin_cos() } else { (0.3 * turn.sin(), turn.cos().signum()) };
        let along = DVec3::new(cos, sin * y, sin * z);
        let [x, y, z] = [0.1, 0.5 * b, 0.5 * c].map(|half| draw.random.within(-half, half));
        let target = DVec3::new(x, y, z);
        // Close by, so that rounding t leaves two roots apart.
        ray(target - along * 0.5, along)
    };
    (0..rays).map(|_| ray(draw)).collect()
}

fn tubes(draw: &mut Draw, widths: impl Fn(f64) -> [f64; 2]) -> Vec<Case> {
    let precision = draw.precision;
    let cases = (0..30).map(|number| {
        let widths = widths(thickness(draw));
        let mut model = pipe(widths, 4 + 4 * (number % 2));
        let rays = shallow(draw, widths, draw.rays.div_ceil(30));
        // Something behind it, which no ray is to be sent on to.
        if number % 3 == 0 {
            model.surfaces.push(parallelogram([-8.0, -8.0, -6.0], [16.0, 0.0, 0.0], [0.0, 16.0, 0.0]));
            model = Model::numbered(model.surfaces);
            let form = move |model: &Model, ray: &RayLine| {
                let pipe = Model { surfaces: model.surfaces[..model.surfaces.len() - 1].to_vec() };
                through(&pipe, ray, precision)
            };
            return Case::of_form(model, rays, form);
        }
        Case::of_form(model, rays, move |model, ray| through(model, ray, precision))
    });
    cases.collect()
}

fn pipes(draw: &mut Draw) -> Vec<Case> {
    tubes(draw, |thickness| [0.5 * thickness; 2])
}

fn sheets(draw: &mut Draw) -> Vec<Case> {
    tubes(draw, |thickness| [0.15, 0.5 * thickness])
}
