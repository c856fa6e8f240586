extern crate std;

use super::*;
use crate::frame::Frame;
use crate::method::{Following, Scratch, newton_predicted};
use crate::patch::Patches;
use crate::point::Plain;
use crate::ray::Interval;
use crate::scene::{Scene, SceneError, SceneMemory, SceneOptions, SurfaceSlot};
use crate::subdivide::{PatchMemory, SubdivideError, SubdivideScratch, Subdivision, subdivide};
use crate::surface::Net;
use crate::view::{Camera, ViewError, ViewMemory};
use std::vec;
use std::vec::Vec;

/// Numbers in [−1, 1] that only look random: a multiplicative congruential generator (Lehmer, modulus 2³¹ − 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0 * 48271 % 0x7fff_ffff;
        self.0 as f64 / f64::from(0x4000_0000) - 1.0
    }
}

/// Views of crumpled bicubic surfaces, from outside and from among them.
fn with_views(mut with: impl FnMut(&View<'_, Plain<f64>>, &[Patch<f64>])) {
    let mut numbers = Numbers(1);
    let points: Vec<Vec<Plain<f64>>> = (0..5)
        .map(|_| {
            let centre: [f64; 3] = core::array::from_fn(|_| numbers.next());
            (0..16).map(|_| Plain(centre.map(|c| c + numbers.next() * 0.6))).collect()
        })
        .collect();
    let nets: Vec<Net<'_, _>> = points.iter().map(|points| Net::new(3, 3, points).unwrap()).collect();
    let options = SceneOptions::default();
    let nothing = SceneMemory { points: &mut [], surfaces: &mut [], offsets: &mut [], references: &mut [] };
    let Err(SceneError::Memory(needs)) = Scene::build(&nets, &options, nothing) else { panic!() };
    let (mut points, mut surfaces) = (vec![Plain::EMPTY; needs.points.needed], vec![SurfaceSlot::EMPTY; 5]);
    let (mut offsets, mut references) = (vec![0; needs.offsets.needed], vec![0; needs.references.needed]);
    let memory = SceneMemory {
        points: &mut points,
        surfaces: &mut surfaces,
        offsets: &mut offsets,
        references: &mut references,
    };
    let scene = Scene::build(&nets, &options, memory).unwrap();
    let frame: &Frame<f64> = scene.frame();
    let options = Subdivision { flatness: 0.002, ..Subdivision::default() };
    let mut scratch = SubdivideScratch::<_, 16>::new();
    let nothing = PatchMemory { patches: &mut [], first: &mut [] };
    let Err(SubdivideError::Memory(needs)) =
        subdivide(scene.surfaces(), frame, &options, &mut scratch.view(), nothing, None)
    else {
        panic!()
    };
    let (mut patches, mut first) = (vec![Patch::EMPTY; needs.patches.needed], vec![0; needs.first.needed]);
    let memory = PatchMemory { patches: &mut patches, first: &mut first };
    let (patches, _): (Patches<'_, f64>, _) =
        subdivide(scene.surfaces(), frame, &options, &mut scratch.view(), memory, None).unwrap();
    let outside =
        Camera { eye: [4.0, 3.0, 2.0], forward: [-4.0, -3.0, -2.0], right: [-1.5, 2.0, 0.0], up: [-0.4, -0.2, 1.9] };
    let inside =
        Camera { eye: [0.1, -0.3, 0.2], forward: [1.0, 0.3, -0.2], right: [0.2, -0.9, 0.1], up: [0.2, 0.1, 0.8] };
    for camera in [outside, inside] {
        let nothing = ViewMemory {
            points: &mut [],
            surfaces: &mut [],
            patches: &mut [],
            sights: &mut [],
            runs: &mut [],
            first_runs: &mut [],
        };
        let Err(ViewError::Memory(needs)) = View::build(&scene, &patches, &camera, nothing) else { panic!() };
        let mut points = vec![Plain::EMPTY; needs.points.needed];
        let (mut surfaces, mut sights) = (vec![[0.0; 2]; 5], vec![Sight::EMPTY; needs.sights.needed]);
        let mut turned = vec![Patch::EMPTY; needs.patches.needed];
        let (mut runs, mut first_runs) = (vec![[0.0; 2]; needs.runs.needed], vec![0; needs.first_runs.needed]);
        let memory = ViewMemory {
            points: &mut points,
            surfaces: &mut surfaces,
            patches: &mut turned,
            sights: &mut sights,
            runs: &mut runs,
            first_runs: &mut first_runs,
        };
        let view = View::build(&scene, &patches, &camera, memory).unwrap();
        with(&view, patches.all());
    }
}

/// Slots for a line, full of rubbish.
struct Room {
    spans: Vec<Span<f64>>,
    active: Vec<u32>,
    buckets: Vec<u32>,
}

impl Room {
    fn new(spans: usize, buckets: usize) -> Self {
        let rubbish = Span { next: 7, surface: 9, ..Span::EMPTY };
        Room { spans: vec![rubbish; spans], active: vec![77; spans], buckets: vec![5; buckets] }
    }

    fn lend(&mut self) -> LineMemory<'_, f64> {
        LineMemory { spans: &mut self.spans, active: &mut self.active, buckets: &mut self.buckets }
    }
}

const WHOLE: [f64; 2] = [-1.0, 1.0];

/// The patches that a line leads a ray to: by number in the view.
fn met(view: &View<'_, Plain<f64>>, line: &mut Line<'_, f64>, place: [f64; 2]) -> Vec<usize> {
    let (limits, mut work) = (Limits::default(), Work::default());
    let ray = view.ray(place, &Interval::ahead()).unwrap();
    let Some(nearby) = line.nearby(view.patches(), &ray, &limits, &mut work).unwrap() else {
        return Vec::new();
    };
    let (mut met, facing) = (Vec::new(), view.facing(&ray));
    nearby
        .visit(
            &facing.planes,
            facing.range.max,
            &limits,
            &mut work,
            |_, _| false,
            |_, patch, _, _| {
                met.push(view.patches().iter().position(|other| core::ptr::eq(other, patch)).unwrap());
                Ok(f64::INFINITY)
            },
        )
        .unwrap();
    met
}

/// Of all patches those whose boxes the ray meets, anywhere before the eye.
fn met_by_force(view: &View<'_, Plain<f64>>, place: [f64; 2]) -> Vec<usize> {
    let ray = view.facing(&view.ray(place, &Interval::ahead()).unwrap());
    let meets = |(_, patch): &(usize, &Patch<f64>)| {
        let crossing = patch.bounds().crossing(&ray.planes);
        crossing.is_some_and(|crossing| crossing.pierces().is_none_or(|ends| ends[1].depth >= ray.range.min))
    };
    view.patches().iter().enumerate().filter(meets).map(|(k, _)| k).collect()
}

#[test]
fn a_line_leads_to_every_patch_that_brute_force_meets() {
    let mut all = 0;
    with_views(|view, patches| {
        let mut numbers = Numbers(2);
        for buckets in [1, 2, 7, 30, 100, 300] {
            let mut room = Room::new(patches.len(), buckets);
            // A row, and a band of jittered rows.
            let y = numbers.next() * 0.4;
            for band in [0.0, 0.01] {
                let window = Window { x: WHOLE, y: [y - band, y + band] };
                let mut line = Line::build(view, window, room.lend()).unwrap();
                for k in 0..200 {
                    let place = [f64::from(k) * 0.01 - 1.0, y + band * numbers.next()];
                    let mut found = met(view, &mut line, place);
                    let mut expected = met_by_force(view, place);
                    found.sort_unstable();
                    found.dedup();
                    // What the line leads to in vain, behind the eye, is not held against it.
                    expected.retain(|k| found.binary_search(k).is_err());
                    assert_eq!(expected, [0; 0], "{place:?}");
                    all += found.len();
                }
            }
        }
    });
    assert!(all > 400, "{all}");
}

#[test]
fn rays_in_any_order_are_led_to_the_same_patches_in_the_same_order() {
    with_views(|view, patches| {
        let (mut room, mut numbers) = (Room::new(patches.len(), 50), Numbers(3));
        let window = Window { x: WHOLE, y: [0.1, 0.1] };
        let mut line = Line::build(view, window, room.lend()).unwrap();
        let xs: Vec<f64> = (0..200).map(|_| numbers.next()).collect();
        let jumping: Vec<Vec<usize>> = xs.iter().map(|&x| met(view, &mut line, [x, 0.1])).collect();
        for (&x, there) in xs.iter().zip(&jumping) {
            let mut fresh = Room::new(patches.len(), 50);
            let mut line = Line::build(view, window, fresh.lend()).unwrap();
            assert_eq!(&met(view, &mut line, [x, 0.1]), there);
        }
    });
}

#[test]
fn too_little_room_is_told_and_a_ray_of_another_line_is_no_miss() {
    let mut tried = 0;
    with_views(|view, patches| {
        let window = Window { x: WHOLE, y: [-0.3, 0.3] };
        let needs = Line::build(view, window, Room::new(0, 0).lend()).unwrap_err();
        assert!(needs.spans.needed <= patches.len());
        if needs.spans.needed == 0 {
            return;
        }
        tried += 1;
        assert_eq!((needs.active.needed, needs.buckets.needed), (needs.spans.needed, 1));
        let mut room = Room::new(needs.spans.needed, 1);
        let mut line = Line::build(view, window, room.lend()).unwrap();
        let (limits, mut work) = (Limits::default(), Work::default());
        for place in [[0.0, 0.31], [0.0, -0.4]] {
            let ray = view.ray(place, &Interval::ahead()).unwrap();
            let nearby = line.nearby(view.patches(), &ray, &limits, &mut work);
            assert_eq!(nearby.err(), Some(Limit::Line));
        }
        let mut short = Room::new(needs.spans.needed, 1);
        short.active.pop();
        assert!(Line::build(view, window, short.lend()).is_err());
        // Out of its budget, and after that as if nothing had been.
        let ray = view.ray([0.01, 0.0], &Interval::ahead()).unwrap();
        let (budget, mut work) = (Limits { spans: 0, ..limits }, Work::default());
        assert_eq!(line.nearby(view.patches(), &ray, &budget, &mut work).err(), Some(Limit::Spans));
        assert_eq!(work.spans_visited, 0);
        assert_eq!(met(view, &mut line, [0.01, 0.0]).len(), {
            let mut fresh = Room::new(patches.len(), 1);
            let mut line = Line::build(view, window, fresh.lend()).unwrap();
            met(view, &mut line, [0.01, 0.0]).len()
        });
    });
    assert!(tried > 0);
}

/// A caller who reads the counts of a whole line at its end must not have its budgets run out with the rays before.
#[test]
fn budgets_are_of_one_ray_though_the_counts_go_on() {
    with_views(|view, patches| {
        let window = Window { x: WHOLE, y: [0.0, 0.0] };
        let mut room = Room::new(patches.len(), 1);
        let mut line = Line::build(view, window, room.lend()).unwrap();
        // Beyond all patches, so that each around the ray is tested and nothing is found.
        let ray = view.ray([0.01, 0.0], &Interval::new(1e6, f64::INFINITY).unwrap()).unwrap();
        let mut scratch = Scratch::<_, 4, 16>::new();
        let mut ask = |limits: &Limits<f64>, work: &mut Work| {
            let memory = &mut Following { slots: &mut [], last: u32::MAX };
            newton_predicted::closest_in_view(view, &mut line, memory, 0, &ray, limits, &mut scratch.view(), work)
        };
        let mut once = Work::default();
        assert_eq!(ask(&Limits::default(), &mut once), Ok(None));
        let mut again = Work::default();
        assert_eq!(ask(&Limits::default(), &mut again), Ok(None));
        if again.patches_tested == 0 {
            return;
        }
        let enough = Limits { spans: again.spans_visited, patches: again.patches_tested, ..Limits::default() };
        for _ in 0..3 {
            assert_eq!(ask(&enough, &mut again), Ok(None));
        }
        let short = Limits { patches: enough.patches - 1, ..enough };
        assert_eq!(ask(&short, &mut again).map_err(|gave_up| gave_up.limit), Err(Limit::Patches));
    });
}
