//! Shapes that a scene file asks for by their measures: toruses, which flattened are rings, spheres, and walls of cylinders.
//!
//! All are about the z axis and around the origin. By default they are made of polynomial bicubics, which leave the circle a
//! little (see [`Arcs`]); `exact = true` makes them rational biquadratics that do not.
use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use super::error::InputError;
use super::model::ModelSurface;
use super::revolution::{Arcs, Curve, revolve};

/// The most surfaces of a shape in either direction. More would let a slip of the pen ask for millions.
const MAX_ARCS: u32 = 1000;

/// A shape with its measures, in the units of the scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// An ellipse swept around the z axis.
    Torus {
        /// The radius of the circle that the ellipse's centre goes along.
        major: f64,
        /// The half width of the ellipse, across the axis.
        minor: f64,
        /// Its half height, along the axis: as `minor` for a torus with a round section, less or more for a ring.
        height: f64,
        /// How many surfaces it is divided into around the axis.
        around: usize,
        /// How many it is divided into across.
        across: usize,
        /// Where across they begin, in degrees upward from the outermost circle.
        seam: f64,
        /// Of which kind its arcs are.
        arcs: Arcs,
    },
    /// A sphere of two rows of surfaces, each with an edge collapsed at a pole.
    Sphere {
        /// The radius.
        radius: f64,
        /// How many surfaces a row has.
        around: usize,
        /// Of which kind its arcs are.
        arcs: Arcs,
    },
    /// The wall of a cylinder, open at both ends, or a part of one.
    Cylinder {
        /// The radius.
        radius: f64,
        /// The height, half of it above and half below the origin.
        height: f64,
        /// Where about the axis it begins, in degrees from the x axis, and how far it goes on: 360 for a closed one.
        arc: [f64; 2],
        /// How many surfaces it has around the axis.
        around: usize,
        /// Of which kind its arcs are.
        arcs: Arcs,
    },
}

impl Shape {
    /// How many surfaces there will be.
    pub fn count(&self) -> usize {
        match *self {
            Self::Torus { around, across, .. } => around * across,
            Self::Sphere { around, .. } => 2 * around,
            Self::Cylinder { around, .. } => around,
        }
    }

    /// The surfaces. Neighbours share the bits of their common control points.
    pub fn surfaces(&self) -> Vec<ModelSurface> {
        let circle = |arcs: Arcs, count: usize| Curve::circle(arcs, 0.0, 360.0, count);
        match *self {
            Self::Torus { major, minor, height, around, across, seam, arcs } => {
                let section = Curve::circle(arcs, seam, 360.0, across);
                revolve(&section.map(|[x, y]| [major + minor * x, height * y]), &circle(arcs, around))
            }
            Self::Sphere { radius, around, arcs } => {
                let half = Curve::circle(arcs, -90.0, 180.0, 2).map(|[x, y]| [radius * x, radius * y]);
                revolve(&half, &circle(arcs, around))
            }
            Self::Cylinder { radius, height, arc: [from, sweep], around, arcs } => {
                let line = Curve::segment(arcs.degree(), [radius, -0.5 * height], [radius, 0.5 * height]);
                revolve(&line, &Curve::circle(arcs, from, sweep, around))
            }
        }
    }
}

/// The field `torus` as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TorusTable {
    major: Spanned<f64>,
    minor: Spanned<f64>,
    height: Option<Spanned<f64>>,
    around: Option<Spanned<i128>>,
    across: Option<Spanned<i128>>,
    seam: Option<Spanned<f64>>,
    #[serde(default)]
    exact: bool,
}

/// The field `sphere` as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereTable {
    radius: Spanned<f64>,
    around: Option<Spanned<i128>>,
    #[serde(default)]
    exact: bool,
}

/// The field `cylinder` as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderTable {
    radius: Spanned<f64>,
    height: Spanned<f64>,
    arc: Option<Spanned<Vec<f64>>>,
    around: Option<Spanned<i128>>,
    #[serde(default)]
    exact: bool,
}

/// The surfaces into which a whole circle is divided where a file does not say: each a quarter of it.
const QUARTERS: u32 = 4;

fn kind(exact: bool) -> Arcs {
    if exact { Arcs::Rational } else { Arcs::Polynomial }
}

/// The number of arcs of `sweep` degrees; see [`Arcs`] for how long one may be.
fn arcs(name: &str, given: &Option<Spanned<i128>>, sweep: f64, kind: Arcs, check: &Check) -> Result<usize, InputError> {
    let enough = |count: u32| match kind {
        Arcs::Rational => sweep < 180.0 * f64::from(count),
        Arcs::Polynomial => sweep <= 180.0 * f64::from(count),
    };
    let Some(count) = given else {
        return Ok(QUARTERS as usize);
    };
    // Quarters are enough for every sweep, as it is at most a whole circle.
    let least = (1..QUARTERS).find(|&count| enough(count)).unwrap_or(QUARTERS);
    Ok(check.whole(name, count, least..=MAX_ARCS)? as usize)
}

impl TorusTable {
    pub(super) fn check(&self, check: &Check) -> Result<Shape, InputError> {
        let minor = check.positive("`minor`", &self.minor)?;
        let kind = kind(self.exact);
        Ok(Shape::Torus {
            major: check.positive("`major`", &self.major)?,
            minor,
            height: self.height.as_ref().map_or(Ok(minor), |height| check.positive("`height`", height))?,
            around: arcs("`around`", &self.around, 360.0, kind, check)?,
            across: arcs("`across`", &self.across, 360.0, kind, check)?,
            seam: self.seam.as_ref().map_or(Ok(0.0), |seam| check.finite("`seam`", seam))?,
            arcs: kind,
        })
    }
}

impl SphereTable {
    pub(super) fn check(&self, check: &Check) -> Result<Shape, InputError> {
        let kind = kind(self.exact);
        Ok(Shape::Sphere {
            radius: check.positive("`radius`", &self.radius)?,
            around: arcs("`around`", &self.around, 360.0, kind, check)?,
            arcs: kind,
        })
    }
}

impl CylinderTable {
    pub(super) fn check(&self, check: &Check) -> Result<Shape, InputError> {
        let arc = match &self.arc {
            None => [0.0, 360.0],
            Some(list) => match list.get_ref()[..] {
                // What was rounded in writing is no gap, and no overlap.
                [from, to] if from.is_finite() && (to - from - 360.0).abs() < 1e-9 => [from, 360.0],
                [from, to] if from.is_finite() && to > from && to - from < 360.0 => [from, to - from],
                _ => {
                    return Err(check.source.refuse(
                        list.span(),
                        "`arc` is no part of a circle",
                        "not two angles of which the second is larger, by at most 360",
                        "write where it begins and ends in degrees, such as `arc = [-30, 30]`",
                    ));
                }
            },
        };
        let kind = kind(self.exact);
        Ok(Shape::Cylinder {
            radius: check.positive("`radius`", &self.radius)?,
            height: check.positive("`height`", &self.height)?,
            arc,
            around: arcs("`around`", &self.around, arc[1], kind, check)?,
            arcs: kind,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    /// The control points along the four edges of a surface, as bits, each edge from whichever end is the lesser.
    fn edges(surface: &ModelSurface) -> [Vec<[u64; 4]>; 4] {
        let (m, n) = (surface.degree_u, surface.degree_v);
        let point = |i: usize, j: usize| surface.points[i * (n + 1) + j].map(f64::to_bits);
        let along_u = |j: usize| (0..=m).map(|i| point(i, j)).collect::<Vec<_>>();
        let along_v = |i: usize| (0..=n).map(|j| point(i, j)).collect::<Vec<_>>();
        [along_u(0), along_u(n), along_v(0), along_v(m)].map(|mut edge| {
            let reversed: Vec<_> = edge.iter().rev().copied().collect();
            edge = if reversed < edge { reversed } else { edge };
            edge
        })
    }

    /// How many edges are of one surface alone, collapsed ones left out.
    fn open_edges(shape: Shape) -> usize {
        let mut count: HashMap<_, u32> = HashMap::new();
        for edge in shape.surfaces().iter().flat_map(edges) {
            if edge.iter().any(|point| point[..3] != edge[0][..3]) {
                *count.entry(edge).or_default() += 1;
            }
        }
        assert!(count.values().all(|&surfaces| surfaces <= 2));
        count.values().filter(|&&surfaces| surfaces == 1).count()
    }

    #[test]
    fn there_are_no_cracks() {
        for (arcs, around, across) in [(Arcs::Rational, 3, 7), (Arcs::Polynomial, 4, 2), (Arcs::Polynomial, 7, 3)] {
            let torus = Shape::Torus { major: 3.1, minor: 0.7, height: 0.2, around, across, seam: 10.1, arcs };
            assert_eq!(torus.surfaces().len(), around * across);
            assert_eq!(open_edges(torus), 0, "{torus:?}");
            let sphere = Shape::Sphere { radius: 0.3, around, arcs };
            assert_eq!(sphere.surfaces().len(), 2 * around);
            assert_eq!(open_edges(sphere), 0, "{sphere:?}");
            let wall = |arc| Shape::Cylinder { radius: 0.3, height: 0.7, arc, around, arcs };
            assert_eq!(open_edges(wall([20.0, 360.0])), 2 * around);
            assert_eq!(open_edges(wall([20.0, 350.0])), 2 * around + 2);
        }
    }

    #[test]
    fn only_exact_shapes_are_rational() {
        for (arcs, rational, degree) in [(Arcs::Rational, true, 2), (Arcs::Polynomial, false, 3)] {
            for surface in (Shape::Sphere { radius: 1.0, around: 4, arcs }).surfaces() {
                assert_eq!((surface.rational, surface.degree_u, surface.degree_v), (rational, degree, degree));
            }
        }
    }
}
