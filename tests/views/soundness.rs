//! No line leaves out a patch that a ray of it meets: a span too narrow by rounding is a hole that no later step mends.
//!
//! Rays through known points of patches, corners and borders among them; and each patch whose box any ray meets.
//! `PATCHRAY_RAYS=N` traces N rays per case and precision.

use crate::cameras::{cameras, inside, scaled};
use crate::common::{Kind, Prepared, add, cross, dot, index, is_rational};
use crate::corpus::{Case, cases};
use crate::judging::rays_per_case;
use crate::rooms::{InView, LineRoom, ViewRoom};
use patchray::bernstein::Basis;
use patchray::limits::{Limits, Work};
use patchray::line::{Line, Window};
use patchray::patch::Patch;
use patchray::planes::Planes;
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::span::Order;
use patchray::subdivide::Subdivision;
use patchray::sweep::Along;
use patchray::view::{Camera, View, ViewRay};
use patchray_host::scene::model::ModelSurface;
use patchray_host::scene::shapes::Random;
use rayon::prelude::*;

/// Rays per case and precision, unless the environment says otherwise.
const RAYS: usize = 3_000;

/// What became of the rays of a case.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    rays: usize,
    /// Patches that rays were led to.
    led: usize,
    /// Patches whose boxes rays meet before the eye, but that their lines do not hold.
    left_out: usize,
    /// Rays through a point of a patch whose line does not lead to that patch.
    refused: usize,
}

/// The patches that a line leads a ray to, by their domains and surfaces: each is told by where it lies.
fn led<P: Kind>(
    view: &View<'_, P>,
    line: &mut Line<'_, P::Scalar>,
    ray: &ViewRay<P::Scalar>,
    mut planes_of: impl FnMut(&Planes<P::Scalar>, u32),
) -> Vec<(u32, [[P::Scalar; 2]; 2])> {
    let (limits, mut work) = (Limits { spans: u32::MAX, ..Limits::default() }, Work::default());
    let mut found = Vec::new();
    let answer = line.closest(view, ray, &limits, &mut work, |surface, planes, range, along, limits, work| {
        planes_of(planes, surface.number);
        along.ahead(planes, &range, limits, work, |patch, _, _| {
            found.push((surface.number, patch.domain().bounds()));
            Ok(P::Scalar::INFINITY)
        })?;
        Ok(None)
    });
    assert_eq!(answer, Ok(None));
    found
}

/// The place of a point in a camera's image, which may be wider than ±1, if the point lies before the eye.
fn place(camera: &Camera<f64>, point: [f64; 3]) -> Option<[f64; 2]> {
    let Camera { eye, forward, right, up } = *camera;
    let from_eye = add(point, -1.0, eye);
    let volume = dot(forward, cross(right, up));
    let depth = dot(from_eye, cross(right, up)) / volume;
    let [x, y] = [cross(up, forward), cross(forward, right)].map(|row| dot(from_eye, row) / volume / depth);
    (depth > 0.0).then_some([x, y])
}

/// The rows in which a surface's control points lie, if all do before the eye. Boxes of patches reach farther, and may be met
/// where no surface is: what a line leaves out there is no loss.
fn rows_of(camera: &Camera<f64>, surface: &ModelSurface) -> [f64; 2] {
    surface.points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &[x, y, z, _]| {
        match place(camera, [x, y, z]) {
            Some([_, y]) => [low.min(y), high.max(y)],
            None => [f64::NEG_INFINITY, f64::INFINITY],
        }
    })
}

fn shoot<P: Kind>(case: &Case) -> Count {
    let options = Subdivision { flatness: P::Scalar::from_f64(0.004), ..Subdivision::default() };
    let prepared = Prepared::<P>::new(&case.model, 1.0, &options);
    let surfaces = &case.model.surfaces;
    let all: Vec<_> = cameras(surfaces).into_iter().chain(inside(surfaces)).enumerate().collect();
    let each = rays_per_case(RAYS) / all.len();
    let of_camera = |&(seed, named): &(usize, crate::cameras::Named)| {
        let camera = scaled::<P::Scalar>(&named.camera, 1.0);
        let mut room = ViewRoom::for_view(&prepared, true, &camera).unwrap();
        // The turned patches, which the view keeps to itself.
        room.build(&prepared, true, &camera).unwrap();
        let turned: Vec<Patch<P::Scalar>> = room.patches.clone();
        let view = room.build(&prepared, true, &camera).unwrap();
        let mut random = Random(seed as u64);
        let (mut basis, mut line_room) = (Basis::<P::Scalar, 16>::new(), LineRoom::for_any(&prepared, 1 + seed * 30));
        let unscale = -prepared.scene().frame().exponent();
        let rows: Vec<_> = surfaces.iter().map(|surface| rows_of(&named.camera, surface)).collect();
        let mut count = Count::default();
        for _ in 0..each {
            let surface = index(&mut random, surfaces.len());
            let patches = prepared.patches();
            let of_surface = patches.of_surface(surface).unwrap();
            let patch = &of_surface[index(&mut random, of_surface.len())];
            let [u, v] = patch.domain().bounds::<P::Scalar>().map(|[low, high]| {
                let share = [0.0, 1.0, random.within(0.0, 1.0), random.within(0.0, 1.0)][index(&mut random, 4)];
                low + (high - low) * P::Scalar::from_f64(share)
            });
            let net = prepared.scene().surface(surface).unwrap().net;
            let point = net.position(u, v, &mut basis.view()).unwrap();
            let point = point.map(|c| c.times_power_of_two(unscale).to_f64());
            let Some(place) = place(&named.camera, point).filter(|p| p.iter().all(|c| c.abs() <= 1.0)) else {
                continue;
            };
            let place = place.map(P::Scalar::from_f64);
            let Ok(ray) = view.ray(place, &Interval::ahead()) else { continue };
            let wide = P::Scalar::from_f64(random.within(0.0, 0.01));
            let x = if index(&mut random, 2) == 0 { [place[0]; 2] } else { [-P::Scalar::ONE, P::Scalar::ONE] };
            let window = Window { x, y: [place[1] - wide, place[1] + wide] };
            let mut line = line_room.line(&view, InView::Newton, window).unwrap();
            let mut planes = None;
            let found = led(&view, &mut line, &ray, |of_ray, _| planes = Some(*of_ray));
            let bounds = patch.domain().bounds();
            count.rays += 1;
            count.led += found.len();
            count.refused += usize::from(!found.contains(&(surface as u32, bounds)));
            // What brute force meets, wherever a line leads to anything at all.
            let Some(planes) = planes else { continue };
            // Depth 0 is the scene's middle; the eye is where t is 0.
            for (number, slot) in turned.iter().enumerate() {
                let ahead = |depth: P::Scalar| planes.t(depth) >= P::Scalar::ZERO;
                let met = slot.bounds().crossing(&planes).is_some_and(|crossing| {
                    crossing.pierces().is_some_and(|ends| ahead(ends[1].depth) && ends[0].depth <= ends[1].depth)
                });
                if met {
                    // Its surface's number.
                    let of = prepared.first.partition_point(|&first| first as usize <= number) as u32 - 1;
                    let [low, high] = rows[of as usize];
                    let seen = low <= window.y[1].to_f64() && window.y[0].to_f64() <= high;
                    count.left_out += usize::from(seen && !found.contains(&(of, slot.domain().bounds())));
                }
            }
        }
        count
    };
    all.par_iter().map(of_camera).reduce(Count::default, |a, b| Count {
        rays: a.rays + b.rays,
        led: a.led + b.led,
        left_out: a.left_out + b.left_out,
        refused: a.refused + b.refused,
    })
}

#[test]
fn no_line_leaves_out_what_a_ray_meets() {
    assert_eq!(InView::Newton.order(), Order::Surfaces);
    for case in cases() {
        let [of_f32, of_f64] = if is_rational(&case.model) {
            [shoot::<Weighted<f32>>(&case), shoot::<Weighted<f64>>(&case)]
        } else {
            [shoot::<Plain<f32>>(&case), shoot::<Plain<f64>>(&case)]
        };
        println!("{}: f32 {of_f32:?}, f64 {of_f64:?}", case.name);
        for count in [of_f32, of_f64] {
            assert!(count.rays * 4 > rays_per_case(RAYS), "{}: {count:?}", case.name);
            assert_eq!((count.refused, count.left_out), (0, 0), "{}: {count:?}", case.name);
        }
    }
}
