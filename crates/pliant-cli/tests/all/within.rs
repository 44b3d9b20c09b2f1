//! End-to-end tests of `pliant check --within`.

use crate::common::{check, folder};
use serde_json::{Value, json};
use std::path::Path;

/// A triangle in the plane z.
fn flat(z: f64) -> String {
    format!("v -1 -1 {z}\nv 9 -1 {z}\nv -1 9 {z}\nf 1 2 3\n")
}

/// Two triangles far apart. A corner of each is above the plane z by the given height, or below.
fn two_corners(heights: [f64; 2]) -> String {
    let [a, b] = heights;
    format!("v 0 0 {a}\nv 0 1 5\nv 1 0 5\nv 2 0 {b}\nv 2 1 5\nv 3 0 5\nf 1 2 3\nf 4 5 6\n")
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let said = check(folder, &[arguments, &["--format", "json"]].concat());
    said.json_without_places()
}

#[test]
fn pairs_are_those_as_close_as_that_and_the_least_distance_is_said() {
    let folder = folder(&[
        ("skin.obj", flat(0.0)),
        ("shirt_0.obj", two_corners([0.5, 0.25])),
        ("shirt_1.obj", two_corners([-0.5, 0.125])),
        ("shirt_2.obj", two_corners([1.0, 2.0])),
    ]);
    let of = |within: &str, more: &[&str]| {
        let all = ["shirt_*.obj", "skin.obj", "--within", within];
        json(folder.path(), &[&all, more].concat())
    };
    let said = of("0.25", &[]);
    assert_eq!(said["within"], 0.25);
    assert_eq!(
        said["frames"],
        json!([
            {"frame": 0, "count": 1, "distance": 0.25, "pairs": [[0, 1, 1, 0]]},
            {"frame": 1, "count": 2, "distance": 0.0, "pairs": [[0, 0, 1, 0], [0, 1, 1, 0]]},
            {"frame": 2, "count": 0, "distance": null, "pairs": []}
        ])
    );
    // The float before a quarter is too small; 0 leaves pairs that intersect.
    let frames = |said: &Value| -> Vec<[Value; 2]> {
        let frames = said["frames"].as_array().unwrap().iter();
        let frames = frames.map(|frame| [frame["count"].clone(), frame["distance"].clone()]);
        frames.collect()
    };
    for within in ["0", "0.24999999999999997"] {
        let count = if within == "0" { 1 } else { 2 };
        let said = frames(&of(within, &[]));
        let nothing = || [json!(0), Value::Null];
        assert_eq!(said, [nothing(), [json!(count), json!(0.0)], nothing()]);
    }
    // With `--first`, the nearest pair of each frame, whatever its order.
    let said = of("3", &["--first"]);
    assert_eq!(
        said["frames"],
        json!([
            {"frame": 0, "count": 1, "complete": false, "distance": 0.25, "pairs": [[0, 1, 1, 0]]},
            {"frame": 1, "count": 1, "complete": false, "distance": 0.0, "pairs": [[0, 0, 1, 0]]},
            {"frame": 2, "count": 1, "complete": false, "distance": 1.0, "pairs": [[0, 0, 1, 0]]}
        ])
    );
    // Pairs of frame 0 are known.
    let said = of("3", &["--baseline", "0", "--count"]);
    let counted = json!([
        {"frame": 0, "count": 0, "distance": null, "left_out": 2},
        {"frame": 1, "count": 0, "distance": null, "left_out": 2},
        {"frame": 2, "count": 0, "distance": null, "left_out": 2}
    ]);
    assert_eq!(said["frames"], counted);
    // Nothing about it where it is not asked for.
    let said = json(folder.path(), &["shirt_*.obj", "skin.obj"]);
    assert_eq!(said.get("within"), None);
    assert_eq!(said["frames"][0].get("distance"), None);
}

#[test]
fn exit_codes_are_as_always() {
    let folder = folder(&[
        ("skin.obj", flat(0.0)),
        ("shirt.obj", two_corners([0.5, 0.25])),
    ]);
    for (within, code) in [("0.25", 1), ("0.2", 0), ("0", 0)] {
        for more in [&[][..], &["--quiet"], &["--count"], &["--first"]] {
            let arguments = ["shirt.obj", "skin.obj", "--within", within];
            let said = check(folder.path(), &[&arguments, more].concat());
            assert_eq!(
                said.code, code,
                "{within} {more:?}: {}{}",
                said.out, said.err
            );
        }
    }
}

#[test]
fn people_read_it() {
    let folder = folder(&[
        ("skin.obj", flat(0.0)),
        ("shirt_0.obj", two_corners([0.5, 0.25])),
        ("shirt_1.obj", two_corners([1.0, 2.0])),
    ]);
    let arguments = ["shirt_*.obj", "skin.obj", "--within", "0.5"];
    let said = check(folder.path(), &arguments).out;
    for line in [
        "checked: the bodies with each other, not with themselves, triangles at most 0.5 apart",
        "   frame  file            pairs    distance  first pair",
        "       0  shirt_0.obj         2        0.25  triangle 0 of body 0, triangle 0 of body 1",
        "       1  shirt_1.obj         0           -",
        "1 of 2 frames have triangles at most 0.5 apart; least distance: 0.25 in \
         frame 0; most pairs: 2 in frame 0",
    ] {
        assert!(said.lines().any(|it| it == line), "{line:?}: {said}");
    }
    let lines = check(
        folder.path(),
        &[&arguments[..], &["--format", "lines"]].concat(),
    );
    assert_eq!(lines.out, "0 0 0 1 0\n0 0 1 1 0\n");
    let said = check(
        folder.path(),
        &[&arguments[..], &["--format", "github", "--count"]].concat(),
    );
    let message = "::error file=shirt_0.obj,title=pliant::frame 0: 2 pairs of triangles at most \
                   0.5 apart, the nearest 0.25; the first: triangle 0 of shirt_*.obj and triangle \
                   0 of skin.obj";
    assert_eq!(said.out.lines().next(), Some(message));
}

#[test]
fn neighbours_are_not_asked() {
    let folder = folder(&[
        ("skin.obj", flat(0.0)),
        ("shirt.obj", two_corners([0.5; 2])),
    ]);
    let alone = check(folder.path(), &["skin.obj", "--within", "0.1"]);
    alone.assert_refused(&["neighbouring triangles", "two bodies"]);
    let both = ["skin.obj", "shirt.obj", "--within", "0.1", "--self"];
    check(folder.path(), &both).assert_refused(&["neighbouring triangles", "leave out `--self`"]);
    // The pieces of a file are bodies, if that is asked.
    let pieces = ["shirt.obj", "--within", "1.5", "--split", "components"];
    let said = json(folder.path(), &pieces);
    assert_eq!(said["frames"][0]["pairs"], json!([[0, 0, 1, 1]]));
    // From a corner of the one, at height 5, to the edge of the other that rises by 4.5 beside it.
    let expected = f64::sqrt(1.0 + 20.25 / 21.25);
    let distance = said["frames"][0]["distance"].as_f64().unwrap();
    assert!((distance - expected).abs() < 1e-8, "{distance}");
    for bad in ["-1", "nan", "inf", "near"] {
        let said = check(folder.path(), &["skin.obj", "shirt.obj", "--within", bad]);
        said.assert_refused(&[bad, "at least 0"]);
    }
}

/// A strip of four triangles that lies flat, and one that is folded, with its ends close.
fn strip(fold: bool) -> String {
    let ends = if fold {
        "v 0 0 0.1\nv 0 1 0.1\n"
    } else {
        "v 2 0 0\nv 2 1 0\n"
    };
    let start = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\n";
    format!("{start}{ends}f 1 2 3\nf 2 4 3\nf 3 4 5\nf 4 6 5\n")
}

#[test]
fn what_is_close_at_rest_is_left_out() {
    fn asked<'a>(more: &[&'a str]) -> Vec<&'a str> {
        let strip = ["strip_*.obj", "--within", "0.2"];
        [&strip[..], more].concat()
    }
    let folder = folder(&[
        ("strip_0.obj", strip(false)),
        ("strip_1.obj", strip(true)),
        ("flat.obj", strip(false)),
        ("skin.obj", flat(0.0)),
        ("turn_0.obj", strip(false)),
        ("turn_1.obj", flat(0.0)),
    ]);
    for rest in ["0", "flat.obj"] {
        let said = json(folder.path(), &asked(&["--rest", rest]));
        let frames = said["frames"].as_array().unwrap();
        let counts: Vec<_> = frames.iter().map(|frame| frame["count"].as_u64()).collect();
        assert_eq!(counts, [Some(0), Some(1)], "{rest}");
        assert_eq!(frames[1]["pairs"], json!([[0, 0, 0, 3]]));
        // Not quite half of the height at the fold's end, for triangles slope.
        assert_eq!(frames[1]["distance"], 0.049_875_466_805_381_65);
        let rest = if rest == "0" { json!(0) } else { json!(rest) };
        assert_eq!(said["rest"], rest);
    }
    // In the folded shape the ends are close, so that is how they rest.
    let said = check(folder.path(), &asked(&["--rest", "1"]));
    assert_eq!(said.code, 0, "{}{}", said.out, said.err);
    let message = "triangles at most 0.2 apart; left out: triangles of one file that are as close \
                   in frame 1";
    assert!(said.out.contains(message), "{}", said.out);
    // Bodies with themselves and each other.
    let both = [
        "skin.obj",
        "strip_*.obj",
        "--self",
        "--within",
        "0.05",
        "--rest",
        "0",
    ];
    let said = json(folder.path(), &both);
    assert_eq!(said["frames"][0]["count"], 4);

    for (arguments, words) in [
        (&["strip_*.obj", "--rest", "0"][..], "--within"),
        (&asked(&["--rest", "2"]), "the rest shape is frame 2, but"),
        (
            &asked(&["--rest", "skin.obj"]),
            "the rest shape skin.obj: it has 3 vertices",
        ),
        (
            &asked(&["skin.obj", "--rest", "flat.obj"]),
            "it is of one body, and 2 are checked",
        ),
        (
            &["turn_*.obj", "--within", "1", "--rest", "0"],
            "another than in the rest shape",
        ),
    ] {
        check(folder.path(), arguments).assert_refused(&[words]);
    }
}

#[test]
fn a_report_says_what_is_close() {
    let folder = folder(&[
        ("skin.obj", flat(0.0)),
        ("shirt_0.obj", two_corners([0.5, 0.25])),
        ("shirt_1.obj", two_corners([-0.5, 0.125])),
    ]);
    let arguments = [
        "shirt_*.obj",
        "skin.obj",
        "--within",
        "0.5",
        "--report",
        "page.html",
    ];
    assert_eq!(check(folder.path(), &arguments).code, 1);
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    for said in [
        "There are triangles that are at most 0.5 apart in 2 of 2 frames, first in \
         frame 0. Most: 2 pairs, in frame 0.",
        "pairs at most 0.5 apart per frame",
        r#""within":0.5"#,
    ] {
        assert!(page.contains(said), "{said}");
    }
    let image = [
        "shirt_*.obj",
        "skin.obj",
        "--within",
        "0.5",
        "--png",
        "image.png",
    ];
    check(folder.path(), &image).assert_refused(&["--within", "--png"]);
}
