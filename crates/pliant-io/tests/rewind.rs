//! A body that is read twice: the same frames, and no file that is another one meanwhile.

mod common;

use common::{Folder, all_frames, npy, npz, tetrahedron};
use pliant_io::Reason;
use zip::CompressionMethod;

/// Two frames as files, and two as one file that is deflated and cannot be sought in.
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
                        &common::bytes(&vertices, f32::to_le_bytes),
                    ),
                ),
                (
                    "faces",
                    npy(
                        "<u4",
                        false,
                        &[1, 3],
                        &common::bytes(&faces, u32::to_le_bytes),
                    ),
                ),
            ],
        ),
    );
    folder
}

#[test]
fn frames_come_again_from_wherever_the_reading_was() {
    let folder = folder();
    for argument in ["t*.obj", "t.npz"] {
        let all = all_frames(&mut folder.open(argument).unwrap()).unwrap();
        assert_eq!(all.len(), 3);
        for read in 0..=3 {
            let mut body = folder.open(argument).unwrap();
            for frame in 0..read {
                body.next_frame().unwrap();
                assert_eq!(body.positions().get(0), all[frame][0]);
            }
            body.rewind().unwrap();
            body.rewind().unwrap();
            assert_eq!(
                all_frames(&mut body).unwrap(),
                all,
                "{argument} after {read}"
            );
            assert!(body.next_frame().unwrap().is_none());
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
}
