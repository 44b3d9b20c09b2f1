//! Hostile files: refused in one line, with exit code 2, soon, in little memory.

use crate::common::npz::{Entry, archive, array};
use crate::common::{Measured, measured};
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::process::{Command, Stdio};

/// Bytes: more than the program needs for any small file, less than any claim below.
const LITTLE: u64 = 64 << 20;

/// Fails unless the file is refused soon and in little memory, by one line with its name and
/// `words`.
fn refused(folder: &Path, name: &str, words: &[&str]) {
    refused_with(folder, &[name], &[&[name], words].concat());
}

fn refused_with(folder: &Path, arguments: &[&str], words: &[&str]) {
    let Measured { said, peak } = measured(folder, &[&["check"], arguments].concat());
    said.assert_refused(words);
    assert!(!said.err.contains("panicked"), "{}", said.err);
    assert!(
        peak.is_none_or(|peak| peak < LITTLE),
        "{arguments:?} took {peak:?} bytes"
    );
}

const OBJ: &[u8] = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";

fn ply(encoding: &str, counts: [&str; 2], data: &[u8]) -> Vec<u8> {
    let [vertices, faces] = counts;
    let header = format!(
        "ply\nformat {encoding} 1.0\nelement vertex {vertices}\n\
         property float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list uint int vertex_indices\nend_header\n"
    );
    [header.as_bytes(), data].concat()
}

/// Three corners, and a triangle with these numbers.
fn binary(corners: [[f32; 3]; 3], triangle: [i32; 3]) -> Vec<u8> {
    let mut data: Vec<u8> = corners
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    data.extend(3_u32.to_le_bytes());
    data.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    data
}

const CORNERS: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn npz(corners: [[f32; 3]; 3], triangle: [i32; 3]) -> Vec<u8> {
    let data = binary(corners, triangle);
    archive(&[
        Entry::stored("vertices", array("<f4", "(1, 3, 3)", &data[..36])),
        Entry::stored("faces", array("<i4", "(1, 3)", &data[40..])),
    ])
}

#[test]
fn cut_short_at_any_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let little = ply(
        "binary_little_endian",
        ["3", "1"],
        &binary(CORNERS, [0, 1, 2]),
    );
    let ascii = ply("ascii", ["3", "1"], b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (name, whole) in [
        ("whole.ply", &little),
        ("ascii.ply", &ascii),
        ("whole.npz", &npz(CORNERS, [0, 1, 2])),
    ] {
        fs::write(path.join(name), whole).unwrap();
        let said = measured(path, &["check", name]).said;
        assert_eq!((said.code, said.err.as_str()), (0, ""), "{name}");
        // Without the line break at the end of the text.
        for end in (0..whole.len() - 1).step_by(whole.len() / 12) {
            let cut = format!("cut{end}_{name}");
            fs::write(path.join(&cut), &whole[..end]).unwrap();
            refused(path, &cut, &[]);
        }
    }
    // An OBJ file announces no sizes. A cut inside a word or before the first face is found; faces
    // of two corners are noted.
    fs::write(path.join("cut.obj"), &OBJ[..OBJ.len() - 2]).unwrap();
    let said = measured(path, &["check", "cut.obj"]).said;
    assert!(said.code == 0 && said.err.contains("have two corners"));
    for end in [0, 3, 30, OBJ.len() - 4] {
        fs::write(path.join("cut.obj"), &OBJ[..end]).unwrap();
        refused(path, "cut.obj", &[]);
    }
}

#[test]
fn counts_that_nothing_stands_behind() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let most = "18446744073709551615";
    let some = "50000000"; // 600 MB of vertices: allowed, but not there
    for (name, contents, word) in [
        (
            "a.ply",
            ply("ascii", [most, "1"], b"0 0 0\n"),
            "--max-memory",
        ),
        (
            "b.ply",
            ply("binary_little_endian", [most, most], b"1234"),
            "--max-memory",
        ),
        (
            "c.ply",
            ply("binary_big_endian", [some, "1"], b"1234"),
            "ends too early",
        ),
        (
            "d.ply",
            ply("ascii", [some, some], b"0 0 0\n"),
            "ends too early",
        ),
        (
            "e.ply",
            ply(
                "binary_little_endian",
                ["3", most],
                &binary(CORNERS, [0, 1, 2]),
            ),
            "--max-memory",
        ),
        (
            "f.ply",
            ply(
                "binary_little_endian",
                ["3", some],
                &binary(CORNERS, [0, 1, 2]),
            ),
            "ends too early",
        ),
        (
            "g.ply",
            ply("ascii", ["99999999999999999999", "1"], b""),
            "expected a count",
        ),
        ("h.ply", ply("ascii", ["-1", "1"], b""), "expected a count"),
        (
            "i.npz",
            npz_of("(1, 4000000000000000000, 3)", "(1, 3)"),
            "ends too early",
        ),
        (
            "j.npz",
            npz_of("(18446744073709551615, 3, 3)", "(1, 3)"),
            "more than 2^64",
        ),
        (
            "k.npz",
            npz_of("(1, 3, 3)", "(18446744073709551615, 3)"),
            "--max-memory",
        ),
        (
            "l.npz",
            npz_of("(1, 3, 3)", "(50000000, 3)"),
            "ends too early",
        ),
    ] {
        fs::write(path.join(name), contents).unwrap();
        refused(path, name, &[word]);
    }
    // A polygon of four thousand million corners.
    let mut polygon = binary(CORNERS, [0, 1, 2]);
    polygon[36..40].copy_from_slice(&u32::MAX.to_le_bytes());
    fs::write(
        path.join("m.ply"),
        ply("binary_little_endian", ["3", "1"], &polygon),
    )
    .unwrap();
    refused(path, "m.ply", &["face 0", "ends too early"]);
    // Elements without data, as often as there are numbers.
    let nothing = "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\n\
        element vertex 0\nproperty float x\nproperty float y\nproperty float z\n\
        element face 0\nproperty list uchar int vertex_indices\nend_header\n";
    fs::write(path.join("n.ply"), nothing).unwrap();
    refused(path, "n.ply", &["holds no vertices"]);
}

fn npz_of(vertices: &str, faces: &str) -> Vec<u8> {
    let data = binary(CORNERS, [0, 1, 2]);
    archive(&[
        Entry::stored("vertices", array("<f4", vertices, &data[..36])),
        Entry::stored("faces", array("<i4", faces, &data[40..])),
    ])
}

#[test]
fn wrong_words_numbers_and_indices() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let bad = |at: usize, value: f32| {
        let mut corners = CORNERS;
        corners[at / 3][at % 3] = value;
        corners
    };
    let file = |corners, triangle| {
        ply(
            "binary_little_endian",
            ["3", "1"],
            &binary(corners, triangle),
        )
    };
    let text = |row: &str| {
        ply(
            "ascii",
            ["3", "1"],
            format!("0 0 0\n{row}\n0 1 0\n3 0 1 2\n").as_bytes(),
        )
    };
    let obj = |line: &str| [OBJ, line.as_bytes()].concat();
    for (name, contents, word) in [
        (
            "nan.ply",
            file(bad(4, f32::NAN), [0, 1, 2]),
            "y of vertex 1",
        ),
        (
            "inf.ply",
            file(bad(8, f32::INFINITY), [0, 1, 2]),
            "z of vertex 2",
        ),
        ("nan.npz", npz(bad(3, f32::NAN), [0, 1, 2]), "x of vertex 1"),
        (
            "inf.npz",
            npz(bad(0, f32::NEG_INFINITY), [0, 1, 2]),
            "x of vertex 0",
        ),
        ("text.ply", text("1 one 0"), "\"one\""),
        ("nan_text.ply", text("1 nan 0"), "y of vertex 1"),
        ("short.ply", text("1 0"), "line 11"),
        ("long.ply", text("1 0 0 0"), "line 11"),
        ("text.obj", obj("v 1 one 0\n"), "line 7"),
        ("nan.obj", obj("v 1 nan 0\n"), "y of vertex 4"),
        ("large.obj", obj("v 1 0 1e39\n"), "z of vertex 4"),
        ("binary.obj", vec![0; 17 << 20], "is this a binary file?"),
        ("index.obj", obj("f 1 2 5\n"), "vertex 5"),
        ("zero.obj", obj("f 0 1 2\n"), "numbers begin at 1"),
        ("index.ply", file(CORNERS, [0, 1, 3]), "vertex 3"),
        ("below.ply", file(CORNERS, [0, -1, 2]), "vertex -1"),
        ("index.npz", npz(CORNERS, [0, 1, 3]), "vertex 3"),
        (
            "below.npz",
            npz(CORNERS, [0, 1, i32::MIN]),
            "vertex -2147483648",
        ),
    ] {
        fs::write(path.join(name), contents).unwrap();
        refused(path, name, &[word]);
    }
}

#[test]
fn nothing_directories_pipes_and_devices() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    for ending in ["obj", "ply", "npz"] {
        let [empty, directory, pipe, device, many] =
            ["empty", "directory", "pipe", "device", "many_1"]
                .map(|name| format!("{name}.{ending}"));
        fs::write(path.join(&empty), "").unwrap();
        refused(path, &empty, &[]);
        fs::create_dir(path.join(&directory)).unwrap();
        refused(path, &directory, &["is a directory"]);
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("/dev/zero", path.join(&device)).unwrap();
            refused(path, &device, &["not a regular file"]);
            if !Command::new("mkfifo")
                .arg(path.join(&pipe))
                .status()
                .is_ok_and(|made| made.success())
            {
                eprintln!("skipped: no pipe could be made with mkfifo");
                continue;
            }
            refused(path, &pipe, &["not a regular file"]);
            fs::hard_link(path.join(&pipe), path.join(&many)).unwrap();
            refused_with(
                path,
                &[&format!("many_*.{ending}")],
                &[&many, "not a regular file"],
            );
        }
    }
}

/// A megabyte of zeros, deflated, in a form that can be repeated.
const ZEROS: usize = 1 << 20;

fn deflated_zeros(times: usize) -> Vec<u8> {
    // One literal, then matches of 258 at distance 1, in a block of fixed codes.
    //
    // Then an empty stored block, which ends at a byte.
    let (mut bits, mut stream) = (Vec::new(), Vec::new());
    let mut put =
        |code: u32, length: u32| bits.extend((0..length).rev().map(|bit| code >> bit & 1));
    put(0b0, 1); // not the last block
    put(0b10, 2); // fixed codes (01, least significant bit first)
    let matches = (ZEROS - 1) / 258;
    for _ in 0..ZEROS - 258 * matches {
        put(0b0011_0000, 8); // the literal 0
    }
    for _ in 0..matches {
        put(0b1100_0101, 8); // length 258
        put(0, 5); // distance 1
    }
    put(0, 7); // end of the block
    put(0, 3); // not the last block; stored
    while bits.len() % 8 != 0 {
        bits.push(0);
    }
    for byte in bits.chunks(8) {
        stream.push(
            byte.iter()
                .rev()
                .fold(0, |byte, bit| byte << 1 | *bit as u8),
        );
    }
    stream.extend([0, 0, 0xff, 0xff]);
    stream.repeat(times)
}

/// An array with a stored header and deflated data.
fn bomb(name: &'static str, dtype: &str, shape: &str, megabytes: usize) -> Entry {
    let header = array(dtype, shape, &[]);
    let [low, high] = (header.len() as u16).to_le_bytes();
    let mut data = vec![0, low, high, !low, !high];
    data.extend(&header);
    data.extend(deflated_zeros(megabytes));
    data.extend([1, 0, 0, 0xff, 0xff]); // the last block, empty
    Entry {
        name,
        deflated: true,
        size: (header.len() + megabytes * ZEROS) as u32,
        checksum: 0,
        data,
    }
}

#[test]
fn bombs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let faces = || Entry::stored("faces", array("<i4", "(1, 3)", &[0; 12]));
    let vertices = || Entry::stored("vertices", array("<f4", "(1, 3, 3)", &[0; 36]));
    // A frame of 3,840 MiB in 25 MiB: within the limit, but not with its seams.
    let frame = archive(&[bomb("vertices", "<f4", "(1, 335544320, 3)", 3840), faces()]);
    assert!(frame.len() < 26 << 20);
    fs::write(path.join("frame.npz"), &frame).unwrap();
    refused(
        path,
        "frame.npz",
        &[
            "frame 0",
            "6.3 GiB",
            "4 GiB are allowed",
            "--no-weld",
            "--max-memory",
        ],
    );
    refused_with(
        path,
        &["frame.npz", "--no-weld", "--max-memory", "3G"],
        &["frame.npz", "3.8 GiB", "3 GiB are allowed", "--max-memory"],
    );
    // Equally many faces.
    let many = archive(&[vertices(), bomb("faces", "<i4", "(335544320, 3)", 3840)]);
    fs::write(path.join("faces.npz"), &many).unwrap();
    refused(path, "faces.npz", &["11.3 GiB", "4 GiB are allowed"]);
    // Endless frames are streamed: each is small, and only the checksum, at the end, is wrong.
    let frames = archive(&[bomb("vertices", "<f4", "(144, 174762, 3)", 288), faces()]);
    fs::write(path.join("frames.npz"), &frames).unwrap();
    refused(path, "frames.npz", &["the shape needs"]);
    let frames = archive(&[bomb("vertices", "<f4", "(48, 131072, 3)", 72), faces()]);
    fs::write(path.join("frames.npz"), &frames).unwrap();
    refused(path, "frames.npz", &["does not match its checksum"]);
    // Data beyond the announced length is not unpacked.
    let mut hidden = bomb("vertices", "<f4", "(1, 3, 3)", 3840);
    hidden.size = (array("<f4", "(1, 3, 3)", &[]).len() + 36) as u32;
    fs::write(path.join("hidden.npz"), archive(&[hidden, faces()])).unwrap();
    refused(path, "hidden.npz", &["does not match its checksum"]);
}

/// A find with `zip` 9.4.1, which reserved room for all records that the end of a directory claims.
#[test]
fn a_hole_of_eight_gibibytes_with_a_directory_that_claims_to_fill_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let mut file = File::create(path.join("hole.npz")).unwrap();
    let length = 8_u64 << 30;
    let (directory, end) = (length / 40, length - 2000);
    if file.set_len(end).is_err() {
        eprintln!("skipped: no file with a hole can be made here");
        return;
    }
    let record = [&b"PK\x01\x02"[..], &[0; 60]].concat();
    file.seek(SeekFrom::Start(directory)).unwrap();
    file.write_all(&record).unwrap();
    file.seek(SeekFrom::Start(end)).unwrap();
    let records = (end - directory) / 46;
    let mut tail = [
        &b"PK\x06\x06"[..],
        &44_u64.to_le_bytes(),
        &[45, 0, 45, 0],
        &[0; 8],
    ]
    .concat();
    for number in [records, records, 1 << 62, directory] {
        tail.extend(number.to_le_bytes());
    }
    tail.extend(
        [
            &b"PK\x06\x07\0\0\0\0"[..],
            &end.to_le_bytes(),
            &[1, 0, 0, 0],
        ]
        .concat(),
    );
    tail.extend([&b"PK\x05\x06\0\0\0\0"[..], &[0xff; 12], &[0, 0]].concat());
    file.write_all(&tail).unwrap();
    refused(path, "hole.npz", &["not an NPZ file"]);

    // Holes in the other formats.
    for (name, head, word) in [
        ("hole.obj", &b""[..], "is this a binary file?"),
        (
            "hole.ply",
            &ply("binary_little_endian", ["3", "600000000"], &[])[..],
            "--max-memory",
        ),
        (
            "short.ply",
            &ply("binary_little_endian", ["3", "60"], &[])[..],
            "face 0 has 0 corners",
        ),
    ] {
        let mut file = File::create(path.join(name)).unwrap();
        file.write_all(head).unwrap();
        file.set_len(1 << 36).unwrap();
        refused(path, name, &[word]);
    }
}

/// A frame in which each of `count` triangles crosses each of `count` others.
fn thicket(count: u32, shift: f64) -> String {
    let mut text = String::new();
    for i in 0..count {
        let at = f64::from(i) / 64.0 + shift;
        writeln!(text, "v -9 -9 {at}\nv 99 -9 {at}\nv -9 99 {at}").unwrap();
        writeln!(text, "v {at} 0 -9\nv {at} 1 -9\nv {at} 0 99").unwrap();
    }
    for i in 0..2 * count {
        writeln!(text, "f {} {} {}", 3 * i + 1, 3 * i + 2, 3 * i + 3).unwrap();
    }
    text
}

#[test]
fn frames_that_change_between_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let last = path.join("t19.obj");
    let changes: [(&str, &dyn Fn()); 5] = [
        ("grown", &|| {
            let mut file = File::options().append(true).open(&last).unwrap();
            file.write_all(b"# more\n").unwrap();
        }),
        ("shrunk", &|| {
            let file = File::options().write(true).open(&last).unwrap();
            file.set_len(99).unwrap();
        }),
        ("replaced", &|| {
            fs::write(path.join("new"), thicket(40, 19.0)).unwrap();
            fs::rename(path.join("new"), &last).unwrap();
        }),
        ("a pipe", &|| {
            fs::remove_file(&last).unwrap();
            let made = Command::new("mkfifo").arg(&last).status();
            if !made.is_ok_and(|made| made.success()) {
                eprintln!("skipped: no pipe could be made with mkfifo");
                fs::write(&last, "").unwrap();
            }
        }),
        ("gone", &|| fs::remove_file(&last).unwrap()),
    ];
    for (what, change) in changes {
        let _ = fs::remove_file(&last);
        for frame in 0..20 {
            fs::write(
                path.join(format!("t{frame}.obj")),
                thicket(40, f64::from(frame)),
            )
            .unwrap();
        }
        // A frame prints some 20 kB. Nobody reads yet, so the program blocks some frames from here.
        let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
            .current_dir(path)
            .args(["check", "t*.obj", "--format", "json"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut out = child.stdout.take().unwrap();
        let mut text = vec![0; 1000];
        out.read_exact(&mut text).unwrap();
        change();
        out.read_to_end(&mut text).unwrap();
        let output = child.wait_with_output().unwrap();
        let line = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{what}: {line}");
        assert_eq!(line.lines().count(), 1, "{what}: {line}");
        let word = if what == "gone" {
            "cannot be read"
        } else {
            "changed while it was being read"
        };
        assert!(
            line.contains("t19.obj") && line.contains(word),
            "{what}: {line}"
        );
        let text = String::from_utf8(text).unwrap();
        assert_eq!(
            text.matches("\"frame\":").count(),
            19,
            "what was checked stands"
        );
        assert!(
            text.trim_end().ends_with('}') && text.contains("\"error\":"),
            "{what}"
        );
    }
}

#[test]
fn more_pairs_than_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("a.obj"), thicket(40, 0.0)).unwrap();
    let listed = |limit: &str| {
        measured(
            path,
            &["check", "a.obj", "--format", "json", "--max-memory", limit],
        )
        .said
    };
    let whole = listed("25600");
    assert_eq!((whole.code, whole.counts()), (1, vec![1600]));
    let refused = listed("25599");
    refused.assert_refused(&["frame 0", "more than 1599 pairs", "--max-memory", "--count"]);
    assert!(refused.json()["error"].is_string());
    // Without lists nothing is kept: four million pairs would take 64 MB.
    fs::write(path.join("thicket.obj"), thicket(2000, 0.0)).unwrap();
    for (arguments, pairs) in [
        (&[][..], "4,000,000"),
        (&["--count", "--format", "json"], "4000000"),
    ] {
        let count = [&["check", "thicket.obj"], arguments].concat();
        let Measured { said, peak } = measured(path, &count);
        assert!(
            said.code == 1 && said.out.contains(pairs),
            "{}{}",
            said.out,
            said.err
        );
        if arguments.is_empty() {
            let smallest = "triangle 0 of body 0, triangle 1 of body 0";
            assert!(said.out.contains(smallest), "{}", said.out);
        }
        // Crossing edges, which JSON counts, are searched with buffers of their own.
        let most = if arguments.is_empty() {
            LITTLE / 2
        } else {
            LITTLE
        };
        assert!(peak.is_none_or(|peak| peak < most), "{peak:?}");
    }
}

#[test]
fn what_would_take_hours_is_refused_with_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // A polygon that goes to and fro. All triangles of its fan share vertices.
    let corners = "1 2 ".repeat(80_000);
    fs::write(
        path.join("fro.obj"),
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {corners}\n"),
    )
    .unwrap();
    refused(
        path,
        "fro.obj",
        &["face 0 visits 2 vertices 160000 times in all, \
            which no face of a surface does; mend it"],
    );
    let list: Vec<u8> = (0..160_000_u32)
        .flat_map(|corner| (corner % 2).to_le_bytes())
        .collect();
    let face = [&[0; 36][..], &160_000_u32.to_le_bytes(), &list].concat();
    fs::write(
        path.join("fro.ply"),
        ply("binary_little_endian", ["3", "1"], &face),
    )
    .unwrap();
    refused(path, "fro.ply", &["visits 2 vertices 160000 times in all"]);
    // A sparse file of triangles in a single point: two thousand million pairs, or twenty.
    for (count, is_refused) in [(1 << 16, false), (200_000, true)] {
        let mut file = File::create(path.join("point.stl")).unwrap();
        file.write_all(&[&[b' '; 80][..], &u32::to_le_bytes(count)].concat())
            .unwrap();
        file.set_len(84 + 50 * u64::from(count)).unwrap();
        let arguments = ["check", "point.stl", "--first"];
        let said = measured(path, &arguments).said;
        if is_refused {
            said.assert_refused(&[
                "point.stl, frame 0: 200000 triangles have no size and lie at one point, (0.0, \
                 0.0, 0.0); each would be a pair with every other; remove these triangles",
            ]);
        } else {
            assert_eq!((said.code, said.err.as_str()), (1, ""));
        }
    }
}

#[test]
fn sizes_that_are_none_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.obj"), OBJ).unwrap();
    for size in ["", "1GB", "many", "-1", "99999999999G"] {
        let said = measured(
            folder.path(),
            &["check", "a.obj", &format!("--max-memory={size}")],
        )
        .said;
        assert_eq!(said.code, 2);
        assert!(said.err.contains("--max-memory"), "{}", said.err);
    }
    for size in ["4GiB", "512MiB", "1G", "100000"] {
        let said = measured(folder.path(), &["check", "a.obj", "--max-memory", size]).said;
        assert_eq!((said.code, said.err.as_str()), (0, ""));
    }
    // Four vertices, two triangles, their seams: 96 + 24 + 48 + 32.
    let said = measured(folder.path(), &["check", "a.obj", "--max-memory", "199"]).said;
    said.assert_refused(&[
        "a.obj",
        "200 bytes",
        "199 bytes are allowed",
        "--max-memory",
        "--no-weld",
    ]);
}

#[test]
fn very_many_names_are_no_danger() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 6 5 5\nv 5 6 5\n";
    let split = ["--split", "groups"];
    // A million names that no face has.
    let mut text = corners.to_owned();
    for number in 0..1_000_000 {
        writeln!(text, "g {number}").unwrap();
    }
    text += "f 1 2 3\no last\nf 4 5 6\n";
    fs::write(path.join("empty.obj"), &text).unwrap();
    let Measured { said, peak } = measured(path, &[&["check", "empty.obj"], &split[..]].concat());
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(
        said.out.contains("body 0: empty.obj#999999, "),
        "{}",
        said.out
    );
    assert!(peak.is_none_or(|peak| peak < LITTLE), "{peak:?}");
    // Very many names with a face each, and equally many of one object, whose name is long.
    let mut many = corners.to_owned();
    for number in 0..100_000 {
        writeln!(many, "g {number}\nf 1 2 3").unwrap();
    }
    fs::write(path.join("many.obj"), &many).unwrap();
    fs::write(
        path.join("long.obj"),
        format!("o {}\n{many}", "x".repeat(1 << 20)),
    )
    .unwrap();
    let said = measured(
        path,
        &[
            &["check", "many.obj", "--count", "--ignore-adjacent"],
            &split[..],
        ]
        .concat(),
    )
    .said;
    assert_eq!(said.code, 0, "{}", said.err);
    let head = "bodies 0 to 99999: many.obj#0 to #99999, ";
    assert!(said.out.starts_with(head), "{}", said.out);
    for (name, limit) in [("many.obj", "16MiB"), ("long.obj", "32MiB")] {
        let arguments = [&[name, "--max-memory", limit], &split[..]].concat();
        refused_with(
            path,
            &arguments,
            &[name, "allow more memory with `--max-memory`"],
        );
    }
}
