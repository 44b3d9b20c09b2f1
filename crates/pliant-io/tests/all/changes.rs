//! Files that change: while being read, between frames, or between being found and being opened.

use std::fs::{self, File};
use std::time::{Duration, SystemTime};

use crate::common::{Folder, all_frames, bytes, npy, npz, tetrahedron};
use pliant_io::{Body, Error, Reason};
use zip::CompressionMethod;

/// Sets the modification time, as a slightly later write would.
fn touch(folder: &Folder, name: &str) {
    let file = File::options()
        .append(true)
        .open(folder.path().join(name))
        .unwrap();
    let later = SystemTime::now() + Duration::from_secs(9);
    file.set_modified(later).unwrap();
}

fn changed(result: Result<Vec<Vec<[f64; 3]>>, Error>) -> bool {
    let error = result.unwrap_err();
    let line = error.to_string();
    assert!(line.contains("changed while it was being read"), "{line}");
    assert_eq!(line.lines().count(), 1);
    matches!(error.reason(), Reason::Changed)
}

fn sequence(folder: &Folder) -> Body {
    for frame in [1, 2, 3] {
        folder.write(&format!("t{frame}.obj"), tetrahedron(f64::from(frame)));
    }
    folder.open("t*.obj").unwrap()
}

#[test]
fn a_frame_that_grows_shrinks_or_is_written_anew_is_refused() {
    let folder = Folder::new();
    let grown = tetrahedron(2.0) + "# and more\n";
    let shrunk = tetrahedron(2.0).replace("f 3 1 4\n", "");
    let equal = tetrahedron(7.0);
    for text in [grown, shrunk, equal] {
        let mut body = sequence(&folder);
        assert!(body.next_frame().unwrap().is_some());
        folder.write("t2.obj", text);
        touch(&folder, "t2.obj");
        assert!(changed(all_frames(&mut body)));
    }
    // Frames that were read before stay valid.
    let mut body = sequence(&folder);
    folder.write("t1.obj", "no mesh any more");
    assert_eq!(all_frames(&mut body).unwrap().len(), 3);
}

#[cfg(unix)]
#[test]
fn a_frame_that_another_file_takes_the_place_of_is_refused() {
    let folder = Folder::new();
    let mut body = sequence(&folder);
    let old = folder.path().join("t2.obj");
    // Same length and same time, but another file.
    let time = fs::metadata(&old).unwrap().modified().unwrap();
    folder.write("new", tetrahedron(8.0));
    let new = folder.path().join("new");
    let file = File::options().append(true).open(&new).unwrap();
    file.set_modified(time).unwrap();
    fs::rename(new, old).unwrap();
    assert!(changed(all_frames(&mut body)));
}

#[cfg(unix)]
#[test]
fn a_pipe_that_takes_the_place_of_a_frame_is_not_waited_for() {
    let folder = Folder::new();
    let mut body = sequence(&folder);
    fs::remove_file(folder.path().join("t2.obj")).unwrap();
    let made = std::process::Command::new("mkfifo")
        .arg(folder.path().join("t2.obj"))
        .status();
    if !made.is_ok_and(|status| status.success()) {
        eprintln!("skipped: no pipe could be made with mkfifo");
        return;
    }
    assert!(changed(all_frames(&mut body)));
    // A pipe that is found as one is not opened at all.
    assert!(folder.error("t2.obj").contains("not a regular file"));
    assert!(folder.error("t*.obj").contains("not a regular file"));
}

/// Three frames of 10,000 vertices, so that no buffer holds them all.
fn long_npz(method: CompressionMethod) -> Vec<u8> {
    let coordinates: Vec<f32> = (0..90_000_u32).map(|i| (i * 7919 % 9973) as f32).collect();
    let vertices = npy(
        "<f4",
        false,
        &[3, 10_000, 3],
        &bytes(&coordinates, f32::to_le_bytes),
    );
    let faces = npy("<u4", false, &[1, 3], &bytes(&[0, 1, 2], u32::to_le_bytes));
    npz(method, &[("vertices", vertices), ("faces", faces)])
}

#[test]
fn a_sequence_in_one_file_is_refused_from_the_frame_on_where_it_changes() {
    let folder = Folder::new();
    for method in [CompressionMethod::Stored, CompressionMethod::DEFLATE] {
        let file = long_npz(method);
        for change in ["grown", "shrunk", "touched", "in place"] {
            folder.write("a.npz", &file);
            let mut body = folder.open("a.npz").unwrap();
            assert!(body.next_frame().unwrap().is_some());
            let handle = File::options()
                .write(true)
                .open(folder.path().join("a.npz"))
                .unwrap();
            match change {
                "grown" => handle.set_len(file.len() as u64 + 1).unwrap(),
                "shrunk" => handle.set_len(file.len() as u64 / 2).unwrap(),
                "touched" => touch(&folder, "a.npz"),
                _ => {
                    use std::io::Write;
                    (&handle).write_all(&file[..file.len() / 2]).unwrap();
                    touch(&folder, "a.npz");
                }
            }
            assert!(changed(all_frames(&mut body)), "{change}");
        }
    }
}

#[test]
fn between_looking_into_a_file_and_reading_it() {
    // The first file is looked into when the body is opened, and opened again when its turn comes.
    let folder = Folder::new();
    let file = long_npz(CompressionMethod::Stored);
    folder.write("a1.npz", &file).write("a2.npz", &file);
    let mut body = folder.open("a*.npz").unwrap();
    // Equal numbers of frames and bytes.
    touch(&folder, "a2.npz");
    for _ in 0..3 {
        assert!(body.next_frame().unwrap().is_some());
    }
    assert!(changed(all_frames(&mut body)));
}
