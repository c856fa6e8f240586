//! A patch: a nearly flat piece of a surface, its parallelogram, its enclosing parallelepiped, and the ray tests on them.
//!
//! Source: W. Barth and W. Stürzlinger, "Efficient ray tracing for Bézier and B-spline surfaces", Computers & Graphics
//! 17(4), 1993; section "Barth and Stürzlinger's Algorithm" of the paper. How the parallelepiped is chosen and tested is
//! ours:
//!
//! The box is kept as centre and half edges e1, e2, e3. In the system of a ray's two planes the ray is a point, 0, and the box a
//! hexagon, whose sides are parallel to the projected e1, e2, e3: 0 lies inside exactly if, for each of the three,
//! |c × e_i| ≤ Σ_j |e_j × e_i|. No division, and an edge-on or flat box needs no special case. The same cross products
//! give eq. (1), the point where the ray meets the parallelogram, and where it enters and leaves the box.

use crate::domain::Domain;
use crate::frame::Aabb;
use crate::planes::{CENTRE, Columns, DepthRange, Planes};
use crate::scalar::{Scalar, Vector3};
use crate::story::Event;

/// A box with skew sides: centre ± e1 ± e2 ± e3, in the frame; e1, e2, e3 are along v1, v2 and v1 × v2.
///
/// For each coordinate axis the four numbers e1, e2, centre, e3 stand together, in this order: the ray test multiplies the
/// four of the ray's steepest axis by one slope and subtracts them from the four of another, and then multiplies the pair
/// (e1, e2) by one number each of the pair (centre, e3). Vector units take them two or four at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Parallelepiped<S> {
    pub(crate) axes: [[S; 4]; 3],
}

/// A patch as a slot of lent memory: 64 bytes in `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Patch<S> {
    pub(crate) bounds: Parallelepiped<S>,
    /// The most by which derivatives stray from the parallelogram's sides: see [`Patch::at_most_once`].
    pub(crate) stray: S,
    /// How many times longer the box is than the parallelogram, along v1 and v2, in steps of 1 / [`SIDE_STEPS`]: good for
    /// a start, not for a proof.
    pub(crate) sides: [u16; 2],
    pub(crate) domain: Domain,
}

pub(crate) const SIDE_STEPS: u32 = 2048;

/// The two numbers in a word, that of the lower half first.
const fn halves(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}

/// A word of two numbers.
const fn word([low, high]: [u16; 2]) -> u32 {
    low as u32 | (high as u32) << 16
}

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

/// The patches of a scene: a view of lent memory.
#[derive(Clone, Copy, Debug)]
pub struct Patches<'m, S> {
    patches: &'m [Patch<S>],
    first: &'m [u32],
}

impl<'m, S: Scalar> Patches<'m, S> {
    /// The view of memory that was filled before, such as a table in flash.
    pub const fn new(patches: &'m [Patch<S>], first: &'m [u32]) -> Self {
        Patches { patches, first }
    }

    /// The same division among surfaces over other patches.
    pub(crate) fn with_patches(&self, patches: &'m [Patch<S>]) -> Self {
        Patches { patches, first: self.first }
    }

    /// All patches, surface by surface.
    pub fn all(&self) -> &'m [Patch<S>] {
        self.patches
    }

    /// How many surfaces they are of.
    #[inline]
    pub fn surfaces(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// The number, among all, of a surface's first patch, and of the one after its last; `None` if there is no such surface.
    #[inline]
    pub fn range(&self, surface: usize) -> Option<(usize, usize)> {
        Some((*self.first.get(surface)? as usize, *self.first.get(surface + 1)? as usize))
    }

    /// The patches of one surface; `None` if the memory does not hold them.
    #[inline]
    pub fn of_surface(&self, surface: usize) -> Option<&'m [Patch<S>]> {
        let (first, end) = self.range(surface)?;
        self.patches.get(first..end)
    }
}

/// A patch whose box a ray meets, and how.
pub type Met<'m, S> = (&'m Patch<S>, Crossing<S>);

/// Where a ray enters or leaves a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pierce<S> {
    /// Coordinates along e1 and e2, −1 to 1.
    pub(crate) local: [S; 2],
    /// Depth along the ray.
    pub depth: S,
}

impl<S: Scalar> Parallelepiped<S> {
    /// What a slot holds before it is filled.
    pub const EMPTY: Self = Parallelepiped { axes: [[S::ZERO; 4]; 3] };

    /// The slot that holds these numbers. For tables; see [`LAYOUT`](crate::LAYOUT).
    ///
    /// They are, for each coordinate axis in turn, those of e1, e2, the centre and e3.
    pub const fn from_numbers(axes: [[S; 4]; 3]) -> Self {
        Parallelepiped { axes }
    }

    /// What [`Parallelepiped::from_numbers`] takes.
    pub const fn numbers(&self) -> [[S; 4]; 3] {
        self.axes
    }

    pub(crate) fn new(centre: S::Vec3, edges: [S::Vec3; 3]) -> Self {
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

    /// Its eight corners.
    pub(crate) fn corners(&self) -> [[S; 3]; 8] {
        core::array::from_fn(|corner| {
            self.axes.map(|[e1, e2, centre, e3]| {
                let side = |bit: usize, edge: S| if corner & bit == 0 { -edge } else { edge };
                centre + side(1, e1) + side(2, e2) + side(4, e3)
            })
        })
    }

    /// The box multiplied by a matrix, given by its rows.
    pub(crate) fn turned(&self, rows: &[[S; 3]; 3]) -> Self {
        let [x, y, z] = &self.axes;
        Parallelepiped { axes: rows.map(|[a, b, c]| core::array::from_fn(|k| a * x[k] + b * y[k] + c * z[k])) }
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
        Patch { bounds: Parallelepiped::EMPTY, stray: S::ZERO, sides: [0; 2], domain: Domain::EMPTY };

    /// The slot that holds these numbers. For tables; see [`LAYOUT`](crate::LAYOUT).
    ///
    /// After the box's come the most by which derivatives stray, then two words of two numbers each, the first in the lower
    /// half: how much longer the box is than the parallelogram, along v1 and v2; and the domain, in u and v.
    pub const fn from_numbers(bounds: [[S; 4]; 3], stray: S, [sides, domain]: [u32; 2]) -> Self {
        let bounds = Parallelepiped::from_numbers(bounds);
        Patch { bounds, stray, sides: halves(sides), domain: Domain::from_numbers(halves(domain)) }
    }

    /// What [`Patch::from_numbers`] takes.
    pub const fn numbers(&self) -> ([[S; 4]; 3], S, [u32; 2]) {
        (self.bounds.numbers(), self.stray, [word(self.sides), word(self.domain.numbers())])
    }

    /// The enclosing parallelepiped.
    pub fn bounds(&self) -> &Parallelepiped<S> {
        &self.bounds
    }

    /// The parameter domain.
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// That it was tested.
    pub(crate) fn told(&self, met: bool) -> Event {
        Event::Patch { sides: self.domain.bounds(), met }
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

    /// Start: where the ray meets the parallelogram's plane; ours, held within the box. `None` edge on.
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
