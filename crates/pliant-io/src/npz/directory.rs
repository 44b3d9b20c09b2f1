//! Central directory of a zip archive: offset, length and compression of each entry.
//!
//! ```text
//! entries, each with a local header    PK\3\4 ...
//! directory, one record an entry       PK\1\2 ...
//! for counts beyond 16 or 32 bits      PK\6\6 end of the directory, PK\6\7 its offset
//! end                                  PK\5\6 number and offset of the records, comment
//! ```
//!
//! The crate has its own reader because zip 9.4.1 keeps every record. It reserves as many as the
//! end claims, limited only by the length of the file. A sparse file of 8 GiB, 8 kB on disk, made
//! it ask for 26 GB and ended the program. Here records are passed over one by one, and only the
//! wanted one is kept.

use std::collections::BTreeMap;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

use crate::error::Reason;
use crate::text::quoted;

/// Most names listed where an array is missing.
const NAMES_LISTED: usize = 8;

/// Size in bytes of the end record without its comment.
const END: u64 = 22;
/// Size in bytes of the longest comment.
const LONGEST_COMMENT: u64 = u16::MAX as u64;

/// Bit of a record's flags that marks an encrypted entry.
const ENCRYPTED: u16 = 1;

/// Location and encoding of an entry's data. All numbers are claims.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Record {
    /// Offset of the data in the archive, in bytes.
    pub(super) start: u64,
    /// Compressed and uncompressed size, in bytes.
    pub(super) compressed: u64,
    pub(super) size: u64,
    pub(super) checksum: u32,
    pub(super) method: Method,
}

/// Compression method of an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    Stored,
    Deflated,
}

/// Finds the array with the first of the names `wanted`, or the only one with another of them.
///
/// Takes O(number of entries) time and O(1) memory.
pub(super) fn find<R: Read + Seek>(
    archive: &mut BufReader<R>,
    wanted: &[&'static str],
) -> Result<(&'static str, Record), Reason> {
    let (records, directory) = end(archive)?;
    archive.seek(SeekFrom::Start(directory))?;
    let mut found: BTreeMap<usize, ([u8; 46], Vec<u8>)> = BTreeMap::new();
    let mut names = Vec::new();
    let mut words = Vec::new();
    for _ in 0..records {
        let fixed: [u8; 46] = bytes(archive)?;
        if !fixed.starts_with(b"PK\x01\x02") {
            return Err(damaged("a record of its directory has a wrong signature"));
        }
        let [name_length, extra_length, comment] =
            [28, 30, 32].map(|at| usize::from(short(&fixed, at)));
        words.resize(name_length + extra_length, 0);
        archive.read_exact(&mut words).map_err(cut)?;
        archive.seek_relative(comment as i64)?;
        let (its_name, extra) = words.split_at(name_length);
        let array = its_name.strip_suffix(b".npy");
        let place = wanted.iter().position(|it| array == Some(it.as_bytes()));
        if let Some(place) = place
            && found.insert(place, (fixed, extra.to_vec())).is_some()
        {
            let name = wanted[place];
            return Err(damaged(&format!("the array `{name}` is in it twice")));
        }
        if place != Some(0) && names.len() < NAMES_LISTED {
            let array = array.unwrap_or(its_name);
            names.push(quoted(array).trim_matches('"').to_owned());
        }
    }
    let is_clear = found.contains_key(&0) || found.len() == 1;
    let first = found.into_iter().next().filter(|_| is_clear);
    let (place, (fixed, extra)) = first.ok_or_else(|| missing(wanted[0], &names))?;
    let record = record(archive, wanted[place], &fixed, &extra)?;
    Ok((wanted[place], record))
}

/// Reads the end record: number of records, and offset of the first.
fn end<R: Read + Seek>(archive: &mut BufReader<R>) -> Result<(u64, u64), Reason> {
    let length = archive.seek(SeekFrom::End(0))?;
    let from = length.saturating_sub(END + LONGEST_COMMENT);
    archive.seek(SeekFrom::Start(from))?;
    let mut tail = Vec::new();
    archive.take(length - from).read_to_end(&mut tail)?;
    // The last signature with room for the comment that it claims.
    let places = 0..(tail.len() + 1).saturating_sub(END as usize);
    let at = places.rev().find(|&at| {
        let fixed = &tail[at..];
        fixed.starts_with(b"PK\x05\x06")
            && END as usize + usize::from(short(fixed, 20)) <= fixed.len()
    });
    let at = at.ok_or_else(|| damaged("it has no directory at its end; it may be cut short"))?;
    let fixed = &tail[at..];
    let (records, directory) = (short(fixed, 10), long(fixed, 16));
    if records != u16::MAX && directory != u32::MAX {
        return Ok((records.into(), directory.into()));
    }
    let Some(locator) = at.checked_sub(20).map(|at| &tail[at..]) else {
        return Ok((records.into(), directory.into()));
    };
    if !locator.starts_with(b"PK\x06\x07") {
        return Ok((records.into(), directory.into()));
    }
    archive.seek(SeekFrom::Start(longest(locator, 8)))?;
    let fixed: [u8; 56] = bytes(archive)?;
    if !fixed.starts_with(b"PK\x06\x06") {
        return Err(damaged(
            "the end of its directory is not where it should be",
        ));
    }
    Ok((longest(&fixed, 32), longest(&fixed, 48)))
}

/// Parses a record of the directory, and reads the local header to find the data.
fn record<R: Read + Seek>(
    archive: &mut BufReader<R>,
    name: &str,
    fixed: &[u8; 46],
    extra: &[u8],
) -> Result<Record, Reason> {
    if short(fixed, 8) & ENCRYPTED != 0 {
        return Err(Reason::Unsupported(format!(
            "`{name}` is encrypted; save it without"
        )));
    }
    let method = match short(fixed, 10) {
        0 => Method::Stored,
        8 => Method::Deflated,
        other => {
            return Err(Reason::Unsupported(format!(
                "`{name}` is compressed by method {other}; \
                 save it with numpy.savez or numpy.savez_compressed"
            )));
        }
    };
    // Numbers beyond 32 bits follow, in this order, in the extra field of kind 1.
    let mut wide = wide_numbers(extra).chunks_exact(8);
    let [size, compressed, header] = [24, 20, 42].map(|at| match long(fixed, at) {
        u32::MAX => wide
            .next()
            .map_or(u32::MAX.into(), |number| longest(number, 0)),
        number => number.into(),
    });
    archive.seek(SeekFrom::Start(header))?;
    let local: [u8; 30] = bytes(archive)?;
    if !local.starts_with(b"PK\x03\x04") {
        return Err(damaged(&format!("the data of `{name}` cannot be found")));
    }
    let start = header + 30 + u64::from(short(&local, 26)) + u64::from(short(&local, 28));
    Ok(Record {
        start,
        compressed,
        size,
        checksum: long(fixed, 16),
        method,
    })
}

/// Contents of the extra field of kind 1 (zip64); empty where there is none.
fn wide_numbers(mut extra: &[u8]) -> &[u8] {
    while extra.len() >= 4 {
        let (kind, length) = (short(extra, 0), usize::from(short(extra, 2)));
        let rest = &extra[4..];
        let length = length.min(rest.len());
        if kind == 1 {
            return &rest[..length];
        }
        extra = &rest[length..];
    }
    &[]
}

fn bytes<const N: usize>(archive: &mut impl Read) -> Result<[u8; N], Reason> {
    let mut bytes = [0; N];
    archive.read_exact(&mut bytes).map_err(cut)?;
    Ok(bytes)
}

fn cut(error: io::Error) -> Reason {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => damaged("its directory goes beyond its end"),
        _ => error.into(),
    }
}

fn damaged(why: &str) -> Reason {
    Reason::Malformed(format!("not an NPZ file (a zip archive of arrays): {why}"))
}

fn missing(name: &str, names: &[String]) -> Reason {
    let names = names.join(", ");
    Reason::Malformed(format!(
        "has no array `{name}`; save it as numpy.savez(file, vertices=..., faces=...); \
         it holds: {names}"
    ))
}

/// Reads the little-endian 16-bit integer at offset `at`.
fn short(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([bytes[at], bytes[at + 1]])
}

/// Reads the little-endian 32-bit integer at offset `at`.
fn long(bytes: &[u8], at: usize) -> u32 {
    u32::from(short(bytes, at)) | u32::from(short(bytes, at + 2)) << 16
}

/// Reads the little-endian 64-bit integer at offset `at`.
fn longest(bytes: &[u8], at: usize) -> u64 {
    u64::from(long(bytes, at)) | u64::from(long(bytes, at + 4)) << 32
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Cursor, Write};
    use zip::write::SimpleFileOptions;
    use zip::{CompressionMethod, ZipWriter};

    const DATA: &[u8] = b"seven words that hardly compress at all";

    fn found(archive: &[u8], name: &'static str) -> Result<Record, Reason> {
        find(&mut BufReader::new(Cursor::new(archive)), &[name]).map(|(_, record)| record)
    }

    /// An archive of these arrays; `large`: with 64-bit numbers, as numpy writes it.
    fn archive(method: CompressionMethod, large: bool, names: &[&str]) -> Vec<u8> {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        archive
            .set_comment("PK\x05\x06 is not the end, whatever it says")
            .unwrap();
        for name in names {
            let options = SimpleFileOptions::default()
                .compression_method(method)
                .large_file(large);
            archive.start_file(format!("{name}.npy"), options).unwrap();
            archive.write_all(DATA).unwrap();
        }
        archive.finish().unwrap().into_inner()
    }

    #[test]
    fn entries_are_found_wherever_they_are() {
        for large in [false, true] {
            let file = archive(CompressionMethod::Stored, large, &["one", "two", "three"]);
            for name in ["one", "two", "three"] {
                let record = found(&file, name).unwrap();
                assert_eq!(
                    (record.method, record.size),
                    (Method::Stored, DATA.len() as u64)
                );
                assert_eq!(
                    &file[record.start as usize..][..record.compressed as usize],
                    DATA
                );
            }
        }
        let file = archive(CompressionMethod::DEFLATE, false, &["one"]);
        let record = found(&file, "one").unwrap();
        assert_eq!(
            (record.method, record.size),
            (Method::Deflated, DATA.len() as u64)
        );
    }

    /// An archive with all numbers in 64 bits, which claims `records` and an offset of the
    /// directory.
    fn wide(records: u64, claimed: impl Fn(u64) -> u64) -> Vec<u8> {
        let narrow = archive(CompressionMethod::Stored, false, &["one"]);
        let directory = narrow.windows(4).rposition(|w| w == b"PK\x01\x02").unwrap();
        let name = 46 + "one.npy".len();
        let mut file = narrow[..directory + name].to_vec();
        // Sizes and offset move to an extra field, behind another one.
        let extra = [
            &[9, 9, 2, 0, 7, 7, 1, 0, 24, 0][..],
            &(DATA.len() as u64).to_le_bytes(),
            &(DATA.len() as u64).to_le_bytes(),
            &0_u64.to_le_bytes(),
        ]
        .concat();
        for at in [20, 24, 42] {
            file[directory + at..][..4].fill(0xff);
        }
        file[directory + 30..][..2].copy_from_slice(&(extra.len() as u16).to_le_bytes());
        file.extend(extra);
        let end = file.len() as u64;
        file.extend([&b"PK\x06\x06"[..], &44_u64.to_le_bytes(), &[0; 12]].concat());
        for number in [
            records,
            records,
            end - directory as u64,
            claimed(directory as u64),
        ] {
            file.extend(number.to_le_bytes());
        }
        file.extend(
            [
                &b"PK\x06\x07\0\0\0\0"[..],
                &end.to_le_bytes(),
                &[1, 0, 0, 0],
            ]
            .concat(),
        );
        file.extend([&b"PK\x05\x06\0\0\0\0"[..], &[0xff; 12], &[0, 0]].concat());
        file
    }

    #[test]
    fn numbers_of_64_bits() {
        let file = wide(1, |directory| directory);
        let record = found(&file, "one").unwrap();
        assert_eq!(
            &file[record.start as usize..][..record.compressed as usize],
            DATA
        );
    }

    #[test]
    fn claims_are_found_out() {
        for file in [
            wide(u64::MAX, |directory| directory),
            wide(2, |directory| directory),
            wide(1, |directory| directory + 1),
            wide(1, |_| u64::MAX),
            wide(1, |_| i64::MAX as u64),
        ] {
            assert!(found(&file, "one").is_err());
        }
        assert!(found(&wide(0, |directory| directory), "one").is_err());
    }

    #[test]
    fn whatever_is_cut_or_changed_ends_in_an_answer() {
        for file in [
            archive(CompressionMethod::Stored, true, &["one", "two"]),
            wide(1, |directory| directory),
        ] {
            for end in 0..file.len() {
                assert!(found(&file[..end], "none").is_err());
                for bits in [1, 0x80, 0xff] {
                    let mut changed = file.clone();
                    changed[end] ^= bits;
                    let _ = found(&changed, "one");
                }
            }
        }
    }

    #[test]
    fn one_name_twice_is_refused() {
        let mut file = archive(CompressionMethod::Stored, false, &["one", "two"]);
        let at = file
            .windows(7)
            .rposition(|window| window == b"two.npy")
            .unwrap();
        file[at..at + 3].copy_from_slice(b"one");
        let message = found(&file, "one").unwrap_err().to_string();
        assert!(
            message.ends_with("the array `one` is in it twice"),
            "{message}"
        );
    }
}
