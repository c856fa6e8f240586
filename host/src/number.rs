//! Numbers as text that reads back to the same bits.
use std::fmt::{self, Display, LowerExp};

/// A number that prints as the shortest text which, read in the same precision, gives the same bits.
///
/// Rust's own `{}` does that too, but writes 1e300 with 300 zeros; outside 1e-5 to 1e17 this writes an exponent.
///
/// ```
/// use patchray_host::number::Shortest;
/// assert_eq!(Shortest(0.1_f32).to_string(), "0.1");
/// assert_eq!(Shortest(-1.5e300_f64).to_string(), "-1.5e300");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortest<T>(pub T);

impl<T: Number> Display for Shortest<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.into().abs();
        if size == 0.0 || !size.is_finite() || (1e-5..1e17).contains(&size) {
            Display::fmt(&self.0, f)
        } else {
            LowerExp::fmt(&self.0, f)
        }
    }
}

/// The numbers that files hold: `f32` and `f64`, each printed in its own precision.
pub trait Number: Copy + Display + LowerExp + Into<f64> {}

impl Number for f32 {}
impl Number for f64 {}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn short_where_it_can_be() {
        assert_eq!(Shortest(3.434075_f64).to_string(), "3.434075");
        assert_eq!(Shortest(-0.0_f64).to_string(), "-0");
        assert_eq!(Shortest(1e-5_f64).to_string(), "0.00001");
        assert_eq!(Shortest(9e-6_f64).to_string(), "9e-6");
        assert_eq!(Shortest(1e17_f64).to_string(), "1e17");
        assert_eq!(Shortest(f64::INFINITY).to_string(), "inf");
        assert_eq!(Shortest(5e-324_f64).to_string(), "5e-324");
    }

    proptest! {
        #[test]
        fn same_bits_f64(number in any::<f64>()) {
            let text = Shortest(number).to_string();
            prop_assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(number.to_bits()));
            prop_assert!(text.len() <= 25);
        }

        #[test]
        fn same_bits_f32(number in any::<f32>()) {
            let text = Shortest(number).to_string();
            prop_assert_eq!(text.parse::<f32>().map(f32::to_bits), Ok(number.to_bits()));
        }
    }
}
