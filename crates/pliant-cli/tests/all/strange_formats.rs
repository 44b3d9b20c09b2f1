//! Hostile glTF, STL, PC2 and MDD files: refused in one line, with exit code 2, soon, in little
//! memory.

use crate::common::{Measured, measured};
use std::fs::{self, File};
use std::path::Path;

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

#[test]
fn claims_that_nothing_stands_behind() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("m.obj"), MESH).unwrap();
    let most = u32::MAX.to_le_bytes();
    let stl = [&[b' '; 80][..], &most, &[0; 500]].concat();
    fs::write(path.join("claim.stl"), stl).unwrap();
    refused(path, "claim.stl", &["byte 80", "4294967295 triangles need"]);
    let pc2 = [
        &b"POINTCACHE2\0\x01\0\0\0"[..],
        &most,
        &[0; 8],
        &most,
        &[0; 500],
    ]
    .concat();
    fs::write(path.join("claim.pc2"), pc2).unwrap();
    refused(path, "m.obj+claim.pc2", &["claim.pc2", "ends too early"]);
    fs::write(
        path.join("claim.mdd"),
        [&most[..], &most, &[0; 500]].concat(),
    )
    .unwrap();
    refused(path, "m.obj+claim.mdd", &["claim.mdd", "ends too early"]);
    let glb = |json: &str, length: u32| {
        let json = format!("{json:<0$}", json.len().next_multiple_of(4));
        let chunk = [
            &(json.len() as u32).to_le_bytes()[..],
            b"JSON",
            json.as_bytes(),
        ]
        .concat();
        let all = [&b"glTF\x02\0\0\0"[..], &length.to_le_bytes(), &chunk];
        all.concat()
    };
    fs::write(path.join("long.glb"), glb("{}", u32::MAX)).unwrap();
    refused(path, "long.glb", &["byte 8", "4294967295 bytes"]);
    fs::write(path.join("none.glb"), glb("{}", 24)).unwrap();
    refused(path, "none.glb", &["holds no faces"]);
    let text = |accessor: &str| {
        format!(
            r#"{{"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{accessor}],"bufferViews":[{{"buffer":0,"byteLength":4000000000}}],
            "buffers":[{{"byteLength":4000000000,"uri":"data:;base64,AAAA"}}]}}"#
        )
    };
    for (name, accessor, words) in [
        (
            "a.gltf",
            r#"{"bufferView":0,"componentType":5126,"count":300000000,"type":"VEC3"}"#,
            "it has 3",
        ),
        (
            "b.gltf",
            r#"{"componentType":5126,"count":300000000,"type":"VEC3"}"#,
            "has no data",
        ),
        (
            "c.gltf",
            r#"{"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":3000000000,
            "indices":{"bufferView":0,"componentType":5125},"values":{"bufferView":0}}}"#,
            "accessor 0",
        ),
    ] {
        fs::write(path.join(name), text(accessor)).unwrap();
        refused(path, name, &[name, words]);
    }
    // Brackets without end, and a million nodes that are children of each other.
    fs::write(path.join("deep.gltf"), "[".repeat(1 << 20)).unwrap();
    refused(path, "deep.gltf", &["glTF"]);
    let nodes = vec!["{}"; 200_000].join(",");
    fs::write(
        path.join("nodes.gltf"),
        format!(r#"{{"scenes":[{{}}],"nodes":[{nodes}]}}"#),
    )
    .unwrap();
    refused(path, "nodes.gltf", &["holds no faces"]);
}

#[test]
fn nothing_directories_and_holes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("m.obj"), MESH).unwrap();
    for ending in ["stl", "gltf", "glb", "pc2", "mdd"] {
        let [empty, directory, hole] =
            ["empty", "directory", "hole"].map(|name| format!("{name}.{ending}"));
        fs::write(path.join(&empty), "").unwrap();
        fs::create_dir(path.join(&directory)).unwrap();
        let file = File::create(path.join(&hole)).unwrap();
        if file.set_len(1 << 36).is_err() {
            eprintln!("skipped: no file with a hole can be made here");
            fs::write(path.join(&hole), [0; 1000]).unwrap();
        }
        let beside = |name: &str| {
            if ["pc2", "mdd"].contains(&ending) {
                format!("m.obj+{name}")
            } else {
                name.to_owned()
            }
        };
        refused(path, &beside(&empty), &[&empty]);
        refused(path, &beside(&directory), &["is a directory"]);
        refused(path, &beside(&hole), &[&hole]);
    }
}
