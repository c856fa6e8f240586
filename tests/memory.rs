//! Lent memory: exactly what counting asked for is enough, one slot less says what is missing, rubbish in slots changes
//! nothing before they are filled and harms nothing after.

mod common;

use common::{Built, Kind, Prepared, direction, index, subdivide_scratch, with_nets};
use patchray::arena::Need;
use patchray::bernstein::Basis;
use patchray::grid::{GridError, GridMemory, GridNeeds, GridOptions, GridSlot, Grids};
use patchray::limits::{Acceptance, GaveUp, Limit, Limits, Work};
use patchray::method::Remembered;
use patchray::method::{ClipScratch, Scratch, clipping, newton, newton_coherent};
use patchray::patch::{Parallelepiped, Patch, Patches};
use patchray::point::{Plain, Point, Weighted};
use patchray::ray::{Hit, Interval};
use patchray::scalar::Scalar;
use patchray::scene::{Scene, SceneError, SceneMemory, SceneNeeds, SceneOptions, SurfaceSlot};
use patchray::subdivide::{
    PatchMemory, SubdivideError, SubdivideNeeds, SubdivideScratch, Subdivision, TreeMemory, subdivide,
};
use patchray::tree::Tree;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::{Random, bumpy, sphere};
use patchray_host::scene::teapot;

fn small_model() -> Model {
    Model::numbered(vec![
        bumpy(1, [3, 3], [0.0; 3], 1.0, 0.3),
        bumpy(2, [2, 2], [1.0, 0.0, 0.5], 1.0, 0.3),
        bumpy(3, [4, 1], [0.0, 1.0, -0.5], 1.0, 0.3),
    ])
}

/// One slot less of kind `k`, of as many kinds as `sizes` names.
fn one_less<const N: usize>(sizes: [usize; N]) -> impl Iterator<Item = [usize; N]> {
    (0..N).map(move |k| core::array::from_fn(|i| sizes[i] - usize::from(i == k)))
}

fn need(needed: usize, given: usize) -> Need {
    Need { needed, given }
}

fn scene_with<P: Kind>(model: &Model, sizes: [usize; 4]) -> Result<(), SceneError> {
    let (mut points, mut surfaces) = (vec![P::EMPTY; sizes[0]], vec![SurfaceSlot::EMPTY; sizes[1]]);
    let (mut offsets, mut references) = (vec![7; sizes[2]], vec![7; sizes[3]]);
    with_nets(model, 1.0, |nets: &[_]| {
        let memory = SceneMemory {
            points: &mut points,
            surfaces: &mut surfaces,
            offsets: &mut offsets,
            references: &mut references,
        };
        Scene::<P>::build(nets, &SceneOptions::default(), memory).map(|_| ())
    })
}

#[test]
fn a_scene_needs_what_it_says() {
    fn check<P: Kind>(model: &Model) {
        let prepared = Prepared::<P>::of(model);
        let sizes = [prepared.points.len(), prepared.surfaces.len(), prepared.offsets.len(), prepared.references.len()];
        assert_eq!(scene_with::<P>(model, sizes), Ok(()));
        assert_eq!(scene_with::<P>(model, sizes.map(|n| n + 3)), Ok(()));
        for given in one_less(sizes).chain([[0; 4]]) {
            let [points, surfaces, offsets, references] = core::array::from_fn(|k| need(sizes[k], given[k]));
            let needs = SceneNeeds { points, surfaces, offsets, references };
            assert_eq!(scene_with::<P>(model, given), Err(SceneError::Memory(needs)));
        }
    }
    check::<Plain<f32>>(&small_model());
    check::<Plain<f64>>(&teapot::model().unwrap());
    check::<Weighted<f32>>(&sphere([0.0; 3], 1.0));
}

#[test]
fn patches_and_trees_need_what_they_say() {
    let model = small_model();
    let prepared = Prepared::<Plain<f32>>::of(&model);
    let scene = prepared.scene();
    let mut scratch = subdivide_scratch();
    let mut run = |sizes: [usize; 4], with_tree: bool| {
        let (mut patches, mut first) = (vec![Patch::EMPTY; sizes[0]], vec![7; sizes[1]]);
        let (mut nodes, mut links) = (vec![Parallelepiped::EMPTY; sizes[2]], vec![7; sizes[3]]);
        let memory = PatchMemory { patches: &mut patches, first: &mut first };
        let tree = with_tree.then_some(TreeMemory { nodes: &mut nodes, links: &mut links });
        let options = Subdivision::default();
        subdivide(scene.surfaces(), scene.frame(), &options, &mut scratch.view(), memory, tree)
            .map(|(_, t)| t.is_some())
    };
    let sizes = [prepared.patches.len(), prepared.first.len(), prepared.nodes.len(), prepared.links.len()];
    let surfaces = model.surfaces.len();
    assert_eq!(sizes[2], sizes[0] - surfaces);
    assert_eq!(sizes[3], 2 * sizes[0] - surfaces);
    assert_eq!(run(sizes, true), Ok(true));
    for given in one_less(sizes).chain([[0; 4]]) {
        let [patches, first, nodes, links] = core::array::from_fn(|k| need(sizes[k], given[k]));
        let needs = SubdivideNeeds { patches, first, nodes, links };
        assert_eq!(run(given, true), Err(SubdivideError::Memory(needs)));
    }
    // Without a tree none of its memory is asked for.
    let bare = [sizes[0], sizes[1], 0, 0];
    assert_eq!(run(bare, false), Ok(false));
    for given in one_less([sizes[0], sizes[1]]) {
        let needs =
            SubdivideNeeds { patches: need(sizes[0], given[0]), first: need(sizes[1], given[1]), ..Default::default() };
        assert_eq!(run([given[0], given[1], 0, 0], false), Err(SubdivideError::Memory(needs)));
    }
    // Scratch for exactly the largest net (4 × 4 points), and for one point less: the first surface that does not fit.
    let ask = |view: &mut patchray::subdivide::SubdivideScratchView<'_, _>, options: &Subdivision<f32>| {
        let memory = PatchMemory { patches: &mut [], first: &mut [] };
        subdivide(scene.surfaces(), scene.frame(), options, view, memory, None).map(|_| ())
    };
    let options = Subdivision::default();
    let exact = ask(&mut SubdivideScratch::<_, 16>::new().view(), &options);
    assert!(matches!(exact, Err(SubdivideError::Memory(_))));
    let small = ask(&mut SubdivideScratch::<_, 15>::new().view(), &options);
    assert_eq!(small, Err(SubdivideError::Scratch { surface: 0 }));
    let few = Subdivision { patches_per_surface: 10, ..options };
    let refused = ask(&mut SubdivideScratch::<_, 16>::new().view(), &few);
    assert_eq!(refused, Err(SubdivideError::Patches { surface: 0 }));
}

#[test]
fn grids_need_what_they_say() {
    let model = small_model();
    let prepared = Prepared::<Plain<f64>>::of(&model);
    let run = |sizes: [usize; 3], surfaces: usize| {
        let mut grids = vec![GridSlot::EMPTY; sizes[0]];
        let (mut offsets, mut references) = (vec![7; sizes[1]], vec![7; sizes[2]]);
        let memory = GridMemory { grids: &mut grids, offsets: &mut offsets, references: &mut references };
        Grids::build(surfaces, &prepared.patches(), &GridOptions::default(), memory).map(|_| ())
    };
    let sizes = [prepared.grids.len(), prepared.grid_offsets.len(), prepared.grid_references.len()];
    assert_eq!(run(sizes, 3), Ok(()));
    for given in one_less(sizes).chain([[0; 3]]) {
        let [grids, offsets, references] = core::array::from_fn(|k| need(sizes[k], given[k]));
        assert_eq!(run(given, 3), Err(GridError::Memory(GridNeeds { grids, offsets, references })));
    }
    assert_eq!(run(sizes, 4), Err(GridError::Patches));
}

type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// Both methods, one after the other, over whatever the slots hold.
fn trace<P: Kind>(
    prepared: &Prepared<P>,
    memory: &mut [Remembered<P::Scalar>],
    line: u32,
    [origin, d]: [[f64; 3]; 2],
    limits: &Limits<P::Scalar>,
) -> Option<[(Answer<P::Scalar>, Work); 2]> {
    let scene = prepared.scene();
    let ray = scene.ray(origin.map(P::Scalar::from_f64), d.map(P::Scalar::from_f64)).ok()?;
    let (interval, mut scratch) = (Interval::ahead(), Scratch::<P, 16, 256>::new());
    let (patches, tree, grids) = (prepared.patches(), prepared.tree(), prepared.grids());
    let (mut a, mut b) = (Work::default(), Work::default());
    let plain = newton::closest(&scene, &patches, &tree, &ray, &interval, limits, &mut scratch.view(), &mut a);
    let view = &mut scratch.view();
    let coherent =
        newton_coherent::closest(&scene, &patches, &grids, memory, line, &ray, &interval, limits, view, &mut b);
    Some([(plain, a), (coherent, b)])
}

/// A filled slot of another scene, in each slot: a bit pattern that is wrong in all fields at once.
fn litter<T: Copy>(slots: &mut [T], rubbish: &[T]) {
    for (slot, &other) in slots.iter_mut().zip(rubbish.iter().cycle()) {
        *slot = other;
    }
}

/// Control points of NaN, infinity, and numbers that are not.
fn bad_points<S: Scalar>() -> Vec<Plain<S>> {
    let nan = S::from_f64(f64::NAN);
    vec![Plain([nan; 3]), Plain([S::INFINITY, -S::INFINITY, nan]), Plain([S::MAX, -S::MAX, S::MIN_POSITIVE])]
}

#[test]
fn rubbish_in_lent_memory_changes_nothing() {
    fn check<S: Scalar>() {
        let (model, other) = (small_model(), Prepared::<Plain<S>>::coarse(&teapot::model().unwrap()));
        let clean = Prepared::<Plain<S>>::of(&model);
        let mut dirty = Prepared::<Plain<S>>::of(&model);
        litter(&mut dirty.points, &bad_points());
        litter(&mut dirty.surfaces, &other.surfaces[5..]);
        litter(&mut dirty.patches, &other.patches[9..]);
        litter(&mut dirty.nodes, &other.nodes[3..]);
        litter(&mut dirty.grids, &other.grids[2..]);
        for slots in [&mut dirty.offsets, &mut dirty.references, &mut dirty.first, &mut dirty.links] {
            slots.fill(0xdead_beef);
        }
        for slots in [&mut dirty.grid_offsets, &mut dirty.grid_references] {
            slots.fill(u32::MAX);
        }
        let d = &mut dirty;
        d.header = with_nets(&model, 1.0, |nets: &[_]| {
            let memory = SceneMemory {
                points: &mut d.points,
                surfaces: &mut d.surfaces,
                offsets: &mut d.offsets,
                references: &mut d.references,
            };
            Scene::build(nets, &SceneOptions::default(), memory).unwrap().header()
        });
        let scene = Scene::new(d.header, &d.points, &d.surfaces, &d.offsets, &d.references);
        let mut scratch = subdivide_scratch();
        let memory = PatchMemory { patches: &mut d.patches, first: &mut d.first };
        let tree = TreeMemory { nodes: &mut d.nodes, links: &mut d.links };
        // The scratch holds what another scene left.
        let mut view = scratch.view();
        let nothing = PatchMemory { patches: &mut [], first: &mut [] };
        let elsewhere = other.scene();
        let _ = subdivide(elsewhere.surfaces(), elsewhere.frame(), &Subdivision::default(), &mut view, nothing, None);
        subdivide(scene.surfaces(), scene.frame(), &Subdivision::default(), &mut view, memory, Some(tree)).unwrap();
        let patches = Patches::new(&d.patches, &d.first);
        let memory =
            GridMemory { grids: &mut d.grids, offsets: &mut d.grid_offsets, references: &mut d.grid_references };
        Grids::build(3, &patches, &GridOptions::default(), memory).unwrap();
        assert_eq!(dirty.header, clean.header);
        assert_eq!((&dirty.points, &dirty.surfaces), (&clean.points, &clean.surfaces));
        assert_eq!((&dirty.offsets, &dirty.references), (&clean.offsets, &clean.references));
        assert_eq!((&dirty.patches, &dirty.first), (&clean.patches, &clean.first));
        assert_eq!((&dirty.nodes, &dirty.links), (&clean.nodes, &clean.links));
        assert_eq!(dirty.grids, clean.grids);
        assert_eq!((&dirty.grid_offsets, &dirty.grid_references), (&clean.grid_offsets, &clean.grid_references));

        // Coherence memory of an earlier scan line, and a basis that another surface filled: the next line's answers and
        // counters are those of fresh ones.
        let mut random = Random(91);
        let mut used = [Remembered::EMPTY; 3];
        let limits = Limits::default();
        let mut kept = Scratch::<Plain<S>, 16, 256>::new();
        for line in 0..200 {
            let mut base = [direction(&mut random, 0.0).map(|c| 3.0 * c), [0.0; 3]];
            base[1] = core::array::from_fn(|k| random.within(-0.4, 0.4) - base[0][k]);
            let mut fresh = [Remembered::EMPTY; 3];
            for step in 0..5 {
                let ray = [base[0], base[1].map(|c| c + 0.01 * f64::from(step))];
                let one = trace(&clean, &mut fresh, line, ray, &limits);
                let two = trace(&clean, &mut used, line, ray, &limits);
                assert_eq!(one, two);
                let scene = clean.scene();
                let ray = scene.ray(ray[0].map(S::from_f64), ray[1].map(S::from_f64)).unwrap();
                let (interval, mut work) = (Interval::ahead(), Work::default());
                let (patches, tree) = (clean.patches(), clean.tree());
                let view = &mut kept.view();
                let found = newton::closest(&scene, &patches, &tree, &ray, &interval, &limits, view, &mut work);
                assert_eq!((found, work), one.unwrap()[0]);
            }
        }
    }
    check::<f32>();
    check::<f64>();
}

/// Any bits in slots: answers may be anything, but every call ends within its budgets, and none panics.
#[test]
fn views_over_rubbish_neither_panic_nor_run_on() {
    fn check<S: Scalar>(seed: u64) -> [u32; 3] {
        let mut random = Random(seed);
        let models = [small_model(), teapot::model().unwrap()];
        let donors: Vec<_> = models.iter().map(Prepared::<Plain<S>>::coarse).collect();
        let mut kinds = [0; 3];
        for round in 0..6000 {
            let mut target = Prepared::<Plain<S>> { ..copy(&donors[round % 2]) };
            let donor = &donors[(round / 2) % 2];
            // Each kind of slot: left alone, shuffled, from the other scene, cut short, or, for numbers, of random bits.
            spoil(&mut random, &mut target.points, &donor.points);
            if index(&mut random, 4) == 0 {
                let bad = bad_points();
                for _ in 0..5 {
                    let at = index(&mut random, target.points.len().max(1));
                    if let Some(point) = target.points.get_mut(at) {
                        *point = bad[index(&mut random, bad.len())];
                    }
                }
            }
            spoil(&mut random, &mut target.surfaces, &donor.surfaces);
            spoil(&mut random, &mut target.patches, &donor.patches);
            spoil(&mut random, &mut target.nodes, &donor.nodes);
            spoil(&mut random, &mut target.grids, &donor.grids);
            for (slots, others) in [
                (&mut target.offsets, &donor.offsets),
                (&mut target.references, &donor.references),
                (&mut target.first, &donor.first),
                (&mut target.links, &donor.links),
                (&mut target.grid_offsets, &donor.grid_offsets),
                (&mut target.grid_references, &donor.grid_references),
            ] {
                spoil(&mut random, slots, others);
                spoil_numbers(&mut random, slots);
            }
            if index(&mut random, 4) == 0 {
                target.header = donor.header;
            }
            let limits = Limits::<S> {
                surfaces: 50,
                nodes: 300,
                patches: 300,
                voxels: 200,
                newton_steps: 500,
                acceptance: if round % 3 == 0 { Acceptance::Proved } else { Acceptance::Paper },
                ..Default::default()
            };
            // Coherence memory filled by rays of another scene, or too short.
            let mut memory = vec![Remembered::EMPTY; 40];
            let eye = random.point(4.0);
            for _ in 0..4 {
                let at = random.point(0.8);
                let ray = [eye, core::array::from_fn(|k| at[k] - eye[k])];
                let _ = trace(donor, &mut memory, round as u32, ray, &limits);
                let slots = if index(&mut random, 10) == 0 { 1 } else { 40 };
                let Some(answers) = trace(&target, &mut memory[..slots], round as u32, ray, &limits) else { continue };
                // With memory: the search that it led, and the one without.
                for ((answer, work), searches) in answers.into_iter().zip(1..) {
                    let counts = [work.surfaces_tested, work.nodes_visited, work.patches_tested];
                    assert!(counts.into_iter().zip([50, 300, 300]).all(|(count, budget)| count <= searches * budget));
                    assert!(work.voxels_visited <= searches * 200 && work.newton_steps <= searches * 500);
                    kinds[match answer {
                        Ok(None) => 0,
                        Ok(Some(_)) => 1,
                        Err(_) => 2,
                    }] += 1;
                    if let Ok(Some(hit)) = answer {
                        let _ = target.scene().normal(&hit, &mut Basis::<S, 16>::new().view());
                    }
                    let _ = (target.scene().surfaces().count(), target.grids().longest_walks());
                }
            }
        }
        kinds
    }
    for kinds in [check::<f32>(101), check::<f64>(102)] {
        println!("misses, hits, gave up: {kinds:?}");
        assert!(kinds.iter().all(|&n| n > 1000), "{kinds:?}");
    }
}

fn copy<P: Point>(p: &Prepared<P>) -> Prepared<P> {
    Prepared {
        header: p.header,
        points: p.points.clone(),
        surfaces: p.surfaces.clone(),
        offsets: p.offsets.clone(),
        references: p.references.clone(),
        patches: p.patches.clone(),
        first: p.first.clone(),
        nodes: p.nodes.clone(),
        links: p.links.clone(),
        grids: p.grids.clone(),
        grid_offsets: p.grid_offsets.clone(),
        grid_references: p.grid_references.clone(),
    }
}

/// Mostly nothing; else slots exchanged, taken from elsewhere, or cut off.
fn spoil<T: Copy>(random: &mut Random, slots: &mut Vec<T>, others: &[T]) {
    if slots.is_empty() {
        return;
    }
    match index(random, 32) {
        0 => (0..slots.len()).for_each(|k| slots.swap(k, index(random, k + 1))),
        1 => litter(slots, &others[index(random, others.len())..]),
        2 => slots.truncate(index(random, slots.len())),
        3 => {
            for _ in 0..4 {
                let at = index(random, slots.len());
                slots[at] = others[index(random, others.len())];
            }
        }
        _ => {}
    }
}

/// Mostly nothing; else random bits, here and there or everywhere.
fn spoil_numbers(random: &mut Random, slots: &mut [u32]) {
    if slots.is_empty() {
        return;
    }
    let bits = |random: &mut Random| (random.within(0.0, 4_294_967_296.0) as u32) >> index(random, 32);
    match index(random, 24) {
        0 => slots.iter_mut().for_each(|slot| *slot = bits(random)),
        1 | 2 => {
            for _ in 0..4 {
                let at = index(random, slots.len());
                slots[at] = bits(random);
            }
        }
        3 => slots.fill(u32::MAX),
        4 => slots.fill(0),
        _ => {}
    }
}

/// Memory that holds fewer surfaces than the scene is told apart from a ray that hits nothing.
#[test]
fn slots_that_are_missing_are_named() {
    let model = small_model();
    let prepared = Prepared::<Plain<f64>>::of(&model);
    let ray = [[0.1, 0.05, 4.0], [0.0, 0.0, -1.0]];
    let limits = Limits::default();
    let limit = |answer: &Answer<f64>| answer.as_ref().err().map(|gave_up| gave_up.limit);
    let mut full = vec![Remembered::EMPTY; 3];
    let [(plain, _), (coherent, _)] = trace(&prepared, &mut full, 0, ray, &limits).unwrap();
    assert!(plain.unwrap().is_some() && coherent.unwrap().is_some());
    let [_, (coherent, _)] = trace(&prepared, &mut [], 0, ray, &limits).unwrap();
    assert_eq!(limit(&coherent), Some(Limit::Memory));
    for cut in 0..4 {
        let mut short = copy(&prepared);
        match cut {
            0 => short.first.truncate(1),
            1 => short.patches.clear(),
            2 => (short.links.clear(), short.grids.clear()).0,
            _ => short.points.clear(),
        }
        let [(plain, _), (coherent, _)] = trace(&short, &mut full, 1 + cut, ray, &limits).unwrap();
        assert_eq!((limit(&plain), limit(&coherent)), (Some(Limit::Slot), Some(Limit::Slot)), "{cut}");
    }
    let tree = Tree::new(&prepared.nodes, &prepared.links[..3]);
    assert!(tree.of_surface(&prepared.patches(), 0).is_none());
    let mut scratch = Scratch::<Plain<f64>, 3, 16>::new();
    let scene = prepared.scene();
    let ray = scene.ray([0.05, 1.0, 4.0], [0.0, 0.0, -1.0]).unwrap();
    let (patches, tree) = (prepared.patches(), prepared.tree());
    let (interval, mut work) = (Interval::ahead(), Work::default());
    let view = &mut scratch.view();
    let answer = newton::closest(&scene, &patches, &tree, &ray, &interval, &limits, view, &mut work);
    assert_eq!(limit(&answer), Some(Limit::Scratch));
}

/// Clipping needs a scene and its scratch, no patches, trees or grids; and what another surface left in the scratch, of whatever
/// degrees and whether it gave up there, changes no bit of answer or work.
#[test]
fn what_is_left_in_clipping_scratch_changes_nothing() {
    fn check<P: Kind>(models: &[Model]) {
        let built: Vec<_> = models.iter().map(|model| Built::<P>::new(model, 1.0)).collect();
        let mut used = ClipScratch::<P, 16, 256, 64>::new();
        let mut random = Random(103);
        let mut hits = 0;
        for _ in 0..2000 {
            let built = &built[index(&mut random, models.len())];
            let (eye, to) = (direction(&mut random, 0.0).map(|c| 5.0 * c), random.point(0.7));
            let d: [f64; 3] = core::array::from_fn(|k| to[k] - eye[k]);
            let scene = built.scene();
            let ray = scene.ray(eye.map(P::Scalar::from_f64), d.map(P::Scalar::from_f64)).unwrap();
            let (interval, mut limits) = (Interval::ahead(), Limits::default());
            if index(&mut random, 3) == 0 {
                limits.clip_steps = index(&mut random, 8) as u32;
            }
            let mut fresh = ClipScratch::<P, 16, 256, 64>::new();
            let trace = |scratch: &mut ClipScratch<P, 16, 256, 64>| {
                let (mut first, mut second) = (Work::default(), Work::default());
                let mut list = heapless::Vec::<_, 32>::new();
                let room = &mut scratch.view();
                let closest = clipping::closest(&scene, &ray, &interval, &limits, room, &mut first);
                let all = clipping::all_hits(&scene, &ray, &interval, &limits, room, &mut list, &mut second);
                (closest, all, list, first, second)
            };
            let answer = trace(&mut used);
            hits += u32::from(answer.0.is_ok_and(|hit| hit.is_some()));
            assert_eq!(answer, trace(&mut fresh));
        }
        assert!(hits > 500, "{hits}");
    }
    let bumpy = |seed, degrees| Model::numbered(vec![bumpy(seed, degrees, [0.0; 3], 2.5, 0.6)]);
    let models = [small_model(), bumpy(4, [15, 15]), bumpy(5, [1, 1]), bumpy(6, [2, 12]), teapot::model().unwrap()];
    check::<Plain<f32>>(&models);
    check::<Plain<f64>>(&models);
    check::<Weighted<f64>>(&[sphere([0.0; 3], 1.0), bumpy(7, [4, 3])]);
}
