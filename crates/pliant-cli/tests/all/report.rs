//! End-to-end tests of pages and pictures. Tests in `web/` show pages in a browser.

use crate::common::{Said, pliant};
use serde_json::{Value, json};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Two triangles that meet in the frames 1 and 2, of four; the second moves.
fn sequence(folder: &Path) {
    fs::write(
        folder.join("still.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    for (frame, x) in [-2.0, 0.2, 0.3, 5.0].into_iter().enumerate() {
        let text = format!("v {x} 0.2 -1\nv {x} 0.2 1\nv {x} 0.4 1\nf 1 2 3\n");
        fs::write(folder.join(format!("moves_{frame}.obj")), text).unwrap();
    }
}

fn check(folder: &Path, arguments: &[&str]) -> Said {
    pliant(
        folder,
        &[&["check", "still.obj", "moves_*.obj"], arguments].concat(),
    )
}

/// Data of a page, as its viewer reads it.
fn head(folder: &Path, page: &str) -> Value {
    let page = fs::read_to_string(folder.join(page)).unwrap();
    let start = page.find(r#"id="report">"#).unwrap() + r#"id="report">"#.len();
    serde_json::from_str(page[start..].split("</script").next().unwrap()).unwrap()
}

#[test]
fn a_page_and_a_picture_change_nothing_that_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    sequence(folder);
    for form in [
        &["--format", "json"][..],
        &["--count", "--format", "json"],
        &[],
        &["--count"],
        &["--first"],
    ] {
        let alone = check(folder, form);
        let pictures = ["--report", "a.html", "--png", "a.png", "--frame", "1"];
        let with = check(folder, &[form, &pictures].concat());
        assert_eq!(
            (alone.code, &alone.out, &alone.err),
            (with.code, &with.out, &with.err),
            "{form:?}"
        );
        assert_eq!(alone.code, 1);
        let head = head(folder, "a.html");
        assert_eq!(
            head["motions"][0]["pairs"],
            serde_json::json!([0, 1, 1, 0]),
            "{form:?}"
        );
        assert_eq!(
            head["motions"][0]["frames"],
            serde_json::json!([0, 1, 2, 3])
        );
        assert_eq!(head["motions"][0]["bodies"][1]["name"], "moves_*.obj");
        let found =
            "Something intersects in 2 of 4 frames, first in frame 1. Most pairs: 1, in frame 1.";
        assert_eq!(head["found"], found);
        assert!(
            fs::read(folder.join("a.png"))
                .unwrap()
                .starts_with(b"\x89PNG")
        );
    }
}

#[test]
fn only_pages_and_images_are_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    sequence(folder);
    let mesh = fs::read(folder.join("still.obj")).unwrap();
    for option in ["--report", "--png"] {
        let said = check(folder, &[option, "still.obj", "--frame", "0"]);
        assert_eq!(said.code, 2);
        assert!(
            said.err.contains("give a name that ends in"),
            "{}",
            said.err
        );
        assert_eq!(fs::read(folder.join("still.obj")).unwrap(), mesh);
    }
}

#[test]
fn what_cannot_be_is_said_before_anything_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    sequence(folder);
    check(folder, &["--png", "a.png", "--frame", "4"])
        .assert_refused(&["--frame 4", "the first is 0, the last 3"]);
    check(folder, &["--report", "nowhere/a.html"]).assert_refused(&["cannot write nowhere/a.html"]);
    let run = [
        "run",
        "--triangles",
        "320",
        "--stride",
        "50",
        "--png",
        "a.png",
        "--frame",
        "60",
    ];
    pliant(folder, &run).assert_refused(&["--frame 60", "step", "the first is 50, the last 200"]);
    // An existing page is not lost to a check that cannot begin.
    fs::write(folder.join("old.html"), "kept").unwrap();
    check(
        folder,
        &["--report", "old.html", "--png", "a.png", "--frame", "9"],
    )
    .assert_refused(&["--frame 9"]);
    assert_eq!(fs::read(folder.join("old.html")).unwrap(), b"kept");
    assert_eq!(check(folder, &["--frame", "1"]).code, 2);
    check(folder, &["--png", "a.png"])
        .assert_refused(&["say which with --frame", "the first is 0, the last 3"]);
    assert!(!folder.join("a.png").exists());
    // A mesh that does not move leaves no choice of frame.
    let said = pliant(folder, &["check", "still.obj", "--png", "a.png"]);
    assert!(said.code < 2, "{}", said.err);
    assert!(folder.join("a.png").exists());
}

#[test]
fn a_picture_keeps_the_pairs_of_its_frame_alone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Forty upright triangles cross forty flat ones in frame 1: a list of 1,600 pairs takes 25,600
    // bytes.
    let (mut still, mut away, mut across) = (String::new(), String::new(), String::new());
    for i in 0..40 {
        let z = f64::from(i) / 50.0;
        let x = 0.01 + z / 10.0;
        writeln!(still, "v 0 0 {z}\nv 1 0 {z}\nv 0 1 {z}\nf -3 -2 -1").unwrap();
        for (text, x) in [(&mut away, x + 9.0), (&mut across, x)] {
            writeln!(text, "v {x} 0.1 -1\nv {x} 0.1 2\nv {x} 0.2 2\nf -3 -2 -1").unwrap();
        }
    }
    for (name, text) in [
        ("still.obj", still),
        ("moves_0.obj", away),
        ("moves_1.obj", across),
    ] {
        fs::write(folder.join(name), text).unwrap();
    }
    let little = ["--max-memory", "20000"];
    let draw = |form: &[&str], frame: &str| {
        let picture = ["--png", "a.png", "--frame", frame];
        check(folder, &[form, &little, &picture].concat())
    };
    for form in [&["--count"][..], &[], &["--quiet"]] {
        let alone = check(folder, &[form, &little].concat());
        let drawn = draw(form, "0");
        assert_eq!(
            (drawn.code, &drawn.out, &drawn.err),
            (1, &alone.out, &alone.err),
            "{form:?}"
        );
        draw(form, "1").assert_refused(&["frame 1", "--max-memory"]);
    }
}

#[test]
fn a_check_that_ends_early_has_a_page_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    sequence(folder);
    fs::write(folder.join("moves_2.obj"), "v 0 0\n").unwrap();
    check(folder, &["--count", "--report", "a.html"]).assert_refused(&["moves_2.obj"]);
    let head = head(folder, "a.html");
    assert_eq!(head["motions"][0]["pairs"], serde_json::json!([0, 1]));
    let note = head["plays"][0]["notes"][0].as_str().unwrap();
    assert!(
        note.starts_with("The check ended early")
            && note.contains("moves_2.obj")
            && note.ends_with("; mend it, or export it again."),
        "{note}"
    );
}

/// Page of the first experiment: 2 x 20,480 triangles, 200 steps.
#[test]
fn the_default_scene_fits_into_thirty_megabytes_and_no_step_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let said = pliant(
        folder.path(),
        &["run", "--report", "run.html", "--format", "json"],
    );
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    let json = said.json();
    let size = fs::metadata(folder.path().join("run.html")).unwrap().len();
    println!("the page: {:.1} MB", size as f64 / 1e6);
    assert!(size < 30_000_000, "{size} bytes");
    let head = head(folder.path(), "run.html");
    let motion = &head["motions"][0];
    assert_eq!(motion["frames"].as_array().unwrap().len(), 200);
    assert_eq!(
        (&motion["pairs"], &motion["numbers"]),
        (&json["pairs"], &json["step"])
    );
    // Times equal the JSON's, step by step.
    let chart = &head["plays"][0]["charts"][0];
    assert_eq!(
        (&chart["lines"][1]["values"], &chart["lines"][2]["values"]),
        (&json["query_ms"], &json["update_ms"])
    );
    assert!(chart["svg"].as_str().unwrap().starts_with("<svg"));
}

#[test]
fn a_first_pair_and_a_body_with_itself_are_shown_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (scene, query, triangles) in [
        ("spheres", "first", "320"),
        ("cloth", "self", "1922"),
        ("gather", "all", "80"),
    ] {
        let run = [
            "run",
            scene,
            "--query",
            query,
            "--triangles",
            triangles,
            "--stride",
            "5",
            "--precision",
            "f64",
        ];
        let said = pliant(
            folder,
            &[&run[..], &["--format", "json", "--report", "a.html"]].concat(),
        );
        assert_eq!(said.code, 0, "{}", said.err);
        let pairs = &head(folder, "a.html")["motions"][0]["pairs"];
        assert_eq!(*pairs, said.json()["pairs"], "{scene}");
        assert!(
            pairs
                .as_array()
                .unwrap()
                .iter()
                .any(|count| count.as_u64() > Some(0)),
            "{scene}"
        );
    }
}

#[test]
fn experiments_have_a_page_and_charts() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // All pairs and the first pair of one motion share a picture. Without peers, no experiment has
    // both.
    let (experiment, motions, chart) = if cfg!(feature = "peers") {
        let chart = "experiment-1-figure-3a-all-pairs-both.svg";
        ("experiment-1", [0, 0, 1], chart)
    } else {
        ("splits", [0, 1, 2], "splits-splits-on-arms-both.svg")
    };
    let bench = ["bench", experiment, "--small", "--rounds", "1"];
    let files = ["--json", "a.json", "--report", "a.html", "--svg", "charts"];
    let said = pliant(folder, &[&bench[..], &files].concat());
    assert_eq!(said.code, 0, "{}", said.err);
    let record: Value = serde_json::from_slice(&fs::read(folder.join("a.json")).unwrap()).unwrap();
    let contests = record["experiments"][0]["contests"].as_array().unwrap();
    let head = head(folder, "a.html");
    let plays = head["plays"].as_array().unwrap();
    assert_eq!(plays.len(), contests.len());
    let shown = [0, 1, 2].map(|play: usize| plays[play]["motion"].as_u64());
    assert_eq!(shown, motions.map(Some));
    for (play, contest) in plays.iter().zip(contests) {
        let motion = &head["motions"][play["motion"].as_u64().unwrap() as usize];
        assert_eq!(
            (&motion["pairs"], &motion["numbers"]),
            (&contest["pairs"], &contest["steps"])
        );
        let lines = play["charts"][1]["lines"].as_array().unwrap();
        let methods = contest["methods"].as_array().unwrap();
        for (line, method) in lines.iter().zip(methods) {
            assert_eq!(
                (&line["name"], &line["values"]),
                (&method["name"], &method["update_ms"])
            );
        }
        assert_eq!(lines.len(), methods.len());
    }
    let mut charts: Vec<_> = fs::read_dir(folder.join("charts"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    charts.sort();
    assert_eq!(charts.len(), 9);
    assert!(charts[0].ends_with(chart), "{}", charts[0].display());
    for chart in charts {
        assert!(fs::read_to_string(chart).unwrap().contains("<polyline"));
    }
}

#[test]
fn pages_and_pictures_have_what_is_left_of_the_pairs() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    sequence(folder);
    let scene = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../pliant-io/tests/fixtures/hierarchy.gltf")
        .display()
        .to_string();
    let looked_at = |arguments: &[&str]| {
        // A frame in which intersections can be seen.
        let frame = if arguments[0] == scene { "11" } else { "1" };
        let pictures = ["--report", "a.html", "--png", "a.png", "--frame", frame];
        let said = pliant(folder, &[&["check"], arguments, &pictures].concat());
        assert!(said.code < 2, "{arguments:?}: {}", said.err);
        let head = head(folder, "a.html");
        (said, head, fs::read(folder.join("a.png")).unwrap())
    };
    let files = &["still.obj", "moves_*.obj"][..];
    let (plain, of_scene) = (
        looked_at(files),
        looked_at(&[&scene, "--self", "--clip", "turn", "--fps", "10"]),
    );
    assert_eq!(
        of_scene.1["motions"][0]["bodies"].as_array().unwrap().len(),
        4
    );
    let ground = format!("{scene}#ground");
    assert_eq!(
        of_scene.1["motions"][0]["bodies"][3]["name"],
        ground.as_str()
    );
    for (bodies, rules, differs) in [
        (files, &[][..], false),
        (files, &["--baseline", "2"], true),
        (files, &["--ignore", "0,1"], true),
        (files, &["--split", "components"], false),
        (&[&scene], &[], false),
        (&[&scene], &["--baseline", "11"], true),
        (&[&scene], &["--ignore", &format!("{scene},{scene}")], true),
        (&[&scene], &["--split", "components"], false),
    ] {
        let (of_plain, clip) = if bodies.len() == 1 {
            (&of_scene, &["--self", "--clip", "turn", "--fps", "10"][..])
        } else {
            (&plain, &[][..])
        };
        let json = [bodies, clip, rules, &["--format", "json"]].concat();
        let (said, page, picture) = looked_at(&json);
        let counts = said.counts();
        assert_eq!(
            page["motions"][0]["pairs"],
            serde_json::json!(counts),
            "{json:?}"
        );
        // Pieces have the same red triangles; what is left out is not red.
        assert_eq!(picture != of_plain.2, differs, "{json:?}");
        // Apart from the names of pieces, the page is as without `--split`.
        let unsplit = |page: &Value| {
            let mut bodies = page["motions"][0]["bodies"].clone();
            for body in bodies.as_array_mut().unwrap() {
                body["parts"].take();
                body["number"].take();
            }
            bodies
        };
        assert_eq!(unsplit(&page), unsplit(&of_plain.1), "{json:?}");
        // Nothing printed: still all pairs.
        let quiet = [bodies, clip, rules, &["--quiet"]].concat();
        let (said, page, same) = looked_at(&quiet);
        assert_eq!(
            (said.out, &page["motions"][0]["pairs"]),
            (String::new(), &serde_json::json!(counts))
        );
        assert!(same == picture, "{quiet:?}");
    }
}

#[test]
fn places_of_solids_have_depths_on_the_page_and_nothing_else_changes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let tetrahedron = |corners: [[f64; 3]; 4]| {
        let corners = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n"));
        format!("{}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", corners.concat())
    };
    let write = |name: &str, text: String| fs::write(folder.join(name), text).unwrap();
    let still = [0.0, 8.0].map(|x| [x, 0.0, 0.0]);
    let still = [still[0], still[1], [0.0, 8.0, 0.0], [0.0, 0.0, 8.0]];
    write("still.obj", tetrahedron(still));
    // From below a tip goes into it, and further in the next frame.
    for (frame, z) in [-0.5, 0.25, 0.75].into_iter().enumerate() {
        let [a, b, c] = [[1.5, 1.5], [2.5, 1.5], [2.0, 2.5]].map(|[x, y]| [x, y, z - 2.0]);
        let tip = tetrahedron([a, b, c, [2.0, 2.0, z]]);
        write(&format!("moves_{frame}.obj"), tip);
    }
    let page = |name: &str, solid: &[&str]| {
        let asked = ["--format", "json", "--report", name];
        let said = check(folder, &[&asked[..], solid].concat());
        assert_eq!(said.code, 1, "{}", said.err);
        (said.json(), head(folder, name))
    };
    let (said, mut with) = page("with.html", &["--solid"]);
    let (_, mut without) = page("without.html", &[]);
    assert_eq!(with["motions"][0]["depths"].take(), json!([0.25, 0.75]));
    for frame in [1, 2] {
        let depth = with["motions"][0]["places"][frame][0][5].take();
        assert_eq!(depth, said["frames"][frame]["places"][0]["depth"]);
        assert!(depth.is_number());
    }
    let note = with["plays"][0]["notes"].take();
    assert!(note[0].as_str().unwrap().contains("its depth"), "{note}");
    assert_eq!(without["plays"][0]["notes"].take(), json!([]));
    with["asked"].take();
    without["asked"].take();
    assert_eq!(with, without);
}

#[test]
fn pieces_and_groups_are_bodies_of_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.2 0.2 1\nv 0.3 0.4 1\n";
    let text = format!("{corners}o a\nf 1 2 3\no <b\nf 4 5 6\n");
    fs::write(folder.join("two.obj"), &text).unwrap();
    fs::write(
        folder.join("one.obj"),
        "v 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\n",
    )
    .unwrap();
    let bodies = |arguments: &[&str]| {
        let said = pliant(
            folder,
            &[&["check"], arguments, &["--report", "a.html"]].concat(),
        );
        assert!(said.code < 2, "{}", said.err);
        let head = head(folder, "a.html");
        let facts = head["plays"][0]["facts"].clone();
        let bodies = head["motions"][0]["bodies"].as_array().unwrap().clone();
        let bodies = bodies
            .into_iter()
            .map(|body| (body["number"].clone(), body["parts"].clone()));
        (bodies.collect::<Vec<_>>(), facts)
    };
    let none = Value::Null;
    let (pieces, facts) = bodies(&["two.obj", "one.obj", "--split", "components"]);
    assert_eq!(
        pieces,
        [(0.into(), json!(["1", "2"])), (2.into(), json!(["1"]))]
    );
    assert!(facts.as_array().unwrap().contains(&json!(["pieces", "3"])));
    let (groups, _) = bodies(&["two.obj", "one.obj", "--split", "groups"]);
    assert_eq!(
        groups,
        [(0.into(), json!(["a", "<b"])), (2.into(), none.clone())]
    );
    // The other group is a part without a name.
    let (some, facts) = bodies(&["one.obj", "two.obj#<b"]);
    assert_eq!(some, [(0.into(), none.clone()), (1.into(), json!(["<b"]))]);
    assert!(facts.as_array().unwrap().contains(&json!(["groups", "2"])));
    let (whole, _) = bodies(&["two.obj", "one.obj"]);
    assert_eq!(whole, [(0.into(), none.clone()), (1.into(), none)]);
}

#[test]
fn all_that_meets_on_the_way_is_on_the_page() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // A leaf falls through a floor, on which it lies in no frame, whatever is printed.
    fs::write(
        folder.join("floor.obj"),
        "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n",
    )
    .unwrap();
    for (frame, z) in [3.0, -7.0, -7.0].into_iter().enumerate() {
        let text = format!("v 0 0 {z}\nv 1 0 {z}\nv 0 1 {}\nf 1 2 3\n", z + 5.0);
        fs::write(folder.join(format!("leaf_{frame}.obj")), text).unwrap();
    }
    let swept = ["check", "leaf_*.obj", "floor.obj", "--swept"];
    let moments = |more: &[&str]| {
        let report = ["--report", "a.html"];
        let alone = pliant(folder, &[&swept[..], more].concat());
        let said = pliant(folder, &[&swept[..], more, &report].concat());
        assert_eq!((said.code, &said.out), (alone.code, &alone.out), "{more:?}");
        head(folder, "a.html")["motions"][0]["moments"].clone()
    };
    let json = pliant(folder, &[&swept[..], &["--format", "json"]].concat()).json();
    let impacts = json["frames"][1]["vertex_triangle"].as_array().unwrap();
    assert_eq!(impacts.len(), 3);
    // Time, and the numbers of the elements.
    let contact = |row: &Value| json!([row[5], row[0], row[1], row[2], row[3]]);
    let mut contacts: Vec<Value> = impacts.iter().map(contact).collect();
    contacts.sort_by(|a, b| a[0].as_f64().unwrap().total_cmp(&b[0].as_f64().unwrap()));
    for more in [
        &[][..],
        &["--count"],
        &["--quiet"],
        &["--format", "json"],
        &["--format", "json", "--count"],
    ] {
        let moment = json!({"until": 1, "count": 3, "contacts": contacts});
        assert_eq!(moments(more), json!([null, moment, null, null]), "{more:?}");
    }
    // With `--first`, the number of other contacts is unknown.
    let first = json!({"until": 1, "count": null, "contacts": [contacts[0]]});
    assert_eq!(moments(&["--first"]), json!([null, first, null, null]));
}

#[test]
fn of_meshes_that_change_frames_of_all_the_way_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let run = ["run", "tear", "--triangles", "20000", "--format", "json"];
    let said = pliant(folder, &[&run[..], &["--report", "a.html"]].concat());
    assert_eq!(said.code, 0, "{}", said.err);
    let head = head(folder, "a.html");
    let motion = &head["motions"][0];
    let (pairs, places) = (&motion["pairs"], motion["frames"].as_array().unwrap());
    let pairs: Vec<u64> = pairs
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n.as_u64().unwrap())
        .collect();
    let places: Vec<usize> = places
        .iter()
        .map(|n| n.as_u64().unwrap() as usize)
        .collect();
    assert!(places.len() < 200 && pairs.len() == 250);
    let first = pairs.iter().position(|&count| count > 0).unwrap();
    let most = *pairs.iter().max().unwrap();
    let worst = pairs.iter().position(|&count| count == most).unwrap();
    assert!(
        [0, first, worst, 249]
            .iter()
            .all(|place| places.contains(place)),
        "{places:?}"
    );
    let widest = places.windows(2).map(|two| two[1] - two[0]).max();
    assert!(widest <= Some(16), "{places:?}");
    let note = format!(
        "The picture shows {} of 250 steps, since a page has room for 30 MiB of them; the first \
         contact, the step with the most pairs and the last are among them. All figures are of all \
         steps.",
        places.len()
    );
    assert_eq!(head["plays"][0]["notes"], json!([note]));
}
