//! Kinds of rays on which answers were once wrong, for all that a ray meets.

use glam::DVec3;
use patchray::ray::Incidence;
use patchray_host::scanline::{Found, Outcome};
use patchray_host::scene::model::Model;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::revolution::{Arcs, Curve, revolve};
use patchray_host::scene::shapes::{Random, net, parallelogram, single, sphere, torus};
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::stress::case::{Case, Draw, mapped, point, ray};
use patchray_host::stress::forms::meet_pipe;
use patchray_host::stress::truth::{in_precision, rays_of, size};

use crate::residual::{distance, most};
use crate::tools::{METHODS, PRECISIONS, all_hits, index, rays, trace};

/// The methods that tell all hits.
const ORIGINALS: [Method; 2] = [Method::Clipping, Method::Newton];

/// The case in numbers of the precision, and its rays.
fn rounded(model: &Model, lines: Vec<RayLine>, precision: Precision) -> (Model, Vec<RayLine>) {
    let case = in_precision(&Case::of_rays(model.clone(), lines), precision);
    let lines = rays_of(&case);
    (case.model, lines)
}

/// How many of the hits have this t, to `off`.
fn at(hits: &[Found], t: f64, off: f64) -> usize {
    hits.iter().filter(|found| (found.t - t).abs() <= off).count()
}

/// A pipe along x from -1/2 to 1/2, of three arcs, either way round.
fn pipe(half: f64, reversed: bool) -> Model {
    let sweep = if reversed { -360.0 } else { 360.0 };
    let profile = Curve::segment(1, [half, -0.5], [half, 0.5]);
    let upright = Model::numbered(revolve(&profile, &Curve::circle(Arcs::Rational, 0.0, sweep, 3)));
    mapped(&upright, |p| DVec3::new(p.z, p.x, p.y))
}

/// The one root was once taken for both, and the far one told.
#[test]
fn a_pipe_met_at_a_shallow_angle_has_two_roots() {
    for precision in PRECISIONS {
        let mut random = Random(61);
        let (decades, unit) = match precision {
            Precision::F64 => (7.0, f64::EPSILON),
            Precision::F32 => (1.5, f64::from(f32::EPSILON)),
        };
        for round in 0..rays(1000).div_ceil(50) {
            let half = 0.5 * 10_f64.powf(-random.within(1.0, 1.0 + decades));
            let floor = parallelogram([-0.5, -0.5, -2.0 * half], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
            let pipe = pipe(half, round % 2 == 1);
            let model = Model::numbered([pipe.surfaces, vec![floor]].concat());
            let lines = (0..50).map(|_| {
                // The ray passes the axis so that both roots may lie on one arc, and that they are apart; they are not at an end.
                let (angle, turn) = (random.within(2.0, 12.0_f64).to_radians(), random.within(0.0, 6.3));
                let ([s, c], (y, z)) = ([angle.sin(), angle.cos()], turn.sin_cos());
                let d = DVec3::new(c, s * y, s * z);
                let aside = random.within(0.55, 0.9) * if random.bits().is_multiple_of(2) { 1.0 } else { -1.0 };
                let aside = DVec3::new(0.0, -z, y) * (half * aside);
                ray(aside + DVec3::X * random.within(-0.1, 0.1) - d, d)
            });
            let (model, lines) = rounded(&model, lines.collect(), precision);
            // As this precision holds the half widths.
            let half = model.surfaces[..3].iter().flat_map(|s| &s.points).filter(|p| p[3] == 1.0);
            let half = half.map(|p| p[1].hypot(p[2])).fold(0.0, f64::max);
            for method in ORIGINALS {
                let told = all_hits(&model, &lines, method, precision);
                let closest = trace(&model, &lines, method, precision);
                for ((ray, hits), closest) in lines.iter().zip(told).zip(closest) {
                    let what = format!("{} {} {half:e} {ray:?}", method.name(), precision.name());
                    let [first, second] = meet_pipe([half; 2], ray).expect("it passes through the pipe");
                    let across = [first, second].map(|t| ray.origin[0] + t * ray.direction[0]);
                    if across.iter().any(|x| x.abs() > 0.49) {
                        continue;
                    }
                    let sine = ray.direction[1].hypot(ray.direction[2]);
                    let off = 100.0 * unit / sine;
                    assert!(second - first > 4.0 * off, "{what}: too thin to tell");
                    let hits = hits.unwrap_or_else(|| panic!("{what}: given up"));
                    assert!(
                        at(&hits, first, off) > 0 && at(&hits, second, off) > 0,
                        "{what}: {hits:?} {first} {second}"
                    );
                    let found = hits
                        .iter()
                        .all(|hit| hit.surface == 3 || at(&[*hit], first, off) + at(&[*hit], second, off) > 0);
                    assert!(found, "{what}: {hits:?} {first} {second}");
                    let Outcome::Hit(closest) = closest else { panic!("{what}: {closest:?}") };
                    // From below the floor is met before.
                    let below = ray.direction[2] > 0.0 && closest.surface == 3;
                    assert!(below || at(&[closest], first, off) == 1, "{what}: {closest:?} {first} {second}");
                }
            }
        }
    }
}

/// What a line meets of a sphere or of a torus about the z axis, in the plane that holds both.
fn met_in_plane(ray: &RayLine, circles: &[[f64; 3]]) -> Vec<f64> {
    let (o, d) = (DVec3::from_array(ray.origin), DVec3::from_array(ray.direction));
    let outward = DVec3::new(d.x, d.y, 0.0).normalize_or(DVec3::new(o.x, o.y, 0.0).normalize_or(DVec3::X));
    let flat = |p: DVec3| [p.dot(outward), p.z];
    let ([x, z], [dx, dz]) = (flat(o), flat(d));
    let mut all = Vec::new();
    for &[cx, cz, r] in circles {
        // From the point nearest to the circle's middle, where little cancels.
        let speed = dx.hypot(dz);
        let nearest = -((x - cx) * dx + (z - cz) * dz) / (speed * speed);
        let off = (x - cx + nearest * dx).hypot(z - cz + nearest * dz);
        let half = ((r - off) * (r + off)).sqrt() / speed;
        all.extend([nearest - half, nearest + half].into_iter().filter(|t| t.is_finite() && *t >= 0.0));
    }
    all.sort_by(f64::total_cmp);
    all
}

/// Rays in planes through the axis meet surfaces of revolution along their seams, and a sphere at its poles: whatever is told
/// there is a crossing, and none is left out.
#[test]
fn all_crossings_of_seams_and_poles_are_told() {
    let ball = (sphere([0.0; 3], 1.5), vec![[0.0, 0.0, 1.5]]);
    let ring = (torus([0.0; 3], 1.0, 0.25, 4, 4), vec![[1.0, 0.0, 0.25], [-1.0, 0.0, 0.25]]);
    for (model, circles) in [ball, ring] {
        for precision in PRECISIONS {
            let mut draw = Draw { random: Random(62), rays: 0, precision };
            let lines = (0..rays(400)).map(|n| {
                // The planes of seams, in which x or y is 0.
                let outward = *draw.pick(&[DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y]);
                let pole = n % 8 == 0;
                let [a, b] = [0; 2].map(|_| draw.random.within(-1.0, 1.0));
                let d =
                    (outward * draw.random.within(-1.0, 1.0) + DVec3::Z * draw.random.within(-1.0, 1.0)).normalize();
                let target = if pole { DVec3::Z * 1.5 } else { outward * a + DVec3::Z * (0.2 * b) };
                ray(target - d * 6.0, d)
            });
            let (model, lines) = rounded(&model, lines.collect(), precision);
            let unit = if precision == Precision::F64 { f64::EPSILON } else { f64::from(f32::EPSILON) };
            for method in ORIGINALS {
                let mut crossings = 0;
                for (ray, hits) in lines.iter().zip(all_hits(&model, &lines, method, precision)) {
                    let truth = met_in_plane(ray, &circles);
                    // Where roots are nearly one, their places are no more than the circle's rounding says.
                    let least = 0.4 * circles[0][2];
                    if truth.windows(2).any(|pair| pair[1] - pair[0] < least) || truth.len() % 2 == 1 {
                        continue;
                    }
                    let what = format!("{} {} {ray:?}", method.name(), precision.name());
                    let hits = hits.unwrap_or_else(|| panic!("{what}: given up"));
                    let off = 400.0 * unit;
                    assert!(truth.iter().all(|&t| at(&hits, t, off) > 0), "{what}: {hits:?} {truth:?}");
                    assert!(
                        hits.iter().all(|hit| truth.iter().any(|&t| at(&[*hit], t, off) > 0)),
                        "{what}: {hits:?} {truth:?}"
                    );
                    crossings += truth.len();
                }
                assert!(crossings > lines.len() / 2, "{crossings}");
            }
        }
    }
}

/// Rays all but along the rulings of surfaces that are folded, stalled or twisted beside them: whatever is said to be met, and
/// be it a graze or contact, the ray's point is there to the tolerance.
#[test]
fn nothing_is_told_off_the_ray() {
    for precision in PRECISIONS {
        let mut draw = Draw { random: Random(63), rays: 0, precision };
        let digits = draw.digits();
        let mut told = 0;
        for number in 0..rays(1000).div_ceil(40) {
            // Between two curves that are alike, or nearly: rulings are parallel, or nearly, and a curve may turn back.
            let degree = 1 + index(&mut draw.random, 4);
            let curve: Vec<DVec3> =
                (0..=degree).map(|_| DVec3::from_array(draw.random.point(3.0)) * DVec3::new(0.0, 1.0, 1.0)).collect();
            let twist = *draw.pick(&[0.0, 1e-6, 1e-3]);
            let turned: Vec<DVec3> = curve.iter().map(|p| *p + DVec3::from_array(draw.random.point(twist))).collect();
            let length = 10_f64.powf(draw.random.within(0.0, 1.5));
            let surface = net(1, degree, |i, j| {
                let p = if i == 0 { curve[j] } else { turned[j] };
                (p + DVec3::X * (length * (i as f64 - 0.5))).to_array()
            });
            let model = Model::numbered(vec![surface]);
            let surface = &model.surfaces[0];
            let lines = (0..40).map(|_| {
                let v = draw.random.within(0.0, 1.0);
                let [a, b] = [point(surface, 0.0, v), point(surface, 1.0, v)];
                let [off, tilt] = [0; 2].map(|_| 10_f64.powf(-draw.random.within(1.0, digits)));
                let d = (b - a) / length + DVec3::from_array(draw.random.point(tilt));
                ray(a + DVec3::from_array(draw.random.point(off)) - d * (3.0 * (number % 3) as f64), d)
            });
            let (model, lines) = rounded(&model, lines.collect(), precision);
            for method in METHODS {
                for (ray, outcome) in lines.iter().zip(trace(&model, &lines, method, precision)) {
                    let Outcome::Hit(found) = outcome else { continue };
                    let surface = &model.surfaces[0];
                    // A graze or contact is told up to four errors of the net off the line that the surface is seen as.
                    let errors = if found.incidence == Incidence::Crossing { 1.0 } else { 4.0 };
                    let most = errors * most(precision, surface, size(surface, &model), ray, found.t);
                    let off = distance(surface, ray, &found, 0.01 * most);
                    let what = format!("{} {}", method.name(), precision.name());
                    assert!(off <= most, "{what}: off by {off:e} of {most:e}: {ray:?} {found:?} {surface:?}");
                    told += 1;
                }
            }
        }
        println!("{}: {told} told", precision.name());
        assert!(told > 1000, "{told}");
    }
}

/// Where the ray is all but tangent, rounding moves a root far along the surface. If it lies where regions are halved, each half
/// once left it to the other: of z = x³ clips leave a region about the one root, which its middle is.
#[test]
fn a_shallow_root_is_not_lost_between_halves() {
    let (ends, heights) = ([-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0], [-1.0, 1.0, -1.0, 1.0]);
    let model = single(net(3, 1, |i, j| [ends[i], 2.0 * j as f64 - 1.0, heights[i]]));
    for precision in PRECISIONS {
        let mut draw = Draw { random: Random(63), rays: 0, precision };
        // What rounding leaves across the ray is more along it.
        let (least, across) = match precision {
            Precision::F64 => (5.0, 1e-14),
            Precision::F32 => (2.0, 1e-5),
        };
        let lines = (0..rays(100_000)).map(|_| {
            let slope = 10_f64.powf(-draw.random.within(1.0, least));
            let (y, aside) = (draw.random.within(-0.5, 0.5), draw.random.within(-0.2, 0.2));
            ray(DVec3::new(-2.0, y - 2.0 * aside, 2.0 * slope), DVec3::new(1.0, aside, -slope))
        });
        let (model, lines) = rounded(&model, lines.collect(), precision);
        for method in METHODS {
            let lost = trace(&model, &lines, method, precision).into_iter().zip(&lines).filter(|(outcome, ray)| {
                let off = across / -ray.direction[2];
                !matches!(outcome, Outcome::Hit(found) if (found.t - 2.0).abs() <= off)
            });
            let lost: Vec<_> = lost.collect();
            assert!(lost.is_empty(), "{} {}: {} {:?}", method.name(), precision.name(), lost.len(), lost[0]);
        }
    }
}
