//! Roots on borders: of surfaces, where neighbours share an edge, and of the halves that bisection makes. No crack lets a ray
//! through, and no surface counts a root twice.

use crate::ask::{Query, Room, ask};
use crate::common::{Built, Kind, add, cross, direction, dot, index, is_rational, norm};
use crate::judge::Allowed;
use patchray::bernstein::Basis;
use patchray::limits::Limits;
use patchray::point::{Plain, Weighted};
use patchray::scalar::Scalar;
use patchray_host::oracle::Oracle;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{Random, bumpy, single, sphere, torus};
use patchray_host::scene::teapot;

/// Which points of a surface rays go through.
#[derive(Clone, Copy, Debug, PartialEq)]
enum On {
    /// Its edges and corners.
    Edges,
    /// Multiples of 1/16 of its parameters.
    Dyadic,
}

/// A parameter on a border, or anywhere.
fn parameter(random: &mut Random, on: On) -> f64 {
    match on {
        On::Edges => [0.0, 1.0][index(random, 2)],
        On::Dyadic => index(random, 17) as f64 / 16.0,
    }
}

/// Rays through points on borders, as flat as `10^−flattest` to the surface.
fn shoot<P: Kind>(name: &str, model: &Model, on: On, rays: u32, flattest: f64) {
    let built = Built::<P>::new(model, 1.0);
    let scene = built.scene();
    let oracle = Oracle::new(model);
    let size = model.control_box().unwrap().diagonal();
    let (mut room, mut random) = (Room::<P>::new(), Random(71));
    let (mut lost, mut twice, mut shot, mut gave_up) = (0, 0, 0, 0);
    let unit = f64::from(-scene.frame().exponent()).exp2();
    for _ in 0..rays {
        let number = index(&mut random, scene.len());
        let mut at = [parameter(&mut random, on), random.within(0.0, 1.0)];
        if index(&mut random, 2) == 0 {
            at.swap(0, 1);
        }
        if index(&mut random, 4) == 0 {
            at = [parameter(&mut random, on), parameter(&mut random, on)];
        }
        let [u, v] = at.map(P::Scalar::from_f64);
        let net = scene.surface(number).unwrap().net;
        let jet = net.jet(u, v, &mut Basis::<P::Scalar, 16>::new().view()).unwrap();
        let vector = |p: P| p.weighted_position().map(|c| c.to_f64() * unit);
        let share = |d: P| if P::RATIONAL { d.weight().to_f64() / jet.point.weight().to_f64() } else { 0.0 };
        let point = vector(jet.point).map(|c| c / jet.point.weight().to_f64());
        let [su, sv] = [jet.du, jet.dv].map(|d| add(vector(d), -share(d), vector(jet.point)));
        let normal = cross(su, sv);
        if norm(normal) < 1e-6 * norm(su) * norm(sv) || norm(su) < 1e-6 * size || norm(sv) < 1e-6 * size {
            // A pole: see `bounded_work`.
            continue;
        }
        let along = add(su.map(|c| c * random.within(-1.0, 1.0)), random.within(-1.0, 1.0), sv);
        let sine = 10.0_f64.powf(-random.within(0.0, flattest));
        let tilted = add(along.map(|c| c / norm(along)), sine / norm(normal), normal);
        let d = if index(&mut random, 3) == 0 { direction(&mut random, 0.0) } else { tilted };
        let d = d.map(|c| c / norm(d));
        let cosine = (dot(d, normal) / norm(normal)).abs();
        if cosine < 0.5 * 10.0_f64.powf(-flattest) {
            continue;
        }
        let distance = random.within(0.5, 2.0) * size;
        let query = Query::new(add(point, -distance, d), d);
        let answers = ask(&built, &query, &Limits::default(), &mut room);
        shot += 1;
        let off = (64.0 * Limits::<P::Scalar>::default().tolerance.to_f64() * size / cosine).min(1e-2 * size);
        let here: Vec<_> =
            answers.hits.iter().filter(|hit| (hit.t.to_f64() - distance).abs() <= off).copied().collect();
        // On an edge that no neighbour shares, or that is a fold as the ray sees it, the ray's own rounding decides.
        let safe = || {
            let verdict = oracle.trace(query.origin, query.direction, 0.0, f64::INFINITY);
            let margin = Allowed::of::<P::Scalar>().margin;
            verdict.roots.iter().any(|root| (root.t - distance).abs() <= off && root.margin > margin)
        };
        if answers.all.is_err() && cosine < 1e-3 {
            // All but tangent, the regions to clip are too many: said so, and no hole.
            gave_up += 1;
        } else if answers.all.is_err() || (here.is_empty() && safe()) {
            lost += 1;
            println!(
                "{name} lost {at:?} of {number}, cosine {cosine:e}: {query:?} {:?} {:?}",
                answers.all, answers.hits
            );
        }
        for (k, hit) in here.iter().enumerate() {
            let close =
                |a: P::Scalar, b: P::Scalar| (a - b).to_f64().abs() < 64.0 * P::Scalar::EPSILON.to_f64() / cosine;
            if here[..k].iter().any(|old| old.surface == hit.surface && close(old.u, hit.u) && close(old.v, hit.v)) {
                twice += 1;
                println!("{name} twice {at:?} of {number}: {here:?}");
            }
        }
    }
    println!("{name} {on:?}: {shot} rays, {lost} lost, {twice} twice, {gave_up} gave up");
    assert!(shot * 2 > rays, "{name}: {shot}");
    assert_eq!((lost, twice), (0, 0), "{name}");
    assert!(gave_up * 20 < shot, "{name}: {gave_up} of {shot} gave up");
}

fn all<S: Scalar>(flattest: f64)
where
    Plain<S>: Kind<Scalar = S>,
    Weighted<S>: Kind<Scalar = S>,
{
    let bumpy = |seed, degrees| single(bumpy(seed, degrees, [0.3, -0.2, 0.1], 2.0, 0.5));
    for (name, model) in [
        ("teapot", teapot::model().unwrap()),
        ("sphere", sphere([0.5, -0.25, 1.0], 1.5)),
        ("torus", torus([0.0; 3], 1.0, 0.25, 4, 4)),
        ("bumpy 3 x 3", bumpy(72, [3, 3])),
        ("bumpy 2 x 12", bumpy(73, [2, 12])),
        ("bumpy 7 x 5", bumpy(74, [7, 5])),
    ] {
        for on in [On::Edges, On::Dyadic] {
            if is_rational(&model) {
                shoot::<Weighted<S>>(name, &model, on, 2000, flattest);
            } else {
                shoot::<Plain<S>>(name, &model, on, 2000, flattest);
            }
        }
    }
}

#[test]
fn no_ray_slips_through_a_border_f64() {
    all::<f64>(6.0);
}

#[test]
fn no_ray_slips_through_a_border_f32() {
    all::<f32>(1.5);
}
