use std::io::Write;

use proptest::prelude::*;

use super::super::error::tests::{assert_refused, rendered};
use super::*;

const HEADER: &str = "ox,oy,oz,dx,dy,dz,tmin,tmax,line";

fn strict(text: &str) -> Result<RayBatch, InputError> {
    parse("r.csv", text, OnInvalid::Refuse)
}

fn lenient(text: &str) -> Result<RayBatch, InputError> {
    parse("r.csv", text, OnInvalid::Skip)
}

fn refused_always(text: &str, place: &str, message: &str) {
    assert_refused(strict(text), place, message);
    assert_refused(lenient(text), place, message);
}

/// Asserts that the second of three rays is refused, or kept as invalid when told to skip.
fn refused_or_kept(line: &str, place: &str, message: &str) {
    let text = format!("{HEADER}\n0,0,0,0,0,1,0,1,7\n{line}\n1,1,1,1,0,0,0,inf,9\n");
    assert_refused(strict(&text), place, message);
    let batch = lenient(&text).expect("kept");
    assert_eq!(batch.rays.iter().map(|ray| ray.valid).collect::<Vec<_>>(), [true, false, true]);
    assert_eq!((batch.invalid, batch.rays[2].scan_line), (1, 9));
    let skipped = batch.first_invalid.expect("it is named");
    assert_eq!((skipped.number, skipped.place.to_string()), (1, place.to_owned()));
    assert!(skipped.reason.contains(message), "{skipped}");
}

#[test]
fn columns_by_name_with_defaults() {
    let batch = strict("dz, dy, dx ,oz,oy,ox\r\n1,2,3,4,5,6\r\n\r\n-1,0,0,0,0,1e-3").expect("valid");
    let ray = batch.rays[0];
    assert_eq!((ray.origin, ray.direction), ([6.0, 5.0, 4.0], [3.0, 2.0, 1.0]));
    assert_eq!((ray.t_min, ray.t_max, ray.scan_line, ray.valid), (0.0, f64::INFINITY, 0, true));
    assert_eq!((batch.rays.len(), batch.invalid), (2, 0));
}

#[test]
fn ranges_and_scan_lines() {
    let text = format!("\u{feff}{HEADER}\n0,0,0, 0 ,0,1,-1,inf,3\n0,0,0,0,0,1,2,2,18446744073709551615\n");
    let rays = strict(&text).expect("valid").rays;
    assert_eq!((rays[0].t_min, rays[0].t_max, rays[0].scan_line), (-1.0, f64::INFINITY, 3));
    assert_eq!((rays[1].t_min, rays[1].t_max, rays[1].scan_line), (2.0, 2.0, u64::MAX));
}

#[test]
fn ranges_may_have_no_ends_and_empty_fields_are_the_defaults() {
    let infinity = f64::INFINITY;
    for (text, range) in [
        ("-inf,inf", [-infinity, infinity]),
        ("-Infinity, +INF ", [-infinity, infinity]),
        ("-inf,-2.5", [-infinity, -2.5]),
        ("-inf,", [-infinity, infinity]),
        (",", [0.0, infinity]),
        (" ,\t", [0.0, infinity]),
        (",7", [0.0, 7.0]),
        ("-3,\"\"", [-3.0, infinity]),
    ] {
        let rays = strict(&format!("{HEADER}\n0,0,0,0,0,1,{text},0\n")).expect(text).rays;
        assert_eq!([rays[0].t_min, rays[0].t_max], range, "{text}");
        assert!(rays[0].valid);
    }
    // Other columns have no defaults.
    for line in [",0,0,0,0,1,0,1,0", "0,0,0,0,0,,0,1,0", "0,0,0,0,0,1,0,1,"] {
        assert!(strict(&format!("{HEADER}\n{line}\n")).is_err(), "{line}");
    }
}

#[test]
fn a_batch_may_be_empty_but_not_the_file() {
    assert!(strict("ox,oy,oz,dx,dy,dz").expect("valid").rays.is_empty());
    refused_always("", "r.csv:1:1", "the file is empty");
    refused_always("\n\n", "r.csv:3:1", "the file is empty");
}

#[test]
fn headers() {
    refused_always("ox,oy,oz,dx,dy,dz,tmx\n", "r.csv:1:19", "there is no column `tmx` (did you mean `tmax`?)");
    refused_always("ox,oy,oz,dx,dy,dz,weather\n", "r.csv:1:19", "there is no column `weather`");
    refused_always("ox,oy,oz,dx, dx,dz\n", "r.csv:1:14", "the column `dx` stands twice");
    refused_always("ox,oy,oz,dx,dy\n0,0,0,0,0\n", "r.csv:1:1", "the column `dz` is missing");
    refused_always("0,0,0,0,0,1\n", "r.csv:1:1", "the first line holds numbers");
    let report = rendered(&strict("a\n").expect_err("refused"));
    assert!(report.contains("the columns are ox,oy,oz,dx,dy,dz, and optionally tmin, tmax, line"), "{report}");
}

#[test]
fn lines_that_no_number_can_be_read_from() {
    refused_always("ox,oy,oz,dx,dy,dz\n\n1,2,3,4,5\n", "r.csv:3:1", "the line has 5 fields, the header 6");
    refused_always("ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6,7\n", "r.csv:2:1", "the line has 7 fields, the header 6");
    refused_always("ox,oy,oz,dx,dy,dz\r\n1,2, x3,4,5,6\r\n", "r.csv:2:6", "`x3` in column `oz` is not a number");
    refused_always("ox,oy,oz,dx,dy,dz\n1,\"2\",3,4,,6\n", "r.csv:2:11", "the field of column `dy` is empty");
    let line = |text: &str| format!("{HEADER}\n0,0,0,0,0,1,0,1,{text}\n");
    refused_always(&line("-1"), "r.csv:2:17", "`-1` in column `line` is not a whole number");
    refused_always(&line("1.5"), "r.csv:2:17", "`1.5` in column `line` is not a whole number");
}

#[test]
fn rays_that_cannot_be_traced() {
    refused_or_kept("0,nan,0,0,0,1,0,1,8", "r.csv:3:3", "`oy` is not a number (NaN)");
    refused_or_kept("0,0,0,0,-inf,1,0,1,8", "r.csv:3:9", "`dy` is infinite");
    refused_or_kept("0,0,0,0,1e999,1,0,1,8", "r.csv:3:9", "`dy` is too large");
    refused_or_kept("0,0,0,0,-0,0,0,1,8", "r.csv:3:1", "the direction is zero");
    refused_or_kept("0,0,0,0,0,1,inf,inf,8", "r.csv:3:13", "`tmin` is inf, which leaves no t");
    refused_or_kept("0,0,0,0,0,1,Infinity,,8", "r.csv:3:13", "`tmin` is inf, which leaves no t");
    refused_or_kept("0,0,0,0,0,1,-inf,-inf,8", "r.csv:3:18", "`tmax` is -inf, which leaves no t");
    refused_or_kept("0,0,0,0,0,1,nan,,8", "r.csv:3:13", "`tmin` is not a number (NaN)");
    refused_or_kept("0,0,0,0,0,1,-1e999,inf,8", "r.csv:3:13", "`tmin` is too large");
    refused_or_kept("0,0,0,0,0,1,,-1,8", "r.csv:3:14", "`tmin` is 0 and above `tmax`, which is -1");
    refused_or_kept("0,0,0,0,0,1,0,NaN,8", "r.csv:3:15", "`tmax` is not a number (NaN)");
    refused_or_kept("0,0,0,0,0,1,0,1e999,8", "r.csv:3:15", "`tmax` is too large");
    refused_or_kept("0,0,0,0,0,1,2,1,8", "r.csv:3:15", "`tmin` is 2 and above `tmax`, which is 1");
    refused_or_kept("0,0,0,0,0,1,0,-inf,8", "r.csv:3:15", "`tmin` is 0 and above `tmax`, which is -inf");
}

#[test]
fn a_file_longer_than_the_buffer() {
    let mut text = String::from("ox,oy,oz,dx,dy,dz\n");
    for k in 0..20_000 {
        text += &format!("{k},0,0,0,0,{}\n", u8::from(k != 12_345));
    }
    assert_refused(strict(&text), "r.csv:12347:1", "the direction is zero");
    let batch = lenient(&text).expect("kept");
    assert_eq!((batch.rays.len(), batch.invalid), (20_000, 1));
    assert!(batch.rays.iter().enumerate().all(|(k, ray)| ray.origin[0] == k as f64));
    let report = rendered(&strict(&text).expect_err("refused"));
    assert!(report.contains("12347 │ 12345,0,0,0,0,0"), "{report}");
}

#[test]
fn from_disk() {
    let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
    file.write_all(b"ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1\n0,0,0,0,\xff,1\n").expect("written");
    let place = format!("{}:3:1", file.path().display());
    assert_refused(read(file.path(), OnInvalid::Skip), &place, "the line is not text in UTF-8");
    let folder = file.path().parent().expect("it is in a folder");
    let error = read(folder, OnInvalid::Refuse).expect_err("a folder");
    assert!(error.to_string().starts_with("cannot read `"), "{error}");
}

proptest! {
    #[test]
    fn same_bits(numbers in any::<[f64; 6]>()) {
        prop_assume!(numbers[3..] != [0.0; 3]);
        let line = numbers.map(|number| crate::number::Shortest(number).to_string()).join(",");
        let ray = strict(&format!("ox,oy,oz,dx,dy,dz\n{line}\n")).expect("valid").rays[0];
        let read = [ray.origin, ray.direction].concat();
        prop_assert!(read.iter().zip(&numbers).all(|(read, number)| read.to_bits() == number.to_bits()));
    }

    #[test]
    fn damage_never_panics(changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6)) {
        let mut bytes = format!("{HEADER}\n0,0,0,0,0,1,0,1,7\r\n1,1,1,1,0,0,0,inf,9\n").into_bytes();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        for on_invalid in [OnInvalid::Refuse, OnInvalid::Skip] {
            if let Err(error) = Reader::new("r.csv", Cursor::new(&bytes), on_invalid).and_then(Reader::batch) {
                prop_assert!(rendered(&error).contains("[r.csv:"));
            }
        }
    }
}
