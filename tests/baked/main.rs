//! Tables that `patchray bake` wrote: they are what was prepared, to the bit, and compile into what is traced alike.

use std::path::Path;

use patchray::frame::Frame;
use patchray::grid::GridSlot;
use patchray::limits::{Limits, Work};
use patchray::method::{Followed, Remembered, Scratch, newton_coherent};
use patchray::patch::{Parallelepiped, Patch};
use patchray::point::{Plain, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::scene::{SceneHeader, SurfaceSlot};
use patchray::span::Span;
use patchray::view::Sight;
use patchray_host::lower::{FromFile, Lowered, Preparation, Stages};
use patchray_host::method::Views;
use patchray_host::prepared::Prepared;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::model::Model;
use patchray_host::scene::trace::{Method, Precision};
use patchray_host::scene::{patches, teapot};
use patchray_host::settings::{Flags, Settings};

// As it was written. A program of one crate exports nothing.
#[rustfmt::skip]
#[allow(unreachable_pub)]
mod hill;

/// The command that wrote `hill.rs`, but for the name of the output, from the repository's folder:
/// `patchray bake fixtures/patches/hill.bpt --method newton-coherent --precision f32 --flatness 0.02 --rust`.
const SETTINGS: (Method, Precision, f64) = (Method::NewtonCoherent, Precision::F32, 0.02);

fn fixture(name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/patches").join(name);
    patches::read(&path, OnInvalid::Refuse).expect("valid").model
}

fn prepared() -> Prepared {
    let (method, precision, flatness) = SETTINGS;
    let flags = Flags { flatness: Some(flatness), precision: Some(precision), ..Flags::default() };
    Prepared::build(&fixture("hill.bpt"), Stages::of(method), &Settings::of_flags(&flags)).expect("it fits")
}

/// Whether two values are the same to the bit, the sign of zero included.
fn same(a: &impl std::fmt::Debug, b: &impl std::fmt::Debug) {
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
}

fn slots_say_what_they_hold<P: FromFile>(model: &Model) {
    let lowered = Lowered::<P>::build(model, Stages::ALL, &Preparation::default()).expect("it fits");
    let slots = lowered.slots();
    for slot in slots.surfaces {
        let (lengths, numbers) = slot.numbers();
        same(slot, &SurfaceSlot::from_numbers(lengths, numbers));
    }
    for slot in slots.patches {
        let (bounds, stray, numbers) = slot.numbers();
        same(slot, &Patch::from_numbers(bounds, stray, numbers));
    }
    for slot in slots.nodes {
        same(slot, &Parallelepiped::from_numbers(slot.numbers()));
    }
    for slot in slots.grids {
        let (lengths, numbers) = slot.numbers();
        same(slot, &GridSlot::from_numbers(lengths, numbers));
    }
    let header = lowered.scene().header();
    let (scales, corners, sizes, exponent) = header.frame().numbers();
    let frame = Frame::from_numbers(scales, corners, sizes, exponent);
    same(&header, &SceneHeader::new(frame, *header.grid()));
    assert!(slots.patches.len() > 100 && slots.nodes.len() > 100 && slots.grids.len() > 1);
}

#[test]
fn every_slot_is_made_again_from_its_numbers() {
    let (teapot, nurbs) = (teapot::model().expect("valid"), fixture("nurbs.json"));
    slots_say_what_they_hold::<Plain<f32>>(&teapot);
    slots_say_what_they_hold::<Plain<f64>>(&teapot);
    slots_say_what_they_hold::<Weighted<f32>>(&nurbs);
    slots_say_what_they_hold::<Weighted<f64>>(&nurbs);
    let point = Weighted::new([1.0, -0.0, 3.0], 0.5);
    same(&point, &Weighted::from_numbers(point.numbers()));
}

/// Numbers that tell all places apart: what is given first comes out first, and lies first in memory.
#[test]
fn numbers_keep_their_places() {
    let reals = |from: u32| std::array::from_fn(|k| f32::from_u32(from + k as u32));
    let lengths = [reals(0), reals(3), reals(6), reals(9), reals(12)];
    let slot = SurfaceSlot::from_numbers(lengths, [15, 16, 17]);
    assert_eq!(slot.numbers(), (lengths, [15, 16, 17]));
    let bounds = [0, 4, 8].map(|from| std::array::from_fn(|k| f64::from(from + k as u32)));
    let patch = Patch::from_numbers(bounds, 12.0, [0x8001_7fff, 0xfffe_0001]);
    assert_eq!(patch.numbers(), (bounds, 12.0, [0x8001_7fff, 0xfffe_0001]));
    assert_eq!([size_of::<Patch<f32>>(), size_of::<Patch<f64>>()], [13 * 4 + 8, 13 * 8 + 8]);
    assert_eq!([size_of::<SurfaceSlot<f32>>(), size_of::<SurfaceSlot<f64>>()], [18 * 4, 15 * 8 + 16]);
    assert_eq!([size_of::<GridSlot<f32>>(), size_of::<GridSlot<f64>>()], [17 * 4, 12 * 8 + 24]);
}

/// A static of slots that are not zeros would take flash besides RAM: once a view's memory took a megabyte of it.
#[test]
fn empty_slots_are_zeros() {
    let (span, sight) = (Span::<f32>::EMPTY, Sight::<f32>::EMPTY);
    let (patch, surface) = (Patch::<f32>::EMPTY, SurfaceSlot::<f32>::EMPTY);
    let (grid, remembered, followed) = (GridSlot::<f32>::EMPTY, Remembered::<f32>::EMPTY, Followed::<f32>::EMPTY);
    let shown = format!("{span:?} {sight:?} {patch:?} {surface:?} {grid:?} {remembered:?} {followed:?}");
    let fields = shown.split(|letter: char| !(letter.is_alphanumeric() || "-.+_".contains(letter)));
    let numbers: Vec<f64> = fields.filter_map(|field| field.parse().ok()).collect();
    assert!(numbers.len() == 90 && numbers.iter().all(|number| number.to_bits() == 0), "{shown}");
}

#[test]
fn the_committed_tables_are_what_bake_writes() {
    let mut text = Vec::new();
    prepared().baked(SETTINGS.0).write_rust("hill.bpt", &mut text).expect("memory takes it");
    let text = String::from_utf8(text).expect("text");
    assert!(
        text == include_str!("hill.rs"),
        "if that is meant, bake again and raise LAYOUT where a number's meaning changed"
    );
}

#[test]
fn baked_tables_are_traced_like_prepared_ones() {
    let Prepared::PlainF32(lowered) = prepared() else { panic!("a polynomial model in f32") };
    assert_eq!(hill::BYTES as u64, lowered.bytes(Stages::of(SETTINGS.0)).total());
    assert_eq!([hill::ORDER, hill::NET, hill::COUNT], [4, 16, 1]);
    same(&hill::scene(), &lowered.scene());
    same(&hill::patches(), &lowered.patches());
    same(&hill::grids(), &lowered.grids());
    let (scene, limits, interval) = (hill::scene(), Limits::default(), Interval::ahead());
    let mut scratch = Scratch::<Plain<f32>, { hill::ORDER }, { hill::NET }>::new();
    let made = Views::of(&lowered);
    let baked = Views { scene, patches: hill::patches(), grids: hill::grids(), ..made };
    let mut hits = 0;
    for line in 0..32_u32 {
        let mut memory = [[Remembered::EMPTY; hill::COUNT]; 2];
        for column in 0..32 {
            let ray = scene.ray([3.0, -5.0, 4.0], [column as f32 / 8.0 - 5.0, line as f32 / 8.0 + 3.0, -3.5]);
            let ray = ray.expect("valid");
            let mut trace = |of: &Views<'_, Plain<f32>>, memory: &mut [Remembered<f32>]| {
                let Views { scene, patches, grids, .. } = of;
                let mut work = Work::default();
                let mut scratch = scratch.view();
                let hit = newton_coherent::closest(
                    scene,
                    patches,
                    grids,
                    memory,
                    line,
                    &ray,
                    &interval,
                    &limits,
                    &mut scratch,
                    &mut work,
                );
                (hit, work)
            };
            let answer = trace(&baked, &mut memory[0]);
            same(&answer, &trace(&made, &mut memory[1]));
            hits += u32::from(matches!(answer.0, Ok(Some(_))));
        }
    }
    assert!(hits > 200, "{hits}");
}
