//! Malformed and hostile glTF files: each gives frames or an error of one line that names the file.
//!
//! Among them are counts, offsets and strides that overflow or overlap, and numbers that are not
//! finite. Nodes form cycles, and buffers are elsewhere or are no files.

use crate::common::{Folder, all_frames};
use crate::gltf::triangle;
use allocation_counter::measure;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pliant_io::{OpenOptions, Reason};
use serde_json::{Value, json};

/// A change to the valid file.
type Change = fn(&mut Value);

fn changed(change: Change) -> String {
    let mut file = triangle();
    change(&mut file);
    file.to_string()
}

/// The bytes in the JSON.
fn data(file: &Value) -> Vec<u8> {
    let uri = file["buffers"][0]["uri"].as_str().unwrap();
    STANDARD.decode(uri.rsplit_once(',').unwrap().1).unwrap()
}

fn set_data(file: &mut Value, bytes: &[u8]) {
    file["bufferViews"][0]["byteLength"] = json!(bytes.len());
    file["buffers"][0] = json!({
        "byteLength": bytes.len(),
        "uri": format!("data:;base64,{}", STANDARD.encode(bytes)),
    });
}

/// Overwrites the four bytes `at` an offset by a number.
fn put(file: &mut Value, at: usize, number: f32) {
    let mut bytes = data(file);
    bytes[at..at + 4].copy_from_slice(&number.to_le_bytes());
    set_data(file, &bytes);
}

/// Appends numbers as rows of a new accessor; returns its number.
fn append(file: &mut Value, shape: &str, count: usize, numbers: &[f32]) -> usize {
    let mut bytes = data(file);
    let at = bytes.len();
    bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    set_data(file, &bytes);
    let accessors = file["accessors"].as_array_mut().unwrap();
    accessors.push(
        json!({"bufferView": 0, "byteOffset": at, "componentType": 5126, "count": count,
            "type": shape}),
    );
    accessors.len() - 1
}

/// Makes the only animation move this property of node 1, between two keys.
fn animate(file: &mut Value, path: &str, shape: &str, interpolation: &str, numbers: &[f32]) {
    let width = if shape == "VEC4" { 4 } else { 3 };
    let output = append(file, shape, numbers.len() / width, numbers);
    file["animations"][0]["channels"][0]["target"]["path"] = json!(path);
    file["animations"][0]["samplers"][0] =
        json!({"input": 3, "output": output, "interpolation": interpolation});
}

/// Checks that each file is refused by one line that begins with the file and has these words.
fn assert_refused(table: &[(Change, &str)]) {
    let folder = Folder::new();
    let mut wrong = Vec::new();
    for (number, &(change, words)) in table.iter().enumerate() {
        folder.write("bad.gltf", changed(change));
        let read = folder
            .open("bad.gltf")
            .and_then(|mut body| all_frames(&mut body));
        let error = match read {
            Ok(frames) => format!("{} frames", frames.len()),
            Err(error) => error.to_string(),
        };
        let file = folder.argument("bad.gltf");
        if !(error.starts_with(&file) && error.contains(words) && error.lines().count() == 1) {
            wrong.push(format!("case {number}: {words:?} is not in: {error}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn sparse(file: &mut Value, sparse: Value) {
    file["accessors"][0]["sparse"] = sparse;
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn counts_offsets_and_strides_that_overflow() {
    const MOST: u64 = u64::MAX;
    assert_refused(&[
        // Behind other vertices, their number exceeds 64 bits.
        (
            |file| {
                let many =
                    json!({"bufferView": 0, "componentType": 5126, "count": MOST, "type": "VEC3"});
                file["accessors"].as_array_mut().unwrap().push(many);
                let primitive =
                    json!({"attributes": {"POSITION": 5, "JOINTS_0": 1, "WEIGHTS_0": 2}});
                let primitives = &mut file["meshes"][0]["primitives"];
                primitives.as_array_mut().unwrap().push(primitive);
            },
            "more than 4294967295 vertices",
        ),
        (
            |file| file["accessors"][0]["count"] = json!(u32::MAX),
            "4294967295 rows from byte 0 on do not fit",
        ),
        (
            |file| file["accessors"][0]["byteOffset"] = json!(MOST - 3),
            "do not fit into buffer view 0",
        ),
        (
            |file| file["accessors"][0]["byteOffset"] = json!(93),
            "3 rows from byte 93 on do not fit",
        ),
        (
            |file| file["accessors"][3]["count"] = json!(MOST),
            "accessor 3: ends too early",
        ),
        (
            |file| file["accessors"][3]["count"] = json!(0),
            "sampler 0: has no keys",
        ),
        (
            |file| {
                file["bufferViews"][0]["byteOffset"] = json!(MOST);
                file["bufferViews"][0]["byteLength"] = json!(MOST);
            },
            "ends at byte 18446744073709551615, its buffer has 128",
        ),
        (
            |file| {
                file["bufferViews"][0]["byteOffset"] = json!(1);
                file["bufferViews"][0]["byteLength"] = json!(MOST);
                file["buffers"][0]["byteLength"] = json!(MOST);
                file["accessors"][0]["byteOffset"] = json!(MOST - 40);
            },
            "are needed, but it has 128",
        ),
        (
            |file| {
                file["bufferViews"][0]["byteLength"] = json!(MOST);
                file["buffers"][0]["byteLength"] = json!(MOST);
                file["accessors"][0]["count"] = json!(u64::from(u32::MAX));
            },
            "at least 48.1 GiB of memory, 4 GiB are allowed",
        ),
        (
            |file| file["bufferViews"][0]["byteStride"] = json!(0),
            "byteStride 0 is too small for rows of 4 bytes",
        ),
        (
            |file| file["bufferViews"][0]["byteStride"] = json!(253),
            "byteStride 253 is above 252",
        ),
        (
            |file| file["bufferViews"][0]["byteStride"] = json!(MOST),
            "byteStride 18446744073709551615 is above 252",
        ),
        (
            |file| file["bufferViews"][0]["byteStride"] = json!(252),
            "do not fit into buffer view 0",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": MOST, "indices": {"bufferView": 0, "componentType": 5121},
                        "values": {"bufferView": 0}}),
                );
            },
            "18446744073709551615 rows from byte 0 on do not fit",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 20, "indices": {"bufferView": 0, "componentType": 5121},
                        "values": {"bufferView": 0}}),
                );
            },
            "sparse index 0 is not larger than",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 1, "indices": {"bufferView": 0, "byteOffset": 50,
                        "componentType": 5121}, "values": {"bufferView": 0}}),
                );
            },
            "sparse index 128 is not below the 3 rows",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 3, "indices": {"bufferView": 0, "byteOffset": 36,
                        "componentType": 5121}, "values": {"bufferView": 0}}),
                );
            },
            "sparse index 0 is not larger than",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 1, "indices": {"bufferView": 0, "byteOffset": MOST,
                        "componentType": 5125}, "values": {"bufferView": 0}}),
                );
            },
            "1 rows from byte 18446744073709551615 on do not fit",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5125},
                        "values": {"bufferView": 0, "byteOffset": MOST}}),
                );
            },
            "1 rows from byte 18446744073709551615 on do not fit",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 1, "indices": {"bufferView": 9, "componentType": 5125},
                        "values": {"bufferView": 0}}),
                );
            },
            "there is no buffer view 9",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5125},
                        "values": {"bufferView": 9}}),
                );
            },
            "there is no buffer view 9",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5126},
                        "values": {"bufferView": 0}}),
                );
            },
            "sparse indices must have the type unsigned byte, short or int",
        ),
        (
            |file| {
                sparse(
                    file,
                    json!({"count": -1, "indices": {"bufferView": 0, "componentType": 5121},
                        "values": {"bufferView": 0}}),
                );
            },
            "does not describe a glTF file",
        ),
        (
            |file| {
                let matrices = append(file, "MAT4", 1, &[0.0; 16]);
                file["accessors"][matrices]["sparse"] = json!({"count": 1,
                    "indices": {"bufferView": 0, "componentType": 5121},
                        "values": {"bufferView": 0}});
                file["skins"][0]["inverseBindMatrices"] = json!(matrices);
            },
            "matrices in a sparse accessor are not evaluated",
        ),
        (
            |file| {
                let matrices = append(file, "MAT4", 1, &[0.0; 16]);
                file["skins"][0]["inverseBindMatrices"] = json!(matrices);
            },
            "has 1 inverse bind matrices for 2 joints",
        ),
        (
            |file| {
                file["accessors"]
                    .as_array_mut()
                    .unwrap()
                    .push(json!({"bufferView": 0,
                    "byteOffset": 36, "componentType": 5121, "count": MOST, "type": "SCALAR"}));
                file["meshes"][0]["primitives"][0]["indices"] = json!(5);
            },
            "accessor 5: ends too early",
        ),
        (
            |file| {
                file["accessors"]
                    .as_array_mut()
                    .unwrap()
                    .push(json!({"bufferView": 0,
                    "byteOffset": 48, "componentType": 5125, "count": 3, "type": "SCALAR"}));
                file["meshes"][0]["primitives"][0]["indices"] = json!(5);
            },
            "face 0 uses vertex 1065353216",
        ),
        (
            |file| file["bufferViews"][0]["buffer"] = json!(MOST),
            "there is no such buffer",
        ),
        (
            |file| file["scenes"][0]["nodes"][0] = json!(MOST),
            "node 18446744073709551615 does not exist",
        ),
        (
            |file| file["nodes"][1]["children"][0] = json!(MOST),
            "its child 18446744073709551615 does not exist",
        ),
        (
            |file| file["accessors"][0]["count"] = json!(3.5),
            "does not describe a glTF file",
        ),
        (
            |file| file["accessors"][0]["count"] = json!(1e30),
            "does not describe a glTF file",
        ),
    ]);
}

/// Bytes that belong to several accessors are read as each accessor says.
#[test]
fn bytes_may_be_of_more_than_one_accessor() {
    let folder = Folder::new();
    let overlapping: [Change; 4] = [
        // Joints overlap positions: where they have no weight, they do not matter.
        |file| file["accessors"][1]["byteOffset"] = json!(0),
        // Positions begin in the middle of others, in overlapping views.
        |file| {
            let views = file["bufferViews"].as_array_mut().unwrap();
            views.push(json!({"buffer": 0, "byteOffset": 4, "byteLength": 36, "byteStride": 12}));
            file["accessors"][0]["bufferView"] = json!(1);
        },
        // Positions replace themselves.
        |file| {
            sparse(
                file,
                json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5121},
                    "values": {"bufferView": 0}}),
            );
        },
        // Unaligned, against the format; read nevertheless.
        |file| {
            let mut bytes = data(file);
            bytes.push(0);
            bytes.extend_from_within(..36);
            set_data(file, &bytes);
            file["accessors"][0]["byteOffset"] = json!(129);
        },
    ];
    for change in overlapping {
        folder.write("over.gltf", changed(change));
        let frames = all_frames(&mut folder.open("over.gltf").unwrap()).unwrap();
        assert_eq!((frames.len(), frames[0].len()), (31, 3));
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn numbers_that_are_not_finite() {
    assert_refused(&[
        // Zero times NaN is NaN, so x is NaN too though only y was.
        (|file| put(file, 16, f32::NAN), "x of vertex 1 is NaN"),
        (|file| put(file, 20, f32::INFINITY), "x of vertex 1 is NaN"),
        // Weights of joints; also some that sum to zero.
        (|file| put(file, 48, f32::NAN), "x of vertex 0 is NaN"),
        (|file| put(file, 48, f32::INFINITY), "x of vertex 0 is NaN"),
        (
            |file| {
                put(file, 64, 1.0);
                put(file, 68, -1.0);
            },
            "of vertex 1 is",
        ),
        // Times of keys.
        (
            |file| put(file, 96, f32::NAN),
            "the time of key 0 is not finite",
        ),
        (
            |file| put(file, 100, f32::NAN),
            "the time of key 1 is not finite",
        ),
        (
            |file| put(file, 96, f32::NEG_INFINITY),
            "the time of key 0 is not finite",
        ),
        (
            |file| put(file, 100, f32::INFINITY),
            "the time of key 1 is not finite",
        ),
        (|file| put(file, 100, f32::MAX), "more than 16777216 frames"),
        // Animated values, between keys and at the last.
        (
            |file| put(file, 104, f32::NAN),
            "frame 0: x of vertex 0 is NaN",
        ),
        (
            |file| put(file, 116, f32::INFINITY),
            "frame 0: x of vertex 0 is NaN",
        ),
        (
            |file| {
                let numbers = [0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0];
                animate(file, "translation", "VEC3", "STEP", &numbers);
            },
            "frame 30: x of vertex 0 is NaN",
        ),
        (
            |file| {
                let numbers = [1.0, 1.0, 1.0, 1.0, f32::NEG_INFINITY, 1.0];
                animate(file, "scale", "VEC3", "STEP", &numbers);
            },
            "frame 30: ",
        ),
        (
            |file| animate(file, "rotation", "VEC4", "STEP", &[0.0; 8]),
            "frame 0: x of vertex 0 is NaN",
        ),
        (
            |file| {
                let numbers = [0.0, 0.0, 0.0, 1.0, 0.0, f32::NAN, 0.0, 1.0];
                animate(file, "rotation", "VEC4", "LINEAR", &numbers);
            },
            "frame 0: x of vertex 0 is NaN",
        ),
        (
            // A single tangent: it counts between the keys, but not at them.
            |file| {
                let mut numbers = [0.0; 18];
                numbers[6] = f32::NAN;
                animate(file, "translation", "VEC3", "CUBICSPLINE", &numbers);
            },
            "frame 0: x of vertex 0 is NaN",
        ),
        (
            |file| {
                let mut numbers = [0.0; 18];
                numbers[6] = f32::MAX;
                numbers[9] = f32::MAX;
                put(file, 100, 1000.0);
                animate(file, "translation", "VEC3", "CUBICSPLINE", &numbers);
            },
            "x of vertex 0 is inf",
        ),
        // Displacements and weights of morph targets.
        (
            |file| {
                let deltas = append(
                    file,
                    "VEC3",
                    3,
                    &[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0],
                );
                file["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": deltas}]);
                file["meshes"][0]["weights"] = json!([0.5]);
            },
            "x of vertex 1 is NaN",
        ),
        (
            |file| {
                let deltas = append(file, "VEC3", 3, &[f32::MAX; 9]);
                file["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": deltas}]);
                file["meshes"][0]["weights"] = json!([1e300]);
            },
            "x of vertex 0 is NaN",
        ),
        (
            |file| {
                let deltas = append(file, "VEC3", 3, &[1.0; 9]);
                file["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": deltas}]);
                let weights = append(file, "SCALAR", 2, &[f32::NAN, 0.0]);
                file["animations"][0]["channels"][0]["target"] =
                    json!({"node": 0, "path": "weights"});
                file["animations"][0]["samplers"][0]["output"] = json!(weights);
            },
            "frame 0: x of vertex 0 is NaN",
        ),
        // Matrices.
        (
            |file| {
                let mut numbers = [1.0; 32];
                numbers[13] = f32::NAN;
                let matrices = append(file, "MAT4", 2, &numbers);
                file["skins"][0]["inverseBindMatrices"] = json!(matrices);
            },
            "x of vertex 0 is NaN",
        ),
        (
            |file| {
                file["animations"] = json!([]);
                file["nodes"][1]["matrix"] =
                    json!([1e308, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
                file["nodes"][0] = json!({"mesh": 0});
                file["nodes"][1]["mesh"] = json!(0);
                file["scenes"][0]["nodes"] = json!([1]);
            },
            "x of vertex 1 is inf",
        ),
    ]);
    // JSON has neither NaN nor infinity; a number beyond the largest is malformed.
    let folder = Folder::new();
    for number in ["1e999", "-1e999", "NaN", "Infinity", "1e"] {
        let text = changed(|file| file["nodes"][1]["translation"] = json!([0.125, 0, 0]));
        folder.write("bad.gltf", text.replace("0.125", number));
        let error = folder.error("bad.gltf");
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(error.contains("does not describe a glTF file"), "{error}");
    }
    // The bone that this turns has no vertex, so it does not matter.
    folder.write(
        "unused.gltf",
        changed(|file| {
            animate(file, "rotation", "VEC4", "STEP", &[f32::NAN; 8]);
            file["nodes"] = json!([{"mesh": 0}, {}, {}]);
        }),
    );
    assert!(all_frames(&mut folder.open("unused.gltf").unwrap()).is_ok());
}

/// Rotations whose squares overflow or underflow are normalised like others.
#[test]
fn rotations_of_any_length() {
    let folder = Folder::new();
    let turned = |rotation: [f64; 4]| {
        let mut file = triangle();
        file["animations"] = json!([]);
        file["nodes"][1]["rotation"] = json!(rotation);
        folder.write("turned.gltf", file.to_string());
        all_frames(&mut folder.open("turned.gltf").unwrap()).unwrap()
    };
    let expected = turned([0.5, 0.5, 0.0, 0.0]);
    assert_ne!(expected, turned([0.0, 0.0, 0.0, 1.0]));
    for length in [1e300, 1e200, 1e-170, 1e-320] {
        assert_eq!(turned([length, length, 0.0, 0.0]), expected, "{length}");
    }
}

#[test]
fn nodes_that_go_round_and_depths() {
    assert_refused(&[
        (
            |file| file["nodes"][2]["children"] = json!([1]),
            "its ancestors form a cycle",
        ),
        (
            |file| file["nodes"][0]["children"] = json!([0]),
            "node 0: its ancestors form a cycle",
        ),
        (
            // Two cycles that the scene does not reach.
            |file| {
                let nodes = file["nodes"].as_array_mut().unwrap();
                nodes.extend([json!({"children": [4]}), json!({"children": [3]})]);
            },
            "node 3: its ancestors form a cycle",
        ),
        (
            |file| file["nodes"][0]["children"] = json!([2]),
            "node 2: is the child of more than one node",
        ),
    ]);
    let folder = Folder::new();
    // Ignored values may have any depth; values that are read have a fixed type without depth.
    let [open, close] = ["[", "]"].map(|bracket| bracket.repeat(100_000));
    let whole = changed(|file| file["extras"] = json!("deep"));
    folder.write(
        "extras.gltf",
        whole.replace("\"deep\"", &format!("{open}{close}")),
    );
    assert!(all_frames(&mut folder.open("extras.gltf").unwrap()).is_ok());
    let whole = changed(|file| file["nodes"][1]["children"] = json!("deep"));
    folder.write(
        "children.gltf",
        whole.replace("\"deep\"", &format!("{open}{close}")),
    );
    let error = folder.error("children.gltf");
    assert!(error.contains("does not describe a glTF file"), "{error}");
    // A root that is another node's child, or is listed repeatedly, is shown once.
    folder.write(
        "roots.gltf",
        changed(|file| file["scenes"][0]["nodes"] = (0..50_000).map(|at| at % 3).collect()),
    );
    let argument = folder.argument("roots.gltf");
    let bodies = pliant_io::open_all(&argument, &OpenOptions::default()).unwrap();
    assert_eq!(bodies.len(), 1);
}

/// A folder with a file in it, beside files that it must not reach.
#[cfg(unix)]
fn with_surroundings() -> Folder {
    use std::os::unix::fs::symlink;
    let folder = Folder::new();
    let bytes = data(&triangle());
    let path = folder.path();
    for sub in ["scene", "scene/sub", "outside"] {
        std::fs::create_dir(path.join(sub)).unwrap();
    }
    for file in ["scene/a b.bin", "scene/sub/a.bin", "outside/secret.bin"] {
        folder.write(file, &bytes);
    }
    for (target, link) in [
        ("a b.bin", "inside"),
        ("../scene/a b.bin", "round"),
        ("../outside/secret.bin", "out.bin"),
        ("../outside", "out"),
        ("/dev/zero", "zero"),
        ("/", "root"),
        ("loop", "loop"),
        ("gone", "dangling"),
    ] {
        symlink(target, path.join("scene").join(link)).unwrap();
    }
    let made = std::process::Command::new("mkfifo")
        .arg(path.join("scene/pipe"))
        .status();
    assert!(made.unwrap().success(), "mkfifo makes pipes");
    folder
}

#[cfg(unix)]
#[test]
fn buffers_that_leave_the_folder_or_are_no_files() {
    let folder = with_surroundings();
    let with_uri = |uri: &str| {
        let mut file = triangle();
        file["buffers"][0]["uri"] = json!(uri);
        folder.write("scene/bad.gltf", file.to_string());
        folder
            .open("scene/bad.gltf")
            .and_then(|mut body| all_frames(&mut body))
    };
    for uri in [
        "a b.bin",
        "a%20b.bin",
        "./a%20b.bin",
        "sub/a.bin",
        "sub//a.bin",
        // Links that stay in the folder.
        "inside",
        "round",
    ] {
        assert_eq!(with_uri(uri).unwrap().len(), 31, "{uri}");
    }
    let only_beside = "only files beside this one";
    let absolute = folder.argument("outside/secret.bin");
    let mut wrong = Vec::new();
    for (uri, words) in [
        ("", only_beside),
        ("..", only_beside),
        ("../outside/secret.bin", only_beside),
        ("sub/../../outside/secret.bin", only_beside),
        ("%2e%2e/outside/secret.bin", only_beside),
        ("..%2foutside%2Fsecret.bin", only_beside),
        ("..\\outside\\secret.bin", only_beside),
        (&absolute, only_beside),
        (&absolute.replace('/', "%2F"), only_beside),
        ("file:///etc/passwd", only_beside),
        ("http://localhost/a.bin", only_beside),
        ("//localhost/a.bin", only_beside),
        ("C:a.bin", only_beside),
        ("a%20b.bin%00", only_beside),
        // Links that leave the folder.
        ("out.bin", "a link leads out of the folder"),
        ("out/secret.bin", "a link leads out of the folder"),
        ("root/etc/passwd", "a link leads out of the folder"),
        ("zero", "a link leads out of the folder"),
        // No regular files.
        (".", "is a directory"),
        ("sub", "is a directory"),
        ("sub/", "is a directory"),
        ("pipe", "not a regular file"),
        ("loop", "cannot be read"),
        ("dangling", "no such file"),
        ("a b.bin/", "cannot be read"),
        ("a b.bin/c", "cannot be read"),
        ("gone.bin", "no such file"),
        ("%ff.bin", "no such file"),
        ("a%2", "no such file"),
        (&"x".repeat(100_000), "cannot be read"),
        // The file itself is beside itself, but its text is no buffer.
        ("bad.gltf", "accessor 3: sampler 0: the time of key 1"),
    ] {
        let error = with_uri(uri).map_or_else(|error| error.to_string(), |_| "frames".to_owned());
        let named = error.starts_with(folder.path().to_str().unwrap());
        if !(named && error.contains(words) && error.lines().count() == 1) {
            let error: String = error.chars().take(200).collect();
            wrong.push(format!("{uri:.40}: {words:?} is not in: {error}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Bytes that this program has read from files, where the system counts them.
fn bytes_read() -> Option<u64> {
    let counted = std::fs::read_to_string("/proc/self/io").ok()?;
    let read = counted
        .lines()
        .find_map(|line| line.strip_prefix("rchar: "));
    read?.trim().parse().ok()
}

/// A count is compared with the limit before its data is read.
///
/// A sparse file is a large buffer that takes no room on disk.
#[test]
fn buffers_that_are_holes() {
    let folder = Folder::new();
    let length = 1_u64 << 37;
    let hole = std::fs::File::create(folder.path().join("hole.bin")).unwrap();
    if hole.set_len(length).is_err() {
        eprintln!("skipped: no file with a hole can be made here");
        return;
    }
    let large: [(&str, Change); 3] = [
        ("positions", |file| {
            file["accessors"][0]["count"] = json!(4_000_000_000_u64);
        }),
        ("triangles", |file| {
            let indices = json!({"bufferView": 0, "componentType": 5125, "count": 3_000_000_000_u64,
                "type": "SCALAR"});
            file["accessors"].as_array_mut().unwrap().push(indices);
            file["meshes"][0]["primitives"][0]["indices"] = json!(5);
        }),
        ("keys", |file| {
            file["accessors"][4]["count"] = json!(2_000_000_000);
        }),
    ];
    for (what, change) in large {
        let mut file = triangle();
        let own = [file["bufferViews"][0].clone(), file["buffers"][0].clone()];
        change(&mut file);
        // The times of the keys stay as they were.
        file["accessors"][3]["bufferView"] = json!(1);
        let [mut view, buffer] = own;
        view["buffer"] = json!(1);
        file["bufferViews"] = json!([{"buffer": 0, "byteLength": length}, view]);
        file["buffers"] = json!([{"byteLength": length, "uri": "hole.bin"}, buffer]);
        folder.write("large.gltf", file.to_string());
        let before = bytes_read();
        let error = folder.open("large.gltf").unwrap_err();
        // Reading by concurrent tests is negligible in comparison.
        let read = bytes_read()
            .zip(before)
            .map(|(after, before)| after - before);
        assert!(
            read.is_none_or(|read| read < 4 << 30),
            "{what}: {read:?} bytes were read"
        );
        let is_too_large =
            matches!(error.reason(), Reason::TooLarge { needed, .. } if *needed > 8 << 30);
        assert!(is_too_large, "{what}: {error}");
    }
}

/// A hundred thousand morph targets that are the same zeros are read once.
#[test]
fn morph_targets_that_move_nothing_take_no_time() {
    const VERTICES: usize = 60_000;
    let mut file = triangle();
    let rest = append(&mut file, "VEC3", VERTICES, &vec![1.0; 3 * VERTICES]);
    let zeros = append(&mut file, "VEC3", VERTICES, &vec![0.0; 3 * VERTICES]);
    file["nodes"] = json!([{"mesh": 0}]);
    file["scenes"][0]["nodes"] = json!([0]);
    file["skins"] = json!([]);
    file["animations"] = json!([]);
    let targets = vec![json!({"POSITION": zeros}); 100_000];
    file["meshes"] =
        json!([{"primitives": [{"attributes": {"POSITION": rest}, "targets": targets}]}]);
    let folder = Folder::new();
    folder.write("zeros.gltf", file.to_string());
    let read = measure(|| {
        let frames = all_frames(&mut folder.open("zeros.gltf").unwrap()).unwrap();
        assert_eq!(frames[0].len(), VERTICES);
    });
    // Separate copies would take 720 KB each.
    assert!(read.bytes_total < 2 << 30, "{} bytes", read.bytes_total);
}
