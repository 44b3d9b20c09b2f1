//! Seams that part in a later frame, in every format.
//!
//! Each frame has the result of a check of it alone, and one line says which seams part.

use crate::common::{Said, check, folder, pliant};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Two strips of four squares side by side, with corners of their own along x = 1.
///
/// In the second frame one side of that seam has moved by `by`, at every other corner to the other
/// side. In the last frame the tip of a fin goes through the second strip.
fn strips(frame: usize, by: f32) -> String {
    let mut text = String::new();
    for (first, last, moves) in [(0.0_f32, 1.0_f32, false), (1.0, 2.0, true)] {
        for (x, is_seam) in [(first, moves), (last, false)] {
            for y in 0_u8..5 {
                let side = if y.is_multiple_of(2) { by } else { -by };
                let x = if is_seam && frame == 1 { x + side } else { x };
                writeln!(text, "v {x} {y} 0").unwrap();
            }
        }
    }
    let tip = if frame == 2 { -0.5 } else { 0.5 };
    writeln!(text, "v 1.5 1.25 {tip}\nv 1.25 1.5 3\nv 1.75 1.5 3").unwrap();
    for first in [1, 11] {
        for y in first..first + 4 {
            writeln!(text, "f {} {} {}", y, y + 5, y + 6).unwrap();
            writeln!(text, "f {} {} {}", y, y + 6, y + 1).unwrap();
        }
    }
    text + "f 21 22 23\n"
}

/// `s_0.obj`, `s_1.obj`, `s_2.obj`.
fn sequence(by: f32) -> TempDir {
    let names = ["s_0.obj", "s_1.obj", "s_2.obj"];
    let files = names.iter().enumerate();
    let files: Vec<_> = files.map(|(at, &name)| (name, strips(at, by))).collect();
    folder(&files)
}

/// Movement by one rounding, and by much more.
const DISTANCES: [f32; 2] = [1.2e-7, 0.125];

fn counts_of(folder: &Path, arguments: &[&str]) -> Vec<u64> {
    let said = check(folder, &[arguments, &["--format", "json"]].concat());
    assert!(said.code < 2, "{}", said.err);
    said.counts()
}

#[test]
fn each_frame_is_what_it_is_alone_in_every_format() {
    for by in DISTANCES {
        let folder = sequence(by);
        let path = folder.path();
        // Equal in every format that can be written, each corner separate in the file.
        for to in [
            "s.npz",
            "c_%d.ply",
            "c_%d.stl",
            "m.obj+s.pc2",
            "m2.ply+s.mdd",
        ] {
            let said = pliant(path, &["convert", "s_*.obj", to]);
            assert_eq!(said.code, 0, "{}", said.err);
        }
        let alone = |weld: &[&str]| -> Vec<u64> {
            let of = |frame: usize| {
                let name = format!("s_{frame}.obj");
                counts_of(path, &[&[&*name], weld].concat())[0]
            };
            (0..3).map(of).collect()
        };
        for (weld, expected) in [
            (&[][..], None),
            (&["--weld", "1e-6"], (by < 0.1).then_some([0, 0, 1])),
        ] {
            let alone = alone(weld);
            assert!(alone[0] == 0 && alone[2] == 1, "{alone:?}");
            if let Some(expected) = expected {
                assert_eq!(alone, expected);
            }
            // The fin goes through one triangle. Where the seam is open, its sides cross.
            assert_eq!(alone[1] > 0, by > 0.1 || weld.is_empty(), "{alone:?}");
            for name in [
                "s_*.obj",
                "s.npz",
                "c_*.ply",
                "c_*.stl",
                "m.obj+s.pc2",
                "m2.ply+s.mdd",
            ] {
                assert_eq!(counts_of(path, &[&[name], weld].concat()), alone, "{name}");
            }
        }
    }
}

/// The only line about seams that part.
fn note(said: &Said) -> &str {
    let lines: Vec<&str> = said.err.trim_end().lines().collect();
    assert_eq!(lines.len(), 1, "{}", said.err);
    lines[0]
}

#[test]
fn one_line_says_how_many_where_and_when() {
    let folder = sequence(1.2e-7);
    let said = check(folder.path(), &["s_*.obj", "--count"]);
    assert!(said.code == 1, "{}", said.err);
    for words in [
        "note: s_*.obj: seams that are closed in the first frame are open in frame 1: 5 vertices \
         part there, ",
        " and 1",
        " at (1.0, ",
        ", 0.0) farthest, by 1.9e-8 of the body's size; ",
        "the sides of an open seam may intersect; `--weld 1e-6` keeps together what parts by \
         rounding",
    ] {
        let is_said = said.err.lines().any(|line| line.contains(words));
        assert!(is_said, "{words}: {}", said.err);
    }
    // With the tolerance it stays together.
    let said = check(folder.path(), &["s_*.obj", "--count", "--weld", "1e-6"]);
    assert_eq!((said.code, said.err.as_str()), (1, ""));
    let said = check(folder.path(), &["s_*.obj", "--quiet"]);
    assert_eq!((said.code, said.err.as_str()), (1, ""));
    // Beyond the given tolerance there is no other advice.
    let folder = sequence(0.125);
    let said = check(folder.path(), &["s_*.obj", "--count", "--weld", "1e-6"]);
    assert!(
        note(&said).ends_with("the sides of an open seam may intersect"),
        "{}",
        said.err
    );
    // Nothing is noted where seams are to stay open.
    let said = check(folder.path(), &["s_*.obj", "--count", "--no-weld"]);
    assert!(!said.err.contains("seams"), "{}", said.err);
}

/// Files `stack_*.stl`: two closed cubes that touch along a face in the first frame, then part.
fn stacks(offsets: &[f32]) -> TempDir {
    let corners = |z: f32| -> Vec<[f32; 3]> {
        let bit = |number: u8, bit: u8| f32::from(number >> bit & 1);
        (0..8)
            .map(|k| [bit(k, 0), bit(k, 1), bit(k, 2) + z])
            .collect()
    };
    let faces = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    let names: Vec<String> = (0..offsets.len())
        .map(|n| format!("stack_{n}.stl"))
        .collect();
    let files = names.iter().zip(offsets).map(|(name, offset)| {
        let mut text = String::new();
        for (solid, z) in [("lower", 0.0), ("upper", 1.0 + offset)] {
            writeln!(text, "solid {solid}").unwrap();
            let corners = corners(z);
            for face in faces {
                writeln!(text, "facet normal 0 0 0\nouter loop").unwrap();
                for [x, y, z] in face.map(|corner: usize| corners[corner]) {
                    writeln!(text, "vertex {x} {y} {z}").unwrap();
                }
                writeln!(text, "endloop\nendfacet").unwrap();
            }
            writeln!(text, "endsolid {solid}").unwrap();
        }
        (name.as_str(), text)
    });
    folder(&files.collect::<Vec<_>>())
}

#[test]
fn solids_that_touch_may_go_apart() {
    let folder = stacks(&[0.0, 0.5, 1.0]);
    // Where they touch, two triangles of each stand twice.
    let said = check(folder.path(), &["stack_*.stl"]);
    assert!(said.out.contains("2 triangles stand twice"), "{}", said.out);
    assert_eq!(said.code, 1, "{}", said.err);
    let apart = check(folder.path(), &["stack_*.stl", "--ignore-adjacent"]);
    assert_eq!(apart.code, 0, "{}", apart.err);
    let words = "seams that are closed in the first frame are open in 2 frames, 1 to 2, and widest \
                 in frame 2: 4 vertices part there, ";
    assert!(note(&said).contains(words), "{}", said.err);
    // Pieces and groups of the first frame stay, and are no reason to stop.
    for (split, bodies) in [("components", 1), ("groups", 2)] {
        let arguments = ["stack_*.stl", "--split", split, "--format", "json"];
        let said = check(
            folder.path(),
            &[&arguments[..], &["--ignore-adjacent"]].concat(),
        );
        assert_eq!((said.code, said.counts()), (0, vec![0; 3]), "{}", said.err);
        assert_eq!(said.json()["bodies"].as_array().unwrap().len(), bodies);
    }
    // The other way round: cubes that touch are one solid alone.
    let folder = stacks(&[1.0, 0.5, 0.0]);
    let alone = check(folder.path(), &["stack_2.stl", "--ignore-adjacent"]);
    let said = check(folder.path(), &["stack_*.stl", "--ignore-adjacent"]);
    assert_eq!((alone.code, said.code, said.err.as_str()), (0, 0, ""));
}

fn intervals(said: &Said) -> Vec<Value> {
    let json = said.json();
    let frames = json["frames"].as_array().unwrap().iter();
    frames
        .filter(|it| it.get("until").is_some())
        .cloned()
        .collect()
}

#[test]
fn no_way_between_two_frames_is_skipped() {
    // Apart, then through each other: the side of the upper cube is not held where it was joined.
    let folder = stacks(&[0.0, 0.5, -0.5, -0.5]);
    let arguments = ["stack_*.stl", "--swept", "--format", "json"];
    let said = check(folder.path(), &arguments);
    assert_eq!(said.code, 1, "{}", said.err);
    let ways = intervals(&said);
    let facts = |way: &Value| {
        (
            way["count"].as_u64().unwrap() > 0,
            way["at_start"].as_u64().unwrap() > 0,
        )
    };
    let facts: Vec<_> = ways.iter().map(facts).collect();
    assert_eq!(
        facts,
        [(false, true), (true, false), (false, true)],
        "{}",
        said.out
    );
    // Half way from half above to half below.
    assert_eq!(ways[1]["first"]["time"], 0.5);
    assert!(!said.err.contains("not looked at"), "{}", said.err);

    for by in DISTANCES {
        let folder = sequence(by);
        let arguments = ["s_*.obj", "--swept", "--format", "json", "--weld", "1e-6"];
        for split in [&[][..], &["--split", "components"]] {
            let said = check(folder.path(), &[&arguments[..], split].concat());
            let ways = intervals(&said);
            assert!(ways.iter().all(|way| way.get("changed").is_none()));
            // The tip of the fin meets the strip half way. A seam that rounding parts is closed
            // throughout.
            let meets = by < 0.1 && split.is_empty();
            if meets {
                assert_eq!([&ways[0]["count"], &ways[0]["at_start"]], [0, 0]);
            }
            let tip = ways[1]["vertex_triangle"].as_array().unwrap().iter();
            let mut times = tip.filter(|it| it[1] == 20).map(|it| &it[5]);
            assert_eq!(times.next(), Some(&0.5.into()), "{}", said.out);
        }
    }
    // A page shows it all.
    let folder = stacks(&[0.0, 0.5, -0.5]);
    let said = check(
        folder.path(),
        &["stack_*.stl", "--swept", "--report", "a.html"],
    );
    assert_eq!(said.code, 1, "{}", said.err);
    assert!(fs::metadata(folder.path().join("a.html")).is_ok());
}

#[test]
fn pairs_of_a_baseline_are_left_out_whatever_seams_do() {
    let folder = sequence(0.125);
    let said = check(
        folder.path(),
        &["s_*.obj", "--baseline", "1", "--format", "json"],
    );
    let left_out: Vec<_> = said.json()["frames"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| (frame["count"].as_u64(), frame["left_out"].as_u64()))
        .collect();
    let all = counts_of(folder.path(), &["s_1.obj"])[0];
    let expected = [(0, 0), (0, all), (1, 0)];
    let expected = expected.map(|(count, left_out)| (Some(count), Some(left_out)));
    assert_eq!(left_out, expected);
}

#[test]
fn what_is_converted_has_one_mesh() {
    let folder = stacks(&[0.0, 0.5]);
    let said = pliant(folder.path(), &["convert", "stack_*.stl", "a.npz"]);
    said.assert_refused(&[
        "stack_*.stl: vertices ",
        "are one in frame 0",
        "apart in frame 1",
        "use `--no-weld`",
    ]);
    assert!(!folder.path().join("a.npz").exists());
    let said = pliant(
        folder.path(),
        &["convert", "stack_*.stl", "a.npz", "--no-weld"],
    );
    assert_eq!(said.code, 0, "{}", said.err);
    let said = check(folder.path(), &["a.npz", "--ignore-adjacent"]);
    assert_eq!(said.code, 0, "{}", said.err);
}
