//! When nobody reads: standard output or standard error that is closed, or full.

#![cfg(unix)]

use crate::common::pliant_into;
use std::fs::{self, File};
use std::process::Stdio;

/// The writing end of a pipe that nobody reads.
fn closed() -> Stdio {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer.into()
}

fn full() -> Option<Stdio> {
    File::options()
        .write(true)
        .open("/dev/full")
        .ok()
        .map(Stdio::from)
}

const CALLS: [&[&str]; 5] = [
    &["run", "--triangles", "320", "--stride", "50"],
    &[
        "run",
        "--triangles",
        "320",
        "--stride",
        "50",
        "--format",
        "json",
    ],
    &["check", "a.obj"],
    &["check", "a.obj", "--format", "json"],
    &["bench", "degrees", "--small", "--rounds", "1"],
];

#[test]
fn a_reader_that_has_gone_is_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("a.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    for call in CALLS {
        assert_eq!(
            pliant_into(folder.path(), call, closed(), Stdio::piped()),
            (2, String::new()),
            "{call:?}"
        );
        assert_eq!(
            pliant_into(folder.path(), call, closed(), closed()).0,
            2,
            "{call:?}"
        );
        if let Some(full) = full() {
            let (code, said) = pliant_into(folder.path(), call, full, Stdio::piped());
            assert_eq!((code, said.lines().count()), (2, 1), "{call:?}: {said}");
            assert!(said.contains("standard output"), "{call:?}: {said}");
        }
    }
    // Errors too can find nobody to tell.
    for call in [
        &["check", "missing.obj"][..],
        &["run", "missing"],
        &["check", "a_1.obj", "a_2.obj"],
    ] {
        assert_eq!(
            pliant_into(folder.path(), call, Stdio::null(), closed()).0,
            2,
            "{call:?}"
        );
    }
}
