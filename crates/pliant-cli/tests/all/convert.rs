//! End-to-end tests of `pliant convert`, and of `pliant check` on its input and output.

use crate::common::pliant;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Three frames of a quadrangle and a triangle that comes down through it.
fn sequence() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (frame, z) in [1.5, 0.1, -2.5].into_iter().enumerate() {
        let text = format!(
            "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n\
             v 0.1 0.2 {z}\nv 0.3 0.1 {}\nv 0.2 0.3 {}\nf 1 2 3 4\nf 5 6 7\n",
            z + 1.0,
            z - 0.5
        );
        fs::write(folder.path().join(format!("s{frame}.obj")), text).unwrap();
    }
    folder
}

fn convert(folder: &Path, arguments: &[&str]) -> String {
    let said = pliant(folder, &[&["convert"], arguments].concat());
    assert_eq!((said.code, &said.err[..]), (0, ""), "{arguments:?}");
    said.out
}

fn counts(folder: &Path, argument: &str) -> Vec<u64> {
    let said = pliant(folder, &["check", argument, "--count", "--format", "json"]);
    assert!(said.code < 2, "{}", said.err);
    said.counts()
}

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../pliant-io/tests/fixtures")
        .join(name)
}

#[test]
fn a_sequence_is_the_same_in_every_format() {
    let folder = sequence();
    let path = folder.path();
    let expected = counts(path, "s?.obj");
    assert!(
        expected[0] == 0 && expected[1] > 0 && expected[2] == 0,
        "{expected:?}"
    );
    // Rounding to 32 bits changes the coordinates, and a note says so.
    let said = pliant(path, &["convert", "s?.obj", "m.obj+c.pc2"]);
    assert_eq!(said.code, 0);
    assert_eq!(
        said.err,
        "pliant: note: m.obj+c.pc2 has 32-bit coordinates, s?.obj has 64-bit ones: they were \
         rounded\n"
    );
    assert_eq!(said.out, "m.obj+c.pc2: 3 frames, 7 vertices, 3 triangles\n");
    let mut from = "m.obj+c.pc2".to_owned();
    for (to, read) in [
        ("a.npz", "a.npz"),
        ("p_%02d.ply", "p_*.ply"),
        ("m.ply+c.mdd", "m.ply+c.mdd"),
        ("t%d.stl", "t*.stl"),
        ("again_%04d.obj", "again_*.obj"),
    ] {
        let out = convert(path, &[&from, to]);
        assert!(
            out.starts_with(&format!("{to}: 3 frames, 7 vertices, 3 triangles")),
            "{out}"
        );
        assert_eq!(counts(path, read), expected, "{to}");
        from = read.to_owned();
    }
    assert!(path.join("again_0002.obj").exists());
    // The corners of STL became vertices again, each written once.
    let text = fs::read_to_string(path.join("again_0000.obj")).unwrap();
    assert_eq!(text.matches("v ").count(), 7);
    let out = convert(path, &["t*.stl", "apart.npz", "--no-weld"]);
    assert_eq!(out, "apart.npz: 3 frames, 9 vertices, 3 triangles\n");
}

#[test]
fn frames_are_chosen() {
    let folder = sequence();
    let path = folder.path();
    let all = counts(path, "s?.obj");
    for (frames, chosen) in [
        ("1..3", 1..3),
        ("..2", 0..2),
        ("2..", 2..3),
        ("..", 0..3),
        ("1", 1..2),
    ] {
        convert(path, &["s?.obj", "some.npz", "--frames", frames, "--force"]);
        assert_eq!(counts(path, "some.npz"), all[chosen], "{frames}");
    }
    // Every second one: the frames between are passed over.
    convert(path, &["s?.obj", "some.npz", "--frames", "..:2", "--force"]);
    assert_eq!(counts(path, "some.npz"), [all[0], all[2]]);
    convert(path, &["s?.obj", "one.ply", "--frames", "1"]);
    assert_eq!(counts(path, "one.ply"), all[1..2]);
    let said = pliant(path, &["convert", "s?.obj", "x.npz", "--frames", "1..4"]);
    said.assert_refused(&["frames 0 to 2", "--frames"]);
}

#[test]
fn gltf_is_evaluated_and_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let file = fixture("skin.gltf").display().to_string();
    let out = convert(path, &[&file, "s.npz", "--clip", "bend", "--fps", "4"]);
    assert!(
        out.starts_with("s.npz: 5 frames, 28 vertices, 24 triangles"),
        "{out}"
    );
    let check = |arguments: &[&str]| {
        pliant(
            path,
            &[&["check", "--count", "--format", "json"], arguments].concat(),
        )
    };
    let there = check(&[&file, "--clip", "bend", "--fps", "4"]);
    assert_eq!(there.counts(), check(&["s.npz"]).counts());
    assert_eq!(there.counts().len(), 5);

    // The file has two clips. The table says which was taken.
    let table = pliant(path, &["check", &file]).out;
    let head = table.lines().next().unwrap();
    assert!(head.ends_with(", clip bend"), "{head}");

    let many = fixture("hierarchy.gltf").display().to_string();
    let said = check(&[&many]);
    assert_eq!(said.json()["bodies"].as_array().unwrap().len(), 4);
    pliant(path, &["convert", &many, "h.npz"])
        .assert_refused(&["holds 4 bodies: mirrored, arm (node 3)", "#mirrored'"]);
    convert(path, &[&format!("{many}#ground"), "h.ply"]);

    let refused =
        |arguments: &[&str], words: &[&str]| pliant(path, arguments).assert_refused(words);
    refused(
        &["convert", "s.npz", "s.glb"],
        &["s.glb", "glTF can be read but not written", ".npz"],
    );
    refused(
        &["check", &file, "--clip", "run"],
        &["has no clip \"run\"; it has: bend, stand"],
    );
    refused(
        &["check", "s.npz", "--clip", "bend"],
        &["none of the files has one", "--clip"],
    );
    refused(
        &["convert", "s.npz", "t.npz", "--clip", "bend"],
        &["s.npz", "no animation", "--clip"],
    );
    let said = check(&[&file, "--fps", "0"]);
    assert!(
        said.code == 2 && said.err.contains("--fps") && said.err.contains("above 0"),
        "{}",
        said.err
    );
}

#[test]
fn what_is_there_is_written_over_only_by_force() {
    let folder = sequence();
    let path = folder.path();
    fs::write(path.join("precious.npz"), "precious").unwrap();
    let before = fs::read_dir(path).unwrap().count();
    pliant(path, &["convert", "s?.obj", "precious.npz"]).assert_refused(&[
        "precious.npz",
        "exists already",
        "--force",
    ]);
    // A failure half way, at the third of three frames, leaves nothing.
    fs::write(path.join("s2.obj"), "v 0 0\n").unwrap();
    for to in ["new.npz", "m.obj+new.mdd", "precious.npz"] {
        pliant(path, &["convert", "s?.obj", to, "--force"]).assert_refused(&["s2.obj", "line 1"]);
    }
    assert_eq!(fs::read(path.join("precious.npz")).unwrap(), b"precious");
    assert_eq!(fs::read_dir(path).unwrap().count(), before);
    convert(path, &["s0.obj", "precious.npz", "--force"]);
    assert_eq!(counts(path, "precious.npz"), [0]);
    // A file converted onto itself is read to the end before it is replaced.
    convert(path, &["precious.npz", "precious.npz", "--force"]);
    assert_eq!(counts(path, "precious.npz"), [0]);
}
