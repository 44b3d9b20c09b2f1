//! End-to-end tests of `pliant check`: every exit code, and every kind of wrong file.

use crate::common::{check, folder, kinds, pliant};
use serde_json::json;
use std::fs;
use std::path::Path;

/// An OBJ file: a right-angled triangle of side 2 in the plane z.
fn flat(z: f64) -> String {
    format!("v 0 0 {z}\nv 2 0 {z}\nv 0 2 {z}\nf 1 2 3\n")
}

/// A triangle upright in x = 0.5, which crosses the plane z = 0 if `z` is between -1 and 1.
fn upright(z: f64) -> String {
    format!(
        "v 0.5 0.25 {}\nv 0.5 0.25 {}\nv 0.5 0.75 {}\nf 1 2 3\n",
        z - 1.0,
        z + 1.0,
        z + 1.0
    )
}

/// Two triangles without a common vertex, which cross each other if asked to.
fn pair(crossing: bool) -> String {
    let z = if crossing { 0.0 } else { 5.0 };
    flat(0.0) + &upright(z).replace("f 1 2 3", "f 4 5 6")
}

#[test]
fn zero_when_nothing_intersects() {
    let folder = folder(&[("a.obj", pair(false)), ("b.obj", upright(9.0))]);
    for arguments in [
        &["a.obj"][..],
        &["a.obj", "b.obj"],
        &["a.obj", "b.obj", "--self"],
        &["a.obj", "--first"],
    ] {
        let said = check(folder.path(), arguments);
        assert_eq!((said.code, said.err.as_str()), (0, ""), "{}", said.out);
        assert!(said.out.contains("0 of 1 frames intersect"), "{}", said.out);
    }
}

#[test]
fn one_when_something_intersects() {
    let folder = folder(&[
        ("a.obj", pair(true)),
        ("b.obj", upright(0.0)),
        ("c.obj", flat(50.0)),
    ]);
    let path = folder.path();
    let itself = check(path, &["a.obj", "--format", "json"]);
    assert_eq!((itself.code, itself.err.as_str()), (1, ""));
    let bodies = json!([{"name": "a.obj", "vertices": 6, "triangles": 2}]);
    let frames = json!([
        {"frame": 0, "count": 1, "kinds": kinds([1, 0, 0]), "pairs": [[0, 0, 0, 1]],
            "adjacent": 0, "adjacent_pairs": [], "crossing_edges": [[0, 0, 2, 2]]}
    ]);
    assert_eq!(
        itself.json_without_places(),
        json!({"format": 1, "bodies": bodies, "frames": frames})
    );

    // Several bodies: against each other, and with --self each also against itself.
    let others = check(path, &["a.obj", "b.obj", "c.obj", "--format", "json"]);
    assert_eq!(
        others.json()["frames"][0]["pairs"],
        json!([[0, 0, 1, 0], [0, 1, 1, 0]])
    );
    let all = check(path, &["b.obj", "a.obj", "--self", "--format", "json"]);
    assert_eq!(
        all.json()["frames"][0]["pairs"],
        json!([[0, 0, 1, 0], [0, 0, 1, 1], [1, 0, 1, 1]])
    );

    let count = check(path, &["a.obj", "b.obj", "--count", "--format", "json"]);
    assert_eq!(
        count.json()["frames"],
        json!([{"frame": 0, "count": 2, "kinds": kinds([1, 1, 0]),
            "crossing_edges": [[1, 0, 2, 2]], "inside": [], "not_closed": [0, 1]}])
    );
    assert_eq!(count.code, 1);

    let first = check(path, &["b.obj", "a.obj", "--first", "--format", "json"]);
    let frame = &first.json()["frames"][0];
    assert_eq!(
        (&frame["count"], &frame["complete"]),
        (&json!(1), &json!(false))
    );
    assert!([json!([[0, 0, 1, 0]]), json!([[0, 0, 1, 1]])].contains(&frame["pairs"]));
    let none = check(path, &["b.obj", "c.obj", "--first", "--format", "json"]);
    assert_eq!(
        (none.code, &none.json()["frames"]),
        (
            0,
            &json!([{"frame": 0, "count": 0, "complete": false, "pairs": [], "inside": [],
            "not_closed": [0, 1]}])
        )
    );

    let table = check(path, &["a.obj"]);
    assert!(
        table
            .out
            .contains("1 of 1 frames intersect; most pairs: 1 in frame 0"),
        "{}",
        table.out
    );
    assert!(
        table
            .out
            .contains("triangle 0 of body 0, triangle 1 of body 0"),
        "{}",
        table.out
    );
}

#[test]
fn the_table_separates_thousands_in_counts_and_not_in_numbers_of_triangles() {
    let folder = tempfile::tempdir().unwrap();
    // A thousand triangles far from each other, then fifty that lie on each other.
    let corners = |x: usize, y: usize| {
        format!(
            "v {x} {y} 0\nv {} {y} 0\nv {x} {} 0\nf -3 -2 -1\n",
            x + 99,
            y + 99
        )
    };
    let apart = (0..1000).map(|place| corners(0, 100 + 100 * place));
    let mesh: String = apart
        .chain((0..50).map(|place| corners(place, 0)))
        .collect();
    fs::write(folder.path().join("many.obj"), mesh).unwrap();
    let table = check(folder.path(), &["many.obj"]).out;
    let lines: Vec<_> = table.lines().collect();
    assert_eq!(
        lines[0],
        "body 0: many.obj, 3,150 vertices, 1,050 triangles, 148 x 100100 x 0 large"
    );
    assert_eq!(
        lines[4],
        "       0     1,225         0  triangle 1000 of body 0, triangle 1001 of body 0"
    );
    assert_eq!(lines[6], "1 place:");
    assert_eq!(
        lines[7],
        "  place 0: 1,225 pairs; 146 across, round (74, 49, 0); 50 triangles from 1000 on"
    );
    assert_eq!(
        lines[9],
        "1 of 1 frames intersect; most pairs: 1,225 in frame 0"
    );
}

#[test]
fn a_pattern_is_a_sequence_in_natural_order() {
    // Crossing in frames 9 and 11 only: in the order of characters, 10 would come first.
    let mut files: Vec<_> = (9..12)
        .map(|i| {
            (
                format!("move_{i}.obj"),
                upright(if i == 10 { 7.0 } else { 0.0 }),
            )
        })
        .collect();
    files.push(("still.obj".into(), flat(0.0)));
    let files: Vec<_> = files
        .iter()
        .map(|(name, text)| (name.as_str(), text.clone()))
        .collect();
    let folder = folder(&files);
    let said = check(
        folder.path(),
        &["move_*.obj", "still.obj", "--format", "json"],
    );
    assert_eq!(said.counts(), [1, 0, 1]);
    assert_eq!((said.code, said.err.as_str()), (1, ""));

    // A shell that expands the pattern makes three bodies of it.
    let expanded = check(folder.path(), &["move_9.obj", "move_10.obj", "move_11.obj"]);
    assert!(expanded.err.contains("'move_*.obj'"), "{}", expanded.err);
    assert_eq!(expanded.code, 1, "bodies 0 and 2 are in the same place");
}

#[test]
fn polygons_are_triangles_that_know_their_face() {
    let text = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n".to_owned()
        + &upright(0.0).replace("f 1 2 3", "f 5 6 7");
    let folder = folder(&[("quad.obj", text)]);
    let said = check(folder.path(), &["quad.obj", "--format", "json"]);
    assert_eq!(
        said.json()["bodies"][0],
        json!({
            "name": "quad.obj", "box": [[0.0, 0.0, -1.0], [4.0, 4.0, 1.0]],
            "vertices": 7, "triangles": 3, "faces": [0, 0, 1]
        })
    );
    // The upright triangle touches the diagonal at (0.5, 0.5), and so both halves of the square.
    assert_eq!(
        said.json()["frames"][0]["pairs"],
        json!([[0, 0, 0, 2], [0, 1, 0, 2]])
    );
}

#[test]
fn seams_are_welded_unless_told_not_to() {
    // A strip of two triangles, each with vertices of its own.
    let text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n".to_owned();
    let folder = folder(&[("seam.obj", text)]);
    let welded = check(folder.path(), &["seam.obj", "--format", "json"]);
    assert_eq!(
        (welded.code, &welded.json()["bodies"][0]["welded"]),
        (0, &json!(2))
    );
    let table = check(folder.path(), &["seam.obj"]);
    assert!(table.out.contains("2 vertices welded"), "{}", table.out);
    let apart = check(
        folder.path(),
        &["seam.obj", "--no-weld", "--format", "json"],
    );
    assert_eq!(
        (apart.code, &apart.json()["frames"][0]["pairs"]),
        (1, &json!([[0, 0, 0, 1]]))
    );
}

#[test]
fn two_when_it_cannot_be_checked() {
    let folder = folder(&[
        ("good.obj", pair(true)),
        ("empty.obj", String::new()),
        ("range.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n".into()),
        ("text.obj", "v 0 zero 0\n".into()),
        ("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into()),
        ("huge.obj", "v 0 0 1e39\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into()),
        (
            "cut.ply",
            "ply\nformat ascii 1.0\nelement vertex 99\nproperty float x\nend_header\n1\n".into(),
        ),
        ("mesh.xyz", "1 2 3\n".into()),
        ("cut.npz", "PK\u{3}\u{4}".into()),
    ]);
    let path = folder.path();
    fs::create_dir(path.join("folder.obj")).unwrap();
    check(path, &["missing.obj"]).assert_refused(&["missing.obj"]);
    check(path, &["missing_*.obj"]).assert_refused(&["missing_*.obj"]);
    check(path, &["empty.obj"]).assert_refused(&["empty.obj"]);
    check(path, &["range.obj"]).assert_refused(&["range.obj", "line 3"]);
    check(path, &["text.obj"]).assert_refused(&["text.obj", "line 1"]);
    check(path, &["nan.obj"]).assert_refused(&["nan.obj", "vertex 0"]);
    check(path, &["huge.obj"]).assert_refused(&["huge.obj", "vertex 0"]);
    check(path, &["cut.ply"]).assert_refused(&["cut.ply"]);
    check(path, &["cut.npz"]).assert_refused(&["cut.npz"]);
    check(path, &["mesh.xyz"]).assert_refused(&["mesh.xyz", "obj", "ply", "npz"]);
    check(path, &["folder.obj"]).assert_refused(&["folder.obj"]);
    // A good body does not help: nothing is printed as if it had been checked.
    let said = check(path, &["good.obj", "nan.obj", "--format", "json"]);
    said.assert_refused(&["nan.obj"]);
    assert_eq!(said.out, "");
}

#[test]
fn two_when_a_late_frame_cannot_be_checked_even_after_hits() {
    let other = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 nan\nf 1 2 3\n".to_owned();
    let folder = folder(&[
        ("s_0.obj", pair(true)),
        ("s_1.obj", pair(false)),
        ("s_2.obj", other),
        ("s_3.obj", pair(true)),
    ]);
    let json = check(folder.path(), &["s_*.obj", "--format", "json"]);
    json.assert_refused(&["s_2.obj"]);
    assert_eq!(
        json.counts(),
        [1, 0],
        "what was checked stands, and the object is closed"
    );
    let error = json.json()["error"].as_str().unwrap().to_owned();
    assert!(
        error.contains("s_2.obj") && json.err.contains(&error),
        "{error}"
    );
    let table = check(folder.path(), &["s_*.obj"]);
    table.assert_refused(&["s_2.obj"]);
    assert!(
        table.out.contains("place 0: 1 pair in frame 0; "),
        "{}",
        table.out
    );
    assert_eq!(
        table
            .out
            .lines()
            .take_while(|line| *line != "1 place:")
            .filter(|line| line.trim_start().starts_with(['0', '1']))
            .count(),
        2,
        "{}",
        table.out
    );
}

#[test]
fn the_table_names_the_file_of_each_frame() {
    let folder = folder(&[
        ("7.obj", pair(true)),
        ("227.obj", pair(false)),
        ("still.obj", flat(9.0)),
    ]);
    let path = folder.path();
    for (file, z) in [("one/b.obj", 1.0), ("two/b.obj", 2.0)] {
        let file = path.join(file);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, flat(z)).unwrap();
    }
    let rows = |arguments: &[&str]| {
        let table = check(path, arguments).out;
        let from_header_on = table
            .lines()
            .skip_while(|line| !line.trim_start().starts_with("frame"));
        let rows = from_header_on.take_while(|line| !line.is_empty());
        rows.map(String::from).collect::<Vec<_>>()
    };
    let of_numbers = [
        "   frame  file        pairs  adjacent  first pair",
        "       0  7.obj           1         0  triangle 0 of body 0, triangle 1 of body 0",
        "       1  227.obj         0         0",
    ];
    assert_eq!(rows(&["[0-9]*.obj"]), of_numbers);
    assert_eq!(
        rows(&["[0-9]*.obj", "--count"]),
        of_numbers.map(|row| row.get(..37).unwrap_or(row))
    );
    // The common folder is named in the line of the body.
    let whole = path.join("[0-9]*.obj");
    assert_eq!(rows(&[whole.to_str().unwrap()]), of_numbers);
    let of_folders = rows(&["*/b.obj"]);
    assert_eq!(of_folders[1..].concat().matches("b.obj").count(), 2);
    for (row, file) in of_folders[1..].iter().zip(["one", "two"]) {
        let file = Path::new(file).join("b.obj").display().to_string();
        assert!(row.split_whitespace().any(|word| word == file), "{row}");
    }
    // Two bodies in files: the header says whose files are listed.
    let of_two = rows(&["still.obj", "*/b.obj", "[0-9]*.obj"]);
    assert_eq!(of_two[0], "   frame  file of body 1     pairs  first pair");
    assert_eq!(of_two[2].find("1  two"), Some(7), "{}", of_two[2]);
    // One file is all frames: its name stands in the head.
    assert_eq!(
        rows(&["still.obj", "7.obj"]),
        ["   frame     pairs  first pair", "       0         0"]
    );
}

#[test]
fn frame_counts_must_be_equal_or_one() {
    let folder = folder(&[
        ("a_0.obj", flat(0.0)),
        ("a_1.obj", flat(1.0)),
        ("a_2.obj", flat(2.0)),
        ("b_0.obj", flat(0.0)),
        ("b_1.obj", flat(3.0)),
    ]);
    check(folder.path(), &["a_*.obj", "b_*.obj"])
        .assert_refused(&["a_*.obj has 3", "b_*.obj has 2"]);
}

#[test]
fn a_long_sequence_is_streamed() {
    let folder = tempfile::tempdir().unwrap();
    for frame in 0..120 {
        fs::write(
            folder.path().join(format!("f{frame}.obj")),
            upright(f64::from(frame % 7) - 3.0),
        )
        .unwrap();
    }
    fs::write(folder.path().join("ground.obj"), flat(0.0)).unwrap();
    let said = check(
        folder.path(),
        &["f*.obj", "ground.obj", "--format", "json", "--count"],
    );
    // Upright triangles reach from z - 1 to z + 1: they meet the ground at z = -1, 0 and 1, as
    // touching counts.
    let expected: Vec<u64> = (0..120)
        .map(|frame| u64::from((2..=4).contains(&(frame % 7))))
        .collect();
    assert_eq!(said.counts(), expected);
}

#[test]
fn wrong_words_are_explained() {
    let folder = folder(&[]);
    for arguments in [
        &["check"][..],
        &["check", "a.obj", "--format", "xml"],
        &["chekc"],
        &[],
    ] {
        let said = pliant(folder.path(), arguments);
        assert_eq!(said.code, 2);
        assert!(
            said.err.contains("Usage") || said.err.contains("--help"),
            "{}",
            said.err
        );
    }
    let help = pliant(folder.path(), &["--help"]);
    assert_eq!(help.code, 0);
    for verb in ["pliant run", "pliant check"] {
        assert!(help.out.contains(verb), "{}", help.out);
    }
}

#[test]
fn pairs_are_counted_by_how_they_intersect() {
    // Against a triangle in z = 0: one crosses it, one stands on it, one lies on it, one is beside
    // it.
    let folder = folder(&[
        ("a.obj", flat(0.0)),
        ("through.obj", upright(0.0)),
        ("on.obj", upright(1.0)),
        (
            "lies.obj",
            "v 1 0 0\nv 3 0 0\nv 1 2 0\nf 1 2 3\n".to_owned(),
        ),
        (
            "beside.obj",
            "v 2 0 0\nv 0 2 0\nv 2 2 0\nf 1 2 3\n".to_owned(),
        ),
    ]);
    let of = |files: &[&str]| {
        let said = check(folder.path(), &[files, &["--format", "json"]].concat());
        said.json()["frames"][0]["kinds"].clone()
    };
    assert_eq!(of(&["a.obj", "through.obj"]), kinds([1, 0, 0]));
    assert_eq!(of(&["a.obj", "on.obj"]), kinds([0, 0, 1]));
    assert_eq!(of(&["a.obj", "lies.obj"]), kinds([0, 1, 0]));
    assert_eq!(of(&["a.obj", "beside.obj"]), kinds([0, 0, 1]));
    // Kinds are not reported where nothing intersects, where not all pairs are asked for, or with a
    // distance.
    let first = ["a.obj", "through.obj", "--first"];
    let within = ["a.obj", "through.obj", "--within", "1"];
    for files in [&["on.obj", "beside.obj"][..], &first, &within] {
        assert_eq!(of(files), serde_json::Value::Null, "{files:?}");
    }
}

#[test]
fn frames_are_chosen() {
    // Two triangles that cross in the frames 0, 3, 6, ... of ten.
    let names: Vec<String> = (0..10).map(|frame| format!("a_{frame}.obj")).collect();
    let files = names.iter().enumerate();
    let files: Vec<(&str, String)> = files
        .map(|(frame, name)| (name.as_str(), pair(frame % 3 == 0)))
        .collect();
    let folder = folder(&files);
    let chosen = |more: &[&str]| {
        let said = check(
            folder.path(),
            &[&["a_*.obj", "--format", "json"], more].concat(),
        );
        assert!(said.code < 2, "{}", said.err);
        let json = said.json();
        let frames = json["frames"].as_array().unwrap().iter();
        let numbers: Vec<u64> = frames.map(|it| it["frame"].as_u64().unwrap()).collect();
        let hit = numbers.iter().map(|frame| u64::from(frame % 3 == 0));
        assert!(said.counts().into_iter().eq(hit), "{more:?}");
        numbers
    };
    for (frames, expected) in [
        ("..", (0..10).collect::<Vec<_>>()),
        ("3..6", vec![3, 4, 5]),
        ("7..", vec![7, 8, 9]),
        ("..2", vec![0, 1]),
        ("4", vec![4]),
        ("1..9:3", vec![1, 4, 7]),
        ("2..:4", vec![2, 6]),
        ("..11:4", vec![0, 4, 8]),
    ] {
        assert_eq!(chosen(&["--frames", frames]), expected, "{frames}");
    }
    // A baseline may be another frame. The exit code depends on these frames alone.
    let said = check(
        folder.path(),
        &["a_*.obj", "--frames", "3..:3", "--baseline", "0"],
    );
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    assert!(said.out.contains("0 of 3 frames intersect"), "{}", said.out);
    assert_eq!(
        check(folder.path(), &["a_*.obj", "--frames", "1..3"]).code,
        0
    );
    // Pages, pictures and files for ParaView show these frames, too.
    let files = [
        "--hits", "hits.vtp", "--report", "a.html", "--png", "a.png", "--frame", "7",
    ];
    assert_eq!(
        chosen(&[&["--frames", "1..9:3"], &files[..]].concat()),
        [1, 4, 7]
    );
    let mut written: Vec<_> = fs::read_dir(folder.path())
        .unwrap()
        .collect::<Result<_, _>>()
        .unwrap();
    written.retain(|it| it.file_name().to_string_lossy().starts_with("hits"));
    let mut written: Vec<_> = written.iter().map(fs::DirEntry::file_name).collect();
    written.sort();
    assert_eq!(
        written,
        ["hits.pvd", "hits_1.vtp", "hits_4.vtp", "hits_7.vtp"]
    );
    let page = fs::read_to_string(folder.path().join("a.html")).unwrap();
    assert!(page.contains(r#""numbers":[1,4,7]"#));
    let one = ["--frames", "3", "--hits", "one.vtp", "--png", "one.png"];
    assert_eq!(chosen(&one), [3]);
    assert!(
        ["one.vtp", "one.png"]
            .iter()
            .all(|name| folder.path().join(name).exists())
    );
    // Contacts are sought on the way from one of these frames to the next.
    let said = check(folder.path(), &["a_*.obj", "--swept", "--frames", "1..9:3"]);
    assert!(
        said.out.contains("to 4") && !said.out.contains("to 5"),
        "{}",
        said.out
    );

    let refused = |more: &[&str], words: &[&str]| {
        check(folder.path(), &[&["a_*.obj"], more].concat()).assert_refused(words);
    };
    refused(&["--frames", "8..11"], &["frame 10", "0 to 9"]);
    refused(&["--frames", "10.."], &["frame 10", "0 to 9"]);
    refused(&["--frames", "5..5"], &["5..5 has no frames"]);
    refused(&["--frames", "1..5:0"], &["10..20:3"]);
    refused(&["--frames", "1-5"], &["10..20:3"]);
    refused(&["--frames", "3", "--swept"], &["--swept"]);
    let picture = ["--frames", "1..9:3", "--png", "a.png", "--frame", "2"];
    refused(&picture, &["--frame 2", "the first is 1, the last 7"]);
}
