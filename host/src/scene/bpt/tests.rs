use proptest::prelude::*;

use super::super::error::tests::assert_refused;
use super::super::model::Model;
use super::*;

const SQUARE: &str = "1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n";

fn strict(text: &str) -> Result<PatchFile, InputError> {
    parse("a.bpt", text, OnInvalid::Refuse)
}

fn lenient(text: &str) -> Result<PatchFile, InputError> {
    parse("a.bpt", text, OnInvalid::Skip)
}

/// A file of one surface of degrees 1 1 with `line` as its third point, which is line 5.
fn with_point(line: &str) -> String {
    format!("1\n{}", SQUARE.replace("1 0 0", line))
}

/// Asserts that the file is refused with and without skipping.
fn refused_always(text: &str, place: &str, message: &str) {
    assert_refused(strict(text), place, message);
    assert_refused(lenient(text), place, message);
}

/// Asserts that surface 1 of three is refused, or left out when told to skip.
fn refused_or_skipped(surface: &str, place: &str, message: &str) {
    let text = format!("3\n{SQUARE}{surface}{SQUARE}");
    assert_refused(strict(&text), place, message);
    let file = lenient(&text).expect("only surface 1 is left out");
    let numbers: Vec<_> = file.model.surfaces.iter().map(|surface| surface.number).collect();
    assert_eq!(numbers, [0, 2]);
    let [skipped] = &file.skipped[..] else { panic!("{:?}", file.skipped) };
    assert_eq!((skipped.kind, skipped.number, skipped.place.to_string()), ("surface", 1, place.to_owned()));
    assert!(skipped.reason.contains(message), "{skipped}");
}

#[test]
fn a_mixed_file_with_comments() {
    let text = "\u{feff}# two surfaces\r\n 2 # count\r\n\r\n1 2\r\n0 0 0\r\n0 1 0\r\n0 2 0\r\n1 0 0\r\n1 1 .5\r\n1 2 -1e-3\r\n\
                1 1\n0 0 0 1\n0 1 0 0.5\n1 0 0 1\n1 1 0 2";
    let model = strict(text).expect("valid").model;
    let [plain, rational] = &model.surfaces[..] else { panic!("{model:?}") };
    assert_eq!((plain.number, plain.degree_u, plain.degree_v, plain.rational), (0, 1, 2, false));
    assert_eq!(plain.points[4..], [[1.0, 1.0, 0.5, 1.0], [1.0, 2.0, -1e-3, 1.0]]);
    assert_eq!((rational.number, rational.rational), (1, true));
    assert_eq!(rational.points[1], [0.0, 1.0, 0.0, 0.5]);
}

#[test]
fn no_surfaces_is_a_file() {
    assert!(strict("0\n").expect("valid").model.surfaces.is_empty());
}

#[test]
fn empty_and_without_count() {
    refused_always("", "a.bpt:1:1", "the file is empty");
    refused_always("# only\n\n", "a.bpt:1:1", "the file is empty");
    refused_always("3 3\n", "a.bpt:1:1", "the first line is not the number of surfaces");
    refused_always("# x\n  two\n", "a.bpt:2:3", "the first line is not the number of surfaces");
    refused_always("-1\n", "a.bpt:1:1", "the first line is not the number of surfaces");
}

#[test]
fn cut_off() {
    refused_always(
        "1\n1 1\n0 0 0\n0 1 0\n",
        "a.bpt:4:1",
        "surface 0 is cut off: it has 2 of the 4 points of degrees 1 1",
    );
    refused_always("1\n3 3\n", "a.bpt:2:1", "surface 0 is cut off: it has 0 of the 16 points of degrees 3 3");
    refused_always(
        &format!("2\n1 1\n0 0 0\n0 1 0\n1 0 0\n{SQUARE}"),
        "a.bpt:6:1",
        "surface 0 is cut off: it has 3 of the 4 points",
    );
}

#[test]
fn counts_that_lie() {
    let lie = "the file holds 1 of the 99999999999 surfaces that its first line promises";
    refused_always(&format!("99999999999\n{SQUARE}"), "a.bpt:6:1", lie);
    refused_always(&format!("2\n{SQUARE}"), "a.bpt:6:1", "the file holds 1 of the 2 surfaces");
    refused_always(&format!("1\n{SQUARE}{SQUARE}"), "a.bpt:7:1", "the file goes on after the 1 surfaces");
    refused_always("1\n99999999999 99999999999\n0 0 0\n", "a.bpt:3:1", "cut off");
    refused_always("1\n18446744073709551615 2\n0 0 0\n", "a.bpt:3:1", "cut off");
    refused_always("99999999999999999999999999\n", "a.bpt:1:1", "not the number of surfaces");
}

#[test]
fn too_many_points() {
    let more = "surface 0 has more points than its degrees say";
    refused_always(&format!("1\n{SQUARE}2 2 2\n"), "a.bpt:7:1", more);
    refused_always(&format!("2\n{SQUARE}2 2 2\n{SQUARE}"), "a.bpt:7:1", more);
}

#[test]
fn degrees() {
    refused_or_skipped("0 1\n0 0 0\n0 1 0\n", "a.bpt:7:1", "surface 1 has degree 0 in u");
    let points = "0 0 0\n".repeat(34);
    refused_or_skipped(&format!("1 16\n{points}"), "a.bpt:7:3", "surface 1 has degree 16 in v");
    refused_always("1\n1 -1\n0 0 0\n", "a.bpt:2:3", "the degree of surface 0 in v is not a whole number from 1 to 15");
    refused_always("1\n1.5 1\n", "a.bpt:2:1", "the degree of surface 0 in u is not");
    refused_always("1\n3\n", "a.bpt:2:1", "surface 0 does not start with its two degrees");
    refused_always("1\n1 1 1\n", "a.bpt:2:1", "surface 0 does not start with its two degrees");
    let full = format!("1\n15 15\n{}", "1 2 3\n".repeat(256));
    assert_eq!(strict(&full).expect("valid").model.surfaces[0].points.len(), 256);
}

#[test]
fn numbers_that_are_none() {
    refused_always(&with_point("1 zero 0"), "a.bpt:5:3", "y of point 2 of surface 0 is not a number: `zero`");
    refused_always(&with_point("1 0 0,0"), "a.bpt:5:5", "z of point 2 of surface 0 is not a number: `0,0`");
}

#[test]
fn values_that_are_not_valid() {
    let of = |point: &str| format!("1 1\n0 0 0\n0 1 0\n{point}\n1 1 0\n");
    refused_or_skipped(&of("1 nan 0"), "a.bpt:10:3", "y of point 2 of surface 1 is not a number (NaN)");
    refused_or_skipped(&of("-inf 0 0"), "a.bpt:10:1", "x of point 2 of surface 1 is infinite");
    refused_or_skipped(&of("1 0 1e999"), "a.bpt:10:5", "z of point 2 of surface 1 is too large");
    let weighted = |weight: &str| format!("1 1\n0 0 0 1\n0 1 0 1\n1 0 0 {weight}\n1 1 0 1\n");
    refused_or_skipped(&weighted("0"), "a.bpt:10:7", "the weight of point 2 of surface 1 is not above 0");
    refused_or_skipped(&weighted("-1"), "a.bpt:10:7", "the weight of point 2 of surface 1 is not above 0");
    refused_or_skipped(&weighted("NaN"), "a.bpt:10:7", "the weight of point 2 of surface 1 is not a number");
}

#[test]
fn damage_behind_an_invalid_value_is_refused() {
    refused_always("1\n1 1\n0 nan 0\n0 1 0\n", "a.bpt:4:1", "cut off");
}

#[test]
fn many_invalid_surfaces_take_no_square_of_time() {
    let invalid = SQUARE.replace("0 0 0", "nan 0 0");
    let file = lenient(&format!("50000\n{}", invalid.repeat(50_000))).expect("all are left out");
    let last = file.skipped.last().expect("one of many");
    assert_eq!((last.number, last.place.line), (49_999, 2 + 5 * 49_999 + 1));
}

#[test]
fn wrong_arity() {
    refused_always(&with_point("1 0 0 1"), "a.bpt:5:1", "point 2 of surface 0 has 4 numbers, those before it 3");
    refused_always(&with_point("1 0 0 1 7"), "a.bpt:5:1", "point 2 of surface 0 has 5 numbers");
    refused_always(&with_point("1"), "a.bpt:5:1", "point 2 of surface 0 has 1 numbers");
}

fn surface() -> impl Strategy<Value = ModelSurface> {
    (1..=MAX_DEGREE, 1..=MAX_DEGREE, any::<bool>()).prop_flat_map(|(degree_u, degree_v, rational)| {
        let weight = if rational { (1e-3..1e3_f64).boxed() } else { Just(1.0).boxed() };
        let point = (any::<[f64; 3]>(), weight).prop_map(|([x, y, z], w)| [x, y, z, w]);
        proptest::collection::vec(point, (degree_u + 1) * (degree_v + 1)).prop_map(move |points| ModelSurface {
            number: 0,
            degree_u,
            degree_v,
            rational,
            points,
            knots: None,
        })
    })
}

fn bits(model: &Model) -> Vec<[u64; 4]> {
    model.surfaces.iter().flat_map(|surface| &surface.points).map(|point| point.map(f64::to_bits)).collect()
}

proptest! {
    #[test]
    fn what_is_written_reads_back(mut surfaces in proptest::collection::vec(surface(), 0..4)) {
        for (number, surface) in surfaces.iter_mut().enumerate() {
            surface.number = number;
        }
        let model = Model { surfaces };
        let file = strict(&write(&model)).expect("what was written is valid");
        prop_assert_eq!(bits(&file.model), bits(&model));
        prop_assert_eq!(file.model, model);
    }

    #[test]
    fn damage_never_panics(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6)) {
        let mut bytes = format!("2 # two\n{SQUARE}{}", SQUARE.replace('\n', " 1\n").replace("1 1 1", "1 1")).into_bytes();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        let text = String::from_utf8_lossy(&bytes);
        for result in [strict(&text), lenient(&text)] {
            if let Err(error) = result {
                prop_assert!(super::super::error::tests::rendered(&error).contains("[a.bpt:"));
            }
        }
    }

    #[test]
    fn any_text_never_panics(text in "[0-9 .#\n\r\u{e9}ae-]{0,60}") {
        let _ = (strict(&text), lenient(&text));
    }
}
