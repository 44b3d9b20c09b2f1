//! Seams close when a body is opened, and must stay closed.

use std::fmt::Write;

use crate::common::{Folder, all_frames, bytes, npy, npz};
use pliant_io::OpenOptions;
use zip::CompressionMethod;

/// The six sides of a cube, four vertices each, `scale` long; vertex `moved` a little aside.
fn cube(scale: f64, moved: Option<usize>) -> String {
    let mut text = String::new();
    for axis in 0..3 {
        for side in [0.0, scale] {
            for (u, v) in [(0.0, 0.0), (scale, 0.0), (scale, scale), (0.0, scale)] {
                let mut position = [u; 3];
                position[axis] = side;
                position[(axis + 1) % 3] = v;
                if moved == Some(text.lines().count()) {
                    position[axis] += 1e-9;
                }
                let [x, y, z] = position;
                writeln!(text, "v {x} {y} {z}").unwrap();
            }
        }
    }
    for side in 0..6 {
        let first = 4 * side + 1;
        writeln!(
            text,
            "f {} {} {} {}",
            first,
            first + 1,
            first + 2,
            first + 3
        )
        .unwrap();
    }
    text
}

#[test]
fn a_cube_of_six_sides_welds_to_eight_places() {
    let folder = Folder::new();
    folder
        .write("c1.obj", cube(1.0, None))
        .write("c2.obj", cube(2.5, None));
    let mut body = folder.open("c*.obj").unwrap();
    assert_eq!((body.welded(), body.vertex_count()), (16, 24));
    assert_eq!(body.faces().unwrap().len(), 12);
    let mut used = body.triangles().concat();
    used.sort_unstable();
    used.dedup();
    assert_eq!(used.len(), 8);
    assert_eq!(all_frames(&mut body).unwrap().len(), 2);
}

#[test]
fn without_welding_the_mesh_is_the_files() {
    let folder = Folder::new();
    folder
        .write("c1.obj", cube(1.0, None))
        .write("c2.obj", cube(1.0, Some(7)));
    let options = OpenOptions {
        weld: false,
        ..OpenOptions::default()
    };
    let mut body = pliant_io::open(&folder.argument("c*.obj"), &options).unwrap();
    assert_eq!(body.welded(), 0);
    assert_eq!(body.triangles()[11], [20, 22, 23]);
    assert_eq!(all_frames(&mut body).unwrap().len(), 2);
}

#[test]
fn a_seam_that_opens_later_is_an_error() {
    let folder = Folder::new();
    folder
        .write("c1.obj", cube(1.0, None))
        .write("c2.obj", cube(2.0, None))
        .write("c3.obj", cube(1.0, Some(7)));
    let message = folder.error("c*.obj");
    assert!(message.starts_with("c3.obj: vertices "), "{message}");
    assert!(
        message.contains(" 7 ") && message.ends_with("but are apart here"),
        "{message}"
    );
}

#[test]
fn in_a_file_of_many_frames_the_frame_is_named() {
    // Two triangles that share an edge by position; in frame 2 they part.
    let mut frames = [[
        [0_f32, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [-0.0, 0.0, -0.0],
        [0.0, -1.0, 0.0],
    ]; 4];
    frames[2][4][0] = 0.25;
    let vertices = npy(
        "<f4",
        false,
        &[4, 6, 3],
        &bytes(frames.as_flattened().as_flattened(), f32::to_le_bytes),
    );
    let faces = npy(
        "<i8",
        false,
        &[2, 3],
        &bytes(&[0_i64, 1, 2, 3, 4, 5], i64::to_le_bytes),
    );
    let folder = Folder::new();
    folder.write(
        "a.npz",
        npz(
            CompressionMethod::DEFLATE,
            &[("vertices", vertices), ("faces", faces)],
        ),
    );
    let mut body = folder.open("a.npz").unwrap();
    assert_eq!(
        (body.welded(), body.triangles()),
        (2, &[[0, 1, 2], [1, 0, 5]][..])
    );
    assert!(body.next_frame().unwrap().is_some() && body.next_frame().unwrap().is_some());
    drop(body);
    assert_eq!(
        folder.error("a.npz"),
        "a.npz, frame 2: vertices 0 and 4 were welded, since edges of theirs coincide in the first frame, but are apart here"
    );
}

#[test]
fn bodies_that_touch_in_a_point_stay_two() {
    let folder = Folder::new();
    let two = crate::common::tetrahedron(1.0)
        + "v 0 0 0\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
    assert_eq!(
        folder
            .write("two.obj", two)
            .open("two.obj")
            .unwrap()
            .welded(),
        0
    );
}
