//! Sizes of bodies: reported for each, and noted where they may be why nothing was found.

use crate::common::{check, folder};
use serde_json::json;

/// A tetrahedron of this size, at this place.
fn tetrahedron(size: f64, at: f64) -> String {
    let far = at + size;
    format!(
        "v {at} 0 0\nv {far} 0 0\nv {at} {size} 0\nv {at} 0 {size}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 \
         1 4\n"
    )
}

#[test]
fn every_body_has_its_box() {
    let two =
        tetrahedron(2.0, 0.0) + "o other\nv 5 5 5\nv 6 5 5\nv 5 5.25 5\nf 5 6 7\nv 99 99 99\n";
    let folder = folder(&[("a.obj", tetrahedron(1.5, -3.0)), ("two.obj", two)]);
    let json = ["--format", "json"];
    let said = check(folder.path(), &[&["a.obj", "two.obj"], &json[..]].concat());
    let of_a = json!([[-3.0, 0.0, 0.0], [-1.5, 1.5, 1.5]]);
    let of_two = json!([[0.0, 0.0, 0.0], [6.0, 5.25, 5.0]]);
    assert_eq!(
        [
            &said.json()["bodies"][0]["box"],
            &said.json()["bodies"][1]["box"]
        ],
        [&of_a, &of_two]
    );
    for split in ["components", "groups"] {
        let arguments = ["a.obj", "two.obj", "--split", split];
        let said = check(folder.path(), &[&arguments, &json[..]].concat()).json();
        let bodies = said["bodies"].as_array().unwrap().iter();
        let boxes: Vec<_> = bodies.map(|body| body["box"].clone()).collect();
        let other = json!([[5.0, 5.0, 5.0], [6.0, 5.25, 5.0]]);
        assert_eq!(
            boxes,
            [
                of_a.clone(),
                json!([[0.0, 0.0, 0.0], [2.0, 2.0, 2.0]]),
                other
            ]
        );
        assert_eq!(
            [&said["sources"][0]["box"], &said["sources"][1]["box"]],
            [&of_a, &of_two]
        );
    }
    let said = check(folder.path(), &["a.obj", "two.obj"]);
    for line in [
        "body 0: a.obj, 4 vertices, 4 triangles, 1.5 x 1.5 x 1.5 large\n",
        "body 1: two.obj, 8 vertices, 5 triangles, 6 x 5.25 x 5 large\n",
    ] {
        assert!(said.out.contains(line), "{}", said.out);
    }
}

#[test]
fn bodies_of_other_units_are_noted_if_nothing_is_found() {
    let with = |size: f64, at: f64| {
        let files = [
            ("body.obj", tetrahedron(1.75, 0.0)),
            ("shirt.obj", tetrahedron(size, at)),
        ];
        let folder = folder(&files);
        check(folder.path(), &["body.obj", "shirt.obj"])
    };
    let said = with(1750.0, 10.0);
    assert_eq!(said.code, 0, "{}", said.err);
    assert_eq!(
        said.err,
        "pliant: note: nothing was found, and the longest side of shirt.obj is 1750, that of \
         body.obj 1.75: are they of one unit?\n"
    );
    // No note where bodies meet, nor for plausible sizes.
    for (size, at, code) in [(1750.0, 0.25, 1), (174.9, 10.0, 0), (0.0176, 10.0, 0)] {
        let said = with(size, at);
        assert_eq!((said.code, said.err.as_str()), (code, ""), "{size}");
    }
    let said = with(0.0174, 10.0);
    assert!(said.err.contains("are they of one unit?"), "{}", said.err);
    // Pieces of one file have one unit.
    let both = tetrahedron(1.0, 0.0) + "v 90 0 0\nv 90.001 0 0\nv 90 0.001 0\nf 5 6 7\n";
    let folder = folder(&[("a.obj", both)]);
    let said = check(folder.path(), &["a.obj", "--split", "components"]);
    assert_eq!((said.code, said.err.as_str()), (0, ""));
}
