//! Stream of one array: an entry of an archive, with its checksum, or an NPY file.
//!
//! The stream keeps its position from frame to frame. The sizes in the directory are only claims:
//! reading stops where the data ends.

use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Take};

use flate2::Crc;
use flate2::bufread::DeflateDecoder;

use super::directory::{self, Method};
use crate::error::Reason;
use crate::file::{Found, Opened};

/// Data of one array, with `Read` up to its announced size.
pub(super) struct Entry {
    pub(super) name: &'static str,
    data: Data,
    /// Bytes still to come, as the directory announces.
    left: u64,
    checksum: u32,
    read: Crc,
    /// Whether data was skipped, or there is no checksum to compare.
    skipped: bool,
}

enum Data {
    Stored(Take<BufReader<Opened>>),
    Deflated(DeflateDecoder<Take<BufReader<Opened>>>),
}

/// Most bytes that one byte of a deflated stream can stand for.
const MOST_DEFLATED: u64 = 1032;

impl Entry {
    /// Opens the array with the first of these names in the archive `file`, or with another of
    /// them.
    pub(super) fn open(file: &Found, names: &[&'static str]) -> Result<Self, Reason> {
        let mut input = BufReader::new(file.open()?);
        let (name, record) = directory::find(&mut input, names)?;
        let length = input.get_ref().length();
        // A size that the file cannot hold is refused before reading to its end.
        let end = record.start.saturating_add(record.compressed);
        let most = match record.method {
            Method::Stored => record.compressed,
            Method::Deflated => record.compressed.saturating_mul(MOST_DEFLATED),
        };
        if end > length || record.size > most {
            let there = record.compressed.min(length.saturating_sub(record.start));
            let size = record.size;
            return Err(Reason::Truncated(format!(
                "`{name}` announces {size} bytes, more than {there} bytes of the file can hold"
            )));
        }
        input.seek(SeekFrom::Start(record.start))?;
        let input = input.take(record.compressed);
        Ok(Self {
            name,
            data: match record.method {
                Method::Stored => Data::Stored(input),
                Method::Deflated => Data::Deflated(DeflateDecoder::new(input)),
            },
            left: record.size,
            checksum: record.checksum,
            read: Crc::new(),
            skipped: false,
        })
    }

    /// Opens an NPY file as one array.
    pub(super) fn whole(file: &Found, name: &'static str) -> Result<Self, Reason> {
        let input = BufReader::with_capacity(1 << 16, file.open()?);
        let left = input.get_ref().length();
        Ok(Self {
            name,
            data: Data::Stored(input.take(left)),
            left,
            checksum: 0,
            read: Crc::new(),
            // An NPY file has no checksum.
            skipped: true,
        })
    }

    /// Returns an error if the file has changed since it was found.
    pub(super) fn unchanged(&self) -> Result<(), Reason> {
        let input = match &self.data {
            Data::Stored(input) => input,
            Data::Deflated(input) => input.get_ref(),
        };
        input.get_ref().get_ref().unchanged()
    }

    /// Bytes still to come, as the directory announces.
    pub(super) fn left(&self) -> u64 {
        self.left
    }

    /// Reads until `buffer` is full or the data ends; returns the number of bytes read.
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

    /// Skips `bytes` bytes: by seeking, or by inflating where they are deflated.
    pub(super) fn skip(&mut self, bytes: u64) -> Result<(), Reason> {
        let ends = || Reason::Truncated("the data ends before the frame asked for".into());
        if bytes > self.left {
            return Err(ends());
        }
        match &mut self.data {
            Data::Stored(input) => {
                // Neither fails for a real file, which is at most i64::MAX bytes long.
                let limit = input.limit().checked_sub(bytes).ok_or_else(ends)?;
                let forward = i64::try_from(bytes).map_err(|_| ends())?;
                input.get_mut().seek_relative(forward)?;
                input.set_limit(limit);
                self.left -= bytes;
                self.skipped |= bytes > 0;
            }
            Data::Deflated(_) => {
                if io::copy(&mut self.by_ref().take(bytes), &mut io::sink())? < bytes {
                    return Err(ends());
                }
            }
        }
        Ok(())
    }

    /// Checks that the data ends here and matches its checksum.
    pub(super) fn finish(&mut self) -> Result<(), Reason> {
        let array = self.name;
        let more = match &mut self.data {
            Data::Stored(input) => !input.fill_buf()?.is_empty(),
            Data::Deflated(input) => input.read(&mut [0])? > 0,
        };
        let other = !self.skipped && self.read.sum() != self.checksum;
        if more || self.left > 0 || other {
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
