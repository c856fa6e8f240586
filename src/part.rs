//! The projected net of a region of a surface, and what rounding may have done to it.

use crate::bernstein::{Degrees, Direction, Full};
use crate::casteljau;
use crate::clip::{Noise, chords, corners};
use crate::parameter::Parameter;
use crate::point::Flat;
use crate::reading::Reading;
use crate::region::Region;
use crate::scalar::Scalar;
use heapless::vec::VecView;

/// The net of a region, in lent room, and the region that it is of.
pub(crate) struct Part<'a, F: Flat> {
    pub(crate) region: Region<F::Parameter>,
    pub(crate) degrees: Degrees,
    pub(crate) net: &'a mut [F],
    /// A bound of the points' |f| and |g|.
    reach: F::Scalar,
    /// By how much the points may be off: the coefficients by that times their weights, of which de Casteljau's algorithm makes
    /// means as it does of them. A bound for the heaviest would drown what is light.
    pub(crate) error: F::Scalar,
    /// By how much those of the whole may be.
    projected: F::Scalar,
}

impl<'a, F: Flat> Part<'a, F> {
    /// The whole surface, its projected net, off by `error` at most, copied into lent room; `None` if it is seen to pass the
    /// ray by, which is a departure: the paper's clipping finds it out.
    #[inline(always)]
    pub(crate) fn whole(
        reading: impl Reading,
        degrees: Degrees,
        whole: &[F],
        error: F::Scalar,
        room: &'a mut VecView<F>,
    ) -> Result<Option<Self>, Full> {
        let reach = match straddling(whole, error) {
            Some(reach) => reach,
            None if reading.box_first() => return Ok(None),
            None => reach(whole),
        };
        if room.len() < whole.len() {
            room.resize(whole.len(), F::ZERO).map_err(|_| Full)?;
        }
        let net = room.get_mut(..whole.len()).ok_or(Full)?;
        net.iter_mut().zip(whole).for_each(|(slot, &point)| *slot = point);
        Ok(Some(Part { region: Region::WHOLE, degrees, net, reach, error, projected: error }))
    }

    /// What to allow for when its coefficients are compared, with this much of tolerance for its points.
    #[inline(always)]
    pub(crate) fn noise(&self, tolerance: F::Scalar) -> Noise<F::Scalar> {
        Noise { error: self.error, tolerance }
    }

    /// To a region of the surface: from what it is, if that holds it, else from the whole again.
    pub(crate) fn become_region(&mut self, whole: &[F], region: Region<F::Parameter>) {
        let mut from = Region::WHOLE;
        if self.region.encloses(region.sides) {
            from = self.region;
        } else {
            self.net.iter_mut().zip(whole).for_each(|(slot, &point)| *slot = point);
            (self.reach, self.error) = (reach(whole), self.projected);
        }
        for (direction, ([low, high], inner)) in
            [Direction::U, Direction::V].into_iter().zip(from.sides.into_iter().zip(region.sides))
        {
            if [low, high] != inner {
                let inverse = F::Scalar::ONE / high.minus(low);
                let share = |c: F::Parameter| {
                    F::Parameter::ZERO.toward(F::Parameter::ONE, c.minus(low) * inverse, high.minus(c) * inverse)
                };
                self.restrict(direction, inner.map(share));
            }
        }
        self.region = region;
    }

    /// To a part of itself, counted across it from 0 to 1.
    #[inline(always)]
    pub(crate) fn narrow(&mut self, direction: Direction, part: [F::Scalar; 2]) {
        self.restrict(direction, part.map(F::Parameter::new));
        self.region.narrow(direction, part);
    }

    #[inline(always)]
    fn restrict(&mut self, direction: Direction, part: [F::Parameter; 2]) {
        let degree = match direction {
            Direction::U => self.degrees.u,
            Direction::V => self.degrees.v,
        };
        // Each of up to 2 · degree levels of de Casteljau's algorithm rounds a sum of two products.
        let roundings = F::Scalar::from_u32(3 * u32::from(degree));
        self.error += roundings * F::Scalar::EPSILON * self.reach;
        casteljau::restrict(self.degrees, self.net, direction, part);
        // A part reaches no farther than the whole, so a bound need not be renewed each time.
        if direction == Direction::V {
            self.reach = reach(self.net);
        }
    }

    /// The parameter along which the net is longer, as the ray sees it.
    #[cold]
    pub(crate) fn longer(&self) -> Direction {
        let [along_u, along_v] = self.lengths();
        if along_u >= along_v { Direction::U } else { Direction::V }
    }

    /// The same if it is many times longer: as of rulings seen end on, to halve the other is to see the same twice.
    #[cold]
    pub(crate) fn much_longer(&self) -> Option<Direction> {
        let much = |[u, v]: [F::Scalar; 2]| {
            let times = F::Scalar::from_u32(MUCH);
            if u > v * times {
                Some(Direction::U)
            } else if v > u * times {
                Some(Direction::V)
            } else {
                None
            }
        };
        // By the corners first, which cost less than all points; they may be in one place, as those of a loop.
        let length = |[f, g]: [F::Scalar; 2]| f.abs() + g.abs();
        much(chords(corners(self.degrees, self.net)).map(length)).and_then(|_| much(self.lengths()))
    }

    /// Whether one of the two edges along a parameter is a point, to rounding.
    #[cold]
    pub(crate) fn is_collapsed(&self, direction: Direction) -> bool {
        let (rows, columns) = (self.degrees.rows(), self.degrees.columns());
        let edge = |k: usize| -> [usize; 3] {
            match direction {
                // Along u: all rows of one column.
                Direction::U => [k * (columns - 1), columns, rows],
                Direction::V => [k * (rows - 1) * columns, 1, columns],
            }
        };
        let point = |[first, stride, count]: [usize; 3]| {
            let at = |k: usize| self.net.get(first + k * stride).map_or([F::Scalar::ZERO; 2], |point| point.position());
            let [f, g] = at(0);
            // What is settled as seen across any line, see `clip`, or else the other parameter would be halved for ever.
            let off = self.error;
            (1..count).map(at).all(|[h, i]| (h - f).abs() <= off && (i - g).abs() <= off)
        };
        point(edge(0)) || point(edge(1))
    }

    /// How far its points lie from its first corner at most: |f| + |g|.
    #[cold]
    pub(crate) fn extent(&self) -> F::Scalar {
        let [f, g] = self.net.first().map_or([F::Scalar::ZERO; 2], |corner| corner.position());
        self.net.iter().fold(F::Scalar::ZERO, |most, point| {
            let [h, i] = point.position();
            most.greater((h - f).abs() + (i - g).abs())
        })
    }

    /// The longest steps from one point to the next, along u and along v.
    fn lengths(&self) -> [F::Scalar; 2] {
        let columns = self.degrees.columns();
        let step = |p: F, q: F| {
            let [[f, g], [h, i]] = [p.position(), q.position()];
            (h - f).abs() + (i - g).abs()
        };
        let longest = |most: F::Scalar, (&p, &q): (&F, &F)| most.greater(step(p, q));
        let along_u = self.net.iter().zip(self.net.iter().skip(columns)).fold(F::Scalar::ZERO, longest);
        let rows = self.net.chunks_exact(columns);
        let along_v = rows.fold(F::Scalar::ZERO, |most, row| row.iter().zip(row.iter().skip(1)).fold(most, longest));
        [along_u, along_v]
    }
}

/// A net is halved across its longer side where that is so many times the other. Smaller halves sides that a clip may yet shorten,
/// larger those that say nothing.
const MUCH: u32 = 16;

/// The largest |f| or |g| of a projected net's points.
#[inline(always)]
fn reach<F: Flat>(net: &[F]) -> F::Scalar {
    if F::RATIONAL {
        return net.iter().fold(F::Scalar::ZERO, |most, point| {
            let [f, g] = point.f_g();
            most.greater(f.abs().greater(g.abs()) / point.weight())
        });
    }
    // Two points at a time, so that one comparison need not wait for another.
    let mut most = [F::Scalar::ZERO; 4];
    let mut pairs = net.chunks_exact(2);
    let mut add = |points: [F; 2]| {
        let [[f, g], [h, i]] = points.map(Flat::f_g);
        most = [most[0].greater(f.abs()), most[1].greater(g.abs()), most[2].greater(h.abs()), most[3].greater(i.abs())];
    };
    for pair in &mut pairs {
        if let &[p, q] = pair {
            add([p, q]);
        }
    }
    pairs.remainder().iter().for_each(|&p| add([p, p]));
    most[0].greater(most[1]).greater(most[2].greater(most[3]))
}

/// The largest |f| or |g| of a net's points, if both take both signs, or nearly; if not, no point of the surface is on the ray.
#[inline(always)]
fn straddling<F: Flat>(net: &[F], error: F::Scalar) -> Option<F::Scalar> {
    let (mut low, mut high) = ([F::Scalar::INFINITY; 2], [F::Scalar::LEAST; 2]);
    for point in net {
        let f_g = point.f_g();
        // Of a rational net each coefficient is off by its own weight's share: one for all would drown what is light.
        let off = if F::RATIONAL { error * point.weight() } else { F::Scalar::ZERO };
        low = [low[0].lesser(f_g[0] - off), low[1].lesser(f_g[1] - off)];
        high = [high[0].greater(f_g[0] + off), high[1].greater(f_g[1] + off)];
    }
    let error = if F::RATIONAL { F::Scalar::ZERO } else { error };
    let straddles = low[0] <= error && low[1] <= error && high[0] >= -error && high[1] >= -error;
    if F::RATIONAL {
        return straddles.then(|| reach(net));
    }
    straddles.then(|| high[0].greater(high[1]).greater(-low[0]).greater(-low[1]))
}
