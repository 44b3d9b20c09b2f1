//! Folders, files and arrays for the tests.
#![allow(dead_code)] // every test file uses some of it

use std::io::{Cursor, Write};
use std::path::Path;

use pliant_io::{Body, Error, Files, OpenOptions, Positions};
use tempfile::TempDir;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// A temporary folder, removed when dropped.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.0.path().join(name), contents).unwrap();
        self
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    /// The argument that names `name` in this folder.
    pub(crate) fn argument(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }

    /// Opens a body from disk, after all of it was found to be the same from memory.
    pub(crate) fn open(&self, name: &str) -> Result<Body, Error> {
        let argument = self.argument(name);
        if let Some(files) = self.in_memory() {
            let options = OpenOptions {
                files,
                ..OpenOptions::default()
            };
            let [memory, disk] = [options, OpenOptions::default()].map(|options| {
                let mut body = pliant_io::open(&argument, &options)?;
                let first = format!("{:?} {:?}", body.triangles(), body.notes());
                Ok((first, all_frames(&mut body)?))
            });
            assert_eq!(
                format!("{memory:?}"),
                format!("{:?}", disk as Result<_, Error>)
            );
        }
        pliant_io::open(&argument, &OpenOptions::default())
    }

    /// The files of the folder under their full names.
    ///
    /// None if it has what memory does not: links, pipes, empty folders.
    pub(crate) fn in_memory(&self) -> Option<Files> {
        let mut files = Vec::new();
        let mut folders = vec![self.0.path().to_owned()];
        while let Some(folder) = folders.pop() {
            let is_root = folder == self.0.path();
            let mut entries = std::fs::read_dir(folder).unwrap().peekable();
            if entries.peek().is_none() && !is_root {
                return None;
            }
            for entry in entries {
                let entry = entry.unwrap();
                let kind = entry.file_type().unwrap();
                match () {
                    () if kind.is_dir() => folders.push(entry.path()),
                    () if kind.is_file() => {
                        files.push((entry.path(), std::fs::read(entry.path()).ok()?));
                    }
                    () => return None,
                }
            }
        }
        Some(Files::in_memory(files).unwrap())
    }

    /// The error when a body is opened or read, without the folder's name.
    pub(crate) fn error(&self, name: &str) -> String {
        let error = self
            .open(name)
            .and_then(|mut body| all_frames(&mut body))
            .unwrap_err();
        let folder = format!("{}{}", self.0.path().display(), std::path::MAIN_SEPARATOR);
        error.to_string().replace(&folder, "")
    }
}

/// The remaining frames, widened to f64.
pub(crate) fn all_frames(body: &mut Body) -> Result<Vec<Vec<[f64; 3]>>, Error> {
    let mut frames = Vec::new();
    while let Some(positions) = body.next_frame()? {
        frames.push(match positions {
            Positions::F32(positions) => positions.iter().map(|p| p.map(f64::from)).collect(),
            Positions::F64(positions) => positions.to_vec(),
        });
    }
    Ok(frames)
}

/// An array as numpy saves it.
pub(crate) fn npy(dtype: &str, fortran_order: bool, shape: &[u64], data: &[u8]) -> Vec<u8> {
    let order = if fortran_order { "True" } else { "False" };
    let shape = shape.iter().fold(String::new(), |shape, length| {
        shape + &length.to_string() + ", "
    });
    let mut header =
        format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': ({shape}), }}");
    while (header.len() + 11) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), data].concat()
}

/// An archive of arrays as numpy saves it.
pub(crate) fn npz(method: CompressionMethod, arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, array) in arrays {
        let options = SimpleFileOptions::default().compression_method(method);
        archive.start_file(format!("{name}.npy"), options).unwrap();
        archive.write_all(array).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

/// The bytes of numbers in an array.
pub(crate) fn bytes<const N: usize, T: Copy>(
    numbers: &[T],
    each: impl Fn(T) -> [u8; N],
) -> Vec<u8> {
    numbers.iter().flat_map(|&number| each(number)).collect()
}

/// A tetrahedron with its top at `height`, as OBJ.
pub(crate) fn tetrahedron(height: f64) -> String {
    format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 {height}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
}
