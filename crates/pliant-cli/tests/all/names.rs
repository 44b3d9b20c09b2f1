//! Nasty names in every message: of files, of their contents, of arguments.
//!
//! No message contains a terminal escape, a changed direction of text, a line break or a command to
//! a CI runner. None is as long as a name can be.

use crate::common::npz::{Entry, archive, array};
use crate::common::{Said, check, pliant};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A nasty name: a colour, a line that is a command, an older such line, the reading direction, a
/// line separator, an eight-bit control.
const NASTY: &str = "\u{1b}[31m\n::error::x\n##[error]\u{202e}\u{2028}\u{9b}";

/// Its beginning, as shown.
const SHOWN: &str = r"\u{1b}[31m\n::error::x\n##\u{5b}error]\u{202e}\u{2028}\u{9b}";

const FLAT: &str = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n";
const UPRIGHT: &str = "v 1 1 -1\nv 1 1 1\nv 1 2 1\nf 1 2 3\n";

/// Fails if the output has any effect beyond plain lines.
fn assert_harmless(said: &Said, what: &dyn std::fmt::Debug) {
    assert!(said.err.lines().count() <= 1, "{what:?}: {:?}", said.err);
    for text in [&said.out, &said.err] {
        let steers = |c: char| {
            c.is_control() && c != '\n'
                || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        };
        assert!(!text.contains(steers), "{what:?}: {text:?}");
        assert!(!text.contains("##["), "{what:?}: {text}");
        for line in text
            .lines()
            .filter(|line| line.trim_start().starts_with("::"))
        {
            assert!(line.starts_with("::error "), "{what:?}: {line}");
            assert_eq!(
                line.matches("title=pliant::").count(),
                1,
                "{what:?}: {line}"
            );
        }
    }
}

/// Two crossing triangles, each a node moved by a clip. Everything that can have a name has this
/// one.
fn scene(name: &str) -> Value {
    let corners = [
        [0., 0., 0., 4., 0., 0., 0., 4., 0.],
        [1., 1., -1., 1., 1., 1., 1., 2., 1.],
    ];
    let bytes: Vec<u8> = corners
        .as_flattened()
        .iter()
        .flat_map(|x: &f32| x.to_le_bytes())
        .collect();
    let data = base64(&bytes);
    let rows = |view: u32, count: u32, shape: &str| {
        json!({
            "bufferView": view, "componentType": 5126, "count": count, "type": shape
        })
    };
    let mesh = |positions: u32| {
        json!({
            "name": name, "primitives": [{"attributes": {"POSITION": positions}}]
        })
    };
    let meshes = [0, 1].map(mesh);
    json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": name}, {"mesh": 1, "name": name}],
        "meshes": meshes,
        "animations": [{
            "name": name,
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
            "samplers": [{"input": 2, "output": 0, "interpolation": "STEP"}],
        }],
        "accessors": [rows(0, 3, "VEC3"), rows(1, 3, "VEC3"), rows(2, 3, "SCALAR")],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 36},
            {"buffer": 1, "byteLength": 12},
        ],
        "buffers": [
            {"byteLength": 72, "uri": format!("data:;base64,{data}")},
            {"byteLength": 12, "uri": "data:;base64,AAAAAAAAgD8AAABA"},
        ],
        "extensionsRequired": [],
    })
}

fn base64(bytes: &[u8]) -> String {
    use ::base64::prelude::{BASE64_STANDARD, Engine};
    BASE64_STANDARD.encode(bytes)
}

/// Files with nasty names, or with nasty names in them.
fn folder(name: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let write = |file: &str, text: &str| fs::write(path.join(file), text).unwrap();
    write("flat.obj", FLAT);
    let group = name.replace('\n', "\u{b}");
    write(
        "groups.obj",
        &format!("o {group}\n{FLAT}g {group}\n{UPRIGHT}g other\n{UPRIGHT}"),
    );
    write("words.obj", &format!("v {}\n", name.replace('\n', "\u{b}")));
    write(
        "element.ply",
        &format!(
            "ply\nformat ascii 1.0\nelement {0} 1\nproperty float {0}\nend_header\nx\n",
            name.replace(['\n', ' '], "_")
        ),
    );
    let of_npz: &'static str = name.to_owned().leak();
    let entry = Entry::stored(of_npz, array("<f4", "(1, 3, 3)", &[0; 36]));
    fs::write(path.join("arrays.npz"), archive(&[entry])).unwrap();
    for (file, change) in [
        ("scene.gltf", None),
        (
            "uri.gltf",
            Some(("/buffers/0/uri", json!(format!("{name}.bin")))),
        ),
        (
            "away.gltf",
            Some(("/buffers/0/uri", json!(format!("../{name}")))),
        ),
        ("version.gltf", Some(("/asset/version", json!(name)))),
        (
            "extension.gltf",
            Some(("/extensionsRequired", json!([name]))),
        ),
        (
            "path.gltf",
            Some(("/animations/0/channels/0/target/path", json!(name))),
        ),
        (
            "keys.gltf",
            Some(("/animations/0/samplers/0/interpolation", json!(name))),
        ),
        ("kind.gltf", Some(("/accessors/0/type", json!(name)))),
        ("number.gltf", Some(("/nodes/0/mesh", json!(name)))),
    ] {
        let mut scene = scene(name);
        if let Some((pointer, value)) = change {
            *scene.pointer_mut(pointer).unwrap() = value;
        }
        write(file, &scene.to_string());
    }
    folder
}

/// Output of every line of arguments with this name, in files and as a request.
///
/// Each line runs as it is, and once for each output format.
fn asked(path: &Path, name: &str) -> Vec<Said> {
    let part = format!("scene.gltf#{name}");
    let in_groups = format!("groups.obj#{}", name.replace('\n', "\u{b}"));
    let missing = format!("{name}.obj");
    let [group, pair] = [format!("{name}={name}"), format!("{name},{name}")];
    let vtp = format!("{name}/hits.vtp");
    let lines: &[&[&str]] = &[
        &["check", "scene.gltf"],
        &["check", "scene.gltf", "--self", "--split", "components"],
        &["check", "scene.gltf", "--ignore", "0,1"],
        &["check", "scene.gltf", "--clip", name],
        &["check", "scene.gltf", "--clip", "none"],
        &["check", "scene.gltf", "--ignore", &pair],
        &["check", "scene.gltf", "--ignore", "a,b"],
        &["check", "scene.gltf", "--group", &group],
        &[
            "check",
            "scene.gltf",
            "--group",
            &format!("{name}="),
            "--ignore",
            "a,b",
        ],
        &[
            "check",
            "scene.gltf",
            "--group",
            &format!("{name}=0"),
            "--ignore",
            "a,b",
        ],
        &["check", "scene.gltf", "--report", "page.html"],
        &["check", &part],
        &["check", "scene.gltf#none"],
        &["check", &missing],
        &["check", &format!("flat.obj#{name}")],
        &["check", "groups.obj", "--split", "groups"],
        &["check", "groups.obj#none"],
        &["check", &in_groups],
        &["check", &in_groups, &in_groups],
        &["check", &in_groups, "--split", "components"],
        &["check", "groups.obj", "--ignore", &format!("{in_groups},0")],
        &["check", &format!("flat.obj+{name}.pc2")],
        &["check", name],
        &["check", "words.obj"],
        &["check", "element.ply"],
        &["check", "arrays.npz"],
        &["check", "uri.gltf"],
        &["check", "away.gltf"],
        &["check", "version.gltf"],
        &["check", "extension.gltf"],
        &["check", "path.gltf"],
        &["check", "keys.gltf"],
        &["check", "kind.gltf"],
        &["check", "number.gltf"],
        &["check", "flat.obj", "--hits", &vtp],
        &["check", "flat.obj", "--hits", name],
        &["check", "flat.obj", "--report", &format!("{name}/a.html")],
        &["check", "flat.obj", "--report", name],
        &["check", "flat.obj", "--png", &format!("{name}/a.png")],
        &["check", "flat.obj", "--max-memory", name],
        &["check", "flat.obj", &format!("--{name}")],
        &["convert", "scene.gltf", "out.obj"],
        &["convert", &part, "out.obj"],
        &["convert", "flat.obj", name],
        &["convert", "flat.obj", &format!("{name}/a.obj")],
        &["convert", "flat.obj", &format!("{name}/a.pc2")],
        &["convert", "flat.obj", "out.obj", "--frames", name],
        &["run", name],
        &["bench", name],
        &["bench", "splits", "--json", &format!("{name}/a.json")],
        &["completions", name],
        &["man", &format!("flat.obj/{name}")],
        &[name],
    ];
    let mut all = Vec::new();
    for line in lines {
        let formats: &[&str] = if line[0] == "check" {
            &["table", "github"]
        } else {
            &["table"]
        };
        for format in formats {
            let with = if line[0] == "check" {
                &["--format", format][..]
            } else {
                &[]
            };
            let said = pliant(path, &[line, with].concat());
            assert_harmless(&said, &[line, with].concat());
            all.push(said);
        }
    }
    all
}

#[test]
fn no_message_obeys_a_name() {
    let folder = folder(NASTY);
    let said = asked(folder.path(), NASTY);
    // Every message is about the name, except messages without room for it.
    let about = said
        .iter()
        .filter(|said| said.out.contains(r"\u{1b}") || said.err.contains(r"\u{1b}"));
    assert!(
        about.count() * 10 > said.len() * 8,
        "{} messages",
        said.len()
    );
    let page = fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(!page.contains(['\u{1b}', '\u{202e}', '\u{2028}']));
}

#[test]
fn no_message_is_as_long_as_a_name() {
    // Twice in an argument, that is the longest that an argument may be.
    let long = "n".repeat(60_000);
    for said in asked(folder(&long).path(), &long) {
        assert!(
            said.err.len() < 4200,
            "{} bytes: {}",
            said.err.len(),
            said.err
        );
        let longest = said.out.lines().map(str::len).max().unwrap_or(0);
        assert!(longest < 4200, "{}", said.out);
    }
}

/// A folder of files with this prefix, and a folder of this name with the same files.
#[cfg(unix)]
fn files_called(name: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::create_dir(path.join(name)).unwrap();
    for (file, text) in [
        ("1.obj", FLAT),
        ("2.obj", UPRIGHT),
        ("bad.obj", "v 0 0 0\nf 1 2 3\n"),
        ("few.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n"),
        ("not.npz", "no archive"),
        ("not.gltf", "{}"),
        ("not.mesh", ""),
        ("empty.stl", ""),
        ("empty.ply", ""),
        ("empty.pc2", ""),
    ] {
        fs::write(path.join(format!("{name}{file}")), text).unwrap();
        fs::write(path.join(name).join(file), text).unwrap();
    }
    fs::write(path.join("plain.obj"), FLAT.replace('4', "0.1")).unwrap();
    folder
}

/// Lines of arguments with a name in place of `@`. Not every system allows such files.
#[cfg(unix)]
const LINES: &[&str] = &[
    // An expanded pattern, frames that differ, a column of files.
    "check @1.obj @2.obj",
    "check @1.obj @2.obj --count --ignore 0,0",
    "check @1.obj @2.obj --hits @hits.vtp",
    "check @1.obj @few.obj --split components",
    "check */[12].obj",
    "check */[1f]*.obj",
    "check @1.obj#a",
    "check @1.obj+@empty.pc2",
    // A conversion that rounds, and says so; existing files; lines that begin with the name.
    "convert plain.obj @new.stl",
    "convert plain.obj @new.stl",
    "convert plain.obj @new.npz",
    "convert plain.obj ::error::x.stl",
    "convert @1.obj+@empty.pc2 out.obj",
    "convert @1.obj @not.gltf",
    "convert @1.obj @new.pc2",
    "convert @1.obj @1.obj+@new.pc2",
];

#[cfg(unix)]
#[test]
fn no_message_obeys_the_name_of_a_file() {
    let folder = files_called(NASTY);
    let path = folder.path();
    let files =
        "1.obj 2.obj bad.obj few.obj not.npz not.gltf not.mesh empty.stl empty.ply empty.pc2";
    let each = files.split_whitespace().flat_map(|file| {
        let lines = [
            "check @",
            "check @/",
            "convert plain.obj @",
            "convert plain.obj @/",
        ];
        let into = [
            format!("convert @{file} {file}.stl"),
            format!("convert @/{file} {file}.npz"),
        ];
        lines
            .map(|line| format!("{line}{file}"))
            .into_iter()
            .chain(into)
    });
    for line in LINES.iter().map(ToString::to_string).chain(each) {
        let words: Vec<String> = line
            .split(' ')
            .map(|word| word.replace('@', NASTY))
            .collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        assert_harmless(&pliant(path, &words), &line);
        if words[0] == "check" {
            assert_harmless(
                &pliant(path, &[&words[..], &["--format", "github"]].concat()),
                &line,
            );
        }
    }
    let name = |ending: &str| format!("{NASTY}{ending}");
    let said = check(path, &[&name("1.obj"), &name("2.obj")]);
    let note = "pliant: note: 2 arguments are 2 bodies; if they are frames of one body, quote";
    assert!(
        said.err.starts_with(note) && said.err.contains(r"\u{1b}"),
        "{}",
        said.err
    );
    assert!(
        said.out.contains(&format!("body 0: {SHOWN}1.obj, ")),
        "{}",
        said.out
    );
    let said = pliant(path, &["convert", "plain.obj", "::warning::x.stl"]);
    let line = r"\u{3a}:warning::x.stl";
    assert!(
        said.out.starts_with(&format!("{line}: 1 frame")),
        "{}",
        said.out
    );
    assert!(
        said.err
            .starts_with(&format!("pliant: note: {line} has 32-bit")),
        "{}",
        said.err
    );
}

/// JSON has escapes of its own: its readers get the true name.
#[test]
fn json_has_the_true_names() {
    let folder = folder(NASTY);
    let said = check(folder.path(), &["scene.gltf", "--format", "json"]);
    let json = said.json();
    for (node, body) in json["bodies"].as_array().unwrap().iter().enumerate() {
        assert_eq!(body["name"], format!("scene.gltf#{NASTY} (node {node})"));
    }
    assert_eq!(json["frames"][0]["count"], 1);
}
