//! Notes which compiler builds the harness, for what it measures.

use std::env;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=RUSTC");
    let compiler = env::var_os("RUSTC").unwrap_or("rustc".into());
    // A compiler that does not name itself stays without a name: that is no reason not to build.
    if let Ok(output) = Command::new(compiler).arg("--version").output() {
        println!("cargo::rustc-env=PATCHRAY_COMPILER={}", String::from_utf8_lossy(&output.stdout).trim());
    }
}
