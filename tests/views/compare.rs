//! Whether two answers to one ray say the same.

use crate::adapters::Adapter;
use crate::allowances::Allowed;
use crate::answers::outcome;
use crate::common::{Kind, Prepared};
use crate::corpus::Case;
use crate::image::Seen;
use crate::rooms::InView;
use patchray_host::judge::{Agreement, Allowance, Truth, allowance};
use patchray_host::oracle::Oracle;
use patchray_host::scanline::{Found, Outcome};
use patchray_host::scene::rays::RayLine;
use patchray_host::scene::trace::Precision;

/// What tells answers to the rays of one case apart.
pub(crate) struct Judge<'c> {
    case: &'c Case,
    precision: Precision,
    oracle: Oracle,
    diagonal: f64,
}

impl<'c> Judge<'c> {
    pub(crate) fn new(case: &'c Case, precision: Precision) -> Self {
        let diagonal = case.model.control_box().expect("the case has points").diagonal();
        Judge { case, precision, oracle: Oracle::new(&case.model), diagonal }
    }

    /// Whether two answers differ: in kind, in t by more than each may be off, or in the surface elsewhere than on an edge. Rays
    /// whose answer rounding decides do not count; nor does on which of the sheets that cross within an allowance
    /// of each other a point lies.
    pub(crate) fn differ<P: Kind>(
        &self,
        prepared: &Prepared<P>,
        method: InView,
        ray: &RayLine,
        [one, other]: [&Seen<P::Scalar>; 2],
    ) -> bool {
        let (one, other) = (outcome(prepared, one), outcome(prepared, other));
        let allowed = Allowed::of(&Adapter { method: method.judged_as(), precision: self.precision }, self.case);
        let near = allowance(self.precision);
        let twice = Allowance { across: 2.0 * near.across.max(allowed.residual), most: 2.0 * near.most };
        let closest = match &one {
            Outcome::Hit(found) => Some(found.t),
            Outcome::Miss => None,
            _ => return true,
        };
        let as_truth = Truth { closest, margin: 1.0, ..Truth::default() };
        let mut agreement = Agreement::default();
        agreement.add(&other, &as_truth, ray.direction, self.diagonal, &twice);
        let same_surface = match (&one, &other) {
            (Outcome::Hit(one), Outcome::Hit(other)) => {
                one.surface == other.surface || (self.on_edge(one) && self.on_edge(other))
            }
            _ => true,
        };
        if agreement.right == 1 && same_surface {
            return false;
        }
        let verdict = self.oracle.trace(ray.origin, ray.direction, ray.t_min, ray.t_max);
        verdict.margin >= allowed.least_margin
    }

    fn on_edge(&self, found: &Found) -> bool {
        let near = match self.precision {
            Precision::F64 => 1e-9,
            Precision::F32 => 1e-3,
        };
        [found.u, found.v, 1.0 - found.u, 1.0 - found.v].iter().any(|&c| c < near)
    }
}
