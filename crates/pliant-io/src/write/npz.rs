//! NPZ writer: `vertices` (T, n, 3) as frames come, then `faces` (m, 3).
//!
//! Arrays are not deflated, so that a reader can skip frames.

use std::io::{self, Write};
use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::coordinates::widened;
use super::shape::Shape;
use super::staged::StagedFile;
use crate::error::{Error, Reason};
use crate::positions::{Positions, Precision};

/// An archive being written.
pub(super) struct Npz {
    archive: ZipWriter<StagedFile>,
    path: std::path::PathBuf,
    precision: Precision,
    /// Reused buffer: a frame as the file has it.
    bytes: Vec<u8>,
}

impl Npz {
    pub(super) fn create(path: &Path, shape: &Shape) -> Result<Self, Error> {
        let mut npz = Self {
            archive: ZipWriter::new(StagedFile::create(path)?),
            path: path.to_owned(),
            precision: shape.precision,
            bytes: Vec::new(),
        };
        let dtype = match shape.precision {
            Precision::F32 => "<f4",
            Precision::F64 => "<f8",
        };
        let frame = (shape.vertex_count as u64).saturating_mul(shape.precision.bytes());
        let size = frame.saturating_mul(shape.frame_count as u64);
        let dimensions = format!("{}, {}, 3", shape.frame_count, shape.vertex_count);
        npz.begin("vertices", dtype, &dimensions, size)?;
        Ok(npz)
    }

    /// Begins an array of `size` bytes.
    fn begin(&mut self, name: &str, dtype: &str, shape: &str, size: u64) -> Result<(), Error> {
        // Sizes beyond 32 bits need the large format; 4096 bytes are allowed for the header.
        let large = size > u64::from(u32::MAX) - 4096;
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(large);
        let begun = self.archive.start_file(format!("{name}.npy"), options);
        self.written(begun.map_err(io::Error::from))?;
        let mut header =
            format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': ({shape}), }}");
        // Pads the header to a multiple of 64 bytes, its preamble and the line break included.
        let padding = 63 - (header.len() + 10) % 64;
        header.extend(std::iter::repeat_n(' ', padding));
        header.push('\n');
        let length = (header.len() as u16).to_le_bytes();
        let start = [b"\x93NUMPY\x01\0", &length[..], header.as_bytes()].concat();
        let written = self.archive.write_all(&start);
        self.written(written)
    }

    fn written<T>(&self, result: io::Result<T>) -> Result<T, Error> {
        result.map_err(|error| Error::new(&self.path, Reason::Write(error)))
    }

    pub(super) fn frame(&mut self, positions: Positions<'_>) -> Result<(), Error> {
        self.bytes.clear();
        for position in widened(positions) {
            for x in position {
                match self.precision {
                    Precision::F32 => self.bytes.extend((x as f32).to_le_bytes()),
                    Precision::F64 => self.bytes.extend(x.to_le_bytes()),
                }
            }
        }
        let written = self.archive.write_all(&self.bytes);
        self.written(written)
    }

    pub(super) fn finish(mut self, shape: &Shape) -> Result<StagedFile, Error> {
        let size = size_of_val(&shape.triangles[..]) as u64;
        self.begin(
            "faces",
            "<u4",
            &format!("{}, 3", shape.triangles.len()),
            size,
        )?;
        for corners in &shape.triangles {
            let bytes = corners.map(u32::to_le_bytes);
            let written = self.archive.write_all(bytes.as_flattened());
            self.written(written)?;
        }
        let path = self.path;
        let finished = self.archive.finish();
        finished.map_err(|error| Error::new(path, Reason::Write(error.into())))
    }
}
