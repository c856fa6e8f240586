//! B-spline surfaces: knots and net, rational or not, clamped or not.
//!
//! A B-spline of degree p with the knots t_0 ≤ t_1 ≤ … ≤ t_(n+p+1) has n + 1 control points, and is defined from t_p to
//! t_(n+1). Between two neighbouring knots that differ it is a polynomial, and so a Bézier curve: a *span*. A surface has
//! knots and spans in u and in v, and each pair of spans makes a *piece*, a Bézier surface like any other. To cut a surface
//! so ([`pieces`](crate::pieces)) is exact but for rounding. It is a departure from the paper, which projects the B-spline
//! itself.

use crate::arena::Need;
use crate::bernstein::{Degrees, MAX_DEGREE};
use crate::point::Point;
use crate::scalar::Scalar;
use crate::surface::Direction;

/// Why knots and control points are not a B-spline surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BSplineError {
    /// A degree is not within 1 to [`MAX_DEGREE`].
    Degree {
        /// In which direction.
        direction: Direction,
        /// The degree.
        degree: usize,
    },
    /// Fewer knots than the 2 · (degree + 1) with which a surface begins.
    Knots {
        /// In which direction.
        direction: Direction,
        /// How many at least, and how many there are.
        need: Need,
    },
    /// A knot is NaN or infinite.
    KnotNotFinite {
        /// In which direction.
        direction: Direction,
        /// Which knot, from 0.
        index: usize,
    },
    /// A knot is less than the one before it.
    Decreasing {
        /// In which direction.
        direction: Direction,
        /// Which knot, from 0.
        index: usize,
    },
    /// There is nothing between the knots where the surface begins and ends: its domain is empty.
    Empty {
        /// In which direction.
        direction: Direction,
        /// The knot at which the domain begins: the degree.
        first: usize,
        /// The knot at which it ends, equal to the first: the number of control points in this direction.
        last: usize,
    },
    /// More equal knots than the degree within the domain, where the surface would come apart, or than the degree + 1 at its
    /// ends or outside.
    Multiplicity {
        /// In which direction.
        direction: Direction,
        /// The first knot, from 0, that is one too many.
        index: usize,
        /// How many equal knots there may be here.
        most: usize,
    },
    /// The number of control points is not that which the knots ask for: knots less degree less 1, in u times in v.
    Points(Need),
    /// The control point of this index has a coordinate or a weight that is NaN or infinite.
    NotFinite(usize),
    /// The control point of this index has a weight that is not positive.
    Weight(usize),
}

impl core::fmt::Display for BSplineError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            BSplineError::Degree { direction, degree } => {
                write!(f, "degree {degree} in {direction} is not within 1 to {MAX_DEGREE}")
            }
            BSplineError::Knots { direction, need } => {
                write!(f, "{} knots in {direction}, where at least {} are needed", need.given, need.needed)
            }
            BSplineError::KnotNotFinite { direction, index } => write!(f, "knot {index} in {direction} is not finite"),
            BSplineError::Decreasing { direction, index } => {
                write!(f, "knot {index} in {direction} is less than the one before it")
            }
            BSplineError::Empty { direction, first, last } => {
                write!(f, "the domain in {direction} is empty: knots {first} to {last} are equal")
            }
            BSplineError::Multiplicity { direction, index, most } => {
                write!(f, "knot {index} in {direction} is equal to the {most} before it, and that is one too many")
            }
            BSplineError::Points(need) => write!(f, "{} control points, not {}", need.given, need.needed),
            BSplineError::NotFinite(k) => write!(f, "control point {k} is not finite"),
            BSplineError::Weight(k) => write!(f, "the weight of control point {k} is not positive"),
        }
    }
}

impl core::error::Error for BSplineError {}

/// A B-spline surface: a view of lent knots and control points, all of them valid.
#[derive(Clone, Copy, Debug)]
pub struct BSpline<'m, P: Point> {
    pub(crate) degrees: Degrees,
    pub(crate) u: &'m [P::Scalar],
    pub(crate) v: &'m [P::Scalar],
    points: &'m [P],
}

impl<'m, P: Point> BSpline<'m, P> {
    /// A view of knots and control points as a surface of these degrees, 1 to [`MAX_DEGREE`]; checks all of it.
    ///
    /// `u` and `v` are knots, none less than the one before it. They are as many as the control points in that direction +
    /// degree + 1: so the knots say how many points there are. A knot may be repeated, within the domain up to as often as
    /// the degree says, at its ends once more. Clamped surfaces, whose first and last knots are repeated so often, begin and
    /// end at their outermost points; others do not, and are as welcome. Knots can be of any size and in any units.
    ///
    /// `points` holds the control points with u as the outer index.
    pub fn new(
        degree_u: usize,
        degree_v: usize,
        u: &'m [P::Scalar],
        v: &'m [P::Scalar],
        points: &'m [P],
    ) -> Result<Self, BSplineError> {
        let rows = check_knots(Direction::U, degree_u, u)?;
        let columns = check_knots(Direction::V, degree_v, v)?;
        let needed = rows.saturating_mul(columns);
        if points.len() != needed {
            return Err(BSplineError::Points(Need { needed, given: points.len() }));
        }
        for (k, point) in points.iter().enumerate() {
            let weight = point.weight();
            if point.weighted_position().iter().any(|c| !c.is_finite()) || !weight.is_finite() {
                return Err(BSplineError::NotFinite(k));
            }
            if weight <= P::Scalar::ZERO {
                return Err(BSplineError::Weight(k));
            }
        }
        // Both are at most MAX_DEGREE here.
        Ok(BSpline { degrees: Degrees { u: degree_u as u8, v: degree_v as u8 }, u, v, points })
    }

    /// The degree in a direction.
    pub fn degree(&self, direction: Direction) -> usize {
        usize::from(match direction {
            Direction::U => self.degrees.u,
            Direction::V => self.degrees.v,
        })
    }

    /// The knots in a direction.
    pub fn knots(&self, direction: Direction) -> &'m [P::Scalar] {
        match direction {
            Direction::U => self.u,
            Direction::V => self.v,
        }
    }

    /// The number of control points in a direction.
    pub fn size(&self, direction: Direction) -> usize {
        self.knots(direction).len().saturating_sub(self.degree(direction) + 1)
    }

    /// The control points, u outer.
    pub fn points(&self) -> &'m [P] {
        self.points
    }

    /// The parameters in a direction for which the surface is defined, from the first to the second.
    pub fn domain(&self, direction: Direction) -> [P::Scalar; 2] {
        let at = |k: usize| self.knots(direction).get(k).copied().unwrap_or(P::Scalar::ZERO);
        [at(self.degree(direction)), at(self.size(direction))]
    }

    /// The number of spans of positive length in a direction; those of u times those of v are the pieces.
    pub fn spans(&self, direction: Direction) -> usize {
        self.spans_of(direction).count()
    }

    /// The spans of positive length in a direction, in order.
    pub(crate) fn spans_of(&self, direction: Direction) -> impl Iterator<Item = Span<P::Scalar>> + use<'m, P> {
        let (degree, size) = (self.degree(direction), self.size(direction));
        let pairs = self.knots(direction).windows(2).enumerate().take(size).skip(degree);
        pairs.filter_map(|(index, pair)| match pair {
            &[from, to] if from < to => Some(Span { index, ends: [from, to] }),
            _ => None,
        })
    }
}

/// A span of positive length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span<S> {
    /// The knot at which it begins; it ends at the next one.
    pub(crate) index: usize,
    /// Both knots.
    pub(crate) ends: [S; 2],
}

/// Checks degree and knots of one direction; the number of control points that they ask for.
fn check_knots<S: Scalar>(direction: Direction, degree: usize, knots: &[S]) -> Result<usize, BSplineError> {
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(BSplineError::Degree { direction, degree });
    }
    let need = Need { needed: 2 * (degree + 1), given: knots.len() };
    if !need.met() {
        return Err(BSplineError::Knots { direction, need });
    }
    let size = knots.len().saturating_sub(degree + 1);
    if let Some(index) = knots.iter().position(|knot| !knot.is_finite()) {
        return Err(BSplineError::KnotNotFinite { direction, index });
    }
    if let Some(index) = knots.windows(2).position(|pair| matches!(pair, [before, after] if after < before)) {
        return Err(BSplineError::Decreasing { direction, index: index.saturating_add(1) });
    }
    let (Some(&begin), Some(&end)) = (knots.get(degree), knots.get(size)) else {
        return Err(BSplineError::Knots { direction, need });
    };
    if !(begin < end) {
        return Err(BSplineError::Empty { direction, first: degree, last: size });
    }
    let (mut value, mut count) = (begin, 0);
    for (index, &knot) in knots.iter().enumerate() {
        count = if index > 0 && knot == value { count + 1 } else { 1 };
        value = knot;
        let most = if begin < knot && knot < end { degree } else { degree + 1 };
        if count > most {
            return Err(BSplineError::Multiplicity { direction, index, most });
        }
    }
    Ok(size)
}

#[cfg(test)]
mod tests;
