//! Budgets: never more work than they say, giving up names the limit and never looks like a miss, more never finds less.

mod common;

use common::{Kind, Prepared, direction};
use patchray::limits::{Extent, GaveUp, Limit, Limits, Work};
use patchray::method::Remembered;
use patchray::method::{ClipScratch, Scratch, clipping, clipping_coherent, newton, newton_coherent};
use patchray::point::Plain;
use patchray::ray::{Hit, Interval, Ray};
use patchray::reading::Ours;
use patchray::scalar::Scalar;
use patchray_host::scene::camera::Camera;
use patchray_host::scene::shapes::Random;
use patchray_host::scene::teapot;

type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// An answer, the work it took, and the memory it left.
type Traced<S> = (Answer<S>, Work, Vec<Remembered<S>>);

/// Which method, and for the coherent ones what memory they start with.
#[derive(Clone, Copy, Debug)]
enum Method<'r, S> {
    Newton,
    Coherent(&'r [Remembered<S>]),
    Clipping,
    ClippingCoherent(&'r [Remembered<S>]),
}

impl<S> Method<'_, S> {
    /// The same with memory that holds nothing; `None` without memory.
    fn forgetful<'r>(self, nothing: &'r [Remembered<S>]) -> Option<Method<'r, S>> {
        match self {
            Method::Newton | Method::Clipping => None,
            Method::Coherent(_) => Some(Method::Coherent(nothing)),
            Method::ClippingCoherent(_) => Some(Method::ClippingCoherent(nothing)),
        }
    }
}

const LINE: u32 = 5;

fn trace<P: Kind>(
    prepared: &Prepared<P>,
    method: Method<'_, P::Scalar>,
    ray: &Ray<P::Scalar>,
    limits: &Limits<P::Scalar>,
) -> Traced<P::Scalar> {
    let scene = prepared.scene();
    let (patches, interval) = (prepared.patches(), Interval::ahead());
    let (mut scratch, mut work) = (Scratch::<P, 16, 256>::new(), Work::default());
    let view = &mut scratch.view();
    match method {
        Method::Newton => {
            let tree = prepared.tree();
            let answer = newton::closest(&scene, &patches, &tree, ray, &interval, limits, view, &mut work);
            (answer, work, vec![])
        }
        Method::Coherent(memory) => {
            let (mut memory, grids) = (memory.to_vec(), prepared.grids());
            let answer = newton_coherent::closest(
                &scene,
                &patches,
                &grids,
                &mut memory,
                LINE,
                ray,
                &interval,
                limits,
                view,
                &mut work,
            );
            (answer, work, memory)
        }
        Method::Clipping => {
            let mut scratch = ClipScratch::<P, 16, 256, 64>::new();
            let answer = clipping::closest(&scene, ray, &interval, limits, &mut scratch.view(), &mut work);
            (answer, work, vec![])
        }
        Method::ClippingCoherent(memory) => {
            let (mut memory, grids) = (memory.to_vec(), prepared.grids());
            let mut scratch = ClipScratch::<P, 16, 256, 64>::new();
            let answer = clipping_coherent::closest(
                &scene,
                &patches,
                &grids,
                &mut memory,
                LINE,
                ray,
                &interval,
                limits,
                &mut scratch.view(),
                &mut work,
            );
            (answer, work, memory)
        }
    }
}

/// A budget by name: how to set it, and the counter that it bounds.
type Budget<S> = (Limit, fn(&mut Limits<S>, u32), fn(&Work) -> u32);

fn budgets<S: Scalar>() -> [Budget<S>; 7] {
    [
        (Limit::Surfaces, |l, n| l.surfaces = n, |w| w.surfaces_tested),
        (Limit::Nodes, |l, n| l.nodes = n, |w| w.nodes_visited),
        (Limit::Patches, |l, n| l.patches = n, |w| w.patches_tested),
        (Limit::Voxels, |l, n| l.voxels = n, |w| w.voxels_visited),
        (Limit::NewtonSteps, |l, n| l.newton_steps = n, |w| w.newton_steps),
        (Limit::ClipSteps, |l, n| l.clip_steps = n, |w| w.clip_steps),
        (Limit::Bisections, |l, n| l.bisections = n, |w| w.bisections),
    ]
}

/// Rays of the common view and others through the teapot.
fn rays<S: Scalar>(prepared: &Prepared<Plain<S>>, number: usize) -> Vec<Ray<S>>
where
    Plain<S>: Kind<Scalar = S>,
{
    let scene = prepared.scene();
    let camera: Camera = teapot::common_scene().unwrap().description.camera;
    let view = camera.view([64, 64]);
    let mut random = Random(111);
    let make = |k: usize| {
        let (origin, d) = if k.is_multiple_of(2) {
            // Consecutive pixels of a scan line, so that coherence has something to work with.
            (view.eye, view.direction((k as u32 / 2) % 64, 8 + (k as u32 / 128) % 48))
        } else {
            let at = random.point(1.5);
            let d = direction(&mut random, 0.0);
            (common::add([at[0], at[1], at[2] + 1.5], -5.0, d), d)
        };
        scene.ray(origin.map(S::from_f64), d.map(S::from_f64)).unwrap()
    };
    (0..number).map(make).collect()
}

fn every_budget<S: Scalar>()
where
    Plain<S>: Kind<Scalar = S>,
{
    let prepared = Prepared::<Plain<S>>::of(&teapot::model().unwrap());
    let limits = Limits::<S>::default();
    let mut gave_up = [0_u32; 7];
    let mut with_best = 0;
    let nothing = vec![Remembered::EMPTY; 32];
    let (mut remembered, mut without_memory) = ([nothing.clone(), nothing.clone()], 0);
    for (k, ray) in rays(&prepared, 240).iter().enumerate() {
        let [newton, clips] = remembered.clone();
        let methods = [Method::Newton, Method::Coherent(&newton), Method::Clipping, Method::ClippingCoherent(&clips)];
        for (number, method) in methods.into_iter().enumerate() {
            let (full, used, memory) = trace(&prepared, method, ray, &limits);
            let full = full.expect("the default budgets are far from any ray of the teapot");
            if k % 2 == 0 && !memory.is_empty() {
                remembered[number / 2] = memory;
            }
            let forgot = method.forgetful(&nothing).map(|method| trace(&prepared, method, ray, &limits));
            let (memory_led, alone) = (forgot.is_some(), forgot.as_ref().map(|(_, work, _)| *work));
            // Of a root that was found by two ways the last bits may differ.
            let other = forgot.and_then(|(answer, ..)| answer.expect("as far").map(|hit| hit.t));
            let nearest = full.map(|hit| other.map_or(hit.t, |t| t.lesser(hit.t)));
            for (b, (limit, set, counter)) in budgets::<S>().into_iter().enumerate() {
                let needed = counter(&used);
                let mut found_before = false;
                for n in (0..needed.min(40)).chain((40..needed).step_by(7)).chain(needed..needed + 2) {
                    let mut small = limits;
                    set(&mut small, n);
                    let (answer, work, _) = trace(&prepared, method, ray, &small);
                    // The search that memory led, and the one without.
                    let searches = if memory_led { 2 } else { 1 };
                    assert!(counter(&work) <= searches * n, "{limit}: {} of {n}", counter(&work));
                    if n >= needed {
                        assert_eq!((answer, work), (Ok(full), used));
                        continue;
                    }
                    // Short of what the ray needs: without memory it may need less.
                    let forgot = method.forgetful(&nothing).map(|method| trace(&prepared, method, ray, &small));
                    if let Some((Ok(hit), alone, _)) = forgot {
                        assert_eq!((answer, n <= counter(&work)), (Ok(hit), true));
                        assert!(counter(&alone) <= n && hit.is_some() == full.is_some());
                        without_memory += 1;
                        continue;
                    }
                    // What memory led into may leave more to the rest than a search without it has.
                    if let (Some(_), Ok(hit)) = (&forgot, answer) {
                        assert!(counter(&work) > n && hit.is_some() == full.is_some());
                        continue;
                    }
                    // Neither a hit nor a miss, and it says why.
                    let short = answer.expect_err("a budget that is too small is not an answer");
                    assert_eq!(short.limit, limit);
                    assert!(counter(&work) >= n);
                    gave_up[b] += 1;
                    with_best += u32::from(short.best.is_some());
                    // What was found by then is a root of the ray, never nearer than the answer; more budget never loses it.
                    assert!(short.best.is_some() || !found_before);
                    found_before = short.best.is_some();
                    if let (Some(best), Some(nearest)) = (short.best, nearest) {
                        assert!(best.t >= nearest);
                    }
                    assert!(short.best.is_none() || full.is_some());
                    let others = budgets::<S>();
                    let most = |counter: fn(&Work) -> u32| counter(&used) + alone.as_ref().map_or(0, counter);
                    assert!(others.iter().all(|&(_, _, counter)| counter(&work) <= most(counter)));
                }
            }
        }
    }
    println!("gave up on {gave_up:?}, {with_best} times with a hit so far; {without_memory} answered without memory");
    assert!(gave_up.iter().all(|&n| n > 50) && with_best > 100 && without_memory > 5);
}

#[test]
fn every_budget_from_nothing_to_enough() {
    every_budget::<f32>();
    every_budget::<f64>();
}

/// `Limits::worst_case` is above what any of many rays takes, in every counter.
#[test]
fn no_ray_passes_the_worst_case() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
    {
        let prepared = Prepared::<Plain<S>>::of(&teapot::model().unwrap());
        let limits = Limits::<S>::default();
        let extent = Extent {
            surfaces: 32,
            patches: prepared.patches.len() as u32,
            scene_voxels: prepared.scene().longest_walk(),
            ..Default::default()
        };
        let plain = limits.worst_case(&Extent { nodes: prepared.nodes.len() as u32, ..extent });
        let coherent =
            limits.worst_case(&Extent { surface_voxels: prepared.grids().longest_walks(), walks: 2, ..extent });
        let clips = limits.worst_case(&Extent { clipped: true, patches: 0, ..extent });
        let coherent_clips = limits.worst_case(&Extent {
            surface_voxels: prepared.grids().longest_walks(),
            walks: 1,
            clipped: true,
            ..extent
        });
        let mut hardest = [Work::default().counts(); 4];
        let mut remembered = vec![Remembered::EMPTY; 32];
        let mut clipped = vec![Remembered::EMPTY; 32];
        for ray in rays(&prepared, 6000) {
            let (_, work, _) = trace(&prepared, Method::Newton, &ray, &limits);
            let (answer, coherent, memory) = trace(&prepared, Method::Coherent(&remembered), &ray, &limits);
            assert!(answer.is_ok());
            remembered = memory;
            let (_, clipping, _) = trace(&prepared, Method::Clipping, &ray, &limits);
            let (answer, both, memory) = trace(&prepared, Method::ClippingCoherent(&clipped), &ray, &limits);
            assert!(answer.is_ok());
            clipped = memory;
            for (most, work) in hardest.iter_mut().zip([work, coherent, clipping, both]) {
                for (most, count) in most.iter_mut().zip(work.counts()) {
                    *most = (*most).max(count);
                }
            }
        }
        let names = ["newton", "newton-coherent", "clipping", "clipping-coherent"];
        let worst = [plain, coherent, clips, coherent_clips];
        for (name, (hardest, worst)) in names.iter().zip(hardest.iter().zip(worst)) {
            for (k, (&hardest, worst)) in hardest.iter().zip(worst.counts()).enumerate() {
                println!("{name} {}: hardest {hardest}, worst case {worst}", Work::NAMES[k]);
                assert!(hardest <= worst, "{name} {}: {hardest} {worst}", Work::NAMES[k]);
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

/// A scene whose every part one ray meets: the bound is reached where it can be, so it is no idle number.
#[test]
fn the_worst_case_is_come_near() {
    use patchray_host::scene::model::Model;
    use patchray_host::scene::shapes::parallelogram;
    // A tower of forty flat sheets across the ray, one patch each: all surfaces, patches and nearly all voxels are met.
    let sheets = (0..40).map(|k| parallelogram([-0.5, -0.5, f64::from(k)], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    let prepared = Prepared::<Plain<f64>>::of(&Model::numbered(sheets.collect()));
    let limits = Limits::default();
    let ray = prepared.scene().ray([0.1, 0.05, 50.0], [0.0, 0.0, -1.0]).unwrap();
    let (scene, patches, tree) = (prepared.scene(), prepared.patches(), prepared.tree());
    let extent = Extent {
        surfaces: 40,
        nodes: prepared.nodes.len() as u32,
        patches: prepared.patches.len() as u32,
        scene_voxels: scene.longest_walk(),
        ..Default::default()
    };
    let worst = limits.worst_case(&extent);
    // The original method's search, but of no effect: a hit would end the way through the scene.
    let mut work = Work::default();
    let whole = Interval::new(-f64::INFINITY, f64::INFINITY).unwrap();
    let no_pruning = scene.closest(Ours, &ray, &whole, &limits, &mut work, |surface, planes, _, work| {
        let mut descent = tree.of_surface(&patches, surface.number as usize).unwrap();
        while let Some((patch, crossing)) = descent.next_patch(planes, &limits, work)? {
            let start = patch.parallelogram(&crossing).unwrap();
            work.intersection_points += u32::from(common::solve(surface, planes, start, &limits, work)?.is_some());
        }
        Ok(None)
    });
    assert_eq!(no_pruning, Ok(None));
    assert_eq!((work.surfaces_tested, worst.surfaces_tested), (40, 40));
    assert_eq!((work.patches_tested, worst.patches_tested), (40, 40));
    assert_eq!(work.intersection_points, 40);
    let along = work.voxels_visited as f64 / worst.voxels_visited as f64;
    println!("voxels: {} of {}", work.voxels_visited, worst.voxels_visited);
    assert!(along > 0.9);
}

/// A tangent takes all that clipping is allowed, where that is little, and no more; the bounds are reached.
#[test]
fn the_worst_case_of_clipping_is_reached() {
    use patchray_host::scene::shapes::{paraboloid, single};
    let prepared = Prepared::<Plain<f64>>::of(&single(paraboloid([0.0; 3], 1.0)));
    // Of z = x² + y² at (0.3, 0.2), from two lengths of its direction away.
    let ray = prepared.scene().ray([-0.9, -1.4, -1.23], [0.6, 0.8, 0.68]).unwrap();
    let extent = Extent { surfaces: 1, clipped: true, ..Default::default() };
    for (clip_steps, bisections) in [(40, 10_000), (20_000, 10), (1, 1), (0, 0)] {
        let limits = Limits { clip_steps, bisections, ..Default::default() };
        let worst = limits.worst_case(&extent);
        let (answer, work, _) = trace(&prepared, Method::Clipping, &ray, &limits);
        let expected = if clip_steps <= 40 { Limit::ClipSteps } else { Limit::Bisections };
        assert_eq!(answer.unwrap_err().limit, expected);
        let reached = if expected == Limit::ClipSteps {
            (work.clip_steps, worst.clip_steps)
        } else {
            (work.bisections, worst.bisections)
        };
        assert_eq!(reached.0, reached.1);
        assert!(work.counts().iter().zip(worst.counts()).skip(6).all(|(&count, worst)| count <= worst), "{work:?}");
    }
}

/// Regions that wait are bounded by the limit, and by the room lent, whichever is less: by that name, and never a miss.
#[test]
fn waiting_regions_are_bounded() {
    use patchray_host::scene::shapes::{bumpy, single};
    fn closest<const ORDER: usize, const POINTS: usize, const PENDING: usize>(
        prepared: &Prepared<Plain<f64>>,
        ray: &Ray<f64>,
        pending_domains: u32,
    ) -> Answer<f64> {
        let limits = Limits { pending_domains, ..Default::default() };
        let (mut scratch, mut work) = (ClipScratch::<_, ORDER, POINTS, PENDING>::new(), Work::default());
        let (scene, interval) = (prepared.scene(), Interval::ahead());
        clipping::closest(&scene, ray, &interval, &limits, &mut scratch.view(), &mut work)
    }
    let prepared = Prepared::<Plain<f64>>::of(&single(bumpy(112, [3, 4], [0.0; 3], 2.0, 1.5)));
    let limit = |answer: Answer<f64>| answer.map_or_else(|gave_up| Some(gave_up.limit), |_| None);
    let mut random = Random(113);
    let mut bisected = 0;
    for _ in 0..300 {
        let (from, to) = (direction(&mut random, 0.0), random.point(0.7));
        let d = core::array::from_fn(|k| to[k] - 3.0 * from[k]);
        let ray = prepared.scene().ray(from.map(|c| 3.0 * c), d).unwrap();
        let (full, work, _) = trace(&prepared, Method::Clipping, &ray, &Limits::default());
        // Exactly so many are needed, by the limit and by the room alike.
        let needed = (0..64).find(|&n| closest::<5, 20, 64>(&prepared, &ray, n) == full).unwrap();
        assert_eq!(needed == 0, work.bisections == 0);
        if needed > 0 {
            bisected += 1;
            assert!(needed >= 2);
            assert_eq!(limit(closest::<5, 20, 64>(&prepared, &ray, needed - 1)), Some(Limit::PendingDomains));
            assert_eq!(limit(closest::<5, 20, 1>(&prepared, &ray, 64)), Some(Limit::PendingDomains));
            if needed > 2 {
                assert_eq!(limit(closest::<5, 20, 2>(&prepared, &ray, 64)), Some(Limit::PendingDomains));
            }
        }
        assert_eq!(limit(closest::<5, 20, 0>(&prepared, &ray, 64)).is_some(), needed > 0);
        // Too little room for the net is said wherever the surface is looked at; for the basis, where it is evaluated.
        let passes = work.clip_steps == 0;
        let short = closest::<5, 19, 64>(&prepared, &ray, 64);
        assert_eq!(limit(short), if work.surfaces_tested == 0 { None } else { limit(short) });
        assert!(passes || limit(short) == Some(Limit::Scratch));
        let low = closest::<4, 20, 64>(&prepared, &ray, 64);
        assert!(low == full || limit(low) == Some(Limit::Scratch));
        assert!(full.unwrap().is_none() || limit(low) == Some(Limit::Scratch));
    }
    assert!(bisected > 30, "{bisected}");
}
