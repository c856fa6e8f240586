//! Runs a target over files, as libFuzzer would: `patchray-fuzz TARGET FILE..`, of which it says how each is found.

use std::process::ExitCode;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let names = || patchray_fuzz::TARGETS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
    let Some(target) = arguments.next().filter(|name| patchray_fuzz::TARGETS.iter().any(|(known, _)| known == name))
    else {
        eprintln!("usage: patchray-fuzz TARGET FILE..; targets are {}", names());
        return ExitCode::from(2);
    };
    let mut failed = false;
    for path in arguments {
        let found = match std::fs::read(&path) {
            Err(error) => error.to_string(),
            Ok(bytes) => match std::panic::catch_unwind(|| patchray_fuzz::check(&target, &bytes)) {
                Ok(()) => {
                    println!("{path}: holds");
                    continue;
                }
                Err(_) => "a claim is broken, as said above".to_owned(),
            },
        };
        println!("{path}: {found}");
        failed = true;
    }
    ExitCode::from(u8::from(failed))
}
