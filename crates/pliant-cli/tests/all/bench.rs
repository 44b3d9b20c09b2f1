//! End-to-end tests of `pliant bench`, in small form.

use crate::common::pliant;

#[test]
fn an_experiment_prints_tables_and_writes_a_record() {
    let words = [
        "== degrees (small form",
        "pliant, paper: degree 8",
        "van den Bergen, world frame, 8-ary",
        "times faster",
    ];
    prints_tables_and_writes_a_record("degrees", &words);
}

#[cfg(feature = "peers")]
#[test]
fn an_experiment_with_other_libraries_does_too() {
    let words = [
        "== cloth (small form",
        "parry3d",
        "obvhs, 4 a leaf",
        "times faster",
        "measured",
    ];
    prints_tables_and_writes_a_record("cloth", &words);
}

#[cfg(not(feature = "peers"))]
#[test]
fn what_needs_other_libraries_says_how_they_come_in() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["cloth", "peers", "all"] {
        let command = format!("cargo run --release --features peers -- bench {name}`");
        let said = pliant(folder.path(), &["bench", name, "--json", "record.json"]);
        said.assert_refused(&["other libraries", &command]);
    }
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
    let help = pliant(folder.path(), &["bench", "--help"]).out;
    for line in ["* peers ", "* all ", "  table-1 ", "--features peers"] {
        assert!(help.contains(line), "{line}: {help}");
    }
}

fn prints_tables_and_writes_a_record(name: &str, words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let said = pliant(
        folder.path(),
        &[
            "bench",
            name,
            "--small",
            "--rounds",
            "1",
            "--json",
            "record.json",
        ],
    );
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    for word in words {
        assert!(said.out.contains(word), "{word}: {}", said.out);
    }
    let record = std::fs::read_to_string(folder.path().join("record.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    assert_eq!(
        (&record["format"], &record["experiments"][0]["experiment"]),
        (&1.into(), &name.into())
    );
}

#[test]
fn what_cannot_be_run_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    pliant(folder.path(), &["bench", "experiment-2"]).assert_refused(&[
        "experiment-2",
        "table-1",
        "all",
    ]);
    pliant(
        folder.path(),
        &[
            "bench",
            "splits",
            "--small",
            "--json",
            "no/such/folder.json",
        ],
    )
    .assert_refused(&["no/such/folder.json"]);
    assert_eq!(pliant(folder.path(), &["bench"]).code, 2);
    let help = pliant(folder.path(), &["bench", "--help"]);
    assert!(
        help.out.contains("experiment-3") && help.out.contains("figure 4"),
        "{}",
        help.out
    );
}
