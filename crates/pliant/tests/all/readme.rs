//! Documents that people read first.
//!
//! The README of the repository shows the example of the package's README, which is compiled and
//! run as documentation. The first screens say how debug builds become quick. Methods of `World`
//! are documented in the order in which users need them.

use std::fs;
use std::path::Path;

/// The blocks of Rust code in a text.
fn blocks(text: &str) -> Vec<&str> {
    let behind = text.split("```rust\n").skip(1);
    behind
        .map(|block| block.split_once("```").unwrap().0)
        .collect()
}

#[test]
fn both_readmes_show_the_same_code() {
    let package = blocks(include_str!("../../README.md"));
    assert_eq!(package.len(), 1);
    assert_eq!(blocks(include_str!("../../../../README.md")), package);
}

/// The package's README and the guide name the remedy for slow debug builds on their first screen.
#[test]
fn whoever_begins_is_told_of_debug_builds() {
    let first_screens = [
        include_str!("../../README.md"),
        include_str!("../../guide.md"),
    ];
    for text in first_screens {
        let screen: Vec<&str> = text.lines().take(48).collect();
        assert!(screen.contains(&"opt-level = 3"), "{screen:?}");
    }
}

/// The texts of the files of a module, each before the files that it declares.
fn texts(module: &Path) -> Vec<String> {
    let file = module.with_extension("rs");
    let file = if file.exists() {
        file
    } else {
        module.join("mod.rs")
    };
    let text = fs::read_to_string(file).unwrap();
    let declared = text.lines().filter_map(|line| {
        let (_, name) = line.strip_suffix(';')?.split_once("mod ")?;
        Some(texts(&module.join(name)))
    });
    let inner: Vec<_> = declared.flatten().collect();
    [vec![text], inner].concat()
}

/// Methods in the order of rustdoc: file by file, as modules declare them.
#[test]
fn worlds_are_documented_in_the_order_in_which_they_are_met() {
    let world = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/world");
    let begins = "impl<S: Scalar> World<S> {";
    let methods = |text: &str| -> Vec<String> {
        let lines = text.lines().map_while(|line| (line != "}").then_some(line));
        let names = lines.filter_map(|line| line.strip_prefix("    pub fn "));
        names
            .map(|name| name.split(['(', '<']).next().unwrap().to_owned())
            .collect()
    };
    let documented: Vec<String> = texts(&world)
        .iter()
        .flat_map(|text| -> Vec<String> {
            let blocks = text.split(begins).skip(1);
            blocks.flat_map(methods).collect()
        })
        .collect();
    let place = |name: &str| documented.iter().position(|it| it == name).unwrap();
    let met = [
        "new",
        "add",
        "set_positions",
        "intersections",
        "distance",
        "free_step",
        "set_filter",
        "edit",
        "components",
        "validate",
    ];
    assert!(met.map(place).is_sorted(), "{documented:?}");
}
