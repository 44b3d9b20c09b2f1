//! Bytes of glTF buffers and views: in the GLB behind the JSON, in files beside it, or in the JSON.
//!
//! Bytes in files stay there and are read when an accessor needs them; data URIs are decoded once.
//! No other place is ever read: no network, no folder above, no target of a link outside the
//! folder. A compressed view is decoded once, and only if its buffer has no uncompressed bytes,
//! which are equal.

use std::collections::BTreeMap;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::document::{Compressed, Document, memory};
use super::meshopt;
use crate::error::{Fault, Place, Reason};
use crate::file::{Found, Opened};
use crate::files::Files;
use crate::memory::{Account, bytes_of};
use crate::text::quoted;

/// An open file and its buffers.
pub(super) struct Buffers {
    main: Opened,
    files: Files,
    folder: PathBuf,
    /// Offset and length of the binary chunk behind the JSON.
    behind: Option<(u64, u64)>,
    opened: Vec<Option<Bytes>>,
    /// Decoded bytes of compressed views, by number; counted in the account.
    decoded: BTreeMap<usize, Vec<u8>>,
}

/// Location of the bytes of a buffer.
enum Bytes {
    Behind,
    Beside(PathBuf, Opened),
    Within(Vec<u8>),
}

/// First bytes of a GLB file.
const GLB: &[u8; 4] = b"glTF";
/// Size in bytes of the GLB header: magic, version and length.
const HEAD: u64 = 12;
/// Size in bytes of a chunk's header: length and kind.
const CHUNK: u64 = 8;
/// A chunk's header, for messages.
const CHUNK_HEADER: &str = "the header of a chunk";

/// Compressed bytes read at a time: memory grows with data that exists, not with its claim.
const AT_A_TIME: u64 = 1 << 16;

/// Opens a file and parses its JSON, if the account allows both the text and the parsed document.
pub(super) fn open(
    found: &Found,
    files: &Files,
    account: &mut Account,
) -> Result<(Document, Buffers), Fault> {
    let mut main = found.open()?;
    let length = main.length();
    let mut start = [0; 4];
    let filled = Read::by_ref(&mut main).take(4).read(&mut start)?;
    let (json, behind) = if filled == 4 && start == *GLB {
        chunks(&mut main, length)?
    } else {
        ((0, length), None)
    };
    account.check(json.1.saturating_mul(2))?;
    main.seek(SeekFrom::Start(json.0))?;
    let mut text = Vec::new();
    Read::by_ref(&mut main)
        .take(json.1)
        .read_to_end(&mut text)?;
    main.unchanged()?;
    account.enter(memory(&text))?;
    let document = Document::parse(&text)?;
    let folder = found.path().parent().unwrap_or(Path::new("")).to_owned();
    let opened = document.buffers.iter().map(|_| None).collect();
    let buffers = Buffers {
        main,
        files: files.clone(),
        folder,
        behind,
        opened,
        decoded: BTreeMap::new(),
    };
    Ok((document, buffers))
}

/// Offset and length of the two chunks of a GLB file: JSON, and binary if there is one.
fn chunks(main: &mut Opened, length: u64) -> Result<((u64, u64), Option<(u64, u64)>), Fault> {
    let mut number = |what: &str, at: u64| -> Result<u64, Fault> {
        let mut bytes = [0; 4];
        main.seek(SeekFrom::Start(at))?;
        main.read_exact(&mut bytes)
            .map_err(|_| Reason::Truncated(format!("{what} is missing")).at(Place::Byte(at)))?;
        Ok(u32::from_le_bytes(bytes).into())
    };
    let version = number("the version in the GLB header", 4)?;
    if version != 2 {
        let reason =
            format!("is GLB of version {version}; only version 2 can be read, so convert it");
        return Err(Reason::Unsupported(reason).into());
    }
    let announced = number("the length in the GLB header", 8)?;
    if announced > length {
        let reason = format!("the file announces {announced} bytes, and has {length}");
        return Err(Reason::Truncated(reason).at(Place::Byte(8)));
    }
    let mut chunk = |at: u64, kind: &[u8; 4]| -> Result<Option<(u64, u64)>, Fault> {
        if at + CHUNK > announced {
            return Ok(None);
        }
        let (size, found) = (number(CHUNK_HEADER, at)?, number(CHUNK_HEADER, at + 4)?);
        if found != u64::from(u32::from_le_bytes(*kind)) {
            return Ok(None);
        }
        if at + CHUNK + size > announced {
            let reason = format!("a chunk of {size} bytes goes beyond the {announced} announced");
            return Err(Reason::Truncated(reason).at(Place::Byte(at)));
        }
        Ok(Some((at + CHUNK, size)))
    };
    let json = chunk(HEAD, b"JSON")?.ok_or_else(|| {
        Reason::Malformed("the first chunk is not JSON".into()).at(Place::Byte(HEAD))
    })?;
    // Chunks begin at multiples of four, but some writers put them right behind each other.
    let end = json.0 + json.1;
    let behind = match chunk(end, b"BIN\0")? {
        None if !end.is_multiple_of(4) => chunk(end.next_multiple_of(4), b"BIN\0")?,
        behind => behind,
    };
    Ok((json, behind))
}

impl Buffers {
    /// Fills `bytes` from a view, from `offset` on.
    pub(super) fn read_view(
        &mut self,
        document: &Document,
        number: usize,
        offset: u64,
        bytes: &mut [u8],
        account: &mut Account,
    ) -> Result<(), Fault> {
        let Some(view) = document.buffer_views.get(number) else {
            return Err(Reason::Malformed(format!("there is no buffer view {number}")).into());
        };
        let has_bytes = |buffer: usize| {
            let has_uri = document
                .buffers
                .get(buffer)
                .is_some_and(|it| it.uri.is_some());
            has_uri || (buffer == 0 && self.behind.is_some())
        };
        let Some(compressed) = view.compressed().filter(|_| !has_bytes(view.buffer)) else {
            let offset = view.byte_offset.saturating_add(offset);
            return self.read(document, view.buffer, offset, bytes, account);
        };
        if !self.decoded.contains_key(&number) {
            let at = |fault: Fault| fault.or_at(Place::Part("buffer view", number));
            let decoded = self.decode(document, view.byte_length, compressed, account);
            self.decoded.insert(number, decoded.map_err(at)?);
        }
        let decoded = self.decoded.get(&number).map_or(&[][..], |all| all);
        let there = decoded
            .get(offset as usize..)
            .and_then(|rest| rest.get(..bytes.len()));
        let there = there.ok_or_else(|| {
            let has = decoded.len();
            let needed = bytes.len();
            Reason::Truncated(format!(
                "{needed} bytes from byte {offset} on are needed of buffer view {number}, \
                 but it has {has}"
            ))
        })?;
        bytes.copy_from_slice(there);
        Ok(())
    }

    /// Decodes a compressed view, which must have `length` bytes.
    fn decode(
        &mut self,
        document: &Document,
        length: u64,
        compressed: &Compressed,
        account: &mut Account,
    ) -> Result<Vec<u8>, Fault> {
        let (count, width) = (compressed.count, compressed.byte_stride);
        if count.checked_mul(width) != Some(length) {
            let reason =
                format!("its compression has {count} rows of {width} bytes, it has {length} bytes");
            return Err(Reason::Malformed(reason).into());
        }
        // The announced bytes may not exist.
        let mut stream = Vec::new();
        while (stream.len() as u64) < compressed.byte_length {
            let done = stream.len();
            let now = (compressed.byte_length - done as u64).min(AT_A_TIME);
            account.enter(now)?;
            stream.resize(done + now as usize, 0);
            let from = compressed.byte_offset.saturating_add(done as u64);
            self.read(
                document,
                compressed.buffer,
                from,
                &mut stream[done..],
                account,
            )?;
        }
        let decoded = meshopt::decode(&stream, compressed, account)?;
        account.take_off(bytes_of(&stream));
        Ok(decoded)
    }

    /// Drops decoded views once reading is done, and takes them off the account.
    pub(super) fn forget_decoded(&mut self, account: &mut Account) {
        for (_, decoded) in std::mem::take(&mut self.decoded) {
            account.take_off(bytes_of(&decoded));
        }
    }

    /// Fills `bytes` from a buffer, from `offset` on.
    pub(super) fn read(
        &mut self,
        document: &Document,
        buffer: usize,
        offset: u64,
        bytes: &mut [u8],
        account: &mut Account,
    ) -> Result<(), Fault> {
        let at = |reason: Reason| reason.at(Place::Part("buffer", buffer));
        let Some(entry) = document.buffers.get(buffer) else {
            return Err(at(Reason::Malformed("there is no such buffer".into())));
        };
        let needed = bytes.len() as u64;
        let end = offset.saturating_add(needed);
        let beyond = |has: u64| {
            at(Reason::Truncated(format!(
                "{needed} bytes from byte {offset} on are needed, but it has {has}"
            )))
        };
        if end > entry.byte_length {
            return Err(beyond(entry.byte_length));
        }
        if self.opened[buffer].is_none() {
            let opened = self.find(entry.uri.as_deref(), buffer, account);
            self.opened[buffer] =
                Some(opened.map_err(|fault| fault.or_at(Place::Part("buffer", buffer)))?);
        }
        match &mut self.opened[buffer] {
            Some(Bytes::Within(within)) => {
                let range = offset as usize..end as usize;
                let there = within
                    .get(range)
                    .ok_or_else(|| beyond(within.len() as u64))?;
                bytes.copy_from_slice(there);
            }
            Some(Bytes::Beside(path, file)) => {
                let has = file.length();
                if end > has {
                    return Err(beyond(has).or_in(path));
                }
                fill(file, offset, bytes).map_err(|reason| at(reason).or_in(path))?;
            }
            Some(Bytes::Behind) | None => {
                let (start, has) = self.behind.unwrap_or_default();
                if end > has {
                    return Err(beyond(has));
                }
                fill(&mut self.main, start + offset, bytes).map_err(at)?;
            }
        }
        Ok(())
    }

    /// Locates and opens the bytes of a buffer.
    fn find(
        &self,
        uri: Option<&str>,
        buffer: usize,
        account: &mut Account,
    ) -> Result<Bytes, Fault> {
        let Some(uri) = uri else {
            if buffer == 0 && self.behind.is_some() {
                return Ok(Bytes::Behind);
            }
            return Err(
                Reason::Malformed("has neither a URI nor bytes behind the JSON".into()).into(),
            );
        };
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((kind, text)) = data.split_once(',') else {
                return Err(Reason::Malformed("its data URI has no comma".into()).into());
            };
            if !kind.ends_with(";base64") {
                return Err(Reason::Unsupported(
                    "its data URI is not base64; export the file as .glb".into(),
                )
                .into());
            }
            account.enter(text.len() as u64)?;
            let bytes = STANDARD.decode(text).map_err(|error| {
                let error = error.to_string();
                let why = error.trim_end_matches('.');
                Reason::Malformed(format!("its data URI is not valid base64: {why}"))
            })?;
            return Ok(Bytes::Within(bytes));
        }
        let name = unescaped(uri);
        let path = Path::new(&name);
        let plain = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if name.is_empty() || name.contains([':', '\\', '\0']) || !path.components().all(plain) {
            return Err(Reason::Unsupported(format!(
                "its bytes are at {}; \
                 only files beside this one, and data URIs, are read: export it as .glb",
                quoted(uri)
            ))
            .into());
        }
        let path = self.folder.join(path);
        let found = self.files.find_below(&self.folder, path.clone());
        let opened = found.and_then(|found| found.open());
        let opened = opened.map_err(|reason| Fault::from(reason).or_in(&path))?;
        Ok(Bytes::Beside(path, opened))
    }

    /// Total size in bytes of the files opened and the views decoded so far.
    pub(super) fn bytes(&self) -> u64 {
        let of_buffer = |bytes: &Bytes| match bytes {
            Bytes::Behind => 0, // in the file itself
            Bytes::Beside(_, file) => file.length(),
            Bytes::Within(bytes) => bytes.len() as u64,
        };
        let of_buffers = self.opened.iter().flatten().map(of_buffer);
        let of_views = self.decoded.values().map(|decoded| bytes_of(decoded));
        let all = of_buffers.chain(of_views);
        all.fold(self.main.length(), u64::saturating_add)
    }

    /// Returns an error if any file has changed since it was found.
    pub(super) fn unchanged(&self) -> Result<(), Fault> {
        self.main.unchanged()?;
        for bytes in self.opened.iter().flatten() {
            if let Bytes::Beside(path, file) = bytes {
                file.unchanged()
                    .map_err(|reason| Fault::from(reason).or_in(path))?;
            }
        }
        Ok(())
    }
}

/// Fills `bytes` from a file, from `offset` on.
fn fill(file: &mut Opened, offset: u64, bytes: &mut [u8]) -> Result<(), Reason> {
    file.seek(SeekFrom::Start(offset))?;
    Ok(file.read_exact(bytes)?)
}

/// Decodes percent escapes such as `%20`.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        let escaped = match (first, after) {
            (b'%', [high, low, ..]) => {
                let digit = |c: u8| char::from(c).to_digit(16);
                digit(*high)
                    .zip(digit(*low))
                    .map(|(high, low)| (16 * high + low) as u8)
            }
            _ => None,
        };
        bytes.push(escaped.unwrap_or(*first));
        rest = if escaped.is_some() {
            &after[2..]
        } else {
            after
        };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
