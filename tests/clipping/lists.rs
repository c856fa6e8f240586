//! Lists of hits: too short ones, cut ones, the first hit that comes, and what Newton's method finds of them.

use crate::ask::{MANY, Query, Room, ask, limit};
use crate::common::{Built, Kind, Prepared, direction, norm};
use patchray::limits::{GaveUp, Limit, Limits, Work};
use patchray::method::{Scratch, clipping, newton};
use patchray::point::Plain;
use patchray::ray::Hit;
use patchray::scalar::Scalar;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::roots::{grid_of_roots, product, spread};
use patchray_host::scene::shapes::{Random, bumpy, net, single};
use patchray_host::scene::teapot;

/// What `all_hits` says, and what its list holds.
type Listed<S> = (Result<(), GaveUp<S>>, Vec<Hit<S>>);

/// With a list of this capacity.
fn with_room_for<const N: usize, P: Kind>(built: &Built<P>, query: &Query) -> Listed<P::Scalar> {
    let scene = built.scene();
    let (origin, d) = (query.origin.map(P::Scalar::from_f64), query.direction.map(P::Scalar::from_f64));
    let ray = scene.ray(origin, d).unwrap();
    let (mut list, mut room, mut work) = (heapless::Vec::<_, N>::new(), Room::<P>::new(), Work::default());
    let limits = Limits::default();
    let ended = clipping::all_hits(&scene, &ray, &query.interval(), &limits, &mut room.view(), &mut list, &mut work);
    (ended, list.to_vec())
}

/// Rays through the teapot, and the model.
fn teapot_rays(count: usize) -> (Model, Vec<Query>) {
    let mut random = Random(61);
    let rays = (0..count).map(|_| {
        let (at, d) = (random.point(1.5), direction(&mut random, 1.0));
        let by = 6.0 / norm(d);
        Query::new(core::array::from_fn(|k| at[k] - by * d[k] + if k == 2 { 1.5 } else { 0.0 }), d).exact()
    });
    (teapot::model().unwrap(), rays.collect())
}

fn short_lists<P: Kind>(model: &Model, queries: &[Query]) -> u32 {
    let built = Built::<P>::new(model, 1.0);
    let mut room = Room::<P>::new();
    let mut overflowed = 0;
    for query in queries {
        let all = ask(&built, query, &Limits::default(), &mut room);
        assert_eq!(all.all, Ok(()));
        let hits = &all.hits;
        let shorter = [
            (0, with_room_for::<0, P>(&built, query)),
            (1, with_room_for::<1, P>(&built, query)),
            (2, with_room_for::<2, P>(&built, query)),
            (3, with_room_for::<3, P>(&built, query)),
            (24, with_room_for::<24, P>(&built, query)),
            (25, with_room_for::<25, P>(&built, query)),
            (MANY, with_room_for::<MANY, P>(&built, query)),
        ];
        for (capacity, (ended, held)) in shorter {
            assert_eq!(held, hits[..hits.len().min(capacity)], "{capacity} {query:?}");
            let best = held.first().copied();
            let full = Err(GaveUp { limit: Limit::Hits, best });
            assert_eq!(ended, if hits.len() > capacity { full } else { Ok(()) }, "{capacity} {query:?}");
            overflowed += u32::from(ended.is_err());
        }
    }
    overflowed
}

#[test]
fn a_list_that_is_too_short_holds_the_closest() {
    let five = spread(5);
    let many = single(grid_of_roots(&five, &five, 5, 5));
    let through: Vec<_> = [1.0, -1.0].map(|side| Query::new([0.0, 0.0, -2.0 * side], [0.0, 0.0, side])).to_vec();
    assert_eq!(short_lists::<Plain<f64>>(&many, &through), 10);
    let (model, queries) = teapot_rays(500);
    assert!(short_lists::<Plain<f64>>(&model, &queries) > 500);
    assert!(short_lists::<Plain<f32>>(&model, &queries) > 500);
}

/// The hits of a part of the ray are the ray's hits in that part.
#[test]
fn the_range_of_t_cuts_the_list() {
    fn check<P: Kind>(model: &Model, queries: &[Query]) {
        let built = Built::<P>::new(model, 1.0);
        let mut room = Room::<P>::new();
        let mut cuts = 0;
        for query in queries {
            let whole = Query { range: [f64::NEG_INFINITY, f64::INFINITY], ..*query };
            let all = ask(&built, &whole, &Limits::default(), &mut room);
            let t: Vec<_> = all.hits.iter().map(|hit| hit.t.to_f64()).collect();
            let speed = norm(query.direction);
            for (i, pair) in t.windows(2).enumerate().filter(|(_, pair)| (pair[1] - pair[0]) * speed > 1e-3) {
                let middle = 0.5 * (pair[0] + pair[1]);
                for (range, hits) in [([middle, f64::INFINITY], &all.hits[i + 1..]), ([-1e3, middle], &all.hits[..=i])]
                {
                    let part = ask(&built, &Query { range, ..*query }, &Limits::default(), &mut room);
                    assert_eq!((part.all, part.hits.len()), (Ok(()), hits.len()), "{query:?} {range:?}");
                    for (part, hit) in part.hits.iter().zip(hits) {
                        // The ray's origin is moved to where the range begins, so bits differ.
                        let off = 1e4 * P::Scalar::EPSILON.to_f64();
                        assert!((part.t - hit.t).to_f64().abs() * speed < off, "{part:?} {hit:?}");
                    }
                    cuts += 1;
                }
                // Empty between two hits.
                let gap = [0.75 * pair[0] + 0.25 * pair[1], middle];
                let none = ask(&built, &Query { range: gap, ..*query }, &Limits::default(), &mut room);
                assert_eq!((none.all, none.hits.len()), (Ok(()), 0), "{query:?} {gap:?}");
            }
        }
        assert!(cuts > 100);
    }
    let (model, queries) = teapot_rays(500);
    check::<Plain<f64>>(&model, &queries);
    let five = spread(5);
    let through: Vec<_> = [-8.0, 0.0, 0.5].map(|z| Query::new([0.0, 0.0, z], [0.0, 0.0, 1.0])).to_vec();
    check::<Plain<f64>>(&single(grid_of_roots(&five, &five, 5, 5)), &through);
}

/// A sheet that is folded onto itself is met at one point by each of its layers: hits of one t, up to rounding. The layer at u = 1/2,
/// where halves adjoin, is found from both, and what stands for it takes no other layer along.
#[test]
fn layers_that_are_met_at_one_t_are_all_listed() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
    {
        let (mut random, mut room) = (Random(23), Room::new());
        for _ in 0..3000 {
            let layers = 2 + random.bits() as usize % 4;
            let others = spread(layers - 1).into_iter().map(|u| 0.9 * u - 0.02);
            let c = product(&others.chain([0.5]).collect::<Vec<_>>());
            let (s, z) = (random.within(0.05, 0.95), [(); 3].map(|()| random.within(-1.0, 1.0)));
            let model = single(net(layers, 2, |i, j| [c[i], j as f64 / 2.0 - s, z[j]]));
            let built = Built::<Plain<S>>::new(&model, 1.0);
            let query = Query::new([0.0, 0.0, 3.0], [0.0, 0.0, -1.0]);
            let all = ask(&built, &query, &Limits::default(), &mut room);
            assert_eq!((all.all, all.hits.len()), (Ok(()), layers), "{:?} {c:?} {s} {z:?}", all.hits);
        }
    }
    check::<f64>();
    check::<f32>();
}

/// Surfaces that lie over one another share their voxels: those that are left there when the first hit is found cost no
/// budget that could run out on it.
#[test]
fn any_hit_is_an_answer_as_soon_as_it_is_found() {
    let model = Model::numbered(vec![bumpy(62, [3, 3], [0.0; 3], 2.0, 0.2); 5]);
    let built = Built::<Plain<f64>>::new(&model, 1.0);
    let scene = built.scene();
    let ray = scene.ray([0.1, 0.2, 4.0], [0.0, 0.0, -1.0]).unwrap();
    let query = Query::new([0.1, 0.2, 4.0], [0.0, 0.0, -1.0]);
    let limits = Limits { surfaces: 1, ..Default::default() };
    let (mut room, mut work) = (Room::new(), Work::default());
    let any = clipping::any_hit(&scene, &ray, &query.interval(), &limits, &mut room.view(), &mut work);
    assert!(any.is_ok_and(|hit| hit.is_some()), "{any:?}");
    let answers = clipping::closest(&scene, &ray, &query.interval(), &limits, &mut room.view(), &mut work);
    assert_eq!(limit(&answers), Some(Limit::Surfaces));
}

#[test]
fn newton_finds_nothing_that_clipping_does_not() {
    fn check<S: Scalar>()
    where
        Plain<S>: Kind<Scalar = S>,
    {
        let (model, queries) = teapot_rays(3000);
        let prepared = Prepared::<Plain<S>>::of(&model);
        let built = Built::<Plain<S>>::new(&model, 1.0);
        let (scene, patches, tree) = (prepared.scene(), prepared.patches(), prepared.tree());
        let limits = Limits::default();
        let (mut room, mut scratch) = (Room::new(), Scratch::<_, 16, 256>::new());
        let (mut found, mut of) = (0, 0);
        for query in &queries {
            let all = ask(&built, query, &limits, &mut room);
            assert_eq!(all.all, Ok(()));
            let ray = scene.ray(query.origin.map(S::from_f64), query.direction.map(S::from_f64)).unwrap();
            let (interval, mut work) = (query.interval(), Work::default());
            let mut list = heapless::Vec::<_, MANY>::new();
            let view = &mut scratch.view();
            let ended = newton::all_hits(&scene, &patches, &tree, &ray, &interval, &limits, view, &mut list, &mut work);
            assert_eq!(ended, Ok(()));
            assert_eq!(work.intersection_points as usize, list.len());
            assert_eq!((work.clip_steps, work.bisections), (0, 0));
            // Roots closer to a graze than the tolerance tells are one to the one and two to the other.
            let near = limits.tolerance.sqrt().to_f64() * 8.0;
            let same = |a: &Hit<S>, b: &Hit<S>| {
                a.surface == b.surface && (a.t - b.t).to_f64().abs() * norm(query.direction) < near
            };
            for hit in &list {
                assert!(all.hits.iter().any(|other| same(hit, other)), "{hit:?} {query:?} {:?}", all.hits);
            }
            let any = newton::any_hit(&scene, &patches, &tree, &ray, &interval, &limits, view, &mut work).unwrap();
            assert_eq!(any.is_some(), !list.is_empty());
            assert!(any.is_none_or(|any| list.iter().any(|hit| same(hit, &any))), "{any:?} {query:?}");
            (found, of) = (found + list.len(), of + all.hits.len());
        }
        println!("newton finds {found} of {of}");
        assert!(of > 3000 && found <= of && found * 1000 >= of * 998);
    }
    check::<f64>();
    check::<f32>();
}
