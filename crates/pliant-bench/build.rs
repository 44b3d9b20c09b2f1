//! Records the compiler's version, for the machine line of records.

use std::process::Command;

fn main() {
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version = Command::new(compiler).arg("--version").output().ok();
    let version = version
        .and_then(|output| String::from_utf8(output.stdout).ok())
        .unwrap_or_default();
    println!(
        "cargo::rustc-env=PLIANT_RUSTC_VERSION={}",
        version.split_whitespace().nth(1).unwrap_or("unknown")
    );
    println!("cargo::rerun-if-changed=build.rs");
}
