//! Arguments become bodies: files, patterns, order, and agreement between the frames of a body.

use crate::common::{Folder, all_frames, tetrahedron};
use pliant_io::{Error, OpenOptions, Place, Precision, Reason};

fn heights(folder: &Folder, argument: &str) -> Vec<f64> {
    let frames = all_frames(&mut folder.open(argument).unwrap()).unwrap();
    frames.iter().map(|frame| frame[3][2]).collect()
}

#[test]
fn the_files_of_a_pattern_are_frames_in_natural_order() {
    let folder = Folder::new();
    for frame in [10, 9, 100, 2] {
        folder.write(&format!("t{frame}.obj"), tetrahedron(f64::from(frame)));
    }
    folder
        .write("t3.txt", "no mesh")
        .write("u4.obj", tetrahedron(4.0))
        .write(".t5.obj", "hidden");
    std::fs::create_dir(folder.path().join("t1.obj")).unwrap();
    assert_eq!(heights(&folder, "t*.obj"), [2.0, 9.0, 10.0, 100.0]);
    assert_eq!(heights(&folder, "t?.obj"), [2.0, 9.0]);
    assert_eq!(heights(&folder, "[tu]*.obj"), [2.0, 9.0, 10.0, 100.0, 4.0]);
    assert_eq!(heights(&folder, "*.obj").len(), 5);

    let mut body = folder.open("t*.obj").unwrap();
    assert_eq!(body.name(), folder.argument("t*.obj"));
    assert_eq!(
        (body.frame_count(), body.vertex_count(), body.welded()),
        (4, 4, 0)
    );
    assert_eq!(
        body.triangles(),
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    );
    assert_eq!((body.faces(), body.precision()), (None, Precision::F64));
    assert_eq!(body.frame_file(2).unwrap(), folder.path().join("t10.obj"));
    assert_eq!(body.frame_file(4), None);
    all_frames(&mut body).unwrap();
    assert!(
        body.next_frame().unwrap().is_none(),
        "the end stays the end"
    );
}

#[test]
fn an_existing_file_wins_over_its_reading_as_a_pattern() {
    let folder = Folder::new();
    folder
        .write("t[1].obj", tetrahedron(1.0))
        .write("t1.obj", tetrahedron(2.0));
    assert_eq!(heights(&folder, "t[1].obj"), [1.0]);
    assert_eq!(heights(&folder, "t[1-2].obj"), [2.0]);
}

#[test]
fn frames_may_be_files_of_different_kinds() {
    let folder = Folder::new();
    let ply = "ply\nformat ascii 1.0\n\
        element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 4\nproperty list uchar int vertex_index\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n0 0 .1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    folder
        .write("t1.obj", tetrahedron(5.0))
        .write("t2.ply", ply);
    assert_eq!(heights(&folder, "t*"), [5.0, f64::from(0.1_f32)]);
    folder.write("t0.ply", ply);
    assert_eq!(
        folder.error("t*"),
        "t1.obj: holds 64-bit coordinates, but the body began with 32-bit ones in t0.ply; convert \
         the frames to one type"
    );
}

#[test]
fn what_names_nothing_readable_is_an_error() {
    let folder = Folder::new();
    folder
        .write("t.npt", "")
        .write("t.obj", "")
        .write("t.ply", "")
        .write("t.npz", "")
        .write("cut.obj", "v 0 0");
    std::fs::create_dir(folder.path().join("d.obj")).unwrap();
    let readable = "one frame per file (.obj, .ply, .stl); \
        a sequence per file (.npz, .glb, .gltf, .vrm); \
        positions beside a mesh ('mesh.obj+positions.pc2', .mdd, .npy)";
    assert_eq!(folder.error("none.obj"), "none.obj: no such file");
    assert_eq!(
        folder.error("none_*.obj"),
        "none_*.obj: no file matches this pattern"
    );
    assert_eq!(folder.error("d.*"), "d.*: no file matches this pattern");
    assert!(
        folder
            .error("[.obj")
            .starts_with("[.obj: not a valid pattern")
    );
    assert_eq!(
        folder.error("d.obj"),
        "d.obj: is a directory; name a file, or a pattern such as 'frame_*.obj'"
    );
    assert_eq!(
        folder.error("t.npt"),
        format!("t.npt: this kind of file cannot be read; these can: {readable}")
    );
    assert_eq!(
        folder.error("t.npt*"),
        format!("t.npt: this kind of file cannot be read; these can: {readable}")
    );
    assert_eq!(folder.error("t.obj"), "t.obj: holds no vertices");
    assert_eq!(folder.error("t.ply"), "t.ply: is empty");
    assert!(folder.error("t.npz").starts_with("t.npz: not an NPZ file"));
    assert_eq!(
        folder.error("cut.obj"),
        "cut.obj, line 1: a vertex has two coordinates; pliant needs three"
    );
    for argument in [
        "",
        "\0",
        "a\0*.obj",
        "**x/*.obj",
        "t.obj/*.obj",
        "t.obj/t.obj",
    ] {
        let error = pliant_io::open(argument, &OpenOptions::default()).unwrap_err();
        assert_eq!(error.to_string().lines().count(), 1);
    }
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_refused_unopened() {
    let folder = Folder::new();
    std::os::unix::fs::symlink("/dev/zero", folder.path().join("zero.ply")).unwrap();
    assert!(folder.error("zero.ply").contains("not a regular file"));
    assert!(folder.error("zer*.ply").contains("not a regular file"));
    std::os::unix::fs::symlink("nowhere", folder.path().join("dangling.ply")).unwrap();
    assert!(folder.error("dang*.ply").contains("cannot be read"));
}

#[test]
fn faces_must_agree() {
    let folder = Folder::new();
    let second = tetrahedron(2.0).replace("f 2 3 4", "f 2 4 3");
    folder
        .write("t1.obj", tetrahedron(1.0))
        .write("t2.obj", second);
    let mut body = folder.open("t*.obj").unwrap();
    assert!(body.next_frame().unwrap().is_some());
    let error = body.next_frame().unwrap_err();
    assert_eq!(error.file(), folder.path().join("t2.obj"));
    assert_eq!(error.place(), &Place::Line(7));
    assert!(matches!(
        error.reason(),
        Reason::FacesDiffer { face: 2, than } if *than == folder.path().join("t1.obj")
    ));
    let after: Error = body.next_frame().unwrap_err();
    assert!(
        matches!(after.reason(), Reason::AfterError),
        "frames after an error are not handed out"
    );

    let agree = "the frames of a body need the same faces";
    folder.write("t2.obj", tetrahedron(2.0) + "f 1 2 3\n");
    assert_eq!(
        folder.error("t*.obj"),
        format!("t2.obj: has 5 faces, t1.obj has 4; {agree}")
    );
    folder.write("t2.obj", tetrahedron(2.0).replace("f 3 1 4\n", ""));
    assert_eq!(
        folder.error("t*.obj"),
        format!("t2.obj: has 3 faces, t1.obj has 4; {agree}")
    );
    folder.write("t2.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nv 0 0 0\n");
    assert_eq!(
        folder.error("t*.obj"),
        "t2.obj: holds no faces, so there is no surface to check"
    );
}

#[test]
fn vertex_counts_must_agree() {
    let folder = Folder::new();
    let agree = "the frames of a body need the same number";
    folder
        .write("t1.obj", tetrahedron(1.0))
        .write("t2.obj", tetrahedron(1.0) + "v 9 9 9\n");
    assert_eq!(
        folder.error("t*.obj"),
        format!("t2.obj: has 5 vertices, t1.obj has 4; {agree}")
    );
    folder.write("t2.obj", tetrahedron(1.0).replace("v 1 0 0\n", ""));
    assert_eq!(
        folder.error("t*.obj"),
        format!("t2.obj: has 3 vertices, t1.obj has 4; {agree}")
    );
}

#[test]
fn polygons_carry_their_number() {
    let folder = Folder::new();
    let box_without_lid = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 1 4 3 2\nf 1 2 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    folder.write("b1.obj", box_without_lid).write(
        "b2.obj",
        box_without_lid.replace("f 1 2 6 5", "f 1 2 6\nf 1 6 5"),
    );
    let body = folder.open("b1.obj").unwrap();
    assert_eq!(body.faces(), Some(&[0, 0, 1, 1, 2, 3, 4, 4, 5, 5][..]));
    assert_eq!(body.triangles()[2..4], [[0, 1, 5], [0, 5, 4]]);
    assert!(
        folder
            .error("b*.obj")
            .starts_with("b2.obj, line 10: face 1 has other corners than in b1.obj")
    );
}

#[test]
fn a_file_that_goes_away_is_an_error() {
    let folder = Folder::new();
    folder
        .write("t1.obj", tetrahedron(1.0))
        .write("t2.obj", tetrahedron(2.0));
    let mut body = folder.open("t*.obj").unwrap();
    std::fs::remove_file(folder.path().join("t2.obj")).unwrap();
    assert!(matches!(
        all_frames(&mut body).unwrap_err().reason(),
        Reason::Io(_)
    ));
}

#[test]
fn memory_is_limited_by_what_is_held() {
    let folder = Folder::new();
    // Four vertices of 24 bytes, and four triangles of 12. The second file has six triangles of 16,
    // with their polygons.
    folder
        .write("t.obj", tetrahedron(1.0))
        .write("q.obj", tetrahedron(1.0) + "f 1 2 3 4\n");
    let ascii = "ply\nformat ascii 1.0\n\
        element vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
        element face 4\nproperty list uchar int vertex_index\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    folder.write("t.ply", ascii);
    let open = |name: &str, weld, max_memory| {
        pliant_io::open(
            &folder.argument(name),
            &OpenOptions {
                weld,
                max_memory,
                ..OpenOptions::default()
            },
        )
        .and_then(|mut body| all_frames(&mut body))
        .map_err(|error| match error.reason() {
            Reason::TooLarge { needed, limit } => ("frame", *needed, *limit),
            Reason::SeamsTooLarge { needed, limit } => ("seams", *needed, *limit),
            _ => panic!("{error}"),
        })
    };
    let frame = 4 * 24 + 4 * 12;
    let seams = frame + 4 * 24 + 4 * 8;
    for name in ["t.obj", "t.ply"] {
        assert!(open(name, false, frame).is_ok());
        assert!(open(name, true, seams).is_ok());
        assert_eq!(
            open(name, true, seams - 1).unwrap_err(),
            ("seams", seams, seams - 1)
        );
        assert_eq!(
            open(name, false, frame - 1).unwrap_err(),
            ("frame", frame, frame - 1)
        );
    }
    let polygons = frame + 2 * 12 + 6 * 4;
    assert!(open("q.obj", false, polygons).is_ok());
    assert!(open("q.obj", false, polygons - 1).is_err());
    // Later frames replace the first; welding is held beside them.
    folder
        .write("t2.obj", tetrahedron(2.0))
        .write("t1.obj", tetrahedron(3.0));
    assert_eq!(open("t*.obj", false, frame).unwrap().len(), 3);
}

#[test]
fn bodies_can_be_sent_to_threads_and_errors_kept() {
    fn sent<T: Send>() {}
    fn shared<T: Send + Sync + std::error::Error + 'static>() {}
    sent::<pliant_io::Body>();
    shared::<Error>();
}
