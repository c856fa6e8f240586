//! A hash over bits: FNV-1a, 64 bits.

use patchray::limits::{GaveUp, Work};
use patchray::ray::Hit;
use patchray::scalar::Scalar;

/// What a method answers to a ray.
pub type Answer<S> = Result<Option<Hit<S>>, GaveUp<S>>;

/// A hash that goes on from ray to ray.
#[derive(Clone, Copy, Debug)]
pub struct Hash(pub u64);

impl Hash {
    /// Of nothing.
    pub const NOTHING: Self = Hash(0xcbf2_9ce4_8422_2325);

    fn add(&mut self, number: u64) {
        for byte in number.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }

    /// Adds t, u, v and surface of a hit; of a ray without one, which kind of answer it was.
    pub fn add_answer<S: Scalar>(&mut self, answer: &Answer<S>) {
        match answer {
            Ok(Some(hit)) => {
                self.add(1);
                // Exact in either precision, and the sign of zero is kept. No hit holds NaN, whose sign differs by machine.
                for number in [hit.t, hit.u, hit.v] {
                    self.add(number.to_f64().to_bits());
                }
                self.add(u64::from(hit.surface));
            }
            Ok(None) => self.add(0),
            Err(GaveUp { limit, .. }) => self.add(2 + *limit as u64),
        }
    }

    /// Adds all counters.
    pub fn add_work(&mut self, work: &Work) {
        for count in work.counts() {
            self.add(u64::from(count));
        }
    }
}
