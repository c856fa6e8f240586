use proptest::prelude::*;

use super::super::error::tests::{assert_refused, rendered};
use super::*;

/// What geomdl itself wrote.
const WRITTEN: &str = include_str!("../../../../fixtures/patches/nurbs.json");

/// A surface on lines of their own, as they are numbered here, in a file in which it starts on line 2.
const SURFACE: [&str; 11] = [
    "{\"type\": \"spline\", \"rational\": true, \"dimension\": 3, \"delta\": [0.1, 0.1],",
    "\"degree_u\": 2,",
    "\"degree_v\": 1,",
    "\"knotvector_u\": [0, 0, 0, 1, 2, 2, 2],",
    "\"knotvector_v\": [0, 0, 0.5, 1, 1],",
    "\"size_u\": 4,",
    "\"size_v\": 3,",
    "\"control_points\": {\"points\": [[0, 0, 0], [0, 1, 0], [0, 2, 0], [1, 0, 0], [1, 1, 1], [1, 2, 0],",
    "[2, 0, 0], [2, 1, 1], [2, 2, 0], [3, 0, 0], [3, 1, 0], [3, 2, 0]],",
    "\"weights\": [1, 1, 1, 1, 2, 1, 1, 0.5, 1, 1, 1, 1]},",
    "\"name\": \"a \\\"NaN\\\"\", \"id\": 0}",
];

fn file(surfaces: &[String]) -> String {
    let count = surfaces.len();
    format!("{{\"shape\": {{\"type\": \"surface\", \"count\": {count}, \"data\": [\n{}\n]}}}}\n", surfaces.join(",\n"))
}

/// The surface with a part of it replaced.
fn surface_with(from: &str, to: &str) -> String {
    let surface = SURFACE.join("\n");
    assert_eq!(surface.matches(from).count(), 1, "{from}");
    surface.replace(from, to)
}

fn strict(text: &str) -> Result<PatchFile, InputError> {
    parse("a.json", text, OnInvalid::Refuse)
}

/// Asserts that the second surface is refused, or left out when told to skip; it starts on line 13.
fn refused(from: &str, to: &str, place: &str, message: &str) {
    let whole = SURFACE.join("\n");
    let text = file(&[whole.clone(), surface_with(from, to), whole]);
    assert_refused(strict(&text), place, message);
    let left = parse("a.json", &text, OnInvalid::Skip).expect("only surface 1 is left out");
    let numbers: Vec<_> = left.splines.iter().map(|spline| spline.surface).collect();
    assert_eq!(numbers, [0, 2]);
    assert!(left.model.surfaces.iter().all(|piece| piece.number != 1));
    let [skipped] = &left.skipped[..] else { panic!("{:?}", left.skipped) };
    assert_eq!((skipped.kind, skipped.number, skipped.place.to_string()), ("surface", 1, place.to_owned()));
    assert!(skipped.reason.contains(message), "{skipped}");
}

#[test]
fn what_geomdl_writes() {
    let file = strict(WRITTEN).expect("valid");
    let of = |k: usize| {
        let SplineSummary { surface, rational, degrees, control_points, spans, pieces, trims_ignored, .. } =
            file.splines[k];
        (surface, rational, degrees, control_points, spans, pieces, trims_ignored)
    };
    assert_eq!(of(0), (0, false, [3, 2], [6, 4], [3, 2], 6, 0));
    assert_eq!(of(1), (1, true, [2, 3], [4, 6], [2, 3], 6, 1));
    assert_eq!(of(2), (2, true, [2, 4], [5, 5], [2, 1], 2, 0));
    assert_eq!(of(3), (3, false, [1, 5], [3, 7], [2, 2], 4, 0));
    assert_eq!(file.model.surfaces.iter().filter(|piece| piece.number == 1).count(), 6);
    assert!(file.skipped.is_empty());
}

#[test]
fn a_surface_is_read_as_written() {
    let text = file(&[SURFACE.join("\n")]);
    for text in [text.clone(), format!("\u{feff}{text}"), text.replace('\n', "\r\n"), text.replace('\n', " ")] {
        let file = strict(&text).expect("valid");
        assert_eq!(file.splines[0].domain, [[0.0, 2.0], [0.0, 1.0]]);
        let pieces = &file.model.surfaces;
        assert_eq!(pieces.len(), 4);
        assert!(pieces.iter().all(|piece| piece.rational && (piece.degree_u, piece.degree_v) == (2, 1)));
        // v runs fastest: the second piece begins at the middle column.
        assert_eq!(pieces[1].points[0], [0.0, 1.0, 0.0, 1.0]);
        assert_eq!(pieces[3].points[5], [3.0, 2.0, 0.0, 1.0]);
        assert_eq!(pieces[3].parameters(0.5, 0.5), [1.5, 0.75]);
    }
    // Without weights it is polynomial, whatever `rational` says.
    let plain = surface_with("\"weights\": [1, 1, 1, 1, 2, 1, 1, 0.5, 1, 1, 1, 1]", "\"weights\": null");
    let read = strict(&file(&[plain])).expect("valid");
    assert!(!read.splines[0].rational && read.model.surfaces.iter().all(|piece| !piece.rational));
}

#[test]
fn no_surfaces_is_a_file() {
    assert!(strict(&file(&[])).expect("valid").model.surfaces.is_empty());
}

#[test]
fn what_is_no_file_of_surfaces() {
    let refused = |text: &str, place: &str, message: &str| assert_refused(strict(text), place, message);
    refused("", "a.json:1:1", "the file is empty");
    refused(" \n ", "a.json:2:1", "the file is empty");
    refused("[]", "a.json:1:1", "the file is a list");
    refused("{}", "a.json:1:1", "the file has no `shape`");
    refused("{\"shapes\": {}}", "a.json:1:1", "(is it `shapes`?)");
    refused("{\"shape\": 5}", "a.json:1:11", "`shape` is `5`");
    refused("{\"shape\": {}}", "a.json:1:11", "`shape` has no `type`");
    for kind in ["curve", "volume", "spline"] {
        let text = format!("{{\"shape\": {{\"type\": \"{kind}\", \"count\": 1, \"data\": [{{}}]}}}}");
        refused(&text, "a.json:1:20", &format!("of type `{kind}`, not `surface`"));
    }
    let text = file(&[SURFACE.join("\n")]);
    refused(&text.replace("\"count\": 1", "\"count\": 2"), "a.json:1:40", "holds 1 of the 2 surfaces");
    refused(&text.replace("\"count\": 1", "\"count\": -1"), "a.json:1:40", "`count` of `shape` is `-1`");
    refused(&text.replace("\"data\"", "\"date\""), "a.json:1:11", "has no `data` (is it `date`?)");
    // Cut off anywhere, it is refused, and once.
    for end in (0..text.trim_end().len()).filter(|&end| text.is_char_boundary(end)) {
        let error = strict(&text[..end]).expect_err("cut off");
        assert!(error.place().is_some() && rendered(&error).contains("help: "), "{error}");
    }
    refused("{\"shape\": {\"type\": \"surface\",\n \"data\": [{]}}", "a.json:2:12", "not JSON");
    refused(&text.replace("\"size_u\": 4,", "\"size_u\": 04,"), "a.json:7:12", "not JSON: invalid number");
    refused(&text.replace("\"size_u\": 4,", "\"size_u\": nan,"), "a.json:7:12", "not JSON");
    refused(&(text.clone() + "x"), "a.json:14:1", "not JSON: trailing characters");
}

#[test]
fn surfaces_are_refused_with_their_place() {
    refused("\"degree_u\": 2", "\"degree\": 2", "a.json:13:1", "surface 1 has no `degree_u` (is it `degree`?)");
    refused("\"degree_u\": 2", "\"degree_u\": 0", "a.json:14:13", "surface 1 has degree 0 in u");
    refused("\"degree_v\": 1", "\"degree_v\": 16", "a.json:15:13", "surface 1 has degree 16 in v");
    refused("\"degree_u\": 2", "\"degree_u\": 2.5", "a.json:14:13", "the degree of surface 1 in u is `2.5`");
    refused("\"degree_u\": 2", "\"degree_u\": \"two\"", "a.json:14:13", "is `\"two\"`");
    refused("\"degree_u\": 2", "\"degree_u\": NaN", "a.json:14:13", "is `NaN`");
    refused("\"size_u\": 4", "\"size_u\": 2", "a.json:18:11", "2 control points in u, too few for degree 2");
    refused("\"size_v\": 3", "\"size_v\": 4", "a.json:20:30", "12 control points, not the 4 x 4");
    refused("\"size_v\": 3", "\"size_v\": 9223372036854775807", "a.json:20:30", "12 control points");
    refused(", [3, 2, 0]]", "]", "a.json:20:30", "11 control points, not the 4 x 3");
    refused("[3, 2, 0]]", "[3, 2, 0, 1]]", "a.json:21:56", "point 11 of surface 1 has 4 numbers");
    refused("[3, 2, 0]]", "[3, 2]]", "a.json:21:56", "point 11 of surface 1 has 2 numbers");
    refused("[3, 2, 0]]", "320]", "a.json:21:56", "point 11 of surface 1 is `320`");
    refused("[3, 2, 0]]", "[3, \"2\", 0]]", "a.json:21:60", "y of point 11 of surface 1 is not a number: `\"2\"`");
    refused("[3, 2, 0]]", "[3, NaN, 0]]", "a.json:21:60", "y of point 11 of surface 1 is not a number (NaN)");
    refused("[3, 2, 0]]", "[3, 2, Infinity]]", "a.json:21:63", "z of point 11 of surface 1 is infinite");
    refused("[3, 2, 0]]", "[-Infinity, 2, 0]]", "a.json:21:57", "x of point 11 of surface 1 is infinite");
    refused("[3, 2, 0]]", "[1e309, 2, 0]]", "a.json:21:57", "is too large");
    refused("[3, 2, 0]]", "[null, 2, 0]]", "a.json:21:57", "is not a number: `null`");
    refused("2, 1, 1, 0.5", "2, 1, 1, 0", "a.json:22:34", "the weight of point 7 of surface 1 is not above 0");
    refused("2, 1, 1, 0.5", "2, 1, 1, -0.5", "a.json:22:34", "not above 0");
    refused("2, 1, 1, 0.5", "2, 1, 1, NaN", "a.json:22:34", "the weight of point 7 of surface 1 is not a number");
    refused("2, 1, 1, 0.5", "2, 1, 1", "a.json:22:12", "11 weights for 12 control points");
    refused("\"dimension\": 3", "\"dimension\": 2", "a.json:13:51", "surface 1 is of dimension 2");
    refused("\"spline\"", "\"freeform\"", "a.json:13:10", "of type `freeform`, not `spline`");
    refused("\"id\": 0", "\"trims\": 5", "a.json:23:31", "`trims` of surface 1 is `5`");
}

#[test]
fn knots_are_refused_with_their_place() {
    let u = "[0, 0, 0, 1, 2, 2, 2]";
    let knots = |to: &str, place: &str, message: &str| refused(u, to, place, message);
    knots("[0, 0, 0, 1, 2, 2]", "a.json:16:17", "surface 1 has 6 knots in u, not 7");
    knots("[0, 0, 0, 1, 2, 2, 2, 2]", "a.json:16:17", "surface 1 has 8 knots in u, not 7");
    knots("[]", "a.json:16:17", "surface 1 has 0 knots in u, not 7");
    knots("7", "a.json:16:17", "`knotvector_u` of surface 1 is `7`");
    knots("[0, 0, 0, 3, 2, 2, 2]", "a.json:16:30", "knot 4 of surface 1 in u is less than the 3 before it");
    knots("[0, 0, 0, 0, 2, 2, 2]", "a.json:16:27", "knot 3 of surface 1 in u is equal to the 3 before it");
    knots("[0, 0, 0, 2, 2, 2, 2]", "a.json:16:36", "knot 6 of surface 1 in u is equal to the 3 before it");
    knots("[0, 1, 2, 2, 2, 3, 4]", "a.json:16:30", "surface 1 is empty in u: its knots 2 to 4 are equal");
    knots("[0, 0, 0, NaN, 2, 2, 2]", "a.json:16:27", "knot 3 of surface 1 in u is not a number (NaN)");
    knots("[0, 0, 0, 1, 2, 2, Infinity]", "a.json:16:36", "knot 6 of surface 1 in u is infinite");
    knots("[0, 0, 0, \"1\", 2, 2, 2]", "a.json:16:27", "knot 3 of surface 1 in u is not a number");
    refused("[0, 0, 0.5, 1, 1]", "[0, 0.5, 0.5, 0.5, 1]", "a.json:17:31", "surface 1 is empty in v");
    // Within the domain, as often as the degree and no more.
    let six = |knots: &str| {
        let points: Vec<String> = (0..18).map(|k| format!("[{}, {}, 0]", k / 3, k % 3)).collect();
        let points = points.join(", ");
        let surface = format!(
            "{{\"degree_u\": 2, \"degree_v\": 1, \"size_u\": 6, \"size_v\": 3,\n\"knotvector_u\": {knots},\n\
             \"knotvector_v\": [0, 0, 1, 2, 2], \"control_points\": {{\"points\": [{points}]}}}}"
        );
        strict(&file(&[surface]))
    };
    assert_eq!(six("[0, 0, 0, 1, 1, 2, 3, 3, 3]").expect("valid").splines[0].spans, [3, 2]);
    assert_refused(
        six("[0, 0, 0, 1, 1, 1, 3, 3, 3]"),
        "a.json:3:33",
        "knot 5 of surface 0 in u is equal to the 2 before it",
    );
    let unclamped = six("[-1, 0, 0, 0, 1, 2, 2, 2, 3]").expect("a knot three times at an end");
    assert_eq!(unclamped.splines[0].domain[0], [0.0, 2.0]);
}

#[test]
fn weights_that_overflow_are_refused_at_their_point() {
    let surface = surface_with("[1, 1, 1]", "[1, 1e308, 1]");
    assert_refused(strict(&file(&[surface])), "a.json:9:75", "point 4 of surface 0 times its weight is too large");
}

#[test]
fn trims_are_counted() {
    let trims = |text: &str| {
        let file = strict(&file(&[surface_with("\"id\": 0", &format!("\"trims\": {text}"))]));
        file.expect("valid").splines[0].trims_ignored
    };
    assert_eq!(trims("null"), 0);
    assert_eq!(trims("{\"count\": 0, \"data\": []}"), 0);
    assert_eq!(trims("{\"count\": 2, \"data\": [{\"type\": \"spline\"}, {\"type\": \"freeform\"}]}"), 2);
}

proptest! {
    #[test]
    fn damage_never_panics(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6)) {
        let mut bytes = file(&[SURFACE.join("\n"), SURFACE.join("\n")]).into_bytes();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        let text = String::from_utf8_lossy(&bytes);
        for on_invalid in [OnInvalid::Refuse, OnInvalid::Skip] {
            if let Err(error) = parse("a.json", &text, on_invalid) {
                prop_assert!(rendered(&error).contains("help: "), "{}", error);
            }
        }
    }
}
