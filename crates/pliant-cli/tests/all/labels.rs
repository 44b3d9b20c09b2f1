//! `pliant check --labels`: parts of a body that may meet.

use crate::common::npz::integers;
use crate::common::{check, folder};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A strip of six triangles, folded to and fro, so that all lie in one square; the last two as one
/// polygon.
fn folded(lift: f64) -> String {
    let rows = [0.0, 1.0, 0.2, 0.8].map(|x| format!("v {x} 0 {lift}\nv {x} 1 {lift}\n"));
    let sides = "f 1 2 3\nf 2 4 3\nf 3 4 5\nf 4 6 5\n";
    format!("{}{sides}f 5 6 8 7\n", rows.concat())
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let said = check(folder, &[arguments, &["--format", "json"]].concat());
    said.json_without_places()
}

/// Writes labels as numpy does.
fn labels(folder: &Path, name: &str, labels: &[i64]) {
    fs::write(folder.join(name), integers(labels)).unwrap();
}

/// A folder with a strip that moves, one that gets another mesh, and labels for them.
fn strips() -> TempDir {
    let folder = folder(&[
        ("arm_0.obj", folded(0.0)),
        ("arm_1.obj", folded(0.5)),
        ("skin.obj", folded(0.0)),
        ("turn_0.obj", folded(0.0)),
        (
            "two.obj",
            folded(0.0) + "v 8 0 0\nv 9 0 0\nv 8 1 0\nf 9 10 11\n",
        ),
        (
            "turn_1.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned(),
        ),
    ]);
    let at = folder.path();
    labels(at, "parts.npy", &[0, 0, 7, 7, 2, 2]);
    labels(at, "polygons.npy", &[0, 0, 7, 7, 2]);
    labels(at, "none.npy", &[-1; 6]);
    labels(at, "many.npy", &[1; 7]);
    labels(at, "large.npy", &[0, 0, 7, 7, 2, 1 << 32]);
    folder
}

#[test]
fn equal_and_neighbouring_labels_are_left_out() {
    let folder = strips();
    let at = folder.path();
    let all = json(at, &["arm_*.obj"]);
    let of = |said: &Value, frame: usize| {
        let frame = &said["frames"][frame];
        let pairs = frame["pairs"].as_array().unwrap().len();
        (
            frame["count"].as_u64().unwrap() as usize,
            pairs,
            frame["adjacent"]["count"].clone(),
        )
    };
    let (count, _, _) = of(&all, 0);
    // Triangles 0 and 1 with 4 and 5 alone: four pairs that share no vertex.
    for file in ["parts.npy", "polygons.npy"] {
        let arguments = ["arm_*.obj", "--labels", &format!("arm_*.obj={file}")];
        let said = json(at, &arguments);
        assert_eq!(said["labels"], json!({"arm_*.obj": file}));
        for frame in [0, 1] {
            let (left, listed, _) = of(&said, frame);
            assert_eq!((left, listed), (4, 4), "{file}");
        }
        let table = check(at, &arguments);
        assert_eq!(table.code, 1);
        let words = "left out: triangles of arm_*.obj whose labels are equal or neighbours";
        assert!(table.out.contains(words), "{}", table.out);
    }
    assert!(count > 4, "{count}");
    // No label leaves nothing out, and the body's number is a name.
    let said = json(at, &["arm_*.obj", "--labels", "0=none.npy"]);
    assert_eq!(of(&said, 0), of(&all, 0));
    // Close triangles of one body.
    let within = ["arm_*.obj", "--within", "0.01", "--labels", "0=parts.npy"];
    assert_eq!(json(at, &within)["frames"][0]["count"], 4);
    // Two bodies are not left out.
    let two = [
        "arm_*.obj",
        "skin.obj",
        "--labels",
        "0=parts.npy",
        "--labels",
        "1=parts.npy",
    ];
    let unlabelled = json(at, &two[..2]);
    assert_eq!(
        json(at, &two)["frames"][0]["count"],
        unlabelled["frames"][0]["count"]
    );
}

#[test]
fn labels_that_fit_nothing_are_refused() {
    let folder = strips();
    let at = folder.path();
    for (arguments, words) in [
        (
            &["arm_*.obj", "--labels", "0=many.npy"][..],
            "it has 7 labels, and arm_*.obj 6 triangles of 5 polygons",
        ),
        (
            &["arm_*.obj", "--labels", "0=large.npy"],
            "label 4294967296 of number 5",
        ),
        (&["arm_*.obj", "--labels", "0=gone.npy"], "no such file"),
        (&["arm_*.obj", "--labels", "0=skin.obj"], "not an array"),
        (
            &["arm_*.obj", "--labels", "leg=parts.npy"],
            "no body is called",
        ),
        (
            &[
                "arm_*.obj",
                "--labels",
                "0=parts.npy",
                "--labels",
                "arm_*.obj=parts.npy",
            ],
            "has labels already",
        ),
        (
            &[
                "two.obj",
                "--split",
                "components",
                "--labels",
                "two.obj#1=parts.npy",
            ],
            "a part of one: two.obj#1",
        ),
        (&["arm_*.obj", "--labels", "parts.npy"], "BODY=FILE.npy"),
        (
            &["arm_*.obj", "--labels", "0=parts.npy", "--swept"],
            "--swept",
        ),
        (
            &["arm_*.obj", "--labels", "0=parts.npy", "--crossing"],
            "--crossing",
        ),
        (
            &[
                "arm_*.obj",
                "skin.obj",
                "--self",
                "--within",
                "0.1",
                "--labels",
                "0=parts.npy",
            ],
            "labels of all bodies",
        ),
        (
            &["turn_*.obj", "--labels", "0=parts.npy"],
            "the labels say nothing about it",
        ),
    ] {
        check(at, arguments).assert_refused(&[words]);
    }
}
