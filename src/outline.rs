//! Where in a view's image something can be seen: an octagon around it.
//!
//! Image coordinates (x, y) are those of [`Camera`](crate::view::Camera): what a ray's direction adds of `right` and of `up`.

use crate::scalar::Scalar;

/// An octagon with sides across x, y, x + y and x − y: tight enough around what is seen of a flat box, and where a row of the
/// image crosses it costs six additions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Outline<S> {
    /// The least x, y, x + y and x − y.
    low: [S; 4],
    /// The largest ones.
    high: [S; 4],
}

impl<S: Scalar> Outline<S> {
    /// What a slot holds before it is filled: zeros, of which static memory takes no flash.
    pub(crate) const EMPTY: Self = Outline { low: [S::ZERO; 4], high: [S::ZERO; 4] };

    /// Around nothing.
    pub const NOWHERE: Self = Outline { low: [S::INFINITY; 4], high: [S::LEAST; 4] };

    /// The whole image, however large.
    pub const EVERYWHERE: Self = Outline { low: [S::LEAST; 4], high: [S::INFINITY; 4] };

    /// The smallest octagon that also holds all points that lie no farther than `margin` from `point` in x and in y.
    #[must_use]
    #[inline]
    pub fn with(self, point: [S; 2], margin: S) -> Self {
        let [x, y] = point;
        let mut grown = self;
        // Sums have twice the margin, and round once more.
        for (k, (sum, margin)) in
            [(x, margin), (y, margin), (x + y, margin + margin), (x - y, margin + margin)].into_iter().enumerate()
        {
            grown.low[k] = grown.low[k].lesser(sum - margin);
            grown.high[k] = grown.high[k].greater(sum + margin);
        }
        grown
    }

    /// The least and the largest y of it.
    pub fn rows(&self) -> [S; 2] {
        [self.low[1], self.high[1]]
    }

    /// The least and the largest x of its part between two values of y; `None` if it has none.
    #[inline(always)]
    pub fn across(&self, rows: [S; 2]) -> Option<[S; 2]> {
        let Outline { low, high } = self;
        let [from, to] = [rows[0].greater(low[1]), rows[1].lesser(high[1])];
        let least = low[0].greater(low[2] - to).greater(low[3] + from);
        let largest = high[0].lesser(high[2] - from).lesser(high[3] + to);
        if from <= to && least <= largest { Some([least, largest]) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_crosses_what_it_should() {
        // A square on its corner.
        let diamond = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
            .into_iter()
            .fold(Outline::NOWHERE, |all: Outline<f64>, p| all.with(p, 0.0));
        assert_eq!(diamond.across([0.5, 0.5]), Some([-0.5, 0.5]));
        assert_eq!(diamond.across([-0.75, -0.5]), Some([-0.5, 0.5]));
        assert_eq!(diamond.across([-5.0, 5.0]), Some([-1.0, 1.0]));
        assert_eq!(diamond.across([1.1, 2.0]), None);
        assert_eq!(Outline::<f64>::NOWHERE.across([-1.0, 1.0]), None);
        assert_eq!(Outline::<f64>::EVERYWHERE.across([-1.0, 1.0]), Some([f64::NEG_INFINITY, f64::INFINITY]));
    }
}
