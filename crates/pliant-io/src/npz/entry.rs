//! One array of an archive as a stream, with its checksum.
//!
//! The `zip` crate reads the directory; its stream borrows the archive, so a reader that keeps its
//! place from frame to frame takes over from where the data begins. The sizes in the directory are
//! claims like any other: what is read ends where the data ends.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Take};
use std::path::Path;

use flate2::Crc;
use flate2::bufread::DeflateDecoder;
use zip::{CompressionMethod, ZipArchive};

use crate::error::Reason;

/// At most so many names are listed where an array is missing.
const NAMES_LISTED: usize = 8;

/// The data of one array, `Read` up to its announced size.
pub(super) struct Entry {
    name: &'static str,
    data: Data,
    /// Bytes that the directory still announces.
    left: u64,
    checksum: u32,
    read: Crc,
}

enum Data {
    Stored(Take<BufReader<File>>),
    Deflated(DeflateDecoder<Take<BufReader<File>>>),
}

impl Entry {
    /// Opens the array `name` of the archive at `path`.
    pub(super) fn open(path: &Path, name: &'static str) -> Result<Self, Reason> {
        let mut archive = ZipArchive::new(BufReader::new(File::open(path)?)).map_err(|error| {
            Reason::Malformed(format!(
                "not an NPZ file (a zip archive of arrays): {error}"
            ))
        })?;
        let index = archive
            .index_for_name(&format!("{name}.npy"))
            .ok_or_else(|| missing(&archive, name))?;
        let damaged =
            |error| Reason::Malformed(format!("the entry of `{name}` cannot be found: {error}"));
        let entry = archive.by_index_raw(index).map_err(damaged)?;
        if entry.encrypted() {
            return Err(Reason::Unsupported(format!(
                "`{name}` is encrypted; save it without"
            )));
        }
        let (method, start) = (entry.compression(), entry.data_start());
        let (left, compressed, checksum) = (entry.size(), entry.compressed_size(), entry.crc32());
        drop(entry);

        let start = start
            .ok_or_else(|| Reason::Malformed(format!("the data of `{name}` cannot be found")))?;
        let mut input = archive.into_inner();
        input.seek(SeekFrom::Start(start))?;
        let input = input.take(compressed);
        let data = match method {
            CompressionMethod::Stored => Data::Stored(input),
            CompressionMethod::DEFLATE => Data::Deflated(DeflateDecoder::new(input)),
            other => {
                let advice = format!(
                    "`{name}` is compressed as {other}; save it with numpy.savez or numpy.savez_compressed"
                );
                return Err(Reason::Unsupported(advice));
            }
        };
        let read = Crc::new();
        Ok(Self {
            name,
            data,
            left,
            checksum,
            read,
        })
    }

    /// Bytes that, by the directory, are still to come.
    pub(super) fn left(&self) -> u64 {
        self.left
    }

    /// Reads until `buffer` is full or the data ends; returns how much.
    pub(super) fn fill(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let mut filled = 0;
        while filled < buffer.len() {
            match self.read(&mut buffer[filled..]) {
                Ok(0) => break,
                Ok(read) => filled += read,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(filled)
    }

    /// Makes sure that the data ends here and is what was written.
    pub(super) fn finish(&mut self) -> Result<(), Reason> {
        let array = self.name;
        let more = match &mut self.data {
            Data::Stored(input) => !input.fill_buf()?.is_empty(),
            Data::Deflated(input) => input.read(&mut [0])? > 0,
        };
        if more || self.left > 0 || self.read.sum() != self.checksum {
            return Err(Reason::Checksum { array });
        }
        Ok(())
    }
}

impl Read for Entry {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let most = usize::try_from(self.left).map_or(buffer.len(), |left| left.min(buffer.len()));
        let buffer = &mut buffer[..most];
        if buffer.is_empty() {
            return Ok(0);
        }
        let read = match &mut self.data {
            Data::Stored(input) => input.read(buffer)?,
            Data::Deflated(input) => input.read(buffer)?,
        };
        self.read.update(&buffer[..read]);
        self.left -= read as u64;
        Ok(read)
    }
}

fn missing<R: Read + Seek>(archive: &ZipArchive<R>, name: &str) -> Reason {
    let names = archive.file_names_raw().take(NAMES_LISTED);
    let names: Vec<String> = names
        .map(|name| {
            String::from_utf8_lossy(name.strip_suffix(b".npy").unwrap_or(name)).into_owned()
        })
        .collect();
    Reason::Malformed(format!(
        "has no array `{name}`; save it as numpy.savez(file, vertices=..., faces=...); it holds: {}",
        names.join(", ")
    ))
}
