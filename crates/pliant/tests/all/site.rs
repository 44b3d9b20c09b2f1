//! The site's pages: every block of code is compiled or run somewhere, and no link leads nowhere.
//!
//! `site/README.md` has the rule as a table. Here its half is held that needs no build: where a
//! block comes from. `site/build` runs commands, and looks at links between finished pages.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

fn workspace() -> PathBuf {
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    above.canonicalize().unwrap()
}

fn read(path: &str) -> String {
    fs::read_to_string(workspace().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The targets of inline links outside of code.
fn links(text: &str) -> Vec<String> {
    let prose: String = text.split("\n```").step_by(2).collect();
    let targets = prose.split("](").skip(1);
    targets
        .map(|rest| rest[..rest.find(')').unwrap()].to_owned())
        .collect()
}

/// The file that a link of a file leads to, from the root of the workspace; without the place.
fn leads_to(file: &str, link: &str) -> PathBuf {
    let folder = Path::new(file).parent().unwrap();
    let target = link.split('#').next().unwrap();
    let path = workspace().join(folder).join(target);
    let path = path
        .canonicalize()
        .unwrap_or_else(|_| panic!("{file}: {link} leads nowhere"));
    path.strip_prefix(workspace()).unwrap().to_owned()
}

/// All pages of the site, as files of the workspace.
fn pages() -> Vec<String> {
    let summary = "site/pages/SUMMARY.md";
    let pages = links(&read(summary));
    let page = |link: &String| leads_to(summary, link).to_str().unwrap().to_owned();
    pages.iter().map(page).collect()
}

/// The rest of each comment of a page that begins with a word.
fn asked<'t>(text: &'t str, word: &str) -> Vec<&'t str> {
    let start = format!("<!-- {word} ");
    let rests = text
        .match_indices(&start)
        .map(|(at, _)| &text[at + start.len()..]);
    rests
        .map(|rest| rest.split(" -->").next().unwrap())
        .collect()
}

/// Language and lines of each block of code.
fn blocks(text: &str) -> Vec<(String, Vec<String>)> {
    let mut blocks = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let code = lines.by_ref().take_while(|line| *line != "```");
            blocks.push((language.to_owned(), code.map(str::to_owned).collect()));
        }
    }
    blocks
}

/// Whether the lines follow each other in one of the texts, indented as you like.
fn is_part_of(code: &[String], texts: &[String]) -> bool {
    texts.iter().any(|text| {
        let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
        let code: Vec<&str> = code.iter().map(|line| line.trim_start()).collect();
        lines.windows(code.len()).any(|some| some == code)
    })
}

/// Texts of all files of a folder that end so.
fn texts(folder: &str, end: &str) -> Vec<String> {
    let entries = fs::read_dir(workspace().join(folder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.extension().is_some_and(|it| it == end))
        .map(|path| fs::read_to_string(path).unwrap())
        .collect()
}

/// The fault of a block of a page, if it has one.
fn fault(page: &str, language: &str, code: &[String]) -> Option<&'static str> {
    let is_guide = page.starts_with("crates/pliant/guide/");
    let is_own = is_guide || page.starts_with("site/pages/");
    // Only the first program of the README is compiled.
    let readme = || vec![blocks(&read("bindings/c/README.md")).remove(0).1.join("\n")];
    let compiled = |end| {
        let of = |folder| texts(folder, end);
        [
            of("bindings/c/examples"),
            of("bindings/c/tests"),
            if end == "c" { readme() } else { vec![] },
        ]
        .concat()
    };
    let is_fine = match language {
        "rust" => is_guide,
        "toml" => is_part_of(code, &[read("crates/pliant/README.md")]),
        "c" => is_part_of(code, &compiled("c")),
        "cpp" => is_part_of(code, &compiled("cpp")),
        // The last is run by test_examples.py, from the page.
        "python" if page.ends_with("guide/change.md") => true,
        "python" => is_part_of(code, &[read("bindings/python/README.md")]),
        "sh" if is_own => true,
        "sh" => code.iter().all(|line| {
            let runs = ["pliant ", "python -"];
            let installs = ["cargo install ", "pip install "];
            runs.iter()
                .chain(&installs)
                .any(|word| line.starts_with(word))
        }),
        "text" => !is_guide,
        _ => false,
    };
    (!is_fine).then_some("nothing compiles or runs it")
}

#[test]
fn every_block_of_code_is_compiled_or_run() {
    let mut count = 0;
    let mut said = String::new();
    for page in pages() {
        for (language, code) in blocks(&read(&page)) {
            count += 1;
            if let Some(fault) = fault(&page, &language, &code) {
                writeln!(said, "{page}: {language}: {fault}\n{}", code.join("\n")).unwrap();
            }
        }
    }
    assert!(said.is_empty(), "{said}");
    assert!(count >= 50, "{count} blocks");
    // And a block that is nobody's is found.
    let nobodys = ["int main() { return 1; }".to_owned()];
    for language in ["c", "cpp", "python", "toml", "yaml", "", "rust,ignore"] {
        assert!(
            fault("crates/pliant/guide/near.md", language, &nobodys).is_some(),
            "{language}"
        );
    }
}

#[test]
fn what_pages_ask_for_is_there() {
    let gallery = read("site/pages/gallery.md");
    for page in pages() {
        let text = read(&page);
        for link in links(&text) {
            let is_path = !link.contains("://") && !link.contains("::") && !link.starts_with('#');
            let is_crate = ["crate", "pliant_exact"].contains(&link.split('#').next().unwrap());
            if is_path && !is_crate {
                leads_to(&page, &link);
            }
        }
        for name in asked(&text, "shown") {
            let drawn = workspace().join(format!("crates/pliant/pictures/{name}.svg"));
            let is_scene = gallery.contains(&format!("--report {name}.html"));
            assert!(is_scene || drawn.exists(), "{page}: {name}");
        }
        for section in asked(&text, "section") {
            let (file, heading) = section.split_once(' ').unwrap();
            let text = read(file);
            let mut headings = text.lines().filter(|line| line.starts_with('#'));
            let is_it = |line: &str| line.trim_start_matches('#').trim() == heading;
            assert!(headings.any(is_it), "{page}: {file} has no {heading:?}");
        }
    }
}

/// Parts of the guide: a file, a module, a page, and a line of its first page for each.
#[test]
fn all_parts_of_the_guide_are_everywhere() {
    let folder = workspace().join("crates/pliant/guide");
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let parts: BTreeSet<String> = names.filter(|name| name != "README.md").collect();
    assert!(parts.len() >= 10);

    let pages = pages();
    let (library, first) = (
        read("crates/pliant/src/lib.rs"),
        read("crates/pliant/guide/README.md"),
    );
    for part in parts {
        let module = part.strip_suffix(".md").unwrap();
        let title = read(&format!("crates/pliant/guide/{part}"));
        let title = title.lines().next().unwrap().strip_prefix("# ").unwrap();
        assert!(pages.contains(&format!("crates/pliant/guide/{part}")));
        assert!(first.contains(&format!("\n[{title}]: {part}\n")), "{part}");
        for line in [
            format!("/// [{title}]: crate::guide::{module}\n"),
            format!("    #[doc = include_str!(\"../guide/{part}\")]\n    pub mod {module} {{}}\n"),
        ] {
            assert!(library.contains(&line), "{line}");
        }
    }
}
