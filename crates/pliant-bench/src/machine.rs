//! Processor, system and versions: one line under every figure.

use crate::record::Machine;

/// Libraries whose versions matter to the figures.
///
/// The manifest asks for exactly these, and a test compares them with the lock file.
const LIBRARIES: [(&str, &str); 3] = [
    ("pliant", env!("CARGO_PKG_VERSION")),
    ("parry3d", "0.31.1"),
    ("obvhs", "0.4.0"),
];

/// Description of this machine and this build.
pub fn this_machine() -> Machine {
    let mut system = sysinfo::System::new();
    system.refresh_cpu_all();
    let versions = LIBRARIES
        .into_iter()
        .chain([("rustc", env!("PLIANT_RUSTC_VERSION"))])
        .map(|(name, version)| (name.to_owned(), version.to_owned()))
        .collect();
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
