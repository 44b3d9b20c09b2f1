//! Bodies that are read twice: the same frames, and no file that has changed meanwhile.

use crate::common::{Folder, all_frames, npy, npz, tetrahedron};
use pliant_io::{Body, OpenOptions, Reason, Shape, WriteOptions, Writer};
use std::path::Path;
use zip::CompressionMethod;

/// Three frames as files, and three in one deflated file, in which no reader can seek.
fn folder() -> Folder {
    let folder = Folder::new();
    for frame in 0..3 {
        folder.write(&format!("t{frame}.obj"), tetrahedron(f64::from(frame)));
    }
    let vertices: Vec<f32> = (0..3 * 3 * 3_u8).map(f32::from).collect();
    let faces = [0_u32, 1, 2];
    folder.write(
        "t.npz",
        npz(
            CompressionMethod::Deflated,
            &[
                (
                    "vertices",
                    npy(
                        "<f4",
                        false,
                        &[3, 3, 3],
                        &crate::common::bytes(&vertices, f32::to_le_bytes),
                    ),
                ),
                (
                    "faces",
                    npy(
                        "<u4",
                        false,
                        &[1, 3],
                        &crate::common::bytes(&faces, u32::to_le_bytes),
                    ),
                ),
            ],
        ),
    );
    folder
}

/// Writes the body `from` as `to`.
fn convert(folder: &Folder, from: &str, to: &str) {
    let mut body = folder.open(from).unwrap();
    let shape = Shape {
        triangles: body.triangles().to_vec(),
        faces: None,
        outlines: std::collections::BTreeMap::new(),
        vertex_count: body.vertex_count(),
        frame_count: body.frame_count(),
        precision: body.precision(),
    };
    let mut writer = Writer::create(to, shape, WriteOptions::default()).unwrap();
    while let Some(positions) = body.next_frame().unwrap() {
        writer.frame(positions).unwrap();
    }
    writer.finish().unwrap();
}

/// Arguments that name bodies of all kinds.
fn every_kind(folder: &Folder) -> Vec<String> {
    let path = folder.path().display();
    let caches = ["pc2", "mdd"].map(|ending| format!("{path}/m.obj+{path}/s.{ending}"));
    convert(folder, "t.npz", &caches[0]);
    std::fs::remove_file(folder.path().join("m.obj")).unwrap();
    convert(folder, "t.npz", &caches[1]);
    let fixture = |name| {
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests/fixtures")
            .join(name)
    };
    for name in ["k0.gltf", "k1.gltf"] {
        std::fs::copy(fixture("skin.gltf"), folder.path().join(name)).unwrap();
    }
    std::fs::copy(fixture("hierarchy.gltf"), folder.path().join("h.gltf")).unwrap();
    let files = ["t*.obj", "t.npz", "k0.gltf", "k*.gltf", "h.gltf"];
    files
        .map(|name| folder.argument(name))
        .into_iter()
        .chain(caches)
        .collect()
}

#[test]
fn frames_come_again_from_wherever_the_reading_was() {
    let folder = folder();
    for argument in every_kind(&folder) {
        let options = OpenOptions {
            fps: 5.0,
            ..OpenOptions::default()
        };
        let open = || pliant_io::open_all(&argument, &options).unwrap();
        for number in 0..open().len() {
            let body = || open().swap_remove(number);
            let all = all_frames(&mut body()).unwrap();
            assert!(all.len() >= 3 || body().name().contains('#'));
            for read in 0..=all.len() {
                for passed_over in 0..=read {
                    let mut body: Body = body();
                    body.skip(passed_over);
                    for frame in &all[passed_over..read] {
                        body.next_frame().unwrap();
                        assert_eq!(body.positions().get(0), frame[0]);
                    }
                    body.rewind().unwrap();
                    body.rewind().unwrap();
                    // From the beginning, and from another frame.
                    let case = format!("{argument} {number} after {passed_over} and {read}");
                    body.skip(passed_over);
                    assert_eq!(all_frames(&mut body).unwrap(), all[passed_over..], "{case}");
                    body.rewind().unwrap();
                    assert_eq!(all_frames(&mut body).unwrap(), all, "{case}");
                    assert!(body.next_frame().unwrap().is_none());
                }
            }
        }
    }
}

#[test]
fn seams_still_hold_the_second_time() {
    let folder = Folder::new();
    let strip = |z: f64| {
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 {z}\nv 0 1 0\nf 1 2 3\nf 4 5 6\n")
    };
    folder
        .write("s0.obj", strip(0.0))
        .write("s1.obj", strip(1.0));
    let mut body = folder.open("s*.obj").unwrap();
    let all = all_frames(&mut body).unwrap();
    body.rewind().unwrap();
    assert_eq!((body.welded(), all_frames(&mut body).unwrap()), (2, all));
}

#[test]
fn a_file_that_changed_meanwhile_is_refused() {
    let folder = folder();
    let mut body = folder.open("t*.obj").unwrap();
    all_frames(&mut body).unwrap();
    folder.write("t0.obj", tetrahedron(0.0) + "# and more\n");
    let error = body.rewind().unwrap_err();
    assert!(matches!(error.reason(), Reason::Changed), "{error}");
    let again = body.rewind().unwrap_err();
    assert!(matches!(again.reason(), Reason::AfterError), "{again}");
    assert!(body.next_frame().is_err());

    // A cache stays open, and yet a change in it is noticed.
    let caches = every_kind(&folder).split_off(5);
    for cache in caches {
        let mut body = pliant_io::open(&cache, &OpenOptions::default()).unwrap();
        all_frames(&mut body).unwrap();
        let file = cache.rsplit_once('+').unwrap().1;
        let whole = std::fs::read(file).unwrap();
        std::fs::write(file, &whole[..whole.len() - 1]).unwrap();
        let error = body.rewind().unwrap_err();
        assert!(matches!(error.reason(), Reason::Changed), "{error}");
        assert!(body.next_frame().is_err());
    }
}

/// Triangles, number of vertices and number of welded vertices of each frame.
fn meshes(body: &mut Body) -> Vec<(Vec<[u32; 3]>, usize, usize)> {
    let mut meshes = Vec::new();
    while let Some(positions) = body.next_frame().unwrap() {
        let places = positions.len();
        meshes.push((body.triangles().to_vec(), places, body.welded()));
    }
    meshes
}

/// A frame of a changing mesh is the same whether earlier ones were read, skipped or read twice.
///
/// Its seams are its own.
#[test]
fn a_mesh_that_changes_is_that_of_its_file_whatever_was_read_before() {
    // Two triangles that share the places of an edge, or do not.
    let square = |apart: u8| {
        let first = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        format!("{first}v 1 {apart} 0\nv 0 1 {apart}\nv 1 1 0\nf 4 6 5\n")
    };
    let folder = Folder::new();
    let part = crate::common::bytes(&[0_f32; 3 * 3 * 4], f32::to_le_bytes);
    let npz_of = |triangle: [u32; 3]| {
        let faces = crate::common::bytes(&triangle, u32::to_le_bytes);
        let vertices = npy("<f4", false, &[3, 4, 3], &part);
        let faces = npy("<u4", false, &[1, 3], &faces);
        let entries: [(&str, Vec<u8>); 2] = [("vertices", vertices), ("faces", faces)];
        npz(CompressionMethod::Deflated, &entries)
    };
    folder
        .write("s0.obj", tetrahedron(1.0))
        .write("s1.obj", square(0))
        .write("s2.obj", square(2))
        .write("s3.obj", tetrahedron(2.0))
        .write("s4.obj", tetrahedron(2.0).replace("f 3 1 4\n", ""))
        .write("s5.obj", square(0))
        .write("z0.npz", npz_of([0, 1, 2]))
        .write("z1.npz", npz_of([1, 2, 3]))
        .write("z2.npz", npz_of([0, 1, 2]));
    let faces = tetrahedron(1.0)
        .lines()
        .filter(|line| line.starts_with('f'))
        .count();
    let square_is = |welded| (2, 6, welded);
    let tetrahedron_is = |faces| (faces, 4, 0);
    let expected = [
        tetrahedron_is(faces),
        square_is(2),
        square_is(0),
        tetrahedron_is(faces),
        tetrahedron_is(faces - 1),
        square_is(2),
    ];
    let mut body = folder.open("s*.obj").unwrap();
    body.let_mesh_change();
    let all = meshes(&mut body);
    let sizes = all
        .iter()
        .map(|(triangles, vertices, welded)| (triangles.len(), *vertices, *welded));
    assert_eq!(sizes.collect::<Vec<_>>(), expected);

    let mut body = folder.open("z*.npz").unwrap();
    body.let_mesh_change();
    let archives = meshes(&mut body);
    let corners: Vec<u32> = archives
        .iter()
        .map(|(triangles, ..)| triangles[0][0])
        .collect();
    assert_eq!(corners, [0, 0, 0, 1, 1, 1, 0, 0, 0]);

    for (name, all) in [("s*.obj", all), ("z*.npz", archives)] {
        let mut body = folder.open(name).unwrap();
        body.let_mesh_change();
        for first in (0..all.len()).chain((0..all.len()).rev()) {
            body.rewind().unwrap();
            body.skip(first);
            body.next_frame().unwrap().unwrap();
            assert_eq!(body.triangles(), all[first].0, "{name}, frame {first}");
            assert_eq!(body.welded(), all[first].2, "{name}, frame {first}");
            assert_eq!(meshes(&mut body), all[first + 1..], "{name}, after {first}");
        }
    }

    // Any other fault is an error, and so is a higher precision.
    let ply = "ply\nformat ascii 1.0\n\
        element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_index\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let four = ply
        .replace("vertex 3", "vertex 4")
        .replace("0 0 0", "0 0 0\n0 0 2");
    for (next, is_error) in [
        (four.clone(), false),
        (four.replace("float", "double"), true),
        (four.replace("3 0 1 2", "3 0 1 4"), true),
        (four.replace("0 0 2", "0 0 nan"), true),
    ] {
        folder.write("p0.ply", ply).write("p1.ply", next);
        let mut body = folder.open("p*.ply").unwrap();
        body.let_mesh_change();
        assert!(body.next_frame().is_ok());
        assert_eq!(body.next_frame().is_err(), is_error);
        assert_eq!(body.next_frame().is_err(), is_error);
    }
}
