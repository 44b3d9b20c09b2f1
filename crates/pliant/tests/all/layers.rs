//! Layers of the library: which folder may use which; arrows run one way.
//!
//! This is about structure, not style. Folders are listed from the bottom up. Each may use the
//! folders listed with it, which all stand before it. Within a folder, files beside each other do
//! not use each other in circles. Unit tests may use what they like.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder, or a file of the crate's root, and the folders that it may use.
const LAYERS: [(&str, &[&str]); 29] = [
    ("held", &[]),
    ("ids", &[]),
    ("options", &[]),
    ("statistics", &[]),
    ("threads", &["held"]),
    ("error", &["ids"]),
    ("edit", &["ids"]),
    ("selection", &["ids"]),
    ("labels", &[]),
    ("geometry", &["held", "ids"]),
    ("kernels", &["held", "ids", "geometry"]),
    (
        "mesh",
        &["held", "ids", "error", "edit", "kernels", "threads"],
    ),
    ("sort", &["held", "kernels", "threads"]),
    (
        "broad_phase",
        &["held", "ids", "options", "geometry", "kernels", "threads"],
    ),
    (
        "tree",
        &[
            "held", "ids", "options", "geometry", "kernels", "mesh", "threads",
        ],
    ),
    (
        "update",
        &[
            "held",
            "ids",
            "options",
            "statistics",
            "kernels",
            "threads",
            "tree",
        ],
    ),
    (
        "queries",
        &[
            "labels",
            "held",
            "ids",
            "statistics",
            "geometry",
            "kernels",
            "mesh",
            "sort",
            "threads",
            "tree",
        ],
    ),
    (
        "traversal",
        &[
            "held",
            "ids",
            "statistics",
            "geometry",
            "kernels",
            "mesh",
            "threads",
            "tree",
            "update",
            "queries",
        ],
    ),
    (
        "bodies",
        &[
            "labels",
            "held",
            "ids",
            "options",
            "error",
            "edit",
            "selection",
            "geometry",
            "kernels",
            "mesh",
            "threads",
            "tree",
            "queries",
            "traversal",
        ],
    ),
    (
        "collide",
        &[
            "held",
            "ids",
            "options",
            "statistics",
            "error",
            "selection",
            "geometry",
            "kernels",
            "sort",
            "broad_phase",
            "threads",
            "tree",
            "update",
            "queries",
            "traversal",
            "bodies",
        ],
    ),
    (
        "all_pairs",
        &["bodies", "error", "geometry", "labels", "mesh"],
    ),
    (
        "points",
        &[
            "held",
            "ids",
            "statistics",
            "error",
            "geometry",
            "kernels",
            "threads",
            "tree",
            "update",
            "queries",
            "traversal",
            "bodies",
            "collide",
        ],
    ),
    (
        "world",
        &[
            "labels",
            "held",
            "ids",
            "options",
            "statistics",
            "error",
            "edit",
            "selection",
            "geometry",
            "kernels",
            "mesh",
            "threads",
            "tree",
            "queries",
            "traversal",
            "bodies",
            "collide",
            "points",
            "all_pairs",
        ],
    ),
    (
        "pairs",
        &[
            "error", "geometry", "kernels", "queries", "threads", "world",
        ],
    ),
    ("changes", &["ids", "edit", "queries", "world"]),
    ("curves", &["ids", "error", "queries", "world"]),
    (
        "feature_pairs",
        &[
            "ids",
            "error",
            "geometry",
            "queries",
            "selection",
            "threads",
            "world",
        ],
    ),
    ("hit_rows", &["ids", "error", "queries", "world"]),
    ("lib", &[]),
];

/// Names that the root exports, and the folder that defines each.
const EXPORTED: [(&str, &str); 32] = [
    ("BodyId", "ids"),
    ("BroadPhase", "options"),
    ("CloseEdgeEdge", "queries"),
    ("CloseVertexTriangle", "queries"),
    ("ClosestFeatures", "queries"),
    ("Contact", "queries"),
    ("ContactKind", "queries"),
    ("Degree", "options"),
    ("EdgeEdge", "queries"),
    ("EdgeEdgeImpact", "queries"),
    ("Edit", "edit"),
    ("Edited", "edit"),
    ("Error", "error"),
    ("ErrorKind", "error"),
    ("Impact", "queries"),
    ("Instructions", "kernels"),
    ("NodeBox", "bodies"),
    ("Options", "options"),
    ("Pair", "queries"),
    ("Partition", "options"),
    ("Query", "world"),
    ("Scalar", "world"),
    ("Selection", "selection"),
    ("Statistics", "statistics"),
    ("TreeShape", "bodies"),
    ("Update", "options"),
    ("VertexTriangle", "queries"),
    ("VertexTriangleImpact", "queries"),
    ("World", "world"),
    ("edge_edge_impacts", "pairs"),
    ("kernels", "kernels"),
    ("vertex_triangle_impacts", "pairs"),
];

/// Structs of `bodies` with visible fields, and the reason; all other structs keep theirs private.
const RECORDS: [(&str, &str); 3] = [
    (
        "NewShape",
        "an argument: the mesh makes it, the shape takes it",
    ),
    ("NodeBox", "shown to the caller"),
    ("TreeShape", "shown to the caller"),
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// All files below a folder, and their code without comments and unit tests.
fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(files(&path));
        } else {
            let text = fs::read_to_string(&path).unwrap();
            let end = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
            let code = text[..end].lines();
            let code = code.filter(|line| !line.trim_start().starts_with("//"));
            all.push((path, code.collect::<Vec<_>>().join("\n")));
        }
    }
    all
}

/// Names behind a prefix such as `crate::`, each once, names in braces included.
fn names_behind(prefix: &str, code: &str) -> BTreeSet<String> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let first = |text: &str| text.chars().take_while(|&c| is_part(c)).collect::<String>();
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices(prefix) {
        // Not `super::super::`, and not a longer word.
        if code[..at].ends_with("::") || code[..at].ends_with(is_part) {
            continue;
        }
        let rest = &code[at + prefix.len()..];
        let Some(list) = rest.strip_prefix('{') else {
            names.insert(first(rest));
            continue;
        };
        let (mut depth, mut item) = (0, String::new());
        for c in list.chars() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    names.insert(first(item.trim()));
                    item.clear();
                    continue;
                }
                _ => {}
            }
            item.push(c);
        }
        names.insert(first(item.trim()));
    }
    names.remove("");
    names
}

/// The folder or file of the crate's root that a file is in.
fn layer_of(path: &Path) -> String {
    let relative = path.strip_prefix(source()).unwrap();
    let first = relative.components().next().unwrap();
    let name = Path::new(first.as_os_str()).file_stem().unwrap();
    name.to_str().unwrap().to_owned()
}

#[test]
fn folders_use_what_stands_below_them() {
    let mut below = BTreeSet::new();
    for (layer, uses) in LAYERS {
        assert!(uses.iter().all(|used| below.contains(used)), "{layer}");
        below.insert(layer);
    }
    let exported: BTreeMap<_, _> = EXPORTED.into_iter().collect();
    for (path, code) in files(&source()) {
        let layer = layer_of(&path);
        if layer == "lib" {
            continue;
        }
        let (_, uses) = LAYERS
            .into_iter()
            .find(|(name, _)| *name == layer)
            .unwrap_or_else(|| panic!("{layer} is not in the list: say what it may use"));
        for name in names_behind("crate::", &code) {
            let used = exported.get(name.as_str()).copied().unwrap_or(&name);
            assert!(
                used == layer || uses.contains(&used),
                "{}: {layer} may not use {used}",
                path.display()
            );
        }
    }
}

#[test]
fn the_degree_of_trees_is_a_type_in_no_folder_above_them() {
    let mut found = BTreeSet::new();
    for (path, code) in files(&source()) {
        if code.contains("const N: usize") {
            let inside = path.strip_prefix(source()).unwrap();
            found.insert(inside.iter().next().unwrap().to_str().unwrap().to_owned());
        }
    }
    let below = ["kernels", "tree", "update"].map(str::to_owned);
    assert_eq!(found, BTreeSet::from(below));
}

#[test]
fn nobody_sees_the_fields_of_a_body_nor_of_what_it_is_made_of() {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let mut seen = BTreeSet::new();
    for (path, code) in files(&source().join("bodies")) {
        for (at, word) in code.match_indices("struct ") {
            let item = &code[at + word.len()..];
            let open = item.find(['{', '(', ';']).unwrap();
            let close = if item[open..].starts_with('{') {
                "\n}"
            } else {
                ";"
            };
            let end = open + item[open..].find(close).unwrap();
            let mut words = item[..end].split(|c| !is_part(c));
            let name = words.next().unwrap();
            if words.any(|word| word == "pub") {
                let is_record = RECORDS.iter().any(|&(record, _)| record == name);
                assert!(is_record, "{}: fields of {name}", path.display());
                seen.insert(name.to_owned());
            }
        }
    }
    assert!(
        RECORDS.iter().all(|&(name, _)| seen.contains(name)),
        "{seen:?}"
    );
}

#[test]
fn files_beside_each_other_use_each_other_in_no_circle() {
    let mut folders: BTreeMap<PathBuf, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for (path, code) in files(&source()) {
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let folder = path.parent().unwrap().to_owned();
        let uses = names_behind("super::", &code);
        folders.entry(folder).or_default().insert(name, uses);
    }
    for (folder, mut files) in folders {
        // A name that the parent exports from a file is no name of a file, so it is left out here.
        files.remove("mod");
        let there: BTreeSet<_> = files.keys().cloned().collect();
        for uses in files.values_mut() {
            uses.retain(|used| there.contains(used));
        }
        while !files.is_empty() {
            let free = files.iter().find(|(_, uses)| uses.is_empty());
            let Some(free) = free.map(|(name, _)| name.clone()) else {
                panic!("{}: in a circle: {files:?}", folder.display());
            };
            files.remove(&free);
            files.values_mut().for_each(|uses| {
                uses.remove(&free);
            });
        }
    }
}

#[test]
fn one_folder_knows_instruction_sets_and_one_knows_thread_pools() {
    for (path, code) in files(&source()) {
        let layer = layer_of(&path);
        assert!(
            layer == "kernels" || !code.contains("fearless_simd"),
            "{}",
            path.display()
        );
        // The public interface takes a rayon pool from the application and hands it on.
        let hands_on = layer == "threads" || layer == "world";
        assert!(hands_on || !code.contains("rayon"), "{}", path.display());
    }
}
