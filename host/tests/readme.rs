//! The README's figures that a command can check.

use serde_json::Value;
use std::process::Command;

/// The README's table of the kernel's memory says what `patchray info --json` says of the teapot.
#[test]
fn the_memory_table_is_what_info_says() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    let info = Command::new(env!("CARGO_BIN_EXE_patchray"))
        .args(["info", "--json", "fixtures/patches/teapot.bpt"])
        .current_dir(root)
        .output()
        .expect("the binary runs");
    assert!(info.status.success());
    let info: Value = serde_json::from_slice(&info.stdout).expect("it prints JSON");
    let readme = std::fs::read_to_string(format!("{root}/README.md")).expect("there is a README");
    let mut rows = 0;
    for precision in ["f32", "f64"] {
        for method in ["newton", "newton-coherent"] {
            let of = &info["memory"][precision]["methods"][method];
            let [scene, coherence, scratch] =
                ["arena_bytes", "coherence_bytes_per_thread", "scratch_bytes_per_thread"].map(|key| grouped(&of[key]));
            let row = format!("| `{method}` | {precision} | {scene} | {coherence} | {scratch} |");
            assert!(readme.contains(&row), "README.md has no row\n{row}");
            rows += 1;
        }
    }
    assert_eq!(rows, 4);
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
