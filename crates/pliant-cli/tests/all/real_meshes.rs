//! Real meshes with exact counts: closed triangles without a common vertex, counted in rationals.
//!
//! The files are not part of the project. Where they are absent, these tests skip and say so.

use crate::common::{Said, pliant};
use std::io::{self, Write};
use std::path::PathBuf;

/// Checks files below the data folder, if it exists.
fn check(arguments: &[&str]) -> Option<Said> {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !data.is_dir() {
        // Not `eprintln`, which the test runner keeps to itself unless the test fails.
        let _ = writeln!(
            io::stderr(),
            "skipped: {arguments:?}: there is no folder shared/data beside the checkout"
        );
        return None;
    }
    Some(pliant(
        &data,
        &[&["check", "--format", "json", "--count"], arguments].concat(),
    ))
}

fn assert_count(file: &str, count: u64) {
    for options in [&[][..], &["--no-weld"]] {
        let Some(said) = check(&[&[file], options].concat()) else {
            return;
        };
        assert_eq!(said.counts(), [count], "{file}");
        assert_eq!(said.code, i32::from(count > 0), "{file}");
        assert!(
            said.json()["bodies"][0].get("welded").is_none(),
            "{file} needs no welding"
        );
    }
}

#[test]
fn cloth_funnel() {
    assert_count("cloth-funnel/227.ply", 261);
    assert_count("cloth-funnel/228.ply", 332);
}

#[test]
fn armadillo_rollers_touch_in_no_triangle() {
    // In plain f64, without exact signs, there would be 444 in 327: many triangles are exactly
    // coplanar.
    assert_count("armadillo-rollers/326.ply", 0);
    assert_count("armadillo-rollers/327.ply", 0);
}

#[test]
fn ipc_toolkit() {
    assert_count("ipc-toolkit/two-cubes-far.ply", 0);
    assert_count("ipc-toolkit/two-cubes-close.ply", 0);
    assert_count("ipc-toolkit/two-cubes-intersecting.ply", 96);
    assert_count("ipc-toolkit/thick-cloth/t1.ply", 46);
}

#[test]
fn a_sequence_by_pattern() {
    let Some(said) = check(&["cloth-funnel/*.ply"]) else {
        return;
    };
    assert_eq!(said.counts(), [261, 332]);
}

#[test]
fn human_morph() {
    let Some(said) = check(&["human-morph.npz"]) else {
        return;
    };
    let counts = said.counts();
    assert_eq!(counts.len(), 60);
    assert_eq!([counts[0], counts[30], counts[59]], [88, 30, 88]);
    assert_eq!(said.code, 1);
}
