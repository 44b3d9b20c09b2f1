//! Output of `pliant check` for other programs: `--format github`, `--format lines`, `--quiet`.

use crate::common::check;
use std::fmt::Write;
use std::fs;
use tempfile::TempDir;

const SHEET: &str = "v -1 -1 0\nv 9 -1 0\nv -1 9 0\nf 1 2 3\n";

/// Fifteen frames of an upright triangle that crosses a sheet, and one more above it. Frame 2 is
/// clear.
fn folder(name: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for frame in 0..15 {
        let low = if frame == 2 { 5 } else { -1 };
        let text = format!("v 1 0 {low}\nv 1 0 7\nv 1 2 7\nf 1 2 3\n");
        fs::write(folder.path().join(format!("{name}{frame}.obj")), text).unwrap();
    }
    fs::write(folder.path().join("sheet.obj"), SHEET).unwrap();
    folder
}

#[test]
fn github_shows_places_on_the_files_of_their_frames() {
    let folder = folder("m,100%:_");
    let said = check(
        folder.path(),
        &["m*.obj", "sheet.obj", "--format", "github"],
    );
    assert_eq!((said.code, said.err.as_str()), (1, ""));
    let lines: Vec<_> = said.out.lines().collect();
    // Commas, colons and percent signs would end the name, or begin an escape.
    //
    // After a frame without it, the same place is a new place.
    let first = "triangle 0 of m*.obj and triangle 0 of sheet.obj";
    assert_eq!(
        lines,
        [
            &*format!(
                "::error file=m%2C100%25%3A_0.obj,title=pliant::place 0: frames 0 to 1, 1 pair at \
                 most, in frame 0; the first: {first}"
            ),
            &*format!(
                "::error file=m%2C100%25%3A_3.obj,title=pliant::place 1: frames 3 to 14, 1 pair at \
                 most, in frame 3; the first: {first}"
            ),
            "pliant: 14 of 15 frames intersect; most pairs: 1 in frame 0; 2 places",
        ]
    );

    // Without places, the first frames are annotated.
    let count = check(
        folder.path(),
        &["m*.obj", "sheet.obj", "--format", "github", "--count"],
    );
    let lines: Vec<_> = count.out.lines().collect();
    assert_eq!(
        lines[0],
        format!(
            "::error file=m%2C100%25%3A_0.obj,title=pliant::frame 0: 1 pair of triangles \
             intersects; the first: {first}"
        )
    );
    assert!(
        lines[2].contains("_3.obj,") && lines[2].contains("::frame 3: "),
        "{}",
        lines[2]
    );
    let annotations = lines.iter().filter(|line| line.starts_with("::error"));
    assert_eq!(annotations.count(), 10);
    assert_eq!(
        lines[10..],
        ["pliant: 14 of 15 frames intersect; most pairs: 1 in frame 0; the first 10 are annotated"]
    );

    let baseline = [
        "m*.obj",
        "sheet.obj",
        "--format",
        "github",
        "--baseline",
        "0",
    ];
    let said = check(folder.path(), &baseline);
    assert_eq!(
        (said.code, said.out.as_str()),
        (0, "pliant: 0 of 15 frames intersect\n")
    );
    let first = check(
        folder.path(),
        &["m*.obj", "sheet.obj", "--format", "github", "--first"],
    )
    .out;
    assert!(first.contains("at least 1 pair"), "{first}");
}

#[test]
fn github_says_why_it_could_not_be_checked() {
    let folder = folder("m");
    fs::write(folder.path().join("m4.obj"), "no mesh\n").unwrap();
    fs::write(folder.path().join("bad.obj"), "v 0 0 100%\n").unwrap();
    let advice = "; mend it, or export it again";
    for (body, errors, words) in [("m*.obj", 3, "m4.obj"), ("bad.obj", 1, "bad.obj, line 1")] {
        let said = check(folder.path(), &[body, "sheet.obj", "--format", "github"]);
        said.assert_refused(&[words, advice]);
        let lines: Vec<_> = said.out.lines().collect();
        assert_eq!(lines.len(), errors, "{}", said.out);
        let last = lines[errors - 1];
        assert!(
            last.starts_with("::error title=pliant::")
                && last.contains(words)
                && last.ends_with(advice),
            "{last}"
        );
        assert!(!last.contains("% "), "{last}");
    }
}

/// Thirty needles through a sheet each, the third pierced twice; in three frames, clear in the
/// second.
#[test]
fn places_of_table_json_and_annotations_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    for frame in 0..3 {
        let mut text = String::new();
        for (place, twice) in (0..30).map(|place| (place, place == 2)) {
            let low = if frame == 1 { 5 } else { -1 };
            let x = 20 * place;
            writeln!(text, "v {x} -1 0\nv {} -1 0\nv {x} 9 0\nf -3 -2 -1", x + 9).unwrap();
            for needle in 0..=i32::from(twice) {
                let x = x + 1 + 2 * needle;
                writeln!(text, "v {x} 0 {low}\nv {x} 0 7\nv {x} 2 7\nf -3 -2 -1").unwrap();
            }
        }
        fs::write(folder.path().join(format!("m{frame}.obj")), text).unwrap();
    }
    let said = |format| check(folder.path(), &["m*.obj", "--format", format]);
    let json = said("json").json();
    let places = json["places"].as_array().unwrap();
    assert_eq!((places.len(), json.get("places_left_out")), (60, None));
    let first = serde_json::json!({
        "number": 2, "frames": [0, 0], "most_pairs": 2, "most_in": 0,
        "box": [[41.0, 0.0, 0.0], [43.0, 0.25, 0.0]],
        "first_pair": [0, 4, 0, 5], "bodies": [{"body": 0, "triangles": 3, "first_triangle": 4}]
    });
    assert_eq!(places[0], first);
    assert_eq!(places[1]["number"], 32);
    let frame = &json["frames"][0]["places"];
    assert_eq!(frame[0]["count"], 2);
    assert_eq!(frame[0]["first_pair"], first["first_pair"]);
    assert_eq!(frame.as_array().unwrap().len(), 30);
    assert_eq!(json["frames"][1]["places"], serde_json::json!([]));

    let table = said("table").out;
    assert!(
        table.contains(
            "\n60 places, most pairs first:\n  place 2: 2 pairs in frame 0; 2 across, round \
             (42, 0.125, 0); 3 triangles from 4 on\n"
        ),
        "{table}"
    );
    let lines = table.lines().filter(|line| line.starts_with("  place "));
    assert_eq!(lines.count(), 20);
    assert!(table.contains("\n  and 40 more\n"), "{table}");

    let github = said("github").out;
    let lines: Vec<_> = github.lines().collect();
    assert_eq!(lines.len(), 11);
    assert!(
        lines[10].ends_with("; 60 places, the 10 with the most pairs are annotated"),
        "{github}"
    );
    assert!(lines[1].contains("file=m2.obj,title=pliant::place 32: 2 pairs in frame 2; "));

    // Places are not reported with a first pair, or with numbers alone.
    for less in ["--first", "--count"] {
        for format in ["json", "table"] {
            let said = check(folder.path(), &["m*.obj", "--format", format, less]);
            assert!(!said.out.contains("place"), "{}", said.out);
        }
    }
}

#[test]
fn a_line_for_each_pair() {
    let folder = folder("m");
    let said = check(folder.path(), &["m*.obj", "sheet.obj", "--format", "lines"]);
    let mut expected = String::new();
    for frame in (0..15).filter(|&frame| frame != 2) {
        writeln!(expected, "{frame} 0 0 1 0").unwrap();
    }
    assert_eq!((said.code, said.out, said.err.as_str()), (1, expected, ""));
    let count = check(
        folder.path(),
        &[
            "m2.obj",
            "m3.obj",
            "sheet.obj",
            "--format",
            "lines",
            "--count",
        ],
    );
    assert_eq!(count.out, "0 2\n", "m3 meets m2 and the sheet");
    let clear = check(folder.path(), &["m2.obj", "sheet.obj", "--format", "lines"]);
    assert_eq!((clear.code, clear.out.as_str()), (0, ""));
}

#[test]
fn lines_are_the_pairs_of_the_json() {
    let folder = tempfile::tempdir().unwrap();
    let mut text = SHEET.to_owned();
    for x in 0..4 {
        writeln!(text, "v {x} 0 -1\nv {x} 0 1\nv {x} 2 1\nf -1 -2 -3").unwrap();
    }
    fs::write(folder.path().join("a.obj"), text).unwrap();
    let pairs = |format| check(folder.path(), &["a.obj", "--format", format]);
    let json = pairs("json").json();
    let rows = json["frames"][0]["pairs"].as_array().unwrap().iter();
    let row = |row: &serde_json::Value| format!("0 {} {} {} {}\n", row[0], row[1], row[2], row[3]);
    let expected: String = rows.map(row).collect();
    assert_eq!(expected.lines().count(), 4);
    assert_eq!(pairs("lines").out, expected);
}

#[test]
fn quiet_says_it_by_its_exit_code() {
    let folder = folder("m");
    for format in ["table", "json", "github", "lines"] {
        let quiet = |arguments: &[&str]| {
            let said = check(
                folder.path(),
                &[arguments, &["--quiet", "--format", format]].concat(),
            );
            assert_eq!(said.out, "", "{format}");
            (said.code, said.err)
        };
        assert_eq!(quiet(&["m*.obj", "sheet.obj"]), (1, String::new()));
        assert_eq!(
            quiet(&["m2.obj", "sheet.obj", "--self"]),
            (0, String::new())
        );
        assert_eq!(quiet(&["m*.obj", "sheet.obj", "--baseline", "0"]).0, 0);
        assert_eq!(quiet(&["m*.obj", "sheet.obj", "--baseline", "2"]).0, 1);
        let (code, said) = quiet(&["absent.obj"]);
        assert!(code == 2 && said.contains("absent.obj"), "{said}");
    }
    // An unreadable frame matters more than a pair in an earlier frame.
    fs::write(folder.path().join("m9.obj"), "no mesh").unwrap();
    let said = check(folder.path(), &["m*.obj", "sheet.obj", "-q"]);
    said.assert_refused(&["m9.obj"]);
    assert_eq!(said.out, "");
}
