//! The README's figures that a command can check.

use serde_json::Value;
use std::process::Command;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// The README's tables of the kernel's memory say what `patchray info --json` says of the teapot.
#[test]
fn the_memory_table_is_what_info_says() {
    let info = info();
    let readme = std::fs::read_to_string(format!("{ROOT}/README.md")).expect("there is a README");
    let mut rows = 0;
    for precision in ["f32", "f64"] {
        for method in ["newton", "newton-coherent", "clipping", "clipping-coherent"] {
            let of = &info["memory"][precision]["methods"][method];
            let [scene, coherence, scratch] =
                ["arena_bytes", "coherence_bytes_per_thread", "scratch_bytes_per_thread"].map(|key| grouped(&of[key]));
            let row = format!("| `{method}` | {precision} | {scene} | {coherence} | {scratch} |");
            assert!(readme.contains(&row), "README.md has no row\n{row}");
            rows += 1;
        }
        for method in ["newton-predicted", "clipping-predicted"] {
            let of = &info["memory"][precision]["methods"][method]["view"];
            let [scene, coherence, scratch, line] = [
                "arena_bytes",
                "coherence_bytes_per_thread",
                "scratch_bytes_per_thread",
                "line_bytes_per_thread_at_most",
            ]
            .map(|key| grouped(&of[key]));
            let row = format!("| `{method}` | {precision} | {scene} | {coherence} | {scratch} | {line} |");
            assert!(readme.contains(&row), "README.md has no row\n{row}");
            rows += 1;
        }
    }
    assert_eq!(rows, 12);
}

/// Clipping alone fits where there is little memory: the teapot, and all that a thread needs for degrees up to 15 × 15.
#[test]
fn clipping_the_teapot_takes_less_than_20_kb() {
    let of = &info()["memory"]["f32"]["methods"]["clipping"];
    let bytes = ["arena_bytes", "coherence_bytes_per_thread", "scratch_bytes_per_thread"]
        .map(|key| of[key].as_u64().expect("bytes are a whole number"));
    assert!(bytes.iter().sum::<u64>() < 20_000, "{bytes:?}");
    let kinds = of["arena_bytes_by_kind"].as_object().expect("bytes by kind");
    assert!(kinds.keys().all(|kind| !["patches", "tree", "grid"].iter().any(|part| kind.contains(part))), "{kinds:?}");
}

/// What `patchray info --json` says of the teapot.
fn info() -> Value {
    let info = Command::new(env!("CARGO_BIN_EXE_patchray"))
        .args(["info", "--json", "fixtures/patches/teapot.bpt"])
        .current_dir(ROOT)
        .output()
        .expect("the binary runs");
    assert!(info.status.success());
    serde_json::from_slice(&info.stdout).expect("it prints JSON")
}

/// 1234567 as `1,234,567`.
fn grouped(number: &Value) -> String {
    let digits = number.as_u64().expect("bytes are a whole number").to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
