use clap::ValueEnum;
use patchray::point::{Plain, Weighted};

use super::*;
use crate::memory::Kind;
use crate::scene::shapes::{bilinear, parallelogram, single, torus};
use crate::scene::teapot;

#[test]
fn bytes_are_sizes_times_slots() {
    let model = teapot::model().expect("the fixture is valid");
    let lowered = Lowered::<Plain<f64>>::build(&model, Stages::ALL, &Preparation::default()).expect("built");
    let patches = lowered.patches().all().len() as u64;
    let bytes = lowered.bytes(Stages::ALL);
    assert_eq!(bytes.of(Kind::Points), 32 * 16 * 24);
    assert_eq!(bytes.of(Kind::PatchRanges), 33 * 4);
    assert_eq!(bytes.of(Kind::Patches), patches * size_of::<Patch<f64>>() as u64);
    assert_eq!(bytes.of(Kind::TreeLinks), (2 * patches - 32) * 4);
    let newton = lowered.bytes(Stages::of(Method::Newton));
    assert_eq!((newton.of(Kind::GridVoxels), newton.of(Kind::TreeLinks)), (0, bytes.of(Kind::TreeLinks)));

    // A method's own stages alone take what its part of all stages takes.
    for &method in Method::value_variants() {
        let stages = Stages::of(method);
        let alone = Lowered::<Plain<f64>>::build(&model, stages, &Preparation::default()).expect("built");
        assert_eq!(alone.bytes(Stages::ALL).total(), lowered.bytes(stages).total());
    }
}

#[test]
fn a_bound_on_bytes_is_met_exactly_or_refused() {
    let model = torus([0.0; 3], 3.0, 1.0, 4, 4);
    let build = |arena_bytes| {
        let mut preparation = Preparation { arena_bytes, ..Preparation::<f32>::default() };
        preparation.subdivision.flatness = 0.01;
        Lowered::<Weighted<f32>>::build(&model, Stages::of(Method::NewtonCoherent), &preparation)
    };
    let needed = build(u64::MAX).expect("there is memory").bytes(Stages::of(Method::NewtonCoherent)).total();
    assert!(build(needed).is_ok());
    for given in [needed - 1, 0] {
        match build(given) {
            Err(LowerError::Arena { needed: asked, given: told, .. }) => {
                assert!(asked <= needed && asked > given && told == given);
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn what_f32_cannot_hold_is_named() {
    let corners = |size: f64| [[0.0; 3], [0.0, size, 0.0], [size, 0.0, 0.0], [size, size, 1.0]];
    let build = |size| {
        let model = single(bilinear(corners(size)));
        (
            Lowered::<Plain<f32>>::build(&model, Stages::ALL, &Preparation::default()).err(),
            unfit::<Plain<f32>>(&model).len(),
            unfit::<Plain<f64>>(&model).len(),
        )
    };
    assert!(matches!(build(1e6), (None, 0, 0)));
    assert!(matches!(build(1e39), (Some(LowerError::Surface { index: 0, number: 0, .. }), 1, 0)));
    let mut tiny = single(bilinear(corners(1e-50)));
    tiny.surfaces[0].points[3][2] = 0.0;
    let error = Lowered::<Plain<f32>>::build(&tiny, Stages::ALL, &Preparation::default()).expect_err("it vanishes");
    assert!(matches!(error, LowerError::Vanishes { .. }), "{error}");
    assert!(Lowered::<Plain<f64>>::build(&tiny, Stages::ALL, &Preparation::default()).is_ok());

    let mut light = torus([0.0; 3], 3.0, 1.0, 3, 3);
    light.surfaces[4].points[0][3] = 1e-60;
    assert_eq!(unfit::<Weighted<f32>>(&light).iter().map(|(index, _)| *index).collect::<Vec<_>>(), [4]);
}

#[test]
fn no_surfaces_make_an_empty_scene() {
    let lowered = Lowered::<Plain<f32>>::build(&Model::default(), Stages::ALL, &Preparation::default());
    let lowered = lowered.expect("nothing is needed");
    assert!(lowered.scene().is_empty());
    assert!(lowered.patches().all().is_empty());
}

#[test]
fn small_surfaces_have_origins_of_their_own_at_any_scale() {
    let sheet = |low: f64, side: f64| parallelogram([low, low, 0.0], [side, 0.0, 0.0], [0.0, side, 0.0]);
    for scale in [1e-30, 1.0, 1e30, 1.5e38] {
        // The largest is as wide as no `f32` tells.
        let model = Model::numbered([sheet(-scale, 2.0 * scale), sheet(0.5 * scale, 0.25 * scale)].into());
        let small = Model::numbered([model.surfaces.clone(), vec![sheet(0.5 * scale, 1e-3 * scale)]].concat());
        for (model, moved) in [(model, vec![]), (small, vec![2])] {
            let origins = Origins::<f32>::of(&model, true).own;
            let of = (0..origins.len()).filter(|&k| origins[k] != [0.0; 3]).collect::<Vec<_>>();
            assert_eq!(of, moved, "{scale:e}");
            let lowered = Lowered::<Plain<f32>>::build(&model, Stages::NONE, &Preparation::default());
            assert!(lowered.is_ok(), "{scale:e}: {:?}", lowered.err());
        }
    }
}

#[test]
fn a_surface_that_vanishes_beside_another_is_named() {
    let sheet = |side: f64| parallelogram([0.0; 3], [side, 0.0, 0.0], [0.0, side, 0.0]);
    let model = Model::numbered([sheet(1e17), sheet(1e-30), sheet(1.0)].into());
    let error = Lowered::<Plain<f32>>::build(&model, Stages::NONE, &Preparation::default()).err();
    assert!(matches!(error, Some(LowerError::Surface { index: 1, .. })), "{error:?}");
    assert!(Lowered::<Plain<f64>>::build(&model, Stages::NONE, &Preparation::default()).is_ok());
}
