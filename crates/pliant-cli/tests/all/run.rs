//! End-to-end tests of `pliant run`.

use crate::common::{Said, pliant};
use serde_json::Value;
use std::path::Path;

fn run(arguments: &[&str]) -> Said {
    pliant(Path::new("."), &[&["run"], arguments].concat())
}

/// The JSON object without its times.
fn without_times(said: &Said) -> Value {
    let mut json = said.json();
    let object = json.as_object_mut().unwrap();
    assert!(object.remove("update_ms").is_some() && object.remove("query_ms").is_some());
    json
}

#[test]
fn the_default_scene_is_the_first_experiment() {
    let said = run(&["--stride", "20", "--format", "json"]);
    assert_eq!(
        (said.code, said.err.as_str()),
        (0, ""),
        "no progress where there is no terminal"
    );
    let json = said.json();
    assert_eq!(
        (&json["scene"], &json["triangles"], &json["bodies"]),
        (&"spheres".into(), &20_480.into(), &2.into())
    );
    assert_eq!(
        (&json["degree"], &json["partition"], &json["update"]),
        (&8.into(), &"balanced".into(), &"hybrid".into())
    );
    assert_eq!(
        (&json["query"], &json["broad"], &json["precision"]),
        (&"all".into(), &"auto".into(), &"f32".into())
    );
    assert_eq!(
        (&json["steps"], &json["stride"], &json["level"]),
        (&200.into(), &20.into(), &Value::Null)
    );
    assert_eq!(json["first_contact"], 60);
    assert_eq!(json["step"], (1..=10).map(|i| 20 * i).collect::<Value>());
    assert_eq!(json["pairs"][9], 3742);
    for list in ["pairs", "update_ms", "query_ms"] {
        assert_eq!(json[list].as_array().unwrap().len(), 10, "{list}");
    }
    let found: u64 = json["pairs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|pairs| pairs.as_u64().unwrap())
        .sum();
    assert_eq!(json["statistics"]["pairs"], found);
}

#[test]
fn no_option_changes_the_pairs() {
    let small = ["--triangles", "1280", "--stride", "25", "--format", "json"];
    let pairs = |more: &[&str]| run(&[&small, more].concat()).json()["pairs"].clone();
    let expected = pairs(&[]);
    assert!(expected[7].as_u64().unwrap() > 500);
    for more in [
        &["--degree", "2", "--partition", "centre", "--leaf-size", "1"][..],
        &[
            "--degree",
            "4",
            "--partition",
            "mean",
            "--update",
            "bottom-up",
        ],
        &["--update", "top-down", "--broad", "sweep"],
        &["--level", "1", "--broad", "brute"],
        &["--precision", "f64"],
    ] {
        assert_eq!(pairs(more), expected, "{more:?}");
    }
    let first = pairs(&["--query", "first"]);
    let some: Value = expected
        .as_array()
        .unwrap()
        .iter()
        .map(|pairs| u64::from(pairs.as_u64().unwrap() > 0))
        .collect();
    assert_eq!(first, some);
}

#[test]
fn two_runs_say_the_same() {
    let arguments = [
        "crowd",
        "--triangles",
        "320",
        "--steps",
        "12",
        "--stride",
        "4",
        "--format",
        "json",
    ];
    assert_eq!(
        without_times(&run(&arguments)),
        without_times(&run(&arguments))
    );
}

#[test]
fn every_scene_plays() {
    for (scene, triangles, query) in [
        ("spheres", "320", "all"),
        ("crowd", "320", "all"),
        ("arms", "1280", "all"),
        ("gather", "80", "all"),
        ("cloth", "648", "self"),
    ] {
        let said = run(&[
            scene,
            "--triangles",
            triangles,
            "--stride",
            "25",
            "--format",
            "json",
        ]);
        assert_eq!(said.code, 0, "{}", said.err);
        assert_eq!(
            (&said.json()["scene"], &said.json()["query"]),
            (&scene.into(), &query.into())
        );
        let table = run(&[scene, "--triangles", triangles, "--stride", "50"]);
        for word in [
            "first contact",
            "pairs at step",
            "slowest step",
            "update",
            "query",
            "median",
            "boxes made top-down",
        ] {
            assert!(table.out.contains(word), "{word}: {}", table.out);
        }
    }
}

#[test]
fn what_cannot_be_played_is_explained() {
    run(&["sphere"]).assert_refused(&["sphere", "spheres", "cloth"]);
    run(&["--triangles", "20000"]).assert_refused(&["16384", "20480"]);
    run(&["cloth", "--steps", "51"]).assert_refused(&["50"]);
    run(&["--steps", "10", "--stride", "11"]).assert_refused(&["--stride 11"]);
    run(&["--update", "top-down", "--level", "2"]).assert_refused(&["--level", "hybrid"]);
    for wrong in [
        ["--degree", "3"],
        ["--partition", "median"],
        ["--query", "none"],
        ["--leaf-size", "0"],
        ["--steps", "0"],
    ] {
        let said = run(&wrong);
        assert_eq!(said.code, 2, "{wrong:?}");
        assert!(said.err.contains(wrong[0]), "{}", said.err);
    }
}
