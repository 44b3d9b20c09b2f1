//! Hostile places: names of pipes, devices, links, sparse files, and other names of a file.
//!
//! In every format, as a file, as part of one, and beside one. Each is refused in one line, with
//! exit code 2, soon, in little memory.
#![cfg(unix)]

use crate::common::npz::Surface;
use crate::common::{Measured, measured};
use serde_json::json;
use std::fs::{self, File};
use std::io::Write as _;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

/// Bytes: more than the program needs for any small file, less than any claim below.
const LITTLE: u64 = 64 << 20;

fn refused(folder: &Path, name: &str, words: &[&str]) {
    let Measured { said, peak } = measured(folder, &["check", name]);
    said.assert_refused(words);
    assert!(!said.err.contains("panicked"), "{}", said.err);
    assert!(
        peak.is_none_or(|peak| peak < LITTLE),
        "{name} took {peak:?} bytes"
    );
}

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const FORMATS: [&str; 8] = ["obj", "ply", "stl", "npz", "gltf", "glb", "pc2", "mdd"];

/// Arguments that read a file. Positions alone are read beside a mesh; glTF files have parts.
fn arguments(file: &str) -> Vec<String> {
    match file.rsplit_once('.').map(|(_, ending)| ending) {
        Some("pc2" | "mdd") => vec![format!("m.obj+{file}")],
        Some("gltf" | "glb") => vec![file.to_owned(), format!("{file}#body")],
        // Also as the mesh beside positions.
        _ => vec![file.to_owned(), format!("{file}+m.pc2")],
    }
}

fn pc2(vertices: u32, frames: u32, positions: &[f32]) -> Vec<u8> {
    let mut file = b"POINTCACHE2\0\x01\0\0\0".to_vec();
    file.extend(vertices.to_le_bytes());
    file.extend([0.0_f32, 1.0].map(f32::to_le_bytes).concat());
    file.extend(frames.to_le_bytes());
    file.extend(positions.iter().flat_map(|x| x.to_le_bytes()));
    file
}

const CORNERS: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.obj"), MESH).unwrap();
    fs::write(folder.path().join("m.pc2"), pc2(3, 1, &CORNERS)).unwrap();
    folder
}

#[test]
fn pipes_devices_and_links_that_lead_nowhere() {
    let folder = folder();
    let path = folder.path();
    for ending in FORMATS {
        let [pipe, device, round, dangling, to_pipe, directory] = [
            "pipe",
            "device",
            "round",
            "dangling",
            "to_pipe",
            "directory",
        ]
        .map(|name| format!("{name}.{ending}"));
        let made = Command::new("mkfifo").arg(path.join(&pipe)).status();
        assert!(made.unwrap().success(), "mkfifo makes pipes");
        for (target, link) in [
            ("/dev/zero", &device),
            (&round, &round),
            ("gone", &dangling),
            (&pipe, &to_pipe),
            ("/", &directory),
        ] {
            symlink(target, path.join(link)).unwrap();
        }
        for (file, words) in [
            (&pipe, "not a regular file"),
            (&device, "not a regular file"),
            (&to_pipe, "not a regular file"),
            (&round, "cannot be read"),
            (&dangling, "no such file"),
            (&directory, "is a directory"),
        ] {
            for argument in arguments(file) {
                refused(path, &argument, &[file, words]);
            }
        }
    }
}

/// A link is the file that it leads to; hard links are read, too.
#[test]
fn links_to_files_are_read() {
    let folder = folder();
    let path = folder.path();
    fs::create_dir(path.join("elsewhere")).unwrap();
    fs::write(path.join("elsewhere/a.npz"), Surface::new(5, 2).file()).unwrap();
    fs::write(
        path.join("elsewhere/a.glb"),
        Surface::new(5, 1).glb(false, 0),
    )
    .unwrap();
    fs::write(path.join("elsewhere/a.obj"), MESH).unwrap();
    for ending in ["npz", "glb", "obj"] {
        let link = format!("link.{ending}");
        symlink(format!("elsewhere/a.{ending}"), path.join(&link)).unwrap();
        let hard = format!("hard.{ending}");
        fs::hard_link(path.join(format!("elsewhere/a.{ending}")), path.join(&hard)).unwrap();
        for name in [link, hard] {
            let said = measured(path, &["check", &name]).said;
            assert_eq!((said.code, said.err.as_str()), (0, ""), "{name}");
        }
    }
}

/// A glTF file with a buffer of this URI.
fn gltf(uri: &str, count: u64, length: u64) -> String {
    json!({
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "body"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": length}],
        "buffers": [{"byteLength": length, "uri": uri}],
    })
    .to_string()
}

#[test]
fn buffers_that_are_elsewhere_or_no_files() {
    let folder = folder();
    let path = folder.path();
    let scene = path.join("scene");
    fs::create_dir(&scene).unwrap();
    let bytes: Vec<u8> = CORNERS.iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(path.join("outside.bin"), &bytes).unwrap();
    fs::write(scene.join("inside.bin"), &bytes).unwrap();
    symlink("inside.bin", scene.join("link.bin")).unwrap();
    symlink("../outside.bin", scene.join("out.bin")).unwrap();
    symlink("..", scene.join("up")).unwrap();
    symlink("/dev/zero", scene.join("zero.bin")).unwrap();
    let made = Command::new("mkfifo").arg(scene.join("pipe.bin")).status();
    assert!(made.unwrap().success(), "mkfifo makes pipes");
    let read = |uri: &str| {
        fs::write(scene.join("a.gltf"), gltf(uri, 3, 36)).unwrap();
        // Also from the folder itself, whose name is then empty.
        for (folder, name) in [(path, "scene/a.gltf"), (&scene, "a.gltf")] {
            let said = measured(folder, &["check", name]).said;
            assert_eq!((said.code, said.err.as_str()), (0, ""), "{uri} in {name}");
        }
    };
    read("inside.bin");
    read("./link.bin");
    for (uri, words) in [
        ("../outside.bin", "only files beside this one"),
        ("%2e%2e%2foutside.bin", "only files beside this one"),
        ("/etc/passwd", "only files beside this one"),
        ("file:outside.bin", "only files beside this one"),
        ("out.bin", "a link leads out of the folder"),
        ("up/outside.bin", "a link leads out of the folder"),
        ("zero.bin", "a link leads out of the folder"),
        ("pipe.bin", "not a regular file"),
        (".", "is a directory"),
        ("gone.bin", "no such file"),
    ] {
        fs::write(scene.join("a.gltf"), gltf(uri, 3, 36)).unwrap();
        refused(path, "scene/a.gltf", &["scene/", words]);
        refused(&scene, "a.gltf", &[words]);
        refused(&scene, "a.gltf#body", &[words]);
    }
}

/// Sparse files, which take no place on any disk, and are as long as their headers say.
#[test]
fn holes_that_are_as_long_as_they_say() {
    let folder = folder();
    let path = folder.path();
    let hole = |name: &str, head: &[u8], length: u64| {
        let mut file = File::create(path.join(name)).unwrap();
        file.write_all(head).unwrap();
        file.set_len(length).is_ok()
    };
    let many = 1_u64 << 31;
    let stl = [&[b' '; 80][..], &(many as u32).to_le_bytes()].concat();
    let ply = |vertices: u64, faces: u64| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n\
             property float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
        )
        .into_bytes()
    };
    let mdd = [1_u32.to_be_bytes(), (many as u32).to_be_bytes()].concat();
    let all = hole("a.stl", &stl, 84 + 50 * many)
        && hole("v.ply", &ply(many, 1), 1 << 36)
        && hole("f.ply", &ply(3, 1 << 33), 1 << 36)
        && hole("a.pc2", &pc2(many as u32, 1, &[]), 32 + 12 * many)
        && hole("a.mdd", &mdd, 12 + 12 * many)
        && hole("a.bin", &[], 1 << 37);
    if !all {
        eprintln!("skipped: no file with a hole can be made here");
        return;
    }
    fs::write(
        path.join("a.gltf"),
        gltf("a.bin", u64::from(u32::MAX), 1 << 37),
    )
    .unwrap();
    let allowed = "4 GiB are allowed";
    for (argument, words) in [
        ("a.stl", allowed),
        ("v.ply", allowed),
        ("f.ply", allowed),
        ("m.obj+a.pc2", "has 2147483648 vertices, m.obj has 3"),
        ("m.obj+a.mdd", "has 2147483648 vertices, m.obj has 3"),
        ("a.gltf", allowed),
        ("a.gltf#body", allowed),
        // Read as another format.
        ("a.stl+a.pc2", "a.stl"),
        ("a.gltf+a.mdd", "a.gltf"),
    ] {
        refused(path, argument, &[words]);
    }
}

/// Every binary format; text is in `strangers.rs`.
#[test]
fn numbers_that_are_not_finite() {
    let folder = folder();
    let path = folder.path();
    for (bad, name) in [
        (f32::NAN, "nan"),
        (f32::INFINITY, "inf"),
        (f32::NEG_INFINITY, "minus"),
    ] {
        let mut frames = [CORNERS, CORNERS];
        frames[1][4] = bad;
        let numbers = frames.as_flattened();
        let little: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let big: Vec<u8> = numbers.iter().flat_map(|x| x.to_be_bytes()).collect();
        // Times of frames are not read, whatever they are.
        let mdd = [
            &2_u32.to_be_bytes()[..],
            &3_u32.to_be_bytes(),
            &[0xff; 8],
            &big,
        ]
        .concat();
        let stl = [
            &[b' '; 80][..],
            &1_u32.to_le_bytes(),
            &[0xff; 12],
            &little[36..],
            &[0; 2],
        ]
        .concat();
        let ending = |ending: &str| format!("{name}.{ending}");
        fs::write(path.join(ending("pc2")), pc2(3, 2, numbers)).unwrap();
        fs::write(path.join(ending("mdd")), mdd).unwrap();
        fs::write(path.join(ending("stl")), stl).unwrap();
        fs::write(path.join(ending("bin")), &little[36..]).unwrap();
        fs::write(path.join(ending("gltf")), gltf(&ending("bin"), 3, 36)).unwrap();
        for (argument, words) in [
            (format!("m.obj+{name}.pc2"), "frame 1: y of vertex 1 is"),
            (format!("m.obj+{name}.mdd"), "frame 1: y of vertex 1 is"),
            (ending("stl"), "y of vertex 1 is"),
            (ending("gltf"), "of vertex 1 is"),
        ] {
            refused(path, &argument, &[name, words]);
        }
    }
}
