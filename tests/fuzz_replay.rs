//! The fuzz targets' checks without libFuzzer: over the committed corpus, every past failure, and bytes at random.

use patchray_fuzz::TARGETS;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// The files of a target in a folder of `tests/fuzz`, in order; none where there is no such folder.
fn inputs(folder: &str, target: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz").join(folder).join(target);
    let files = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.expect("the folder can be read").path());
    let mut files: Vec<_> = files.collect();
    files.sort();
    files
}

/// Runs the checks over all inputs in a folder; how many there are.
fn replay(folder: &str) -> usize {
    let mut broken = Vec::new();
    let mut count = 0;
    for &(target, check) in TARGETS {
        for path in inputs(folder, target) {
            let bytes = fs::read(&path).expect("the file can be read");
            count += 1;
            if catch_unwind(AssertUnwindSafe(|| check(&bytes))).is_err() {
                broken.push(path);
            }
        }
    }
    assert!(broken.is_empty(), "claims are broken, as said above, by {broken:#?}");
    count
}

#[test]
fn the_corpus_holds() {
    let count = replay("corpus");
    println!("{count} inputs");
    assert!(TARGETS.iter().all(|(target, _)| !inputs("corpus", target).is_empty()), "every target has a corpus");
}

#[test]
fn past_failures_hold() {
    println!("{} inputs", replay("failures"));
}

/// Random bytes through every target, with the smallest that breaks a claim. `PROPTEST_CASES=N` runs N for each.
#[test]
fn random_bytes_hold() {
    for &(target, check) in TARGETS {
        let bytes = prop_oneof![
            // Many zeros, as of an ordinary case; and none.
            prop::collection::vec(prop_oneof![Just(0), any::<u8>()], 0..300),
            prop::collection::vec(any::<u8>(), 0..300),
        ];
        let config = Config { failure_persistence: None, ..Config::default() };
        let result = TestRunner::new(config).run(&bytes, |bytes| {
            check(&bytes);
            Ok(())
        });
        assert!(result.is_ok(), "{target}: {}", result.unwrap_err());
    }
}
