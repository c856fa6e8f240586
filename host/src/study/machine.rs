//! On what a cell was measured, and by which build.

use std::fs;

use serde::{Deserialize, Serialize};

/// A machine, and the build that ran on it.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Machine {
    /// The processor, as the operating system names it; empty where it does not say.
    pub processor: String,
    /// How many threads it runs at a time.
    pub cores: u32,
    /// The operating system.
    pub system: String,
    /// The instruction set.
    pub architecture: String,
    /// The version of `patchray`.
    pub version: String,
    /// The compiler, as it names itself; empty where it did not say.
    pub compiler: String,
    /// Whether it was built with optimisation for release.
    pub release: bool,
}

impl Machine {
    /// This one.
    pub fn this() -> Self {
        // Linux tells in a text file; elsewhere the processor stays without a name.
        let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let name = text.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split_once(':'));
        let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
        Machine {
            processor: name.map_or(String::new(), |(_, name)| name.trim().to_owned()),
            cores: u32::try_from(cores).unwrap_or(u32::MAX),
            system: std::env::consts::OS.to_owned(),
            architecture: std::env::consts::ARCH.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            compiler: option_env!("PATCHRAY_COMPILER").unwrap_or_default().to_owned(),
            release: !cfg!(debug_assertions),
        }
    }
}
