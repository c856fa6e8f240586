//! Repeated measurements: their median and spread, and gains of one over another.

use serde::Serialize;

/// How long each repetition took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Seconds of each repetition, in order.
    pub repetitions: Vec<f64>,
    /// Their median, in seconds.
    pub median: f64,
    /// From the first to the third quartile, as a share of the median.
    pub spread: f64,
}

impl Times {
    /// The times of these repetitions.
    pub fn of(repetitions: Vec<f64>) -> Self {
        let median = quantile(&repetitions, 0.5);
        let spread = (quantile(&repetitions, 0.75) - quantile(&repetitions, 0.25)) / median;
        Times { repetitions, median, spread }
    }

    /// By what share of `original` these are less. The two were measured in turn: it is the median of what each
    /// repetition says, since what else went on in the machine meanwhile disturbed both.
    pub fn gain_over(&self, original: &Times) -> f64 {
        let pairs = self.repetitions.iter().zip(&original.repetitions);
        1.0 - quantile(&pairs.map(|(own, other)| own / other).collect::<Vec<_>>(), 0.5)
    }
}

/// The value below which the share `share`, 0 to 1, of the numbers lies, straight between the two next to it; NaN of
/// none.
pub fn quantile(numbers: &[f64], share: f64) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * sorted.len().saturating_sub(1) as f64;
    let (below, part) = (place.floor(), place.fract());
    let Some(&low) = sorted.get(below as usize) else {
        return f64::NAN;
    };
    let high = sorted.get(below as usize + 1).copied().unwrap_or(low);
    low + part * (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_numbers() {
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
        assert_eq!(quantile(&[4.0, 1.0, 2.0, 3.0], 0.5), 2.5);
        assert_eq!(quantile(&[5.0, 1.0, 2.0, 4.0, 3.0], 0.25), 2.0);
        assert_eq!(quantile(&[7.0], 0.75), 7.0);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn median_and_spread() {
        let times = Times::of(vec![1.0, 9.0, 2.0, 3.0, 2.5]);
        assert_eq!((times.median, times.spread), (2.5, 0.4));
        assert_eq!(Times::of(vec![2.0]).spread, 0.0);
    }

    #[test]
    fn a_gain_compares_what_was_measured_together() {
        // The machine was half as fast in the second repetition: the gain is 20 % all the same.
        let (original, improved) = (Times::of(vec![10.0, 20.0, 10.0]), Times::of(vec![8.0, 16.0, 8.0]));
        assert!((improved.gain_over(&original) - 0.2).abs() < 1e-12);
        assert!((original.gain_over(&improved) + 0.25).abs() < 1e-12);
        assert_eq!(original.gain_over(&original), 0.0);
    }
}
