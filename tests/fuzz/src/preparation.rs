//! Each preparation in lent memory of any size: what asking says is enough, and less is said, with all that is missing.

use crate::bytes::Bytes;
use crate::common::Kind;
use crate::input::{Case, OfKind, any_subdivision, in_kernel, number, with_kind};
use crate::ready::{GridRoom, PatchRoom, SceneRoom, Stage, VOXELS, ask_and_fill, nets, points};
use crate::rooms::{LineRoom, ViewRoom, slots};
use patchray::arena::Need;
use patchray::grid::GridOptions;
use patchray::line::{Line, LineMemory, LineNeeds, Window};
use patchray::scene::SceneOptions;
use patchray::view::{View, ViewError};

pub(crate) fn check(bytes: &[u8]) {
    let mut bytes = Bytes::new(bytes);
    let case = Case::any(&mut bytes, 4);
    with_kind(&case, bytes, Preparation);
}

struct Preparation;

/// Lends a preparation memory of any sizes, and last what it asks for; says whether it is not refused.
pub(crate) fn lend<const N: usize>(bytes: &mut Bytes<'_>, mut build: impl FnMut([usize; N]) -> Stage<N>) -> bool {
    let needed = ask_and_fill(&mut build);
    for _ in 0..1 + bytes.below(2) {
        let sizes: [usize; N] = std::array::from_fn(|k| {
            let needed = needed.map_or(0, |needed| needed[k]);
            match bytes.below(4) {
                0 => needed,
                1 => needed + bytes.below(8),
                2 => needed.saturating_sub(1 + bytes.below(4)),
                _ => usize::from(bytes.byte()),
            }
        });
        let expected = match needed {
            None => Stage::Refused,
            Some(needed) if (0..N).all(|k| needed[k] <= sizes[k]) => Stage::Done,
            Some(needed) => Stage::Lacks(std::array::from_fn(|k| Need { needed: needed[k], given: sizes[k] })),
        };
        assert_eq!(build(sizes), expected, "{needed:?} needed, {sizes:?} given");
    }
    needed.is_some_and(|needed| build(needed) == Stage::Done)
}

impl OfKind for Preparation {
    fn run<P: Kind>(self, case: &Case, mut bytes: Bytes<'_>) {
        let points = points::<P>(&case.model);
        let nets = nets(&case.model, &points);
        let mut scene_options = SceneOptions { voxels: VOXELS, ..SceneOptions::default() };
        if bytes.rarely(4) {
            scene_options.voxels = bytes.count().min(VOXELS);
        }
        if bytes.rarely(4) {
            scene_options.density = number(&mut bytes);
        }
        if bytes.rarely(4) {
            scene_options.origin = [0; 3].map(|_| number(&mut bytes));
        }
        let origins: Vec<_> =
            nets.iter().map_while(|_| bytes.rarely(4).then(|| [0; 3].map(|_| number(&mut bytes)))).collect();
        let mut room =
            SceneRoom { points: vec![], surfaces: vec![], offsets: vec![], references: vec![], header: None };
        if !lend(&mut bytes, |sizes| room.build(&nets, &origins, &scene_options, sizes)) {
            return;
        }
        let scene = room.scene().expect("it was built");
        let options = any_subdivision(&mut bytes);
        let with_tree = !bytes.rarely(4);
        let mut cut = PatchRoom { patches: vec![], first: vec![], nodes: vec![], links: vec![] };
        let subdivided = if with_tree {
            lend(&mut bytes, |sizes| cut.build(&scene, &options, true, sizes))
        } else {
            lend(&mut bytes, |[patches, first]| match cut.build(&scene, &options, false, [patches, first, 0, 0]) {
                Stage::Lacks([patches, first, ..]) => Stage::Lacks([patches, first]),
                Stage::Done => Stage::Done,
                Stage::Refused => Stage::Refused,
            })
        };
        if !subdivided {
            return;
        }
        let mut grid_options = GridOptions { voxels: VOXELS, ..GridOptions::default() };
        if bytes.rarely(4) {
            grid_options.voxels = bytes.count().min(VOXELS);
        }
        if bytes.rarely(4) {
            grid_options.density = number(&mut bytes);
        }
        let patches = cut.patches();
        // Of another number of surfaces than there are, it is the caller who is wrong, and is told.
        let surfaces = if bytes.rarely(8) { bytes.below(8) } else { scene.len() };
        let mut over = GridRoom { grids: vec![], offsets: vec![], references: vec![] };
        lend(&mut bytes, |sizes| over.build(surfaces, &patches, &grid_options, sizes));

        let camera = in_kernel::<P::Scalar>(&case.camera(&mut bytes));
        let mut of_view = ViewRoom::<P>::sized([0; 6]);
        let seen = lend(&mut bytes, |sizes| {
            of_view = ViewRoom::sized(sizes);
            match View::build(&scene, &patches, &camera, of_view.lend()) {
                Ok(_) => Stage::Done,
                Err(ViewError::Memory(needs)) => {
                    let given =
                        [needs.points, needs.surfaces, needs.patches, needs.sights, needs.runs, needs.first_runs];
                    assert_eq!(slots(&needs), given.map(|need| need.needed));
                    Stage::Lacks(given)
                }
                Err(_) => Stage::Refused,
            }
        });
        let Some(view) =
            seen.then(|| View::build(&scene, &patches, &camera, of_view.lend()).expect("it was built before"))
        else {
            return;
        };
        let mut end = || number::<P::Scalar>(&mut bytes);
        let window = Window { x: [end(), end()], y: [end(), end()] };
        lend(&mut bytes, |[spans, active, buckets]| {
            let (mut room, mut others) = (LineRoom::sized(spans, buckets), vec![7; active]);
            let memory = LineMemory { active: &mut others, ..room.lend() };
            match Line::build(&view, window, memory) {
                Ok(_) => Stage::Done,
                Err(LineNeeds { spans, active, buckets }) => Stage::Lacks([spans, active, buckets]),
            }
        });
    }
}
