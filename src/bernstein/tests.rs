//! The parts of evaluation that the public face does not show apart.

use super::*;
use crate::parameter::{Number, Parameter};
use crate::point::{Plain, Point, Weighted};
use crate::surface::Net;
use patchray_host::scene::shapes::Random;

fn points<P: Point, const N: usize>(random: &mut Random) -> [P; N]
where
    Weighted<P::Scalar>: Into<P>,
{
    core::array::from_fn(|_| {
        let position = random.point(1.0).map(P::Scalar::from_f64);
        Weighted::new(position, P::Scalar::from_f64(random.within(0.25, 1.0))).into()
    })
}

impl<S: Scalar> From<Weighted<S>> for Plain<S> {
    fn from(point: Weighted<S>) -> Self {
        Plain(point.position())
    }
}

/// The unrolled shapes sum in another order than the loops, so they differ by a few roundings, and by no more.
fn unrolled<P: Point, const N: usize>(degree: usize)
where
    Weighted<P::Scalar>: Into<P>,
{
    let mut random = Random(1);
    let mut basis = Basis::<P::Scalar, 4>::new();
    let allowance = P::Scalar::EPSILON * P::Scalar::from_u32(8 * degree as u32);
    for round in 0..200 {
        let points = points::<P, N>(&mut random);
        let net = Net::new(degree, degree, &points).unwrap();
        let [u, v] = match round {
            0 => [0.0, 0.0],
            1 => [1.0, 0.0],
            2 => [1.0, 1.0],
            _ => [random.within(0.0, 1.0), random.within(0.0, 1.0)],
        }
        .map(P::Scalar::from_f64);
        let one = net.jet(u, v, &mut Basis::<P::Scalar, 0>::new().view()).unwrap();
        let other =
            jet_any_degree(net.degrees(), &points, [u, v].map(P::Parameter::new), &mut basis.view(), |p| p).unwrap();
        for (a, b) in [(one.point, other.point), (one.du, other.du), (one.dv, other.dv)] {
            let (p, q) = (a.weighted_position(), b.weighted_position());
            assert!((0..3).all(|k| (p[k] - q[k]).abs() <= allowance), "{u:?} {v:?}: {a:?} {b:?}");
            assert!((a.weight() - b.weight()).abs() <= allowance);
        }
        // At a corner both are the control point, to the bit.
        if round < 3 {
            assert_eq!(one.point, net.corners()[[0, 1, 3][round]]);
        }
    }
}

#[test]
fn unrolled_degrees_agree_with_the_loops() {
    unrolled::<Plain<f32>, 9>(2);
    unrolled::<Plain<f64>, 16>(3);
    unrolled::<Weighted<f32>, 16>(3);
    unrolled::<Weighted<f64>, 9>(2);
}

#[test]
fn bernstein_polynomials_of_any_degree_sum_to_one_and_their_derivatives_to_zero() {
    let mut out = heapless::Vec::<Terms<f64>, 16>::new();
    for degree in 1..=MAX_DEGREE {
        for t in [0.0, 0.125, 0.3, 0.5, 0.9, 1.0] {
            bernstein(degree, Number::new(t), &mut out).unwrap();
            assert_eq!(out.len(), degree + 1);
            for (k, expected) in [1.0, 0.0, 0.0].into_iter().enumerate() {
                let sum: f64 = out.iter().map(|terms| terms[k]).sum();
                assert!((sum - expected).abs() < 1e-13 * (degree * degree) as f64, "{degree} {t} {k}: {sum}");
            }
            // The curve with control points i / n is t, and that with i (i − 1) / (n (n − 1)) is t².
            let n = degree as f64;
            let along = |k: usize| out.iter().enumerate().map(|(i, terms)| i as f64 / n * terms[k]).sum::<f64>();
            assert!((along(0) - t).abs() < 1e-14 && (along(1) - 1.0).abs() < 1e-13 && along(2).abs() < 1e-12);
            if degree > 1 {
                let square = |i: usize| (i * i.saturating_sub(1)) as f64 / (n * (n - 1.0));
                let along = |k: usize| out.iter().enumerate().map(|(i, terms)| square(i) * terms[k]).sum::<f64>();
                assert!((along(0) - t * t).abs() < 1e-14);
                assert!((along(1) - 2.0 * t).abs() < 1e-13 && (along(2) - 2.0).abs() < 1e-12);
            }
        }
    }
    assert_eq!(bernstein(16, Number::new(0.5), &mut out), Err(Full));
}
