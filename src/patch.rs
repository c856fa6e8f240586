//! A patch: a nearly flat piece of a surface, its parallelogram, its enclosing parallelepiped, and the ray tests on them.
//!
//! Source: W. Barth and W. Stürzlinger, "Efficient ray tracing for Bézier and B-spline surfaces", Computers & Graphics
//! 17(4), 1993; section "Barth and Stürzlinger's Algorithm" of the paper. How the parallelepiped is chosen and tested is
//! ours:
//!
//! v1 and v2 are the means of opposite edges' chords, v3 their cross product. The box is centred on the parallelogram in
//! v1 and v2 and encloses all control points, so by the convex-hull property (weights > 0) it encloses the patch. The box
//! is kept as centre and half edges e1, e2, e3. In the system of a ray's two planes the ray is a point, 0, and the box a
//! hexagon, whose sides are parallel to the projected e1, e2, e3: 0 lies inside exactly if, for each of the three,
//! |c × e_i| ≤ Σ_j |e_j × e_i|. No division, and an edge-on or flat box needs no special case. The same cross products
//! give eq. (1), the point where the ray meets the parallelogram, and where it enters and leaves the box.

use crate::frame::Aabb;
use crate::planes::{CENTRE, Columns, DepthRange, Planes};
use crate::scalar::{Scalar, Vector3};
use crate::surface::{Net, Point, SHEAR};

/// How often a surface may be halved in each direction: domains are then exact in both number types, and fit 16 bits.
pub const MAX_LEVEL: u32 = 14;

/// Below this sine of the angle between v1 and v2 the shorter is replaced by one orthogonal to the longer. Padding a box
/// by ρ lengthens its edges by ρ over this sine, so smaller values make slivers fatter; larger ones spoil the starts on
/// sheared patches.
const LEAST_SINE: f64 = 0.05;

/// A part of a surface's domain by repeated halving: `[i, i + 1] / 2^level` in each direction, held as `2^level + i`.
/// Half-open, but for the last one, so that each (u, v) lies in exactly one patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Domain {
    u: u16,
    /// The top bit marks a patch that is not flat: it was kept because the depth ran out.
    v: u16,
}

const ROUGH: u16 = 1 << 15;

impl Domain {
    /// The whole surface.
    pub const WHOLE: Self = Domain { u: 1, v: 1 };

    /// How often it was halved in u and in v.
    pub fn levels(self) -> [u32; 2] {
        [self.u, self.v & !ROUGH].map(level)
    }

    /// The halves in u, or in v.
    pub(crate) fn halves(self, along_u: bool) -> [Self; 2] {
        let Domain { u, v } = self;
        [0, 1].map(|side| if along_u { Domain { u: u << 1 | side, v } } else { Domain { u, v: v << 1 | side } })
    }

    /// The same domain, marked as not flat.
    pub(crate) fn rough(self) -> Self {
        Domain { u: self.u, v: self.v | ROUGH }
    }

    /// Whether the patch is not flat: then every ray counts as critical there.
    #[inline(always)]
    pub fn is_rough(self) -> bool {
        self.v & ROUGH != 0
    }

    /// `[u0, u1]` and `[v0, v1]`, exact.
    pub fn bounds<S: Scalar>(self) -> [[S; 2]; 2] {
        [self.u, self.v & !ROUGH].map(|index| {
            let scale = S::ONE.times_power_of_two(-(level(index) as i32));
            let first = u32::from(index) - (1 << level(index));
            [S::from_u32(first) * scale, S::from_u32(first + 1) * scale]
        })
    }

    /// Whether it holds (u, v); exactly one domain of a subdivision does, for any (u, v) in [0, 1]².
    #[inline]
    pub fn holds<S: Scalar>(self, u: S, v: S) -> bool {
        // The finest interval that holds the parameter, then its ancestor at this domain's level.
        let cells = 1_u32 << MAX_LEVEL;
        let ancestor = |t: S, index: u16| {
            let cell = (t * S::from_u32(cells)).to_u32().min(cells - 1);
            (cells | cell) >> (MAX_LEVEL - level(index).min(MAX_LEVEL)) == u32::from(index)
        };
        ancestor(u, self.u) && ancestor(v, self.v & !ROUGH)
    }

    /// The parameters at (a, b) of the local coordinates, −1 to 1 across the domain.
    #[inline(always)]
    fn parameters<S: Scalar>(self, a: S, b: S) -> [S; 2] {
        let at = |local: S, index: u16| {
            let width = width::<S>(index);
            // Index i of 2^level at the middle of its interval: (i + 1/2) · width − 1, the leading bit's 1.
            (S::from_u32(u32::from(index)) + S::HALF * (local + S::ONE)) * width - S::ONE
        };
        [at(a, self.u), at(b, self.v & !ROUGH)]
    }
}

#[inline(always)]
fn level(index: u16) -> u32 {
    15_u32.saturating_sub(index.leading_zeros())
}

/// 2^−level.
#[inline(always)]
fn width<S: Scalar>(index: u16) -> S {
    // A power of two of at most 2^15 converts exactly, and so does its quotient.
    S::ONE / S::from_u32(1 << level(index))
}

/// A box with skew sides: centre ± e1 ± e2 ± e3, in the frame; e1, e2, e3 are along v1, v2 and v1 × v2.
///
/// For each coordinate axis the four numbers e1, e2, centre, e3 stand together, in this order: the ray test multiplies the
/// four of the ray's steepest axis by one slope and subtracts them from the four of another, and then multiplies the pair
/// (e1, e2) by one number each of the pair (centre, e3). Vector units take them two or four at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Parallelepiped<S> {
    axes: [[S; 4]; 3],
}

/// A patch as a slot of lent memory: 64 bytes in `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Patch<S> {
    bounds: Parallelepiped<S>,
    /// The most by which derivatives stray from the parallelogram's sides: see [`Patch::at_most_once`].
    stray: S,
    /// How many times longer the box is than the parallelogram, along v1 and v2, in steps of 1 / [`SIDE_STEPS`]: good for
    /// a start, not for a proof.
    sides: [u16; 2],
    domain: Domain,
}

const SIDE_STEPS: u32 = 2048;

/// How a ray passes a box: the projected parts and their cross products.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<S> {
    /// Of e1 and e2: |f| + |g|.
    lengths: [S; 2],
    /// Depths of e1, e2, the centre and e3.
    depths: [S; 4],
    /// e2 × e3, e3 × e1, e1 × e2: the ray's direction in the box's coordinates, up to a factor.
    along: [S; 3],
    /// centre × e1, e2, e3.
    offset: [S; 3],
}

/// A patch whose box a ray meets, and how.
pub type Met<'m, S> = (&'m Patch<S>, Crossing<S>);

/// Where a ray enters or leaves a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pierce<S> {
    /// Coordinates along e1 and e2, −1 to 1.
    local: [S; 2],
    /// Depth along the ray.
    pub depth: S,
}

impl<S: Scalar> Parallelepiped<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self = Parallelepiped { axes: [[S::ZERO; 4]; 3] };

    fn new(centre: S::Vec3, edges: [S::Vec3; 3]) -> Self {
        let [c, e1, e2, e3] = [centre, edges[0], edges[1], edges[2]].map(Vector3::to_array);
        Parallelepiped { axes: core::array::from_fn(|k| [e1[k], e2[k], c[k], e3[k]]) }
    }

    /// Whether a ray, as a whole line, meets the box; and how.
    #[inline(always)]
    pub fn crossing(&self, planes: &Planes<S>) -> Option<Crossing<S>> {
        let Columns { f, g, depth } = planes.columns(&self.axes);
        let [f1, f2, fc, f3] = f;
        let [g1, g2, gc, g3] = g;
        // c × e1 and c × e2; e3 × e1 and e3 × e2; then e1 × e2 and c × e3.
        let [o1, o2] = [fc * g1 - gc * f1, fc * g2 - gc * f2];
        let [t1, t2] = [f3 * g1 - g3 * f1, f3 * g2 - g3 * f2];
        let (n3, o3) = (f1 * g2 - f2 * g1, fc * g3 - f3 * gc);
        let a3 = n3.abs();
        // A NaN, from lent memory that nobody filled, fails all three.
        let inside = (o1.abs() <= t1.abs() + a3) & (o2.abs() <= t2.abs() + a3) & (o3.abs() <= t1.abs() + t2.abs());
        if inside {
            let lengths = [f1.abs() + g1.abs(), f2.abs() + g2.abs()];
            Some(Crossing { lengths, depths: depth, along: [-t2, t1, n3], offset: [o1, o2, o3] })
        } else {
            None
        }
    }

    /// Whether a ray, as a whole line, meets the box.
    #[inline(always)]
    pub fn met(&self, planes: &Planes<S>) -> bool {
        self.crossing(planes).is_some()
    }

    /// The box along the axes around it.
    pub fn aabb(&self) -> Aabb<S> {
        let reach = self.axes.map(|[e1, e2, _, e3]| e1.abs() + e2.abs() + e3.abs());
        Aabb {
            low: core::array::from_fn(|k| self.axes[k][CENTRE] - reach[k]),
            high: core::array::from_fn(|k| self.axes[k][CENTRE] + reach[k]),
        }
    }
}

impl<S: Scalar> Crossing<S> {
    /// Whether the box's depths overlap a range; coarse, but never wrong when it says no.
    #[inline(always)]
    pub fn overlaps(&self, range: &DepthRange<S>) -> bool {
        let [e1, e2, centre, e3] = self.depths;
        let reach = e1.abs() + e2.abs() + e3.abs();
        centre - reach <= range.max && centre + reach >= range.min
    }

    /// Eq. (1) of the paper, tan α > f · b/h: the ray passes nearly parallel to the box's larger face.
    ///
    /// Ours to choose, since the paper does not say: α is the angle between ray and v3, h the box's thickness along v3, b
    /// the chord of its larger face through the centre along the ray. Then tan α > b/h says that a ray through the
    /// centre enters and leaves through the box's narrow sides; in the box's coordinates the ray's direction is `along`.
    #[inline(always)]
    pub fn critical(&self, factor: S) -> bool {
        let [n1, n2, n3] = self.along.map(S::abs);
        n1.greater(n2) > factor * n3
    }

    /// Entrance and exit, `None` if rounding leaves no stretch inside.
    #[inline]
    pub fn pierces(&self) -> Option<[Pierce<S>; 2]> {
        let [n1, n2, n3] = self.along;
        let [c1, c2, c3] = self.offset;
        // A point of the line in the box's coordinates, where its fastest coordinate is 0 (Cramer's rule).
        let (base, fastest) = if n3.abs() >= n1.abs() && n3.abs() >= n2.abs() {
            ([-c2 / n3, c1 / n3, S::ZERO], n3)
        } else if n1.abs() >= n2.abs() {
            ([S::ZERO, -c3 / n1, c2 / n1], n1)
        } else {
            ([c3 / n2, S::ZERO, -c1 / n2], n2)
        };
        let step = self.along.map(|n| n / fastest);
        let (mut first, mut last) = (-S::INFINITY, S::INFINITY);
        for k in 0..3 {
            if step[k] == S::ZERO {
                continue;
            }
            let inverse = S::ONE / step[k];
            let (a, b) = ((-S::ONE - base[k]) * inverse, (S::ONE - base[k]) * inverse);
            first = first.greater(a.lesser(b));
            last = last.lesser(b.greater(a));
        }
        if !(first > -S::INFINITY && last < S::INFINITY) {
            return None;
        }
        // The hexagon test let a ray at a corner through: take the middle of the inverted stretch.
        if first > last {
            first = (first + last) * S::HALF;
            last = first;
        }
        let at = |s: S| {
            let place: [S; 3] = core::array::from_fn(|k| base[k] + step[k] * s);
            let [e1, e2, centre, e3] = self.depths;
            let depth = centre + place[0] * e1 + place[1] * e2 + place[2] * e3;
            Pierce { local: [place[0], place[1]], depth }
        };
        let (a, b) = (at(first), at(last));
        Some(if a.depth <= b.depth { [a, b] } else { [b, a] })
    }
}

impl<S: Scalar> Patch<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self =
        Patch { bounds: Parallelepiped::EMPTY, stray: S::ZERO, sides: [0; 2], domain: Domain::WHOLE };

    /// The enclosing parallelepiped.
    pub fn bounds(&self) -> &Parallelepiped<S> {
        &self.bounds
    }

    /// The parameter domain.
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// Whether the ray may meet the patch more than once, by eq. (1) with this factor.
    #[inline(always)]
    pub fn is_critical(&self, crossing: &Crossing<S>, factor: S) -> bool {
        self.domain.is_rough() || crossing.critical(factor)
    }

    /// Whether it is proved that the ray, as a line, meets the patch at most once.
    ///
    /// With J the Jacobian of the projected patch and M = [v1 v2] that of the parallelogram, M⁻¹J is strictly diagonally
    /// dominant all over the patch where (|S_u − v1| + |S_v − v2|) · |v_k| < |v1 × v2| for k = 1, 2, in projected lengths.
    /// Its principal minors are then positive, and the projection is injective on the rectangle (D. Gale and H. Nikaido,
    /// "The Jacobian matrix and global univalence of mappings", Math. Annalen 159, 1965). `stray` holds the bracket, for
    /// polynomial surfaces; for rational ones it is infinite.
    #[inline(always)]
    pub fn at_most_once(&self, crossing: &Crossing<S>) -> bool {
        let [e1, e2] = crossing.lengths;
        !self.domain.is_rough() && self.stray * e1.greater(e2) < crossing.along[2].abs()
    }

    /// Start: where the ray meets the parallelogram's plane, held within the box. `None` edge on.
    ///
    /// The parallelogram is taken in the middle between the box's faces (ours): the patch strays from it to both sides by
    /// half of what it strays from the plane of its corners to one.
    #[inline(always)]
    pub fn parallelogram(&self, crossing: &Crossing<S>) -> Option<[S; 2]> {
        let n3 = crossing.along[2];
        let [c1, c2, _] = crossing.offset;
        if n3 == S::ZERO {
            return None;
        }
        let inverse = S::ONE / n3;
        let (a, b) = (-c2 * inverse, c1 * inverse);
        if !(a.is_finite() && b.is_finite()) {
            return None;
        }
        Some(self.parameters([a.clamped(-S::ONE, S::ONE), b.clamped(-S::ONE, S::ONE)]))
    }

    /// The surface's parameters at a place in the box, by the parallelogram.
    #[inline(always)]
    pub fn at(&self, pierce: &Pierce<S>) -> [S; 2] {
        self.parameters(pierce.local)
    }

    #[inline(always)]
    fn parameters(&self, local: [S; 2]) -> [S; 2] {
        let step = S::ONE / S::from_u32(SIDE_STEPS);
        let side = |k: usize| S::from_u32(u32::from(self.sides[k])) * step;
        self.domain.parameters(local[0] * side(0), local[1] * side(1))
    }
}

/// A net's piece, measured: what subdivision decides by, and what it stores.
#[derive(Clone, Copy, Debug)]
pub struct Measure<S> {
    /// The enclosing parallelepiped.
    pub bounds: Parallelepiped<S>,
    /// A bound of the distance between chord and surface along u, from second differences; of a rational net an estimate.
    pub bend_u: S,
    /// The same along v.
    pub bend_v: S,
    /// How far the corners are from a parallelogram's.
    pub twist: S,
    /// Lengths of v1 and v2.
    pub sides: [S; 2],
    stray: S,
    ratios: [S; 2],
}

impl<S: Scalar> Measure<S> {
    /// Measures a net: the control points of one piece of a surface, in the frame. `padding` is a length: by how much the
    /// box is larger than what it encloses, all around.
    pub fn of<P: Point<Scalar = S>>(net: &Net<'_, P>, padding: S) -> Self {
        let vector = |p: P| S::Vec3::from_array(p.position());
        let [p00, p10, p01, p11] = net.corners().map(vector);
        let centre = (p00 + p10 + p01 + p11) * S::from_f64(0.25);
        let v1 = (p10 - p00 + (p11 - p01)) * S::HALF;
        let v2 = (p01 - p00 + (p11 - p10)) * S::HALF;
        let (f1, f2, n, skewed) = edges(v1, v2);
        // Coordinates along f1 and f2 by the dual basis; n is a unit vector across both.
        let (across1, across2) = (f2.cross(n), n.cross(f1));
        let (dual1, dual2) = (across1 * (S::ONE / f1.dot(across1)), across2 * (S::ONE / f2.dot(across2)));
        let [mut a1, mut a2] = [S::ZERO; 2];
        let (mut low, mut high) = (S::INFINITY, -S::INFINITY);
        for &p in net.points() {
            let q = vector(p) - centre;
            a1 = a1.greater(q.dot(dual1).abs());
            a2 = a2.greater(q.dot(dual2).abs());
            let height = q.dot(n);
            low = low.lesser(height);
            high = high.greater(height);
        }
        // The padding is measured across the sides, so along a skew edge it is longer: |dual| is 1 / (distance of sides).
        let (a1, a2) = (a1 + padding * dual1.length(), a2 + padding * dual2.length());
        let (middle, thickness) = ((low + high) * S::HALF, (high - low) * S::HALF + padding);
        let (bend_u, bend_v) = bends(net);
        Measure {
            bounds: Parallelepiped::new(centre + n * middle, [f1 * a1, f2 * a2, n * thickness]),
            bend_u,
            bend_v,
            twist: (p00 - p10 - p01 + p11).length() * S::from_f64(0.25),
            sides: [v1.length(), v2.length()],
            // Sides of the parallelogram are v, those of the box 2 a f.
            ratios: [a1 + a1, a2 + a2],
            stray: if skewed || P::RATIONAL {
                S::INFINITY
            } else {
                stray(net, v1, v2) * a1.greater(a2) * S::from_f64(SHEAR)
            },
        }
    }

    /// The patch over `domain`.
    pub fn patch(&self, domain: Domain) -> Patch<S> {
        let steps = S::from_u32(SIDE_STEPS);
        let sides = self.ratios.map(|ratio| (ratio * steps).to_u32().min(u32::from(u16::MAX)) as u16);
        Patch { bounds: self.bounds, stray: self.stray, sides, domain }
    }
}

/// The directions of the box's edges: v1 and v2, unless they are too short or too nearly parallel, their unit normal, and
/// whether one was replaced.
fn edges<V: Vector3>(v1: V, v2: V) -> (V, V, V, bool) {
    let (l1, l2) = (v1.length(), v2.length());
    let n = v1.unit().cross(v2.unit());
    if n.length() >= V::Scalar::from_f64(LEAST_SINE) {
        return (v1, v2, n.unit(), false);
    }
    // Of a point, of a line, of a sliver: the longer edge stays, or an axis if there is none.
    let axis =
        |k: usize| V::from_array(core::array::from_fn(|i| if i == k { V::Scalar::ONE } else { V::Scalar::ZERO }));
    let longer = if l1 >= l2 { v1 } else { v2 };
    let longer = if longer.length() > V::Scalar::ZERO { longer } else { axis(0) };
    let along = longer.unit();
    let shorter = if l1 >= l2 { v2 } else { v1 };
    let rest = shorter - along * along.dot(shorter);
    // What is left of a parallel edge may be all rounding; then the axis most across will do.
    let [x, y, z] = along.abs().to_array();
    let across = axis(if x <= y && x <= z {
        0
    } else if y <= z {
        1
    } else {
        2
    });
    let trusted = rest.length() > longer.length() * V::Scalar::from_f64(1e-3);
    let rest = if trusted { rest.unit() } else { (across - along * along.dot(across)).unit() };
    let rest = rest * longer.length();
    let (f1, f2) = if l1 >= l2 { (longer, rest) } else { (rest, longer) };
    (f1, f2, f1.unit().cross(f2.unit()).unit(), true)
}

/// Bounds of the deviation from the chord in u and in v: n (n − 1)/8 times the largest second difference.
fn bends<P: Point>(net: &Net<'_, P>) -> (P::Scalar, P::Scalar) {
    let columns = net.degree_v() + 1;
    let along_v = net.rows().fold(P::Scalar::ZERO, |most, row| most.greater(second_difference(row, 1)));
    let factor = |degree: usize| P::Scalar::from_u32((degree * (degree - 1)) as u32) * P::Scalar::from_f64(0.125);
    (second_difference(net.points(), columns) * factor(net.degree_u()), along_v * factor(net.degree_v()))
}

/// The longest second difference of points `stride` apart.
fn second_difference<P: Point>(points: &[P], stride: usize) -> P::Scalar {
    let later = |steps: usize| points.iter().skip(steps * stride).map(|p| V::<P>::from_array(p.position()));
    let triples = later(0).zip(later(1)).zip(later(2));
    triples.fold(P::Scalar::ZERO, |most, ((a, b), c)| most.greater((a - b * P::Scalar::TWO + c).length()))
}

/// A bound of |S_u − v1| + |S_v − v2| over a polynomial piece, parameters counted across the piece.
fn stray<P: Point>(net: &Net<'_, P>, v1: V<P>, v2: V<P>) -> P::Scalar {
    let (n, m) = (P::Scalar::from_u32(net.degree_u() as u32), P::Scalar::from_u32(net.degree_v() as u32));
    let along_v = net.rows().fold(P::Scalar::ZERO, |most, row| most.greater(first_difference(row, 1, m, v2)));
    first_difference(net.points(), net.degree_v() + 1, n, v1) + along_v
}

/// The most by which `factor` times a difference of points `stride` apart is off `mean`.
fn first_difference<P: Point>(points: &[P], stride: usize, factor: P::Scalar, mean: V<P>) -> P::Scalar {
    let later = |steps: usize| points.iter().skip(steps * stride).map(|p| V::<P>::from_array(p.position()));
    later(0).zip(later(1)).fold(P::Scalar::ZERO, |most, (a, b)| most.greater(((b - a) * factor - mean).length()))
}

type V<P> = <<P as Point>::Scalar as Scalar>::Vec3;

#[cfg(test)]
mod tests;
