//! Where and with what: one line under every figure.

use crate::record::Machine;

/// The lock file of the build: what the versions are.
const LOCK: &str = include_str!("../../../Cargo.lock");

/// Libraries whose version matters to the figures.
const LIBRARIES: [&str; 4] = ["pliant", "robust", "parry3d", "obvhs"];

/// This machine and this build.
pub fn this_machine() -> Machine {
    let mut system = sysinfo::System::new();
    system.refresh_cpu_all();
    let mut versions: std::collections::BTreeMap<String, String> = LIBRARIES
        .into_iter()
        .filter_map(|name| Some((name.to_owned(), version(name)?)))
        .collect();
    versions.insert("rustc".to_owned(), env!("PLIANT_RUSTC_VERSION").to_owned());
    Machine {
        processor: system
            .cpus()
            .first()
            .map_or_else(|| "unknown".to_owned(), |cpu| cpu.brand().trim().to_owned()),
        cores: system.cpus().len(),
        system: sysinfo::System::long_os_version()
            .unwrap_or_else(|| std::env::consts::OS.to_owned()),
        profile: if cfg!(debug_assertions) {
            "debug"
        } else {
            "release"
        }
        .to_owned(),
        versions,
    }
}

/// A package's version in the lock file.
fn version(package: &str) -> Option<String> {
    let (_, rest) = LOCK.split_once(&format!("name = \"{package}\"\nversion = \""))?;
    Some(rest.split_once('"')?.0.to_owned())
}
