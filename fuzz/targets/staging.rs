//! Fuzzes writers: sequences written over anything that may be under their names, and given up at
//! any moment.
//!
//! A file is whole or as it was. Without leave to overwrite, nothing that was there changes. No
//! link is followed, and no half of a file is left. A finished file reads back bit for bit.
#![no_main]

use std::fs;
use std::os::unix::fs::{MetadataExt, symlink};
use std::path::{Path, PathBuf};

use arbitrary::Arbitrary;
use pliant_fuzz::folder;
use pliant_io::{OpenOptions, Positions, Precision, Shape, WriteOptions, Writer};

#[derive(Arbitrary, Debug)]
struct Input {
    there: [There; NAMES.len()],
    argument: u8,
    force: bool,
    wide: bool,
    vertices: u8,
    triangles: Vec<[u8; 3]>,
    announced: u8,
    frames: Vec<Vec<[Coordinate; 3]>>,
    is_finished: bool,
}

/// State of a name before writing.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum There {
    Nothing,
    File,
    Folder,
    /// Link to a file that no argument names.
    Link,
    HardLink,
    LinkToNothing,
    LinkToFolder,
}

/// An integer times a power of two; some need more than 32 bits.
#[derive(Arbitrary, Clone, Copy, Debug)]
struct Coordinate(i32, i8);

impl Coordinate {
    fn get(self) -> f64 {
        f64::from(self.0) * 2.0_f64.powi(i32::from(self.1) / 2)
    }
}

const NAMES: [&str; 10] = [
    "a.obj", "a.ply", "a.stl", "a.npz", "a.pc2", "a.mdd", "a_0.obj", "a_1.obj", "a_2.obj", "a.txt",
];

/// Arguments, and the files that they write. The last two cannot be written.
const ARGUMENTS: [(&str, &[&str]); 9] = [
    ("a.obj", &["a.obj"]),
    ("a.ply", &["a.ply"]),
    ("a.stl", &["a.stl"]),
    ("a.npz", &["a.npz"]),
    ("a.obj+a.pc2", &["a.obj", "a.pc2"]),
    ("a.ply+a.mdd", &["a.ply", "a.mdd"]),
    ("a_%d.obj", &["a_0.obj", "a_1.obj", "a_2.obj"]),
    ("a.txt", &[]),
    ("nowhere/a.obj", &[]),
];

const MINE: &[u8] = b"what nobody may lose";

/// State of a name, for comparison: inode, target of a link, content of a file.
fn look(path: &Path) -> Option<(u64, Option<PathBuf>, Option<Vec<u8>>)> {
    let its = path.symlink_metadata().ok()?;
    let content = its
        .is_file()
        .then(|| fs::read(path).expect("it can be read"));
    Some((its.ino(), fs::read_link(path).ok(), content))
}

fn put(there: There, path: &Path, mine: &Path) {
    match there {
        There::Nothing => Ok(()),
        There::File => fs::write(path, MINE),
        There::Folder => fs::create_dir(path),
        There::Link => symlink(mine, path),
        There::HardLink => fs::hard_link(mine, path),
        There::LinkToNothing => symlink(path.with_extension("none"), path),
        There::LinkToFolder => symlink(mine.with_file_name(""), path),
    }
    .expect("a folder of one's own can be filled");
}

/// Writes the sequence. Returns whether it was finished, and the frames that were taken.
fn write(
    input: &Input,
    argument: &str,
    shape: &Shape,
    frames: &[Vec<[f64; 3]>],
) -> (bool, Vec<Vec<[f64; 3]>>) {
    let options = WriteOptions {
        force: input.force,
        ..WriteOptions::default()
    };
    let Ok(mut writer) = Writer::create(argument, shape.clone(), options) else {
        return (false, Vec::new());
    };
    let mut taken = Vec::new();
    for frame in frames {
        let narrow: Vec<[f32; 3]> = frame.iter().map(|point| point.map(|x| x as f32)).collect();
        let positions = if input.wide {
            Positions::F64(frame)
        } else {
            Positions::F32(&narrow)
        };
        // After a frame that was refused, another may be given.
        if writer.frame(positions).is_ok() {
            taken.push(frame.clone());
        }
    }
    (input.is_finished && writer.finish().is_ok(), taken)
}

/// Asserts that a finished file has the frames given, in 32 bits where the format has no others.
///
/// STL has no vertex numbers, so its corners are compared.
fn compare(argument: &str, shape: &Shape, frames: &[Vec<[f64; 3]>]) {
    let options = OpenOptions {
        weld: false,
        ..OpenOptions::default()
    };
    let mut body = pliant_io::open(argument, &options).expect("what was written can be read");
    assert_eq!(body.frame_count(), frames.len());
    let is_soup = argument.ends_with("stl");
    let wide = body.precision() == Precision::F64;
    let triangles = body.triangles().to_vec();
    if !is_soup {
        assert_eq!(triangles, shape.triangles);
    }
    for expected in frames {
        let read = body.next_frame().expect("a frame").expect("as many frames");
        let bits = |x: f64| if wide { x } else { f64::from(x as f32) }.to_bits();
        if is_soup {
            let corners = triangles.as_flattened().iter();
            let expected = shape
                .triangles
                .as_flattened()
                .iter()
                .map(|&v| expected[v as usize]);
            assert!(expected.eq_by_bits(corners.map(|&v| read.get(v)), bits));
        } else {
            let read = (0..read.len() as u32).map(|vertex| read.get(vertex));
            assert!(expected.iter().copied().eq_by_bits(read, bits));
        }
    }
}

/// Points one by one, compared bit by bit.
trait Points: Iterator<Item = [f64; 3]> + Sized {
    fn eq_by_bits(self, other: impl Iterator<Item = [f64; 3]>, bits: impl Fn(f64) -> u64) -> bool {
        self.map(|point| point.map(&bits))
            .eq(other.map(|point| point.map(&bits)))
    }
}

impl<I: Iterator<Item = [f64; 3]>> Points for I {}

libfuzzer_sys::fuzz_target!(|input: Input| {
    let folder = folder().join("staging");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir(&folder).expect("a folder can be made");
    let mine = folder.join("mine");
    fs::write(&mine, MINE).expect("a file can be written");
    let paths = NAMES.map(|name| folder.join(name));
    for (there, path) in input.there.iter().zip(&paths) {
        put(*there, path, &mine);
    }

    let vertex_count = usize::from(input.vertices % 6);
    let shape = Shape {
        triangles: (input.triangles.iter().take(8))
            .map(|corners| corners.map(|corner| u32::from(corner % 6)))
            .collect(),
        faces: None,
        outlines: std::collections::BTreeMap::new(),
        vertex_count,
        frame_count: usize::from(input.announced % 4),
        precision: if input.wide {
            Precision::F64
        } else {
            Precision::F32
        },
    };
    let frames = input.frames.iter().take(4).map(|points| {
        let vertices = points.iter().take(6);
        let points: Vec<_> = vertices.map(|point| point.map(Coordinate::get)).collect();
        // Mostly as many vertices as announced.
        let missing = vertex_count.saturating_sub(points.len());
        [points, vec![[0.5, 1e-40, -0.0]; missing]].concat()
    });
    let frames: Vec<Vec<[f64; 3]>> = frames
        .map(|frame| {
            frame
                .into_iter()
                .map(|p| {
                    if input.wide {
                        p
                    } else {
                        p.map(|x| f64::from(x as f32))
                    }
                })
                .collect()
        })
        .collect();

    let (name, writes) = ARGUMENTS[usize::from(input.argument) % ARGUMENTS.len()];
    let argument = match name.split_once('+') {
        Some((mesh, positions)) => format!(
            "{}+{}",
            folder.join(mesh).display(),
            folder.join(positions).display()
        ),
        None => folder.join(name).display().to_string(),
    };
    let before = paths.each_ref().map(|path| look(path));
    let (is_whole, taken) = write(&input, &argument, &shape, &frames);
    let after = paths.each_ref().map(|path| look(path));

    assert_eq!(fs::read(&mine).expect("it is there"), MINE);
    for entry in fs::read_dir(&folder).expect("it can be listed") {
        let name = entry.expect("it can be listed").file_name();
        let name = name.to_str().expect("a plain name");
        assert!(name == "mine" || NAMES.contains(&name), "{name} was left");
    }
    // A file of one frame appears as soon as that is written. A file of several frames, or a pair
    // of files, appears when all of it is.
    let may_change = is_whole || !(name.contains('+') || name.ends_with("npz"));
    for ((name, before), after) in NAMES.iter().zip(&before).zip(&after) {
        let is_written = may_change && writes.contains(name);
        if !is_written || (before.is_some() && !input.force) {
            assert_eq!(before, after, "{name}");
        }
    }
    if is_whole && name.contains('%') {
        // One by one, since other files beside them were there before.
        for (number, frame) in taken.chunks(1).enumerate() {
            compare(&argument.replace("%d", &number.to_string()), &shape, frame);
        }
    } else if is_whole {
        compare(&argument, &shape, &taken);
    }
});
