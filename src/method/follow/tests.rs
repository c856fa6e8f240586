use super::*;
use crate::parameter::Number;
use crate::ray::Incidence;

/// u and v as functions of x and y, with their derivatives per unit of x and of y.
type Motion = fn(f64, f64) -> ([f64; 2], [[f64; 2]; 2]);

fn quadratic(x: f64, y: f64) -> ([f64; 2], [[f64; 2]; 2]) {
    let at =
        [0.2 + 0.5 * x - 0.3 * y + 2.0 * x * x + 1.5 * x * y - y * y, 0.7 - x + 0.25 * y - x * x + 0.5 * x * y + y * y];
    let per_x = [0.5 + 4.0 * x + 1.5 * y, -1.0 - 2.0 * x + 0.5 * y];
    let per_y = [-0.3 + 1.5 * x - 2.0 * y, 0.25 + 0.5 * x + 2.0 * y];
    (at, [per_x, per_y])
}

fn cubic(x: f64, _: f64) -> ([f64; 2], [[f64; 2]; 2]) {
    let at = [0.5 + x * (1.0 + x * (2.0 - 3.0 * x)), x * x * x];
    (at, [[1.0 + x * (4.0 - 9.0 * x), 3.0 * x * x], [0.0; 2]])
}

fn keep(memory: &mut Followed<f64>, motion: Motion, place: [f64; 2], stamp: u32) {
    let (at, rates) = motion(place[0], place[1]);
    memory.go_on(at, Some(rates), place, stamp);
}

fn error(memory: &Followed<f64>, motion: Motion, place: [f64; 2], stamp: u32) -> f64 {
    let (expected, _) = motion(place[0], place[1]);
    let predicted = memory.predict(place, stamp).unwrap();
    (predicted[0] - expected[0]).abs() + (predicted[1] - expected[1]).abs()
}

#[test]
fn along_a_row_the_prediction_is_the_cubic_through_two_rays_however_long_the_steps() {
    let mut memory = Followed::EMPTY;
    for x in [0.0, 0.01] {
        keep(&mut memory, cubic, [x, 0.0], 3);
    }
    for x in [0.02, 0.013, 0.05] {
        assert!(error(&memory, cubic, [x, 0.0], 3) < 1e-13, "{}", error(&memory, cubic, [x, 0.0], 3));
    }
}

/// Without second derivatives across the row every jittered ray would be predicted as badly as if only the last point were
/// known: half a pixel off.
#[test]
fn jittered_rays_teach_the_second_derivatives_of_both_directions() {
    let mut memory = Followed::EMPTY;
    let places = [
        [0.0, 0.002],
        [0.011, -0.004],
        [0.018, 0.003],
        [0.031, 0.001],
        [0.039, -0.002],
        [0.052, 0.004],
        [0.06, -0.003],
    ];
    for place in places {
        keep(&mut memory, quadratic, place, 1);
    }
    assert!(error(&memory, quadratic, [0.071, 0.003], 1) < 1e-6, "{}", error(&memory, quadratic, [0.071, 0.003], 1));
    let bare = quadratic(0.071, 0.003).0[0] - quadratic(0.06, -0.003).0[0];
    assert!(bare.abs() > 5e-3);
}

#[test]
fn another_line_is_not_remembered_and_an_unknown_rate_predicts_the_last_point() {
    let mut memory = Followed::EMPTY;
    assert_eq!(memory.predict([0.0; 2], 0), None);
    keep(&mut memory, quadratic, [0.0, 0.0], 5);
    assert_eq!(memory.predict([0.0; 2], 4), None);
    keep(&mut memory, quadratic, [0.1, 0.0], 6);
    // Nothing of line 5 is left in it.
    assert!(error(&memory, quadratic, [0.1, 0.0], 6) < 1e-15 && memory.bends == [[0.0; 2]; 3]);
    memory.go_on([0.3, 0.4], None, [0.2, 0.0], 6);
    assert_eq!(memory.predict([0.3, 0.1], 6), Some([0.3, 0.4]));
}

/// Of two surfaces that coincide rounding once chose the one that is named, from ray to ray.
#[test]
fn a_claim_is_contested_by_another_surface_at_its_depth() {
    let root =
        |depth| Root { u: Number::new(0.5), v: Number::new(0.5), depth, incidence: Incidence::Crossing, turned: false };
    let exact = Exactness { tolerance: 2e-15, rounding: 4e-15, size: 1.0, reach: 1.0 };
    let allowed = exact.allowed();
    let claim = Claim::of(&root(0.25), 3, &exact);
    let contested = |depth, surface| claim.is_contested_by(&root(depth), surface);
    assert!(contested(0.25 + 2.0 * allowed, 2) && contested(0.25 - 2.0 * allowed, 4));
    // Its own surface found once more, and what lies apart.
    assert!(!contested(0.25, 3) && !contested(0.25 + 1e-9, 2) && !contested(0.1, 2));
    // It is looked for behind the root too.
    let best = Best { root: root(0.25), surface: 3, kept: true };
    assert!(claim.up_to(Some(&best)) > 0.25 + 2.0 * allowed);
}
