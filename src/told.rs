//! A number that tells: it computes what the number in it does, to the bit, and passes on what searches tell their number
//! type; see [`story`](crate::story).

use crate::scalar::{Scalar, Vector3, sealed::Sealed};
use crate::story::Event;
use core::fmt::Debug;
use core::marker::PhantomData;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Who listens: a type without values of its own, since a number has no room for more.
pub trait Listener: Copy + Default + Debug + PartialEq + PartialOrd + Send + Sync + 'static {
    /// Is called with each event, in order, on the thread that searches.
    fn hear(event: Event);
}

/// A number that tells `L` what searches do that compute with it.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[repr(transparent)]
pub struct Told<S, L>(S, PhantomData<L>);

/// A vector of such numbers.
#[derive(Clone, Copy, Debug)]
pub struct ToldVector<S: Scalar, L>(S::Vec3, PhantomData<L>);

impl<S, L> Told<S, L> {
    /// The number that tells and is this one.
    pub const fn new(number: S) -> Self {
        Told(number, PhantomData)
    }
}

impl<S, L> Sealed for Told<S, L> {}

macro_rules! operators {
    ($($operator:ident $method:ident)*) => {
        $(impl<S: Scalar, L: Listener> $operator for Told<S, L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Told::new(self.0.$method(other.0))
            }
        })*
    };
}
operators!(Add add Sub sub Mul mul Div div);

impl<S: Scalar, L: Listener> Neg for Told<S, L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Told::new(-self.0)
    }
}

impl<S: Scalar, L: Listener> AddAssign for Told<S, L> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl<S: Scalar, L: Listener> Scalar for Told<S, L> {
    type Vec3 = ToldVector<S, L>;

    const ZERO: Self = Told::new(S::ZERO);
    const HALF: Self = Told::new(S::HALF);
    const ONE: Self = Told::new(S::ONE);
    const TWO: Self = Told::new(S::TWO);
    const INFINITY: Self = Told::new(S::INFINITY);
    const LEAST: Self = Told::new(S::LEAST);
    const EPSILON: Self = Told::new(S::EPSILON);
    const MAX: Self = Told::new(S::MAX);
    const MIN_POSITIVE: Self = Told::new(S::MIN_POSITIVE);
    const MAX_SCALE: i32 = S::MAX_SCALE;
    const TOLERANCE: Self = Told::new(S::TOLERANCE);

    fn from_f64(value: f64) -> Self {
        Told::new(S::from_f64(value))
    }
    fn from_f32(value: f32) -> Self {
        Told::new(S::from_f32(value))
    }
    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }
    fn from_u32(value: u32) -> Self {
        Told::new(S::from_u32(value))
    }
    fn to_u32(self) -> u32 {
        self.0.to_u32()
    }
    fn abs(self) -> Self {
        Told::new(self.0.abs())
    }
    fn sqrt(self) -> Self {
        Told::new(self.0.sqrt())
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn times_power_of_two(self, exponent: i32) -> Self {
        Told::new(self.0.times_power_of_two(exponent))
    }
    fn binary_exponent(self) -> i32 {
        self.0.binary_exponent()
    }
    fn tell(event: impl FnOnce() -> Event) {
        L::hear(event());
    }
}

impl<S: Scalar, L: Listener> Add for ToldVector<S, L> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        ToldVector(self.0 + other.0, PhantomData)
    }
}

impl<S: Scalar, L: Listener> Sub for ToldVector<S, L> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        ToldVector(self.0 - other.0, PhantomData)
    }
}

impl<S: Scalar, L: Listener> Neg for ToldVector<S, L> {
    type Output = Self;
    fn neg(self) -> Self {
        ToldVector(-self.0, PhantomData)
    }
}

impl<S: Scalar, L: Listener> Mul<Told<S, L>> for ToldVector<S, L> {
    type Output = Self;
    fn mul(self, factor: Told<S, L>) -> Self {
        ToldVector(self.0 * factor.0, PhantomData)
    }
}

impl<S: Scalar, L: Listener> Vector3 for ToldVector<S, L> {
    type Scalar = Told<S, L>;
    const ZERO: Self = ToldVector(S::Vec3::ZERO, PhantomData);

    fn from_array(components: [Told<S, L>; 3]) -> Self {
        ToldVector(S::Vec3::from_array(components.map(|c| c.0)), PhantomData)
    }
    fn to_array(self) -> [Told<S, L>; 3] {
        self.0.to_array().map(Told::new)
    }
    fn dot(self, other: Self) -> Told<S, L> {
        Told::new(self.0.dot(other.0))
    }
    fn cross(self, other: Self) -> Self {
        ToldVector(self.0.cross(other.0), PhantomData)
    }
    fn abs(self) -> Self {
        ToldVector(self.0.abs(), PhantomData)
    }
}
