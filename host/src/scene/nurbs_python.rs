//! B-spline surfaces in the JSON that NURBS-Python writes, `geomdl.exchange.export_json` (geomdl 5.4).
//!
//! An object `shape` has the `type` `"surface"`, a `count`, and in the list `data` one object per surface: `degree_u` and
//! `degree_v` (1 to 15); `knotvector_u` and `knotvector_v`; `size_u` and `size_v`, the numbers of control points; and
//! `control_points` with the list `points` of `[x, y, z]`, v running fastest, and for a rational surface the list `weights`,
//! one above 0 for each point, not multiplied in. A knot vector has size + degree + 1 numbers, none less than the one before
//! it; what else it has to be says [`BSpline::new`](patchray::bspline::BSpline::new). Clamped or not is all one, and knots
//! stay as they are written.
//!
//! `trims` are not heeded: the whole surface is taken, as geomdl's own evaluation takes it, and the commands say so on
//! standard error. All else, such as `delta`, `name`, `id` and `reversed`, says nothing about the surface and is passed over.
//! Curves, volumes and shapes that are no splines are refused by name. Python's `NaN` and `Infinity` are refused with their
//! place.
//!
//! ```
//! use patchray_host::scene::{error::OnInvalid, nurbs_python};
//! let text = r#"{"shape": {"type": "surface", "count": 1, "data": [{
//!     "degree_u": 1, "degree_v": 1, "size_u": 3, "size_v": 2,
//!     "knotvector_u": [0, 0, 0.5, 2, 2], "knotvector_v": [0, 0, 1, 1],
//!     "control_points": {"points": [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [2, 0, 1], [2, 1, 1]]}
//! }]}}"#;
//! let file = nurbs_python::parse("bent.json", text, OnInvalid::Refuse)?;
//! assert_eq!(file.splines[0].pieces, 2);
//! let second = &file.model.surfaces[1];
//! assert_eq!((second.number, second.parameters(0.5, 0.5)), (0, [1.25, 0.5]));
//! assert_eq!(second.points[3], [2.0, 1.0, 1.0, 1.0]);
//! # Ok::<(), patchray_host::scene::error::InputError>(())
//! ```
use patchray::bernstein::MAX_DEGREE;
use patchray::bspline::BSplineError;
use patchray::surface::Direction;

use super::error::{InputError, OnInvalid, Skipped};
use super::json::{Document, Node, Object};
use super::model::ModelSurface;
use super::patches::PatchFile;
use super::source::SourceText;
use super::spline::{Spline, SplineError, SplineSummary};

/// Reads the text of a file.
///
/// # Errors
/// The text is not in the format, or holds an invalid surface that is not to be skipped. All that is wrong within one
/// surface is skipped with it, since JSON says where it ends.
pub fn read(source: &SourceText, on_invalid: OnInvalid) -> Result<PatchFile, InputError> {
    let document = Document::new(source);
    let mut file = PatchFile::default();
    for (number, node) in surfaces(&document)?.into_iter().enumerate() {
        node.count_lines();
        match surface(number, node) {
            Ok((mut pieces, summary)) => {
                file.model.surfaces.append(&mut pieces);
                file.splines.push(summary);
            }
            Err(InputError::Refused(why)) if on_invalid == OnInvalid::Skip => {
                file.skipped.push(Skipped::from_refusal("surface", number, &why));
            }
            Err(error) => return Err(error),
        }
    }
    Ok(file)
}

/// Reads `text`, a whole file; `name` stands for its path in errors.
///
/// # Errors
/// As [`read`].
pub fn parse(name: &str, text: &str, on_invalid: OnInvalid) -> Result<PatchFile, InputError> {
    read(&SourceText::new(name, text), on_invalid)
}

/// The list of surfaces.
fn surfaces<'d>(document: &'d Document<'d>) -> Result<Vec<Node<'d>>, InputError> {
    let file = document.root()?.object(format_args!("the file"), &["shape"])?;
    let shape =
        file.get("shape", format_args!("the file"))?.object(format_args!("`shape`"), &["type", "count", "data"])?;
    let of_shape = format_args!("`shape`");
    let kind = shape.get("type", of_shape)?;
    let name = kind.text(format_args!("`type` of `shape`"))?;
    if name != "surface" {
        return Err(kind.refuse(
            format!("the shape is of type `{name}`, not `surface`"),
            "not a surface",
            "only surfaces can be traced: export a surface, or a container of surfaces",
        ));
    }
    let data = shape.get("data", of_shape)?.list(format_args!("`data` of `shape`"))?;
    if let Some(count) = shape.find("count") {
        let promised = count.whole(format_args!("`count` of `shape`"))?;
        if promised != data.len() as u64 {
            return Err(count.refuse(
                format!("`data` holds {} of the {promised} surfaces that `count` promises", data.len()),
                "not their number",
                format!("add the missing surfaces, or write `\"count\": {}`", data.len()),
            ));
        }
    }
    Ok(data)
}

/// The names that a surface has values for.
const OF_SURFACE: [&str; 15] = [
    "type",
    "rational",
    "dimension",
    "degree_u",
    "degree_v",
    "knotvector_u",
    "knotvector_v",
    "size_u",
    "size_v",
    "control_points",
    "delta",
    "trims",
    "reversed",
    "name",
    "id",
];

/// Reads and cuts a surface.
fn surface(number: usize, node: Node<'_>) -> Result<(Vec<ModelSurface>, SplineSummary), InputError> {
    let this = format_args!("surface {number}");
    let object = node.object(this, &OF_SURFACE)?;
    check_kind(number, &object)?;
    let [u, v] = ["u", "v"].map(|direction| Axis::read(number, &object, direction));
    let (u, v) = (u?, v?);
    let of_net = format_args!("`control_points` of surface {number}");
    let net = object.get("control_points", this)?.object(of_net, &["points", "weights"])?;
    let list = net.get("points", of_net)?;
    let points = list.list(format_args!("`points` of surface {number}"))?;
    if u.size.checked_mul(v.size) != Some(points.len() as u64) {
        return Err(list.refuse(
            format!(
                "surface {number} has {} control points, not the {} x {} of its sizes",
                points.len(),
                u.size,
                v.size
            ),
            "not as many as `size_u` times `size_v`",
            "add the missing points or remove those too many, or correct `size_u` and `size_v`",
        ));
    }
    u.check_knots(number)?;
    v.check_knots(number)?;
    let weights = match net.find("weights").filter(|weights| !weights.is_null()) {
        Some(list) => Some(read_weights(number, list, points.len())?),
        None => None,
    };
    let mut spline = Spline {
        degrees: [u.degree, v.degree],
        knots: [Vec::new(), Vec::new()],
        rational: weights.is_some(),
        points: Vec::with_capacity(points.len()),
    };
    for (k, point) in points.iter().enumerate() {
        let [x, y, z] = read_point(number, k, *point)?;
        let weight = weights.as_ref().and_then(|weights| weights.get(k)).copied();
        spline.points.push([x, y, z, weight.unwrap_or(1.0)]);
    }
    spline.knots = [u.values(number)?, v.values(number)?];
    let (surfaces, mut summary) = spline.cut(number).map_err(|error| match error {
        SplineError::Invalid(error) => refuse_spline(number, &error, &spline, [&u, &v], &points, list),
        SplineError::Memory { points } => node.refuse(
            format!(
                "surface {number} becomes Bézier surfaces of more control points than there is memory for: {points}"
            ),
            "this surface",
            "reduce its degrees or its knots, or split it",
        ),
    })?;
    summary.trims_ignored = trims(number, &object)?;
    Ok((surfaces, summary))
}

/// Refuses what is no spline in space, where the file says so.
fn check_kind(number: usize, object: &Object<'_>) -> Result<(), InputError> {
    if let Some(kind) = object.find("type") {
        let name = kind.text(format_args!("`type` of surface {number}"))?;
        if name != "spline" {
            return Err(kind.refuse(
                format!("surface {number} is of type `{name}`, not `spline`"),
                "not a spline",
                "only B-spline surfaces can be traced",
            ));
        }
    }
    if let Some(dimension) = object.find("dimension") {
        let found = dimension.whole(format_args!("`dimension` of surface {number}"))?;
        if found != 3 {
            return Err(dimension.refuse(
                format!("surface {number} is of dimension {found}"),
                "not 3",
                "write points of three coordinates, and `\"dimension\": 3`",
            ));
        }
    }
    Ok(())
}

/// What a surface has for each of u and v.
struct Axis<'d> {
    direction: &'static str,
    degree: usize,
    size: u64,
    list: Node<'d>,
    knots: Vec<Node<'d>>,
}

impl<'d> Axis<'d> {
    fn read(number: usize, object: &Object<'d>, direction: &'static str) -> Result<Self, InputError> {
        let this = format_args!("surface {number}");
        let field = |name: &str| object.get(&format!("{name}_{direction}"), this);
        let node = field("degree")?;
        let degree = node.whole(format_args!("the degree of surface {number} in {direction}"))?;
        if degree == 0 || degree > MAX_DEGREE as u64 {
            return Err(node.refuse(
                format!("surface {number} has degree {degree} in {direction}"),
                format!("not from 1 to {MAX_DEGREE}"),
                if degree == 0 {
                    "a curve is no surface: raise the degree to 1 at least"
                } else {
                    "split the surface or reduce its degree"
                },
            ));
        }
        let node = field("size")?;
        let size = node.whole(format_args!("the size of surface {number} in {direction}"))?;
        if size <= degree {
            return Err(node.refuse(
                format!("surface {number} has {size} control points in {direction}, too few for degree {degree}"),
                "too few",
                format!("degree {degree} needs {} points at least: add points, or reduce the degree", degree + 1),
            ));
        }
        let list = field("knotvector")?;
        let knots = list.list(format_args!("`knotvector_{direction}` of surface {number}"))?;
        // At most MAX_DEGREE here.
        Ok(Axis { direction, degree: degree as usize, size, list, knots })
    }

    /// Refuses a number of knots that does not go with the number of points.
    fn check_knots(&self, number: usize) -> Result<(), InputError> {
        let Axis { direction, degree, size, .. } = self;
        let (found, needed) = (self.knots.len() as u64, size.saturating_add(*degree as u64 + 1));
        if found == needed {
            return Ok(());
        }
        Err(self.list.refuse(
            format!("surface {number} has {found} knots in {direction}, not {needed}"),
            if found < needed { "too few" } else { "too many" },
            format!("{size} control points of degree {degree} have {size} + {degree} + 1 knots"),
        ))
    }

    /// Where a knot is.
    fn knot(&self, index: usize) -> Node<'d> {
        self.knots.get(index).copied().unwrap_or(self.list)
    }

    /// The knots as numbers.
    fn values(&self, number: usize) -> Result<Vec<f64>, InputError> {
        let knot =
            |(k, node): (usize, &Node)| node.number(format_args!("knot {k} of surface {number} in {}", self.direction));
        self.knots.iter().enumerate().map(knot).collect()
    }
}

fn read_weights(number: usize, list: Node<'_>, points: usize) -> Result<Vec<f64>, InputError> {
    let weights = list.list(format_args!("`weights` of surface {number}"))?;
    if weights.len() != points {
        return Err(list.refuse(
            format!("surface {number} has {} weights for {points} control points", weights.len()),
            "not as many as points",
            "write a weight for every point (1 where there is none), or leave `weights` out",
        ));
    }
    let weight = |(k, node): (usize, &Node)| {
        let weight = node.number(format_args!("the weight of point {k} of surface {number}"))?;
        if weight > 0.0 {
            return Ok(weight);
        }
        Err(node.refuse(
            format!("the weight of point {k} of surface {number} is not above 0"),
            "not valid",
            "write a weight above 0; it is not multiplied into x, y and z",
        ))
    };
    weights.iter().enumerate().map(weight).collect()
}

fn read_point(number: usize, k: usize, node: Node<'_>) -> Result<[f64; 3], InputError> {
    let coordinates = node.list(format_args!("point {k} of surface {number}"))?;
    let Ok(coordinates) = <[Node; 3]>::try_from(coordinates.as_slice()) else {
        return Err(node.refuse(
            format!("point {k} of surface {number} has {} numbers", coordinates.len()),
            "three are expected",
            "write a point as `[x, y, z]`; weights have a list of their own, `weights`",
        ));
    };
    let mut point = [0.0; 3];
    for ((value, node), name) in point.iter_mut().zip(coordinates).zip(["x", "y", "z"]) {
        *value = node.number(format_args!("{name} of point {k} of surface {number}"))?;
    }
    Ok(point)
}

/// The number of trimming curves.
fn trims(number: usize, object: &Object<'_>) -> Result<usize, InputError> {
    let Some(trims) = object.find("trims").filter(|trims| !trims.is_null()) else {
        return Ok(0);
    };
    let this = format_args!("`trims` of surface {number}");
    Ok(trims.object(this, &["count", "data"])?.get("data", this)?.list(this)?.len())
}

/// The refusal for knots or points that make no surface.
fn refuse_spline(
    number: usize,
    error: &BSplineError,
    spline: &Spline,
    axes: [&Axis<'_>; 2],
    points: &[Node<'_>],
    list: Node<'_>,
) -> InputError {
    let side = |direction: Direction| match direction {
        Direction::U => (axes[0], &spline.knots[0]),
        Direction::V => (axes[1], &spline.knots[1]),
    };
    match *error {
        BSplineError::Decreasing { direction, index } => {
            let (axis, knots) = side(direction);
            let before = index.checked_sub(1).and_then(|before| knots.get(before)).copied().unwrap_or_default();
            axis.knot(index).refuse(
                format!("knot {index} of surface {number} in {direction} is less than the {before} before it"),
                "decreasing",
                "write the knots in ascending order; equal ones may follow one another",
            )
        }
        BSplineError::Empty { direction, first, last } => {
            let (axis, _) = side(direction);
            axis.knot(last).refuse(
                format!("surface {number} is empty in {direction}: its knots {first} to {last} are equal"),
                format!("not above knot {first}"),
                "a surface reaches from the knot with the degree's number to the one with the number of points: let the \
                 second be larger than the first",
            )
        }
        BSplineError::Multiplicity { direction, index, most } => {
            let (axis, _) = side(direction);
            axis.knot(index).refuse(
                format!("knot {index} of surface {number} in {direction} is equal to the {most} before it"),
                "one too many",
                format!(
                    "of degree {0}, equal knots may be {0} within the surface, and {1} at its ends: remove a knot and a row \
                     of points, or split the surface here",
                    axis.degree,
                    axis.degree + 1
                ),
            )
        }
        BSplineError::NotFinite(k) => points.get(k).copied().unwrap_or(list).refuse(
            format!("point {k} of surface {number} times its weight is too large for a 64-bit floating point number"),
            "too large",
            "use smaller units or weights: at most 1.7e308",
        ),
        // The rest was looked at before, where its place was at hand.
        _ => list.refuse(format!("surface {number} is not valid: {error}"), "this surface", "correct it"),
    }
}

#[cfg(test)]
mod tests;
