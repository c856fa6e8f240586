use super::*;

fn built(boxes: &[Aabb<f64>], density: f64, most: u32) -> (GridSlot<f64>, [u32; 600], [u32; 600], [usize; 2]) {
    let (mut offsets, mut references) = ([0; 600], [0; 600]);
    let (mut a, mut b) = (Arena::new(&mut offsets[..]), Arena::new(&mut references[..]));
    let slot = GridSlot::build(boxes.len(), |k| boxes[k], density, most, &mut a, &mut b).unwrap();
    let needed = [a.need(), b.need()].map(|need| {
        assert!(need.met());
        need.needed
    });
    (slot, offsets, references, needed)
}

/// Each item stands in all voxels of its block and in no other, and its bits name the neighbours that hold it too.
#[test]
fn items_stand_where_their_boxes_are() {
    let at = |low: [f64; 3], high: [f64; 3]| Aabb { low, high };
    let boxes = [at([0.0; 3], [1.0; 3]), at([0.1; 3], [0.2; 3]), at([0.0, 0.4, 0.9], [1.0, 0.6, 0.9])];
    let (slot, offsets, references, [_, total]) = built(&boxes, 20.0, 1000);
    let [x, y, z] = slot.counts;
    assert!(x * y * z >= 20 && x * y * z <= 60, "{:?}", slot.counts);
    let mut seen = 0;
    for voxel in 0..(x * y * z) {
        let here = [voxel % x, voxel / x % y, voxel / (x * y)];
        let [begin, end] = [0, 1].map(|next| (offsets[voxel as usize + next] & OFFSET_MASK) as usize);
        let items = &references[begin..end];
        seen += items.len();
        for (number, item) in boxes.iter().enumerate() {
            let [low, high] = slot.block(item);
            let holds = |at: [u32; 3]| (0..3).all(|k| low[k] <= at[k] && at[k] <= high[k]);
            let reference = items.iter().find(|&&r| (r & ITEM_MASK) as usize == number);
            assert_eq!(reference.is_some(), holds(here));
            let Some(reference) = reference else { continue };
            for side in 0..6 {
                let mut next = here;
                next[side / 2] = if side % 2 == 0 { here[side / 2].wrapping_sub(1) } else { here[side / 2] + 1 };
                assert_eq!(reference >> (ITEM_BITS + side as u32) & 1 == 1, holds(next), "{here:?} {side}");
            }
        }
    }
    assert_eq!(seen, total);
}

/// A line is given up in a voxel exactly if no voxel holds anything from there on in its octant.
#[test]
fn octants_are_marked_where_they_hold_nothing() {
    let at = |low: [f64; 3]| Aabb { low, high: low.map(|c| c + 0.1) };
    let boxes = [at([0.1, 0.2, 0.0]), at([0.8, 0.3, 0.9]), at([0.4, 0.9, 0.5])];
    let (slot, offsets, ..) = built(&boxes, 40.0, 1000);
    let [x, y, z] = slot.counts;
    let place = |voxel: u32| [voxel % x, voxel / x % y, voxel / (x * y)];
    let holds = |voxel: u32| {
        let [begin, end] = [voxel, voxel + 1].map(|k| offsets[k as usize] & OFFSET_MASK);
        begin < end
    };
    let mut marked = 0;
    for voxel in 0..x * y * z {
        for octant in 0..8 {
            let ahead = |other: &u32| {
                (0..3).all(|k| {
                    let (from, to) = (place(voxel)[k], place(*other)[k]);
                    if octant >> k & 1 == 1 { to >= from } else { to <= from }
                })
            };
            let empty = !(0..x * y * z).filter(ahead).any(holds);
            assert_eq!(
                offsets[voxel as usize] >> (OFFSET_BITS + octant) & 1 == 1,
                empty,
                "{:?} {octant}",
                place(voxel)
            );
            marked += u32::from(empty);
        }
    }
    assert!(marked > x * y * z && marked < 8 * x * y * z, "{marked}");
}

#[test]
fn shapes_follow_the_box_and_keep_their_bounds() {
    assert_eq!(shape(&[1.0, 1.0, 1.0], 16, 4.0, 1000), [4; 3]);
    assert_eq!(shape(&[1.0, 1.0, 0.0], 16, 4.0, 1000), [8, 8, 1]);
    assert_eq!(shape(&[0.0_f64; 3], 16, 4.0, 1000), [1; 3]);
    assert_eq!(shape(&[f64::NAN; 3], 16, 4.0, 1000), [1; 3]);
    assert_eq!(shape(&[1.0; 3], 16, f64::NAN, 1000), [1; 3]);
    assert_eq!(shape(&[1.0; 3], 0, 4.0, 1000), [1; 3]);
    for sides in [[1.0, 0.5, 0.25], [1e-3, 1.0, 1e-6], [0.7, 0.0, 0.0]] {
        for (density, most) in [(1.0, 50), (4.0, 64), (100.0, 5000), (1e30, 1 << 20), (4.0, 1), (4.0, 0)] {
            let counts = shape(&sides, 100, density, most);
            assert!(counts.iter().all(|&n| (1..=MAX_ALONG_AXIS).contains(&n)));
            assert!(counts.iter().product::<u32>() <= most.max(1), "{sides:?} {density} {most}: {counts:?}");
        }
    }
}

#[test]
fn slots_that_do_not_hold_a_grid_are_none() {
    let (mut slot, offsets, references, [needed, _]) = built(&[Aabb { low: [0.0; 3], high: [1.0; 3] }], 8.0, 100);
    assert!(Grid::new(&slot, &offsets[..needed], &references).is_some());
    assert!(Grid::new(&slot, &offsets[..needed - 1], &references).is_none());
    slot.first = u32::MAX;
    assert!(Grid::new(&slot, &offsets, &references).is_none());
    slot.counts = [u32::MAX; 3];
    assert!(Grid::new(&slot, &offsets, &references).is_none());
}

#[test]
fn a_slot_that_was_never_filled_is_no_grid_but_one_over_nothing_is() {
    assert!(Grid::new(&GridSlot::<f32>::EMPTY, &[0; 4], &[]).is_none());
    let mut offsets = [7; 2];
    let (mut filled, mut none) = (Arena::new(&mut offsets), Arena::new(&mut []));
    let slot = GridSlot::build(0, |_| Aabb::EMPTY, 4.0_f32, 100, &mut filled, &mut none).unwrap();
    assert!(Grid::new(&slot, filled.finish(), &[]).is_some());
}

/// Patches of a net whose weights differ by 1e9 have boxes as large as the surface: each lay in most voxels, and the grid was
/// refused for its references.
#[test]
fn items_as_large_as_the_grid_make_it_coarse_but_never_too_large() {
    let item = Aabb { low: [0.0; 3], high: [1.0; 3] };
    let count = 5_000;
    let (mut offsets, mut references) = (Arena::new(&mut []), Arena::new(&mut []));
    let slot = GridSlot::build(count, |_| item, 3.0, 1 << 22, &mut offsets, &mut references).unwrap();
    let voxels = slot.counts.iter().product::<u32>() as usize;
    assert_eq!(references.need().needed, count * voxels);
    assert!(count * voxels <= MAX_REFERENCES && 8 * count * voxels > MAX_REFERENCES, "{voxels}");
    assert_eq!(offsets.need().needed, voxels + 1);
    let too_many = GridSlot::build(MAX_REFERENCES + 1, |_| item, 3.0, 1, &mut offsets, &mut references);
    assert_eq!(too_many, Err(TooLarge));
}
