//! Surfaces of revolution from circular arcs: a profile of arcs or lines, swept around the z axis.
//!
//! An arc is either exact, a rational quadratic (L. Piegl and W. Tiller, *The NURBS Book*, 2nd edition, section 7.3), or a
//! polynomial cubic that has the circle's ends and tangents and touches it in its middle: with θ the arc's angle, the inner
//! control points lie 4/3 tan(θ/4) radii along the tangents (G. Farin, *Curves and Surfaces for CAGD*, 5th edition, section
//! 10.1). It leaves the circle by at most 2.8e-4 of the radius for a quarter, 5.5e-3 for a third and 1.9e-2 for a half of it.
//!
//! Every control point of a profile and of a circle is made once, by its index, and the last one of a closed curve is its
//! first. Surfaces that join therefore share the bits of their common control points.
use super::model::ModelSurface;
use super::transform::cos_sin;

/// Whether a round shape is met exactly or by polynomials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arcs {
    /// Rational quadratics, exact but for rounding. An arc has to be shorter than a half of the circle.
    Rational,
    /// Polynomial cubics. An arc is at most a half of the circle.
    Polynomial,
}

impl Arcs {
    /// The degree of an arc.
    pub fn degree(self) -> usize {
        match self {
            Arcs::Rational => 2,
            Arcs::Polynomial => 3,
        }
    }
}

/// A plane curve of Bézier arcs: control points `[x, y, weight]`, those of neighbours shared.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    degree: usize,
    /// Every control point once; of a closed curve the first one follows the last.
    points: Vec<[f64; 3]>,
    closed: bool,
}

impl Curve {
    /// The arcs, `count` of them, of the circle of radius 1 about the origin that begin at the angle `from` and go on for
    /// `sweep`, both in degrees: 360 of them make it closed.
    pub fn circle(kind: Arcs, from: f64, sweep: f64, count: usize) -> Self {
        let closed = sweep == 360.0;
        let at = |end: usize| {
            let end = if closed { end % count } else { end };
            cos_sin(from + sweep * end as f64 / count as f64)
        };
        let [cos, _] = cos_sin(sweep / count as f64);
        let step = (sweep / count as f64).to_radians();
        let (weight, handle) = ((0.5 * step).cos(), 4.0 / 3.0 * (0.25 * step).tan());
        let arc = |number: usize| {
            let [start, end] = [at(number), at(number + 1)];
            match kind {
                // Where the tangents at the ends meet; exact for a quarter.
                Arcs::Rational => {
                    let [x, y] = [0, 1].map(|k| (start[k] + end[k]) / (1.0 + cos));
                    vec![[start[0], start[1], 1.0], [x, y, weight]]
                }
                Arcs::Polynomial => vec![
                    [start[0], start[1], 1.0],
                    [start[0] - handle * start[1], start[1] + handle * start[0], 1.0],
                    [end[0] + handle * end[1], end[1] - handle * end[0], 1.0],
                ],
            }
        };
        let mut points: Vec<_> = (0..count).flat_map(arc).collect();
        let degree = kind.degree();
        if !closed {
            let [x, y] = at(count);
            points.push([x, y, 1.0]);
        }
        Curve { degree, points, closed }
    }

    /// The segment between two points, of this degree, at least 1.
    pub fn segment(degree: usize, from: [f64; 2], to: [f64; 2]) -> Self {
        let at = |k: usize| {
            let part = k as f64 / degree as f64;
            [(1.0 - part) * from[0] + part * to[0], (1.0 - part) * from[1] + part * to[1], 1.0]
        };
        Curve { degree, points: (0..=degree).map(at).collect(), closed: false }
    }

    /// The curve with its coordinates mapped.
    pub fn map(mut self, to: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        for point in &mut self.points {
            let [x, y] = to([point[0], point[1]]);
            // Adding 0 turns -0 into 0, so that an edge collapsed at the axis is one point to the bit.
            (point[0], point[1]) = (x + 0.0, y + 0.0);
        }
        self
    }

    /// How many arcs it has.
    fn arcs(&self) -> usize {
        (self.points.len() - usize::from(!self.closed)) / self.degree
    }

    /// Control point `index` of arc `number`.
    fn point(&self, number: usize, index: usize) -> [f64; 3] {
        let at = self.degree * number + index;
        self.points[if self.closed { at % self.points.len() } else { at }]
    }
}

/// The surfaces that `profile`, of points (radius, height), sweeps along `around`, a circle or a part of it about the z axis:
/// arc by arc of the profile, one surface per arc of the circle. u runs along the profile and v around the axis.
pub fn revolve(profile: &Curve, around: &Curve) -> Vec<ModelSurface> {
    let mut surfaces = Vec::new();
    for (along, turn) in (0..profile.arcs()).flat_map(|along| (0..around.arcs()).map(move |turn| (along, turn))) {
        let mut points = Vec::new();
        for i in 0..=profile.degree {
            let [radius, height, weight] = profile.point(along, i);
            for j in 0..=around.degree {
                let [x, y, w] = around.point(turn, j);
                points.push([radius * x + 0.0, radius * y + 0.0, height, weight * w]);
            }
        }
        let rational = points.iter().any(|point| point[3] != 1.0);
        surfaces.push(ModelSurface {
            number: surfaces.len(),
            degree_u: profile.degree,
            degree_v: around.degree,
            rational,
            points,
            knots: None,
        });
    }
    surfaces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest and the least distance from the origin of points on a curve.
    fn radii(curve: &Curve) -> [f64; 2] {
        let mut radii = [f64::INFINITY, 0.0f64];
        for (number, step) in (0..curve.arcs()).flat_map(|number| (0..=64).map(move |step| (number, step))) {
            let t = f64::from(step) / 64.0;
            let mut row: Vec<_> = (0..=curve.degree).map(|k| curve.point(number, k)).collect();
            row.iter_mut().for_each(|[x, y, w]| (*x, *y) = (*x * *w, *y * *w));
            // De Casteljau's steps.
            while row.len() > 1 {
                row = row.windows(2).map(|pair| [0, 1, 2].map(|k| (1.0 - t) * pair[0][k] + t * pair[1][k])).collect();
            }
            let radius = (row[0][0] / row[0][2]).hypot(row[0][1] / row[0][2]);
            radii = [radii[0].min(radius), radii[1].max(radius)];
        }
        radii
    }

    #[test]
    fn arcs_follow_the_circle() {
        for ([from, sweep], count) in [([0.0, 360.0], 3), ([0.0, 360.0], 4), ([-35.0, 85.0], 1), ([20.0, 280.0], 5)] {
            let [low, high] = radii(&Curve::circle(Arcs::Rational, from, sweep, count));
            assert!(low > 1.0 - 1e-15 && high < 1.0 + 1e-15, "{from} {sweep} {count}: {low} {high}");
        }
        for (count, off) in [(2, 1.9e-2), (3, 5.5e-3), (4, 2.8e-4), (8, 4.3e-6)] {
            let [low, high] = radii(&Curve::circle(Arcs::Polynomial, 0.0, 360.0, count));
            assert!(low > 1.0 - 1e-15 && high < 1.0 + off, "{count}: {low} {high}");
        }
    }

    #[test]
    fn a_closed_curve_ends_where_it_begins_to_the_bit() {
        for (kind, count) in [(Arcs::Rational, 3), (Arcs::Rational, 7), (Arcs::Polynomial, 2), (Arcs::Polynomial, 7)] {
            let circle = Curve::circle(kind, 30.1, 360.0, count);
            assert_eq!(circle.arcs(), count);
            assert_eq!(circle.point(count - 1, circle.degree), circle.point(0, 0));
        }
    }

    #[test]
    fn a_pole_is_one_point_to_the_bit() {
        let profile = Curve::circle(Arcs::Polynomial, -90.0, 180.0, 2);
        for surface in revolve(&profile, &Curve::circle(Arcs::Polynomial, 0.0, 360.0, 5)) {
            let edge = if surface.number < 5 { 0..4 } else { 12..16 };
            let bits = |k: usize| surface.points[k].map(f64::to_bits);
            assert!(edge.clone().all(|k| bits(k) == bits(edge.start)), "{:?}", surface.points);
        }
    }
}
