//! Unusual files that are read where their meaning is clear, with a note about it.

use crate::common::{Folder, all_frames, bytes, npy, npz};
use pliant_io::{Body, OpenOptions, Positions, Precision, Reason};
use zip::CompressionMethod;

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";
const PLY: &str = "ply\nformat ascii 1.0\n\
    element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    element face 2\nproperty list uchar int vertex_index\nend_header\n\
    0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n";
const STL: &str = "solid a\nfacet normal 0 0 1\n\
    outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
    endsolid a\n";

fn notes(body: &Body) -> String {
    let notes = body.notes().iter().map(ToString::to_string);
    notes.collect::<Vec<_>>().join("; ")
}

#[test]
fn lines_of_old_macs_are_lines() {
    for (name, text) in [("a.obj", OBJ), ("a.ply", PLY), ("a.stl", STL)] {
        let folder = Folder::new();
        let mut whole = folder.write(name, text).open(name).unwrap();
        let returns = text.replace('\n', "\r");
        let mut body = folder.write(name, returns).open(name).unwrap();
        assert_eq!(body.triangles(), whole.triangles(), "{name}");
        assert_eq!(
            all_frames(&mut body).unwrap(),
            all_frames(&mut whole).unwrap()
        );
        // A malformed line is named by its number.
        let wrong = text.replacen("0 1 0", "0 one 0", 1);
        let lines = text.split_once("0 1 0").unwrap().0.matches('\n').count();
        let message = folder.write(name, wrong.replace('\n', "\r")).error(name);
        assert!(
            message.contains(&format!("line {}", lines + 1)),
            "{message}"
        );
    }
    // The data of a binary file begins where its header ends, whatever its first byte is.
    let header = "ply\rformat binary_little_endian 1.0\r\
        element vertex 3\rproperty float x\rproperty float y\rproperty float z\r\
        element face 1\rproperty list uchar int vertex_index\rend_header\r";
    let first = f32::from_le_bytes([b'\n', b'\r', b'\n', 0x3f]);
    let corners = [first, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut file = header.as_bytes().to_vec();
    file.extend(bytes(&corners, f32::to_le_bytes));
    file.push(3);
    file.extend(bytes(&[0_i32, 1, 2], i32::to_le_bytes));
    let body = Folder::new().write("b.ply", file).open("b.ply").unwrap();
    assert_eq!(
        body.positions().get(0)[0].to_bits(),
        f64::from(first).to_bits()
    );
}

#[test]
fn a_face_of_two_corners_is_a_segment() {
    let ply = PLY.replace("3 0 1 3", "2 1 3");
    let obj = OBJ.replace("f 1 2 4", "f 2/5 4/5");
    for (name, text) in [("a.obj", obj), ("a.ply", ply)] {
        let folder = Folder::new();
        let body = folder.write(name, text).open(name).unwrap();
        assert_eq!(body.triangles(), [[0, 1, 2], [1, 3, 3]]);
        let said = "1 faces have two corners (the first is face 1) and are read as segments";
        assert_eq!(notes(&body), said);
    }
}

#[test]
fn an_stl_file_may_lack_its_end() {
    let folder = Folder::new();
    for (text, said) in [
        (STL.to_owned(), ""),
        (
            STL.replace("endsolid a", "end solid"),
            "ends with \"end solid\" in place of \"endsolid\"; all its triangles were read",
        ),
        (
            STL.replace("endsolid a\n", ""),
            "ends without \"endsolid\"; all its triangles were read",
        ),
    ] {
        let body = folder.write("a.stl", text).open("a.stl").unwrap();
        assert_eq!((body.triangles().len(), notes(&body).as_str()), (1, said));
    }
}

#[test]
fn two_coordinates_are_said_to_be_two() {
    let flat = npy("<f4", false, &[3, 2], &bytes(&[0_f32; 6], f32::to_le_bytes));
    let faces = npy("|u1", false, &[1, 3], &[0, 1, 2]);
    let flat = npz(
        CompressionMethod::Stored,
        &[("vertices", flat), ("faces", faces)],
    );
    let folder = Folder::new();
    folder
        .write("a.obj", OBJ.replace("v 0 1 0", "v 0 1"))
        .write("a.stl", STL.replace("vertex 0 1 0", "vertex 0 1"))
        .write("a.ply", PLY.replace("property float z\n", ""))
        .write("a.npz", flat);
    for name in ["a.obj", "a.stl", "a.ply", "a.npz"] {
        let message = folder.error(name);
        assert!(
            message.ends_with("two coordinates; pliant needs three"),
            "{message}"
        );
    }
}

#[test]
fn what_git_lfs_left_is_named_in_every_format() {
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n";
    let folder = Folder::new();
    folder.write("mesh.obj", OBJ);
    for ending in ["obj", "ply", "stl", "npz", "glb", "gltf", "vrm"] {
        let name = format!("a.{ending}");
        folder.write(&name, pointer);
        let error = pliant_io::open(&folder.argument(&name), &OpenOptions::default()).unwrap_err();
        assert!(matches!(error.reason(), Reason::LfsPointer), "{error}");
        assert!(
            error
                .to_string()
                .ends_with("fetch that with `git lfs pull`"),
            "{error}"
        );
    }
    for ending in ["pc2", "mdd", "npy"] {
        folder.write(&format!("a.{ending}"), pointer);
        for argument in ["mesh.obj", "a.obj"] {
            let positions = folder.argument(&format!("a.{ending}"));
            let message = folder.error(&format!("{argument}+{positions}"));
            assert!(message.contains("Git LFS pointer"), "{message}");
        }
    }
    // A buffer beside a file; and a pointer that is cut short.
    let gltf = concat!(
        r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":132,"uri":"a.pc2"}],"#,
        r#""bufferViews":[{"buffer":0,"byteLength":36}],"#,
        r#""accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"#,
        r#""meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"#,
        r#""scenes":[{"nodes":[0]}]}"#,
    );
    let message = folder.write("b.gltf", gltf).error("b.gltf");
    assert!(message.contains("Git LFS pointer"), "{message}");
    let message = folder.write("a.obj", &pointer[..20]).error("a.obj");
    assert_eq!(message, "a.obj: holds no vertices");
}

/// Two frames of four vertices, as integers that every type holds.
const NUMBERS: [u8; 24] = [
    0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, 3, 1, 1, 1, 5, 1, 1, 1, 5, 1, 1, 1, 5,
];
const FACES: [u8; 6] = [0, 1, 2, 0, 2, 3];

/// The numbers in Fortran order: the first index varies fastest.
fn by_columns<T: Copy>(numbers: &[T], shape: &[usize]) -> Vec<T> {
    let mut columns = Vec::new();
    for at in 0..numbers.len() {
        let (mut rest, mut place, mut stride) = (at, 0, numbers.len());
        for &size in shape {
            stride /= size;
            place += rest % size * stride;
            rest /= size;
        }
        columns.push(numbers[place]);
    }
    columns
}

fn expected() -> Vec<Vec<[f64; 3]>> {
    let frame = |numbers: &[u8]| {
        numbers
            .as_chunks::<3>()
            .0
            .iter()
            .map(|it| it.map(f64::from))
            .collect()
    };
    NUMBERS.chunks(12).map(frame).collect()
}

fn frames(body: &mut Body) -> Vec<Vec<[f64; 3]>> {
    let mut all = Vec::new();
    while let Some(positions) = body.next_frame().unwrap() {
        all.push((0..4).map(|vertex| positions.get(vertex)).collect());
    }
    all
}

type Written = (&'static str, Vec<u8>, Precision);

/// The numbers in every type except the two usual ones.
fn types(numbers: &[u8]) -> Vec<Written> {
    // Small integers in half precision: 2^p (1 + f / 1024).
    let half = |x: u8| match x {
        0 => 0_u16,
        x => {
            let power = x.ilog2();
            let fraction = (u16::from(x) << (10 - power)) & 1023;
            ((power as u16 + 15) << 10) | fraction
        }
    };
    vec![
        ("|u1", numbers.to_vec(), Precision::F32),
        ("|i1", numbers.to_vec(), Precision::F32),
        (
            "<f2",
            bytes(numbers, |x| half(x).to_le_bytes()),
            Precision::F32,
        ),
        (
            ">f2",
            bytes(numbers, |x| half(x).to_be_bytes()),
            Precision::F32,
        ),
        (
            "<i2",
            bytes(numbers, |x| i16::from(x).to_le_bytes()),
            Precision::F32,
        ),
        (
            ">u4",
            bytes(numbers, |x| u32::from(x).to_be_bytes()),
            Precision::F64,
        ),
        (
            "<i8",
            bytes(numbers, |x| i64::from(x).to_le_bytes()),
            Precision::F64,
        ),
    ]
}

#[test]
fn arrays_of_every_type_name_and_order() {
    let folder = Folder::new();
    let columns = by_columns(&NUMBERS, &[2, 4, 3]);
    for (fortran, numbers) in [(false, &NUMBERS[..]), (true, &columns)] {
        let faces = if fortran {
            by_columns(&FACES, &[2, 3])
        } else {
            FACES.to_vec()
        };
        for (dtype, data, precision) in types(numbers) {
            for (vertices_are, faces_are) in [("vertices", "faces"), ("verts", "faces"), ("v", "f")]
            {
                let arrays = [
                    (vertices_are, npy(dtype, fortran, &[2, 4, 3], &data)),
                    (faces_are, npy("|u1", fortran, &[2, 3], &faces)),
                ];
                folder.write("a.npz", npz(CompressionMethod::DEFLATE, &arrays));
                let mut body = folder.open("a.npz").unwrap();
                assert_eq!(body.precision(), precision, "{dtype}");
                assert_eq!(body.triangles(), [[0, 1, 2], [0, 2, 3]]);
                let said = notes(&body);
                for (word, is_said) in [
                    (dtype, true),
                    ("Fortran order", fortran),
                    ("is called `v`", vertices_are == "v"),
                    ("is called `verts`", vertices_are == "verts"),
                    ("is called `f`", faces_are == "f"),
                ] {
                    assert_eq!(said.contains(word), is_said, "{word}: {said}");
                }
                assert_eq!(frames(&mut body), expected(), "{dtype}");
                body.rewind().unwrap();
                body.skip(1);
                assert_eq!(frames(&mut body), expected()[1..], "{dtype}");
            }
        }
    }
    // Usual arrays are not noted.
    let data = bytes(&NUMBERS, |x| f32::from(x).to_le_bytes());
    let usual = [
        ("v", npy("|O", false, &[1], &[])),
        ("vertices", npy("<f4", false, &[2, 4, 3], &data)),
        ("faces", npy("|u1", false, &[2, 3], &FACES)),
    ];
    folder.write("a.npz", npz(CompressionMethod::DEFLATE, &usual));
    assert_eq!(notes(&folder.open("a.npz").unwrap()), "");
    // Two candidates: it is not clear which is meant.
    let unclear = [
        ("v", usual[1].1.clone()),
        ("verts", usual[1].1.clone()),
        ("faces", usual[2].1.clone()),
    ];
    folder.write("a.npz", npz(CompressionMethod::DEFLATE, &unclear));
    assert!(folder.error("a.npz").ends_with("it holds: v, verts, faces"));
    // Integers beyond double precision are not rounded.
    let large = bytes(&[1_i64, 1 << 53, 0, 0, 0, 0, 0, 0, 0], i64::to_le_bytes);
    let large = [
        ("v", npy("<i8", false, &[3, 3], &large)),
        ("f", npy("|u1", false, &[1, 3], &[0, 1, 2])),
    ];
    folder.write("a.npz", npz(CompressionMethod::DEFLATE, &large));
    assert!(
        folder
            .error("a.npz")
            .contains("a coordinate of vertex 0 is 2^53 or more")
    );
}

#[test]
fn half_precision_is_exact_at_its_ends() {
    let half = [
        0x0001_u16, 0x83ff, 0x0400, 0x7bff, 0xfbff, 0x3c01, 0x8000, 0x3555, 0,
    ];
    let two: fn(i32) -> f64 = |power| 2.0_f64.powi(power);
    let expected = [
        [two(-24), -1023.0 * two(-24), two(-14)],
        [65504.0, -65504.0, 1.0 + two(-10)],
        [-0.0, 1365.0 * two(-12), 0.0],
    ];
    let file = |numbers: &[u16]| {
        let vertices = npy("<f2", false, &[3, 3], &bytes(numbers, u16::to_le_bytes));
        let faces = npy("|u1", false, &[1, 3], &[0, 1, 2]);
        npz(
            CompressionMethod::Stored,
            &[("vertices", vertices), ("faces", faces)],
        )
    };
    let folder = Folder::new();
    let body = folder.write("a.npz", file(&half)).open("a.npz").unwrap();
    let Positions::F32(positions) = body.positions() else {
        panic!("of half precision");
    };
    let expected = expected.map(|position| position.map(|x| (x as f32).to_bits()));
    let positions: Vec<[u32; 3]> = positions.iter().map(|it| it.map(f32::to_bits)).collect();
    assert_eq!(positions, expected);
    for (no_number, word) in [(0x7c00, "inf"), (0xfc00, "-inf"), (0x7e00, "NaN")] {
        let mut half = half;
        half[4] = no_number;
        let message = folder.write("a.npz", file(&half)).error("a.npz");
        assert!(
            message.contains(&format!("y of vertex 1 is {word}")),
            "{message}"
        );
    }
}

#[test]
fn an_array_of_positions_moves_a_mesh() {
    let folder = Folder::new();
    folder.write("m.obj", OBJ);
    let walk = format!("m.obj+{}/w.npy", folder.path().display());
    let wide = bytes(&NUMBERS, |x| f64::from(x).to_le_bytes());
    let single = bytes(&NUMBERS, |x| f32::from(x).to_be_bytes());
    let mut written = types(&NUMBERS);
    written.push(("<f8", wide, Precision::F64));
    written.push((">f4", single, Precision::F32));
    for (dtype, data, precision) in written {
        folder.write("w.npy", npy(dtype, false, &[2, 4, 3], &data));
        let mut body = folder.open(&walk).unwrap();
        assert_eq!(
            (body.precision(), body.frame_count()),
            (precision, 2),
            "{dtype}"
        );
        assert_eq!(body.triangles(), [[0, 1, 2], [0, 1, 3]]);
        assert_eq!(frames(&mut body), expected());
        for frame in [1, 0] {
            body.rewind().unwrap();
            body.skip(frame);
            assert_eq!(frames(&mut body), expected()[frame..]);
        }
    }
    let columns = by_columns(&bytes(&NUMBERS, |x| [x]), &[2, 4, 3]);
    folder.write("w.npy", npy("|u1", true, &[2, 4, 3], &columns));
    let mut body = folder.open(&walk).unwrap();
    assert!(notes(&body).contains("Fortran order"));
    assert_eq!(frames(&mut body), expected());
    body.rewind().unwrap();
    assert_eq!(frames(&mut body), expected());

    let pose = npy(
        "<f4",
        false,
        &[4, 3],
        &bytes(&NUMBERS[..12], |x| f32::from(x).to_le_bytes()),
    );
    folder.write("w.npy", &pose);
    assert_eq!(frames(&mut folder.open(&walk).unwrap()), expected()[..1]);
    for (file, words) in [
        (
            pose[..pose.len() - 1].to_vec(),
            "the shape needs 48 bytes, the file announces 47",
        ),
        (
            [&pose[..], b"x"].concat(),
            "the shape needs 48 bytes, the file announces 49",
        ),
        (
            npy("<f4", false, &[3, 3], &[0; 36]),
            "has 3 vertices, m.obj has 4",
        ),
        (
            npy("<f4", false, &[4], &[0; 16]),
            "it must be (frames, vertices, 3) or (vertices, 3)",
        ),
        (
            npy("<c8", false, &[4, 3], &[0; 96]),
            "type <c8 cannot be read",
        ),
        (b"PK".to_vec(), "the header of an array is incomplete"),
    ] {
        let message = folder.write("w.npy", file).error(&walk);
        assert!(message.contains(words), "{message}");
    }
    let alone = folder.write("w.npy", pose).error("w.npy");
    assert!(
        alone.ends_with("name the mesh that they move too: 'mesh.obj+w.npy'"),
        "{alone}"
    );
}

#[test]
fn what_must_be_held_whole_is_held_to_the_limit() {
    let folder = Folder::new();
    let columns = npy("<f4", true, &[100, 4, 3], &[0; 4800]);
    let arrays = [
        ("vertices", columns),
        ("faces", npy("|u1", false, &[2, 3], &FACES)),
    ];
    folder.write("a.npz", npz(CompressionMethod::DEFLATE, &arrays));
    for (max_memory, is_read) in [(1 << 16, true), (4900, false), (4000, false)] {
        let options = OpenOptions {
            max_memory,
            ..OpenOptions::default()
        };
        let opened = pliant_io::open(&folder.argument("a.npz"), &options);
        assert_eq!(opened.is_ok(), is_read);
        if let Err(error) = opened {
            assert!(
                error.to_string().contains("of memory") || error.to_string().contains("in memory"),
                "{error}"
            );
        }
    }
}

#[test]
fn a_gltf_file_without_a_scene_shows_all_nodes() {
    let folder = Folder::new();
    let corners = [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    folder.write("corners.bin", bytes(&corners, f32::to_le_bytes));
    let open = |scenes: &str| {
        let gltf = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":36,"uri":"corners.bin"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "nodes":[{{"mesh":0}},{{"children":[2],"translation":[5,0,0]}},{{"mesh":0}}]{scenes}}}"#
        );
        folder.write("a.gltf", gltf);
        pliant_io::open_all(&folder.argument("a.gltf"), &OpenOptions::default())
    };
    for (scenes, is_noted) in [
        ("", true),
        (r#","scenes":[]"#, true),
        (r#","scenes":[{"nodes":[0,1]}]"#, false),
    ] {
        let bodies = open(scenes).unwrap();
        assert_eq!(bodies.len(), 2);
        assert_eq!(bodies[1].positions().get(0), [5.0, 0.0, 0.0]);
        let said = notes(&bodies[0]);
        let words = "has no scene; all its nodes are read";
        assert_eq!(said.contains(words), is_noted, "{said}");
    }
    let refused = open(r#","scene":0"#).unwrap_err().to_string();
    assert!(refused.contains("scene 0 does not exist"), "{refused}");
}
