//! `pliant check`: bodies inside bodies, which no pair tells, and `--solid`.

use crate::common::{check, folder};
use serde_json::json;
use std::fmt::Write as _;

/// A box from one corner to the other, turned outward, with vertices numbered from `first`.
fn cube(lo: [f64; 3], hi: [f64; 3], first: usize) -> String {
    let mut text = String::new();
    for k in 0..8 {
        let at = [0, 1, 2].map(|axis| {
            if k >> axis & 1 == 0 {
                lo[axis]
            } else {
                hi[axis]
            }
        });
        writeln!(text, "v {} {} {}", at[0], at[1], at[2]).unwrap();
    }
    for quad in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        let [a, b, c, d] = quad.map(|k| k + first);
        writeln!(text, "f {a} {b} {c} {d}").unwrap();
    }
    text
}

fn at(lo: f64, hi: f64) -> String {
    cube([lo; 3], [hi; 3], 1)
}

#[test]
fn a_box_in_a_box_is_said() {
    let two = cube([20.0; 3], [21.0; 3], 1) + &cube([4.0; 3], [5.0; 3], 9);
    let folder = folder(&[
        ("large.obj", at(0.0, 10.0)),
        ("small.obj", at(1.0, 2.0)),
        ("two.obj", two),
        ("walk_0.obj", at(20.0, 21.0)),
        ("walk_1.obj", at(6.0, 7.0)),
        (
            "open.obj",
            "v 1 1 1\nv 2 1 1\nv 1 2 1\nf 1 2 3\n".to_owned(),
        ),
    ]);
    let folder = folder.path();
    let said = check(folder, &["small.obj", "large.obj"]);
    assert_eq!(said.code, 0);
    assert!(
        said.out
            .contains("0 of 1 frames intersect\nsmall.obj lies inside large.obj\n")
    );
    let solid = check(folder, &["small.obj", "large.obj", "--solid"]);
    assert_eq!((solid.code, solid.out), (1, said.out));
    assert_eq!(
        check(folder, &["small.obj", "large.obj", "--solid", "--quiet"]).code,
        1
    );
    assert_eq!(
        check(folder, &["small.obj", "large.obj", "--quiet"]).code,
        0
    );
    // With a distance asked for, too.
    let said = check(folder, &["small.obj", "large.obj", "--within", "0.5"]);
    assert!(said.out.contains("small.obj lies inside large.obj"));
    let said = check(folder, &["two.obj", "large.obj"]);
    assert!(
        said.out
            .contains("component 1 of two.obj lies inside large.obj\n")
    );
    let said = check(folder, &["walk_*.obj", "large.obj"]);
    assert!(
        said.out
            .contains("walk_*.obj lies inside large.obj, in 1 frame, the first 1\n")
    );
    // What is open holds nothing, and may be inside.
    let said = check(folder, &["open.obj", "large.obj"]);
    assert!(said.out.contains("open.obj lies inside large.obj\n"));
    assert!(
        said.out
            .contains("not closed, so nothing is said to lie inside: open.obj\n")
    );
    let said = check(
        folder,
        &["small.obj", "large.obj", "--ignore", "small.obj,large.obj"],
    );
    assert!(!said.out.contains("lies inside"));
    // Lines and annotations have no room for it.
    let said = check(folder, &["small.obj", "large.obj", "--format", "lines"]);
    assert!(said.out.is_empty() && said.err.contains("note: small.obj lies inside large.obj"));
}

#[test]
fn frames_of_the_json_have_what_lies_inside() {
    let folder = folder(&[
        ("large.obj", at(0.0, 10.0)),
        ("small.obj", at(1.0, 2.0)),
        ("both.obj", at(0.0, 10.0) + &cube([1.0; 3], [2.0; 3], 9)),
        (
            "sheet.obj",
            "v 1 1 1\nv 2 1 1\nv 1 2 1\nf 1 2 3\n".to_owned(),
        ),
    ]);
    let folder = folder.path();
    let said = check(
        folder,
        &["small.obj", "large.obj", "sheet.obj", "--format", "json"],
    );
    let frame = &said.json()["frames"][0];
    assert_eq!(frame["inside"], json!([[0, 0, 1], [2, 0, 1]]));
    assert_eq!(frame["not_closed"], json!([2]));
    // Pieces of one file, and one body, of which none can be inside another.
    let said = check(
        folder,
        &["both.obj", "--split", "components", "--format", "json"],
    );
    assert_eq!(said.json()["frames"][0]["inside"], json!([[1, 0, 0]]));
    let said = check(folder, &["large.obj", "--format", "json"]);
    assert!(said.json()["frames"][0]["inside"].is_null());
}

#[test]
fn places_of_solids_have_a_depth() {
    let folder = folder(&[
        ("a.obj", at(0.0, 4.0)),
        ("b.obj", cube([2.5, -4.0, -4.0], [12.5, 8.0, 8.0], 1)),
    ]);
    let folder = folder.path();
    let said = check(folder, &["a.obj", "b.obj", "--solid", "--format", "json"]);
    let said = said.json();
    assert_eq!(said["solid"], json!(true));
    assert_eq!(said["frames"][0]["places"][0]["depth"], json!(1.5));
    assert_eq!(said["places"][0]["depth"], json!(1.5));
    let said = check(folder, &["a.obj", "b.obj", "--solid"]);
    assert!(
        said.out.contains(" across, 1.5 deep, round "),
        "{}",
        said.out
    );
    let said = check(folder, &["a.obj", "b.obj", "--format", "json"]);
    assert!(said.json()["frames"][0]["places"][0]["depth"].is_null());
}
