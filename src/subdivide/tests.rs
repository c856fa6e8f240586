use super::*;
use crate::frame::Aabb;
use crate::point::Plain;
use crate::reading::{Ours, Switches};
use crate::surface::{Net, Shape};

fn measure(bend_u: f64, bend_v: f64, sides: [f64; 2]) -> Measure<f64> {
    let points = [[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.5, 0.5, 0.0]].map(Plain);
    let mut measure = Measure::of(&Net::new(1, 1, &points).unwrap(), 0.0);
    (measure.bend_u, measure.bend_v, measure.sides) = (bend_u, bend_v, sides);
    measure
}

#[test]
fn the_more_bent_direction_is_halved_and_the_longer_of_straight_ones() {
    assert_eq!(direction_to_halve(Ours, &measure(2.0, 1.0, [1.0, 9.0]), [0, 0], 3), Some(true));
    assert_eq!(direction_to_halve(Ours, &measure(1.0, 2.0, [9.0, 1.0]), [0, 0], 3), Some(false));
    assert_eq!(direction_to_halve(Ours, &measure(0.0, 0.0, [1.0, 2.0]), [0, 0], 3), Some(false));
    assert_eq!(direction_to_halve(Ours, &measure(0.0, 0.0, [2.0, 1.0]), [0, 0], 3), Some(true));
    // At its depth a direction leaves it to the other; at both there is nothing more to do.
    assert_eq!(direction_to_halve(Ours, &measure(2.0, 1.0, [1.0; 2]), [3, 0], 3), Some(false));
    assert_eq!(direction_to_halve(Ours, &measure(1.0, 2.0, [1.0; 2]), [0, 3], 3), Some(true));
    assert_eq!(direction_to_halve(Ours, &measure(1.0, 2.0, [1.0; 2]), [3, 3], 3), None);
}

/// Of two directions that are bent alike the shorter one turns more.
#[test]
fn without_the_bend_the_direction_that_turns_more_is_halved() {
    let turning = Switches { bend_halving: false, ..Switches::ours() };
    let more_bent = measure(2.0, 1.0, [9.0, 1.0]);
    assert_eq!(direction_to_halve(Ours, &more_bent, [0, 0], 3), Some(true));
    assert_eq!(direction_to_halve(turning, &more_bent, [0, 0], 3), Some(false));
}

/// A saddle has no bend in u nor in v, only twist: it is halved all the same.
#[test]
fn a_saddle_is_halved_until_its_twist_is_flat() {
    // One is so low that the flatness alone decides, one as high as it is long.
    let saddle = |height| [[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.5, 0.5, height]].map(Plain);
    let [low, high] = [0.03125, 0.5].map(saddle);
    let frame = Frame::new(Aabb { low: [0.0; 3], high: [0.5; 3] });
    let mut patches = [Patch::EMPTY; 64];
    let mut first = [0; 2];
    let mut scratch = SubdivideScratch::<Plain<f64>, 4>::new();
    let twist =
        |points: &[_], flatness, patches: &mut [_], first: &mut [u32], view: &mut SubdivideScratchView<'_, _>| {
            let net = Net::new(1, 1, points).unwrap();
            let surface = Surface { number: 0, net, shape: Shape::of(&net) };
            let options = Subdivision { flatness, ..Default::default() };
            let memory = PatchMemory { patches, first };
            let (patches, tree) = subdivide([surface].into_iter(), &frame, &options, view, memory, None).unwrap();
            assert!(tree.is_none());
            patches.all().len()
        };
    // A quarter of the height at the corners; a halving in each direction leaves a quarter of that.
    let diagonal = frame.diagonal();
    assert_eq!(twist(&low, 0.1251 / 16.0 / diagonal, &mut patches, &mut first, &mut scratch.view()), 1);
    assert_eq!(twist(&low, 0.1249 / 16.0 / diagonal, &mut patches, &mut first, &mut scratch.view()), 2);
    assert_eq!(twist(&low, 0.0313 / 16.0 / diagonal, &mut patches, &mut first, &mut scratch.view()), 4);
    assert_eq!(twist(&low, 0.0079 / 16.0 / diagonal, &mut patches, &mut first, &mut scratch.view()), 16);
    assert_eq!(first, [0, 16]);
    // However coarse the flatness: 1/32 of a side of 1/2 is three halvings below 1/8.
    assert_eq!(twist(&high, 1.0, &mut patches, &mut first, &mut scratch.view()), 8);
}

#[test]
fn surfaces_beyond_the_memory_are_not_there() {
    let slots = [Patch::<f32>::EMPTY; 3];
    let patches = Patches::new(&slots, &[0, 2, 3]);
    assert_eq!(patches.of_surface(0).map(<[_]>::len), Some(2));
    assert_eq!(patches.of_surface(1).map(<[_]>::len), Some(1));
    assert!(patches.of_surface(2).is_none());
    // Ends before begins, and ends beyond the slots.
    assert!(Patches::new(&slots, &[2, 0]).of_surface(0).is_none());
    assert!(Patches::new(&slots, &[0, 4]).of_surface(0).is_none());
    assert!(Patches::new(&slots, &[]).of_surface(0).is_none());
}
