//! One array as a stream: of an archive, with its checksum, or a file of its own.
//!
//! A reader keeps its place from frame to frame. The sizes in the directory are claims like any other: what is read ends where
//! the data ends.

use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Take};

use flate2::Crc;
use flate2::bufread::DeflateDecoder;

use super::directory::{self, Method};
use crate::error::Reason;
use crate::file::{Found, Opened};

/// The data of one array, `Read` up to its announced size.
pub(super) struct Entry {
    pub(super) name: &'static str,
    data: Data,
    /// Bytes that the directory still announces.
    left: u64,
    checksum: u32,
    read: Crc,
    /// Some of the data was passed over, and its checksum cannot be known.
    skipped: bool,
}

enum Data {
    Stored(Take<BufReader<Opened>>),
    Deflated(DeflateDecoder<Take<BufReader<Opened>>>),
}

/// As many bytes does one of a deflated stream stand for, at most.
const MOST_DEFLATED: u64 = 1032;

impl Entry {
    /// Opens the array of the first of these names of the archive `file`, or the one that has another of them.
    pub(super) fn open(file: &Found, names: &[&'static str]) -> Result<Self, Reason> {
        let mut input = BufReader::new(file.open()?);
        let (name, record) = directory::find(&mut input, names)?;
        let length = input.get_ref().length();
        // What cannot be there is not looked for to the end.
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

    /// Opens a file that is one array.
    pub(super) fn whole(file: &Found, name: &'static str) -> Result<Self, Reason> {
        let input = BufReader::with_capacity(1 << 16, file.open()?);
        let left = input.get_ref().length();
        Ok(Self {
            name,
            data: Data::Stored(input.take(left)),
            left,
            checksum: 0,
            read: Crc::new(),
            // It has no checksum.
            skipped: true,
        })
    }

    /// Refuses a file that is not as it was found.
    pub(super) fn unchanged(&self) -> Result<(), Reason> {
        let input = match &self.data {
            Data::Stored(input) => input,
            Data::Deflated(input) => input.get_ref(),
        };
        input.get_ref().get_ref().unchanged()
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

    /// Passes over so many bytes: without reading them, unless they are deflated.
    pub(super) fn skip(&mut self, bytes: u64) -> Result<(), Reason> {
        let ends = || Reason::Truncated("the data ends before the frame asked for".into());
        if bytes > self.left {
            return Err(ends());
        }
        match &mut self.data {
            Data::Stored(input) => {
                // Both below: no file is longer than i64::MAX.
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

    /// Makes sure that the data ends here and is what was written.
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
