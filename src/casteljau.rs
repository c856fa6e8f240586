//! De Casteljau's algorithm: the control net of a part of a surface.
//!
//! Source: G. Farin, "Curves and Surfaces for CAGD", the chapter on the de Casteljau algorithm.

use crate::bernstein::{Degrees, Direction, Linear};
use crate::parameter::Parameter;

/// The part of a net over [from, to] of one parameter, 0 ≤ from ≤ to ≤ 1, in place. A side at
/// the border of [0, 1] stays to the bit. A net that is too short for its degrees stays as it is in part.
#[inline(always)]
pub fn restrict<A: Parameter, T: Linear<A::Scalar>>(
    degrees: Degrees,
    net: &mut [T],
    direction: Direction,
    part: [A; 2],
) {
    if let (Degrees { u: 3, v: 3 }, Ok(net)) = (degrees, <&mut [T; 16]>::try_from(&mut *net)) {
        return restrict_unrolled::<A, T, 4, 16>(net, direction, part);
    }
    if let (Degrees { u: 2, v: 2 }, Ok(net)) = (degrees, <&mut [T; 9]>::try_from(&mut *net)) {
        return restrict_unrolled::<A, T, 3, 9>(net, direction, part);
    }
    let (rows, columns) = (degrees.rows(), degrees.columns());
    match direction {
        Direction::U => (0..columns).for_each(|column| restrict_line(net, column, columns, rows, part)),
        Direction::V => (0..rows).for_each(|row| restrict_line(net, row * columns, 1, columns, part)),
    }
}

/// [`restrict`] for an order known when compiling; `N` is `ORDER²`.
#[inline(always)]
fn restrict_unrolled<A: Parameter, T: Linear<A::Scalar>, const ORDER: usize, const N: usize>(
    net: &mut [T; N],
    direction: Direction,
    part: [A; 2],
) {
    const { assert!(ORDER * ORDER == N) }
    match direction {
        Direction::U => restrict_lines::<A, T, ORDER, N>(net, |line, k| k * ORDER + line, part),
        Direction::V => restrict_lines::<A, T, ORDER, N>(net, |line, k| line * ORDER + k, part),
    }
}

/// `ORDER` lines of as many points, of which `at` says where they are.
#[inline(always)]
fn restrict_lines<A: Parameter, T: Linear<A::Scalar>, const ORDER: usize, const N: usize>(
    net: &mut [T; N],
    at: impl Fn(usize, usize) -> usize,
    [from, to]: [A; 2],
) {
    if to != A::ONE {
        let (to, rest) = (to.number(), to.rest());
        for line in 0..ORDER {
            for level in 1..ORDER {
                for k in (level..ORDER).rev() {
                    net[at(line, k)] = net[at(line, k - 1)] * rest + net[at(line, k)] * to;
                }
            }
        }
    }
    if from != A::ZERO && A::ZERO.is_below(to) {
        let from = from.part_of(to);
        let (from, rest) = (from.number(), from.rest());
        for line in 0..ORDER {
            for level in 1..ORDER {
                for k in 0..ORDER - level {
                    net[at(line, k)] = net[at(line, k)] * rest + net[at(line, k + 1)] * from;
                }
            }
        }
    }
}

/// De Casteljau twice on `count` points, `stride` apart from `first` on: keep what is below `to`, then what is above
/// `from`.
fn restrict_line<A: Parameter, T: Linear<A::Scalar>>(
    points: &mut [T],
    first: usize,
    stride: usize,
    count: usize,
    [from, to]: [A; 2],
) {
    let at = |k: usize| first + k * stride;
    let mut blend = |low: usize, high: usize, into: usize, t: A| {
        if let (Some(&p), Some(&q)) = (points.get(at(low)), points.get(at(high))) {
            if let Some(slot) = points.get_mut(at(into)) {
                *slot = p * t.rest() + q * t.number();
            }
        }
    };
    if to != A::ONE {
        for level in 1..count {
            for k in (level..count).rev() {
                blend(k - 1, k, k, to);
            }
        }
    }
    if from != A::ZERO && A::ZERO.is_below(to) {
        let t = from.part_of(to);
        for level in 1..count {
            for k in 0..count - level {
                blend(k, k + 1, k, t);
            }
        }
    }
}
