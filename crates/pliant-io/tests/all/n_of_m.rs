//! Small glTF files that say "n of m": n nodes that each repeat m weights or m letters of one mesh.
//!
//! Such data are shared or counted. So the allocated memory stays within the limit, or the file is
//! refused by it; every allocation is measured.

use crate::common::Folder;
use allocation_counter::measure;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pliant_io::{Body, OpenOptions, Reason, open_all};
use serde_json::{Value, json};

/// A limit in bytes that all the parsed files stay well below.
const LIMIT: u64 = 64 << 20;

/// Allowance in bytes for memory that is not counted.
///
/// That is the text of a file, the state of the parser, and unused capacity. A few arrays of each
/// body begin with some; of a large one the unused part is allocated, but takes no memory.
const BESIDE: u64 = 48 << 20;

/// A file of `n` nodes with one mesh of one triangle.
fn scene(n: usize) -> Value {
    let corners: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
    let bytes = corners.map(f32::to_le_bytes).concat();
    json!({
        "scenes": [{"nodes": (0..n).collect::<Vec<_>>()}],
        "nodes": vec![json!({"mesh": 0}); n],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": format!("data:;base64,{}", STANDARD.encode(bytes))}],
    })
}

/// Opens the bodies of a file within [`LIMIT`]; returns them and the bytes allocated.
///
/// Fails if more is allocated at once.
fn opened(file: &Value) -> (Result<Vec<Body>, pliant_io::Error>, u64) {
    let folder = Folder::new();
    let text = file.to_string();
    assert!(
        text.len() < 2 << 20,
        "{} bytes are no small file",
        text.len()
    );
    folder.write("n.gltf", &text);
    let options = OpenOptions {
        max_memory: LIMIT,
        ..OpenOptions::default()
    };
    let argument = folder.argument("n.gltf");
    let mut bodies = None;
    let allocated = measure(|| bodies = Some(open_all(&argument, &options)));
    let most = allocated.bytes_max;
    println!("{} bytes of file, {most} allocated", text.len());
    assert!(most < LIMIT + BESIDE, "{most} bytes");
    (bodies.unwrap(), most)
}

fn refused(file: &Value) {
    let error = opened(file).0.unwrap_err();
    let is_limit = matches!(error.reason(), Reason::TooLarge { limit: LIMIT, .. });
    assert!(is_limit, "{error}");
}

/// 10,000 nodes that share the 10,000 weights of a mesh: separately they would take 800 MB.
#[test]
fn weights_of_a_mesh_are_shared_by_its_nodes() {
    let mut file = scene(10_000);
    file["meshes"][0]["weights"] = vec![json!(0); 10_000].into();
    let (bodies, _) = opened(&file);
    assert_eq!(bodies.unwrap().len(), 10_000);
}

/// 2,000 nodes with the name of their mesh, which is 100,000 letters long: 200 MB.
#[test]
fn names_of_a_mesh_are_counted_for_each_of_its_nodes() {
    let mut file = scene(2_000);
    file["meshes"][0]["name"] = "a".repeat(100_000).into();
    refused(&file);
    // Within the limit, names are as in the file.
    let mut file = scene(20);
    file["meshes"][0]["name"] = "a".repeat(100_000).into();
    let bodies = opened(&file).0.unwrap();
    let ending = format!("#{} (node 19)", "a".repeat(100_000));
    assert!(bodies[19].name().ends_with(&ending));
}

/// 2,000 bodies that stand still in a clip of zero length, whose name is 100,000 letters long.
#[test]
fn the_name_of_a_clip_is_shared_by_its_bodies() {
    let mut file = scene(2_001);
    file["scenes"][0]["nodes"] = json!([2_000]);
    file["nodes"][2_000] = json!({"children": (0..2_000).collect::<Vec<_>>()});
    let name = "a".repeat(100_000);
    let number =
        |shape: &str| json!({"bufferView": 0, "componentType": 5126, "count": 1, "type": shape});
    let accessors = file["accessors"].as_array_mut().unwrap();
    accessors.extend([number("SCALAR"), number("VEC3")]);
    file["animations"] = json!([{
        "name": name,
        "channels": [{"sampler": 0, "target": {"node": 2_000, "path": "translation"}}],
        "samplers": [{"input": 1, "output": 2}],
    }]);
    let bodies = opened(&file).0.unwrap();
    assert_eq!((bodies.len(), bodies[9].frame_count()), (2_000, 1));
    assert!(bodies.iter().all(|body| body.clip() == Some(&name)));
}

/// 4,000 nodes whose 4,000 morph targets a clip moves: the weights of a frame take 128 MB.
#[test]
fn weights_that_a_clip_gives_to_morph_targets_are_counted() {
    let mut file = scene(4_000);
    file["meshes"][0]["primitives"][0]["targets"] = vec![json!({}); 4_000].into();
    let zeros = STANDARD.encode([0; 16_000]);
    let mut more = |list: &str, entry: Value| file[list].as_array_mut().unwrap().push(entry);
    more(
        "buffers",
        json!({"byteLength": 16_000, "uri": format!("data:;base64,{zeros}")}),
    );
    more("bufferViews", json!({"buffer": 1, "byteLength": 16_000}));
    let numbers = |count: u32| {
        json!({"bufferView": 1, "componentType": 5126, "count": count,
        "type": "SCALAR"})
    };
    let accessors = file["accessors"].as_array_mut().unwrap();
    accessors.extend([numbers(1), numbers(4_000)]);
    let channel = |node: usize| json!({"sampler": 0, "target": {"node": node, "path": "weights"}});
    file["animations"] = json!([{
        "channels": (0..4_000).map(channel).collect::<Vec<_>>(),
        "samplers": [{"input": 1, "output": 2}],
    }]);
    refused(&file);
    file["animations"][0]["channels"]
        .as_array_mut()
        .unwrap()
        .truncate(400);
    assert_eq!(opened(&file).0.unwrap().len(), 4_000);
}

/// 50,000 morph targets that are the same 50,000 zeros are read once; 1,000 different ones are
/// refused.
///
/// To read them all, and the ones of larger files, would take minutes and hours.
#[test]
fn morph_targets_that_move_nothing_take_no_time() {
    let folder = Folder::new();
    let rows = 50_000;
    folder.write("zeros.bin", vec![0; 12 * rows]);
    let mut file = scene(1);
    let zeros = json!({"bufferView": 0, "componentType": 5126, "count": rows, "type": "VEC3"});
    file["buffers"] = json!([{"byteLength": 12 * rows, "uri": "zeros.bin"}]);
    file["bufferViews"][0]["byteLength"] = json!(12 * rows);
    let open = |file: &Value| {
        folder.write("zeros.gltf", file.to_string());
        folder.open("zeros.gltf")
    };
    let targets = |file: &mut Value, accessors: &mut dyn Iterator<Item = usize>| {
        let target = |accessor: usize| json!({"POSITION": accessor});
        let primitive = &mut file["meshes"][0]["primitives"][0];
        // Strips of one place: triangles take no time.
        primitive["indices"] = json!(0);
        primitive["targets"] = accessors.map(target).collect();
    };
    file["accessors"] =
        json!([{"bufferView": 0, "componentType": 5125, "count": 3, "type": "SCALAR"}, zeros]);
    targets(&mut file, &mut std::iter::repeat_n(1, 50_000));
    file["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(1);
    let read = measure(|| assert_eq!(open(&file).unwrap().vertex_count(), rows));
    // Separate copies would take 600 KB each.
    let total = read.bytes_total;
    assert!(
        total < 1 << 30,
        "{total} bytes, and nothing is to be read twice"
    );

    file["accessors"]
        .as_array_mut()
        .unwrap()
        .extend(vec![zeros; 1_000]);
    targets(&mut file, &mut (2..1_002));
    let error = open(&file).unwrap_err();
    let said = "zero displacements, the most that are read; sparse accessors leave them out";
    assert!(
        error.to_string().ends_with(said)
            && error
                .to_string()
                .contains("mesh 0: its morph targets hold more than"),
        "{error}"
    );
}
