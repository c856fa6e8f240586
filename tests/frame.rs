//! No unit: a scene and its rays scaled by a power of two give the same bits of u and v, t scaled exactly, and the same work.

mod common;

use common::{Kind, Prepared, direction};
use patchray::limits::{Limits, Work};
use patchray::method::Remembered;
use patchray::method::{Scratch, newton, newton_coherent};
use patchray::point::Plain;
use patchray::ray::{Hit, Interval};
use patchray::scalar::Scalar;
use patchray::subdivide::Subdivision;
use patchray_host::scene::shapes::Random;
use patchray_host::scene::teapot;

type Found<S> = Vec<(Option<Hit<S>>, Work)>;

/// All rays through the scene at 2^`size`, their directions longer by 2^`speed`.
fn run<S: Scalar>(size: i32, speed: i32) -> [Found<S>; 2]
where
    Plain<S>: Kind<Scalar = S>,
{
    let model = teapot::model().unwrap();
    let prepared = Prepared::<Plain<S>>::new(&model, 2.0_f64.powi(size), &Subdivision::default());
    let (scene, patches, tree, grids) = (prepared.scene(), prepared.patches(), prepared.tree(), prepared.grids());
    assert_eq!(scene.frame().exponent(), -2 - size);
    let (limits, mut scratch) = (Limits::default(), Scratch::<Plain<S>, 4, 16>::new());
    let mut memory = vec![Remembered::EMPTY; scene.len()];
    let mut random = Random(121);
    let mut found = [vec![], vec![]];
    for number in 0..300_u32 {
        let at = random.point(1.5);
        let mut d = direction(&mut random, 0.0);
        if number % 10 == 0 {
            d[2] = 0.0;
        }
        // Inside the scene, near it, and so far that the origin is brought near with care.
        let back = [0.0, 5.0, 1000.0][number as usize % 3];
        let origin = common::add([at[0], at[1], at[2] + 1.5], -back, d);
        // Rounded first, then scaled: the same bits at every scale.
        let origin = origin.map(|c| S::from_f64(c).times_power_of_two(size));
        let d = d.map(|c| S::from_f64(c).times_power_of_two(speed));
        let ray = scene.ray(origin, d).unwrap();
        let interval = Interval::ahead();
        let mut work = Work::default();
        let view = &mut scratch.view();
        let hit = newton::closest(&scene, &patches, &tree, &ray, &interval, &limits, view, &mut work);
        found[0].push((hit.unwrap(), work));
        let line = number / 50;
        let hit = newton_coherent::closest(
            &scene,
            &patches,
            &grids,
            &mut memory,
            line,
            &ray,
            &interval,
            &limits,
            view,
            &mut work,
        );
        found[1].push((hit.unwrap(), work));
    }
    found
}

fn check<S: Scalar>(sizes: &[i32], speeds: &[i32])
where
    Plain<S>: Kind<Scalar = S>,
{
    let expected = run::<S>(0, 0);
    let hits = expected[0].iter().filter(|(hit, _)| hit.is_some()).count();
    assert!((100..300).contains(&hits), "{hits}");
    for &size in sizes {
        for &speed in speeds {
            for (expected, found) in expected.iter().zip(run::<S>(size, speed)) {
                for ((hit, work), (other, other_work)) in expected.iter().zip(found) {
                    let scaled = hit.map(|hit| Hit { t: hit.t.times_power_of_two(size - speed), ..hit });
                    assert_eq!(scaled, other, "at 2^{size}, 2^{speed}");
                    assert_eq!(*work, other_work);
                }
            }
        }
    }
}

#[test]
fn a_power_of_two_changes_no_bit_f32() {
    check::<f32>(&[-60, -31, -2, 1, 17, 60], &[-20, 0, 20]);
}

#[test]
fn a_power_of_two_changes_no_bit_f64() {
    check::<f64>(&[-600, -60, -1, 3, 60, 600], &[-100, 0, 100]);
}
