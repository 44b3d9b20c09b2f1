//! The memory that `pliant check` takes: a multiple of two frames, however many there are.
//!
//! A frame is what an NPZ file of float32 and uint32 takes for it: 12 bytes a vertex and 12 a triangle. Measured where the system
//! tells the most memory that a process has taken (Linux); elsewhere the tests say that they are skipped.
//!
//! ```sh
//! cargo test --release -p pliant-cli --test memory -- --ignored --nocapture   # the figures in docs/RELIABILITY.md
//! ```

mod common;

use common::npz::surface;
use common::{Measured, measured};
use std::fs;
use std::path::Path;

/// The most memory, for each two frames, that checking takes beyond the program itself: on a body with itself, and with
/// `--no-weld`. Measured are at most 7.9 and 7.9 (release, two million triangles).
const MULTIPLE: f64 = 9.0;

/// What the program takes, whatever the file.
const PROGRAM: u64 = 12 << 20;

fn peak(folder: &Path, arguments: &[&str]) -> Option<u64> {
    let arguments = [&["check", "--count"], arguments].concat();
    let Measured { said, peak } = measured(folder, &arguments);
    assert!(said.code < 2, "{}", said.err);
    if peak.is_none() {
        eprintln!("skipped: this system does not tell the memory of a process");
    }
    peak
}

/// Two frames of a surface with so many vertices each way.
fn two_frames(side: u32) -> u64 {
    let (side, bytes) = (u64::from(side), 12);
    2 * (bytes * side * side + bytes * 2 * (side - 1) * (side - 1))
}

#[test]
fn memory_does_not_grow_with_the_number_of_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let side = 60;
    for frames in [3, 300] {
        fs::write(
            path.join(format!("one_{frames}.npz")),
            surface(side, frames),
        )
        .unwrap();
        let many = path.join(format!("many_{frames}"));
        fs::create_dir(&many).unwrap();
        for frame in 0..frames {
            let mut text = String::new();
            for i in 0..side * side {
                let (x, y) = (i % side, i / side);
                text += &format!("v {x} {y} {}\n", (x * 7 + y * 13 + frame) % 5);
            }
            for y in 0..side - 1 {
                for x in 0..side - 1 {
                    let corner = y * side + x + 1;
                    text += &format!("f {corner} {} {}\n", corner + 1, corner + side);
                }
            }
            fs::write(many.join(format!("{frame}.obj")), text).unwrap();
        }
    }
    for [few, more] in [
        ["one_3.npz", "one_300.npz"],
        ["many_3/*.obj", "many_300/*.obj"],
    ] {
        let [Some(few), Some(more)] = [few, more].map(|argument| peak(path, &[argument])) else {
            return;
        };
        // One frame of positions, kept 297 times, would be 13 MB more.
        println!("3 frames: {few} bytes, 300 frames: {more}");
        assert!(more < few + (2 << 20), "{few} {more}");
    }
}

#[test]
fn memory_is_a_multiple_of_two_frames() {
    let folder = tempfile::tempdir().unwrap();
    let side = 400;
    fs::write(folder.path().join("a.npz"), surface(side, 3)).unwrap();
    for arguments in [&["a.npz"][..], &["a.npz", "--no-weld"]] {
        let Some(peak) = peak(folder.path(), arguments) else {
            return;
        };
        let multiple = peak.saturating_sub(PROGRAM) as f64 / two_frames(side) as f64;
        assert!(multiple < MULTIPLE, "{arguments:?}: {multiple}");
    }
}

#[test]
#[ignore = "large: some gigabytes, a minute"]
fn figures() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // Small frames, but enough of them that the program is there to be looked at.
    fs::write(path.join("small.npz"), surface(8, 3000)).unwrap();
    let Some(program) = peak(path, &["small.npz"]) else {
        return;
    };
    println!("the program itself: {:.1} MB", program as f64 / 1e6);
    let report = |what: &str, arguments: &[&str], two: u64| {
        let peak = peak(path, arguments).unwrap_or(0);
        let multiple = peak.saturating_sub(program) as f64 / two as f64;
        println!(
            "{what}: {:.1} MB, {multiple:.2} times two frames of {:.1} MB",
            peak as f64 / 1e6,
            two as f64 / 2e6
        );
        assert!(multiple < MULTIPLE, "{what}");
    };
    for (side, frames) in [(101, 1000), (1001, 3)] {
        let name = format!("{side}.npz");
        fs::write(path.join(&name), surface(side, frames)).unwrap();
        let triangles = 2 * (side - 1) * (side - 1);
        for (how, arguments) in [
            ("with itself", &[&name[..]][..]),
            ("with itself, --no-weld", &[&name, "--no-weld"]),
        ] {
            let what = format!("{frames} frames of {triangles} triangles, f32, {how}");
            report(&what, arguments, two_frames(side));
        }
    }
}
