//! Points of B-splines as geomdl (NURBS-Python 5.4) finds them: recorded ones always, and fresh ones where it is installed.

use std::path::Path;
use std::process::Command;

use crate::common::lower;
use patchray::bernstein::Basis;
use patchray::point::Weighted;
use patchray::surface::Net;
use patchray_host::scene::error::OnInvalid;
use patchray_host::scene::patches;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// How far a position may be from geomdl's. Coordinates go up to some 20.
const ALLOWANCE: f64 = 1e-12;

/// Compares positions on the surfaces of one file with those in another, on every piece that holds the parameters; the number
/// of comparisons, and the largest difference of a coordinate.
fn compare(surfaces: &Path, positions: &Path) -> (usize, f64) {
    let file = patches::read(surfaces, OnInvalid::Refuse).expect("geomdl's file is read");
    let mut basis = Basis::<f64, 16>::new();
    let (mut compared, mut worst) = (0, 0.0_f64);
    let text = std::fs::read_to_string(positions).expect("it is there");
    for line in text.lines().filter(|line| !line.starts_with(['#', 's'])) {
        let numbers: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let [number, u, v, x, y, z] = numbers[..] else { panic!("{line}") };
        let before = compared;
        for surface in file.model.surfaces.iter().filter(|surface| surface.number as f64 == number) {
            let part = surface.knots.expect("a piece of a B-spline");
            let within = |[from, to]: [f64; 2], at: f64| (from <= at && at <= to).then(|| (at - from) / (to - from));
            let (Some(u), Some(v)) = (within(part.u, u), within(part.v, v)) else {
                continue;
            };
            let points: Vec<Weighted<f64>> = lower(surface, 1.0);
            let net = Net::checked(surface.degree_u, surface.degree_v, &points).expect("valid");
            let found = net.position(u, v, &mut basis.view()).expect("room");
            for (a, b) in found.into_iter().zip([x, y, z]) {
                worst = worst.max((a - b).abs());
                assert!((a - b).abs() <= ALLOWANCE, "{line}: {found:?}");
            }
            compared += 1;
        }
        assert!(compared > before, "no piece holds {line}");
    }
    println!("{compared} positions, off by at most {worst:e}");
    (compared, worst)
}

#[test]
fn recorded_positions_are_met() {
    let root = Path::new(ROOT).join("fixtures");
    let (compared, _) = compare(&root.join("patches/nurbs.json"), &root.join("recorded/nurbs-positions.csv"));
    assert!(compared > 200, "{compared}");
}

/// With geomdl at hand, another seed's surfaces and positions; and the recorded files are what their command makes.
#[test]
fn fresh_positions_are_met() {
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).current_dir(ROOT).output();
    if !python(&["-c", "import geomdl"]).is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 has no geomdl (pip install geomdl==5.4.0)");
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let made = |seed: &str| {
        let files = [folder.join(format!("geomdl-{seed}.json")), folder.join(format!("geomdl-{seed}.csv"))];
        let [surfaces, positions] = files.each_ref().map(|file| file.to_str().expect("UTF-8"));
        let output = python(&["tests/bspline/record.py", seed, surfaces, positions]).expect("python runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        files
    };
    for seed in ["2", "3", "4"] {
        let [surfaces, positions] = made(seed);
        assert!(compare(&surfaces, &positions).0 > 2000);
    }
    let without_comments = |path: &Path| {
        let text = std::fs::read_to_string(path).expect("it is there");
        text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>()
    };
    let recorded =
        ["patches/nurbs.json", "recorded/nurbs-positions.csv"].map(|name| Path::new(ROOT).join("fixtures").join(name));
    for (fresh, recorded) in made("1").iter().zip(&recorded) {
        assert!(
            without_comments(fresh) == without_comments(recorded),
            "{} is not what its command makes",
            recorded.display()
        );
    }
}
