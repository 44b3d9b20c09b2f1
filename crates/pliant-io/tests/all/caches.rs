//! Point caches (PC2 and MDD) beside a mesh, and skipping of frames.

use crate::common::{Folder, all_frames, bytes, npy, npz, tetrahedron};
use pliant_io::{OpenOptions, Positions, Precision, Reason};
use zip::CompressionMethod;

/// Positions of a tetrahedron whose top rises, for `frames` frames.
fn positions(frames: u32) -> Vec<f32> {
    let frame = |frame| {
        [
            0.,
            0.,
            0.,
            1.,
            0.,
            0.,
            0.,
            1.,
            0.,
            0.,
            0.,
            1.0 + frame as f32,
        ]
    };
    (0..frames).flat_map(frame).collect()
}

fn pc2(vertices: u32, frames: u32, positions: &[f32]) -> Vec<u8> {
    let mut file = b"POINTCACHE2\0\x01\0\0\0".to_vec();
    file.extend(vertices.to_le_bytes());
    file.extend(bytes(&[0.0, 1.0_f32], f32::to_le_bytes));
    file.extend(frames.to_le_bytes());
    file.extend(bytes(positions, f32::to_le_bytes));
    file
}

fn mdd(vertices: u32, frames: u32, positions: &[f32]) -> Vec<u8> {
    let mut file = [frames.to_be_bytes(), vertices.to_be_bytes()].concat();
    let times: Vec<f32> = (0..frames.min(100))
        .map(|frame| frame as f32 / 24.0)
        .collect();
    file.extend(bytes(&times, f32::to_be_bytes));
    file.extend(bytes(positions, f32::to_be_bytes));
    file
}

fn tops(folder: &Folder, name: &str) -> Vec<f64> {
    let mut body = folder.open(&argument(folder, name)).unwrap();
    all_frames(&mut body)
        .unwrap()
        .iter()
        .map(|frame| frame[3][2])
        .collect()
}

/// An argument with both files in the folder; `Folder` only completes the first.
fn argument(folder: &Folder, name: &str) -> String {
    name.replacen('+', &format!("+{}/", folder.path().display()), 1)
}

#[test]
fn positions_move_a_mesh() {
    let folder = Folder::new();
    folder
        .write(
            "m.obj",
            tetrahedron(99.0).replace("f 1 3 2\nf 1 2 4\n", "f 1 3 2 4\n"),
        )
        .write("a+b.obj", tetrahedron(99.0))
        .write("s.pc2", pc2(4, 5, &positions(5)))
        .write("s.MDD", mdd(4, 5, &positions(5)));
    for name in ["m.obj+s.pc2", "m.obj+s.MDD", "a+b.obj+s.MDD"] {
        // The last name is split at its last plus.
        let name = if name.starts_with("a+b") {
            let folder = folder.path().display();
            format!("a+b.obj+{folder}/s.MDD")
        } else {
            argument(&folder, name)
        };
        let mut body = folder.open(&name).unwrap();
        assert_eq!(
            (body.frame_count(), body.vertex_count(), body.precision()),
            (5, 4, Precision::F32)
        );
        assert!(body.name().ends_with("s.pc2") || body.name().ends_with("s.MDD"));
        assert_eq!(body.faces().is_some(), name.starts_with("m.obj"));
        let frames = all_frames(&mut body).unwrap();
        assert_eq!(
            frames.iter().map(|frame| frame[3][2]).collect::<Vec<_>>(),
            [1.0, 2.0, 3.0, 4.0, 5.0]
        );
        assert_eq!(frames[4][1], [1.0, 0.0, 0.0]);
    }
    // An existing file of that name wins.
    folder.write("m.obj+s.pc2", "not read");
    assert!(
        folder
            .error("m.obj+s.pc2")
            .contains("holds positions but no faces")
    );
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn what_does_not_agree_is_refused() {
    let folder = Folder::new();
    let two = positions(2);
    let whole = pc2(4, 2, &two);
    let mut nan = two.clone();
    nan[16] = f32::NAN;
    folder
        .write("m.obj", tetrahedron(1.0))
        .write("m2.obj", tetrahedron(2.0) + "v 0 0 0\n")
        .write("bad.obj", "v 0 0\n")
        .write("s.pc2", &whole)
        .write("s.mdd", mdd(4, 2, &two))
        .write("cut.pc2", &whole[..whole.len() - 1])
        .write("long.pc2", [&whole[..], b"x"].concat())
        .write("head.pc2", &whole[..20])
        .write("cut.mdd", &mdd(4, 2, &two)[..30])
        .write("claim.pc2", pc2(u32::MAX, u32::MAX, &two))
        .write("claim.mdd", mdd(u32::MAX, u32::MAX, &two))
        .write("other.pc2", [b"POINTCACHE3", &whole[11..]].concat())
        .write("old.pc2", [&whole[..12], &[2], &whole[13..]].concat())
        .write("empty.pc2", "")
        .write("none.pc2", pc2(4, 0, &[]))
        .write("nothing.mdd", mdd(0, 2, &[]))
        .write("nan.pc2", pc2(4, 2, &nan))
        .write(
            "t.npz",
            npz(
                CompressionMethod::Stored,
                &[
                    (
                        "vertices",
                        npy("<f4", false, &[2, 4, 3], &bytes(&two, f32::to_le_bytes)),
                    ),
                    ("faces", npy("<u1", false, &[1, 3], &[0, 1, 2])),
                ],
            ),
        );
    for (name, message) in [
        (
            "s.pc2",
            "s.pc2: holds positions but no faces; name the mesh that they move too: \
             'mesh.obj+s.pc2'",
        ),
        (
            "m.obj+cut.pc2",
            "cut.pc2: ends too early: 2 frames of 4 vertices need 128 bytes, the file has 127",
        ),
        (
            "m.obj+long.pc2",
            "long.pc2: 2 frames of 4 vertices need 128 bytes, the file has 129",
        ),
        (
            "m.obj+head.pc2",
            "head.pc2: ends too early: the header needs 32 bytes, the file has 20",
        ),
        (
            "m.obj+cut.mdd",
            "cut.mdd: ends too early: 2 frames of 4 vertices need 112 bytes, the file has 30",
        ),
        (
            "m.obj+claim.pc2",
            "claim.pc2: ends too early: 4294967295 frames of 4294967295 vertices need \
             221360928781435404332 bytes, the file has 128",
        ),
        (
            "m.obj+claim.mdd",
            "claim.mdd: ends too early: 4294967295 frames of 4294967295 vertices need ",
        ),
        (
            "m.obj+other.pc2",
            "other.pc2, byte 0: is not a PC2 file of version 1",
        ),
        (
            "m.obj+old.pc2",
            "old.pc2, byte 0: is not a PC2 file of version 1",
        ),
        ("m.obj+empty.pc2", "empty.pc2: ends too early"),
        ("m.obj+none.pc2", "none.pc2: holds no frames"),
        ("m.obj+nothing.mdd", "nothing.mdd: holds no vertices"),
        ("m.obj+nan.pc2", "nan.pc2, frame 1: y of vertex 1 is NaN"),
        (
            "m2.obj+s.pc2",
            "s.pc2: has 4 vertices, m2.obj has 5; the frames of a body need the same number",
        ),
        ("m2.obj+s.mdd", "s.mdd: has 4 vertices, m2.obj has 5"),
        (
            "bad.obj+s.pc2",
            "bad.obj, line 1: a vertex has two coordinates",
        ),
        ("gone.obj+s.pc2", "gone.obj: no such file"),
        ("m.obj+gone.pc2", "gone.pc2: no such file"),
        ("s.mdd+s.pc2", "s.mdd: holds positions but no faces"),
        (
            "t.npz+s.pc2",
            "t.npz: has 2 frames; the mesh beside positions must have one",
        ),
        ("m.txt+s.pc2", "m.txt: no such file"),
    ] {
        let error = folder.error(&argument(&folder, name));
        assert!(error.starts_with(message), "{error}\n{message}");
        assert_eq!(error.lines().count(), 1);
    }
    let little = OpenOptions {
        max_memory: 100,
        ..OpenOptions::default()
    };
    let error =
        pliant_io::open(&folder.argument(&argument(&folder, "m.obj+s.pc2")), &little).unwrap_err();
    assert!(
        matches!(error.reason(), Reason::TooLarge { limit: 100, .. })
            && error.to_string().ends_with(", 100 bytes are allowed"),
        "{error}"
    );
}

/// Reads the frames `wanted`, in ascending order, and skips all others.
fn some(folder: &Folder, name: &str, wanted: &[usize]) -> Vec<f64> {
    let mut body = folder.open(&argument(folder, name)).unwrap();
    let mut next = 0;
    let mut heights = Vec::new();
    for &frame in wanted {
        body.skip(frame - next);
        let positions = body.next_frame().unwrap().unwrap();
        heights.push(match positions {
            Positions::F32(positions) => positions[3][2].into(),
            Positions::F64(positions) => positions[3][2],
        });
        next = frame + 1;
    }
    heights
}

fn archive(method: CompressionMethod, frames: u64, positions: &[f32]) -> Vec<u8> {
    let faces = bytes(&[0_u32, 2, 1, 0, 1, 3], u32::to_le_bytes);
    npz(
        method,
        &[
            (
                "vertices",
                npy(
                    "<f4",
                    false,
                    &[frames, 4, 3],
                    &bytes(positions, f32::to_le_bytes),
                ),
            ),
            ("faces", npy("<u4", false, &[2, 3], &faces)),
        ],
    )
}

#[test]
fn passing_over_frames_is_reading_the_others() {
    let folder = Folder::new();
    folder
        .write("m.obj", tetrahedron(1.0))
        .write("s.pc2", pc2(4, 6, &positions(6)))
        .write("s.mdd", mdd(4, 6, &positions(6)))
        .write(
            "stored.npz",
            archive(CompressionMethod::Stored, 6, &positions(6)),
        )
        .write(
            "deflated.npz",
            archive(CompressionMethod::DEFLATE, 6, &positions(6)),
        );
    for frame in 0..6_u8 {
        folder.write(
            &format!("t{frame}.obj"),
            tetrahedron(f64::from(frame) + 1.0),
        );
        let part = &positions(6)[24 * (usize::from(frame) / 2)..][..24];
        if frame % 2 == 0 {
            folder.write(
                &format!("p{frame}.npz"),
                archive(CompressionMethod::Stored, 2, part),
            );
        }
    }
    for name in [
        "m.obj+s.pc2",
        "m.obj+s.mdd",
        "stored.npz",
        "deflated.npz",
        "t*.obj",
        "p*.npz",
    ] {
        let all = tops(&folder, name);
        assert_eq!(all, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], "{name}");
        for mask in 0..64_usize {
            let wanted: Vec<usize> = (0..6).filter(|frame| mask >> frame & 1 == 1).collect();
            let expected: Vec<f64> = wanted.iter().map(|&frame| all[frame]).collect();
            assert_eq!(some(&folder, name, &wanted), expected, "{name} {wanted:?}");
        }
        let mut body = folder.open(&argument(&folder, name)).unwrap();
        body.skip(usize::MAX);
        assert!(
            body.next_frame().unwrap().is_none(),
            "beyond the end is the end"
        );
    }
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/skin.gltf");
    let open = || pliant_io::open(file.to_str().unwrap(), &OpenOptions::default()).unwrap();
    let all = all_frames(&mut open()).unwrap();
    let mut body = open();
    body.skip(20);
    assert_eq!(all_frames(&mut body).unwrap(), all[20..]);
}

/// Where the format allows it, skipped data are not read: they may be damaged, or no mesh at all.
#[test]
fn what_is_passed_over_is_not_read() {
    let folder = Folder::new();
    let mut spoiled = positions(6);
    spoiled[30] = f32::NAN; // of frame 2
    folder
        .write("m.obj", tetrahedron(1.0))
        .write("s.pc2", pc2(4, 6, &spoiled))
        .write("s.mdd", mdd(4, 6, &spoiled))
        .write(
            "stored.npz",
            archive(CompressionMethod::Stored, 6, &spoiled),
        )
        .write("t0.obj", tetrahedron(1.0))
        .write("t1.obj", "nonsense")
        .write("t2.obj", "v nonsense")
        .write("t3.obj", tetrahedron(4.0));
    for name in ["m.obj+s.pc2", "m.obj+s.mdd", "stored.npz", "t*.obj"] {
        assert_eq!(some(&folder, name, &[0, 3]), [1.0, 4.0], "{name}");
        let whole = folder.error(&argument(&folder, name));
        assert!(!whole.is_empty(), "{name}");
    }
    // After an error no frame follows, skipped or not.
    let mut body = folder.open("t*.obj").unwrap();
    body.skip(2);
    assert!(body.next_frame().is_err());
    body.skip(1);
    assert!(body.next_frame().is_err());
}
