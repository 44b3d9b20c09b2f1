//! End-to-end tests of `pliant check --crossing`.

use crate::common::{check, folder, pliant};
use serde_json::{Value, json};
use std::fmt::Write;

/// A box of unit cubes in each direction, a quadrilateral on each outer side, from a corner on.
fn cubes(from: [f64; 3], size: [usize; 3]) -> String {
    let (mut text, mut faces, mut vertices) = (String::new(), String::new(), 0);
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for end in [0, size[axis]] {
            let number = |i: usize, j: usize| vertices + 1 + i * (size[v] + 1) + j;
            for i in 0..=size[u] {
                for j in 0..=size[v] {
                    let mut at = from;
                    at[axis] += end as f64;
                    at[u] += i as f64;
                    at[v] += j as f64;
                    writeln!(text, "v {} {} {}", at[0], at[1], at[2]).unwrap();
                    if i < size[u] && j < size[v] {
                        let mut face = [
                            number(i, j),
                            number(i + 1, j),
                            number(i + 1, j + 1),
                            number(i, j + 1),
                        ];
                        if end == 0 {
                            face.reverse();
                        }
                        let [a, b, c, d] = face;
                        writeln!(faces, "f {a} {b} {c} {d}").unwrap();
                    }
                }
            }
            vertices += (size[u] + 1) * (size[v] + 1);
        }
    }
    text + &faces
}

/// Places of a beam: on a block, pushed in exactly along edges of both, pushed in anyhow, apart.
const BEAM: [[f64; 3]; 4] = [
    [4.0, 1.0, 1.0],
    [2.0, 1.0, 1.0],
    [2.5, 1.25, 1.25],
    [9.0, 1.0, 1.0],
];

fn files() -> tempfile::TempDir {
    let names = ["beam_0.obj", "beam_1.obj", "beam_2.obj", "beam_3.obj"];
    let beams = names.into_iter().zip(BEAM);
    let beams = beams.map(|(name, from)| (name, cubes(from, [4, 2, 2])));
    let block = ("block.obj", cubes([0.0; 3], [4; 3]));
    let files: Vec<_> = beams.chain([block]).collect();
    folder(&files)
}

#[test]
fn places_that_only_touch_are_left_out_and_what_passes_at_edges_is_not() {
    let folder = files();
    let frames = |more: &[&str]| -> Vec<Value> {
        let all = ["beam_*.obj", "block.obj", "--format", "json"];
        let said = check(folder.path(), &[&all, more].concat());
        assert!(said.code < 2, "{}", said.err);
        let said = said.json();
        let crossing = more.contains(&"--crossing");
        assert_eq!(said.get("crossing"), crossing.then_some(&json!(true)));
        said["frames"].as_array().unwrap().clone()
    };
    let (all, crossing) = (frames(&[]), frames(&["--crossing"]));
    let counts = |frames: &[Value], name: &str| -> Vec<u64> {
        let counts = frames.iter().map(|frame| frame[name].as_u64());
        counts.map(Option::unwrap_or_default).collect()
    };
    let [on, along, through, away] = counts(&all, "count")[..] else {
        panic!("four frames");
    };
    assert!(on > 0 && along > 0 && through > 0 && away == 0);
    for frame in [0, 1] {
        // No two triangles cross.
        assert_eq!(all[frame]["kinds"]["crossing"], 0);
    }
    assert_ne!(all[2]["kinds"]["crossing"], 0);
    assert_eq!(counts(&crossing, "count"), [0, along, through, 0]);
    assert_eq!(counts(&crossing, "only_touching"), [on, 0, 0, 0]);
    assert!(
        crossing
            .iter()
            .all(|frame| frame.get("only_touching").is_some())
    );
    assert!(all.iter().all(|frame| frame.get("only_touching").is_none()));
    assert_eq!(crossing[1]["pairs"], all[1]["pairs"]);
    assert_eq!(crossing[2]["kinds"], all[2]["kinds"]);
    assert_eq!(crossing[0]["places"], json!([]));
    assert_eq!(crossing[1]["places"].as_array().map(Vec::len), Some(1));

    // One pair of each frame, and their numbers alone.
    let first = frames(&["--crossing", "--first"]);
    assert_eq!(counts(&first, "count"), [0, 1, 1, 0]);
    let counted = frames(&["--crossing", "--count"]);
    assert_eq!(counts(&counted, "count"), [0, along, through, 0]);
    // A baseline leaves out all pairs that intersect in its frame, whether or not they only touch.
    let known = frames(&["--crossing", "--baseline", "1"]);
    assert_eq!(counts(&known, "left_out")[1], along);
    let known = frames(&["--crossing", "--baseline", "0"]);
    let of_first = all[0]["pairs"].as_array().unwrap();
    let are_new = |pairs: &Value| {
        pairs
            .as_array()
            .unwrap()
            .iter()
            .all(|pair| !of_first.contains(pair))
    };
    assert!(known.iter().all(|frame| are_new(&frame["pairs"])));
}

#[test]
fn the_exit_code_and_the_table_say_so() {
    let folder = files();
    let touches = ["beam_0.obj", "block.obj"];
    let said = check(folder.path(), &touches);
    assert_eq!(said.code, 1);
    assert!(
        said.out
            .contains("touch; `--crossing` leaves out places where surfaces only touch"),
        "{}",
        said.out
    );
    let said = check(folder.path(), &[&touches[..], &["--crossing"]].concat());
    assert_eq!(said.code, 0, "{}", said.out);
    assert!(said.out.contains("0 of 1 frames intersect"), "{}", said.out);
    assert!(
        said.out
            .contains("; left out: places where surfaces only touch"),
        "{}",
        said.out
    );
    assert!(
        said.out
            .contains("pairs of places where surfaces only touch"),
        "{}",
        said.out
    );
    let said = check(
        folder.path(),
        &[
            "beam_2.obj",
            "beam_0.obj",
            "block.obj",
            "--crossing",
            "--quiet",
        ],
    );
    assert_eq!(said.code, 1);
    assert_eq!(said.out, "");
    let said = pliant(
        folder.path(),
        &[
            "check",
            "beam_0.obj",
            "block.obj",
            "--crossing",
            "--within",
            "1",
        ],
    );
    assert_eq!(said.code, 2);
    assert!(
        said.err.contains("--crossing") && said.err.contains("--within"),
        "{}",
        said.err
    );
}

#[test]
fn a_place_that_touches_does_not_go_with_one_that_crosses() {
    let folder = folder(&[
        ("block.obj", cubes([0.0; 3], [4; 3])),
        ("touches.obj", cubes([4.0, 1.0, 1.0], [2, 2, 2])),
        ("crosses.obj", cubes([-1.5, 1.25, 1.25], [2, 2, 2])),
    ]);
    let said = check(
        folder.path(),
        &[
            "block.obj",
            "touches.obj",
            "crosses.obj",
            "--crossing",
            "--format",
            "json",
        ],
    );
    let frame = &said.json()["frames"][0];
    let pairs = frame["pairs"].as_array().unwrap();
    assert!(
        !pairs.is_empty() && pairs.iter().all(|pair| pair[2] == 2),
        "{pairs:?}"
    );
    assert_ne!(frame["only_touching"], 0);
}
