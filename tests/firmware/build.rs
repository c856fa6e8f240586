//! Lays a program out in the memory of a machine: `MEMORY` names one of the files in `memory`.

use std::env::var;
use std::path::Path;
use std::{fs, io};

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-env-changed=MEMORY");
    println!("cargo:rerun-if-changed=memory");
    let (Ok(out), Ok(machine)) = (var("OUT_DIR"), var("MEMORY")) else {
        return Ok(());
    };
    if var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return Ok(());
    }
    fs::copy(Path::new("memory").join(machine).with_extension("x"), Path::new(&out).join("memory.x"))?;
    println!("cargo:rustc-link-search={out}");
    // That of cortex-m-rt includes memory.x itself.
    if var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("riscv32") {
        println!("cargo:rustc-link-arg-bins=-Tmemory.x");
    }
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    Ok(())
}
