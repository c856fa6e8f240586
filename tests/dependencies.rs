//! What the kernel brings into a program: three crates and what they need, and nothing else.

use std::collections::BTreeSet;
use std::process::Command;

/// The kernel, the crates that it names, and theirs.
const ALLOWED: [&str; 7] = ["patchray", "libm", "heapless", "glam", "hash32", "byteorder", "stable_deref_trait"];

/// The names in a listing of `cargo tree`, which begins each line with one.
fn names(listing: &str) -> BTreeSet<&str> {
    listing.lines().filter_map(|line| line.split_whitespace().next()).collect()
}

/// What stands on one list only.
fn differences(listing: &str) -> Vec<&str> {
    names(listing).symmetric_difference(&BTreeSet::from(ALLOWED)).copied().collect()
}

#[test]
fn the_kernel_depends_on_three_crates_and_theirs() {
    // With all features, for all targets, crates that build scripts use included: what any user of the kernel compiles.
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--package", "patchray", "--edges", "no-dev"])
        .args(["--all-features", "--target", "all", "--prefix", "none", "--no-dedupe"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let listing = String::from_utf8(output.stdout).expect("cargo writes UTF-8");
    assert_eq!(differences(&listing), Vec::<&str>::new(), "in\n{listing}");
}

#[test]
fn one_crate_more_or_less_is_seen() {
    let listing: String = ALLOWED.iter().map(|name| format!("{name} v1.0.0\n")).collect();
    assert!(differences(&listing).is_empty());
    assert_eq!(differences(&format!("{listing}libc v0.2.0 (proc-macro)\n")), ["libc"]);
    assert_eq!(differences(&listing.replace("glam v1.0.0\n", "")), ["glam"]);
}
