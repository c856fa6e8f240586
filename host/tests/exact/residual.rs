//! How far the point of a hit is from the surface that it is told of, at the surface's nearest point: beside whatever stands in
//! the scene no more than that surface's own rounding.

use glam::DVec3;
use patchray::ray::Incidence;
use patchray_host::oracle::{DoubleDouble, OracleIn, Real};
use patchray_host::scanline::{Found, Outcome};
use patchray_host::scene::camera::View;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::file;
use patchray_host::scene::model::{Model, ModelSurface};
use patchray_host::scene::patches;
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::sampling::Sampling;
use patchray_host::scene::shapes::weights::{Sheet, Weights, point_anywhere};
use patchray_host::scene::shapes::{
    Random, bumpy, cylinder, elevate, paraboloid, parallelogram, single, sphere, torus,
};
use patchray_host::scene::teapot;
use patchray_host::scene::trace::Precision;
use patchray_host::stress::case::{Case, Draw, Shot, ray};
use patchray_host::stress::truth::{in_precision, rays_of, size};
use rayon::prelude::*;

use crate::tools::{METHODS, OF_PICTURES, PRECISIONS, rays, told, trace, trace_view};

type Number = DoubleDouble;

/// The point and its two derivatives at (u, v), by de Casteljau's scheme.
fn jet(surface: &ModelSurface, at: [Number; 2]) -> [[Number; 3]; 3] {
    // The value, and the derivative.
    let blend = |mut points: Vec<[Number; 4]>, t: Number| {
        let degree = points.len() - 1;
        // Ends: each round leaves one point less.
        while points.len() > 2 {
            points = points.windows(2).map(|p| [0, 1, 2, 3].map(|k| p[0][k] + t * (p[1][k] - p[0][k]))).collect();
        }
        let slope = [0, 1, 2, 3].map(|k| points[1][k] - points[0][k]);
        ([0, 1, 2, 3].map(|k| points[0][k] + t * slope[k]), slope.map(|c| c.times(degree as f64)))
    };
    let weighted = |point: &[f64; 4]| {
        let [x, y, z, w] = point.map(Number::new);
        [x * w, y * w, z * w, w]
    };
    let rows = surface.points.chunks(surface.degree_v + 1);
    let (values, slopes): (Vec<_>, Vec<_>) = rows.map(|row| blend(row.iter().map(weighted).collect(), at[1])).unzip();
    let (value, along_u) = blend(values, at[0]);
    let (along_v, _) = blend(slopes, at[0]);
    let point = [0, 1, 2].map(|k| value[k] / value[3]);
    let slope = |of: [Number; 4]| [0, 1, 2].map(|k| (of[k] - point[k] * of[3]) / value[3]);
    [point, slope(along_u), slope(along_v)]
}

/// How far the ray's point at the hit's t is from the surface, near the hit's parameters: those are only the nearest numbers.
/// A distance of `enough` is not made smaller.
pub(crate) fn distance(surface: &ModelSurface, ray: &RayLine, found: &Found, enough: f64) -> f64 {
    let t = Number::new(found.t);
    let place = [0, 1, 2].map(|k| t.on_ray(ray.origin[k], ray.direction[k]));
    let off = |at: [Number; 2]| {
        let [point, du, dv] = jet(surface, at);
        let off = [0, 1, 2].map(|k| (place[k] - point[k]).to_f64());
        let [du, dv] = [du, dv].map(|d| DVec3::from_array(d.map(|c| c.to_f64())));
        (DVec3::from_array(off), du, dv)
    };
    let mut at = [found.u, found.v].map(Number::new);
    let (mut way, mut du, mut dv) = off(at);
    let mut share = 1.0;
    for _ in 0..60 {
        if way.length() <= enough {
            break;
        }
        // A step of Gauss and Newton's method, along one parameter where the other leads nowhere, or out of the surface;
        // shorter until it leads nearer.
        let ([a, b, c], [r, s]) = ([du.dot(du), du.dot(dv), dv.dot(dv)], [du.dot(way), dv.dot(way)]);
        let determinant = a * c - b * b;
        let both = [(c * r - b * s) / determinant, (a * s - b * r) / determinant];
        let leaves = |k: usize| (both[k] < 0.0 && at[k] <= Number::ZERO) || (both[k] > 0.0 && at[k] >= Number::ONE);
        let regular = determinant > 1e-20 * a * c;
        let step = if regular && !leaves(0) && !leaves(1) {
            both
        } else if (regular && leaves(1)) || (!regular && a > c) {
            [r / a, 0.0]
        } else {
            [0.0, s / c]
        };
        let tried = [0, 1].map(|k| {
            let moved = at[k] + Number::new(step[k] * share);
            if moved > Number::ONE {
                Number::ONE
            } else if moved > Number::ZERO {
                moved
            } else {
                Number::ZERO
            }
        });
        let next = off(tried);
        if next.0.length() < way.length() {
            (at, (way, du, dv), share) = (tried, next, 1.0);
        } else {
            share *= 0.25;
        }
    }
    way.length()
}

/// The same, not more than to the nearest of the ray's roots: for parameters that are far from those of the nearest point.
fn distance_along(surface: &ModelSurface, ray: &RayLine, t: f64) -> f64 {
    let verdict =
        OracleIn::<Number>::new(&single(surface.clone())).trace(ray.origin, ray.direction, ray.t_min, ray.t_max);
    let speed = DVec3::from_array(ray.direction).length();
    let off = verdict.roots.iter().map(|root| (root.t - t).abs() * speed * root.cosine);
    off.fold(f64::INFINITY, f64::min)
}

/// The most that it may be: a share of the surface's size, and 16 units in the last place of the largest coordinate, of the
/// surface or of the ray there.
pub(crate) fn most(precision: Precision, surface: &ModelSurface, size: f64, ray: &RayLine, t: f64) -> f64 {
    let (share, unit) = match precision {
        Precision::F64 => (1e-14, f64::EPSILON),
        Precision::F32 => (2e-6, f64::from(f32::EPSILON)),
    };
    let points = surface.points.iter().flat_map(|point| &point[..3]);
    let largest = points.fold(0.0, |largest: f64, c| largest.max(c.abs()));
    let there = [0, 1, 2].map(|k| (ray.origin[k] + t * ray.direction[k]).abs());
    share * size + 16.0 * unit * there.into_iter().fold(largest, f64::max)
}

fn fixture(name: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures").join(name)
}

/// A bumpy surface with weights that fall away to one in 1e9.
fn steep(sheet: Sheet, arrangement: Weights) -> Model {
    let mut random = Random(71);
    let surface = sheet.surface(&mut random);
    single(arrangement.of(surface, 1e9, &mut random))
}

/// The models, each with the ratio of its weights.
fn models() -> Vec<(String, Model, f64)> {
    let plain = |name: &str, model: Model| (name.to_owned(), model, 1.0);
    let mut models = vec![
        plain("teapot", teapot::model().expect("the fixture is valid")),
        plain("sphere", sphere([0.1, 0.2, -0.3], 1.0)),
        plain("cylinder", cylinder([0.3, -0.1, 0.2], 0.7, 1.1)),
        plain("torus", torus([-0.2, 0.1, 0.05], 1.0, 0.4, 4, 4)),
        plain("paraboloid", single(paraboloid([0.25, -0.5, 1.0], 1.0))),
        plain("square", single(parallelogram([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]))),
        plain("flat", single(elevate(&parallelogram([0.1, 0.2, 0.3], [1.0, 0.5, 0.0], [-0.25, 1.0, 0.5]), 3, 3))),
        plain("sphere away from 0", sphere([300.0, -200.0, 100.0], 1.0)),
    ];
    for (seed, degrees) in [(1, [2, 12]), (2, [5, 5]), (3, [15, 15]), (4, [3, 3]), (5, [1, 15])] {
        models.push(plain(&format!("bumpy {degrees:?}"), single(bumpy(seed, degrees, [0.1, -0.2, 0.3], 2.0, 0.4))));
    }
    for name in ["patches/hill.bpt", "patches/nurbs.json"] {
        let read = patches::read(&fixture(name), OnInvalid::Refuse).expect("the fixture is valid");
        models.push(plain(name, read.model));
    }
    // They have thousands of patches, which take far longer to make than a few rays to trace.
    let scenes: &[_] = if rays(0) > 0 { &["hill", "mirrors", "rings", "toruses"] } else { &["hill"] };
    for name in scenes {
        let name = format!("scenes/{name}.toml");
        let scene = file::read(&fixture(&name), OnInvalid::Refuse).expect("the fixture is valid");
        models.push(plain(&name, scene.model));
    }
    for arrangement in [Weights::Edge(1), Weights::Corner(3), Weights::Graded([1, -1]), Weights::Any] {
        for sheet in Sheet::ALL {
            models.push((format!("{sheet:?} {arrangement:?}"), steep(sheet, arrangement), 1e9));
        }
    }
    models
}

/// What else is in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mate {
    None,
    /// One of the model's size, 1e9 of it away.
    Far,
    /// One 1e6 times as large, below.
    Large,
}

fn beside(model: &Model, mate: Mate) -> Model {
    let bounds = model.control_box().expect("it has points");
    let (size, [x, y, z]) = (bounds.diagonal(), bounds.min);
    let other = match mate {
        Mate::None => return model.clone(),
        Mate::Far => parallelogram([x + 1e9 * size, y, z], [size, 0.0, 0.0], [0.0, size, 0.0]),
        Mate::Large => {
            let side = 1e6 * size;
            parallelogram([x - 0.5 * side, y - 0.5 * side, z - 100.0 * size], [side, 0.0, 0.0], [0.0, side, 0.0])
        }
    };
    Model::numbered([model.surfaces.clone(), vec![other]].concat())
}

/// Rays at places of the surfaces, from some sizes of the surface away.
fn onto(draw: &mut Draw, model: &Model, ratio: f64, count: usize) -> Vec<RayLine> {
    let aimed = (0..count).map(|_| {
        let surface = draw.pick(&model.surfaces);
        let target = DVec3::from_array(point_anywhere(surface, ratio, &mut draw.random));
        let direction = draw.direction();
        let distance = size(surface, model) * draw.random.within(0.5, 3.0);
        ray(target - direction * distance, direction)
    });
    aimed.collect()
}

#[test]
fn a_hit_is_on_its_surface_whatever_stands_beside_it() {
    let models = models();
    let count = rays(500).div_ceil(models.len());
    let kinds: Vec<_> = models
        .iter()
        .flat_map(|model| PRECISIONS.map(|precision| (model, precision)))
        .flat_map(|(model, precision)| [Mate::None, Mate::Far, Mate::Large].map(|mate| (model, precision, mate)))
        .collect();
    let lines: Vec<(String, Vec<String>)> = kinds
        .par_iter()
        .map(|&((name, model, ratio), precision, mate)| {
            let mut draw = Draw { random: Random(Random(72).bits()), rays: count, precision };
            let lines = onto(&mut draw, model, *ratio, count);
            let case = in_precision(&Case::of_rays(beside(model, mate), lines), precision);
            let lines = rays_of(&case);
            let mut wrong = Vec::new();
            let mut told_of = String::new();
            for method in METHODS {
                let (mut worst, mut share, mut hits) = ([0.0; 2], [0.0; 2], 0);
                for (ray, outcome) in lines.iter().zip(trace(&case.model, &lines, method, precision)) {
                    let Outcome::Hit(found) = outcome else { continue };
                    if found.surface >= model.surfaces.len() {
                        continue;
                    }
                    let surface = &case.model.surfaces[found.surface];
                    let size = size(surface, &case.model);
                    let most = most(precision, surface, size, ray, found.t);
                    let mut off = distance(surface, ray, &found, 0.01 * most);
                    if off > most {
                        off = off.min(distance_along(surface, ray, found.t));
                    }
                    hits += 1;
                    let grazes = found.incidence != Incidence::Crossing;
                    // What does not hold yet: uneven weights leave less of the digits of f32 than even ones.
                    let short = precision == Precision::F32 && *ratio > 1.0;
                    let kind = usize::from(grazes);
                    worst[kind] = f64::max(worst[kind], off / size);
                    share[kind] = f64::max(share[kind], off / most);
                    if !(off <= most) && !grazes && !short {
                        let text = told(surface, ray);
                        wrong.push(format!(
                            "{name} {mate:?} {}: off by {off:e} of {most:e}: {found:?}\n{text}",
                            method.name()
                        ));
                    }
                }
                if 10 * hits < 3 * lines.len() {
                    wrong.push(format!("{name} {mate:?}: only {hits} of {} hit it", lines.len()));
                }
                let ([worst, grazing], [share, by]) = (worst, share);
                told_of += &format!(" {} {worst:.1e} ({share:.2}) {grazing:.1e} ({by:.2})", method.name());
            }
            (format!("{name} {mate:?} {}:{told_of}", precision.name()), wrong)
        })
        .collect();
    let mut wrong = Vec::new();
    for (line, failures) in lines {
        println!("{line}");
        wrong.extend(failures);
    }
    assert!(wrong.is_empty(), "{} wrong, the first:\n{}", wrong.len(), wrong[..wrong.len().min(10)].join("\n\n"));
}

/// A sphere whose radius is a millionth of half the square's side, above its middle and away from it: there a coordinate is told
/// to no more than a thirtieth of the radius in `f32`, which must not be what is left of the sphere.
#[test]
fn a_small_sphere_above_a_large_square_is_where_it_is() {
    // Numbers that the control points hold exactly, away from the middle too.
    let (radius, half) = (1.0 / 2048.0, 500.0);
    let floor = parallelogram([-half, -half, 0.0], [2.0 * half, 0.0, 0.0], [0.0, 2.0 * half, 0.0]);
    for (place, precision) in [[0.0, 0.0], [300.0, -200.0]].into_iter().flat_map(|at| PRECISIONS.map(|of| (at, of))) {
        let [x, y] = place;
        let model = Model::numbered([sphere([x, y, 2.0], radius).surfaces, vec![floor.clone()]].concat());
        let mut random = Random(73);
        // Where a ray begins is a number of `f32` at either place.
        let steps = |c: f64| (c * 32768.0).round() / 32768.0;
        let lines = (0..rays(1000)).map(|_| {
            let [from, turn] = [random.within(0.0, 3.0) * radius, random.within(0.0, 6.3)];
            let (b, a) = turn.sin_cos();
            ray(DVec3::new(x + steps(from * a), y + steps(from * b), 10.0), DVec3::NEG_Z)
        });
        let lines: Vec<_> = lines.collect();
        // The rounding of the sphere's own coordinates, as a share of its radius, and of the ray's.
        let (unit, near) = match precision {
            Precision::F64 => (f64::EPSILON, 1e-12),
            Precision::F32 => (f64::from(f32::EPSILON), 1e-5),
        };
        for method in METHODS {
            let mut hits = 0;
            for (ray, outcome) in lines.iter().zip(trace(&model, &lines, method, precision)) {
                let Outcome::Hit(found) = outcome else { panic!("{} {ray:?}: {outcome:?}", method.name()) };
                let from = (ray.origin[0] - x).hypot(ray.origin[1] - y) / radius;
                let height = |nearer: f64| (1.0 - from * from).max(0.0) + 2.0 * nearer;
                let inside = 8.0 - height(0.0).sqrt() * radius;
                // Near the outline the height changes by more than the rounding of what it is computed from.
                let off = 16.0 * unit * 10.0 + radius * (height(near).sqrt() - height(0.0).sqrt());
                let (at_sphere, at_floor) =
                    ((found.t - inside).abs() <= off, (found.t - 10.0).abs() <= 16.0 * unit * 10.0);
                let right = if from < 1.0 - near { at_sphere } else { at_floor || from < 1.0 + near && at_sphere };
                let what = || format!("{} {} {place:?} {from}", method.name(), precision.name());
                assert!(right, "{} {ray:?}: {found:?} {inside}", what());
                hits += usize::from(at_sphere);
            }
            assert!(5 * hits > lines.len(), "{hits}");
        }
    }
}

/// A part at the coordinates of a national grid, in a file of `f64`: each coordinate is held to half a unit in `f32`, which must
/// not be what is left of a radius of 4.
#[test]
fn a_part_far_from_0_keeps_its_digits() {
    let (centre, radius) = (DVec3::new(123_456.0, 7_654_321.0, 60.0), 4.0);
    let model = sphere(centre.to_array(), radius);
    // What f64 leaves of coordinates so large, and what f32 leaves of a ray from some sizes away.
    let most = |precision| if precision == Precision::F64 { 2e-8 } else { 1e-5 };
    let meet = |ray: &RayLine| {
        let (from, d) = (DVec3::from_array(ray.origin) - centre, DVec3::from_array(ray.direction));
        let (b, c) = (from.dot(d) / d.length_squared(), (from.length_squared() - radius * radius) / d.length_squared());
        let cosine = (b * b - c).max(0.0).sqrt() * d.length() / radius;
        (-b - (b * b - c).sqrt(), cosine)
    };
    let check = |what: &str, precision, ray: &RayLine, outcome: &Outcome| {
        let (t, cosine) = meet(ray);
        if cosine < 0.2 {
            return false;
        }
        let Outcome::Hit(found) = outcome else { panic!("{what} {ray:?}: {outcome:?}") };
        let off = (found.t - t).abs() * DVec3::from_array(ray.direction).length() * cosine;
        assert!(off <= most(precision), "{what} off by {off:e}: {ray:?} {found:?} {t}");
        true
    };
    let mut random = Random(74);
    for precision in PRECISIONS {
        let mut draw = Draw { random: Random(random.bits()), rays: 0, precision };
        let lines: Vec<RayLine> = (0..rays(300))
            .map(|_| draw.ray_to(centre + DVec3::from_array(draw.random.clone().point(1.5)), 12.0))
            .collect();
        for method in METHODS {
            let outcomes = trace(&model, &lines, method, precision);
            let checked =
                lines.iter().zip(&outcomes).filter(|(ray, outcome)| check(method.name(), precision, ray, outcome));
            assert!(2 * checked.count() > lines.len());
        }
        // As a picture, whose eye is no number of f32.
        let toward = DVec3::new(0.6, -0.64, -0.48);
        let right = toward.any_orthonormal_vector();
        let view = View {
            eye: (centre - toward * 12.0 + DVec3::splat(0.1)).to_array(),
            forward: [0.6, -0.64, -0.48].map(|c: f64| f64::from(c as f32)),
            right: (right * 0.25).as_vec3().as_dvec3().to_array(),
            up: (right.cross(toward) * 0.25).as_vec3().as_dvec3().to_array(),
            size: [16, 16],
            sampling: Sampling::One,
        };
        let case = Case { model: model.clone(), shot: Shot::Picture(view), exact: None };
        let lines = rays_of(&case);
        for method in OF_PICTURES {
            let outcomes = trace_view(&model, &view, method, precision);
            let checked =
                lines.iter().zip(&outcomes).filter(|(ray, outcome)| check(method.name(), precision, ray, outcome));
            assert!(2 * checked.count() > lines.len());
        }
    }
}
