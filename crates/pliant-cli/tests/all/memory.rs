//! Peak memory of `pliant check`: a multiple of two frames, however many frames there are.
//!
//! A frame is its positions and triangles: 12 bytes a vertex in f32, 24 in f64, and 12 a triangle.
//! The tests cover splitting into pieces and baselines. They measure where the system reports the
//! peak of a process (Linux), and elsewhere say that they are skipped.
//!
//! ```sh
//! # the figures in docs/RELIABILITY.md
//! cargo test --release -p pliant-cli --test all memory:: -- --ignored --nocapture
//! ```

use crate::common::npz::{Surface, integers};
use crate::common::{Measured, measured};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Peak memory of a check, for each byte of two frames, beyond the program itself.
const MULTIPLE: f64 = 3.5;

/// Peak factor where the mesh changes from file to file.
const CHANGING: f64 = 7.5;

/// Peak factor with `--swept`: boxes of two shapes, edges, and their owners.
const SWEPT: f64 = 11.0;

/// Bytes of the program itself, at most; mostly code, of which the system maps as much as it likes.
///
/// A test build, most of it unoptimised, has 4 MB more code.
const PROGRAM: u64 = if cfg!(debug_assertions) { 16 } else { 12 } << 20;

/// Bytes of each body, at most: its tree, its name, its place in every list.
///
/// If its box overlaps another, its boxes too. For a body of a few triangles this is the largest
/// part.
const A_BODY: u64 = 2560;
const A_BODY_THAT_IS_MET: u64 = 4096;

fn peak(folder: &Path, arguments: &[&str]) -> Option<u64> {
    // More threads than most machines have cores: each has buffers of its own.
    let arguments = [&["check", "--count", "--threads", "16"], arguments].concat();
    // The system maps more of the program in one run than in another, by more than a megabyte.
    let peaks = [0; 2].map(|_| {
        let Measured { said, peak } = measured(folder, &arguments);
        assert!(said.code < 2, "{}", said.err);
        peak
    });
    let least = peaks.into_iter().min().flatten();
    if least.is_none() {
        eprintln!("skipped: this system does not tell the memory of a process");
    }
    least
}

/// Peak of the program itself: small frames, but enough that the program runs while it is measured.
fn program(folder: &Path) -> Option<u64> {
    fs::write(folder.join("small.npz"), Surface::new(8, 3000).file()).unwrap();
    peak(folder, &["small.npz"])
}

/// A surface with `side` vertices each way: joined or split, in f32 or f64.
fn surfaces(side: u32, frames: u32) -> [(&'static str, Surface); 3] {
    let joined = Surface::new(side, frames);
    [
        ("f32", joined),
        (
            "f64",
            Surface {
                wide: true,
                ..joined
            },
        ),
        (
            "f32, every triangle apart",
            Surface {
                split: true,
                ..joined
            },
        ),
    ]
}

fn multiple(peak: u64, program: u64, surface: Surface) -> f64 {
    peak.saturating_sub(program) as f64 / (2 * surface.bytes_of_a_frame()) as f64
}

#[test]
fn memory_does_not_grow_with_the_number_of_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let side = 60;
    for frames in [3, 150] {
        fs::write(
            path.join(format!("one_{frames}.npz")),
            Surface::new(side, frames).file(),
        )
        .unwrap();
        let many = path.join(format!("many_{frames}"));
        fs::create_dir(&many).unwrap();
        for frame in 0..frames {
            let mut text = String::new();
            for i in 0..side * side {
                let (x, y) = (i % side, i / side);
                writeln!(text, "v {x} {y} {}", (x * 7 + y * 13 + frame) % 5).unwrap();
            }
            for y in 0..side - 1 {
                for x in 0..side - 1 {
                    let corner = y * side + x + 1;
                    writeln!(text, "f {corner} {} {}", corner + 1, corner + side).unwrap();
                }
            }
            fs::write(many.join(format!("{frame}.obj")), text).unwrap();
        }
    }
    for [few, more] in [
        ["one_3.npz", "one_150.npz"],
        ["many_3/*.obj", "many_150/*.obj"],
    ] {
        let [Some(few), Some(more)] = [few, more].map(|argument| peak(path, &[argument])) else {
            return;
        };
        // Copies of one frame of positions, 147 of them, would be 6 MB more.
        println!("3 frames: {few} bytes, 150 frames: {more}");
        assert!(more < few + (2 << 20), "{few} {more}");
    }
}

#[test]
fn memory_is_a_multiple_of_two_frames() {
    let folder = tempfile::tempdir().unwrap();
    let Some(program) = program(folder.path()) else {
        return;
    };
    assert!(program < PROGRAM, "the program itself: {program}");
    for (what, surface) in surfaces(400, 3) {
        fs::write(folder.path().join("a.npz"), surface.file()).unwrap();
        let Some(peak) = peak(folder.path(), &["a.npz"]) else {
            return;
        };
        let multiple = multiple(peak, PROGRAM, surface);
        println!("{what}: {multiple:.2} times two frames");
        assert!(multiple < MULTIPLE, "{what}: {multiple}");
    }
}

/// Close pairs that do not meet are not kept, however many there are.
#[test]
fn memory_of_labels() {
    let folder = tempfile::tempdir().unwrap();
    let side = 400;
    let surface = Surface::new(side, 1);
    fs::write(folder.path().join("a.npz"), surface.file()).unwrap();
    let triangles = 2 * i64::from(side - 1).pow(2);
    for (labels, most) in [(20, 40.0), (triangles, 320.0)] {
        let each: Vec<i64> = (0..triangles).map(|it| it * labels / triangles).collect();
        fs::write(folder.path().join("labels.npy"), integers(&each)).unwrap();
        let [Some(with), Some(without)] = [&["a.npz", "--labels", "0=labels.npy"][..], &["a.npz"]]
            .map(|it| peak(folder.path(), it))
        else {
            return;
        };
        let of_each = with.saturating_sub(without) as f64 / triangles as f64;
        println!("{labels} labels: {of_each:.0} bytes a triangle");
        assert!(of_each <= most, "{labels}: {of_each}");
    }
}

#[test]
fn memory_of_what_meets_on_the_way() {
    let folder = tempfile::tempdir().unwrap();
    for (what, surface) in surfaces(300, 3) {
        fs::write(folder.path().join("a.npz"), surface.file()).unwrap();
        let Some(peak) = peak(folder.path(), &["a.npz", "--swept"]) else {
            return;
        };
        let multiple = multiple(peak, PROGRAM, surface);
        println!("{what}: {multiple:.2} times two frames");
        assert!(multiple < SWEPT, "{what}: {multiple}");
    }
}

/// If the mesh changes from file to file, the first mesh is held too, and briefly the last body.
#[test]
fn memory_where_the_mesh_changes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (what, surface) in surfaces(300, 1) {
        for frame in 0..4 {
            let surface = Surface {
                side: surface.side - frame % 2,
                ..surface
            };
            let file = path.join(format!("{frame}.npz"));
            fs::write(file, surface.file()).unwrap();
        }
        for arguments in [&["*.npz"][..], &["*.npz", "--baseline", "1"]] {
            let Some(peak) = peak(path, arguments) else {
                return;
            };
            let multiple = multiple(peak, PROGRAM, surface);
            println!("{what}, {arguments:?}: {multiple:.2} times two frames");
            assert!(multiple < CHANGING, "{what}, {arguments:?}: {multiple}");
        }
    }
}

#[test]
#[ignore = "large: a gigabyte, minutes without --release"]
fn figures() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let Some(program) = program(path) else {
        return;
    };
    println!("the program itself: {:.1} MB", program as f64 / 1e6);
    for (side, frames) in [(101, 1000), (1001, 3)] {
        for (what, surface) in surfaces(side, frames) {
            fs::write(path.join("a.npz"), surface.file()).unwrap();
            let peak = peak(path, &["a.npz"]).unwrap_or(0);
            let multiple = multiple(peak, program, surface);
            println!(
                "{frames} frames of {} triangles, {what}: {:.1} MB, {multiple:.2} times two frames \
                 of {:.1} MB",
                surface.triangles(),
                peak as f64 / 1e6,
                surface.bytes_of_a_frame() as f64 / 1e6
            );
            assert!(multiple < MULTIPLE, "{what}");
        }
    }
}

#[test]
fn memory_of_pieces_and_of_a_baseline() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for (what, surface) in surfaces(300, 3) {
        fs::write(path.join("a.npz"), surface.file()).unwrap();
        let split = ["a.npz", "--split", "components"];
        let baseline = ["a.npz", "--baseline", "2"];
        // Every triangle is a piece of its own; welding would join them.
        let apart = ["a.npz", "--split", "components", "--no-weld", "--first"];
        let ask = if surface.split {
            &[&apart[..]][..]
        } else {
            &[&split[..], &baseline[..]]
        };
        for arguments in ask {
            let Some(peak) = peak(path, arguments) else {
                return;
            };
            let multiple = multiple(peak, PROGRAM, surface);
            println!("{what}, {arguments:?}: {multiple:.2} times two frames");
            assert!(multiple < MULTIPLE, "{what}, {arguments:?}: {multiple}");
        }
    }
}

/// A glTF body takes as much as in an NPZ file, plus the file's data on shape and motion.
#[test]
fn memory_of_gltf() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let surface = Surface::new(400, 3);
    fs::write(path.join("a.npz"), surface.file()).unwrap();
    let Some(plain) = peak(path, &["a.npz"]) else {
        return;
    };
    for (held, targets) in [(false, 0), (true, 0), (false, 1), (true, 4)] {
        fs::write(path.join("a.glb"), surface.glb(held, targets)).unwrap();
        let Some(peak) = peak(path, &["a.glb"]) else {
            return;
        };
        // A moving body keeps positions at rest, and four joints with a number, a weight and a rest
        // pose.
        //
        // A morph target adds the moved vertices and their offsets. A still body keeps only its
        // frame.
        let said = match (held, targets) {
            (false, 0) => 0,
            _ => 12 + if held { 4 * 8 + 4 } else { 0 } + 16 * targets as u64,
        };
        let said = said * u64::from(surface.vertices());
        println!("held {held}, {targets} targets: {peak} bytes, {said} said, {plain} without");
        // A second copy of the triangles would be 3.8 MB more.
        assert!(
            peak < plain + said + (2 << 20),
            "held {held}, {targets} targets: {peak}, {plain} and {said}"
        );
    }
}

#[test]
fn memory_of_hits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // Pairs of crossing triangles, each pair apart: the most output for this number of pairs.
    let pairs = 50_000_u32;
    let mut text = String::new();
    for pair in 0..pairs {
        let x = 3 * pair;
        writeln!(text, "v {x} 0 0\nv {x}.9 0 0\nv {x} 1 0\nf -1 -2 -3").unwrap();
        writeln!(
            text,
            "v {x}.1 .1 -1\nv {x}.1 .1 1\nv {x}.1 .2 1\nf -1 -2 -3"
        )
        .unwrap();
    }
    fs::write(path.join("a.obj"), text).unwrap();
    let Some(peak) = peak(path, &["a.obj", "--hits", "hits.vtp"]) else {
        return;
    };
    let frame = f64::from(2 * pairs) * (3.0 * 24.0 + 12.0);
    let hits = f64::from(pairs) * (2.0 * 16.0 + 2.0 * 300.0);
    println!("{:.1} MB with hits", peak as f64 / 1e6);
    assert!((peak as f64) < MULTIPLE * 2.0 * frame + hits + PROGRAM as f64);
}

/// Two equal sheets: every triangle is in their place, and is reached from all sides.
#[test]
fn memory_of_what_only_touches() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let surface = Surface::new(200, 1);
    for name in ["a.npz", "b.npz"] {
        fs::write(path.join(name), surface.file()).unwrap();
    }
    let asked = ["check", "a.npz", "b.npz", "--count", "--format", "json"];
    let of = |more: &[&str]| measured(path, &[&asked[..], more].concat());
    let (plain, crossing) = (of(&[]), of(&["--crossing"]));
    let frame = &crossing.said.json()["frames"][0];
    assert_eq!(frame["count"], 0, "{frame}");
    let pairs = frame["only_touching"].as_u64().unwrap();
    let triangles = 2 * surface.triangles() as u64;
    let (Some(plain), Some(peak)) = (plain.peak, crossing.peak) else {
        eprintln!("skipped: this system does not tell the memory of a process");
        return;
    };
    println!("{peak} bytes, {plain} without, {pairs} pairs, {triangles} triangles");
    let frames = MULTIPLE * 2.0 * 2.0 * surface.bytes_of_a_frame() as f64;
    let said = (32 * pairs + 200 * triangles + PROGRAM) as f64;
    assert!((peak as f64) < frames + said, "{peak}");
}

/// A glTF file of `count` bodies, each a triangle of one mesh, side by side at this distance.
fn many_triangles(count: u32, distance: f32) -> String {
    // (0, 0, 0), (1, 1, 0.25), (1, 0, 1)
    let corners = "AAAAAAAAAAAAAAAAAACAPwAAgD8AAIA+AACAPwAAAAAAAIA/";
    let nodes: Vec<String> = (0..count)
        .map(|node| {
            format!(
                r#"{{"mesh":0,"translation":[{},0,0]}}"#,
                node as f32 * distance
            )
        })
        .collect();
    let numbers: Vec<String> = (0..count).map(|node| node.to_string()).collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{corners}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "nodes":[{}],"scenes":[{{"nodes":[{}]}}],"scene":0}}"#,
        nodes.join(","),
        numbers.join(",")
    )
}

/// Bodies apart, and in one place: no list of their four and a half million pairs is made.
#[test]
fn very_many_small_bodies_take_what_is_said() {
    let folder = tempfile::tempdir().unwrap();
    for (count, distance, of_one) in [
        (3_000, 2.0, A_BODY),
        (10_000, 2.0, A_BODY),
        (3_000, 1e-5, A_BODY_THAT_IS_MET),
    ] {
        let name = "many.gltf";
        fs::write(folder.path().join(name), many_triangles(count, distance)).unwrap();
        let Some(peak) = peak(folder.path(), &[name, "--max-memory", "64MiB"]) else {
            return;
        };
        let most = PROGRAM + of_one * u64::from(count);
        println!("{count} bodies, {distance} apart: {peak} bytes");
        assert!(
            peak < most,
            "{count} bodies, {distance} apart: {peak} bytes"
        );
    }
}
