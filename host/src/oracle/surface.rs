//! One ray against one surface: halving until every domain holds nothing, one root, or cannot be decided.

use super::contraction::{Content, Domain, content};
use super::edges::{EDGES, Edges};
use super::exclusion::widest_gap;
use super::frame::Frame;
use super::injectivity::{derivatives, mean_derivatives};
use super::net::{Axis, Degrees, Point, halve};
use super::real::Real;
use super::root::{Found, nearest_point};

/// Domains examined per ray and surface, unless told otherwise. The teapot takes at most 111, a degree 15 surface met 15 times
/// 179, a pole met head on or a tangent within 1e-15 up to 2,000; more only lengthens the work for rays that lie along a
/// surface.
pub(super) const MAX_DOMAINS: usize = 20_000;

/// Least extent of a domain in u or v, 2⁻⁵⁰ in f64: below it the parameters have no digits left.
const fn min_size<R: Real>() -> f64 {
    4.0 * R::EPS
}

/// Largest q at which a domain is given to the root finder. Below 1 is enough for at most one root; 1/2 makes the
/// iteration gain a bit per step, at the cost of about one more halving.
const MAX_CONTRACTION: f64 = 0.5;

/// A root whose parameters are coarser in space than this many times the error of an evaluation is sought again in smaller
/// domains: the homogeneous map may be regular where its weight all but vanishes.
const FINE: f64 = 16.0;

/// Largest part of a domain by which rounding may move its root for the domain to be given to the root finder: 1/16
/// leaves it 3 bits to gain. Others are halved further, to a point or until they vary by rounding only.
const MAX_NOISE: f64 = 1.0 / 16.0;

/// A domain that a line separates from the ray is halved further if the gap decides the margin and is less than this
/// part of the domain's extent: a larger part makes margins nearer to the true distances and takes more halvings.
const CLEAR_PART: f64 = 1.0 / 64.0;

/// A domain no farther from the ray than this many times its error and degree is one point, which the ray meets: a pole
/// met head on. More stops earlier, with a root less sharp.
const POINT_PART: f64 = 64.0;

/// Clearances of this part of the diagonal or more count without asking whether they matter. A smaller one is less
/// work; margins are told apart only below it.
const AMPLE_PART: f64 = 1.0 / 1024.0;

/// A surface with what is the same for all rays.
#[derive(Clone, Debug)]
pub(super) struct Surface<R> {
    /// Its number in the model.
    pub(super) number: usize,
    /// The number of its first edge.
    pub(super) first_edge: usize,
    /// Its degrees.
    pub(super) degrees: Degrees,
    /// Its control points `[x, y, z, w]`, the weights scaled by a power of two to at most 1.
    pub(super) points: Vec<Point<R>>,
    /// The centre of their bounding box.
    pub(super) centre: [R; 3],
    /// Half the extents of that box.
    pub(super) half: [R; 3],
    /// The length that its margins are shares of.
    pub(super) unit: f64,
}

/// A part of a surface that the ray passes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clearance<R> {
    /// How far the ray must move at least before it meets that part.
    pub(super) gap: f64,
    /// The least depth of that part.
    pub(super) depth: R,
    /// The unit of its surface.
    pub(super) unit: f64,
}

/// What one ray finds on all surfaces.
#[derive(Clone, Debug)]
pub(super) struct Findings<R> {
    pub(super) roots: Vec<Found<R>>,
    pub(super) clearances: Vec<Clearance<R>>,
    /// Least depths of the domains that could not be decided.
    pub(super) unresolved: Vec<R>,
}

/// What one surface adds to the findings; depths of its parts are those of its own frame.
struct Adding<'f, R> {
    findings: &'f mut Findings<R>,
    /// The depth of the surface's frame in the model's.
    start: R,
    unit: f64,
}

impl<R: Real> Adding<'_, R> {
    /// Notes a part that begins at `depth` and that the ray must move by `gap` to meet otherwise than it does.
    fn clear(&mut self, gap: f64, depth: R) {
        if gap.is_finite() {
            self.findings.clearances.push(Clearance { gap, depth: self.start + depth, unit: self.unit });
        }
    }

    /// Notes a part that begins at `depth` and could not be decided.
    fn leave(&mut self, depth: R) {
        self.findings.unresolved.push(self.start + depth);
    }
}

impl<R: Real> Findings<R> {
    /// Nothing yet.
    pub(super) fn new() -> Findings<R> {
        Findings { roots: Vec::new(), clearances: Vec::new(), unresolved: Vec::new() }
    }
}

/// A ray and the surface that it is traced through.
pub(super) struct Ray<'a, R> {
    /// The ray's frame about the surface.
    pub(super) frame: &'a Frame<R>,
    pub(super) edges: &'a Edges<R>,
    /// The depths between which roots are wanted.
    pub(super) range: [R; 2],
    /// The model's diagonal: no margin is more.
    pub(super) diagonal: f64,
    /// Domains examined per surface at most.
    pub(super) domains: usize,
}

/// The net in which a root is sought: the whole surface's, or that of a part of it.
pub(super) struct Chart<'n, R> {
    /// The homogeneous net.
    pub(super) net: &'n [Point<R>],
    /// The part of the surface that it is the net of.
    pub(super) covers: Domain<R>,
    /// The part of the net's own domain in which the root is sought.
    pub(super) part: Domain<R>,
    /// A bound on the error of an evaluated plane distance, per unit of weight.
    pub(super) error: f64,
    /// The same of a depth.
    pub(super) blur: f64,
}

/// A domain that waits on the stack; its net is at the same place of the stack of nets.
#[derive(Clone, Copy)]
struct Pending<R> {
    domain: Domain<R>,
    /// The error bound of its net's plane distances, per unit of weight.
    error: f64,
    /// The same of its depths.
    blur: f64,
}

pub(super) fn norm(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

impl<R: Real> Ray<'_, R> {
    /// How far a box is clear of the ray and its least depth, or `None` if the ray may pass through it.
    fn passes(&self, centre: [R; 3], half: [R; 3], error: f64) -> Option<(f64, R)> {
        let mut best: Option<f64> = None;
        let mut consider = |gap: f64, extent: f64| {
            if gap > 8.0 * error && gap >= CLEAR_PART * extent && best.is_none_or(|b| gap > b) {
                best = Some(gap);
            }
        };
        for k in 0..2 {
            consider(centre[k].abs().less(half[k]), 2.0 * half[k].to_f64());
        }
        let [near, far] = [centre[2] - half[2], centre[2] + half[2]];
        consider(self.range[0].less(far), 2.0 * half[2].to_f64());
        consider(near.less(self.range[1]), 2.0 * half[2].to_f64());
        best.map(|gap| (gap, near))
    }

    /// Whether the surface carries on across all of its edges that `domain` touches, as far as their ends and middle tell.
    fn continues(&self, surface: &Surface<R>, domain: Domain<R>) -> bool {
        (0..EDGES).all(|edge| {
            let (across, along) = (edge / 2, 1 - edge / 2);
            let border = domain.corner[across] + R::new((edge % 2) as f64 * domain.size[across]);
            border != R::new((edge % 2) as f64)
                || [0.0, 0.5, 1.0].iter().all(|x| {
                    let s = domain.corner[along] + R::new(x * domain.size[along]);
                    self.edges.continues(surface.first_edge + edge, s, self.frame.direction())
                })
        })
    }

    /// Adds what this ray finds on `surface` to `findings`.
    pub(super) fn search(&self, surface: &Surface<R>, findings: &mut Findings<R>) {
        let (centre, half) = self.frame.project_box(surface.centre, surface.half);
        let reach = norm(centre.map(R::to_f64)) + norm(half.map(R::to_f64));
        let error = self.frame.error(reach);
        let mut adding = Adding { findings, start: self.frame.start(), unit: surface.unit };
        if let Some((gap, depth)) = self.passes(centre, half, error) {
            adding.clear(gap, depth);
            return;
        }
        let degrees = surface.degrees;
        let count = degrees.points();
        let net: Vec<Point<R>> = surface.points.iter().map(|&p| self.frame.project(p)).collect();
        // Each of the m + n stages of an evaluation rounds twice, and its parameters once.
        let stages = 3.0 * (degrees.m + degrees.n) as f64 * R::EPS;
        let evaluation = error + stages * reach;
        let ample = AMPLE_PART * surface.unit;

        let mut stack = vec![Pending { domain: Domain::whole(), error, blur: error }];
        let mut nets = net.clone();
        let mut current = vec![[R::ZERO; 4]; count];
        let mut places = vec![[R::ZERO; 3]; count];
        let mut examined = 0;
        // Ends when no domain is pending, or with all pending ones unresolved after `MAX_DOMAINS`.
        while let Some(Pending { domain, error, blur }) = stack.pop() {
            current.copy_from_slice(&nets[stack.len() * count..]);
            nets.truncate(stack.len() * count);
            let mut weight = 0.0;
            let mut farthest = 0.0;
            let mut depths = [R::INFINITY, -R::INFINITY];
            for (place, &[x, y, z, w]) in places.iter_mut().zip(&current) {
                *place = R::over([x, y, z], w);
                for d in &place[..2] {
                    farthest = f64::max(farthest, d.abs().to_f64());
                }
                weight = f64::max(weight, w.to_f64());
                depths = [depths[0].smaller(place[2]), depths[1].larger(place[2])];
            }
            let deepest = f64::max(depths[0].abs().to_f64(), depths[1].abs().to_f64());
            if examined == self.domains {
                adding.leave(depths[0]);
                continue;
            }
            examined += 1;
            let lengths = lengths(degrees, &places);
            let axis = split_axis(lengths, domain);
            let mean = mean_derivatives(degrees, &current);
            let gap = widest_gap(&places, mean, ample);
            if gap.width > 3.0 * error {
                if gap.width >= ample {
                    adding.clear(gap.width, depths[0]);
                    continue;
                }
                // A root can enter a regular part only from a part beside it or across a border that nothing continues.
                let d = derivatives(degrees, &current, mean, error * weight);
                if d.contraction < 1.0 && d.steadiness() >= gap.width && self.continues(surface, domain) {
                    adding.clear(d.steadiness(), depths[0]);
                    continue;
                }
                if gap.width >= CLEAR_PART * gap.extent || axis.is_none() {
                    adding.clear(gap.width, depths[0]);
                    continue;
                }
            } else {
                let beyond = f64::max(self.range[0].less(depths[1]), depths[0].less(self.range[1]));
                if beyond > 3.0 * error {
                    adding.clear(beyond, depths[0]);
                    continue;
                }
                let d = derivatives(degrees, &current, mean, error * weight);
                // The whole net lost nothing to halving, and the halved one has parameters as fine as the domain is small:
                // where weights fall steeply toward 1, a step of the whole net's parameters is far wider in space.
                let nearby = error + stages * farthest;
                let nearby_blur = blur + stages * deepest;
                let step = |k: usize| {
                    let last = (domain.corner[k] + R::new(domain.size[k])).to_f64();
                    lengths[k] * last / domain.size[k]
                };
                let whole = evaluation + 2.0 * R::EPS * (step(0) + step(1))
                    <= f64::max(nearby, nearby_blur) + 2.0 * R::EPS * (lengths[0] + lengths[1]);
                let chart = if whole {
                    Chart { net: &net, covers: Domain::whole(), part: domain, error: evaluation, blur: evaluation }
                } else {
                    Chart { net: &current, covers: domain, part: Domain::whole(), error: nearby, blur: nearby_blur }
                };
                let noise = d.inverse_norm() * chart.error * weight;
                if d.contraction <= MAX_CONTRACTION && noise <= MAX_NOISE {
                    let coarse = match content(degrees, chart.net, chart.part, &d, chart.error * weight) {
                        Content::Root(x) => {
                            let root = self.measure(surface, &chart, x);
                            let coarse = root.fineness > FINE * f64::max(chart.error, chart.blur)
                                && axis.is_some()
                                && d.variation > 8.0 * d.rounding;
                            if !coarse {
                                adding.findings.roots.push(root);
                            }
                            coarse
                        }
                        Content::Nothing(gap) => {
                            if !self.continues(surface, domain) {
                                adding.clear(gap / weight, depths[0]);
                            }
                            false
                        }
                    };
                    if !coarse {
                        adding.clear(d.steadiness(), depths[0]);
                        continue;
                    }
                }
                // All that the map of this domain varies by is rounding: halving it again would tell nothing, unless it
                // is about to be no more than a point.
                let point = POINT_PART * degrees.highest() as f64 * error;
                if axis.is_none() || d.variation <= 8.0 * d.rounding && !(farthest > point && farthest <= 64.0 * point)
                {
                    if farthest <= point {
                        let chart = Chart {
                            net: &current,
                            covers: domain,
                            part: Domain::whole(),
                            error: error + stages * farthest,
                            blur: blur + stages * deepest,
                        };
                        let x = nearest_point(degrees, &current, chart.part);
                        let mut root = self.measure(surface, &chart, x);
                        root.blur = f64::max(root.blur, depths[1].less(depths[0]));
                        root.margin = 0.0;
                        adding.findings.roots.push(root);
                    } else {
                        adding.leave(depths[0]);
                    }
                    continue;
                }
            }
            if let Some(axis) = axis {
                // Each stage of the halving rounds once.
                let degree = if axis == Axis::U { degrees.m } else { degrees.n };
                let error = error + degree as f64 * R::EPS * farthest;
                let blur = blur + degree as f64 * R::EPS * deepest;
                let place = nets.len();
                nets.resize(place + 2 * count, [R::ZERO; 4]);
                let (low, high) = nets[place..].split_at_mut(count);
                halve(degrees, &current, axis, low, high);
                for side in 0..2 {
                    let k = if axis == Axis::U { 0 } else { 1 };
                    let mut half = domain;
                    half.size[k] *= 0.5;
                    half.corner[k] += R::new(side as f64 * half.size[k]);
                    stack.push(Pending { domain: half, error, blur });
                }
            }
        }
    }
}

/// How long a net, not homogeneous, is in space along u and along v, at most.
fn lengths<R: Real>(degrees: Degrees, net: &[[R; 3]]) -> [f64; 2] {
    let Degrees { m, n } = degrees;
    let length = |a: [R; 3], b: [R; 3]| norm([0, 1, 2].map(|k| (b[k] - a[k]).to_f64()));
    let [mut along_u, mut along_v] = [0.0; 2];
    for j in 0..=n {
        let mut sum = 0.0;
        for i in 0..m {
            sum += length(net[i * (n + 1) + j], net[(i + 1) * (n + 1) + j]);
        }
        along_u = f64::max(along_u, sum);
    }
    for i in 0..=m {
        let mut sum = 0.0;
        for j in 0..n {
            sum += length(net[i * (n + 1) + j], net[i * (n + 1) + j + 1]);
        }
        along_v = f64::max(along_v, sum);
    }
    [along_u, along_v]
}

/// The direction in which to halve: the one along which the net is longer in space, unless its domain is too short for
/// another halving; `None` if both are.
fn split_axis<R: Real>([along_u, along_v]: [f64; 2], domain: Domain<R>) -> Option<Axis> {
    let [u_left, v_left] = domain.size.map(|s| s > min_size::<R>());
    match (u_left, v_left) {
        (true, true) if along_u >= along_v => Some(Axis::U),
        (true, false) => Some(Axis::U),
        (_, true) => Some(Axis::V),
        (false, false) => None,
    }
}
