//! No circle among modules, in any crate of the workspace.
//!
//! Beside each other stand the modules of a folder, its folders as wholes, and its own file. A
//! module uses another where its code names it, directly or by a name that a third one hands on. To
//! hand a name on is no use, and unit tests may use what they like. The code is read as words and
//! signs, not compiled: methods, and names that macros make, do not count. `layers.rs` says which
//! folder of the library may use which.
//!

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Path of a module in its crate: the names of the modules around it, then its own.
type Place = Vec<String>;

// Reading a file.

/// A file's code without comments, texts and unit tests.
struct Module {
    /// Words and signs, without `use` declarations.
    tokens: Vec<String>,
    imports: Vec<Import>,
}

/// One name that a `use` brings.
struct Import {
    /// The name in this module; `*` stands for all names of another module.
    name: String,
    path: Vec<String>,
    is_public: bool,
}

/// The words and signs of a file; `::` is one.
fn tokens(text: &str) -> Vec<String> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(length) = length_of_text(rest) {
            length
        } else {
            let length = if is_part(c) {
                rest.find(|c| !is_part(c)).unwrap_or(rest.len())
            } else if rest.starts_with("::") {
                2
            } else {
                c.len_utf8()
            };
            if !c.is_whitespace() {
                tokens.push(rest[..length].to_owned());
            }
            length
        };
        rest = &rest[length..];
    }
    tokens
}

/// Length of the text or character literal that begins here, if one does.
fn length_of_text(rest: &str) -> Option<usize> {
    let plain = rest.strip_prefix('b').unwrap_or(rest);
    let before = rest.len() - plain.len();
    if let Some(raw) = plain.strip_prefix('r') {
        let fence: String = raw.chars().take_while(|&c| c == '#').collect();
        if raw[fence.len()..].starts_with('"') {
            let start = before + 1 + fence.len() + 1;
            let end = format!("\"{fence}");
            return Some(start + rest[start..].find(&end)? + end.len());
        }
    }
    let quote = plain.chars().next().filter(|&c| c == '"' || c == '\'')?;
    let mut inner = plain.char_indices().skip(1);
    let mut is_escaped = false;
    while let Some((at, c)) = inner.next() {
        if c == '\\' {
            inner.next();
            is_escaped = true;
        } else if c == quote {
            return Some(before + at + 1);
        } else if quote == '\'' && !is_escaped && !plain[at + c.len_utf8()..].starts_with('\'') {
            return None; // A lifetime.
        }
    }
    None
}

/// Number of tokens from an opening bracket to the one that closes it.
fn length_in_brackets(tokens: &[String]) -> usize {
    let mut depth = 0;
    let ends = tokens.iter().position(|token| {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        depth == 0
    });
    ends.map_or(tokens.len(), |end| end + 1)
}

/// Number of tokens of the item or member of a list that begins here.
fn length_of_item(tokens: &[String]) -> usize {
    const ITEMS: [&str; 13] = [
        "pub", "fn", "use", "mod", "impl", "struct", "enum", "const", "static", "type", "trait",
        "unsafe", "let",
    ];
    let mut at = 0;
    while tokens[at] == "#" {
        at += 1 + length_in_brackets(&tokens[at + 1..]);
    }
    let is_item = ITEMS.contains(&tokens[at].as_str());
    let is_use = tokens[at..].iter().take(5).any(|token| token == "use");
    while at < tokens.len() {
        match tokens[at].as_str() {
            ";" => return at + 1,
            "," if !is_item => return at + 1,
            "{" if is_item && !is_use => return at + length_in_brackets(&tokens[at..]),
            "}" | ")" | "]" => return at,
            "{" | "(" | "[" => at += length_in_brackets(&tokens[at..]),
            _ => at += 1,
        }
    }
    at
}

/// The tokens without items for tests only, and the names of modules for tests only.
fn without_tests(tokens: &[String]) -> (Vec<String>, Vec<String>) {
    const MARK: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let (mut kept, mut modules) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < tokens.len() {
        if !tokens[at..].iter().take(MARK.len()).eq(MARK.iter()) {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        at += MARK.len();
        let item = &tokens[at..at + length_of_item(&tokens[at..])];
        if let [.., keyword, name, end] = item
            && keyword == "mod"
            && end == ";"
        {
            modules.push(name.clone());
        }
        at += item.len();
    }
    (kept, modules)
}

/// Turns `super` into `self` in modules within a file, where it is the file itself.
fn flatten(tokens: &mut [String]) {
    let mut is_module = Vec::new();
    for at in 0..tokens.len() {
        match tokens[at].as_str() {
            "{" => is_module.push(at >= 2 && tokens[at - 2] == "mod"),
            "}" => drop(is_module.pop()),
            "super" if at == 0 || tokens[at - 1] != "::" => {
                let depth = is_module.iter().filter(|&&it| it).count();
                let path = tokens[at..].iter_mut().step_by(2).take(depth);
                path.take_while(|token| *token == "super")
                    .for_each(|token| "self".clone_into(token));
            }
            _ => {}
        }
    }
}

/// Adds the names that a `use` brings, given the tokens between it and its `;`.
fn add_imports(tokens: &[String], is_public: bool, before: &[String], all: &mut Vec<Import>) {
    let mut path = before.to_vec();
    let mut name = None;
    let mut at = 0;
    while at < tokens.len() {
        match tokens[at].as_str() {
            "::" => {}
            "as" => {
                name = tokens.get(at + 1).cloned();
                break;
            }
            "{" => {
                let list = &tokens[at + 1..at + length_in_brackets(&tokens[at..]) - 1];
                let mut start = 0;
                while start < list.len() {
                    let length = length_of_item(&list[start..]);
                    let item = &list[start..start + length];
                    let item = item.strip_suffix(&[",".to_owned()]).unwrap_or(item);
                    add_imports(item, is_public, &path, all);
                    start += length;
                }
                return;
            }
            // `name::{self}`
            "self" if !path.is_empty() => {}
            word => path.push(word.to_owned()),
        }
        at += 1;
    }
    let Some(last) = path.last().cloned() else {
        return;
    };
    if last == "*" {
        path.pop();
    }
    all.push(Import {
        name: name.unwrap_or(last),
        path,
        is_public,
    });
}

impl Module {
    /// Reads a file's code; also names the modules below it that are for tests only.
    fn read(text: &str) -> (Self, Vec<String>) {
        let (mut all, tests) = without_tests(&tokens(text));
        flatten(&mut all);
        let (mut tokens, mut imports) = (Vec::new(), Vec::new());
        let mut at = 0;
        while at < all.len() {
            let end = all[at..].iter().position(|token| token == ";");
            match (all[at].as_str(), end) {
                // `impl Trait + use<'a>` brings no name.
                ("use", Some(end)) if all[at + 1] != "<" => {
                    let is_public = at > 0 && (all[at - 1] == "pub" || all[at - 1] == ")");
                    add_imports(&all[at + 1..at + end], is_public, &[], &mut imports);
                    at += end + 1;
                }
                ("mod", Some(2)) => at += 3,
                (token, _) => {
                    tokens.push(token.to_owned());
                    at += 1;
                }
            }
        }
        (Self { tokens, imports }, tests)
    }

    /// The import that brings this name, if one does.
    fn import(&self, name: &str) -> Option<&Import> {
        self.imports.iter().find(|import| import.name == name)
    }

    /// All paths of two names or more outside of `use` declarations.
    fn paths(&self) -> Vec<Vec<String>> {
        let is_name = |token: &String| token.starts_with(|c: char| c.is_alphabetic() || c == '_');
        let mut paths = Vec::new();
        let mut at = 0;
        while at < self.tokens.len() {
            let begin = at;
            while self.tokens.get(at).is_some_and(is_name) {
                at += 1;
                if self.tokens.get(at).is_none_or(|token| token != "::") {
                    break;
                }
                at += 1;
            }
            let begins = match &self.tokens[..begin] {
                // `pub(in super::super)`
                [.., bracket, word] if word == "in" => bracket != "(",
                // `<T>::new`
                [.., sign] => sign != "::",
                [] => true,
            };
            if begins && at > begin + 1 {
                let names = self.tokens[begin..at].iter().step_by(2);
                paths.push(names.cloned().collect());
            }
            at = at.max(begin + 1);
        }
        paths
    }
}

// Dependencies between modules.

/// The modules of a crate by their places; the root's place is empty.
struct Crate(BTreeMap<Place, Module>);

impl Crate {
    /// The crate whose root is in this folder.
    fn read(source: &Path) -> Self {
        let mut texts = BTreeMap::new();
        collect(source, &mut Vec::new(), &mut texts);
        Self::of(&texts)
    }

    fn of(texts: &BTreeMap<Place, String>) -> Self {
        let (mut modules, mut tests) = (BTreeMap::new(), Vec::new());
        for (place, text) in texts {
            let (module, of_tests) = Module::read(text);
            tests.extend(of_tests.iter().map(|name| inner(place, name)));
            modules.insert(place.clone(), module);
        }
        modules.retain(|place, _| !tests.iter().any(|test| place.starts_with(test)));
        Self(modules)
    }

    /// Defining module of a path that is written in `from`; `None` outside of this crate.
    ///
    /// `left` is how often names may lead to others.
    fn defining(&self, from: &Place, path: &[String], left: usize) -> Option<Place> {
        let (mut place, mut names) = (from.clone(), path);
        while let Some((name, rest)) = names.split_first() {
            let is_first = names.len() == path.len();
            match name.as_str() {
                "crate" => place.clear(),
                "self" => {}
                "super" => drop(place.pop()),
                _ if self.0.contains_key(&inner(&place, name)) => place.push(name.clone()),
                _ => {
                    if let Some(import) = self.0.get(&place)?.import(name) {
                        // `use name;` would lead to itself.
                        let left = left.checked_sub(1).filter(|_| import.path[0] != *name)?;
                        let whole = [&import.path, rest].concat();
                        return self.defining(&place, &whole, left);
                    }
                    return (!is_first).then_some(place);
                }
            }
            names = rest;
        }
        Some(place)
    }

    /// Dependencies: user and used module, with the names by which they are used.
    fn arrows(&self) -> BTreeMap<[&Place; 2], BTreeSet<String>> {
        let mut arrows: BTreeMap<_, BTreeSet<String>> = BTreeMap::new();
        for (from, module) in &self.0 {
            let defining = |path: &[String]| self.defining(from, path, 32);
            let mut add = |path: &[String]| {
                let known = defining(path).and_then(|to| self.0.get_key_value(&to));
                if let Some((to, _)) = known.filter(|(to, _)| *to != from) {
                    arrows
                        .entry([from, to])
                        .or_default()
                        .insert(path.join("::"));
                }
            };
            for import in &module.imports {
                let to = defining(&import.path);
                let is_below = to.as_ref().is_some_and(|to| to.starts_with(from));
                let is_used = module.tokens.contains(&import.name);
                if !(import.is_public && is_below) || is_used {
                    add(&import.path);
                }
                if let ("*", Some(to)) = (import.name.as_str(), to) {
                    let handed_on = self.0[&to].imports.iter();
                    let used = handed_on.filter(|it| module.tokens.contains(&it.name));
                    used.for_each(|it| add(&inner(&import.path, &it.name)));
                }
            }
            module.paths().iter().for_each(|path| add(path));
        }
        arrows
    }

    /// The arrows that are part of circles, folder by folder, as lines to read; empty if there are
    /// none.
    ///
    /// Unless `own`, a folder's own file is left out.
    fn circles(&self, own: bool) -> String {
        let arrows = self.arrows();
        let folders = self.0.keys().filter_map(|place| place.split_last());
        let folders: BTreeSet<&[String]> = folders.map(|(_, folder)| folder).collect();
        let mut said = String::new();
        for folder in folders {
            let beside = |place: &Place| match place.strip_prefix(folder)?.first() {
                Some(name) => Some(name.clone()),
                None => own.then(|| "mod".to_owned()),
            };
            let mut between: BTreeMap<(String, String), String> = BTreeMap::new();
            for ([from, to], names) in &arrows {
                if let (Some(user), Some(used)) = (beside(from), beside(to))
                    && user != used
                {
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    let lines = between.entry((user, used)).or_default();
                    writeln!(lines, "    {} names {}", from.join("::"), names.join(", ")).unwrap();
                }
            }
            let in_circles = between
                .iter()
                .filter(|((user, used), _)| leads(used, user, &between));
            for ((user, used), lines) in in_circles {
                let folder = folder.join("::");
                writeln!(said, "in `{folder}` {user} uses {used}:\n{lines}").unwrap();
            }
        }
        said
    }
}

/// The place of a module directly in another.
fn inner(place: &[String], name: &str) -> Place {
    let mut inner = place.to_vec();
    inner.push(name.to_owned());
    inner
}

/// Collects the files in a folder and below it.
fn collect(folder: &Path, place: &mut Place, texts: &mut BTreeMap<Place, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if path.is_dir() {
            place.push(name.to_owned());
            collect(&path, place, texts);
            place.pop();
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let place = match name {
                "mod" | "lib" | "main" => place.clone(),
                _ => inner(place, name),
            };
            let old = texts.insert(place, fs::read_to_string(&path).unwrap());
            assert!(old.is_none(), "{}", path.display());
        }
    }
}

/// Whether arrows lead from one module to another, directly or through others.
fn leads<T>(from: &String, to: &String, arrows: &BTreeMap<(String, String), T>) -> bool {
    let (mut seen, mut next) = (BTreeSet::from([from]), vec![from]);
    while let Some(user) = next.pop() {
        let used = arrows.keys().filter(|(from, _)| from == user);
        next.extend(used.map(|(_, to)| to).filter(|&to| seen.insert(to)));
    }
    seen.contains(to)
}

// The crates.

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn no_crate_has_a_circle() {
    let mut said = String::new();
    for entry in fs::read_dir(workspace().join("crates")).unwrap() {
        let path = entry.unwrap().path();
        if !path.is_dir() {
            continue;
        }
        // The library itself has tests of its own below, and in `layers.rs`.
        if !path.ends_with("pliant") {
            let circles = Crate::read(&path.join("src")).circles(true);
            if !circles.is_empty() {
                writeln!(said, "{}\n{circles}", path.display()).unwrap();
            }
        }
    }
    assert!(said.is_empty(), "{said}");
}

#[test]
fn the_bindings_have_no_circle() {
    for source in ["bindings/c/src", "bindings/python/src"] {
        let said = Crate::read(&workspace().join(source)).circles(true);
        assert!(said.is_empty(), "{said}");
    }
}

#[test]
fn modules_of_the_library_beside_each_other_are_in_no_circle() {
    let source = workspace().join("crates/pliant/src");
    let said = Crate::read(&source).circles(false);
    assert!(said.is_empty(), "{said}");
}

#[test]
fn the_library_has_no_circle() {
    let source = workspace().join("crates/pliant/src");
    let said = Crate::read(&source).circles(true);
    assert!(said.is_empty(), "{said}");
}

// Tests of this test.

/// The modules that use each other in circles, in a crate of these files.
fn found(files: &[(&str, &str)], own: bool) -> Vec<String> {
    let texts = files.iter().map(|&(path, text)| {
        let names = path.split("::").filter(|name| !name.is_empty());
        (names.map(str::to_owned).collect(), text.to_owned())
    });
    let said = Crate::of(&texts.collect()).circles(own);
    let heads = said.lines().filter(|line| line.starts_with("in "));
    heads
        .map(|line| line.trim_end_matches(':').to_owned())
        .collect()
}

#[test]
fn circles_are_found_however_they_are_written() {
    let both = ["in `` a uses b", "in `` b uses a"];
    let root = ("", "mod a; mod b; pub use a::A; use b::B as Other;");
    for (a, b) in [
        ("use crate::b::B;", "use crate::a::A;"),
        ("use super::{x, b::{self, B}};", "fn f(a: &super::a::A) {}"),
        // A name that the parent hands on, by its name there.
        ("fn f() { crate::Other::new('\"') }", "use crate::A;"),
        (
            "use super::*; struct A(Other);",
            "use super::a as c; fn f() { c::f() }",
        ),
        (
            "mod inner { fn f() { super::super::b::g() } }",
            "use crate::a::{f, A};",
        ),
    ] {
        assert_eq!(found(&[root, ("a", a), ("b", b)], false), both, "{a} {b}");
    }
    // A folder counts as one module, and through others.
    let files = [
        ("", "mod a; mod b; mod c;"),
        ("a", "mod inner;"),
        ("a::inner", "use crate::b::B;"),
        ("b", "use crate::c::C;"),
        ("c", "use crate::a::A;"),
    ];
    let three = ["in `` a uses b", "in `` b uses c", "in `` c uses a"];
    assert_eq!(found(&files, true), three);
    // A folder's own file.
    let files = [
        ("", "mod a; fn f() { a::f() } pub struct A;"),
        ("a", "use crate::A;"),
    ];
    assert_eq!(
        found(&files, true),
        ["in `` a uses mod", "in `` mod uses a"]
    );
    assert!(found(&files, false).is_empty());
}

#[test]
fn what_is_no_circle_is_not_found() {
    let root = ("", "mod a; mod b; pub use a::A; pub use b::B;");
    for (a, b) in [
        ("use crate::B;", "struct B;"),
        (
            "use crate::B; // crate::a\n const T: &str = \"crate::a::A\";",
            "struct B<'a>(&'a u8);",
        ),
        (
            "use crate::B;",
            "#[cfg(test)] mod tests { use crate::a::A; }",
        ),
        ("use crate::B;", "#[cfg(test)] use crate::a::A; struct B;"),
        (
            "use crate::B;",
            "use std::a::A; fn f() { a::f(); other::a::f() }",
        ),
        (
            "fn f() { g::<crate::B>() }",
            "mod inner { use super::B; fn f(b: super::B) {} }",
        ),
    ] {
        let files = [root, ("a", a), ("b", b)];
        assert!(
            found(&files, true).is_empty(),
            "{a} {b}: {:?}",
            found(&files, true)
        );
    }
    // `pub(in path)` says where an item is visible; it uses nothing.
    let within = "mod within { pub(in super::super) fn f() {} }";
    let files = [("", "mod a; fn f() { a::f() }"), ("a", within)];
    assert!(found(&files, true).is_empty());
    // A module for tests only.
    let files = [
        ("", "mod a; mod b;"),
        ("a", "use crate::b::B; #[cfg(test)] mod tests;"),
        ("a::tests", "use super::A;"),
        ("b", "#[cfg(test)] mod tests;"),
        ("b::tests", "use crate::a::A;"),
    ];
    assert!(found(&files, true).is_empty());
}
