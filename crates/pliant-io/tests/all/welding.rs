//! Welding of sequences: each frame has its own seams, independent of other frames.

use std::fmt::Write;

use crate::common::{Folder, all_frames, bytes, npy, npz};
use pliant_io::{Body, OpenOptions};
use zip::CompressionMethod;

/// The six sides of a cube of size `scale`, four vertices each; vertex `moved` is a little off.
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

/// Triangles of each frame, and its numbers of welded and of parted vertices.
fn seams(body: &mut Body) -> Vec<(Vec<[u32; 3]>, usize, usize)> {
    let mut all = Vec::new();
    while body.next_frame().unwrap().is_some() {
        let parted = body.parted_seams().map_or(0, |parted| parted.count);
        all.push((body.triangles().to_vec(), body.welded(), parted));
    }
    all
}

#[test]
fn a_seam_that_opens_later_is_open_there() {
    let folder = Folder::new();
    folder
        .write("c1.obj", cube(1.0, None))
        .write("c2.obj", cube(2.0, None))
        .write("c3.obj", cube(1.0, Some(7)))
        .write("c4.obj", cube(1.0, None));
    let mut body = folder.open("c*.obj").unwrap();
    let all = seams(&mut body);
    let counts = all.iter().map(|&(_, welded, parted)| [welded, parted]);
    let counts: Vec<_> = counts.collect();
    assert_eq!(counts, [[16, 0], [16, 0], [15, 1], [16, 0]]);
    assert_eq!(all[0], all[3]);
    // Whatever was read before.
    body.rewind().unwrap();
    body.skip(2);
    let positions = body.next_frame().unwrap().unwrap();
    let moved = positions.get(7);
    assert_eq!(body.triangles(), all[2].0);
    let parted = body.parted_seams().unwrap();
    // This vertex represents others in the first frame.
    assert!(parted.vertices[0] == 7 && parted.positions[0] == moved);
    assert!(
        parted.farthest > 1e-10 && parted.farthest < 1e-9,
        "{parted:?}"
    );
    body.rewind().unwrap();
    body.next_frame().unwrap();
    assert_eq!(body.parted_seams(), None);
    // All frames have the same triangles before welding.
    assert_eq!(body.unwelded(), folder.open("c3.obj").unwrap().unwelded());
}

#[test]
fn a_seam_that_closes_later_is_closed_there() {
    let folder = Folder::new();
    folder
        .write("c1.obj", cube(1.0, Some(7)))
        .write("c2.obj", cube(2.0, None));
    let all = seams(&mut folder.open("c*.obj").unwrap());
    assert_eq!([all[0].1, all[1].1], [15, 16]);
    assert_eq!([all[0].2, all[1].2], [0, 0], "none is apart that was one");
}

#[test]
fn within_a_tolerance_seams_stay_closed() {
    let folder = Folder::new();
    folder
        .write("c1.obj", cube(1.0, None))
        .write("c2.obj", cube(2.0, Some(7)))
        .write("c3.obj", cube(2.0, Some(3)));
    for (tolerance, open) in [(1e-6, 0), (1e-11, 1)] {
        let options = OpenOptions {
            weld_tolerance: tolerance,
            ..OpenOptions::default()
        };
        let mut body = pliant_io::open(&folder.argument("c*.obj"), &options).unwrap();
        let all = seams(&mut body);
        for (triangles, welded, parted) in &all {
            assert_eq!(triangles == &all[0].0, *parted == 0);
            assert_eq!(*welded, 16 - parted);
        }
        let parted = all.iter().map(|&(.., parted)| parted);
        assert_eq!(parted.collect::<Vec<_>>(), [0, open, open]);
    }
}

/// Four strips side by side, each with its own corners.
///
/// The digits of `frame` say whether a seam coincides, differs in the last digit, or is apart.
fn strips(frame: usize) -> String {
    let mut text = String::new();
    let mut x = 0.0_f64;
    for strip in 0..4 {
        x += [0.0, f64::EPSILON * 4.0, 0.5][frame / 3_usize.pow(strip) % 3];
        for (dx, y) in [(0.0, 0), (0.0, 1), (1.0, 0), (1.0, 1)] {
            writeln!(text, "v {} {y} 0", x + dx).unwrap();
        }
        x += 1.0;
    }
    for first in [1, 5, 9, 13] {
        writeln!(text, "f {first} {} {}", first + 2, first + 3).unwrap();
        writeln!(text, "f {first} {} {}", first + 3, first + 1).unwrap();
    }
    text
}

#[test]
fn every_frame_has_the_seams_of_its_file_alone() {
    let folder = Folder::new();
    for frame in 0..81 {
        folder.write(&format!("s{frame:02}.obj"), strips(frame));
    }
    for tolerance in [0.0, 1e-6] {
        let options = OpenOptions {
            weld_tolerance: tolerance,
            ..OpenOptions::default()
        };
        let open = |name: &str| pliant_io::open(&folder.argument(name), &options).unwrap();
        let mut alone = Vec::new();
        for frame in 0..81 {
            alone.extend(seams(&mut open(&format!("s{frame:02}.obj"))));
        }
        let sequence = |from: &str| seams(&mut open(from));
        for (found, alone) in sequence("s*.obj").iter().zip(&alone) {
            assert_eq!((&found.0, found.1), (&alone.0, alone.1));
        }
        // Sequences that begin at other frames, with other seams closed.
        for (found, alone) in sequence("s[5-8]*.obj").iter().zip(&alone[50..]) {
            assert_eq!((&found.0, found.1), (&alone.0, alone.1));
        }
    }
}

#[test]
fn in_a_file_of_many_frames_each_has_its_own() {
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
    let all = seams(&mut body);
    let counts = all.iter().map(|&(_, welded, parted)| [welded, parted]);
    // If an edge does not coincide, both its ends are apart: single points are not joined.
    assert_eq!(counts.collect::<Vec<_>>(), [[2, 0], [2, 0], [0, 2], [2, 0]]);
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
