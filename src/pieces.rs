//! B-spline surfaces cut into Bézier surfaces, their pieces, in lent memory; and hits given back in the B-splines' knots.
//!
//! The control points of a piece are values of the blossom with only the span's two ends as arguments (L. Ramshaw,
//! "Blossoming: a connect-the-dots approach to splines", 1987); they are reached by inserting the ends as knots (W. Boehm,
//! "Inserting new knots into B-spline curves", Computer-Aided Design 12, 1980), one insertion at a time, in the slots
//! where the piece ends up. Each is a mean of two points with two shares of at least 0, so that weights stay positive,
//! and each divisor is at least as long as the span, however short its neighbours are. A piece takes what it has in common
//! with the piece before it from that piece, so that common edges are the same bits.
//!
//! As in the rest of the kernel the caller lends the memory, and lending nothing is how to ask:
//!
//! ```
//! use patchray::arena::Need;
//! use patchray::bspline::BSpline;
//! use patchray::pieces::{Piece, PieceError, PieceMemory, PieceNeeds, Pieces};
//! use patchray::point::Plain;
//! use patchray::ray::{Hit, Incidence};
//! use patchray::scene::{Scene, SceneMemory, SceneOptions, SurfaceSlot};
//!
//! // Degrees 2 × 1; four points along u, the parameter of which runs from 3 to 5; two along v.
//! let (u, v) = ([3.0, 3.0, 3.0, 4.0, 5.0, 5.0, 5.0], [0.0, 0.0, 1.0, 1.0]);
//! let points = [0, 1, 2, 3, 4, 5, 6, 7].map(|k: u8| Plain([f32::from(k / 2), f32::from(k % 2), f32::from(k % 3)]));
//! let spline = [BSpline::new(2, 1, &u, &v, &points)?];
//!
//! let asked = Pieces::build(&spline, PieceMemory { points: &mut [], pieces: &mut [] });
//! let needs = PieceNeeds { points: Need { needed: 12, given: 0 }, pieces: Need { needed: 2, given: 0 } };
//! assert_eq!(asked.err(), Some(PieceError::Memory(needs)));
//!
//! // In firmware these are statics.
//! let (mut points, mut pieces) = ([Plain([0.0; 3]); 12], [Piece::EMPTY; 2]);
//! let pieces = Pieces::build(&spline, PieceMemory { points: &mut points, pieces: &mut pieces })?;
//! let nets = pieces.nets_array::<2>().expect("as many as were asked for");
//! # let (mut points, mut surfaces) = ([Plain([0.0; 3]); 12], [SurfaceSlot::EMPTY; 2]);
//! # let (mut offsets, mut references) = ([0; 99], [0; 99]);
//! # let memory = SceneMemory {
//! #     points: &mut points,
//! #     surfaces: &mut surfaces,
//! #     offsets: &mut offsets,
//! #     references: &mut references,
//! # };
//! let scene = Scene::build(&nets, &SceneOptions::default(), memory)?;
//! // … and whatever a method needs: see the head of the crate. Then a hit of surface 1, the span from 4 to 5, at u = 1/2
//! # let hit = Hit { t: 1.0, u: 0.5, v: 0.25, surface: 1, incidence: Incidence::Crossing };
//! let at = pieces.in_knots(&hit).expect("a hit of this scene");
//! assert_eq!((at.spline, at.u, at.v), (0, 4.5, 0.25));
//! # assert_eq!(scene.len(), 2);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```

use crate::arena::{Arena, Need};
use crate::bernstein::Degrees;
use crate::bspline::{BSpline, Span};
use crate::point::Point;
use crate::ray::Hit;
use crate::scalar::Scalar;
use crate::surface::{Direction, Net};

/// A rectangle of a B-spline's domain: that of a piece, from knot to knot in u and in v.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Part<S> {
    /// From and to, in u.
    pub u: [S; 2],
    /// From and to, in v.
    pub v: [S; 2],
}

impl<S: Scalar> Part<S> {
    /// The parameters of the B-spline at the parameters (u, v) of the piece, which are held within 0 to 1. Exact at 0 and
    /// 1, never outside the rectangle, and not less for a larger parameter.
    pub fn in_knots(&self, u: S, v: S) -> [S; 2] {
        [between(self.u, u), between(self.v, v)]
    }
}

/// A piece as a slot of lent memory: where it lies in its B-spline, and where its control points are.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Piece<S> {
    part: Part<S>,
    /// The first of its control points.
    first: u32,
    spline: u32,
    degree_u: u32,
    degree_v: u32,
}

impl<S: Scalar> Piece<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self =
        Piece { part: Part { u: [S::ZERO; 2], v: [S::ZERO; 2] }, first: 0, spline: 0, degree_u: 0, degree_v: 0 };

    /// The B-spline that it is a piece of: an index of what [`Pieces::build`] was given.
    pub fn spline(&self) -> u32 {
        self.spline
    }

    /// The knots between which it lies.
    pub fn part(&self) -> Part<S> {
        self.part
    }
}

/// From `low` to `high`, of which the first is not larger, as `t` goes from 0 to 1: never outside, never backward.
///
/// Source: S. B. Lange, "Extending std::lerp and midpoint", P0811 of the C++ committee, 2019. Neither formula overflows
/// where it is used: the difference is taken of two numbers of one sign.
fn between<S: Scalar>([low, high]: [S; 2], t: S) -> S {
    let t = t.clamped(S::ZERO, S::ONE);
    if low <= S::ZERO && high >= S::ZERO {
        return t * high + (S::ONE - t) * low;
    }
    if t == S::ONE { high } else { (low + t * (high - low)).lesser(high) }
}

/// Lent memory for pieces.
#[derive(Debug)]
pub struct PieceMemory<'m, P: Point> {
    /// The control points of all pieces, (degree in u + 1) · (degree in v + 1) of each.
    pub points: &'m mut [P],
    /// One slot per piece: spans in u times spans in v of each B-spline.
    pub pieces: &'m mut [Piece<P::Scalar>],
}

/// Slots that pieces need, and what was lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PieceNeeds {
    /// Of [`PieceMemory::points`].
    pub points: Need,
    /// Of [`PieceMemory::pieces`].
    pub pieces: Need,
}

/// Why B-splines were not cut into pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceError {
    /// Lent memory is too small; all needs are listed. Lending nothing is how to ask.
    Memory(PieceNeeds),
    /// More B-splines, pieces or points than their numbers can count.
    TooLarge,
}

impl core::fmt::Display for PieceError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            PieceError::Memory(needs) => write!(f, "lent memory is too small: {needs:?}"),
            PieceError::TooLarge => f.write_str("more pieces or points than 32 bits can count"),
        }
    }
}

impl core::error::Error for PieceError {}

/// The pieces of B-splines: a view of lent memory.
#[derive(Clone, Copy, Debug)]
pub struct Pieces<'m, P: Point> {
    points: &'m [P],
    pieces: &'m [Piece<P::Scalar>],
}

/// A hit in the knots of a B-spline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InKnots<S> {
    /// The B-spline: an index of what [`Pieces::build`] was given.
    pub spline: u32,
    /// Its parameter, within its knots in u.
    pub u: S,
    /// Its parameter, within its knots in v.
    pub v: S,
}

impl<'m, P: Point> Pieces<'m, P> {
    /// Cuts B-splines into their pieces: B-spline by B-spline, in each by spans in u, and for each of those by spans in v.
    /// Too little memory is an error that lists all needs.
    ///
    /// Errors of rounding are those of 2 · (degree − 1) means of points in each direction, whatever the knots. Pieces of
    /// which one coordinate is within a rounding of the largest number there is may overflow;
    /// [`Scene::build`](crate::scene::Scene::build) then refuses them.
    pub fn build(splines: &[BSpline<'_, P>], memory: PieceMemory<'m, P>) -> Result<Self, PieceError> {
        let mut points = Arena::new(memory.points);
        let mut pieces = Arena::new(memory.pieces);
        let number = |index: usize| u32::try_from(index).map_err(|_| PieceError::TooLarge);
        for (k, spline) in splines.iter().enumerate() {
            let spline_number = number(k)?;
            let start = points.len();
            let cut = Cut { spline, along_v: spline.spans(Direction::V) };
            for (i, u) in spline.spans_of(Direction::U).enumerate() {
                for (j, v) in spline.spans_of(Direction::V).enumerate() {
                    let first = points.len();
                    cut.copy_window(&u, &v, &mut points);
                    if let Some(nets) = points.since(start) {
                        cut.fill(&u, &v, [i, j], nets);
                    }
                    pieces.push(Piece {
                        part: Part { u: u.ends, v: v.ends },
                        first: number(first)?,
                        spline: spline_number,
                        degree_u: u32::from(spline.degrees.u),
                        degree_v: u32::from(spline.degrees.v),
                    });
                }
            }
        }
        number(pieces.len())?;
        let needs = PieceNeeds { points: points.need(), pieces: pieces.need() };
        if !(needs.points.met() && needs.pieces.met()) {
            return Err(PieceError::Memory(needs));
        }
        Ok(Pieces { points: points.finish(), pieces: pieces.finish() })
    }

    /// The view of memory that was filled before, such as a table in flash. Hits need the pieces alone: once a scene has its
    /// copy of the points, they may be left out, and their memory used for something else.
    pub fn new(points: &'m [P], pieces: &'m [Piece<P::Scalar>]) -> Self {
        Pieces { points, pieces }
    }

    /// The number of pieces.
    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Whether there are no pieces.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// All pieces, in the order of [`Pieces::build`].
    pub fn all(&self) -> &'m [Piece<P::Scalar>] {
        self.pieces
    }

    /// The net of a piece by its number; `None` if there is none, or the memory does not hold it.
    pub fn net(&self, number: usize) -> Option<Net<'m, P>> {
        let piece = self.pieces.get(number)?;
        let (n, m, first) = (piece.degree_u as usize, piece.degree_v as usize, piece.first as usize);
        let count = n.checked_add(1)?.checked_mul(m.checked_add(1)?)?;
        Net::new(n, m, self.points.get(first..first.checked_add(count)?)?).ok()
    }

    /// The nets of the pieces, in order, as a scene takes them.
    pub fn nets(&self) -> impl Iterator<Item = Net<'m, P>> + use<'m, P> {
        let pieces = *self;
        (0..pieces.len()).map_while(move |k| pieces.net(k))
    }

    /// The nets as an array, for callers without an allocator; `None` unless there are exactly `N` pieces, and at least one.
    pub fn nets_array<const N: usize>(&self) -> Option<[Net<'m, P>; N]> {
        if self.len() != N {
            return None;
        }
        let mut nets = [self.net(0)?; N];
        for (k, net) in nets.iter_mut().enumerate() {
            *net = self.net(k)?;
        }
        Some(nets)
    }

    /// A hit of a scene whose surfaces are these pieces, from number 0 on, in the knots of its B-spline; `None` if the
    /// hit's surface is none of them.
    pub fn in_knots(&self, hit: &Hit<P::Scalar>) -> Option<InKnots<P::Scalar>> {
        let piece = self.pieces.get(hit.surface as usize)?;
        let [u, v] = piece.part.in_knots(hit.u, hit.v);
        Some(InKnots { spline: piece.spline, u, v })
    }
}

/// Cuts one B-spline.
struct Cut<'s, 'm, P: Point> {
    spline: &'s BSpline<'m, P>,
    /// The number of spans in v: how many pieces lie between two neighbours in u.
    along_v: usize,
}

impl<P: Point> Cut<'_, '_, P> {
    /// Puts the control points on which a piece depends where the piece's own will be; as many.
    fn copy_window(&self, u: &Span<P::Scalar>, v: &Span<P::Scalar>, points: &mut Arena<'_, P>) {
        let Degrees { u: p, v: q } = self.spline.degrees;
        let (row, column) = (u.index.saturating_sub(p.into()), v.index.saturating_sub(q.into()));
        let stride = self.spline.size(Direction::V);
        for i in 0..self.spline.degrees.rows() {
            let begin = row.saturating_add(i).saturating_mul(stride).saturating_add(column);
            for j in 0..self.spline.degrees.columns() {
                points.push(self.spline.points().get(begin.saturating_add(j)).copied().unwrap_or(P::EMPTY));
            }
        }
    }

    /// Makes the window at the end of `nets`, which holds the B-spline's pieces so far, the net of piece (i, j).
    fn fill(&self, u: &Span<P::Scalar>, v: &Span<P::Scalar>, [i, j]: [usize; 2], nets: &mut [P]) {
        let degrees = self.spline.degrees;
        let (rows, columns) = (degrees.rows(), degrees.columns());
        let count = rows * columns;
        let first = nets.len().saturating_sub(count);
        for column in 0..columns {
            to_bezier(nets, first.saturating_add(column), columns, degrees.u, self.spline.u, u);
        }
        for row in 0..rows {
            to_bezier(nets, first.saturating_add(row * columns), 1, degrees.v, self.spline.v, v);
        }
        // What it shares with the pieces before it in u and in v differs by roundings only: theirs stays.
        let mut take = |from: usize, to: usize| {
            if let Some(&shared) = nets.get(from) {
                if let Some(slot) = nets.get_mut(to) {
                    *slot = shared;
                }
            }
        };
        if i > 0 {
            let last_row = first.saturating_sub(self.along_v.saturating_mul(count)).saturating_add(count - columns);
            for column in 0..columns {
                take(last_row.saturating_add(column), first.saturating_add(column));
            }
        }
        if j > 0 {
            let last_column = first.saturating_sub(count).saturating_add(columns - 1);
            for row in 0..rows {
                take(last_column.saturating_add(row * columns), first.saturating_add(row * columns));
            }
        }
    }
}

/// Turns the degree + 1 control points on which a span depends, `stride` apart from `first` on, into those of the Bézier
/// curve over it.
///
/// The points are f[t_(k−p+1) … t_k], …, f[t_(k+1) … t_(k+p)] for a span that begins at knot k. Its end is inserted until
/// no other knot is left above it, and then its begin likewise.
fn to_bezier<S: Scalar, P: Point<Scalar = S>>(
    points: &mut [P],
    first: usize,
    stride: usize,
    degree: u8,
    knots: &[S],
    span: &Span<S>,
) {
    let degree = usize::from(degree);
    // The knot by its place in the list t_(k−p), …, t_(k+p), from 0.
    let knot = |place: usize| {
        let index = span.index.saturating_sub(degree).saturating_add(place);
        knots.get(index).copied().unwrap_or(S::ZERO)
    };
    let mut mix = |low: usize, high: usize, into: usize, [a, b]: [S; 2]| {
        let at = |k: usize| first.saturating_add(k * stride);
        if let (Some(&p), Some(&q)) = (points.get(at(low)), points.get(at(high))) {
            if let Some(slot) = points.get_mut(at(into)) {
                *slot = p * a + q * b;
            }
        }
    };
    let [begin, end] = span.ends;
    for round in 0..degree.saturating_sub(1) {
        for k in (round + 2..=degree).rev() {
            let (low, high) = (knot(k), knot(degree + k - round));
            // Equal to the end: it is there already.
            if high > end {
                mix(k - 1, k, k, shares(low, end, high));
            }
        }
    }
    for round in 0..degree.saturating_sub(1) {
        for k in 0..degree - 1 - round {
            let low = knot(k + 1 + round);
            if low < begin {
                mix(k, k + 1, k, shares(low, begin, end));
            }
        }
    }
}

/// How much of a point at `low` and of a point at `high` makes one at `x` between them: each at least 0, and in sum 1 but
/// for rounding. Both are divisions, so that a small one has all its digits.
fn shares<S: Scalar>(low: S, x: S, high: S) -> [S; 2] {
    // Halves of numbers whose difference overflows are exact.
    let by = if (high - low).is_finite() { S::ONE } else { S::HALF };
    let [low, x, high] = [low * by, x * by, high * by];
    let width = high - low;
    [(high - x) / width, (x - low) / width]
}

#[cfg(test)]
mod tests;
