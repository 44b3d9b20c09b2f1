//! Evaluation of glTF files, compared with three.js; names, clips and frames; refusals.
//!
//! The files and the records in `fixtures/` are made by `three/` (its package.json says how).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::common::{Folder, all_frames};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pliant_io::{Body, Note, OpenOptions, Positions, Precision, Reason, open, open_all};
use serde_json::{Value, json};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/fixtures")
        .join(name)
}

fn options(clip: Option<&str>, fps: f64) -> OpenOptions {
    OpenOptions {
        clip: clip.map(str::to_owned),
        fps,
        ..OpenOptions::default()
    }
}

/// Relative error allowed between three.js and our results.
///
/// three.js computes in double precision, except for data that files and its records have in single
/// precision or in ten digits. Ours are rounded to single precision. Relative to the size of the
/// bodies that is 6e-8 a step, for a few steps; 1e-5 is far from any mistake.
const BOUND: f64 = 1e-5;

type Frame = Vec<[f64; 3]>;

/// Compares every clip and frame of a file with its record; returns the number of positions.
fn compare(file: &Path, record: &Path) -> usize {
    let record: Value = serde_json::from_str(&std::fs::read_to_string(record).unwrap()).unwrap();
    let fps = record["fps"].as_f64().unwrap();
    let picked: Option<Vec<usize>> = serde_json::from_value(record["vertices"].clone()).unwrap();
    let mut compared = 0;
    for clip in record["clips"].as_array().unwrap() {
        let name = clip["clip"].as_str();
        let path = file.to_str().unwrap();
        let mut bodies = open_all(path, &options(name, fps)).unwrap();
        let expected = clip["frames"].as_array().unwrap();
        let ours: Vec<Vec<Frame>> = bodies
            .iter_mut()
            .map(|body| all_frames(body).unwrap())
            .collect();
        let size = size_of(&ours);
        let mut moves = 0;
        for (number, frame) in expected.iter().enumerate() {
            let theirs: BTreeMap<u32, Frame> =
                serde_json::from_value(frame["bodies"].clone()).unwrap();
            assert_eq!(theirs.len(), ours.len());
            for (body, theirs) in ours.iter().zip(theirs.values()) {
                assert!(
                    [1, expected.len()].contains(&body.len()),
                    "{} frames",
                    body.len()
                );
                moves += usize::from(body.len() > 1);
                let ours = &body[number.min(body.len() - 1)];
                let picked = picked.clone().unwrap_or_else(|| (0..ours.len()).collect());
                assert_eq!(picked.len(), theirs.len());
                for (&vertex, theirs) in picked.iter().zip(theirs) {
                    for (ours, theirs) in ours[vertex].iter().zip(theirs) {
                        assert!(
                            (ours - theirs).abs() <= BOUND * size,
                            "{path} {name:?} frame {number} vertex {vertex}: {ours} {theirs}"
                        );
                    }
                    compared += 1;
                }
            }
        }
        assert_eq!(moves > 0, name.is_some());
    }
    compared
}

/// The largest coordinate of any body.
fn size_of(bodies: &[Vec<Frame>]) -> f64 {
    let all = bodies.iter().flatten().flatten().flatten();
    all.fold(0.0, |size: f64, x| size.max(x.abs()))
}

#[test]
fn everything_is_where_three_js_has_it() {
    let mut compared = 0;
    for name in [
        "hierarchy.gltf",
        "skin.gltf",
        "morph.gltf",
        "skin-and-morph.gltf",
        "kinds.glb",
    ] {
        let file = fixture(name);
        compared += compare(&file, &file.with_extension("json"));
    }
    eprintln!("{compared} positions compared");
    assert!(compared > 1000);
}

#[test]
fn the_fox_runs_as_in_three_js() {
    let fox = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/fox.glb");
    if !fox.is_file() {
        eprintln!("skipped: {} is absent", fox.display());
        return;
    }
    let compared = compare(&fox, &fixture("fox.json"));
    eprintln!("{compared} positions compared");
    let mut body = open(fox.to_str().unwrap(), &OpenOptions::default()).unwrap();
    assert_eq!((body.vertex_count(), body.triangles().len()), (1728, 576));
    // 1,728 corners at 290 places.
    assert_eq!(body.welded(), 1728 - 290);
    let mut used = body.triangles().concat();
    used.sort_unstable();
    used.dedup();
    assert_eq!(used.len(), 290);
    assert_eq!(
        (body.clip(), body.precision()),
        (Some("Survey"), Precision::F32)
    );
    // 3.4166667 seconds at 30 frames per second, both ends included.
    assert_eq!(body.frame_count(), 104);
    // The sides of every seam stay together: every frame is read.
    assert_eq!(all_frames(&mut body).unwrap().len(), 104);
    let error = open(fox.to_str().unwrap(), &options(Some("Fly"), 30.0)).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("has no clip \"Fly\"; it has: Survey, Walk, Run"),
        "{error}"
    );
}

#[test]
fn bodies_are_the_nodes_with_meshes_in_the_default_scene() {
    let file = fixture("hierarchy.gltf");
    let file = file.to_str().unwrap();
    let bodies = open_all(file, &OpenOptions::default()).unwrap();
    let names: Vec<_> = bodies.iter().map(Body::name).collect();
    let part = |name: &str| format!("{file}#{name}");
    assert_eq!(
        names,
        ["mirrored", "arm (node 3)", "arm (node 4)", "ground"].map(part)
    );
    let frames: Vec<_> = bodies.iter().map(Body::frame_count).collect();
    assert_eq!(frames, [61, 61, 61, 1], "the ground stands still");
    let clips: Vec<_> = bodies.iter().map(Body::clip).collect();
    assert_eq!(clips, [Some("turn"), Some("turn"), Some("turn"), None]);

    let error = open(file, &OpenOptions::default()).unwrap_err().to_string();
    let told = format!(
        "holds 4 bodies: mirrored, arm (node 3), arm (node 4), ground; name one: '{file}#mirrored'"
    );
    assert!(error.ends_with(&told), "{error}");
    let arm = open(&part("arm (node 4)"), &OpenOptions::default()).unwrap();
    assert_eq!(
        (arm.name(), arm.vertex_count()),
        (&part("arm (node 4)")[..], 4)
    );
    let error = open(&part("leg"), &OpenOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("has no body \"leg\"; it has: mirrored, "),
        "{error}"
    );
    let error = open(&part("elsewhere"), &OpenOptions::default())
        .unwrap_err()
        .to_string();
    assert!(error.contains("has no body \"elsewhere\""), "{error}");

    let file = fixture("kinds.glb");
    let bodies = open_all(file.to_str().unwrap(), &OpenOptions::default()).unwrap();
    let names: Vec<_> = bodies
        .iter()
        .map(|body| body.name().rsplit_once('#').unwrap().1)
        .collect();
    assert_eq!(
        names,
        [
            "triangles",
            "strip",
            "strip by numbers",
            "fan",
            "many",
            "node 6"
        ]
    );
    let triangles: Vec<_> = bodies.iter().map(Body::triangles).collect();
    assert_eq!(triangles[0], [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(triangles[1], [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]);
    assert_eq!(triangles[2], [[5, 1, 4], [1, 0, 4], [4, 0, 2]]);
    assert_eq!(triangles[3], [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]);
}

/// Names in a file that look like generated ones are names of other bodies.
#[test]
fn bodies_have_names_of_their_own_whatever_the_file_calls_them() {
    let folder = Folder::new();
    let mut file = triangle();
    let again = "a (node 0) (node 0)";
    let names = [
        "a",
        "a",
        "a (node 1)",
        "a (node 0)",
        again,
        "a (node 0)",
        "node 7",
    ];
    let mut nodes: Vec<Value> = names.map(|name| json!({"mesh": 0, "name": name})).into();
    nodes.push(json!({"mesh": 0}));
    file["scenes"][0]["nodes"] = (0..nodes.len()).collect();
    file["nodes"] = nodes.into();
    file["skins"] = json!([]);
    file["animations"] = json!([]);
    folder.write("names.gltf", file.to_string());
    let argument = folder.argument("names.gltf");
    let bodies = open_all(&argument, &OpenOptions::default()).unwrap();
    let names: Vec<_> = bodies.iter().map(Body::name).collect();
    let expected = [
        "a (node 0) (node 0) (node 0)",
        "a (node 1) (node 1)",
        "a (node 1)",
        "a (node 0) (node 3)",
        again,
        "a (node 0) (node 5)",
        "node 7 (node 6)",
        "node 7 (node 7)",
    ];
    assert_eq!(names, expected.map(|name| format!("{argument}#{name}")));
    for (number, name) in names.iter().enumerate() {
        let one = open(name, &OpenOptions::default()).unwrap();
        assert_eq!(one.name(), *name, "{number}");
    }
}

/// The first `#` behind an existing file begins the name of the body; a `+` separates two files.
#[test]
fn folders_and_bodies_may_have_signs_in_their_names() {
    let folder = Folder::new();
    let mut file = triangle();
    let names = ["arm#2", "b.glb#c", "leg+d.pc2"];
    file["nodes"] = names.map(|name| json!({"mesh": 0, "name": name})).into();
    file["scenes"][0]["nodes"] = json!([0, 1, 2]);
    file["skins"] = json!([]);
    file["animations"] = json!([]);
    let options = OpenOptions::default();
    for within in ["take#1", "a.gltf#b", "#", "take+1", "+a.pc2"] {
        let inner = folder.path().join(within);
        std::fs::create_dir(&inner).unwrap();
        std::fs::write(inner.join("s#1.gltf"), file.to_string()).unwrap();
        std::fs::write(inner.join("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let mut cache = b"POINTCACHE2\0\x01\0\0\0".to_vec();
        cache.extend([3, 0, 0, 1].map(u32::to_le_bytes).as_flattened());
        cache.extend([0; 36]);
        std::fs::write(inner.join("m.pc2"), cache).unwrap();
        let scene = folder.argument(&format!("{within}/s#1.gltf"));
        for body in open_all(&scene, &options).unwrap() {
            assert_eq!(open(body.name(), &options).unwrap().name(), body.name());
        }
        let [mesh, positions] =
            ["m.obj", "m.pc2"].map(|name| folder.argument(&format!("{within}/{name}")));
        assert_eq!(
            open(&format!("{mesh}+{positions}"), &options)
                .unwrap()
                .vertex_count(),
            3
        );
    }
    // If no such file exists, the message is about the first that was meant.
    assert_eq!(folder.error("no.gltf#a.gltf#b"), "no.gltf: no such file");
    assert_eq!(folder.error("no.obj+no.pc2"), "no.obj: no such file");
}

#[test]
fn frames_are_at_the_rate_asked_for_and_at_the_end() {
    let file = fixture("skin.gltf");
    let name = format!("{}#ladder", file.display());
    for (fps, frames) in [(1.0, 2), (0.4, 2), (1.5, 3), (30.0, 31), (59.94, 61)] {
        let body = open(&name, &options(None, fps)).unwrap();
        assert_eq!(body.frame_count(), frames, "{fps}");
    }
    let last = |fps| {
        all_frames(&mut open(&name, &options(None, fps)).unwrap())
            .unwrap()
            .pop()
    };
    assert_eq!(last(1.5), last(30.0));
    for fps in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
        let error = open(&name, &options(None, fps)).unwrap_err();
        let said = match error.reason() {
            Reason::BadRate { .. } => "a rate must be finite and above 0",
            Reason::ClipTooLong { .. } if fps == 1e300 => "more than 16777216 frames",
            _ => panic!("{error}"),
        };
        assert!(error.to_string().contains(said), "{error}");
    }
}

/// A valid file of one triangle, as JSON to spoil.
///
/// Its bytes are nine floats of positions, twelve bytes of joints, twelve floats of weights, two
/// times and two translations.
pub(crate) fn triangle() -> Value {
    let mut bytes: Vec<u8> = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0_f32]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    bytes.extend([0, 1, 0, 0].repeat(3)); // joints: 36 to 48
    for weights in [
        [1.0, 0.0, 0.0, 0.0_f32],
        [0.5, 0.5, 0.0, 0.0],
        [0.25, 0.75, 0.0, 0.0],
    ] {
        bytes.extend(weights.iter().flat_map(|x| x.to_le_bytes())); // 48 to 96
    }
    bytes.extend(
        [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0_f32]
            .iter()
            .flat_map(|x| x.to_le_bytes()),
    ); // times: 96; vectors: 104
    json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "skin": 0, "name": "body"}, {"name": "bone", "children": [2]}, {}],
        "skins": [{"joints": [1, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1,
            "WEIGHTS_0": 2}}]}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
            "samplers": [{"input": 3, "output": 4}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 0, "byteOffset": 36, "componentType": 5121, "count": 3, "type": "VEC4"},
            {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 3, "type": "VEC4"},
            {"bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 2,
                "type": "SCALAR"},
            {"bufferView": 0, "byteOffset": 104, "componentType": 5126, "count": 2, "type": "VEC3"}
        ],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}],
        "buffers": [{"byteLength": bytes.len(),
            "uri": format!("data:;base64,{}", STANDARD.encode(&bytes))}]
    })
}

/// The file with the value at `pointer` replaced.
fn with(pointer: &str, value: Value) -> String {
    let mut file = triangle();
    if let Some(place) = file.pointer_mut(pointer) {
        *place = value;
    } else {
        let (parent, name) = pointer.rsplit_once('/').unwrap();
        file.pointer_mut(parent).unwrap()[name] = value;
    }
    file.to_string()
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn what_is_wrong_is_said_in_a_line() {
    let folder = Folder::new();
    folder.write("whole.gltf", triangle().to_string());
    assert_eq!(
        all_frames(&mut folder.open("whole.gltf").unwrap())
            .unwrap()
            .len(),
        31
    );
    for (pointer, value, words) in [
        (
            "/extensionsRequired",
            json!(["KHR_materials_unlit", "KHR_texture_flight", "EXT_strange"]),
            "needs the extension \"EXT_strange\"",
        ),
        (
            "/extensionsRequired",
            json!(["KHR_draco_mesh_compression"]),
            "compressed by Draco",
        ),
        (
            "/extensionsRequired",
            json!(["ACME_walls"]),
            "needs the extension \"ACME_walls\"",
        ),
        (
            "/extensionsUsed",
            json!(["EXT_mesh_gpu_instancing"]),
            "EXT_mesh_gpu_instancing",
        ),
        ("/asset/version", json!("1.0"), "only version 2"),
        ("/scene", json!(1), "scene 1 does not exist"),
        ("/scenes", json!([]), "scene 0 does not exist"),
        (
            "/scenes/0/nodes/0",
            json!(9),
            "scene 0: node 9 does not exist",
        ),
        (
            "/nodes/1/children/0",
            json!(1),
            "node 1: its ancestors form a cycle",
        ),
        (
            "/nodes/1/children/0",
            json!(3),
            "node 1: its child 3 does not exist",
        ),
        (
            "/nodes/1/children",
            json!([2, 2]),
            "node 2: is the child of more than one node",
        ),
        ("/nodes/0/mesh", json!(1), "mesh 1: there is no such mesh"),
        ("/nodes/0/skin", json!(1), "node 0: skin 1 does not exist"),
        (
            "/nodes/1/rotation",
            json!([0, 0, 0, 0]),
            "node 1: its rotation is the zero quaternion",
        ),
        (
            "/nodes/1/matrix",
            json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]),
            "node 1: has a matrix and is animated",
        ),
        (
            "/nodes/1/scale",
            json!([1e300, 1, 1]),
            "x of vertex 1 is inf",
        ),
        (
            "/skins/0/joints",
            json!([1]),
            "node 0: vertex 1 names joint 1, but the skin has 1 joints",
        ),
        (
            "/skins/0/joints/0",
            json!(7),
            "skin 0: joint node 7 does not exist",
        ),
        (
            "/skins/0/inverseBindMatrices",
            json!(0),
            "accessor 0: has type \"VEC3\" and componentType 5126; \
             inverse bind matrices need \"MAT4\" and one of: 5126",
        ),
        (
            "/meshes/0/primitives/0/attributes",
            json!({"POSITION": 0}),
            "node 0: has a skin, but a primitive of its mesh has no joints",
        ),
        (
            "/meshes/0/primitives/0/attributes",
            json!({"POSITION": 0, "JOINTS_0": 1}),
            "joints without weights",
        ),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(9),
            "accessor 9: there is no such accessor",
        ),
        (
            "/meshes/0/primitives/0/attributes",
            json!({}),
            "mesh 0: a primitive has no positions",
        ),
        (
            "/meshes/0/primitives/0/mode",
            json!(7),
            "mesh 0: a primitive has mode 7; glTF has modes 0 to 6",
        ),
        ("/meshes/0/primitives/0/mode", json!(1), "holds no faces"),
        (
            "/meshes/0/primitives/0/indices",
            json!(1),
            "accessor 1: has type \"VEC4\" and componentType 5121; \
             indices need \"SCALAR\" and one of: 5121, 5123, 5125",
        ),
        (
            "/accessors/0/count",
            json!(4),
            "has 3 joints rows for 4 positions",
        ),
        (
            "/accessors/0/count",
            json!(1_000_000),
            "accessor 0: ends too early: 1000000 rows from byte 0 on do not fit into buffer view \
             0 of 128 bytes",
        ),
        (
            "/accessors/0/count",
            json!(u64::MAX),
            "more than 4294967295 vertices",
        ),
        (
            "/accessors/0/count",
            json!(-1),
            "does not describe a glTF file",
        ),
        (
            "/accessors/0/byteOffset",
            json!(u64::MAX),
            "accessor 0: ends too early",
        ),
        (
            "/accessors/0/componentType",
            json!(5125),
            "componentType 5125; positions need \"VEC3\" and one of: 5126, 5120, 5121, 5122, 5123",
        ),
        (
            "/accessors/0/bufferView",
            json!(3),
            "accessor 0: there is no buffer view 3",
        ),
        (
            "/accessors/0/bufferView",
            Value::Null,
            "accessor 0: has no data",
        ),
        (
            "/accessors/3/count",
            json!(1),
            "sampler 0: 1 keys need 3 numbers, there are 6",
        ),
        (
            "/accessors/3/byteOffset",
            json!(100),
            "the time of key 1, 0.0, is not later than",
        ),
        (
            "/animations/0/samplers/0/interpolation",
            json!("ROUND"),
            "sampler 0: interpolation \"ROUND\" is unknown",
        ),
        (
            "/animations/0/channels/0/target/node",
            json!(5),
            "moves node 5, which does not exist",
        ),
        (
            "/animations/0/channels/0/sampler",
            json!(5),
            "a channel names sampler 5, which does not exist",
        ),
        (
            "/bufferViews/0/byteLength",
            json!(1_000_000),
            "accessor 3: ends too early: buffer view 0 ends at byte 1000000, its buffer has 128",
        ),
        (
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            "accessor 3: ends too early: buffer view 0",
        ),
        (
            "/bufferViews/0/byteStride",
            json!(4),
            "byteStride 4 is too small for rows of 12 bytes",
        ),
        (
            "/bufferViews/0/buffer",
            json!(1),
            "buffer 1: there is no such buffer",
        ),
        ("/buffers/0/byteLength", json!(1), "its buffer has 1"),
        (
            "/buffers/0/uri",
            json!("data:;base64,AAAA"),
            "buffer 0: ends too early: 8 bytes from byte 96 on are needed, but it has 3",
        ),
        ("/buffers/0/uri", Value::Null, "neither a URI nor bytes"),
        (
            "/buffers/0/uri",
            json!("data:;base64,@@@@"),
            "its data URI is not valid base64: ",
        ),
        (
            "/buffers/0/uri",
            json!("data:text/plain,hello"),
            "not base64",
        ),
        (
            "/buffers/0/uri",
            json!("https://example.org/a.bin"),
            "only files beside this one",
        ),
        (
            "/buffers/0/uri",
            json!("../a.bin"),
            "only files beside this one",
        ),
        (
            "/buffers/0/uri",
            json!("/etc/passwd"),
            "only files beside this one",
        ),
        (
            "/buffers/0/uri",
            json!("%2e%2e/a.bin"),
            "only files beside this one",
        ),
        (
            "/buffers/0/uri",
            json!("a.bin"),
            "a.bin, buffer 0: no such file",
        ),
    ] {
        folder.write("bad.gltf", with(pointer, value));
        let error = folder.error("bad.gltf");
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(
            error.contains(words)
                && error.starts_with(if words.starts_with("a.bin") {
                    "a.bin"
                } else {
                    "bad.gltf"
                }),
            "{pointer}: {error}"
        );
    }
    let clip = OpenOptions {
        clip: Some("walk".into()),
        ..OpenOptions::default()
    };
    let error = open(&folder.argument("whole.gltf"), &clip)
        .unwrap_err()
        .to_string();
    assert!(
        error.ends_with("has no clip \"walk\"; it has: 0"),
        "{error}"
    );
    folder.write("deep.gltf", format!("{{\"a\":{}", "[".repeat(1 << 20)));
    assert!(folder.error("deep.gltf").contains("the JSON is cut short"));
}

#[test]
fn glb_is_refused_by_the_byte() {
    let folder = Folder::new();
    let whole = std::fs::read(fixture("kinds.glb")).unwrap();
    for end in 0..whole.len() {
        folder.write("cut.glb", &whole[..end]);
        let error = open_all(&folder.argument("cut.glb"), &OpenOptions::default()).unwrap_err();
        assert_eq!(error.to_string().lines().count(), 1, "{error}");
    }
    folder.write("cut.glb", &whole[..whole.len() - 1]);
    let message = format!(
        "cut.glb, byte 8: ends too early: the file announces {} bytes, and has {}",
        whole.len(),
        whole.len() - 1
    );
    assert_eq!(folder.error("cut.glb"), message);
    let mut old = whole.clone();
    old[4] = 1;
    folder.write("old.glb", &old);
    assert!(
        folder
            .error("old.glb")
            .contains("GLB of version 1; only version 2")
    );
}

#[test]
fn seams_are_welded_where_everything_moves_alike() {
    let folder = Folder::new();
    // Two triangles with a common edge: corners 0 1 2 and 3 4 5; 3 and 4 coincide with 1 and 0.
    let corners: [f32; 18] = [
        0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 0., 0., -0., 0., 0., 0., -1., 0.,
    ];
    let joints: [[u8; 4]; 6] = [
        [0, 1, 0, 0],
        [1, 0, 0, 0],
        [0; 4],
        [0, 1, 0, 0],
        [1, 0, 0, 0],
        [0; 4],
    ];
    let weights: [[f32; 4]; 6] = [
        [0.25, 0.75, 0., 0.],
        [1., 0., 0., 0.],
        [1., 0., 0., 0.],
        // Equal to vertex 1, except for a joint without weight; equal to vertex 0, in the other
        // order.
        [0., 1., 0., 0.],
        [0.75, 0.25, 0., 0.],
        [1., 0., 0., 0.],
    ];
    let deltas: [f32; 18] = [
        0., 0., 2., 0., 0., 1., 0., 0., 0., 0., 0., 1., 0., 0., 2., 0., 0., 3.,
    ];
    let file = |weights: [[f32; 4]; 6], deltas: [f32; 18]| {
        let mut bytes: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
        bytes.extend(joints.as_flattened());
        bytes.extend(
            weights
                .as_flattened()
                .iter()
                .chain(&deltas)
                .flat_map(|x| x.to_le_bytes()),
        );
        let accessor = |offset: u32, kind: u32, shape: &str| {
            json!({"bufferView": 0, "byteOffset": offset, "componentType": kind,
                "count": 6, "type": shape})
        };
        json!({
            "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [3, 4, 5]}],
            "skins": [{"joints": [1, 2]}],
            "meshes": [{"weights": [0.5], "primitives": [{
                "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2},
                    "targets": [{"POSITION": 3}]}]}],
            "accessors": [accessor(0, 5126, "VEC3"), accessor(72, 5121, "VEC4"),
                accessor(96, 5126, "VEC4"), accessor(192, 5126, "VEC3")],
            "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}],
            "buffers": [{"byteLength": bytes.len(),
                "uri": format!("data:;base64,{}", STANDARD.encode(&bytes))}]
        })
        .to_string()
    };
    let welded = |text: String| {
        folder.write("seam.gltf", text);
        let mut body = folder.open("seam.gltf").unwrap();
        let welded = body.welded();
        let Some(Positions::F32(positions)) = body.next_frame().unwrap() else {
            panic!()
        };
        (
            welded,
            positions[0] == positions[4],
            positions[1] == positions[3],
        )
    };
    assert_eq!(welded(file(weights, deltas)), (2, true, true));
    // Weights that differ by a rounding or two are equal, and noted. A common factor makes no
    // difference.
    let mut nearly = weights;
    nearly[4] = [0.750_006, 0.249_994, 0.0, 0.0];
    assert_eq!(welded(file(nearly, deltas)).0, 2);
    let notes = folder.open("seam.gltf").unwrap().notes().to_vec();
    assert_eq!(notes, [Note::SeamsByWeights { count: 1 }]);
    nearly[4] = [1.5, 0.5, 0.0, 0.0];
    assert_eq!(welded(file(nearly, deltas)).0, 2);
    nearly[4] = [0.750_02, 0.249_98, 0.0, 0.0];
    assert_eq!(welded(file(nearly, deltas)).0, 0);
    // A joint that is not named weighs nothing, on either side: at vertex 3, then at vertex 1.
    for (few, much) in [(3, 0.000_006), (1, 0.000_006)] {
        let mut named = weights;
        named[few] = if few == 3 {
            [much, 1.0, 0.0, 0.0]
        } else {
            [1.0, much, 0.0, 0.0]
        };
        assert_eq!(welded(file(named, deltas)).0, 2);
        let notes = folder.open("seam.gltf").unwrap().notes().to_vec();
        assert_eq!(notes, [Note::SeamsByWeights { count: 1 }]);
        named[few] = named[few].map(|weight| if weight < 0.5 { 4.0 * weight } else { weight });
        assert_eq!(welded(file(named, deltas)).0, 0);
    }
    // One end has other joints, or moves otherwise by a morph target: the edges are different.
    let mut other = weights;
    other[4] = [0.5, 0.5, 0.0, 0.0];
    assert_eq!(welded(file(other, deltas)), (0, false, true));
    let mut other = deltas;
    other[9] = 1e-3;
    assert_eq!(welded(file(weights, other)), (0, true, false));
}

/// No file, however small, makes the reader hold more than is allowed.
#[test]
fn small_files_of_large_bodies_are_refused() {
    let folder = Folder::new();
    let mut file = triangle();
    let limited = |text: &str, megabytes: u64| {
        folder.write("many.gltf", text);
        let options = OpenOptions {
            max_memory: megabytes << 20,
            ..OpenOptions::default()
        };
        open_all(&folder.argument("many.gltf"), &options)
    };
    // A thousand bodies of one mesh of a thousand triangles: one mesh is held, and 48 kB per body.
    file["nodes"] = (0..1000).map(|_| json!({"mesh": 0})).collect();
    file["scenes"][0]["nodes"] = (0..1000).collect();
    file["skins"] = json!([]);
    file["animations"] = json!([]);
    let primitive = json!({"attributes": {"POSITION": 0}});
    file["meshes"][0]["primitives"] = (0..1000).map(|_| primitive.clone()).collect();
    let text = file.to_string();
    assert_eq!(limited(&text, 128).unwrap().len(), 1000);
    let refused = |text: &str, megabytes: u64| {
        let error = limited(text, megabytes).unwrap_err();
        let is_too_large = matches!(
            error.reason(),
            Reason::TooLarge { limit, .. } | Reason::SeamsTooLarge { limit, .. }
                if *limit == megabytes << 20
        );
        let said = format!(", {megabytes} MiB are allowed");
        assert!(
            is_too_large && error.to_string().ends_with(&said),
            "{error}"
        );
    };
    refused(&text, 16);
    // A mesh of many primitives, all with the same bytes.
    let mut file = triangle();
    let primitive = json!({"attributes": {"POSITION": 0}});
    file["meshes"][0]["primitives"] = (0..100_000).map(|_| primitive.clone()).collect();
    file["nodes"][0] = json!({"mesh": 0});
    refused(&file.to_string(), 8);
    // Zero displacements of morph targets take no memory.
    let mut file = triangle();
    file["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5126, "count": 3, "type": "VEC3"}));
    file["meshes"][0]["primitives"][0]["targets"] =
        (0..1000).map(|_| json!({"POSITION": 5})).collect();
    assert!(limited(&file.to_string(), 4).is_ok());
    // Nested nodes, deeper than any stack.
    let mut file = triangle();
    file["nodes"] = (0..50_000)
        .map(|node| {
            if node < 49_999 {
                json!({"children": [node + 1]})
            } else {
                json!({"mesh": 0, "name": "last"})
            }
        })
        .collect();
    file["scenes"][0]["nodes"] = json!([0]);
    file["skins"] = json!([]);
    file["animations"] = json!([]);
    assert!(limited(&file.to_string(), 64).is_ok());
}

/// GLB files in a row are frames, if each is one body.
#[test]
fn files_in_a_row_are_frames() {
    let folder = Folder::new();
    for (number, x) in [1.0, 2.0, 3.0].into_iter().enumerate() {
        let mut file = triangle();
        file["animations"] = json!([]);
        file["nodes"][1]["translation"] = json!([x, 0, 0]);
        folder.write(&format!("f{number}.gltf"), file.to_string());
    }
    let frames = all_frames(&mut folder.open("f*.gltf").unwrap()).unwrap();
    let moved: Vec<_> = frames.iter().map(|frame| frame[0][0]).collect();
    assert_eq!(moved, [1.0, 2.0, 3.0]);
    std::fs::copy(fixture("kinds.glb"), folder.path().join("f3.gltf")).unwrap();
    assert!(
        folder
            .error("f*.gltf")
            .starts_with("f3.gltf: holds 6 bodies"),
        "{}",
        folder.error("f*.gltf")
    );
}

/// Vertices are moved some thousands at a time, and each target is traversed once.
#[test]
fn morph_targets_move_vertices_of_large_meshes_too() {
    const COUNT: usize = 10_000;
    let moved = [0, 1, 4095, 4096, 8191, 8192, 9999];
    let floats = |row: &dyn Fn(usize) -> [f32; 3]| -> Vec<u8> {
        let numbers = (0..COUNT).flat_map(row);
        numbers.flat_map(f32::to_le_bytes).collect()
    };
    let lift = |vertex: usize| (vertex % 7) as f32;
    let push = |vertex: usize| f32::from(u8::from(moved.contains(&vertex)));
    let bytes = [
        floats(&|vertex| [vertex as f32, 0.0, 0.0]),
        floats(&|vertex| [0.0, lift(vertex), 0.0]),
        floats(&|vertex| [0.0, 0.5 * push(vertex), push(vertex)]),
    ];
    let size = 12 * COUNT;
    let accessor = |view: usize| {
        json!({"bufferView": view, "componentType": 5126, "count": COUNT,
        "type": "VEC3"})
    };
    let view = |at: usize| json!({"buffer": 0, "byteOffset": at * size, "byteLength": size});
    let data = STANDARD.encode(bytes.concat());
    let file = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "weights": [2.0, 0.0, 4.0]}],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0},
            "mode": 5,
            "targets": [{"POSITION": 1}, {"POSITION": 1}, {"POSITION": 2}],
        }]}],
        "accessors": [accessor(0), accessor(1), accessor(2)],
        "bufferViews": [view(0), view(1), view(2)],
        "buffers": [{"byteLength": 3 * size, "uri": format!("data:;base64,{data}")}],
    });
    let folder = Folder::new();
    folder.write("large.gltf", file.to_string());
    let frames = all_frames(&mut folder.open("large.gltf").unwrap()).unwrap();
    let expected = (0..COUNT).map(|vertex| {
        let [lift, push] = [lift(vertex), push(vertex)].map(f64::from);
        [vertex as f64, 2.0 * (lift + push), 4.0 * push]
    });
    assert_eq!(frames, [expected.collect::<Vec<_>>()]);
}

/// Positions of the first frame of the only body.
fn corners(folder: &Folder, text: String) -> Vec<[f32; 3]> {
    folder.write("t.gltf", text);
    let mut body = folder.open("t.gltf").unwrap();
    let Some(Positions::F32(positions)) = body.next_frame().unwrap() else {
        panic!()
    };
    positions.to_vec()
}

/// Number of welded vertices, and positions.
fn corners_of(folder: &Folder, text: String) -> (usize, Vec<[f32; 3]>) {
    folder.write("t.gltf", &text);
    let welded = folder.open("t.gltf").unwrap().welded();
    (welded, corners(folder, text))
}

/// A file of one triangle with these bytes as positions, and nothing else.
fn quantised(component: u32, normalized: bool, stride: usize, bytes: &[u8]) -> String {
    json!({
        "asset": {"version": "2.0"}, "extensionsRequired": ["KHR_mesh_quantization"],
        "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "scale": [2, 2, 2], "translation": [1, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": component, "normalized": normalized,
            "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len(), "byteStride": stride}],
        "buffers": [{"byteLength": bytes.len(),
            "uri": format!("data:;base64,{}", STANDARD.encode(bytes))}]
    })
    .to_string()
}

#[test]
fn quantised_positions_are_fractions_or_whole_numbers() {
    let folder = Folder::new();
    let bytes = [0, 0, 0, 9, 127, 0, 0, 9, 0, 129, 128, 9];
    let expected = [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, -2.0, -2.0]];
    assert_eq!(corners(&folder, quantised(5120, true, 4, &bytes)), expected);
    let expected = [[1.0, 0.0, 0.0], [255.0, 0.0, 0.0], [1.0, -254.0, -256.0]];
    assert_eq!(
        corners(&folder, quantised(5120, false, 4, &bytes)),
        expected
    );
    let shorts = [0, 0, 0, 0, 65535, 0, 0, 0, 0, 13107, 0, 0_u16].map(u16::to_le_bytes);
    let expected = [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 2.0 * 0.2, 0.0]];
    let said = corners(&folder, quantised(5123, true, 8, shorts.as_flattened()));
    assert_eq!(said, expected);
}

/// Two triangles with a common edge in bytes, and a morph target in shorts.
///
/// Seams depend on the numbers that the bytes stand for.
#[test]
fn quantised_seams_and_morph_targets() {
    let folder = Folder::new();
    let corners: [[i8; 4]; 6] = [
        [0, 0, 0, 9],
        [127, 0, 0, 9],
        [0, 127, 0, 9],
        [127, 0, 0, 1],
        [0, 0, 0, 1],
        [0, -127, 0, 1],
    ];
    let file = |delta: i16| {
        let mut bytes: Vec<u8> = corners
            .as_flattened()
            .iter()
            .map(|x| x.cast_unsigned())
            .collect();
        let up = [32767_i16, delta, 0, delta, 32767, -16384];
        bytes.extend(
            up.iter()
                .flat_map(|&z| [0, 0, z, 0])
                .flat_map(i16::to_le_bytes),
        );
        json!({
            "asset": {"version": "2.0"}, "extensionsRequired": ["KHR_mesh_quantization"],
            "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0, "scale": [0.5, 0.5, 0.5], "weights": [4]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0},
                "targets": [{"POSITION": 1}]}]}],
            "accessors": [{"bufferView": 0, "componentType": 5120, "normalized": true, "count": 6,
                "type": "VEC3"},
                {"bufferView": 1, "componentType": 5122, "normalized": true, "count": 6,
                    "type": "VEC3"}],
            "bufferViews": [{"buffer": 0, "byteLength": 24, "byteStride": 4},
                {"buffer": 0, "byteOffset": 24, "byteLength": 48, "byteStride": 8}],
            "buffers": [{"byteLength": bytes.len(),
                "uri": format!("data:;base64,{}", STANDARD.encode(&bytes))}]
        })
        .to_string()
    };
    let expected = [
        [0.0, 0.0, 2.0],
        [0.5, 0.0, 0.0],
        [0.0, 0.5, 0.0],
        [0.5, 0.0, 0.0],
        [0.0, 0.0, 2.0],
    ];
    assert_eq!(corners_of(&folder, file(0)).1[..5], expected);
    assert_eq!(corners_of(&folder, file(0)).0, 2);
    // Both ends of the edge still move together.
    assert_eq!(corners_of(&folder, file(1000)).0, 2);
    let half = corners_of(&folder, file(0)).1[5];
    assert!((half[2] + 1.0).abs() < 1e-4, "{half:?}");
}

#[test]
fn a_sparse_accessor_needs_no_other_data() {
    let folder = Folder::new();
    let mut file = triangle();
    let values = [1.0, 0.0, 0.0, 0.0, 2.0, 0.0_f32].map(f32::to_le_bytes);
    let bytes = [&[1_u8, 2, 0, 0][..], values.as_flattened()].concat();
    file["buffers"] = json!([file["buffers"][0],
        {"byteLength": bytes.len(), "uri": format!("data:;base64,{}", STANDARD.encode(&bytes))}]);
    file["bufferViews"] = json!([file["bufferViews"][0], {"buffer": 1, "byteLength": bytes.len()}]);
    file["accessors"][0] = json!({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
        "count": 2, "indices": {"bufferView": 1, "componentType": 5121},
            "values": {"bufferView": 1, "byteOffset": 4}}});
    file["animations"] = json!([]);
    file["skins"] = json!([]);
    file["nodes"][0] = json!({"mesh": 0});
    let expected = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
    assert_eq!(corners(&folder, file.to_string()), expected);
    // More rows than allowed are refused before they are made.
    file["accessors"][0]["count"] = json!(1_u64 << 30);
    file["accessors"][1]["count"] = json!(1_u64 << 30);
    folder.write("t.gltf", file.to_string());
    assert!(
        folder.error("t.gltf").contains("of memory"),
        "{}",
        folder.error("t.gltf")
    );
}

#[test]
fn animations_may_name_what_they_move_by_a_pointer() {
    let folder = Folder::new();
    let plain = triangle();
    let frames = |file: &Value| {
        folder.write("t.gltf", file.to_string());
        let mut body = folder.open("t.gltf").unwrap();
        let notes = body.notes().to_vec();
        (all_frames(&mut body).unwrap(), notes)
    };
    let (expected, notes) = frames(&plain);
    assert!(notes.is_empty() && expected.len() > 1);
    let pointer = |pointer: &str| {
        json!({"path": "pointer",
        "extensions": {"KHR_animation_pointer": {"pointer": pointer}}})
    };
    let mut file = plain.clone();
    file["extensionsRequired"] = json!(["KHR_animation_pointer"]);
    file["animations"][0]["channels"][0]["target"] = pointer("/nodes/1/translation");
    assert_eq!(frames(&file), (expected.clone(), vec![]));
    // Targets that are not evaluated are noted, once.
    for other in ["/materials/0/emissiveFactor", "/nodes/2/weights/0"] {
        let target = json!({"sampler": 0, "target": pointer(other)});
        file["animations"][0]["channels"]
            .as_array_mut()
            .unwrap()
            .push(target);
    }
    let first = "/materials/0/emissiveFactor".to_owned();
    let notes = vec![Note::StillTargets { count: 2, first }];
    assert_eq!(frames(&file), (expected, notes));
    // A pointer to a missing node is as wrong as its number.
    file["animations"][0]["channels"][0]["target"] = pointer("/nodes/9/translation");
    folder.write("t.gltf", file.to_string());
    assert!(folder.error("t.gltf").contains("moves node 9, which"));
}

#[test]
fn what_an_animation_moves_that_is_no_body_is_noted() {
    let folder = Folder::new();
    let frames = |file: &Value| {
        folder.write("t.gltf", file.to_string());
        let mut body = folder.open("t.gltf").unwrap();
        let notes = body.notes().to_vec();
        (all_frames(&mut body).unwrap(), notes)
    };
    let plain = triangle();
    let (expected, _) = frames(&plain);
    // Nodes 3 and 4 are in no scene, and 4 is a child of 3. Joint 2 is a child of 1 and moves only
    // the body.
    let mut file = plain.clone();
    let nodes = file["nodes"].as_array_mut().unwrap();
    nodes.extend([json!({"children": [4]}), json!({})]);
    let target = |target: Value| json!({"sampler": 0, "target": target});
    let channels = file["animations"][0]["channels"].as_array_mut().unwrap();
    channels.insert(0, target(json!({"node": 4, "path": "translation"})));
    channels.insert(0, target(json!({"node": 3, "path": "translation"})));
    channels.push(target(json!({"node": 0, "path": "weights"})));
    channels.push(target(json!({"node": 0, "path": "visibility"})));
    channels.push(target(json!({"path": "translation"})));
    let first = "/nodes/3/translation".to_owned();
    let note = |count, first: &str| {
        let first = first.to_owned();
        vec![Note::StillTargets { count, first }]
    };
    assert_eq!(frames(&file), (expected.clone(), note(5, &first)));
    // An ancestor of a joint moves the body, in whatever scene it is.
    file["skins"][0]["joints"] = json!([1, 4]);
    let (moved, notes) = frames(&file);
    assert_ne!(moved, expected);
    assert_eq!(notes, note(3, "/nodes/0/weights"));
}

#[test]
fn the_weights_of_a_mesh_are_those_of_its_nodes_without_their_own() {
    let folder = Folder::new();
    // Three nodes of one mesh with a target upwards: the second has its own weights, and an
    // animation gives the third its own.
    let mut bytes: Vec<u8> = Vec::new();
    for number in [
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, // positions
        0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, // deltas
        0.0, 1.0, // times
        2.0, 4.0, // weights of the mesh
        8.0, 16.0_f32, // those of the third node
    ] {
        bytes.extend(number.to_le_bytes());
    }
    let accessor = |offset: u32, count: u32, shape: &str| {
        json!({"bufferView": 0, "byteOffset": offset, "componentType": 5126,
            "count": count, "type": shape})
    };
    let pointer = |sampler: u32, pointer: &str| {
        json!({"sampler": sampler,
            "target": {"path": "pointer",
                "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}})
    };
    let mut file = json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0}, {"mesh": 0, "weights": [0.5]}, {"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}]}],
        // The third node takes precedence over its mesh, in any order.
        "animations": [{
            "channels": [{"sampler": 1, "target": {"node": 2, "path": "weights"}},
                pointer(0, "/meshes/0/weights")],
            "samplers": [{"input": 2, "output": 3}, {"input": 2, "output": 4}]
        }],
        "accessors": [accessor(0, 3, "VEC3"), accessor(36, 3, "VEC3"), accessor(72, 2, "SCALAR"),
            accessor(80, 2, "SCALAR"), accessor(88, 2, "SCALAR")],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}],
        "buffers": [{"byteLength": bytes.len(),
            "uri": format!("data:;base64,{}", STANDARD.encode(&bytes))}]
    });
    let heights = |file: &Value| {
        folder.write("m.gltf", file.to_string());
        let bodies = open_all(&folder.argument("m.gltf"), &OpenOptions::default()).unwrap();
        let ends = |mut body: Body| {
            let notes = body.notes().len();
            let frames = all_frames(&mut body).unwrap();
            let height = |frame: &Vec<[f64; 3]>| frame[0][2];
            (height(&frames[0]), height(&frames[frames.len() - 1]), notes)
        };
        bodies.into_iter().map(ends).collect::<Vec<_>>()
    };
    let expected = [(2.0, 4.0, 0), (0.5, 0.5, 0), (8.0, 16.0, 0)];
    assert_eq!(heights(&file), expected);
    // The same target twice is wrong. If every node has its own weights, or there is no such mesh,
    // nothing moves.
    let channels = &mut file["animations"][0]["channels"];
    channels[0] = pointer(0, "/meshes/7/weights");
    let expected = [(2.0, 4.0, 1), (0.5, 0.5, 0), (2.0, 4.0, 0)];
    assert_eq!(heights(&file), expected);
    file["animations"][0]["channels"][0] = pointer(0, "/meshes/0/weights");
    folder.write("m.gltf", file.to_string());
    let error = open_all(&folder.argument("m.gltf"), &OpenOptions::default()).unwrap_err();
    let error = error.to_string();
    assert!(error.contains("the weights of mesh 0 more than"), "{error}");
}

#[test]
fn what_is_compressed_or_older_is_refused_for_what_it_is() {
    let folder = Folder::new();
    let refused = |file: &Value, word: &str| {
        folder.write("t.gltf", file.to_string());
        let said = folder.error("t.gltf");
        assert!(said.contains(word), "{word}: {said}");
    };
    refused(
        &json!({"asset": {"version": "1.0"}, "meshes": {"a": {}}, "nodes": {}}),
        "is glTF \"1.0\"",
    );
    // Draco that is named but not required: read if there is other data, refused if not.
    let mut file = triangle();
    file["extensionsUsed"] = json!(["KHR_draco_mesh_compression", "EXT_meshopt_compression"]);
    let primitive = &mut file["meshes"][0]["primitives"][0];
    primitive["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    folder.write("t.gltf", file.to_string());
    folder.open("t.gltf").unwrap();
    let mut without = file.clone();
    without["accessors"][0]
        .as_object_mut()
        .unwrap()
        .remove("bufferView");
    refused(&without, "compressed by Draco");
    // Sparse values replace compressed ones, not zeros; indices and attributes may be compressed
    // too.
    without["accessors"][0]["sparse"] = json!({"count": 1,
        "indices": {"bufferView": 0, "byteOffset": 36, "componentType": 5121},
        "values": {"bufferView": 0, "byteOffset": 12}});
    refused(&without, "compressed by Draco");
    let mut without = file.clone();
    without["meshes"][0]["primitives"][0]["indices"] = json!(5);
    let accessors = without["accessors"].as_array_mut().unwrap();
    accessors.push(json!({"componentType": 5123, "count": 3, "type": "SCALAR"}));
    refused(&without, "compressed by Draco");
    for held in [1, 2] {
        let mut without = file.clone();
        let accessor = without["accessors"][held].as_object_mut().unwrap();
        accessor.remove("bufferView");
        refused(&without, "compressed by Draco");
    }
}

/// Every clip of a file, frame by frame.
fn clips(path: &str, names: &[&str]) -> Vec<Vec<Vec<Frame>>> {
    let clip = |name: &&str| {
        let bodies = open_all(path, &options(Some(name), 8.0)).unwrap();
        let frames = |mut body: Body| all_frames(&mut body).unwrap();
        bodies.into_iter().map(frames).collect()
    };
    names.iter().map(clip).collect()
}

#[test]
fn what_meshopt_compressed_is_what_it_was() {
    let text = |name: &str| -> Value {
        serde_json::from_str(&std::fs::read_to_string(fixture(name)).unwrap()).unwrap()
    };
    let (plain, compressed) = (text("skin.gltf"), text("skin-meshopt.gltf"));
    let animations = plain["animations"].as_array().unwrap().iter();
    let names: Vec<&str> = animations.map(|it| it["name"].as_str().unwrap()).collect();
    let expected = clips(fixture("skin.gltf").to_str().unwrap(), &names);
    let ours = clips(fixture("skin-meshopt.gltf").to_str().unwrap(), &names);
    assert_eq!(ours, expected);
    assert!(names.len() > 1 && compare(&fixture("skin-meshopt.gltf"), &fixture("skin.json")) > 100);

    // An uncompressed fallback is read where it exists and the compressed bytes do not.
    let folder = Folder::new();
    let mut other = compressed.clone();
    let first = other["buffers"][0]["byteLength"].as_u64().unwrap();
    let plain_view = &compressed["bufferViews"].as_array().unwrap()[4];
    assert_eq!(
        plain_view["buffer"], 0,
        "the only one that is not compressed"
    );
    other["buffers"][1]["uri"] = plain["buffers"][0]["uri"].clone();
    for (view, was) in other["bufferViews"]
        .as_array_mut()
        .unwrap()
        .iter_mut()
        .zip(plain["bufferViews"].as_array().unwrap())
    {
        if view["buffer"] == 1 {
            view["byteOffset"] = was["byteOffset"].clone();
        } else {
            *view = json!({"buffer": 1, "byteOffset": was["byteOffset"],
                "byteLength": was["byteLength"]});
        }
    }
    other["buffers"][0]["uri"] = json!(format!(
        "data:;base64,{}",
        STANDARD.encode(vec![7; first as usize])
    ));
    other["extensionsRequired"] = json!([]);
    folder.write("other.gltf", other.to_string());
    assert_eq!(clips(&folder.argument("other.gltf"), &names), expected);
}

#[test]
fn what_is_wrong_with_compressed_views_is_said() {
    let folder = Folder::new();
    let whole: Value =
        serde_json::from_str(&std::fs::read_to_string(fixture("skin-meshopt.gltf")).unwrap())
            .unwrap();
    let said = |file: &Value| {
        folder.write("t.gltf", file.to_string());
        let error = open_all(&folder.argument("t.gltf"), &OpenOptions::default()).unwrap_err();
        error.to_string()
    };
    // The second view, of positions: 14 rows of 12 bytes.
    let view = "/bufferViews/1/extensions/KHR_meshopt_compression";
    for (at, value, words) in [
        (
            "/count",
            json!(13),
            "buffer view 1: its compression has 13 rows of 12 bytes, it has 168 bytes",
        ),
        (
            "/count",
            json!(u64::MAX),
            "buffer view 1: its compression has",
        ),
        ("/byteStride", json!(0), "rows of 0 bytes, it has 168 bytes"),
        (
            "/byteLength",
            json!(106),
            "buffer view 1: its compressed bytes are",
        ),
        ("/byteLength", json!(1_u64 << 40), "buffer 0"),
        ("/byteOffset", json!(u64::MAX), "buffer 0"),
        (
            "/byteOffset",
            json!(3),
            "buffer view 1: its compressed bytes begin with another byte than their mode needs",
        ),
        (
            "/buffer",
            json!(1),
            "has neither a URI nor bytes behind the JSON",
        ),
        ("/buffer", json!(9), "there is no such buffer"),
        (
            "/mode",
            json!("POINTS"),
            "has mode \"POINTS\"; there are ATTRIBUTES",
        ),
        (
            "/filter",
            json!("QUATERNION"),
            "a byteStride that its filter cannot have",
        ),
        (
            "/filter",
            json!("COLOR"),
            "with filter \"COLOR\", which is not evaluated; export it without compression",
        ),
    ] {
        let mut file = whole.clone();
        file.pointer_mut(view).unwrap()[&at[1..]] = value;
        let said = said(&file);
        assert!(
            said.contains(words) && said.lines().count() == 1,
            "{words}: {said}"
        );
    }
    // More rows than allowed are refused before any is made.
    let mut file = whole.clone();
    let rows = 1_u64 << 40;
    file["bufferViews"][1]["byteLength"] = json!(rows * 12);
    file["buffers"][1]["byteLength"] = json!(rows * 12);
    file.pointer_mut(view).unwrap()["count"] = json!(rows);
    let refused = said(&file);
    assert!(refused.contains("of memory"), "{refused}");
}

/// Chunks of GLB files begin at multiples of four, but not in files of some programs.
#[test]
fn chunks_of_glb_may_follow_each_other_at_once() {
    let folder = Folder::new();
    let mut file = triangle();
    let uri = file["buffers"][0]["uri"].as_str().unwrap().to_owned();
    let bytes = STANDARD.decode(uri.split_once(',').unwrap().1).unwrap();
    file["buffers"][0].as_object_mut().unwrap().remove("uri");
    for padding in 0..4 {
        let json = file.to_string() + &" ".repeat(padding);
        let length = |length: usize| (length as u32).to_le_bytes();
        let all = 12 + 8 + json.len() + 8 + bytes.len();
        let glb = [
            &b"glTF\x02\0\0\0"[..],
            &length(all),
            &length(json.len()),
            b"JSON",
            json.as_bytes(),
            &length(bytes.len()),
            b"BIN\0",
            &bytes,
        ];
        folder.write("t.glb", glb.concat());
        let mut body = folder.open("t.glb").unwrap();
        assert!(body.next_frame().unwrap().is_some(), "{padding}");
    }
}

/// A fan of triangles round one place, each with its own vertices and next to the one before.
///
/// The second of two joints moves; `weights[i]` is its weight at the vertices of triangle i.
fn fan(weights: &[f32]) -> String {
    let place = |at: usize| {
        let angle = at as f32 / weights.len() as f32 * 6.0;
        [angle.cos(), angle.sin(), 0.0]
    };
    let mut bytes = Vec::new();
    for at in 0..weights.len() {
        let corners = [[0.0_f32; 3], place(at), place(at + 1)];
        bytes.extend(corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    }
    let count = 3 * weights.len();
    let joints = bytes.len();
    bytes.extend([0, 1, 0, 0].repeat(count));
    let held = bytes.len();
    for &weight in weights {
        let four = [1.0 - weight, weight, 0.0, 0.0].repeat(3);
        bytes.extend(four.iter().flat_map(|x| x.to_le_bytes()));
    }
    let times = bytes.len();
    let moved = [0.0, 1.0, 0.0, 0.0, 0.0, 100.0, 200.0, 300.0_f32];
    bytes.extend(moved.iter().flat_map(|x| x.to_le_bytes()));
    let accessor = |offset: usize, kind: u32, count: usize, shape: &str| {
        json!({"bufferView": 0, "byteOffset": offset, "componentType": kind,
            "count": count, "type": shape})
    };
    json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0, "skin": 0}, {}, {}],
        "skins": [{"joints": [1, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1,
            "WEIGHTS_0": 2}}]}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}],
            "samplers": [{"input": 3, "output": 4}]}],
        "accessors": [accessor(0, 5126, count, "VEC3"), accessor(joints, 5121, count, "VEC4"),
            accessor(held, 5126, count, "VEC4"),
            accessor(times, 5126, 2, "SCALAR"), accessor(times + 8, 5126, 2, "VEC3")],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len()}],
        "buffers": [{"byteLength": bytes.len(),
            "uri": format!("data:;base64,{}", STANDARD.encode(&bytes))}]
    })
    .to_string()
}

#[test]
fn vertices_joined_by_nearly_equal_weights_are_one_in_every_frame() {
    let folder = Folder::new();
    let read = |weights: &[f32]| {
        folder.write("fan.gltf", fan(weights));
        let mut body = folder.open("fan.gltf").unwrap();
        let (welded, notes) = (body.welded(), body.notes().to_vec());
        let triangles = body.triangles().to_vec();
        (welded, notes, triangles, all_frames(&mut body).unwrap())
    };
    // The centre and the edge between: moved by 374 they part, and no frame is refused.
    let (welded, notes, triangles, frames) = read(&[0.5, 0.500_006]);
    assert_eq!((welded, &triangles[..]), (2, &[[0, 1, 2], [0, 2, 5]][..]));
    assert_eq!(notes, [Note::SeamsByWeights { count: 2 }]);
    assert_eq!(frames.len(), 31);
    // Each vertex is compared with the smallest of its class, not with the next one. So 0.5 joins
    // all that is within 1e-5 of it, and the others stay apart.
    let chain = [0.5, 0.500_008, 0.500_016, 0.500_024];
    let (welded, notes, triangles, _) = read(&chain);
    assert_eq!(welded, 4);
    assert_eq!(notes, [Note::SeamsByWeights { count: 4 }]);
    assert_eq!(
        triangles,
        [[0, 1, 2], [0, 2, 5], [6, 7, 8], [6, 8, 11]],
        "two and two"
    );
    // Bitwise equal vertices are welded however many others are at that place.
    let mut many: Vec<f32> = (0..200).map(|at| 0.1 + at as f32 * 1e-3).collect();
    many.extend([0.9, 0.9]);
    let (welded, notes, ..) = read(&many);
    assert_eq!((welded, &notes[..]), (2, &[][..]));
}
