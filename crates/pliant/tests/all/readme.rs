//! The README of the repository shows the example of the package's, which is compiled and run as documentation.

/// The blocks of Rust in a text.
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
