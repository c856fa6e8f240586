//! B-splines against their pieces: the same points, the same edges to the bit, the same hits; memory as counted; and the
//! points that geomdl finds.

#[path = "../common/mod.rs"]
mod common;
mod geomdl;
mod reference;

use common::allowances::PIECE_PER_DEGREE;
use common::{Kind, Prepared, index};
use patchray::arena::Need;
use patchray::bernstein::MAX_DEGREE;
use patchray::bspline::BSpline;
use patchray::limits::{Limits, Work};
use patchray::method::{Scratch, newton};
use patchray::pieces::{Part, Piece, PieceError, PieceMemory, PieceNeeds, Pieces};
use patchray::point::{Plain, Point, Weighted};
use patchray::ray::Interval;
use patchray::scalar::Scalar;
use patchray::surface::Direction;
use patchray_host::scene::model::Model;
use patchray_host::scene::shapes::Random;
use patchray_host::scene::spline::Spline;
use reference::{bezier, blend, exact};

/// How knots follow one another.
#[derive(Clone, Copy, Debug)]
enum Spacing {
    /// Lengths of like size.
    Even,
    /// Lengths from 1 to 1e9.
    Uneven,
    /// Some as short as the number type can tell them apart.
    Noisy,
}

/// Knots of a degree: so many spans, a clamped end or not, knots repeated up to as often as the degree.
fn knots<S: Scalar>(random: &mut Random, degree: usize, spacing: Spacing) -> Vec<S> {
    let mut knots: Vec<S> = Vec::new();
    let mut at = S::from_f64(random.within(-3.0, 3.0));
    let run = |knots: &mut Vec<S>, random: &mut Random, most: usize, at: &mut S| {
        let count = match index(random, 3) {
            0 => most,
            1 => 1,
            _ => 1 + index(random, most),
        };
        knots.extend(std::iter::repeat_n(*at, count));
        let far = at.abs().greater(S::ONE) * S::EPSILON * S::TWO;
        *at += match spacing {
            Spacing::Even => S::from_f64(random.within(0.2, 1.0)),
            Spacing::Uneven => S::from_f64(10.0_f64.powf(random.within(0.0, 9.0))),
            Spacing::Noisy if index(random, 2) == 0 => far,
            Spacing::Noisy => S::from_f64(random.within(0.2, 1.0)),
        };
    };
    let end = |knots: &mut Vec<S>, random: &mut Random, at: &mut S| {
        let enough = knots.len() + degree + 1;
        if index(random, 2) == 0 {
            knots.extend(std::iter::repeat_n(*at, degree + 1));
            *at += S::ONE;
        }
        // Ends as each run adds a knot.
        while knots.len() < enough {
            let most = degree.min(enough - knots.len());
            run(knots, random, most, at);
        }
    };
    end(&mut knots, random, &mut at);
    for _ in 0..index(random, 4) {
        run(&mut knots, random, degree, &mut at);
    }
    end(&mut knots, random, &mut at);
    knots
}

/// A B-spline in memory of its own.
struct Owned<P: Point> {
    degrees: [usize; 2],
    knots: [Vec<P::Scalar>; 2],
    points: Vec<P>,
}

impl<P: Kind> Owned<P> {
    fn random(random: &mut Random, degrees: [usize; 2], spacing: Spacing) -> Self {
        // Ends as soon as rounding leaves the domain a length, which it nearly always does.
        loop {
            let knots = degrees.map(|degree| knots::<P::Scalar>(random, degree, spacing));
            let [rows, columns] = [0, 1].map(|k| knots[k].len() - degrees[k] - 1);
            let point = |_| {
                let [x, y, z] = random.point(1.0);
                P::lower(&[x, y, z, 10.0_f64.powf(random.within(-2.0, 2.0))], 1.0)
            };
            let owned = Owned { degrees, knots, points: (0..rows * columns).map(point).collect() };
            let [u, v] = &owned.knots;
            if BSpline::new(degrees[0], degrees[1], u, v, &owned.points).is_ok() {
                return owned;
            }
        }
    }

    fn view(&self) -> BSpline<'_, P> {
        let ([n, m], [u, v]) = (self.degrees, &self.knots);
        BSpline::new(n, m, u, v, &self.points).expect("valid")
    }
}

/// Memory for pieces, of exactly the size that counting asks for.
struct Cut<P: Point> {
    points: Vec<P>,
    pieces: Vec<Piece<P::Scalar>>,
}

fn needs<P: Point>(splines: &[BSpline<'_, P>]) -> PieceNeeds {
    match Pieces::build(splines, PieceMemory { points: &mut [], pieces: &mut [] }) {
        Err(PieceError::Memory(needs)) => needs,
        other => panic!("{other:?}"),
    }
}

impl<P: Point> Cut<P> {
    fn of(splines: &[BSpline<'_, P>]) -> Self {
        let needs = needs(splines);
        let mut points = vec![P::EMPTY; needs.points.needed];
        let mut pieces = vec![Piece::EMPTY; needs.pieces.needed];
        Pieces::build(splines, PieceMemory { points: &mut points, pieces: &mut pieces }).expect("as counted");
        Cut { points, pieces }
    }

    fn view(&self) -> Pieces<'_, P> {
        Pieces::new(&self.points, &self.pieces)
    }
}

/// A part in `f64`.
fn widened<S: Scalar>(part: &Part<S>) -> Part<f64> {
    Part { u: part.u.map(Scalar::to_f64), v: part.v.map(Scalar::to_f64) }
}

/// Compares all pieces with the B-spline at random places, the pieces' ends among them; the largest error, in roundings for
/// each degree.
fn compare<P: Kind>(random: &mut Random, owned: &Owned<P>) -> f64 {
    let spline = owned.view();
    let cut = Cut::of(&[spline]);
    let pieces = cut.view();
    let [along_u, along_v] = [Direction::U, Direction::V].map(|direction| spline.spans(direction));
    assert_eq!(pieces.len(), along_u * along_v);
    let largest = owned.points.iter().map(exact).fold(0.0, |most: f64, p| p.iter().fold(most, |m, c| m.max(c.abs())));
    let mut worst: f64 = 0.0;
    for (net, piece) in pieces.nets().zip(pieces.all()) {
        assert!(patchray::surface::Net::checked(net.degree_u(), net.degree_v(), net.points()).is_ok());
        for _ in 0..4 {
            let [s, t] = [0; 2].map(|_| match index(random, 4) {
                0 => 0.0,
                1 => 1.0,
                _ => random.within(0.0, 1.0),
            });
            let found = bezier(&net, s, t);
            let expected = blend(&spline, &widened(&piece.part()), [s, t]);
            let off = (0..4).fold(0.0, |off: f64, k| off.max((found[k] - expected[k]).abs()));
            worst = worst.max(off / largest);
        }
    }
    let degrees = (owned.degrees[0] + owned.degrees[1]) as f64;
    worst / P::Scalar::EPSILON.to_f64() / degrees
}

fn pieces_are_the_spline<P: Kind>() {
    let mut random = Random(1);
    let mut worst: f64 = 0.0;
    for n in 1..=MAX_DEGREE {
        for m in 1..=MAX_DEGREE {
            for spacing in [Spacing::Even, Spacing::Uneven, Spacing::Noisy] {
                let owned = Owned::<P>::random(&mut random, [n, m], spacing);
                let off = compare(&mut random, &owned);
                worst = worst.max(off);
                assert!(off <= f64::from(PIECE_PER_DEGREE), "{n} x {m} {spacing:?}: {off} {:?}", owned.knots);
            }
        }
    }
    println!("worst: {worst} roundings for each degree");
}

#[test]
fn every_degree_pair_evaluates_as_its_pieces_do() {
    pieces_are_the_spline::<Plain<f32>>();
    pieces_are_the_spline::<Plain<f64>>();
    pieces_are_the_spline::<Weighted<f32>>();
    pieces_are_the_spline::<Weighted<f64>>();
}

fn bits<P: Point>(point: &P) -> [u64; 4] {
    exact(point).map(f64::to_bits)
}

fn edges_are_shared<P: Kind>() {
    let mut random = Random(2);
    let mut edges = 0;
    for k in 0..300 {
        let degrees = [1 + index(&mut random, 8), 1 + index(&mut random, 8)];
        let spacing = [Spacing::Even, Spacing::Uneven, Spacing::Noisy][k % 3];
        let owned = Owned::<P>::random(&mut random, degrees, spacing);
        let cut = Cut::of(&[owned.view()]);
        let (pieces, columns) = (cut.view(), owned.view().spans(Direction::V));
        let nets: Vec<_> = pieces.nets().collect();
        for (k, net) in nets.iter().enumerate() {
            if let Some(next) = nets.get(k + columns) {
                let (last, first) = (net.rows().next_back(), next.rows().next());
                assert!(last.into_iter().flatten().map(bits).eq(first.into_iter().flatten().map(bits)));
                edges += 1;
            }
            if let Some(next) = nets.get(k + 1).filter(|_| (k + 1) % columns != 0) {
                let ends = |row: &[P]| row.last().map(bits);
                assert!(net.rows().map(ends).eq(next.rows().map(|row| row.first().map(bits))));
                edges += 1;
            }
        }
        // Pieces lie side by side, knot by knot, from one end of the domain to the other.
        for (k, piece) in pieces.all().iter().enumerate() {
            let at = |k: usize| pieces.all()[k].part();
            assert_eq!(
                piece.part().u[0],
                if k < columns { owned.view().domain(Direction::U)[0] } else { at(k - columns).u[1] }
            );
            assert_eq!(
                piece.part().v[0],
                if k % columns == 0 { owned.view().domain(Direction::V)[0] } else { at(k - 1).v[1] }
            );
        }
    }
    assert!(edges > 1000, "{edges}");
}

#[test]
fn neighbours_share_the_bits_of_their_edge() {
    edges_are_shared::<Plain<f32>>();
    edges_are_shared::<Weighted<f64>>();
}

/// Knots at the ends of the numbers: nothing overflows, and the points stay within those of the net.
#[test]
fn knots_of_any_size_make_finite_pieces() {
    fn check<S: Scalar>(scales: &[S]) {
        let mut random = Random(3);
        for &scale in scales {
            for degree in 1..=MAX_DEGREE {
                let mut knots: Vec<S> = (0..=degree).map(|_| -scale).collect();
                knots.extend([-S::HALF * scale, S::ZERO, scale * S::EPSILON, S::HALF * scale]);
                knots.extend((0..=degree).map(|_| scale));
                let size = knots.len() - degree - 1;
                let points: Vec<Weighted<S>> = (0..size * size)
                    .map(|_| {
                        Weighted::lower(
                            &{
                                let [x, y, z] = random.point(1.0);
                                [x, y, z, random.within(0.5, 2.0)]
                            },
                            1.0,
                        )
                    })
                    .collect();
                let Ok(spline) = BSpline::new(degree, degree, &knots, &knots, &points) else {
                    // Halves of the smallest number are 0, and may be too many.
                    assert!(scale < S::MIN_POSITIVE);
                    continue;
                };
                let cut = Cut::of(&[spline]);
                for net in cut.view().nets() {
                    for point in net.points() {
                        let [x, y, z] = point.position().map(Scalar::to_f64);
                        assert!(x.abs().max(y.abs()).max(z.abs()) <= 1.0 + 1e-4, "{scale:?}: {point:?}");
                        assert!((0.49..2.01).contains(&point.weight().to_f64()));
                    }
                }
            }
        }
    }
    check::<f32>(&[f32::MAX, 1e30, 1.0, 1e-30, f32::MIN_POSITIVE, 1e-44, 1e-45]);
    check::<f64>(&[f64::MAX, 1e300, 1.0, 1e-300, f64::MIN_POSITIVE, 1e-322, 5e-324]);
}

#[test]
fn pieces_need_what_they_say() {
    fn check<P: Kind>() {
        let mut random = Random(4);
        let owned = [[3, 2], [1, 5]].map(|degrees| Owned::<P>::random(&mut random, degrees, Spacing::Even));
        let splines = [owned[0].view(), owned[1].view()];
        let all = needs(&splines);
        let (points, pieces) = (all.points.needed, all.pieces.needed);
        let each = splines.map(|spline| spline.spans(Direction::U) * spline.spans(Direction::V));
        assert_eq!((points, pieces), (each[0] * 12 + each[1] * 12, each[0] + each[1]));
        let build = |sizes: [usize; 2]| {
            // Rubbish in the slots changes nothing.
            let mut points = vec![P::lower(&[7.0, 8.0, 9.0, 3.0], 1.0); sizes[0]];
            let mut slots = vec![Piece::EMPTY; sizes[1]];
            let built = Pieces::build(&splines, PieceMemory { points: &mut points, pieces: &mut slots });
            built.map(|pieces| (pieces.len(), pieces.nets().map(|net| net.points().to_vec()).collect::<Vec<_>>()))
        };
        let exact = build([points, pieces]).expect("as counted");
        assert_eq!(exact.0, pieces);
        assert_eq!(build([points + 5, pieces + 2]), Ok(exact));
        for given in [[points - 1, pieces], [points, pieces - 1], [points - 1, pieces - 1], [0, pieces], [points, 0]] {
            let [of_points, of_pieces] =
                [(points, given[0]), (pieces, given[1])].map(|(needed, given)| Need { needed, given });
            let needs = PieceNeeds { points: of_points, pieces: of_pieces };
            assert_eq!(build(given), Err(PieceError::Memory(needs)));
        }
        // The B-splines are told apart, and one alone makes the pieces that it makes among others.
        let cut = Cut::of(&splines);
        let numbers: Vec<u32> = cut.view().all().iter().map(Piece::spline).collect();
        assert_eq!(numbers.iter().filter(|&&number| number == 0).count(), each[0]);
        assert!(numbers.is_sorted() && numbers.last() == Some(&1));
        let alone = Cut::of(&splines[1..]);
        let among: Vec<_> = cut.view().nets().skip(each[0]).map(|net| net.points().to_vec()).collect();
        assert!(alone.view().nets().map(|net| net.points().to_vec()).eq(among));
    }
    check::<Plain<f32>>();
    check::<Weighted<f64>>();
}

/// A B-spline over the plane: x and y go up with u and v, so that a ray downward meets it once.
fn hills(random: &mut Random, degrees: [usize; 2], rational: bool) -> Spline {
    let knots = degrees.map(|degree| knots::<f64>(random, degree, Spacing::Even));
    let greville = |k: usize, i: usize| knots[k][i + 1..=i + degrees[k]].iter().sum::<f64>() / degrees[k] as f64;
    let sizes = [0, 1].map(|k| knots[k].len() - degrees[k] - 1);
    let mut points = Vec::new();
    for i in 0..sizes[0] {
        for j in 0..sizes[1] {
            let weight = if rational { random.within(0.7, 1.4) } else { 1.0 };
            points.push([greville(0, i), greville(1, j), random.within(-0.3, 0.3), weight]);
        }
    }
    Spline { degrees, knots, rational, points }
}

/// Hits of a B-spline are those of its pieces: straight down at a known point, at its parameters.
fn hits_lie_at_the_splines_parameters<P: Kind>(rational: bool, allowance: f64) {
    let mut random = Random(5);
    let mut hits = 0;
    for degrees in [[1, 1], [2, 3], [3, 3], [5, 2], [4, 7]] {
        for _ in 0..4 {
            let spline = hills(&mut random, degrees, rational);
            let (surfaces, summary) = spline.cut(3).expect("valid");
            let model = Model { surfaces };
            let prepared = Prepared::<P>::of(&model);
            let scene = prepared.scene();
            let points: Vec<Weighted<f64>> = spline.points.iter().map(|point| Weighted::lower(point, 1.0)).collect();
            let [u, v] = &spline.knots;
            let view = BSpline::new(degrees[0], degrees[1], u, v, &points).expect("valid");
            let mut scratch = Box::new(Scratch::<P, 16, 256>::new());
            for _ in 0..50 {
                let part = model.surfaces[index(&mut random, model.surfaces.len())].knots.expect("a piece");
                // At knots too, where a hit may be found on either piece.
                let shares = [0; 2].map(|_| match index(&mut random, 5) {
                    0 => 0.0,
                    1 => 1.0,
                    _ => random.within(0.0, 1.0),
                });
                let at = part.in_knots(shares[0], shares[1]);
                let [wx, wy, wz, w] = blend(&view, &part, shares);
                let from = [wx / w, wy / w, 9.0].map(P::Scalar::from_f64);
                let down = [0.0, 0.0, -1.0].map(P::Scalar::from_f64);
                let ray = scene.ray(from, down).expect("a ray");
                let (interval, limits, mut work) = (Interval::ahead(), Limits::default(), Work::default());
                let (patches, tree) = (prepared.patches(), prepared.tree());
                let view = &mut scratch.view();
                let hit = newton::closest(&scene, &patches, &tree, &ray, &interval, &limits, view, &mut work);
                let Some(hit) = hit.expect("within the limits") else {
                    // A ray at the border of the whole surface may pass it by.
                    let inside = (0..2).all(|k| summary.domain[k][0] < at[k] && at[k] < summary.domain[k][1]);
                    assert!(!inside, "{degrees:?}: missed at {at:?}");
                    continue;
                };
                hits += 1;
                let surface = &model.surfaces[hit.surface as usize];
                assert_eq!(surface.number, 3);
                let found = surface.parameters(hit.u.to_f64(), hit.v.to_f64());
                let off = [found[0] - at[0], found[1] - at[1], hit.t.to_f64() - (9.0 - wz / w)];
                assert!(off.iter().all(|off| off.abs() <= allowance), "{degrees:?}: {off:?} at {at:?}");
            }
        }
    }
    assert!(hits > 800, "{hits}");
}

#[test]
fn hits_come_back_in_knots() {
    hits_lie_at_the_splines_parameters::<Plain<f64>>(false, 1e-11);
    hits_lie_at_the_splines_parameters::<Weighted<f64>>(true, 1e-11);
    hits_lie_at_the_splines_parameters::<Plain<f32>>(false, 2e-4);
    hits_lie_at_the_splines_parameters::<Weighted<f32>>(true, 2e-4);
}

/// The B-splines add up to 1 everywhere, and so does what they are compared by.
#[test]
fn the_reference_adds_up() {
    let mut random = Random(6);
    let owned = Owned::<Weighted<f64>>::random(&mut random, [4, 3], Spacing::Even);
    let ones = vec![Weighted::new([1.0; 3], 1.0); owned.points.len()];
    let [u, v] = &owned.knots;
    let spline = BSpline::new(4, 3, u, v, &ones).expect("valid");
    for piece in Cut::of(&[spline]).view().all() {
        for k in 0..=10 {
            let sum = blend(&spline, &piece.part(), [k as f64 / 10.0, 1.0 - k as f64 / 10.0]);
            assert!(sum.iter().all(|c| (c - 1.0).abs() < 1e-14), "{sum:?}");
        }
    }
}
