//! NPZ archives with false claims about the place, length, encoding or names of their arrays.
//!
//! Each gives frames or an error of one line.

use crate::common::{Folder, all_frames, bytes, npy, npz};
use zip::CompressionMethod;

const STORED: CompressionMethod = CompressionMethod::Stored;
const DEFLATED: CompressionMethod = CompressionMethod::DEFLATE;

fn valid(method: CompressionMethod) -> Vec<u8> {
    let positions: Vec<f32> = (0..24).map(|x| x as f32).collect();
    let faces = bytes(&[0_u32, 1, 2, 3, 2, 1], u32::to_le_bytes);
    let vertices = npy(
        "<f4",
        false,
        &[2, 4, 3],
        &bytes(&positions, f32::to_le_bytes),
    );
    npz(
        method,
        &[
            ("vertices", vertices),
            ("faces", npy("<u4", false, &[2, 3], &faces)),
        ],
    )
}

/// Offsets of the records of the directory, and of its end.
fn places(file: &[u8]) -> ([usize; 2], usize) {
    let all = |mark: &[u8]| -> Vec<usize> {
        let windows = file.windows(4).enumerate();
        windows
            .filter(|(_, it)| *it == mark)
            .map(|(at, _)| at)
            .collect()
    };
    let records = all(b"PK\x01\x02");
    (
        [records[0], records[1]],
        *all(b"PK\x05\x06").last().unwrap(),
    )
}

fn put(file: &mut [u8], at: usize, number: u32) {
    file[at..at + 4].copy_from_slice(&number.to_le_bytes());
}

fn get(file: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(file[at..at + 4].try_into().unwrap())
}

/// A change to an archive, given the records of `vertices` and `faces`, and the end.
type Lie = fn(&mut Vec<u8>, [usize; 2], usize);

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn archives_that_lie() {
    // In a record: flags at 8, method 10, checksum 16, compressed size 20, size 24, length of the
    // name 28, offset 42, name 46.
    let lies: &[(&str, CompressionMethod, Lie, &str)] = &[
        (
            "both arrays are the same bytes",
            STORED,
            |file, [vertices, faces], _| {
                for field in [16, 20, 24, 42] {
                    let number = get(file, vertices + field);
                    put(file, faces + field, number);
                }
            },
            "array `faces`: ",
        ),
        (
            "vertices are where the faces are",
            DEFLATED,
            |file, [vertices, faces], _| {
                let number = get(file, faces + 42);
                put(file, vertices + 42, number);
            },
            "array `vertices`: ",
        ),
        (
            "vertices begin inside the faces' bytes",
            STORED,
            |file, [vertices, faces], _| {
                let number = get(file, faces + 42) + 9;
                put(file, vertices + 42, number);
            },
            "the data of `vertices` cannot be found",
        ),
        (
            "an array is in the directory",
            STORED,
            |file, [vertices, _], _| put(file, vertices + 42, vertices as u32),
            "the data of `vertices` cannot be found",
        ),
        (
            "an array is beyond the end",
            STORED,
            |file, [vertices, _], _| put(file, vertices + 42, 0xffff_fff0),
            "goes beyond its end",
        ),
        (
            "a place of 64 bits that is nowhere",
            STORED,
            |file, [vertices, _], _| put(file, vertices + 42, u32::MAX),
            "goes beyond its end",
        ),
        (
            "the data begins behind a name of 64 kB",
            STORED,
            |file, [vertices, _], _| {
                let header = get(file, vertices + 42) as usize;
                file[header + 26..header + 28].fill(0xff);
            },
            "array `vertices`: ",
        ),
        (
            "stored, but shorter than it is",
            STORED,
            |file, [vertices, _], _| {
                let number = get(file, vertices + 20) - 50;
                put(file, vertices + 20, number);
            },
            "ends too early",
        ),
        (
            "stored, but longer than it is",
            STORED,
            |file, [vertices, _], _| put(file, vertices + 20, 0x7fff_ffff),
            "",
        ),
        (
            "unpacked, four gigabytes",
            DEFLATED,
            |file, [vertices, _], _| put(file, vertices + 24, 0xffff_fffe),
            "announces 4294967294 bytes, more than",
        ),
        (
            "unpacked, nothing",
            DEFLATED,
            |file, [vertices, _], _| put(file, vertices + 24, 0),
            "array `vertices`: ",
        ),
        (
            "stored bytes, called deflated",
            STORED,
            |file, [vertices, _], _| file[vertices + 10] = 8,
            "array `vertices`: ",
        ),
        (
            "deflated bytes, called stored",
            DEFLATED,
            |file, [vertices, _], _| file[vertices + 10] = 0,
            "array `vertices`: ",
        ),
        (
            "written in a way that nobody knows",
            STORED,
            |file, [_, faces], _| file[faces + 10] = 99,
            "`faces` is compressed by method 99",
        ),
        (
            "encrypted",
            STORED,
            |file, [vertices, _], _| file[vertices + 8] |= 1,
            "`vertices` is encrypted",
        ),
        (
            "another checksum",
            DEFLATED,
            |file, [vertices, _], _| file[vertices + 16] ^= 1,
            "does not match its checksum",
        ),
        (
            "more records than there are",
            STORED,
            |file, _, end| file[end + 10..end + 12].copy_from_slice(&0xfffe_u16.to_le_bytes()),
            "not an NPZ file",
        ),
        (
            "fewer records than there are",
            STORED,
            |file, _, end| file[end + 10..end + 12].copy_from_slice(&1_u16.to_le_bytes()),
            "has no array `faces`",
        ),
        (
            "no records",
            STORED,
            |file, _, end| file[end + 10..end + 12].fill(0),
            "has no array `vertices`",
        ),
        (
            "a directory where the data is",
            STORED,
            |file, _, end| put(file, end + 16, 0),
            "a record of its directory has a wrong signature",
        ),
        (
            "a directory that is the end of itself",
            STORED,
            |file, _, end| put(file, end + 16, end as u32),
            "not an NPZ file",
        ),
        (
            "a directory beyond the end",
            STORED,
            |file, _, end| put(file, end + 16, 0x7fff_ffff),
            "goes beyond its end",
        ),
        (
            "something before the archive, of which it knows nothing",
            STORED,
            |file, _, _| drop(file.splice(0..0, *b"#!/bin/sh\n")),
            "not an NPZ file",
        ),
        (
            "a name with a folder above",
            STORED,
            |file, [vertices, _], _| file[vertices + 46..vertices + 49].copy_from_slice(b"../"),
            "has no array `vertices`",
        ),
        (
            "a name with a line break and more",
            STORED,
            |file, [vertices, _], _| {
                file[vertices + 46..vertices + 49].copy_from_slice(b"\n\x1b\0");
            },
            "has no array `vertices`",
        ),
        (
            "a name longer than the directory",
            STORED,
            |file, [_, faces], _| file[faces + 28..faces + 30].fill(0xff),
            "goes beyond its end",
        ),
        (
            "a comment longer than the directory",
            STORED,
            |file, [vertices, _], _| file[vertices + 32..vertices + 34].fill(0xff),
            "goes beyond its end",
        ),
        (
            "a name of two arrays",
            STORED,
            |file, [vertices, faces], _| {
                file[faces + 46..faces + 55].copy_from_slice(b"faces.npy");
                let record = file[faces..faces + 55].to_vec();
                // One record twice replaces both.
                file.splice(vertices..faces + 55, [&record[..], &record].concat());
            },
            "has no array `vertices`",
        ),
    ];
    let folder = Folder::new();
    let mut wrong = Vec::new();
    for (what, method, lie, words) in lies {
        let mut file = valid(*method);
        folder.write("a.npz", &file);
        assert!(all_frames(&mut folder.open("a.npz").unwrap()).is_ok());
        let (records, end) = places(&file);
        lie(&mut file, records, end);
        folder.write("a.npz", &file);
        let read = folder
            .open("a.npz")
            .and_then(|mut body| all_frames(&mut body));
        let said = match read {
            // The false claim makes no difference.
            Ok(frames) => {
                let is_right = frames.len() == 2 && frames[1][3] == [21.0, 22.0, 23.0];
                let right = if is_right && words.is_empty() {
                    ""
                } else {
                    "frames"
                };
                right.to_owned()
            }
            Err(error) => error.to_string(),
        };
        let named = words.is_empty() || said.starts_with(&folder.argument("a.npz"));
        if !(named && said.contains(words) && said.lines().count() <= 1 && !said.contains('\x1b')) {
            wrong.push(format!("{what}: {words:?} is not in: {said}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
