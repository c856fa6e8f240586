//! Proof that a domain holds no root: all Bernstein coefficients of a line combination have one sign.
//!
//! The ray meets the net's surface where both plane distances vanish, and by the convex-hull property it does not if some
//! line through the origin of the plane of distances has the whole net on one side (T. Nishita, T. W. Sederberg,
//! M. Kakimoto, 1990, section 3, with lines of any direction).

use super::real::Real;

/// The widest gap that a line leaves between a net and the ray.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gap {
    /// The distance of the net from the line, in lengths; 0 if no line separates.
    pub(super) width: f64,
    /// The net's extent in the same direction.
    pub(super) extent: f64,
}

/// The lines tried whatever the net looks like.
const FIXED: [[f64; 2]; 4] = [
    [1.0, 0.0],
    [0.0, 1.0],
    [std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2],
    [std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_1_SQRT_2],
];

/// The widest gap over the fixed lines and over those along each of `tangents`, the net's mean derivatives; the search
/// ends early at a gap of `enough`. `places` are the control points' two plane distances and depths, not homogeneous.
///
/// Lines along the tangents separate a nearly flat piece as its own edges would; where the surface folds over as seen
/// from the ray, both run along the fold, and no other line separates.
pub(super) fn widest_gap<R: Real>(places: &[[R; 3]], tangents: [[R; 2]; 2], enough: f64) -> Gap {
    let mut best = Gap::default();
    // Lines need not run exactly along a tangent.
    let along = tangents.map(|tangent| {
        let [x, y] = tangent.map(R::to_f64);
        let length = (x * x + y * y).sqrt();
        [-y / length, x / length]
    });
    for [x, y] in FIXED.into_iter().chain(along) {
        let (mut low, mut high) = (R::INFINITY, -R::INFINITY);
        for p in places {
            let d = p[0].times(x) + p[1].times(y);
            if d < low {
                low = d;
            }
            if d > high {
                high = d;
            }
        }
        // A zero tangent gives NaN throughout, which leaves low > high: no line.
        let width = if low > -high { low } else { -high }.to_f64();
        if low <= high && width > best.width {
            best = Gap { width, extent: high.less(low) };
            if width >= enough {
                break;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slanted_sliver_is_separated_along_its_own_edge() {
        let places = [[-10.0, -3.0, 0.0], [10.0, 3.1, 0.0], [-9.0, -2.6, 0.0], [11.0, 3.4, 0.0]];
        let blind = widest_gap(&places, [[0.0, 0.0]; 2], f64::INFINITY);
        assert_eq!(blind.width, 0.0);
        let gap = widest_gap(&places, [[20.0, 6.05], [1.0, 0.35]], f64::INFINITY);
        assert!(gap.width > 0.02 && gap.width < 0.03, "{gap:?}");
    }

    #[test]
    fn a_net_about_the_origin_has_no_gap() {
        let places = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(widest_gap(&places, [[2.0, 0.0], [0.0, 2.0]], 1.0).width, 0.0);
    }
}
