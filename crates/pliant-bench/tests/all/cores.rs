//! Many cores: small scenes are measured, and records keep to their schema.

use pliant_bench::cores::{COUNT, Record, measure};
use pliant_bench::machine::this_machine;
use std::fs;
use std::path::{Path, PathBuf};

fn benchmarks() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benchmarks")
}

#[test]
fn records_keep_to_the_schema() {
    let mut schemas = boon::Schemas::new();
    let file = benchmarks().join("cores.schema.json");
    let schema = boon::Compiler::new()
        .compile(file.to_str().unwrap(), &mut schemas)
        .unwrap();
    let check = |text: &str| {
        let record: serde_json::Value = serde_json::from_str(text).unwrap();
        if let Err(wrong) = schemas.validate(&record, schema) {
            panic!("{wrong}");
        }
    };
    let mut shown = 0;
    let all = measure(0.001, true, 1, &mut |_| shown += 1);
    assert_eq!((all.len(), shown), (COUNT, COUNT));
    for one in &all {
        assert!(one.work_ms >= one.span_ms && one.span_ms > 0.0);
    }
    let (machine, wait) = (this_machine(), 0.001);
    check(&serde_json::to_string(&Record::of(&machine, wait, &all)).unwrap());

    let records = fs::read_dir(benchmarks().join("records")).unwrap();
    let records = records.map(|entry| entry.unwrap().path());
    let is_ours = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.starts_with("cores-") && name.ends_with(".json")
    };
    let mut count = 0;
    for record in records.filter(is_ours) {
        check(&fs::read_to_string(record).unwrap());
        count += 1;
    }
    assert!(count > 0);
}
