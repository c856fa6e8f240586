//! The slow truth: all roots of a ray on all surfaces of a model, and how safe the answer is.
//!
//! The oracle shares nothing with the methods that it judges: it reads the file's control points, and has its own evaluation,
//! halving and proofs, in f64 or in double-double. Per ray and surface it projects the control points on two planes that
//! contain the ray and halves the parameter domain until each part is proved to hold no root (`exclusion`), is proved to hold
//! at most one (`injectivity`), which is then found or disproved (`contraction`), or varies by no more than rounding. A double
//! root cannot be certified in floating point: such a part is counted as unresolved, never dropped.

mod contraction;
mod edges;
mod exclusion;
mod frame;
mod injectivity;
mod nearness;
mod net;
mod real;
mod root;
mod surface;

use crate::scene::model::{Model, ModelSurface};
use edges::{EDGES, Edges};
use frame::Frame;
pub use nearness::is_farther;
use net::Degrees;
pub use real::{DoubleDouble, Real};
use root::Found;
use surface::{Findings, Ray, Surface};

/// A root: a point where the ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// The ray's parameter, in units of its direction.
    pub t: f64,
    /// The surface's parameter u, from 0 to 1. At a collapsed edge, any of those that name the point.
    pub u: f64,
    /// The surface's parameter v, from 0 to 1.
    pub v: f64,
    /// The surface's number in the model, from 0. Where several surfaces meet, one of them.
    pub surface: usize,
    /// How far, to first order, the ray may move sideways before this root ends, as a share of `unit`, at most 1: an estimate,
    /// the least of the distance to the silhouette, c² / 2κ (c the cosine between ray and normal, κ the normal curvature along
    /// the tangent nearest to the ray), and the distances, as the ray sees them, to those edges of its surface where no other
    /// surface carries on. 0 where there is no normal.
    pub margin: f64,
    /// How far the root may be off along the ray by rounding, as a share of `unit`.
    pub blur: f64,
    /// The length that margin and blur are shares of: the model's diagonal, or what [`OracleIn::measured_by`] was told of the
    /// surface; where surfaces coincide, the largest of theirs.
    pub unit: f64,
    /// The cosine of the angle between ray and normal, at least 0; 0 where there is no normal.
    pub cosine: f64,
}

/// What a ray meets.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// All roots with t in the range asked for, sorted by t.
    ///
    /// Roots no farther apart along the ray than their blurs are one root, that of the largest margin: a root on a seam,
    /// found from either side; one on surfaces that coincide; one at a pole.
    pub roots: Vec<Root>,
    /// How safe the answer "this is the closest hit" or "there is none" is: how far the ray may be displaced, to first
    /// order and as a share of the unit of the surface concerned, before the answer may change in kind. The least of
    /// - the closest root's own margin;
    /// - how far the ray must move before the second root is as close: the difference in depth, divided by the sum of
    ///   both roots' slopes where that exceeds 1, as a share of the larger of their units;
    /// - how far it must move before a root outside the range of t comes into it, or the closest one leaves it: the distance
    ///   along the ray, divided by the root's slope where that exceeds 1;
    /// - the clearances of all parts of the surfaces, no farther away than the closest root, that hold no root but would
    ///   gain one by a displacement: parts with a fold, or that touch an outer border, or whose whole surface is passed;
    /// - 0, if an unresolved part may be closer than the closest root.
    ///
    /// Clearances are lower bounds by convex hulls, so an ordinary ray's margin may be some 1/1000, whatever it passes.
    /// Below [`Real::LEAST_MARGIN`] the answer cannot be judged. A surface that meets its neighbour without sharing control points
    /// to within rounding has an outer border there.
    pub margin: f64,
    /// Domains that ended neither with a root nor excluded: tangencies, surfaces seen edge on, work beyond the bound on
    /// domains per ray and surface; and surfaces that are invalid. A ray that is invalid has 1, and margin 0.
    pub unresolved: usize,
}

/// The oracle in f64.
pub type Oracle = OracleIn<f64>;

/// All surfaces of a model, made ready for any number of rays; shared by threads. `R` is the number that it works in.
///
/// In [`DoubleDouble`] it takes the same f64 exactly and judges answers down to margins of 1e-26, in 10 to 15 times the
/// time. Seams whose control points differ in the last place of f64 are two outer borders to it: there the surfaces
/// do overlap or leave a crack.
#[derive(Clone, Debug)]
pub struct OracleIn<R> {
    surfaces: Vec<Surface<R>>,
    edges: Edges<R>,
    centre: [R; 3],
    diagonal: f64,
    /// Domains examined per ray and surface at most.
    domains: usize,
    /// Surfaces that no ray can be judged against.
    invalid: usize,
}

/// The bounding box of points, as its least and greatest corner.
fn bounds<'a>(points: impl Iterator<Item = &'a [f64; 4]>) -> [[f64; 3]; 2] {
    let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for p in points {
        for k in 0..3 {
            corners[0][k] = f64::min(corners[0][k], p[k]);
            corners[1][k] = f64::max(corners[1][k], p[k]);
        }
    }
    corners
}

/// The centre of a box and half its extents.
fn middle<R: Real>([low, high]: [[f64; 3]; 2]) -> [[R; 3]; 2] {
    let [low, high] = [low, high].map(|corner| corner.map(R::new));
    [[0, 1, 2].map(|k| (low[k] + high[k]).half()), [0, 1, 2].map(|k| (high[k] - low[k]).half())]
}

fn is_valid(surface: &ModelSurface) -> bool {
    let degrees = 1..net::MAX_ORDER;
    degrees.contains(&surface.degree_u)
        && degrees.contains(&surface.degree_v)
        && surface.points.len() == (surface.degree_u + 1) * (surface.degree_v + 1)
        // The cube of a coordinate or a product of weights must not leave the range of f64.
        && surface.points.iter().all(|p| {
            p[..3].iter().all(|x| x.abs() <= 1e100) && p[3] >= 1e-100 && p[3] <= 1e100
        })
}

impl<R: Real> OracleIn<R> {
    /// Makes `model` ready. A surface with degrees outside 1 to 15, too few or too many points, a coordinate beyond
    /// ±1e100 or a weight outside 1e-100 to 1e100 is invalid: it is left out and counted in every verdict as unresolved.
    pub fn new(model: &Model) -> OracleIn<R> {
        Self::with(model, None)
    }

    /// The same, with margins measured in each surface's own unit, a length above 0: what is a hair's breadth to the model may
    /// be all of a small surface.
    pub fn measured_by(model: &Model, unit: impl Fn(&ModelSurface) -> f64) -> OracleIn<R> {
        Self::with(model, Some(&unit))
    }

    fn with(model: &Model, unit: Option<&dyn Fn(&ModelSurface) -> f64>) -> OracleIn<R> {
        let valid: Vec<(usize, &ModelSurface)> =
            model.surfaces.iter().enumerate().filter(|(_, s)| is_valid(s)).collect();
        let all = bounds(valid.iter().flat_map(|(_, s)| &s.points));
        let [low, high] = all;
        let diagonal = [0, 1, 2].map(|k| (high[k] - low[k]).powi(2)).iter().sum::<f64>().sqrt();
        // A model that is a single point has no extent to measure by.
        let diagonal = if diagonal > 0.0 { diagonal } else { 1.0 };
        let mut surfaces = Vec::new();
        for (place, (number, surface)) in valid.iter().enumerate() {
            let heaviest = surface.points.iter().fold(0.0, |m, p| f64::max(m, p[3]));
            let scale = heaviest.log2().ceil().exp2();
            let points = surface.points.iter().map(|p| [p[0], p[1], p[2], p[3] / scale].map(R::new)).collect();
            let [centre, half] = middle(bounds(surface.points.iter()));
            surfaces.push(Surface {
                number: *number,
                first_edge: EDGES * place,
                degrees: Degrees { m: surface.degree_u, n: surface.degree_v },
                points,
                centre,
                half,
                unit: unit.map_or(diagonal, |unit| unit(surface)),
            });
        }
        let nets = surfaces.iter().map(|s| (s.degrees, &s.points[..]));
        let edges = Edges::new(nets, 4.0 * R::EPS);
        OracleIn {
            invalid: model.surfaces.len() - surfaces.len(),
            centre: if surfaces.is_empty() { [R::ZERO; 3] } else { middle(all)[0] },
            diagonal,
            domains: surface::MAX_DOMAINS,
            surfaces,
            edges,
        }
    }

    /// The same with another bound on domains per surface, for those who ask much and can do without rays that lie along one.
    pub fn within(self, domains: usize) -> OracleIn<R> {
        OracleIn { domains, ..self }
    }

    /// The length in units of which verdicts are stated.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// All roots of the ray `origin + t direction` with `t_min <= t <= t_max`, which may be infinite. The direction may
    /// have any length. Work is bounded: 20,000 domains per surface, or [`OracleIn::within`] so many.
    pub fn trace(&self, origin: [f64; 3], direction: [f64; 3], t_min: f64, t_max: f64) -> Verdict {
        let frame = Frame::new(origin, direction, self.centre);
        let Some(frame) = frame.filter(|_| !t_min.is_nan() && !t_max.is_nan()) else {
            return Verdict { roots: Vec::new(), margin: 0.0, unresolved: 1 };
        };
        let mut findings = Findings::new();
        for surface in &self.surfaces {
            let Some(frame) = frame.about(surface.centre) else {
                findings.unresolved.push(-R::INFINITY);
                continue;
            };
            let range = [t_min, t_max].map(|t| frame.depth(t));
            let ray = Ray { frame: &frame, edges: &self.edges, range, diagonal: self.diagonal, domains: self.domains };
            ray.search(surface, &mut findings);
        }
        let range = [t_min, t_max].map(|t| frame.depth(t));
        self.judge(findings, [t_min, t_max], range)
    }

    /// The verdict on what was found.
    fn judge(&self, mut findings: Findings<R>, times: [f64; 2], range: [R; 2]) -> Verdict {
        let times = times.map(R::new);
        findings.roots.sort_by(|a, b| a.depth.order(&b.depth));
        let mut merged: Vec<Found<R>> = Vec::new();
        for root in findings.roots {
            match merged.last_mut() {
                Some(last) if root.depth.less(last.depth) <= last.blur + root.blur => {
                    let unit = f64::max(last.unit, root.unit);
                    if root.margin > last.margin {
                        *last = root;
                    }
                    last.unit = unit;
                }
                _ => merged.push(root),
            }
        }

        let mut margin = 1.0;
        let mut limit = |length: f64, unit: f64| {
            let x = length / unit;
            // NaN limits to 0: what cannot be computed is not safe.
            if x.is_nan() || x < margin {
                margin = if x > 0.0 { x } else { 0.0 };
            }
        };
        let mut inside = Vec::new();
        for root in &merged {
            if root.t >= times[0] && root.t <= times[1] {
                inside.push(*root);
            }
        }
        // How far a root's depth moves when the ray moves sideways, per length.
        let slope = |r: &Found<R>| (1.0 - r.cosine * r.cosine).sqrt() / r.cosine;
        let carried = |depth: f64, slope: f64| depth / if slope > 1.0 { slope } else { 1.0 };
        // How deep the answer looks: parts that begin beyond the closest root cannot change it.
        let deepest = inside.first().map_or(range[1], |r| r.depth + R::new(r.blur));
        for root in &merged {
            let near = root.depth <= deepest || inside.is_empty();
            if near && root.t < times[0] {
                limit(carried(range[0].less(root.depth), slope(root)), root.unit);
            } else if near && root.t > times[1] {
                limit(carried(root.depth.less(range[1]), slope(root)), root.unit);
            }
        }
        if let Some(closest) = inside.first() {
            limit(closest.margin, closest.unit);
            limit(carried(closest.depth.less(range[0]), slope(closest)), closest.unit);
            limit(carried(range[1].less(closest.depth), slope(closest)), closest.unit);
        }
        if let [closest, second, ..] = &inside[..] {
            let unit = f64::max(closest.unit, second.unit);
            limit(carried(second.depth.less(closest.depth), slope(closest) + slope(second)), unit);
        }
        for clearance in &findings.clearances {
            if clearance.depth <= deepest || inside.is_empty() {
                limit(clearance.gap, clearance.unit);
            }
        }
        if self.invalid > 0 || findings.unresolved.iter().any(|&d| d <= deepest || inside.is_empty()) {
            limit(0.0, 1.0);
        }

        let roots = inside.iter().map(|r| Root {
            t: r.t.to_f64(),
            u: r.uv[0].to_f64(),
            v: r.uv[1].to_f64(),
            surface: r.surface,
            margin: f64::min(r.margin / r.unit, 1.0),
            blur: r.blur / r.unit,
            unit: r.unit,
            cosine: r.cosine,
        });
        Verdict { roots: roots.collect(), margin, unresolved: findings.unresolved.len() + self.invalid }
    }
}

#[cfg(test)]
mod tests;
