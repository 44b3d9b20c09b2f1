//! Fuzzes NPZ: any bytes as a file, and any bytes as the arrays of an intact one.
//!
//! Input that begins like an archive (`PK`) is the file. Otherwise an archive of `vertices.npy` and
//! `faces.npy` is made, so that a fuzzer need not guess a checksum. The first byte says whether the
//! arrays are deflated (odd). The next two are the length of the first array, and the rest are both
//! arrays.
#![no_main]

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

libfuzzer_sys::fuzz_target!(|input: &[u8]| match *input {
    [b'P', b'K', ..] => pliant_fuzz::read_as("npz", input),
    [kind, low, high, ref arrays @ ..] => {
        let first = usize::from(u16::from_le_bytes([low, high])).min(arrays.len());
        let (vertices, faces) = arrays.split_at(first);
        pliant_fuzz::read_as("npz", &archive(kind % 2 == 1, vertices, faces));
    }
    _ => {}
});

fn archive(deflated: bool, vertices: &[u8], faces: &[u8]) -> Vec<u8> {
    let method = if deflated {
        CompressionMethod::DEFLATE
    } else {
        CompressionMethod::Stored
    };
    let options = SimpleFileOptions::default().compression_method(method);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, array) in [("vertices.npy", vertices), ("faces.npy", faces)] {
        let written = archive
            .start_file(name, options)
            .and_then(|()| Ok(archive.write_all(array)?));
        written.expect("memory can be written");
    }
    archive
        .finish()
        .expect("memory can be written")
        .into_inner()
}
