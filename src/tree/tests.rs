use super::*;
use crate::frame::{Aabb, Frame};
use crate::ray::Interval;

fn planes() -> Planes<f64> {
    let frame = Frame::new(Aabb { low: [-0.5; 3], high: [0.5; 3] });
    let ray = frame.ray([0.0, 0.0, -2.0], [0.0, 0.0, 1.0]).unwrap();
    frame.enter(&ray, &Interval::ahead()).unwrap().0
}

/// A box of no size is met by any line, so a tree of such has all its leaves met.
#[test]
fn budgets_stop_a_descent_where_they_say_and_it_can_go_on() {
    let (nodes, patches) = ([Parallelepiped::EMPTY; 3], [Patch::EMPTY; 4]);
    let (links, first) = ([4, 2, 1, 1, 2, 1, 1], [0, 4]);
    let (patches, tree) = (Patches::new(&patches, &first), Tree::new(&nodes, &links));
    let (limits, mut work) = (Limits { patches: 3, ..Limits::default() }, Work::default());
    let mut descent = tree.of_surface(&patches, 0).unwrap();
    for n in 1..=3 {
        assert!(descent.next_patch(&planes(), &limits, &mut work).unwrap().is_some());
        assert_eq!(work.patches_tested, n);
    }
    assert!(matches!(descent.next_patch(&planes(), &limits, &mut work), Err(Limit::Patches)));
    assert_eq!((work.patches_tested, work.nodes_visited), (3, 3));
    assert!(descent.next_patch(&planes(), &Limits::default(), &mut work).unwrap().is_some());
    assert!(descent.next_patch(&planes(), &Limits::default(), &mut work).unwrap().is_none());
    let few = Limits { nodes: 1, ..Limits::default() };
    let mut work = Work::default();
    let mut descent = tree.of_surface(&patches, 0).unwrap();
    assert!(matches!(descent.next_patch(&planes(), &few, &mut work), Err(Limit::Nodes)));
    assert_eq!(work.nodes_visited, 1);
    // What another surface of the same ray used counts too.
    let mut descent = tree.of_surface(&patches, 0).unwrap();
    assert!(matches!(descent.next_patch(&planes(), &few, &mut work), Err(Limit::Nodes)));
    assert_eq!((work.nodes_visited, work.patches_tested), (1, 0));
}

#[test]
fn links_that_lie_are_named_and_end() {
    let (nodes, patches, first) = ([Parallelepiped::EMPTY; 1], [Patch::EMPTY; 2], [0, 2]);
    let patches = Patches::new(&patches, &first);
    let limits = Limits::<f64>::default();
    for links in [[0, 1, 1], [3, 3, 1], [u32::MAX, u32::MAX, 1], [1, 1, 1]] {
        let tree = Tree::new(&nodes, &links);
        let mut descent = tree.of_surface(&patches, 0).unwrap();
        let mut work = Work::default();
        let end = loop {
            match descent.next_patch(&planes(), &limits, &mut work) {
                Ok(Some(_)) => {}
                other => break other.map(|_| ()),
            }
        };
        assert_eq!(end, Err(Limit::Slot), "{links:?}");
    }
    assert!(Tree::new(&nodes, &[2, 1]).of_surface(&patches, 0).is_none());
    assert!(Tree::new(&nodes, &[2, 1, 1]).of_surface(&patches, 1).is_none());
    assert!(Tree::<f64>::new(&[], &[]).of_surface(&Patches::new(&[], &[0, 0]), 0).is_none());
}
