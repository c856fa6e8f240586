//! What the suites forgive, and what they leave out: one table each, with reasons.

use crate::adapters::Adapter;
use crate::corpus::Case;
use patchray_host::scene::trace::Precision;

/// What an adapter may get wrong.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    /// Wrong or missed hits per million rays. Newton's methods lose one root of a pair where a ray nearly touches a patch.
    pub(crate) lost_per_million: f64,
    /// And as many on any number of rays, since few rays say little of a rate.
    pub(crate) lost_at_least: f64,
    /// |S(u, v) − (o + t d)| as a share of the diagonal, for every hit.
    pub(crate) residual: f64,
    /// Rays that change their answer when they move by less than this share of the diagonal are left out.
    pub(crate) least_margin: f64,
    /// The largest share of rays that may be left out so.
    pub(crate) unjudged: f64,
}

impl Allowed {
    /// The allowance.
    ///
    /// | precision | lost per million | residual | margin | why |
    /// | --- | --- | --- | --- | --- |
    /// | f64 | 50 | 1e-12 | 1e-12 | the last Newton step leaves at most 4e-13 of the frame, a quarter to twice the diagonal |
    /// | f32 | 100 | 2e-5 | 2e-5 | it leaves 4e-6; control points round by 6e-8 of the largest coordinate |
    pub(crate) fn of(adapter: &Adapter) -> Allowed {
        match adapter.precision {
            Precision::F64 => Allowed {
                lost_per_million: 50.0,
                lost_at_least: 1.0,
                residual: 1e-12,
                least_margin: 1e-12,
                unjudged: 0.001,
            },
            Precision::F32 => Allowed {
                lost_per_million: 100.0,
                lost_at_least: 2.0,
                residual: 2e-5,
                least_margin: 2e-5,
                unjudged: 0.02,
            },
        }
    }
}

/// The reason why an adapter is not run on a case; none is left out now.
pub(crate) fn skip(_adapter: &Adapter, _case: &Case) -> Option<&'static str> {
    None
}
