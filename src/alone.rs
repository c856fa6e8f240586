//! The proof that around a root there is no other.

use crate::local::Local;
use crate::parameter::Parameter;
use crate::point::Flat;
use crate::root::Root;
use crate::scalar::Scalar;

/// A root around which no other can lie: how near is told by the surface's derivatives near the root and by how much they can
/// change.
///
/// With δ the way from the root to another one, J the Jacobian at a point that lies off the root by σ, and b the bounds of
/// [`Net::bend`](crate::surface::Net::bend), Taylor's theorem gives |J δ| ≤ (b₀ (|δ_u| + 2 σ_u) + b₁ σ_v) |δ_u| + (b₁ (|δ_u| + σ_u) +
/// b₂ (|δ_v| + 2 σ_v)) |δ_v|. Let the brackets be at most α and β. With |δ| ≤ (a, b) · |J δ|, where a and b are the row sums of |J⁻¹|, this is
/// |J δ| ≤ (a α + b β) |J δ|: so where a α + b β < 1, there is no δ but 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Alone<A: Parameter> {
    root: [A; 2],
    /// σ.
    off: [A::Scalar; 2],
    /// a and b.
    inverse: [A::Scalar; 2],
    bend: [A::Scalar; 3],
}

impl<S: Scalar, A: Parameter<Scalar = S>> Alone<A> {
    /// Of a root on a surface, near which `local` holds.
    #[inline(always)]
    pub(crate) fn new<F: Flat<Scalar = S, Parameter = A>>(
        root: &Root<A>,
        local: &Local<A>,
        bend: [S; 3],
        reach: S,
    ) -> Self {
        let (root, [u, v]) = ([root.u, root.v], local.at);
        let off = [root[0].minus(u).abs(), root[1].minus(v).abs()];
        // A Jacobian that may be all rounding says nothing.
        let one = if local.may_be_singular(reach) { S::INFINITY } else { S::ONE };
        // The bounds of what bends are times the weight.
        Alone { root, off, inverse: local.inverse_bounds(local.unweighted::<F>(one)), bend }
    }

    /// Whether it is proved that no other root lies in a rectangle of the surface's domain. A NaN proves nothing.
    #[inline(always)]
    pub(crate) fn within(&self, [[u0, u1], [v0, v1]]: [[S; 2]; 2]) -> bool {
        let Alone { root, off: [off_u, off_v], inverse: [a, b], bend: [uu, uv, vv] } = *self;
        // A distance in parameters may be told by one number to what a bound allows for.
        let [u, v] = root.map(Parameter::number);
        // The farther of two sides, without a branch that nothing could foretell.
        let farther = |t: S, low: S, high: S| (t - (low + high) * S::HALF).abs() + (high - low) * S::HALF;
        let (far_u, far_v) = (farther(u, u0, u1), farther(v, v0, v1));
        let alpha = uu * (far_u + off_u + off_u) + uv * off_v;
        let beta = uv * (far_u + off_u) + vv * (far_v + off_v + off_v);
        a * alpha + b * beta < S::from_f64(0.999)
    }
}
