//! `pliant bench` from end to end, in small form.

use crate::common::pliant;

#[test]
fn an_experiment_prints_tables_and_writes_a_record() {
    let folder = tempfile::tempdir().unwrap();
    let said = pliant(
        folder.path(),
        &[
            "bench",
            "cloth",
            "--small",
            "--rounds",
            "1",
            "--json",
            "record.json",
        ],
    );
    assert_eq!((said.code, said.err.as_str()), (0, ""));
    for word in [
        "== cloth (small form",
        "parry3d",
        "obvhs, 4 a leaf",
        "times faster",
        "measured",
    ] {
        assert!(said.out.contains(word), "{word}: {}", said.out);
    }
    let record = std::fs::read_to_string(folder.path().join("record.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    assert_eq!(
        (&record["format"], &record["experiments"][0]["experiment"]),
        (&1.into(), &"cloth".into())
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
        &["bench", "cloth", "--small", "--json", "no/such/folder.json"],
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
