//! Writers: every format converts to every other without loss, and no file is half written.

use crate::common::{Folder, all_frames, tetrahedron};
use pliant_io::{Error, OpenOptions, Positions, Precision, Reason, Shape, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Everything that can be observed of a body.
#[derive(Debug, Clone, PartialEq)]
struct Told {
    /// Positions of the corners of every triangle, in every frame, as bits.
    frames: Vec<Vec<[[u64; 3]; 3]>>,
    triangles: Vec<[u32; 3]>,
    faces: Option<Vec<u32>>,
    outlines: BTreeMap<u32, Vec<u32>>,
    vertices: usize,
}

fn tell(argument: &str) -> Result<(Told, Vec<Vec<[f64; 3]>>, Precision), Error> {
    let as_it_is = OpenOptions {
        weld: false,
        ..OpenOptions::default()
    };
    let mut body = pliant_io::open(argument, &as_it_is)?;
    let frames = all_frames(&mut body)?;
    let corners = |frame: &Vec<[f64; 3]>| {
        let place = |corner: u32| frame[corner as usize].map(f64::to_bits);
        let triangles = body.triangles().iter();
        triangles.map(|corners| corners.map(place)).collect()
    };
    let told = Told {
        frames: frames.iter().map(corners).collect(),
        triangles: body.triangles().to_vec(),
        faces: body.faces().map(<[u32]>::to_vec),
        outlines: body.outlines(),
        vertices: body.vertex_count(),
    };
    Ok((told, frames, body.precision()))
}

/// Converts a body; returns whether anything was rounded.
fn convert(from: &str, to: &str, options: &WriteOptions) -> Result<bool, Error> {
    let (told, frames, precision) = tell(from)?;
    let shape = Shape {
        triangles: told.triangles,
        faces: told.faces,
        outlines: told.outlines,
        vertex_count: told.vertices,
        frame_count: frames.len(),
        precision,
    };
    let mut writer = Writer::create(to, shape, options.clone())?;
    for frame in &frames {
        match precision {
            Precision::F64 => writer.frame(Positions::F64(frame))?,
            Precision::F32 => {
                let narrow: Vec<_> = frame.iter().map(|p| p.map(|x| x as f32)).collect();
                writer.frame(Positions::F32(&narrow))?;
            }
        }
    }
    let rounded = writer.rounded();
    writer.finish()?;
    Ok(rounded)
}

/// Name to write, name to read, and whether vertices, polygons and 64 bits are kept.
const FORMATS: [(&str, &str, bool, bool, bool); 7] = [
    ("%03d.obj", "*.obj", true, true, true),
    ("%03d.ply", "*.ply", true, true, true),
    ("%03d.stl", "*.stl", false, false, false),
    ("s.npz", "s.npz", true, false, true),
    ("m.obj+s.pc2", "m.obj+s.pc2", true, true, false),
    ("m.ply+s.mdd", "m.ply+s.mdd", true, true, false),
    ("m.ply+s.pc2", "m.ply+s.pc2", true, true, false),
];

/// A polygon of five corners, two triangles and an unused vertex; coordinates that decimals cannot
/// hold.
fn source(folder: &Folder, wide: bool) -> String {
    let coordinates: [f32; 21] = [
        0.1,
        -0.0,
        1e-30,
        1.0,
        2.0e-6,
        -3.4e38,
        3.333_333_3,
        1e16,
        7.0,
        123_456.79,
        1e-45,
        0.5,
        -0.3,
        0.2,
        9.0,
        5.0,
        5.5,
        6.0,
        1.0,
        0.0,
        4.0,
    ];
    for frame in 0..3_u8 {
        let value = |&x: &f32| {
            let x = f64::from(x) * f64::from(1_u8 << frame).min(if x < -1e38 { 1.0 } else { 4.0 });
            // In 64 bits, the number next to one that 32 bits hold.
            if wide { x + x * f64::EPSILON } else { x }
        };
        let mut text = String::new();
        for vertex in coordinates.chunks(3) {
            let [x, y, z] = [0, 1, 2].map(|axis| value(&vertex[axis]));
            writeln!(text, "v {x:e} {y:e} {z:e}").unwrap();
        }
        text += "f 1 2 3 4 5\nf 7 1 2\nf 4 7 3\n";
        folder.write(&format!("source{frame}.obj"), text);
    }
    folder.argument("source*.obj")
}

fn argument(folder: &Folder, sub: &str, name: &str) -> String {
    let parts = name
        .split('+')
        .map(|part| folder.argument(&format!("{sub}/{part}")));
    parts.collect::<Vec<_>>().join("+")
}

#[test]
fn every_format_into_every_other() {
    let folder = Folder::new();
    for wide in [false, true] {
        let source = source(&folder, wide);
        let (first, _, _) = tell(&source).unwrap();
        assert_eq!(first.frames.len(), 3);
        for (write, read, keeps_vertices, keeps_polygons, keeps_wide) in FORMATS {
            let one = format!("one-{wide}-{}", write.replace(['%', '+'], ""));
            fs::create_dir(folder.path().join(&one)).unwrap();
            let there = argument(&folder, &one, write);
            let rounded = convert(&source, &there, &WriteOptions::default()).unwrap();
            assert_eq!(rounded, wide && !keeps_wide, "{write}");
            let read_back = argument(&folder, &one, read);
            let (told, _, precision) = tell(&read_back).unwrap();
            assert_eq!(told.frames == first.frames, !rounded, "{write}");
            if keeps_vertices {
                assert_eq!(
                    (&told.triangles, told.vertices),
                    (&first.triangles, first.vertices),
                    "{write}"
                );
            }
            if keeps_polygons {
                assert_eq!(told.faces, first.faces, "{write}");
            }
            assert_eq!(precision == Precision::F64, keeps_wide, "{write}");
            // From there into all other formats.
            for (again, read_again, ..) in FORMATS {
                let two = format!("two-{one}-{}", again.replace(['%', '+'], ""));
                fs::create_dir(folder.path().join(&two)).unwrap();
                let to = argument(&folder, &two, again);
                let rounded = convert(&read_back, &to, &WriteOptions::default()).unwrap();
                let (back, _, _) = tell(&argument(&folder, &two, read_again)).unwrap();
                assert_eq!(back.frames == told.frames, !rounded, "{write} {again}");
                if !wide {
                    assert!(!rounded, "{write} {again}");
                }
            }
        }
    }
}

#[test]
fn what_is_there_is_kept_and_what_fails_leaves_nothing() {
    let folder = Folder::new();
    let source = source(&folder, false);
    let forced = WriteOptions {
        force: true,
        ..WriteOptions::default()
    };
    for (write, ..) in FORMATS {
        let sub = write.replace(['%', '+'], "");
        fs::create_dir(folder.path().join(&sub)).unwrap();
        let to = argument(&folder, &sub, write);
        // The last file that would be written exists already.
        let last = to.rsplit('+').next().unwrap().replace("%03d", "002");
        fs::write(&last, "precious").unwrap();
        let error = convert(&source, &to, &WriteOptions::default()).unwrap_err();
        assert!(
            error.file() == Path::new(&last) && matches!(error.reason(), Reason::Exists),
            "{error}"
        );
        assert_eq!(error.to_string(), format!("{last}: exists already"));
        let left: Vec<_> = fs::read_dir(folder.path().join(&sub)).unwrap().collect();
        assert_eq!(
            (left.len(), fs::read(&last).unwrap()),
            (1, b"precious".to_vec()),
            "{write}"
        );
        convert(&source, &to, &forced).unwrap();
        assert_ne!(fs::read(&last).unwrap(), b"precious");

        // A writer that is dropped half way leaves no half file.
        let sub = format!("dropped {sub}");
        fs::create_dir(folder.path().join(&sub)).unwrap();
        let (told, frames, _) = tell(&source).unwrap();
        let shape = Shape {
            triangles: told.triangles,
            faces: None,
            outlines: BTreeMap::new(),
            vertex_count: told.vertices,
            frame_count: 3,
            precision: Precision::F64,
        };
        let mut writer = Writer::create(
            &argument(&folder, &sub, write),
            shape,
            WriteOptions::default(),
        )
        .unwrap();
        writer.frame(Positions::F64(&frames[0])).unwrap();
        assert!(writer.frame(Positions::F64(&frames[0][1..])).is_err());
        let missing = writer.finish().unwrap_err().to_string();
        assert!(
            missing.contains("3 frames were announced, 1 came"),
            "{missing}"
        );
        // With one file per frame, the first is complete.
        let whole = usize::from(write.contains('%'));
        assert_eq!(
            fs::read_dir(folder.path().join(&sub)).unwrap().count(),
            whole,
            "{write}"
        );
    }
}

#[test]
fn what_cannot_be_written_says_what_can() {
    let folder = Folder::new();
    folder
        .write("a.obj", tetrahedron(1.0))
        .write("b.obj", tetrahedron(2.0));
    std::fs::create_dir(folder.path().join("d.npz")).unwrap();
    let error = |from: &str, to: &str| {
        let to = argument(&folder, ".", to);
        let error = convert(&folder.argument(from), &to, &WriteOptions::default())
            .unwrap_err()
            .to_string();
        assert_eq!(error.lines().count(), 1, "{error}");
        error
    };
    for (from, to, words) in [
        (
            "a.obj",
            "a.glb",
            "glTF can be read but not written; these can: a mesh (.obj",
        ),
        ("a.obj", "a.fbx", "cannot be written; these can"),
        (
            "a.obj",
            "a.pc2",
            "name a mesh to write beside it: 'mesh.obj+",
        ),
        ("a.obj", "m.stl+a.pc2", "written as .obj or .ply"),
        ("a.obj", "d.npz", "is a directory"),
        ("a.obj", "none/a.npz", "its folder does not exist"),
        ("a.obj", "none/a.obj", "its folder does not exist"),
        (
            "[ab].obj",
            "one.obj",
            "one.obj: this format holds one frame a file, but 2 are to be written",
        ),
    ] {
        let error = error(from, to);
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn shapes_whose_parts_do_not_agree_give_an_error_and_no_file() {
    let folder = Folder::new();
    let good = Shape {
        triangles: vec![[0, 1, 2]],
        faces: Some(vec![0]),
        outlines: BTreeMap::new(),
        vertex_count: 3,
        frame_count: 1,
        precision: Precision::F32,
    };
    let bad = [
        (
            Shape {
                triangles: vec![[0, 1, 2], [0, 1, 3]],
                ..good.clone()
            },
            "triangle 1 uses vertex 3; the shape has 3 vertices",
        ),
        (
            Shape {
                outlines: BTreeMap::from([(0, vec![0, 1, 2, 5])]),
                ..good.clone()
            },
            "polygon 0 uses vertex 5; the shape has 3 vertices",
        ),
        (
            Shape {
                triangles: vec![],
                ..good.clone()
            },
            "holds no faces",
        ),
        (
            Shape {
                faces: Some(vec![0, 0]),
                ..good.clone()
            },
            "`faces` has 2 entries for 1 triangles; it needs one for each",
        ),
        (
            Shape {
                frame_count: 0,
                ..good.clone()
            },
            "holds no frames",
        ),
    ];
    for (shape, words) in bad {
        for name in ["x.obj", "x.npz", "x.stl", "m.ply+x.mdd"] {
            let created = Writer::create(
                &argument(&folder, ".", name),
                shape.clone(),
                WriteOptions::default(),
            );
            let error = created.err().unwrap().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
    assert!(!folder.path().join("x.npz").exists());
    // Counts of point caches are signed and have 32 bits.
    for name in ["m.obj+x.pc2", "m.obj+x.mdd"] {
        let shape = Shape {
            frame_count: 1 << 31,
            ..good.clone()
        };
        let name = argument(&folder, ".", name);
        let created = Writer::create(&name, shape, WriteOptions::default());
        let error = created.err().unwrap().to_string();
        let words = "has 2147483648 frames of 3 vertices; this format holds at most 2147483647";
        assert!(error.contains(words), "{error}");
    }
}

/// Other programs read these files: their bytes are as the formats say.
#[test]
fn caches_are_byte_for_byte_what_the_formats_say() {
    let folder = Folder::new();
    folder
        .write("a1.obj", tetrahedron(1.0))
        .write("a2.obj", tetrahedron(2.5));
    let from = folder.argument("a*.obj");
    let options = WriteOptions {
        fps: 25.0,
        ..WriteOptions::default()
    };
    for name in ["m.obj+s.pc2", "n.obj+s.mdd"] {
        convert(&from, &argument(&folder, ".", name), &options).unwrap();
    }
    let positions = [1.0, 2.5_f32].map(|top| {
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, top],
        ]
    });
    let positions = positions.as_flattened().as_flattened();
    let mut pc2 = b"POINTCACHE2\0\x01\0\0\0\x04\0\0\0\0\0\0\0\0\0\x80\x3f\x02\0\0\0".to_vec();
    pc2.extend(positions.iter().flat_map(|x| x.to_le_bytes()));
    assert_eq!(fs::read(folder.path().join("s.pc2")).unwrap(), pc2);
    let mut mdd = b"\0\0\0\x02\0\0\0\x04".to_vec();
    mdd.extend(
        [0.0, 0.04_f32]
            .iter()
            .chain(positions)
            .flat_map(|x| x.to_be_bytes()),
    );
    assert_eq!(fs::read(folder.path().join("s.mdd")).unwrap(), mdd);
}

/// Concave polygons stay polygons, and are triangulated in the same way again.
#[test]
fn polygons_that_are_no_fans_stay_polygons() {
    let folder = Folder::new();
    // An L from a corner whose fan leaves it, a quad, an arrow, and a triangle.
    let text = "v 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 0 0 1\nv 2 0 1\n\
        f 1 2 3 4 5 6\nf 6 1 8 7\nf 1 2 3\nf 4 2 6 3\n";
    folder.write("l.obj", text);
    let argument = |name: &str| folder.path().join(name).display().to_string();
    let from = argument("l.obj");
    let (told, ..) = tell(&from).unwrap();
    assert_eq!(
        told.faces.as_deref(),
        Some(&[0, 0, 0, 0, 1, 1, 2, 3, 3][..])
    );
    let kept: Vec<u32> = told.outlines.keys().copied().collect();
    assert_eq!(kept, [0, 3]);
    for name in ["copy.obj", "copy.ply"] {
        let to = argument(name);
        convert(&from, &to, &WriteOptions::default()).unwrap();
        assert_eq!(tell(&to).unwrap().0, told, "{name}");
    }
    let bad = Shape {
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        faces: Some(vec![0, 0]),
        outlines: BTreeMap::from([(0, vec![0, 1, 2, 9])]),
        vertex_count: 4,
        frame_count: 1,
        precision: Precision::F32,
    };
    assert!(Writer::create(&argument("bad.obj"), bad, WriteOptions::default()).is_err());
}

#[test]
fn no_error_names_the_temporary_file() {
    let folder = Folder::new();
    let path = folder.path().join("no").join("notes.txt");
    let error = pliant_io::StagedFile::create(&path).unwrap_err();
    let Reason::Write(of_system) = error.reason() else {
        panic!("{error}");
    };
    assert!(of_system.raw_os_error().is_some(), "{of_system}");
    let said = error.to_string();
    assert!(
        said.contains("notes.txt") && !said.contains(".pliant-"),
        "{said}"
    );
}
