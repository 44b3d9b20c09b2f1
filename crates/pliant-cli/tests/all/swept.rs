//! End-to-end tests of `pliant check --swept`.

use crate::common::{Said, check, folder, kinds};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

/// A triangle in the plane z = 0.
fn floor() -> String {
    "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n".to_owned()
}

/// A triangle that stands on a corner at this height. Its other corners are five above.
fn leaf(height: f64) -> String {
    let above = height + 5.0;
    format!("v 0 0 {height}\nv 1 0 {above}\nv 0 1 {above}\nf 1 2 3\n")
}

/// Files `leaf_0.obj`, `leaf_1.obj`, ... at these heights, over `floor.obj`.
fn falling(heights: &[f64]) -> TempDir {
    let names: Vec<String> = (0..heights.len())
        .map(|n| format!("leaf_{n}.obj"))
        .collect();
    let leaves = names.iter().zip(heights);
    let mut files: Vec<(&str, String)> = leaves
        .map(|(name, &height)| (name.as_str(), leaf(height)))
        .collect();
    files.push(("floor.obj", floor()));
    folder(&files)
}

fn swept(folder: &Path, more: &[&str]) -> Said {
    check(
        folder,
        &[&["leaf_*.obj", "floor.obj", "--swept"], more].concat(),
    )
}

/// Frames without their places.
fn frames(said: &Said) -> Value {
    let mut json = said.json();
    let frames = json["frames"].as_array_mut().unwrap();
    for frame in frames.iter_mut() {
        for member in ["places", "inside", "not_closed"] {
            frame.as_object_mut().unwrap().remove(member);
        }
    }
    json["frames"].take()
}

/// Grid of times, 2^-20: the power of two below a millionth. Times are between neighbouring
/// multiples.
const STEP: f64 = 1.0 / 1_048_576.0;

#[test]
fn a_jump_through_a_triangle_has_its_exact_time() {
    // Corners at 3 and 8 come to -7 and -2: after 0.3 and 0.8 of the way they are at 0.
    let folder = falling(&[3.0, -7.0]);
    let cell = |time: f64| [(time / STEP).floor() * STEP, (time / STEP).ceil() * STEP];
    let ([low, high], [later, last]) = (cell(0.3), cell(0.8));
    assert!(low < 0.3 && 0.3 < high && high - low <= 1e-6);
    let said = swept(folder.path(), &["--format", "json"]);
    assert_eq!(said.code, 1);
    assert_eq!(said.json()["swept"], true);
    let interval = json!({
        "frame": 0, "until": 1, "count": 3, "at_start": 0,
        "first": {"time": high, "kind": "vertex_triangle", "pair": [0, 0, 1, 0]},
        "vertex_triangle": [
            [0, 0, 1, 0, low, high], [0, 1, 1, 0, later, last], [0, 2, 1, 0, later, last]
        ],
        "edge_edge": []
    });
    let [first, second] =
        [0, 1].map(|frame| json!({"frame": frame, "count": 0, "pairs": [], "crossing_edges": []}));
    assert_eq!(frames(&said), json!([first, interval, second]));

    let said = swept(folder.path(), &["--format", "json", "--count"]);
    let counted = json!({
        "frame": 0, "until": 1, "count": 3, "at_start": 0,
        "first": {"time": high, "kind": "vertex_triangle", "pair": [0, 0, 1, 0]}
    });
    let [first, second] =
        [0, 1].map(|frame| json!({"frame": frame, "count": 0, "crossing_edges": []}));
    assert_eq!(frames(&said), json!([first, counted, second]));

    let said = swept(folder.path(), &["--format", "json", "--first"]);
    let first = json!({
        "frame": 0, "until": 1, "count": 1, "complete": false, "at_start": 0,
        "first": {"time": high, "kind": "vertex_triangle", "pair": [0, 0, 1, 0]},
        "vertex_triangle": [[0, 0, 1, 0, low, high]], "edge_edge": []
    });
    assert_eq!(frames(&said)[1], first);

    // Nothing about it where it is not asked for; a later check takes the frames as its baseline.
    let said = check(
        folder.path(),
        &["leaf_*.obj", "floor.obj", "--format", "json"],
    );
    assert_eq!((said.code, said.json().get("swept")), (0, None));
    let said = swept(folder.path(), &["--format", "json"]);
    std::fs::write(folder.path().join("old.json"), said.out).unwrap();
    let said = check(
        folder.path(),
        &["leaf_1.obj", "floor.obj", "--baseline", "old.json"],
    );
    said.assert_refused(&["leaf_*.obj"]);
    let said = check(
        folder.path(),
        &["leaf_*.obj", "floor.obj", "--baseline", "old.json"],
    );
    assert_eq!(said.code, 0, "{}", said.err);
}

#[test]
fn edges_that_meet_are_four_vertices_of_the_file() {
    // A bar along x falls on one along y; vertices that no triangle has are vertices of the file.
    let bar = |z: f64| {
        format!(
            "v 7 7 7\nv 1 0 {z}\nv -1 0 {z}\nv 0 0 {}\nf 2 3 4\n",
            z + 1.0
        )
    };
    let folder = folder(&[
        ("leaf_0.obj", bar(1.0)),
        ("leaf_1.obj", bar(-1.0)),
        (
            "floor.obj",
            "v 7 7 7\nv 0 0 -9\nv 0 2 0\nv 0 -1 0\nf 2 3 4\n".to_owned(),
        ),
    ]);
    let said = swept(folder.path(), &["--format", "json"]);
    let interval = &frames(&said)[1];
    assert_eq!(
        interval["first"],
        json!({"time": 0.5, "kind": "edge_edge", "pair": [0, 1, 2, 1, 2, 3]})
    );
    assert_eq!(
        interval["edge_edge"][0],
        json!([0, 1, 2, 1, 2, 3, 0.5 - STEP, 0.5])
    );
    let table = swept(folder.path(), &[]).out;
    assert!(
        table.contains("the first at 0.5: edge 1 to 2 of body 0, edge 2 to 3 of body 1"),
        "{table}"
    );
}

#[test]
fn what_touches_in_a_frame_is_news_of_the_way_there_alone() {
    // The corner touches in frame 1 exactly, and stays in it until frame 2.
    let folder = falling(&[1.0, 0.0, 0.0, 2.0]);
    let said = swept(folder.path(), &["--format", "json"]);
    let frames = frames(&said);
    let news = json!({"time": 1.0, "kind": "vertex_triangle", "pair": [0, 0, 1, 0]});
    let touch = json!([[0, 0, 1, 0]]);
    assert_eq!(
        frames,
        json!([
            {"frame": 0, "count": 0, "pairs": [], "crossing_edges": []},
            {"frame": 0, "until": 1, "count": 1, "at_start": 0, "first": news,
             "vertex_triangle": [[0, 0, 1, 0, 1.0 - STEP, 1.0]], "edge_edge": []},
            {"frame": 1, "count": 1, "kinds": kinds([0, 0, 1]), "pairs": touch,
             "crossing_edges": []},
            {"frame": 1, "until": 2, "count": 0, "at_start": 1, "first": null,
             "vertex_triangle": [], "edge_edge": []},
            {"frame": 2, "count": 1, "kinds": kinds([0, 0, 1]), "pairs": touch,
             "crossing_edges": []},
            {"frame": 2, "until": 3, "count": 0, "at_start": 1, "first": null,
             "vertex_triangle": [], "edge_edge": []},
            {"frame": 3, "count": 0, "pairs": [], "crossing_edges": []}
        ])
    );
}

#[test]
fn either_is_exit_code_1() {
    // Hits in frames alone, on the way alone, in both, in neither.
    for (heights, code) in [
        (&[-1.0, -1.0][..], 1),
        (&[3.0, -7.0], 1),
        (&[3.0, -1.0], 1),
        (&[3.0, 1.0], 0),
    ] {
        let folder = falling(heights);
        for more in [
            &[][..],
            &["--quiet"],
            &["--count"],
            &["--first"],
            &["--format", "json"],
        ] {
            let said = swept(folder.path(), more);
            assert_eq!(
                said.code, code,
                "{heights:?} {more:?}: {}{}",
                said.out, said.err
            );
            assert_eq!(said.out.is_empty(), more == ["--quiet"]);
        }
    }
}

#[test]
fn people_read_it() {
    let folder = falling(&[3.0, -7.0, -8.0, 0.0, 1.0]);
    let said = swept(folder.path(), &[]).out;
    for line in [
        "checked: the bodies with each other, not with themselves, and what meets on the way from \
         frame to frame",
        "   frame  file           pairs  first pair",
        "       0  leaf_0.obj         0",
        "    to 1                     3  met on the way, the first at 0.3: vertex 0 of body 0, \
         triangle 0 of body 1",
        "       1  leaf_1.obj         0",
        "    to 2                     0",
        "    to 3                     3  met on the way, the first at 0.375: vertex 1 of body 0, \
         triangle 0 of body 1",
        "    to 4                     0  in contact in frame 3 already: 1",
        "1 of 5 frames intersect; most pairs: 1 in frame 3",
        "on the way from a frame to the next something meets in 2 of 4",
    ] {
        assert!(said.lines().any(|it| it == line), "{line:?}: {said}");
    }
    let said = swept(folder.path(), &["--count"]).out;
    let line = "    to 1                     3  met on the way, the first at 0.3";
    assert!(said.lines().any(|it| it == line), "{said}");
}

#[test]
fn a_mesh_that_changes_is_said_so_and_that_interval_is_not_looked_at() {
    let folder = folder(&[
        ("leaf_0.obj", leaf(3.0)),
        ("leaf_1.obj", leaf(-7.0) + "f 3 2 1\n"),
        ("leaf_2.obj", leaf(3.0) + "f 3 2 1\n"),
        ("floor.obj", floor()),
    ]);
    let said = swept(folder.path(), &["--format", "json"]);
    assert_eq!(said.code, 1);
    let frames = frames(&said);
    assert_eq!(
        frames[1],
        json!({
            "frame": 0, "until": 1, "changed": [0], "count": null, "at_start": null, "first": null
        })
    );
    assert_eq!(
        (&frames[3]["frame"], &frames[3]["count"]),
        (&json!(1), &json!(3))
    );
    let note = "note: 1 interval between frames not looked at, for a mesh changes there: the first \
                from frame 0 to 1";
    assert!(said.err.contains(note), "{}", said.err);
    let table = swept(folder.path(), &[]);
    for line in [
        "    to 1                     -  not looked at: the mesh of body 0 changes",
        "on the way from a frame to the next something meets in 1 of 1; 1 not looked at, for a \
         mesh changes",
    ] {
        assert!(
            table.out.lines().any(|it| it == line),
            "{line:?}: {}",
            table.out
        );
    }
    assert!(table.err.contains(note), "{}", table.err);
    assert_eq!(swept(folder.path(), &["--quiet"]).err, "");
    // A skipped interval is no hit.
    std::fs::remove_file(folder.path().join("leaf_2.obj")).unwrap();
    let said = swept(folder.path(), &[]);
    assert_eq!(said.code, 0);
    let line = "on the way from a frame to the next something meets in 0 of 0; 1 not looked at, \
                for a mesh changes";
    assert!(said.out.lines().any(|it| it == line), "{}", said.out);
}

#[test]
fn what_has_no_way_or_no_form_is_refused() {
    let folder = falling(&[3.0, -7.0]);
    let refused = |arguments: &[&str], words: &[&str]| {
        check(folder.path(), &[arguments, &["--swept"]].concat()).assert_refused(words);
    };
    let alone = [
        "needs at least two frames, and only one is to be checked",
        "name a sequence, choose more of it with `--frames`, or leave out `--swept`",
    ];
    refused(&["floor.obj", "leaf_0.obj"], &alone);
    refused(&["floor.obj"], &alone);
    let both = ["leaf_*.obj", "floor.obj"];
    let with = |more: &[&'static str]| [&both[..], more].concat();
    refused(
        &with(&["--within", "0.1"]),
        &[
            "on the way, only contacts are found",
            "run two checks, one with `--within` and one with `--swept`",
        ],
    );
    refused(
        &with(&["--baseline", "0"]),
        &[
            "a baseline cannot be used for what meets on the way",
            "run two checks, one with `--baseline` and one with `--swept`",
        ],
    );
    for more in [
        ["--hits", "h.vtp"],
        ["--format", "lines"],
        ["--format", "github"],
    ] {
        let what = more.join(" ");
        let what = what.trim_end_matches(" h.vtp");
        refused(
            &with(&more),
            &[what, "leave out one of them", "`--format json`"],
        );
    }
    // An annotation, too, where that is asked for.
    let said = check(folder.path(), &with(&["--swept", "--format", "github"]));
    assert!(
        said.out.starts_with("::error title=pliant::--swept: "),
        "{}",
        said.out
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
    // A list has its limit: three vertices take 120 bytes.
    let said = swept(folder.path(), &["--format", "json", "--max-memory", "119"]);
    assert_eq!(said.code, 2);
    assert!(said.err.contains("--max-memory"), "{}", said.err);
}
