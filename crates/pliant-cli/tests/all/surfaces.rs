//! Surfaces that files stand for, and notes where another surface may be meant.

use crate::common::{check, folder, kinds, pliant};
use serde_json::json;
use std::fmt::Write;
use std::fs;

type Point = [f64; 3];

/// Triangles of a tetrahedron with sides of about one, each side cut into sixteen.
fn tetrahedron() -> Vec<[Point; 3]> {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut triangles: Vec<[Point; 3]> = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
        .map(|side: [usize; 3]| side.map(|corner| corners[corner]))
        .into();
    for _ in 0..2 {
        let middle =
            |a: Point, b: Point| -> Point { std::array::from_fn(|i| f64::midpoint(a[i], b[i])) };
        let cut = |[a, b, c]: [Point; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(cut).collect();
    }
    triangles
}

/// An OBJ file in which every triangle has corners of its own, each moved by up to `by` in another
/// way.
fn soup(triangles: &[[Point; 3]], by: f64) -> String {
    let mut state = 7_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        ((state >> 33) as f64 / f64::from(1_u32 << 30) - 1.0) * by
    };
    let mut text = String::new();
    for triangle in triangles {
        for [x, y, z] in triangle {
            writeln!(text, "v {} {} {}", x + noise(), y + noise(), z + noise()).unwrap();
        }
        text += "f -3 -2 -1\n";
    }
    text
}

#[test]
fn seams_that_nearly_coincide_are_joined_if_asked_for_and_named_otherwise() {
    let folder = folder(&[("part.obj", soup(&tetrahedron(), 1e-8))]);
    let path = folder.path();
    let plain = check(path, &["part.obj"]);
    assert_eq!(plain.code, 1);
    let note = plain.err.trim_end();
    assert_eq!(note.lines().count(), 1, "{note}");
    assert!(note.starts_with("pliant: note: part.obj: "), "{note}");
    assert!(note.contains("with itself in frame 0 lie where boundary edges nearly coincide"));
    // The note suffices.
    let tolerance = note.split_once("`--weld ").unwrap().1;
    let tolerance = tolerance.split_once('`').unwrap().0;
    let joined = check(path, &["part.obj", "--weld", tolerance, "--format", "json"]);
    assert_eq!(joined.code, 0, "{}", joined.out);
    // The 192 corners are at 34 places.
    assert_eq!(joined.json()["bodies"][0]["welded"], 192 - 34);
    let note = joined.err.trim_end();
    assert!(
        note.contains("158 vertices were merged with a vertex near them"),
        "{note}"
    );
    assert_eq!(check(path, &["part.obj", "--quiet"]).err, "");

    // Once written, a file is closed for good.
    let said = pliant(
        path,
        &["convert", "part.obj", "closed.obj", "--weld", "1e-6"],
    );
    assert_eq!(said.out, "closed.obj: 1 frame, 34 vertices, 64 triangles\n");
    let closed = check(path, &["closed.obj"]);
    assert_eq!((closed.code, &closed.err[..]), (0, ""));

    for (value, word) in [
        ("0.5", "from 1e-15 to 0.1"),
        ("-1", "0.1"),
        ("nan", "0.1"),
        ("1e-16", "1e-15"),
    ] {
        check(path, &["part.obj", "--weld", value]).assert_refused(&[word, "`--weld`"]);
    }
    check(path, &["part.obj", "--weld", "1e-6", "--no-weld"]).assert_refused(&["--no-weld"]);
}

#[test]
fn joined_sides_that_part_in_a_later_frame_are_apart_there() {
    let triangles = tetrahedron();
    let parted: Vec<_> = triangles
        .iter()
        .enumerate()
        .map(|(number, triangle)| {
            let by = if number < 16 { 1e-3 } else { 0.0 };
            triangle.map(|[x, y, z]| [x, y, z - by])
        })
        .collect();
    let folder = folder(&[
        ("p_0.obj", soup(&triangles, 1e-8)),
        ("p_1.obj", soup(&triangles, 1e-7)),
        ("p_2.obj", soup(&parted, 1e-8)),
    ]);
    let path = folder.path();
    let near = check(path, &["p_[01].obj", "--weld", "1e-6"]);
    assert_eq!(near.code, 0, "{}", near.err);
    let said = check(path, &["p_*.obj", "--weld", "1e-6"]);
    let alone = check(path, &["p_2.obj", "--weld", "1e-6"]);
    assert_eq!(said.code, alone.code, "{}", said.err);
    let words = "seams that are closed in the first frame are open in frame 2: ";
    assert!(said.err.contains(words), "{}", said.err);
}

#[test]
fn triangles_without_area_are_counted_named_and_left_out() {
    // A pole of a hundred needles and a triangle that it passes through; two proper triangles that
    // cross.
    let mut text = "v 0 0 -1\nv 0 0 1\n".to_owned();
    for number in 1..=100 {
        writeln!(
            text,
            "v 0 0 {}\nf 1 2 {}",
            f64::from(number) / 128.0,
            number + 2
        )
        .unwrap();
    }
    text += "v -1 -1 0.3\nv 2 -1 0.3\nv -1 2 0.3\nf -3 -2 -1\n";
    text += "v 0.1 -0.5 -1\nv 0.1 -0.5 1\nv 0.2 -0.6 1\nf -3 -2 -1\n";
    let folder = folder(&[("pole.obj", text)]);
    let path = folder.path();
    let table = check(path, &["pole.obj"]);
    assert!(table.out.contains("     101"), "{}", table.out);
    assert!(table.out.ends_with(
        "100 pairs have a triangle without area; `--skip-degenerate` leaves such pairs out\n"
    ));
    let json = check(path, &["pole.obj", "--format", "json"]).json();
    assert_eq!(json["frames"][0]["degenerate"], 100);

    let table = check(path, &["pole.obj", "--skip-degenerate"]);
    assert!(
        table
            .out
            .contains("left out: pairs with a triangle without area"),
        "{}",
        table.out
    );
    assert!(
        table
            .out
            .ends_with("left out: 100 pairs have a triangle without area\n"),
        "{}",
        table.out
    );
    let json = check(path, &["pole.obj", "--skip-degenerate", "--format", "json"]).json();
    let frame = &json["frames"][0];
    assert_eq!(json["skip_degenerate"], true);
    assert_eq!([&frame["count"], &frame["degenerate"]], [1, 100]);
    assert_eq!(frame["pairs"], serde_json::json!([[0, 100, 0, 101]]));
    // Also with `--first`, and where nothing else is left.
    let said = check(
        path,
        &[
            "pole.obj",
            "--skip-degenerate",
            "--first",
            "--format",
            "json",
        ],
    );
    assert_eq!(said.counts(), [1]);
}

const WALL: &str = "v 0 0 0\nv 0 4 0\nv 0 0 4\nf 1 2 3\n";

/// A triangle through the wall, at this height.
fn needle(at: f64) -> String {
    format!("v -1 1 {at}\nv 1 1 {at}\nv 1 1.2 {at}\n")
}

#[test]
fn files_may_be_named_without_their_folders() {
    let path = tempfile::tempdir().unwrap();
    let path = path.path();
    for name in ["a", "b"] {
        fs::create_dir(path.join(name)).unwrap();
        fs::write(path.join(name).join("same.obj"), WALL).unwrap();
        fs::write(
            path.join(name).join(format!("{name}.obj")),
            needle(0.5) + "f 1 2 3\n",
        )
        .unwrap();
    }
    let bodies = ["a/a.obj", "b/b.obj", "a/same.obj"];
    let with = |more: &[&str]| {
        check(
            path,
            &[&bodies[..], more, &["--count", "--format", "lines"]].concat(),
        )
    };
    assert_eq!(with(&[]).out, "0 3\n");
    assert_eq!(with(&["--ignore", "a.obj,b.obj"]).out, "0 2\n");
    assert_eq!(
        with(&["--ignore", "a.obj,same.obj", "--group", "x=b.obj"]).out,
        "0 2\n"
    );
    assert_eq!(
        with(&["--split", "components", "--ignore", "a.obj#1,b.obj#1"]).out,
        "0 2\n"
    );
    // Two have this name.
    check(
        path,
        &[
            "a/same.obj",
            "b/same.obj",
            "a/a.obj",
            "--ignore",
            "same.obj,a.obj",
        ],
    )
    .assert_refused(&["no body or group is called \"same.obj\""]);
}

#[test]
fn an_earlier_check_is_a_baseline() {
    let two = format!("{}{}f 1 2 3\nf 4 5 6\n", needle(0.5), needle(1.0));
    let three = format!("{}{}f 1 2 3\nf 4 5 6\n", needle(0.5), needle(5.0));
    let folder = folder(&[
        ("wall.obj", WALL.to_owned()),
        ("n_0.obj", two),
        ("n_1.obj", three.clone()),
        ("n.obj", three.replace("0.5", "0.25")),
    ]);
    let path = folder.path();
    let save = |name: &str, arguments: &[&str]| {
        let said = check(path, &[arguments, &["--format", "json"]].concat());
        fs::write(path.join(name), &said.out).unwrap();
    };
    save("old.json", &["n.obj", "wall.obj"]);
    let again = check(
        path,
        &[
            "n.obj",
            "wall.obj",
            "--baseline",
            "old.json",
            "--format",
            "json",
        ],
    );
    assert_eq!(again.code, 0);
    assert_eq!(again.json()["frames"][0]["left_out"], 1);
    assert_eq!(again.json()["baseline"], "old.json");
    // In reverse order, and by other paths: bodies are identified by their names.
    let there = path.join("n.obj");
    let there = there.to_str().unwrap();
    let turned = check(
        path,
        &["wall.obj", there, "--baseline", "old.json", "--count"],
    );
    assert_eq!(turned.code, 0, "{}{}", turned.out, turned.err);
    assert!(
        turned.out.contains("left out: pairs that old.json has"),
        "{}",
        turned.out
    );
    // A pair of any frame is left out of all frames; pieces have numbers of their own.
    save(
        "all.json",
        &["n_?.obj", "wall.obj", "--split", "components"],
    );
    let all = [
        "n_?.obj",
        "wall.obj",
        "--split",
        "components",
        "--baseline",
        "all.json",
    ];
    assert_eq!(check(path, &all).code, 0);

    let baseline = |name: &str| check(path, &["n.obj", "wall.obj", "--baseline", name]);
    save("count.json", &["n.obj", "wall.obj", "--count"]);
    baseline("count.json").assert_refused(&[
        "count.json: in its frame 0 it counts 1 pairs and lists 0; write it again with all of them",
        "without `--count` and `--first`",
    ]);
    baseline("nowhere.json").assert_refused(&["nowhere.json"]);
    baseline("wall.obj").assert_refused(&["wall.obj", "JSON"]);
    save("other.json", &["n_0.obj", "wall.obj"]);
    baseline("other.json").assert_refused(&[
        "its body 0, \"n_0.obj\", is not checked here: no body is called \"n_0.obj\"; bodies: ",
    ]);
    let fewer = fs::read_to_string(path.join("old.json")).unwrap();
    fs::write(
        path.join("fewer.json"),
        fewer.replace("\"triangles\":2", "\"triangles\":3"),
    )
    .unwrap();
    baseline("fewer.json")
        .assert_refused(&["its body 0, \"n.obj\", has 3 triangles there and 2 here"]);
    fs::write(
        path.join("lies.json"),
        fewer.replace("[0,0,1,0]", "[0,7,1,0]"),
    )
    .unwrap();
    baseline("lies.json").assert_refused(&[
        "frame 0, pair 0, [0, 7, 1, 0]: body 0, \"n.obj\", has no triangle 7; it has 2, the first \
         is 0",
    ]);
    fs::write(
        path.join("lies.json"),
        fewer.replace("[0,0,1,0]", "[4,0,1,0]"),
    )
    .unwrap();
    baseline("lies.json").assert_refused(&[
        "frame 0, pair 0, [4, 0, 1, 0]: there is no body 4; its bodies are 0 to 1",
    ]);
}

#[test]
fn polygons_that_bend_inward_are_cut_inside() {
    // An L-shaped polygon, from each of its corners on, and a spike through its notch, which a fan
    // would cover.
    //
    // Another spike goes through the L.
    let corners = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]];
    let mut text = String::new();
    for [x, y] in corners {
        writeln!(text, "v {x} {y} 0").unwrap();
    }
    text += "v 1.4 1.4 -1\nv 1.4 1.4 1\nv 1.5 1.5 1\nf 7 8 9\n";
    let through = text.clone() + "v 0.2 0.2 -1\nv 0.2 0.2 1\nv 0.3 0.3 1\nf 10 11 12\n";
    for first in 0..6 {
        let l = (0..6).fold(String::new(), |l, i| format!("{l} {}", (first + i) % 6 + 1));
        let folder = folder(&[
            ("past.obj", format!("{text}f{l}\n")),
            ("through.obj", format!("{through}f{l}\n")),
            ("two_0.obj", format!("{text}f{l}\n")),
            ("two_1.obj", format!("{text}f{l}\n")),
        ]);
        let path = folder.path();
        let past = check(path, &["past.obj"]);
        assert_eq!((past.code, &past.err[..]), (0, ""), "{first}: {}", past.out);
        let counts = check(path, &["through.obj", "--format", "json"]).counts();
        assert!([1, 2].contains(&counts[0]), "{first}: {counts:?}");
        // Equal polygons in a later frame are cut equally.
        let convert = |to: &str| pliant(path, &["convert", "two_*.obj", to]).code;
        assert_eq!(check(path, &["two_*.obj"]).code, 0);
        assert_eq!(convert("same.npz"), 0);
        let turned = format!("{text}f 1 2 3 4 6 5\n");
        fs::write(path.join("two_1.obj"), turned).unwrap();
        assert_eq!(convert("other.npz"), 2);
    }
}

#[test]
fn the_program_says_what_it_reads() {
    let folder = folder(&[]);
    let said = pliant(folder.path(), &["formats"]);
    assert_eq!((said.code, &said.err[..]), (0, ""));
    for ending in [
        "obj", "ply", "stl", "npz", "npy", "glb", "gltf", "vrm", "pc2", "mdd", "fbx", "usd",
    ] {
        assert!(said.out.contains(&format!(".{ending}")), "{ending}");
    }
}

#[test]
fn what_is_not_read_says_what_to_do_as_the_formats_do() {
    let folder = folder(&[]);
    let path = folder.path();
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let formats = plain(&pliant(path, &["formats"]).out);
    for ending in [
        "fbx", "ABC", "blend", "ma", "mb", "max", "dae", "3ds", "c4d", "hip", "step", "iges",
        "usd", "usda", "usdc", "usdz",
    ] {
        let name = format!("a.{ending}");
        fs::write(path.join(&name), "x").unwrap();
        let said = check(path, &[&name]);
        said.assert_refused(&["this kind of file cannot be read; "]);
        let (_, advice) = said.err.trim_end().split_once("cannot be read; ").unwrap();
        for part in advice.split("; ") {
            let part = part.trim_start_matches("or ");
            assert!(formats.contains(part), "{part}: {formats}");
        }
        let is_usd = ending.starts_with("usd");
        assert_eq!(advice.contains("the Python package reads it"), is_usd);
    }
}

/// A triangle as STL text.
const FACET: &str =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

#[test]
fn files_that_people_have_are_read_and_what_was_wrong_is_said() {
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let folder = folder(&[
        ("mac.obj", obj.replace('\n', "\r")),
        ("line.obj", format!("{obj}f 1 2\n")),
        ("flat.obj", obj.replace("v 0 1 0", "v 0 1")),
        ("cut.stl", format!("solid a\n{FACET}")),
        ("end.stl", format!("solid a\n{FACET}end solid a\n")),
        (
            "lfs.obj",
            "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n".into(),
        ),
        ("m.obj", obj.into()),
    ]);
    let path = folder.path();
    let array =
        |dtype: &str, shape: &str, data: &[u8]| crate::common::npz::array(dtype, shape, data);
    let numbers = [0_i16, 0, 0, 1, 0, 0, 0, 1, 0].map(i16::to_le_bytes);
    let positions = array("<i2", "(1, 3, 3)", numbers.as_flattened());
    fs::write(path.join("walk.npy"), &positions).unwrap();
    let entry = crate::common::npz::Entry::stored;
    let faces = entry("f", array("|u1", "(1, 3)", &[0, 1, 2]));
    let archive = crate::common::npz::archive(&[entry("v", positions), faces]);
    fs::write(path.join("a.npz"), archive).unwrap();
    for (name, words) in [
        ("mac.obj", &[][..]),
        (
            "line.obj",
            &["1 faces have two corners (the first is face 1) and are read as segments"],
        ),
        ("cut.stl", &["ends without \"endsolid\""]),
        ("end.stl", &["ends with \"end solid\""]),
        (
            "m.obj+walk.npy",
            &["the array of vertices is of type <i2 and was read as float32"],
        ),
        (
            "a.npz",
            &[
                "of type <i2",
                "the array of vertices is called `v`, not `vertices`",
                "the array of faces is called `f`, not `faces`",
            ],
        ),
    ] {
        let said = check(path, &[name]);
        assert_eq!(said.code, 0, "{name}: {}", said.err);
        assert!(said.out.contains("0 of 1 frames intersect"), "{}", said.out);
        assert_eq!(said.err.is_empty(), words.is_empty(), "{}", said.err);
        for word in words {
            assert!(
                said.err.contains(&format!("note: {name}: ")) && said.err.contains(word),
                "{}",
                said.err
            );
        }
    }
    check(path, &["flat.obj"])
        .assert_refused(&["line 3: a vertex has two coordinates; pliant needs three"]);
    check(path, &["lfs.obj"]).assert_refused(&["Git LFS pointer", "`git lfs pull`"]);
}

#[test]
fn solids_are_groups_and_other_formats_say_why_they_have_none() {
    // The second solid stands across the first.
    let upright = FACET
        .replace("vertex 0 0 0", "vertex 0.25 0.25 -1")
        .replace("vertex 1 0 0", "vertex 0.25 0.25 1");
    let text = format!("solid flat\n{FACET}endsolid\nsolid\n{upright}endsolid\n");
    let folder = folder(&[
        ("two.stl", text),
        ("one.obj", "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n".into()),
    ]);
    let path = folder.path();
    let said = check(path, &["two.stl", "--split", "groups", "--format", "json"]);
    let bodies = said.json()["bodies"].as_array().unwrap().clone();
    let names: Vec<_> = bodies.iter().map(|body| body["name"].clone()).collect();
    assert_eq!(names, ["two.stl#flat", "two.stl#solid 2"]);
    assert_eq!(said.json()["frames"][0]["pairs"], json!([[0, 0, 1, 1]]));
    let said = check(path, &["two.stl#flat", "two.stl#solid 2"]);
    assert_eq!(said.code, 1, "{}", said.err);
    let ignored = [
        "two.stl",
        "--split",
        "groups",
        "--ignore",
        "two.stl#flat,two.stl#solid 2",
    ];
    assert_eq!(check(path, &ignored).code, 0);

    for to in ["a.ply", "a.npz", "a.stl"] {
        assert_eq!(pliant(path, &["convert", "one.obj", to]).code, 0);
        let advice = "split it into its connected pieces with `--split components`";
        let said = check(path, &[to, "--split", "groups"]);
        said.assert_refused(&[to, "cannot be split into groups: ", advice]);
        // Beside files with groups it is one body.
        let said = check(path, &[to, "two.stl", "--split", "groups"]);
        assert_eq!(said.code, 1, "{}", said.err);
    }
    let said = check(path, &["a.ply", "--split", "groups"]);
    said.assert_refused(&["a PLY file names no groups of its faces"]);
}

#[test]
fn polygons_that_are_doubtful_are_noted() {
    let bent = "v 0 0 0\nv 1 0 1\nv 1 1 0\nv 0 1 1\nf 1 2 3 4\n";
    let crossed = "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 3 0\nf 1 2 3\nf 1 2 3 4\nf 4 3 2 1\n";
    let folder = folder(&[("bent.obj", bent.into()), ("crossed.obj", crossed.into())]);
    let path = folder.path();
    let said = check(path, &["bent.obj"]).err;
    assert!(
        said.starts_with("pliant: note: bent.obj: 1 polygon"),
        "{said}"
    );
    let said = check(path, &["crossed.obj"]).err;
    assert!(
        said.contains("2 polygons cross themselves (the first is face 1)"),
        "{said}"
    );
    let said = pliant(path, &["convert", "crossed.obj", "c.ply"]).err;
    assert_eq!(said.lines().count(), 1, "{said}");
}

/// A flat strip of `squares` squares, and a spike through the last one if `pierced`.
fn strip(squares: usize, pierced: bool) -> String {
    let mut text = String::new();
    for x in 0..=squares {
        writeln!(text, "v {x} 0 0\nv {x} 1 0").unwrap();
    }
    for square in 0..squares {
        let [a, b, c, d] = [1, 2, 4, 3].map(|corner| 2 * square + corner);
        writeln!(text, "f {a} {d} {b}\nf {b} {d} {c}").unwrap();
    }
    if pierced {
        let x = squares as f64 - 0.7;
        writeln!(text, "v {x} 0.2 1\nv {x} 0.2 -1\nv {x} 5 -1\nf -3 -2 -1").unwrap();
    }
    text
}

#[test]
fn a_mesh_may_change_from_file_to_file() {
    let frames = [
        (2, false),
        (2, false),
        (3, true),
        (3, true),
        (5, true),
        (2, false),
    ];
    let names: Vec<String> = (0..frames.len())
        .map(|frame| format!("f{frame}.obj"))
        .collect();
    let files = frames.iter().zip(&names);
    let files = files.map(|(&(squares, pierced), name)| (&name[..], strip(squares, pierced)));
    let folder = folder(&files.collect::<Vec<_>>());
    let path = folder.path();
    let table = check(path, &["f*.obj"]);
    assert_eq!(table.code, 1, "{}", table.err);
    let lines: Vec<&str> = table.out.lines().map(str::trim).collect();
    let said = |frame: usize| {
        let row = lines.iter().position(|line| {
            let mut words = line.split_whitespace();
            words.next() == Some(&frame.to_string()) && words.next() == Some(&names[frame])
        });
        lines[row.unwrap() - 1]
    };
    let changes = |size: &str| format!("body 0 has another mesh from here on: {size}");
    assert_eq!(said(2), changes("11 vertices, 7 triangles"));
    assert_eq!(said(4), changes("15 vertices, 11 triangles"));
    assert_eq!(said(5), changes("6 vertices, 4 triangles"));
    assert_eq!(table.out.matches("another mesh").count(), 3);

    // Each frame equals its file, also where earlier frames are passed over or read first.
    let json = check(path, &["f*.obj", "--format", "json"]).json();
    for (frame, name) in names.iter().enumerate() {
        let alone = check(path, &[name, "--format", "json"]).json();
        assert_eq!(
            json["frames"][frame]["pairs"], alone["frames"][0]["pairs"],
            "{name}"
        );
    }
    let changed = &json["frames"][4]["changed"][0];
    assert_eq!(
        (changed["body"].as_u64(), changed["triangles"].as_u64()),
        (Some(0), Some(11))
    );
    assert!(json["frames"][3].get("changed").is_none());

    // Frame 3 has the mesh of frame 2, frame 4 another one.
    let new = check(path, &["f*.obj", "--baseline", "2", "--format", "json"]);
    let of_all = json["frames"].as_array().unwrap().iter();
    let all: Vec<u64> = of_all
        .map(|frame| frame["count"].as_u64().unwrap())
        .collect();
    assert!(all[2] > 0 && all[2] == all[3] && all[4] > 0, "{all:?}");
    assert_eq!(new.counts(), [0, 0, 0, 0, all[4], 0]);

    // Pairs of changing meshes are no baseline, and pieces belong to one mesh.
    fs::write(path.join("before.json"), json.to_string()).unwrap();
    let refused = check(path, &["f*.obj", "--baseline", "before.json"]);
    refused.assert_refused(&[
        "before.json",
        "in its frame 2 a mesh is another than before",
    ]);
    let refused = check(path, &["f*.obj", "--split", "components", "-q"]);
    refused.assert_refused(&[
        "frame 2",
        "the mesh is another than in the first frame",
        "without `--split`",
    ]);
    // A file format of one mesh cannot hold several.
    let refused = pliant(path, &["convert", "f*.obj", "all.npz"]);
    refused.assert_refused(&["f2.obj", "vertices", "export all of them from one mesh"]);
}

/// Three objects as Blender writes them. Two share an edge of the file; the third crosses the first
/// and has a group.
const OBJECTS: &str = "mtllib a.mtl\n\
    o Flat\nv 0 0 0\nv 4 0 0\nv 0 4 0\ns 0\nf 1 2 3\n\
    o Next part\nv 4 4 0\nf 2 4 3\n\
    o Up\nv 1 1 -1\nv 1 1 1\nv 1 2 1\ng Up_Skin\nf 5 6 7\n";

#[test]
fn groups_of_an_obj_file_are_bodies() {
    let folder = folder(&[
        ("scan.obj", OBJECTS.to_owned()),
        ("still.stl", String::new()),
    ]);
    let path = folder.path();
    let said = pliant(path, &["convert", "scan.obj", "still.stl", "--force", "-q"]);
    assert_eq!(said.code, 0, "{}", said.err);
    let json = |arguments: &[&str]| {
        check(path, &[arguments, &["--format", "json"]].concat()).json_without_places()
    };
    let body = |name: &str, triangle: u32| {
        json!({
            "name": name, "vertices": 3, "triangles": 1, "source": 0, "first_triangle": triangle
        })
    };
    let frame = |pair: [u32; 4]| {
        // The edges are of the upright triangle.
        let crossing_edges = [[pair[2], pair[0], 2, 2]];
        json!({
            "frame": 0, "count": 1, "kinds": kinds([1, 0, 0]), "pairs": [pair],
            "adjacent": 0, "adjacent_pairs": [], "crossing_edges": crossing_edges
        })
    };
    let whole = json(&["scan.obj"]);
    assert_eq!(
        whole,
        json!({"format": 1, "bodies": [{"name": "scan.obj", "vertices": 7, "triangles": 3}],
            "frames": [frame([0, 0, 0, 2])]})
    );
    let split = json(&["scan.obj", "--split", "groups"]);
    let bodies = json!([
        body("scan.obj#Flat", 0),
        body("scan.obj#Next part", 1),
        body("scan.obj#Up/Up_Skin", 2),
    ]);
    assert_eq!(
        split,
        json!({
            "format": 1, "bodies": bodies, "split": "groups", "triangle_numbers": "source",
            "sources": whole["bodies"], "frames": [frame([0, 0, 2, 2])]
        })
    );
    // Named by arguments: equal numbers of triangles, and the same source.
    let named = json(&["scan.obj#Up", "scan.obj#Flat", "./scan.obj#Next part"]);
    let bodies = json!([
        body("scan.obj#Up", 2),
        body("scan.obj#Flat", 0),
        body("scan.obj#Next part", 1),
    ]);
    assert_eq!(
        named,
        json!({
            "format": 1, "bodies": bodies, "triangle_numbers": "source", "sources": whole["bodies"],
            "frames": [{"frame": 0, "count": 1, "kinds": kinds([1, 0, 0]), "pairs": [[0, 2, 1, 0]],
                "adjacent": 0, "adjacent_pairs": [], "crossing_edges": [[0, 1, 2, 2]]}]
        })
    );
    // Their common edge is no hit, and nothing else is left.
    assert_eq!(
        check(path, &["scan.obj#Flat", "scan.obj#Next part"]).code,
        0
    );
    // A file without groups stays one body, beside files with groups.
    let both = json(&["still.stl", "scan.obj", "--split", "groups"]);
    let names = both["bodies"].as_array().unwrap().iter();
    let names: Vec<_> = names.map(|body| body["name"].as_str().unwrap()).collect();
    assert_eq!(
        names,
        [
            "still.stl",
            "scan.obj#Flat",
            "scan.obj#Next part",
            "scan.obj#Up/Up_Skin"
        ]
    );
    let table = check(path, &["still.stl", "scan.obj", "--split", "groups"]).out;
    for line in [
        "body 0: still.stl, 9 vertices, 3 triangles",
        "body 2: scan.obj#Next part, 3 vertices, 1 triangle, from triangle 1 on",
        "  of scan.obj, 7 vertices, 3 triangles",
    ] {
        assert!(
            table.lines().any(|said| said.starts_with(line)),
            "{line}: {table}"
        );
    }
}

#[test]
fn groups_are_named_in_rules_baselines_and_pictures() {
    let folder = folder(&[("scan.obj", OBJECTS.to_owned())]);
    let path = folder.path();
    let json =
        |arguments: &[&str]| check(path, &[arguments, &["--format", "json"]].concat()).json();
    // An object stands for its groups, in rules and as an argument of its own.
    for rule in [
        "scan.obj#Up,scan.obj#Flat",
        "scan.obj#Up/Up_Skin,0",
        "scan.obj,scan.obj",
    ] {
        let said = check(path, &["scan.obj", "--split", "groups", "--ignore", rule]);
        assert_eq!(said.code, 0, "{rule}: {}", said.out);
    }
    let group = [
        "--group",
        "sheet=scan.obj#Flat,scan.obj#Next part",
        "--ignore",
        "sheet,2",
    ];
    assert_eq!(
        check(
            path,
            &[&["scan.obj", "--split", "groups"], &group[..]].concat()
        )
        .code,
        0
    );

    let split = json(&["scan.obj", "--split", "groups"]);
    let named = json(&["scan.obj#Up", "scan.obj#Flat", "scan.obj#Next part"]);
    // Pairs found one way are a baseline for the other.
    for (old, arguments) in [
        (
            &split,
            &["scan.obj#Flat", "scan.obj#Next part", "scan.obj#Up/Up_Skin"][..],
        ),
        (&split, &["scan.obj", "--split", "groups"]),
        (
            &named,
            &["scan.obj#Up", "scan.obj#Flat", "scan.obj#Next part"],
        ),
    ] {
        fs::write(path.join("old.json"), old.to_string()).unwrap();
        let said = check(path, &[arguments, &["--baseline", "old.json"]].concat());
        assert_eq!(said.code, 0, "{}{}", said.out, said.err);
    }

    let hits = [
        "--hits", "hits.vtp", "--png", "a.png", "--report", "a.html", "-q",
    ];
    let said = check(
        path,
        &[&["scan.obj#Up", "scan.obj#Flat"], &hits[..]].concat(),
    );
    assert_eq!((said.code, said.err.as_str()), (1, ""));
    let said = pliant(path, &["convert", "scan.obj#Up", "up.obj"]);
    assert_eq!(
        said.out,
        "up.obj: 1 frame, 3 vertices, 1 triangle\n".replace("1 triangle\n", "1 triangles\n")
    );
    assert_eq!(
        fs::read_to_string(path.join("up.obj")).unwrap(),
        "v 1 1 -1\nv 1 1 1\nv 1 2 1\nf 1 2 3\n"
    );
}

#[test]
fn groups_of_a_sequence_are_those_of_its_first_file() {
    let moved = OBJECTS
        .replace("v 1 1 -1", "v 9 9 -1")
        .replace("v 1 1 1", "v 9 9 1");
    let folder = folder(&[
        ("walk_1.obj", OBJECTS.to_owned()),
        (
            "walk_2.obj",
            moved.replace("v 1 2 1", "v 9 8 1").replace("o ", "# "),
        ),
    ]);
    let path = folder.path();
    for arguments in [
        &["walk_*.obj", "--split", "groups"][..],
        &["walk_*.obj#Flat", "walk_*.obj#Up"],
        &["walk_*.obj#Up", "./walk_*.obj#Flat"],
    ] {
        let said = check(path, &[arguments, &["--format", "json"]].concat());
        assert_eq!(said.counts(), [1, 0], "{arguments:?}");
    }
    let said = pliant(path, &["convert", "walk_*.obj#Up", "up.npz"]);
    assert_eq!(
        (said.code, &said.out[..]),
        (0, "up.npz: 2 frames, 3 vertices, 1 triangles\n")
    );
    // Names that end in numbers are no series.
    let numbered = OBJECTS
        .replace("o Flat", "o leg1")
        .replace("o Up", "o leg2");
    fs::write(path.join("legs.obj"), numbered).unwrap();
    let said = check(path, &["legs.obj#leg1", "legs.obj#leg2"]);
    assert_eq!((said.code, &said.err[..]), (1, ""));
}
