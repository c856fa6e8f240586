//! What the suites forgive, and what they leave out: one table each, with reasons.

use crate::adapters::Adapter;
use crate::corpus::Case;
use patchray_host::scene::trace::{Method, Precision};

/// How many rays of a batch may be of a kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rate {
    /// Rays per million.
    pub(crate) per_million: f64,
    /// And as many of any number of rays, since few rays say little of a rate.
    pub(crate) at_least: f64,
}

impl Rate {
    /// Whether `count` of `rays` are not too many.
    pub(crate) fn allows(&self, count: u64, rays: usize) -> bool {
        count as f64 <= self.per_million * rays as f64 * 1e-6 + self.at_least
    }
}

/// What an adapter may get wrong in a case.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    /// Wrong or missed hits.
    pub(crate) lost: Rate,
    /// Rays given up.
    pub(crate) unanswered: Rate,
    /// |S(u, v) − (o + t d)| as a share of the diagonal, for every hit.
    pub(crate) residual: f64,
    /// Rays that change their answer when they move by less than this share of the diagonal are left out.
    pub(crate) least_margin: f64,
    /// The largest share of rays that may be left out so.
    pub(crate) unjudged: f64,
}

/// Wrong, missed or phantom hits of the 262,144 rays of the common view, none of which is left out.
///
/// | method | precision | most | why |
/// | --- | --- | --- | --- |
/// | newton | f64 | 12 | one root of a pair on one patch; 4 and 2 are seen |
/// | newton | f32 | 20 | the same, and rounding tells fewer pairs apart; 6 and 4 are seen |
/// | clipping | f64 | 0 | it finds all roots, and no testing ray is wrong there |
/// | clipping | f32 | 8 | grazes on silhouettes, which f64 sees pass the surface by; 7 and 7 are seen |
pub(crate) fn in_common_view(adapter: &Adapter) -> u64 {
    match (adapter.method, adapter.precision) {
        (Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted, Precision::F64) => 12,
        (Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted, Precision::F32) => 20,
        (Method::Clipping | Method::ClippingCoherent | Method::ClippingPredicted, Precision::F64) => 0,
        (Method::Clipping | Method::ClippingCoherent | Method::ClippingPredicted, Precision::F32) => 8,
    }
}

impl Allowed {
    /// The allowance.
    ///
    /// | method | precision | lost per million | given up per million | why |
    /// | --- | --- | --- | --- | --- |
    /// | newton | f64 | 50 | 0 | one root of a pair is lost where a ray nearly touches a patch |
    /// | newton | f32 | 100 | 0 | the same, and rounding tells fewer pairs apart |
    /// | clipping | f64 | 0 | 0 | it finds all roots |
    /// | clipping-coherent | f64 | 50 | 50 | eq. (1) does not flag every ray that meets a patch twice; domains that lie apart wait longer than those of a stack |
    /// | clipping | f32 | 100 | 50 | u and v settle within what rounding may have done to the net, which is more than Newton's method leaves |
    ///
    /// | precision | residual | margin | why |
    /// | --- | --- | --- | --- |
    /// | f64 | 1e-12 | 1e-12 | the last Newton step leaves at most 4e-13 of the frame, a quarter to twice the diagonal |
    /// | f32 | 2e-5 | 2e-5 | it leaves 4e-6; control points round by 6e-8 of the largest coordinate |
    /// | f32, clipping | 4e-5 | 2e-5 | as above, and the error of a projected net; 1.8e-5 is seen |
    ///
    /// And of the clipping methods, in single cases:
    ///
    /// | case | precision | allowed | why |
    /// | --- | --- | --- | --- |
    /// | flat | either | 300 per million given up | less than a thousandth of a radian off the plane, the lines of both clips are parallel to rounding, and regions are bisected until a budget ends it |
    /// | flat | f32 | 2,000 per million lost, residual 1e-4 | the same rays |
    /// | bumpy 15 x 15 | f32 | 2,000 per million lost, residual 3e-4 | what rounding may have done to a net grows with the degree |
    pub(crate) fn of(adapter: &Adapter, case: &Case) -> Allowed {
        let rate = |per_million: f64| Rate { per_million, at_least: per_million / 50.0 };
        let (lost, unanswered) = match (adapter.method, adapter.precision) {
            (Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted, Precision::F64) => (50.0, 0.0),
            (Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted, Precision::F32) => (100.0, 0.0),
            (Method::Clipping, Precision::F64) => (0.0, 0.0),
            (Method::ClippingCoherent | Method::ClippingPredicted, Precision::F64) => (50.0, 50.0),
            (Method::Clipping | Method::ClippingCoherent | Method::ClippingPredicted, Precision::F32) => (100.0, 50.0),
        };
        let (residual, least_margin, unjudged) = match adapter.precision {
            Precision::F64 => (1e-12, 1e-12, 0.001),
            Precision::F32 => (2e-5, 2e-5, 0.02),
        };
        let usual = Allowed { lost: rate(lost), unanswered: rate(unanswered), residual, least_margin, unjudged };
        match (adapter.method, adapter.precision, case.name) {
            (Method::Newton | Method::NewtonCoherent | Method::NewtonPredicted, ..) => usual,
            (_, Precision::F64, "flat disc" | "flat bicubic") => Allowed { unanswered: rate(300.0), ..usual },
            (_, Precision::F64, _) => usual,
            (_, Precision::F32, "flat disc" | "flat bicubic") => {
                Allowed { lost: rate(2000.0), unanswered: rate(300.0), residual: 1e-4, ..usual }
            }
            (_, Precision::F32, "bumpy 15 x 15") => Allowed { lost: rate(2000.0), residual: 3e-4, ..usual },
            (_, Precision::F32, _) => Allowed { residual: 4e-5, ..usual },
        }
    }
}

/// The reason why an adapter is not run on a case; none is left out now.
pub(crate) fn skip(_adapter: &Adapter, _case: &Case) -> Option<&'static str> {
    None
}
