//! First screens: READMEs show the same compiled example, and beginners are told of debug builds.
//!
//! Methods of `World` come in sections, in the order in which they are met.

use std::fs;
use std::path::Path;

/// Blocks of Rust in a text.
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

/// Checks the first page of the guide, and of the crate's documentation.
#[test]
fn whoever_begins_is_told_of_debug_builds() {
    let first_screens = [
        include_str!("../../README.md"),
        include_str!("../../guide/first_contact.md"),
    ];
    for text in first_screens {
        let screen: Vec<&str> = text.lines().take(48).collect();
        assert!(screen.contains(&"opt-level = 3"), "{screen:?}");
    }
}

/// A section of the page of `World`: an `impl` block with its heading, and its public methods.
struct Section {
    heading: String,
    methods: Vec<String>,
}

/// Adds the sections of a module and its submodules, in the order in which rustdoc lists them.
///
/// That is the order of declarations, from top to bottom.
fn add_sections(file: &Path, sections: &mut Vec<Section>) {
    let text = fs::read_to_string(file).unwrap();
    let (mut heading, mut is_hidden, mut is_world) = ("", false, false);
    for line in text.lines() {
        let declared = line.trim_start_matches("pub(super) ");
        let declared = declared.trim_start_matches("pub(crate) ");
        let module = declared.strip_prefix("mod ");
        if let Some(name) = module.and_then(|rest| rest.strip_suffix(';')) {
            let folder = match file.file_stem().unwrap().to_str().unwrap() {
                "mod" => file.parent().unwrap().to_owned(),
                _ => file.with_extension(""),
            };
            let files = [format!("{name}.rs"), format!("{name}/mod.rs")];
            let mut files = files.iter().map(|name| folder.join(name));
            add_sections(&files.find(|file| file.exists()).unwrap(), sections);
        } else if let Some(said) = line.strip_prefix("/// # ") {
            heading = said;
        } else if line == "impl<S: Scalar> World<S> {" {
            is_world = true;
            sections.push(Section {
                heading: heading.to_owned(),
                methods: Vec::new(),
            });
        } else if line == "}" {
            (heading, is_world) = ("", false);
        } else if line == "    #[doc(hidden)]" {
            is_hidden = true;
        } else if let Some(rest) = line.strip_prefix("    pub fn ").filter(|_| is_world) {
            let name = rest.split(['(', '<']).next().unwrap();
            let section = sections.last_mut().unwrap();
            section
                .methods
                .extend((!is_hidden).then(|| name.to_owned()));
            is_hidden = false;
        }
    }
}

#[test]
fn worlds_are_documented_in_the_order_in_which_they_are_met() {
    let world = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/world");
    let mut sections = Vec::new();
    add_sections(&world.join("mod.rs"), &mut sections);
    sections.retain(|section| !section.methods.is_empty());

    let topic = |section: &Section| section.heading.split(':').next().unwrap().to_owned();
    let mut topics: Vec<String> = sections.iter().map(topic).collect();
    topics.dedup();
    let met = [
        "New",
        "Bodies",
        "Questions",
        "Motions",
        "Change",
        "Settings",
        "Looking inside",
    ];
    assert_eq!(topics, met);

    let documented: Vec<String> = sections.into_iter().flat_map(|it| it.methods).collect();
    let place = |name: &str| documented.iter().position(|it| it == name).unwrap();
    let met = [
        "new",
        "add",
        "set_positions",
        "intersections",
        "contacts",
        "vertex_triangle_candidates",
        "close_vertex_triangle_pairs",
        "vertex_triangle_impacts",
        "distance",
        "set_motion",
        "free_step",
        "edit",
        "components",
        "set_filter",
        "validate",
    ];
    assert!(met.map(place).is_sorted(), "{documented:?}");
}
