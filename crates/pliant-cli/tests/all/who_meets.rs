//! End-to-end tests of rules on who may meet, and of baselines: --split, --group, --ignore,
//! --baseline.

use crate::common::{check, folder, kinds, measured};
use serde_json::json;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A triangle that stands upright in x and crosses z from -1 to 1.
fn upright(x: f64) -> String {
    format!("v {x} 0 -1\nv {x} 0 1\nv {x} 2 1\nf -1 -2 -3\n")
}

/// A triangle in the plane z. Uprights from x = 0 to 4 cross it where z is from -1 to 1.
fn flat(z: f64) -> String {
    format!("v -1 -1 {z}\nv 9 -1 {z}\nv -1 9 {z}\nf -1 -2 -3\n")
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    check(folder, &[arguments, &["--format", "json"]].concat()).json_without_places()
}

/// A file of three pieces with mixed triangles: a square of two, a sheet that crosses it, and one
/// apart.
fn mixed() -> String {
    let square = "v 1 0 -1\nv 1 0 1\nv 1 2 1\nv 1 2 -1\n";
    square.to_owned() + "f 1 2 3\n" + &flat(0.0) + "f 1 3 4\n" + &flat(50.0)
}

#[test]
fn pieces_of_a_file_are_bodies() {
    let folder = folder(&[("mixed.obj", mixed()), ("still.obj", upright(3.0))]);
    let said = json(
        folder.path(),
        &["mixed.obj", "still.obj", "--split", "components"],
    );
    let piece = |name: &str, vertices: u32, triangles: u32, source: u32, first: u32| {
        json!({
            "name": name, "vertices": vertices, "triangles": triangles,
            "source": source, "first_triangle": first
        })
    };
    let bodies = json!([
        piece("mixed.obj#1", 4, 2, 0, 0),
        piece("mixed.obj#2", 3, 1, 0, 1),
        piece("mixed.obj#3", 3, 1, 0, 3),
        piece("still.obj#1", 3, 1, 1, 0),
    ]);
    let sources = json!([
        {"name": "mixed.obj", "vertices": 10, "triangles": 4},
        {"name": "still.obj", "vertices": 3, "triangles": 1},
    ]);
    // Triangles are numbered as in the file: the sheet is triangle 1 of its piece's source.
    let frames = json!([{
        "frame": 0, "count": 3, "kinds": kinds([3, 0, 0]),
        "pairs": [[0, 0, 1, 1], [0, 2, 1, 1], [1, 1, 3, 0]],
        "adjacent": 0, "adjacent_pairs": [], "crossing_edges": [[0, 1, 3, 3], [3, 1, 2, 2]]
    }]);
    assert_eq!(
        said,
        json!({
            "format": 1, "bodies": bodies, "split": "components", "triangle_numbers": "source",
            "sources": sources, "frames": frames
        })
    );

    let table = check(folder.path(), &["mixed.obj", "--split", "components"]).out;
    assert!(
        table.contains("body 2: mixed.obj#3, 3 vertices, 1 triangle, from triangle 3 on"),
        "{table}"
    );
    assert!(
        table.contains("of mixed.obj, 10 vertices, 4 triangles"),
        "{table}"
    );
    assert!(
        table.contains("triangle 0 of body 0, triangle 1 of body 1"),
        "{table}"
    );
    assert!(
        table.contains("bodies with each other, not with themselves"),
        "{table}"
    );

    // A single piece is checked with itself, as a single body is.
    let alone = check(folder.path(), &["still.obj", "--split", "components"]).out;
    assert!(alone.contains("the body with itself"), "{alone}");
    let words = check(folder.path(), &["still.obj", "--split", "halves"]);
    assert!(
        words.code == 2 && words.err.contains("components"),
        "{}",
        words.err
    );
}

#[test]
fn what_is_welded_hangs_together() {
    // Two triangles with vertices of their own along one edge, and one that crosses both.
    let strip = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    let folder = folder(&[("strip.obj", strip.to_owned() + &upright(0.5))]);
    let split = ["strip.obj", "--split", "components"];
    let welded = json(folder.path(), &split);
    assert_eq!(welded["bodies"].as_array().unwrap().len(), 2);
    assert_eq!(welded["sources"][0]["welded"], 2);
    assert_eq!(
        welded["frames"][0]["pairs"],
        json!([[0, 0, 1, 2], [0, 1, 1, 2]])
    );
    let apart = json(folder.path(), &[&split[..], &["--no-weld"]].concat());
    assert_eq!(apart["bodies"].as_array().unwrap().len(), 3);
    assert_eq!(apart["frames"][0]["count"], 3);
}

/// A shell of separate triangles, and an upright triangle that crosses the lowest.
fn shell(triangles: u32) -> String {
    let mut text = String::new();
    let side = 100;
    for i in 0..triangles {
        let (x, y, z) = (i % side, i / side % side, i / side / side);
        writeln!(
            text,
            "v {x} {y} {z}\nv {x}.5 {y} {z}\nv {x} {y}.5 {z}\nf -1 -2 -3"
        )
        .unwrap();
    }
    text + "v 0.1 0.1 -1\nv 0.1 0.2 0.5\nv 0.2 0.1 0.5\nf -1 -2 -3\n"
}

#[test]
fn a_shell_of_single_triangles_is_no_danger() {
    let count = 20_000;
    let folder = folder(&[("shell.obj", shell(count))]);
    let path = folder.path();
    let split = measured(
        path,
        &["check", "shell.obj", "--count", "--split", "components"],
    );
    assert_eq!(split.said.code, 1, "{}", split.said.err);
    let head = format!("bodies 0 to {count}: shell.obj#1 to #{}, ", count + 1);
    assert!(split.said.out.contains(&head), "{}", split.said.out);
    assert_eq!(split.said.out.lines().count(), 8, "{}", split.said.out);
    let named = ["--ignore", "shell.obj,shell.obj"];
    let ignored = check(
        path,
        &[&["shell.obj", "--split", "components"], &named[..]].concat(),
    );
    assert_eq!(ignored.code, 0, "{}", ignored.out);
    // The promise for any file: 3.5 times two frames and 12 MB. A body of its own in the world
    // takes two thousand bytes.
    let frame = u64::from(count + 1) * (3 * 24 + 12);
    if let Some(peak) = split.peak {
        assert!(peak < 7 * frame + (12 << 20), "{peak}");
    }
}

#[test]
fn groups_say_who_meets_whom() {
    let files = [("a.obj", 0.0), ("b.obj", 1.0), ("c.obj", 2.0)];
    let mut files: Vec<_> = files.map(|(name, x)| (name, upright(x))).into();
    files.extend([("low.obj", flat(0.0)), ("mid.obj", flat(0.5))]);
    let folder = folder(&files);
    let all = ["a.obj", "b.obj", "c.obj", "low.obj", "mid.obj"];
    let pairs = |more: &[&str]| {
        let said = json(folder.path(), &[&all[..], more].concat());
        let pairs = said["frames"][0]["pairs"].as_array().unwrap().clone();
        pairs
            .iter()
            .map(|p| [p[0].as_u64().unwrap(), p[2].as_u64().unwrap()])
            .collect::<Vec<_>>()
    };
    assert_eq!(pairs(&[]), [[0, 3], [0, 4], [1, 3], [1, 4], [2, 3], [2, 4]]);
    assert_eq!(pairs(&["--ignore", "a.obj,low.obj"]).len(), 5);
    assert_eq!(
        pairs(&["--ignore", "mid.obj,2", "--ignore", "3,0"]),
        [[0, 4], [1, 3], [1, 4], [2, 3]]
    );
    let up = ["--group", "up=a.obj,1", "--group", "sheets=low.obj,mid.obj"];
    assert_eq!(
        pairs(&[&up[..], &["--ignore", "up,sheets"]].concat()),
        [[2, 3], [2, 4]]
    );
    assert_eq!(
        pairs(&[&up[..], &["--ignore", "up,low.obj"]].concat()),
        [[0, 4], [1, 4], [2, 3], [2, 4]]
    );
    assert_eq!(
        pairs(&[&up[..], &["--ignore", "sheets,sheets"]].concat()).len(),
        6
    );

    let said = json(
        folder.path(),
        &[&all[..], &up, &["--ignore", "up,sheets", "--ignore", "2,2"]].concat(),
    );
    assert_eq!(
        said["groups"],
        json!({"up": ["a.obj", "1"], "sheets": ["low.obj", "mid.obj"]})
    );
    assert_eq!(said["ignore"], json!([["up", "sheets"], ["2", "2"]]));
    let table = check(
        folder.path(),
        &[&all[..], &up, &["--ignore", "up,sheets"]].concat(),
    );
    assert!(
        table.out.contains("; ignored: up with sheets\n"),
        "{}",
        table.out
    );
}

#[test]
fn a_body_can_be_left_alone_with_itself() {
    let crumpled = upright(0.0) + &flat(0.0);
    let folder = folder(&[("a.obj", crumpled.clone()), ("b.obj", crumpled)]);
    let count = |more: &[&str]| {
        json(
            folder.path(),
            &[&["a.obj", "b.obj", "--self"], more].concat(),
        )["frames"][0]["count"]
            .as_u64()
            .unwrap()
    };
    let all = count(&[]);
    assert_eq!(count(&["--ignore", "0,0"]), all - 1);
    assert_eq!(count(&["--group", "g=0,1", "--ignore", "g,g"]), 0);
    assert_eq!(count(&["--ignore", "0,1"]), 2);
    assert_eq!(count(&["--ignore", "0,1", "--first"]), 1);
    assert_eq!(
        count(&[
            "--ignore", "0,1", "--ignore", "0,0", "--ignore", "1,1", "--first"
        ]),
        0
    );
}

#[test]
fn names_of_nobody_are_refused() {
    let folder = folder(&[("a.obj", flat(0.0)), ("b.obj", flat(1.0))]);
    let refused = |more: &[&str], words: &[&str]| {
        let said = check(folder.path(), &[&["a.obj", "b.obj"], more].concat());
        said.assert_refused(words);
        assert_eq!(said.out, "");
    };
    refused(
        &["--ignore", "a.obj,hat.obj"],
        &["\"hat.obj\"", "0 = \"a.obj\", 1 = \"b.obj\""],
    );
    refused(
        &["--group", "g=a.obj,hat.obj"],
        &["\"hat.obj\"", "1 = \"b.obj\""],
    );
    refused(
        &["--group", "g=0", "--ignore", "g,h"],
        &["\"h\"", "groups: \"g\""],
    );
    refused(
        &["--baseline", "1"],
        &["baseline", "frame 1", "these files have one frame, 0"],
    );
    refused(&["--baseline", "last"], &["the baseline last"]);
    // Unreadable lists are explained where they are parsed.
    for more in [
        ["--ignore", "a.obj"],
        ["--ignore", "a,b,c"],
        ["--group", "g"],
        ["--baseline", "1.5"],
    ] {
        let said = check(folder.path(), &[&["a.obj"], &more[..]].concat());
        assert!(said.code == 2 && said.err.contains(more[0]), "{}", said.err);
    }
}

/// Six frames: an upright triangle moves along x, through the sheet, beyond it from frame 3 on.
///
/// Another triangle crosses the sheet in every frame.
fn moving() -> TempDir {
    let mut files = Vec::new();
    for frame in 0..6 {
        let x = if frame < 4 { f64::from(frame) } else { 90.0 };
        files.push((format!("m_{frame}.obj"), upright(x) + &upright(5.0)));
    }
    files.push(("sheet.obj".to_owned(), flat(0.0)));
    let files: Vec<_> = files
        .iter()
        .map(|(name, text)| (name.as_str(), text.clone()))
        .collect();
    folder(&files)
}

#[test]
fn only_what_is_new() {
    let folder = moving();
    let bodies = ["m_*.obj", "sheet.obj"];
    let counts = |more: &[&str]| {
        let said = json(folder.path(), &[&bodies[..], more].concat());
        let of = |frame: &serde_json::Value, name: &str| frame[name].as_u64();
        let frames = said["frames"].as_array().unwrap().clone();
        let counts = frames
            .iter()
            .map(|frame| (of(frame, "count").unwrap(), of(frame, "left_out")));
        counts.collect::<Vec<_>>()
    };
    let plain = [2, 2, 2, 2, 1, 1].map(|count| (count, None));
    assert_eq!(counts(&[]), plain);
    // Frame 4 has one of the two: the other is new while it is there.
    let after_4 = [(1, 1), (1, 1), (1, 1), (1, 1), (0, 1), (0, 1)].map(|(n, out)| (n, Some(out)));
    assert_eq!(counts(&["--baseline", "4"]), after_4);
    assert_eq!(counts(&["--baseline", "4", "--count"]), after_4);
    let after_0 = [(0, 2), (0, 2), (0, 2), (0, 2), (0, 1), (0, 1)].map(|(n, out)| (n, Some(out)));
    assert_eq!(counts(&["--baseline", "0"]), after_0);
    // The first new pair; how many are left out is known where there is none.
    let first = [
        (1, None),
        (1, None),
        (1, None),
        (1, None),
        (0, Some(1)),
        (0, Some(1)),
    ];
    assert_eq!(counts(&["--baseline", "4", "--first"]), first);

    let said = json(folder.path(), &[&bodies[..], &["--baseline", "4"]].concat());
    assert_eq!(said["baseline"], 4);
    assert_eq!(said["frames"][0]["pairs"], json!([[0, 0, 1, 0]]));
    let code = |frame: &str| {
        check(
            folder.path(),
            &[&bodies[..], &["--baseline", frame]].concat(),
        )
        .code
    };
    assert_eq!((code("0"), code("4")), (0, 1));

    let table = check(
        folder.path(),
        &[&bodies[..], &["--baseline", "4", "--first"]].concat(),
    )
    .out;
    let lines: Vec<_> = table.lines().map(str::trim).collect();
    for line in [
        "checked: the bodies with each other, not with themselves; left out: pairs that frame 4 \
         has",
        "frame  file        pairs  left out  first pair",
        "0  m_0.obj         1         -  triangle 0 of body 0, triangle 0 of body 1",
        "4  m_4.obj         0         1",
    ] {
        assert!(lines.contains(&line), "{line:?} is not in {table}");
    }
}

#[test]
fn a_baseline_that_cannot_be_read_is_an_error() {
    let folder = moving();
    fs::write(folder.path().join("m_5.obj"), "no mesh").unwrap();
    let said = check(
        folder.path(),
        &[
            "m_*.obj",
            "sheet.obj",
            "--baseline",
            "5",
            "--format",
            "json",
        ],
    );
    said.assert_refused(&["m_5.obj"]);
    assert_eq!(said.json()["frames"], json!([]));
    assert!(said.json()["error"].as_str().unwrap().contains("m_5.obj"));
}

#[test]
fn with_itself_too() {
    let mut files = vec![(
        "0.obj".to_owned(),
        upright(0.0) + &flat(0.0) + &upright(70.0),
    )];
    files.push((
        "1.obj".to_owned(),
        upright(0.0) + &flat(0.0) + &upright(1.0),
    ));
    let files: Vec<_> = files
        .iter()
        .map(|(name, text)| (name.as_str(), text.clone()))
        .collect();
    let folder = folder(&files);
    let frames = json(folder.path(), &["*.obj", "--baseline", "0"])["frames"].clone();
    let expected = json!([
        {"frame": 0, "count": 0, "left_out": 1, "pairs": [], "adjacent": 0, "adjacent_pairs": [],
            "adjacent_left_out": 0, "crossing_edges": [[0, 0, 2, 2]]},
        {"frame": 1, "count": 1, "kinds": kinds([1, 0, 0]), "left_out": 1, "pairs": [[0, 1, 0, 2]],
            "adjacent": 0, "adjacent_pairs": [], "adjacent_left_out": 0,
            "crossing_edges": [[0, 0, 4, 4]]},
    ]);
    assert_eq!(frames, expected);
}
