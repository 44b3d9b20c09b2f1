//! Triangles that share a vertex and meet beyond it: counted apart, wherever pairs are left out for
//! a shared vertex.

use crate::common::{check, folder, kinds};
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

/// One corner in common; they cross far from it.
const BOW: &str = "v 0 0 0\nv 3 1 -1\nv 3 1 1\nv 4 0 0\nv 4 2 0\nf 1 2 3\nf 1 4 5\n";
/// An edge in common, folded flat onto each other.
const FOLD: &str = "v 0 0 0\nv 4 0 0\nv 1 2 0\nv 2 1 0\nf 1 2 3\nf 2 1 4\n";
/// A triangle that is there twice.
const TWICE: &str = "v 0 0 0\nv 4 0 0\nv 1 2 0\nf 1 2 3\nf 1 3 2\n";
/// One corner in common; an edge of one ends on the other.
const TOUCH: &str = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 2 0.25 0\nv 2 0.25 1\nf 1 2 3\nf 1 4 5\n";
/// One corner in common, and nothing else.
const APART: &str = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv -4 0 0\nv -4 1 0\nf 1 2 3\nf 1 4 5\n";

fn files() -> TempDir {
    folder(&[
        ("bow.obj", BOW.to_owned()),
        ("fold.obj", FOLD.to_owned()),
        ("twice.obj", TWICE.to_owned()),
        ("touch.obj", TOUCH.to_owned()),
        ("apart.obj", APART.to_owned()),
        ("bow_1.obj", APART.to_owned()),
        ("bow_2.obj", BOW.to_owned()),
    ])
}

/// The frames of a check, in JSON.
fn frames(files: &TempDir, arguments: &[&str]) -> (i32, Vec<Value>) {
    let said = check(files.path(), &[arguments, &["--format", "json"]].concat());
    let frames = said.json()["frames"].as_array().unwrap().clone();
    (said.code, frames)
}

#[test]
fn each_kind_is_counted_listed_and_makes_exit_code_1() {
    let files = files();
    for (file, of_kinds, twice) in [
        ("bow.obj", [1, 0, 0], 0),
        ("fold.obj", [0, 1, 0], 0),
        ("twice.obj", [0, 1, 0], 1),
        ("touch.obj", [0, 0, 1], 0),
        ("apart.obj", [0, 0, 0], 0),
    ] {
        let count: usize = of_kinds.iter().sum();
        let code = i32::from(count > 0);
        let (found, of_file) = frames(&files, &[file]);
        let frame = &of_file[0];
        assert_eq!(found, code, "{file}");
        assert_eq!((&frame["count"], &frame["pairs"]), (&json!(0), &json!([])));
        assert_eq!(frame["adjacent"], json!(count));
        let pairs: Vec<_> = (0..count).map(|_| json!([0, 0, 0, 1])).collect();
        assert_eq!(frame["adjacent_pairs"], json!(pairs));
        let expected = if count > 0 {
            kinds(of_kinds)
        } else {
            Value::Null
        };
        assert_eq!(frame["adjacent_kinds"], expected);
        assert_eq!(frame.get("twice").map_or(0, |n| n.as_i64().unwrap()), twice);
        let places = frame["places"].as_array().unwrap();
        assert_eq!(places.len(), count);

        let counted = &frames(&files, &[file, "--count"]).1[0];
        assert_eq!(counted["adjacent"], json!(count));
        assert!(counted.get("adjacent_pairs").is_none());
        for quiet in [
            &[file, "--quiet"][..],
            &[file, "--first"],
            &[file, "--format", "github"],
        ] {
            assert_eq!(check(files.path(), quiet).code, code, "{file}");
        }
        // A line is a pair that shares no vertex, as ever.
        let lines = check(files.path(), &[file, "--format", "lines"]);
        assert_eq!((lines.code, lines.out.as_str()), (code, ""));
        // Crossing leaves out what only touches.
        let (crossing, of_file) = frames(&files, &[file, "--crossing"]);
        let left_out = of_kinds[2];
        assert_eq!(crossing, i32::from(count > left_out));
        assert_eq!(of_file[0]["adjacent_only_touching"], json!(left_out));

        let (ignored, of_file) = frames(&files, &[file, "--ignore-adjacent"]);
        assert_eq!((ignored, of_file[0].get("adjacent")), (0, None));
    }
}

#[test]
fn table_and_annotations_say_them() {
    let files = files();
    let table = check(files.path(), &["twice.obj"]).out;
    for words in [
        "   frame     pairs  adjacent  first pair",
        "       0         0         1  triangle 0 of body 0, triangle 1 of body 0",
        "1 of 1 frames intersect\n",
        "1 pair of triangles shares a vertex and meets beyond it: 0 cross, 1 overlap in a plane, 0 \
         touch; 1 triangle stands twice; `--ignore-adjacent` leaves them out",
    ] {
        assert!(table.contains(words), "{table}");
    }
    let ignored = check(files.path(), &["twice.obj", "--ignore-adjacent"]).out;
    assert!(
        ignored.contains("left out: triangles that share a vertex"),
        "{ignored}"
    );
    assert!(!ignored.contains("  adjacent"), "{ignored}");
    let annotated = check(files.path(), &["bow.obj", "--format", "github"]).out;
    assert!(annotated.contains("::error file=bow.obj"), "{annotated}");
    assert!(
        annotated.contains("1 pair of triangles shares a vertex"),
        "{annotated}"
    );
}

/// Not between files, nor within a distance.
#[test]
fn they_are_asked_for_where_pairs_are_left_out_for_a_shared_vertex() {
    let files = files();
    let (code, between) = frames(&files, &["bow.obj", "apart.obj"]);
    assert!(code == 1 && between[0].get("adjacent").is_none());
    let (_, itself) = frames(&files, &["bow.obj", "fold.obj", "--self"]);
    assert_eq!(
        itself[0]["adjacent_pairs"],
        json!([[0, 0, 0, 1], [1, 0, 1, 1]])
    );
    let arguments = [
        "bow.obj",
        "fold.obj",
        "--self",
        "--ignore",
        "bow.obj,bow.obj",
    ];
    let (_, ignored) = frames(&files, &arguments);
    assert_eq!(ignored[0]["adjacent_pairs"], json!([[1, 0, 1, 1]]));
    let (_, within) = frames(&files, &["bow.obj", "fold.obj", "--within", "0.1"]);
    assert!(within[0].get("adjacent").is_none());
    // Groups of a file meet at their common vertices, and beyond.
    let grouped = BOW
        .replace("f 1 2 3", "g wing\nf 1 2 3")
        .replace("f 1 4", "g tail\nf 1 4");
    fs::write(files.path().join("groups.obj"), grouped).unwrap();
    let (code, groups) = frames(&files, &["groups.obj", "--split", "groups"]);
    assert_eq!(
        (code, &groups[0]["adjacent_pairs"]),
        (1, &json!([[0, 0, 1, 1]]))
    );
    let arguments = [
        "groups.obj",
        "--split",
        "groups",
        "--ignore",
        "groups.obj#wing,groups.obj#tail",
    ];
    let (code, ignored) = frames(&files, &arguments);
    assert_eq!(code, 0);
    assert!(
        ignored[0]
            .get("adjacent")
            .is_none_or(|count| *count == json!(0))
    );
}

#[test]
fn baselines_have_them() {
    let files = files();
    let (code, of_file) = frames(&files, &["bow_*.obj", "--baseline", "0"]);
    let of_frame = |frame: usize, name: &str| of_file[frame][name].clone();
    assert_eq!(code, 1);
    assert_eq!(
        (of_frame(0, "adjacent"), of_frame(1, "adjacent")),
        (json!(0), json!(1))
    );
    let (code, of_file) = frames(&files, &["bow_*.obj", "--baseline", "1"]);
    assert_eq!((code, &of_file[1]["adjacent_left_out"]), (0, &json!(1)));

    let known = check(files.path(), &["bow.obj", "--format", "json"]);
    fs::write(files.path().join("known.json"), &known.out).unwrap();
    let arguments = ["bow.obj", "--baseline", "known.json"];
    let said = check(files.path(), &arguments);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let old = check(
        files.path(),
        &["bow.obj", "--ignore-adjacent", "--format", "json"],
    );
    fs::write(files.path().join("known.json"), &old.out).unwrap();
    let said = check(files.path(), &arguments);
    assert_eq!(said.code, 1);
    let words = "note: known.json has no pairs that share a vertex, so all of these count as new";
    assert!(said.err.contains(words), "{}", said.err);
    let said = check(
        files.path(),
        &[&arguments[..], &["--ignore-adjacent"]].concat(),
    );
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let fewer = known.out.replace("\"adjacent\":1", "\"adjacent\":2");
    fs::write(files.path().join("known.json"), fewer).unwrap();
    let said = check(files.path(), &arguments);
    let words = "it counts 2 adjacent pairs and lists 1; write it again with all of them";
    assert!(said.code == 2 && said.err.contains(words), "{}", said.err);
}

#[test]
fn triangles_without_area_may_be_left_out() {
    let files = files();
    // A segment on the other triangle, from the corner that they have in common.
    let segment = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 2 0.25 0\nf 1 2 3\nf 1 4 4\n";
    fs::write(files.path().join("segment.obj"), segment).unwrap();
    let (code, found) = frames(&files, &["segment.obj"]);
    assert_eq!(code, 1);
    assert_eq!(
        (&found[0]["adjacent"], &found[0]["adjacent_degenerate"]),
        (&json!(1), &json!(1))
    );
    let (code, found) = frames(&files, &["segment.obj", "--skip-degenerate"]);
    assert_eq!(code, 0);
    assert_eq!(
        (&found[0]["adjacent"], &found[0]["adjacent_degenerate"]),
        (&json!(0), &json!(1))
    );
}

#[test]
fn hits_pictures_and_pages_show_them() {
    let files = files();
    let arguments = [
        "bow.obj", "--hits", "hits.vtp", "--png", "bow.png", "--report", "bow.html",
    ];
    let said = check(files.path(), &arguments);
    assert_eq!(said.code, 1, "{}", said.err);
    let hits = fs::read_to_string(files.path().join("hits.vtp")).unwrap();
    assert!(
        hits.contains(r#"NumberOfPoints="7" NumberOfLines="1" NumberOfPolys="2""#),
        "{hits}"
    );
    let page = fs::read_to_string(files.path().join("bow.html")).unwrap();
    let words = "1 pair of triangles shares a vertex and meets beyond it";
    assert!(page.contains(words));
    assert!(files.path().join("bow.png").exists());
}

/// Different edges, and pairs of an edge and a triangle, for every two bodies with any.
#[test]
fn crossing_edges_are_counted() {
    let files = files();
    let counts = |arguments: &[&str]| frames(&files, arguments).1[0]["crossing_edges"].clone();
    assert_eq!(counts(&["bow.obj"]), json!([[0, 0, 1, 1]]));
    // Whatever pairs are left out.
    assert_eq!(
        counts(&["bow.obj", "--ignore-adjacent", "--count"]),
        json!([[0, 0, 1, 1]])
    );
    assert_eq!(counts(&["touch.obj"]), json!([]));
    assert_eq!(counts(&["bow.obj", "--first"]), Value::Null);
    // An upright triangle through two levels: each of its edges crosses both.
    let levels = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 1\nv 9 0 1\nv 0 9 1\nf 1 2 3\nf 4 5 6\n";
    fs::write(files.path().join("levels.obj"), levels).unwrap();
    fs::write(
        files.path().join("up.obj"),
        "v 1 1 -1\nv 1 1 2\nv 2 1 2\nf 1 2 3\n",
    )
    .unwrap();
    assert_eq!(counts(&["levels.obj", "up.obj"]), json!([[1, 0, 2, 4]]));
    assert_eq!(
        counts(&["levels.obj", "up.obj", "--ignore", "levels.obj,up.obj"]),
        json!([])
    );
    // An edge between two groups is of both.
    let corners = "v 0 0 0\nv 3 1 -1\nv 3 1 1\nv 4 0 0\nv 4 2 0\nv 9 1 0\n";
    let groups = "g wing\nf 1 2 3\ng tail\nf 3 2 6\ng plate\nf 1 4 5\n";
    let bow = corners.to_owned() + groups;
    fs::write(files.path().join("groups.obj"), bow).unwrap();
    let groups = counts(&["groups.obj", "--split", "groups"]);
    assert_eq!(groups, json!([[0, 2, 1, 1], [1, 2, 1, 1], [2, 1, 1, 1]]));
}
