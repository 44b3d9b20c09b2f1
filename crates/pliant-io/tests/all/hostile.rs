//! Fuzzing of all readers: any bytes give frames or an error of one line.
//!
//! No input may panic, or take much memory or time.

use std::sync::LazyLock;

use crate::common::{Folder, all_frames, bytes, npy, npz, tetrahedron};
use pliant_io::{Body, Error, Files, OpenOptions};
use proptest::prelude::*;
use zip::CompressionMethod;

/// Reads `contents` as a file with this `ending`. Every error is one line and names a file. From
/// memory everything is the same.
fn survives(ending: &str, contents: &[u8]) {
    static FOLDER: LazyLock<Folder> = LazyLock::new(|| {
        let folder = Folder::new();
        for (name, contents) in BESIDE {
            folder.write(name, contents);
        }
        folder
    });
    const BESIDE: [(&str, &[u8]); 2] = [
        (
            "mesh.obj",
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
        ),
        (
            "morph data.bin",
            include_bytes!("../fixtures/morph data.bin"),
        ),
    ];
    let name = format!("{:?}{ending}", std::thread::current().id());
    FOLDER.write(&name, contents);
    let in_folder = |(name, contents): (&str, &[u8])| (FOLDER.argument(name), contents.to_vec());
    let files = BESIDE.into_iter().chain([(name.as_str(), contents)]);
    let memory = Files::in_memory(files.map(in_folder)).unwrap();
    let mut argument = FOLDER.argument(&name);
    if [".pc2", ".mdd"].contains(&ending) {
        argument = format!("{}+{argument}", FOLDER.argument("mesh.obj"));
    }
    for weld in [true, false] {
        let [on_disk, in_memory] = [Files::default(), memory.clone()].map(|files| {
            let options = OpenOptions {
                weld,
                max_memory: 1 << 20,
                files,
                ..OpenOptions::default()
            };
            let bodies = pliant_io::open_all(&argument, &options)?;
            bodies.into_iter().take(20).map(read).collect()
        });
        assert_eq!(format!("{on_disk:?}"), format!("{in_memory:?}"));
        let on_disk: Result<Vec<_>, Error> = on_disk;
        if let Err(error) = on_disk {
            assert_eq!(error.to_string().lines().count(), 1, "{error}");
            // The file itself, or one beside it that it says it needs.
            let folder = FOLDER.path().to_str().unwrap();
            assert!(error.to_string().contains(folder), "{error}");
        }
    }
}

/// All frames of a body, after a look at what it says of itself.
fn read(mut body: Body) -> Result<Vec<Vec<[f64; 3]>>, Error> {
    let (frames, vertices) = (body.frame_count(), body.vertex_count());
    let mut corners = body.triangles().as_flattened().iter();
    assert!(corners.all(|&corner| (corner as usize) < vertices));
    let groups = body.groups()?;
    let count = groups.names.len();
    let is_there = |&group: &u32| (group as usize) < count;
    assert!(groups.of_triangles.iter().all(is_there));
    // A few bytes can hold a great many frames.
    if frames > 1000 {
        return Ok(Vec::new());
    }
    let read = all_frames(&mut body)?;
    assert_eq!(read.len(), frames);
    assert!(read.iter().all(|frame| frame.len() == vertices));
    let mut values = read.iter().flatten().flatten();
    assert!(values.all(|value| value.abs() <= f64::from(f32::MAX)));
    Ok(read)
}

/// A change to a valid file.
#[derive(Debug, Clone)]
enum Damage {
    Cut(usize),
    Flip(usize, u8),
    Put(usize, Vec<u8>),
    Remove(usize, usize),
    /// Copies a range over another place.
    Copy(usize, usize, usize),
}

fn damage() -> impl Strategy<Value = Damage> {
    let place = 0..1_usize << 16;
    let words = prop::sample::select(vec![
        "-1",
        "0",
        "nan",
        "inf",
        "1e999",
        "4294967295",
        "18446744073709551615",
        "99999999999999999999",
        "/",
        "\\\n",
        "\n",
        "\0",
        "x",
        "{",
        "(",
        "\u{ff}",
        "face",
        "vertex",
        "end_header\n",
        "list",
        "f 1 2 3\n",
        "-0.0",
        "\r",
    ]);
    prop_oneof![
        place.clone().prop_map(Damage::Cut),
        (place.clone(), any::<u8>()).prop_map(|(at, bits)| Damage::Flip(at, bits)),
        (place.clone(), words).prop_map(|(at, word)| Damage::Put(at, word.into())),
        (place.clone(), prop::collection::vec(any::<u8>(), 1..9))
            .prop_map(|(at, bytes)| Damage::Put(at, bytes)),
        (place.clone(), 1..20_usize).prop_map(|(at, length)| Damage::Remove(at, length)),
        (place.clone(), place, 1..40_usize)
            .prop_map(|(from, to, length)| Damage::Copy(from, to, length)),
    ]
}

fn damaged(mut file: Vec<u8>, damages: &[Damage]) -> Vec<u8> {
    for damage in damages {
        let size = file.len().max(1);
        match damage {
            Damage::Cut(at) => file.truncate(at % size),
            Damage::Flip(at, bits) => {
                if let Some(byte) = file.get_mut(at % size) {
                    *byte ^= bits;
                }
            }
            Damage::Put(at, bytes) => {
                let at = (at % size).min(file.len());
                file.splice(at..at, bytes.iter().copied());
            }
            Damage::Remove(at, length) => {
                let at = (at % size).min(file.len());
                let end = (at + length).min(file.len());
                file.drain(at..end);
            }
            Damage::Copy(from, to, length) => {
                let (from, to) = ((from % size).min(file.len()), (to % size).min(file.len()));
                let stretch = file[from..(from + length).min(file.len())].to_vec();
                let end = (to + stretch.len()).min(file.len());
                file.splice(to..end, stretch);
            }
        }
    }
    file
}

fn valid_ply(encoding: &str) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat {encoding} 1.0\n\
         element vertex 4\nproperty float x\nproperty list uchar short tags\n\
         property double y\nproperty int z\n\
         element face 2\nproperty list uchar uint vertex_indices\n\
         property char flag\nend_header\n"
    )
    .into_bytes();
    if encoding == "ascii" {
        file.extend(b"0 0 0 0\n1 1 7 0 0\n0 2 8 9 1 0\n0 0 0 1\n3 0 1 2 5\n4 0 2 1 3 6\n");
        return file;
    }
    let mut put = |little: &[u8]| {
        let mut bytes = little.to_vec();
        if encoding == "binary_big_endian" {
            bytes.reverse();
        }
        file.extend(bytes);
    };
    for (x, y, z) in [
        (0_f32, 0_f64, 0_i32),
        (1.0, 0.0, 0),
        (0.0, 1.0, 0),
        (0.0, 0.0, 1),
    ] {
        put(&x.to_le_bytes());
        put(&[1]);
        put(&7_i16.to_le_bytes());
        put(&y.to_le_bytes());
        put(&z.to_le_bytes());
    }
    for corners in [&[0_u32, 1, 2][..], &[0, 2, 1, 3]] {
        put(&[corners.len() as u8]);
        for corner in corners {
            put(&corner.to_le_bytes());
        }
        put(&[0]);
    }
    file
}

fn valid_npz(method: CompressionMethod) -> Vec<u8> {
    let vertices = bytes(&[0.5_f32; 24], f32::to_le_bytes);
    let faces = bytes(&[0_u16, 1, 2, 3, 2, 1], u16::to_le_bytes);
    npz(
        method,
        &[
            ("vertices", npy("<f4", false, &[2, 4, 3], &vertices)),
            ("faces", npy("<u2", false, &[2, 3], &faces)),
        ],
    )
}

fn valid_obj() -> Vec<u8> {
    (tetrahedron(1.5)
        + "# end \\\no arm \\\n b\nf -4/1 -3//2 \\\n-2/1/1 -1\ng hand\nv 1 2 3 4\nf 1 2 3\n")
        .into_bytes()
}

fn valid_stl(text: bool) -> Vec<u8> {
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
    if text {
        let [a, b, c] = corners.map(|[x, y, z]| format!("vertex {x} {y} {z}\n"));
        let facet = format!("facet normal 0 0 1\nouter loop\n{a}{b}{c}endloop\nendfacet\n");
        return format!("solid a\n{facet}{facet}endsolid\n").into_bytes();
    }
    let mut triangle = vec![0; 12];
    triangle.extend(bytes(corners.as_flattened(), f32::to_le_bytes));
    triangle.extend([0, 0]);
    [&[b' '; 80][..], &[2, 0, 0, 0], &triangle, &triangle].concat()
}

fn valid_cache(pc2: bool) -> Vec<u8> {
    let positions = [0.5_f32; 24];
    if pc2 {
        let head = b"POINTCACHE2\0\x01\0\0\0\x04\0\0\0\0\0\0\0\0\0\x80\x3f\x02\0\0\0";
        return [&head[..], &bytes(&positions, f32::to_le_bytes)].concat();
    }
    let head = b"\0\0\0\x02\0\0\0\x04\0\0\0\0\x3f\0\0\0";
    [&head[..], &bytes(&positions, f32::to_be_bytes)].concat()
}

/// Files of this crate's tests: every kind of clip and mesh, as text and as GLB.
const GLTF: [&[u8]; 6] = [
    include_bytes!("../fixtures/hierarchy.gltf"),
    include_bytes!("../fixtures/skin.gltf"),
    include_bytes!("../fixtures/skin-meshopt.gltf"),
    include_bytes!("../fixtures/skin-and-morph.gltf"),
    include_bytes!("../fixtures/kinds.glb"),
    include_bytes!("../fixtures/morph.gltf"),
];

/// The undamaged files are read without an error.
#[test]
fn the_files_to_damage_are_valid() {
    let folder = Folder::new();
    folder
        .write("a.obj", valid_obj())
        .write("s.npz", valid_npz(CompressionMethod::Stored))
        .write("d.npz", valid_npz(CompressionMethod::DEFLATE));
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        folder.write(&format!("{encoding}.ply"), valid_ply(encoding));
    }
    folder
        .write("a.stl", valid_stl(true))
        .write("b.stl", valid_stl(false));
    for name in [
        "a.stl",
        "b.stl",
        "a.obj",
        "s.npz",
        "d.npz",
        "ascii.ply",
        "binary_little_endian.ply",
        "binary_big_endian.ply",
    ] {
        let mut body = folder.open(name).unwrap();
        assert_eq!(all_frames(&mut body).unwrap().len(), body.frame_count());
    }
}

// PROPTEST_CASES is the number of cases, 256 by default.
proptest! {
    #[test]
    fn damaged_obj(damages in prop::collection::vec(damage(), 1..5)) {
        survives(".obj", &damaged(valid_obj(), &damages));
    }

    #[test]
    fn damaged_ply(damages in prop::collection::vec(damage(), 1..5)) {
        for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
            survives(".ply", &damaged(valid_ply(encoding), &damages));
        }
    }

    #[test]
    fn damaged_npz(damages in prop::collection::vec(damage(), 1..5)) {
        for method in [CompressionMethod::Stored, CompressionMethod::DEFLATE] {
            survives(".npz", &damaged(valid_npz(method), &damages));
        }
    }

    #[test]
    fn damaged_arrays(damages in prop::collection::vec(damage(), 1..3), second in any::<bool>()) {
        // Damage inside an intact archive, which no checksum catches.
        let vertices = npy("<f4", false, &[2, 4, 3], &bytes(&[0.5_f32; 24], f32::to_le_bytes));
        let faces = npy("<u2", false, &[2, 3], &bytes(&[0_u16, 1, 2, 3, 2, 1], u16::to_le_bytes));
        let arrays = if second {
            [("vertices", vertices), ("faces", damaged(faces, &damages))]
        } else {
            [("vertices", damaged(vertices, &damages)), ("faces", faces)]
        };
        survives(".npz", &npz(CompressionMethod::DEFLATE, &arrays));
    }

    #[test]
    fn damaged_stl(damages in prop::collection::vec(damage(), 1..5), text in any::<bool>()) {
        survives(".stl", &damaged(valid_stl(text), &damages));
    }

    #[test]
    fn damaged_caches(damages in prop::collection::vec(damage(), 1..3), pc2 in any::<bool>()) {
        survives(if pc2 { ".pc2" } else { ".mdd" }, &damaged(valid_cache(pc2), &damages));
    }

    #[test]
    fn damaged_gltf(damages in prop::collection::vec(damage(), 1..5), file in 0..5_usize) {
        survives(".gltf", &damaged(GLTF[file].to_vec(), &damages));
    }

    #[test]
    fn noise(contents in prop::collection::vec(any::<u8>(), 0..300)) {
        for ending in [".obj", ".ply", ".npz", ".stl", ".gltf", ".pc2", ".mdd"] {
            survives(ending, &contents);
        }
        for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
            let header = valid_ply(encoding);
            let end = header.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
            survives(".ply", &[&header[..end], &contents].concat());
        }
    }
}
