//! Decoder of buffer views that meshoptimizer compressed:
//!
//! ```text
//! ATTRIBUTES   rows of bytes: blocks of rows, in them byte after byte of a row,
//!              in them groups of 16 differences to the row before
//! TRIANGLES    three numbers each: mostly a recent edge, and the next number or a recent one
//! INDICES      numbers: differences to one of two numbers before
//! ```
//!
//! Rows may then pass through a filter, which expands numbers to the type of the accessor. Every
//! byte is taken through [`Stream`], and all arithmetic wraps as specified. A malformed stream is
//! refused, or gives numbers that are checked like any view's. Source: appendices A and B of the
//! specifications of `EXT_meshopt_compression` and `KHR_meshopt_compression`, which has one more
//! way to write attributes. The crates meshopt-rs 0.1 and meshoptimizer-rs 0.2 have unsafe code.

use super::document::Compressed;
use crate::error::Reason;
use crate::memory::Account;
use crate::text::quoted;

/// Widest row of attributes, in bytes.
const WIDEST: usize = 256;
/// Most bytes of a block of attributes.
const BLOCK: usize = 8192;
/// Most rows of a block of attributes.
const MOST_ROWS: usize = 256;
/// Rows in a group.
const GROUP: usize = 16;

/// Fault of a stream, as the end of a message.
type Wrong = &'static str;

const CUT_SHORT: Wrong = "are cut short";
const NOT_SUCH: Wrong = "begin with another byte than their mode needs";
const TOO_MANY: Wrong = "are more than its rows need";

/// Decodes a compressed view to exactly the bytes that `compressed` announces.
///
/// They are counted in the account before they are made, and grow with the stream. Takes O(size).
pub(super) fn decode(
    stream: &[u8],
    compressed: &Compressed,
    account: &mut Account,
) -> Result<Vec<u8>, Reason> {
    let malformed = |why: &str| Reason::Malformed(format!("its compression {why}"));
    let (count, width) = (compressed.count, compressed.byte_stride);
    let bytes = count.checked_mul(width);
    account.enter(bytes.unwrap_or(u64::MAX))?;
    let (count, width) = (count as usize, width as usize);
    let filter = Filter::of(compressed.filter.as_deref().unwrap_or("NONE"), width);
    let filter = filter.map_err(|why| match why {
        Some(why) => malformed(&format!("{why}: {width}")),
        None => Reason::Unsupported(format!(
            "is compressed by meshopt with filter {}, which is not evaluated; \
             export it without compression",
            quoted(compressed.filter.as_deref().unwrap_or_default())
        )),
    })?;
    let is_plain = matches!(filter, Filter::None);
    let mut rows = Vec::new();
    let decoded = match &compressed.mode[..] {
        "ATTRIBUTES" if width == 0 || width > WIDEST || !width.is_multiple_of(4) => {
            return Err(malformed(&format!(
                "has byteStride {width}; ATTRIBUTES need a multiple of 4, from 4 to {WIDEST}"
            )));
        }
        "ATTRIBUTES" => attributes(stream, count, width, &mut rows),
        mode @ ("TRIANGLES" | "INDICES") if !is_plain => {
            return Err(malformed(&format!("has a filter; {mode} have none")));
        }
        mode @ ("TRIANGLES" | "INDICES") if ![2, 4].contains(&width) => {
            return Err(malformed(&format!(
                "has byteStride {width}; {mode} need 2 or 4"
            )));
        }
        "TRIANGLES" if !count.is_multiple_of(3) => {
            return Err(malformed(&format!(
                "has {count} corners of triangles, which is no multiple of 3"
            )));
        }
        "TRIANGLES" => triangles(stream, count / 3, width, &mut rows),
        "INDICES" => indices(stream, count, width, &mut rows),
        mode => {
            return Err(malformed(&format!(
                "has mode {}; there are ATTRIBUTES, TRIANGLES and INDICES",
                quoted(mode)
            )));
        }
    };
    decoded.map_err(|why| Reason::Malformed(format!("its compressed bytes {why}")))?;
    filter.apply(&mut rows);
    Ok(rows)
}

/// Stream of bytes that are taken from the front; an error beyond its end.
struct Stream<'a>(&'a [u8]);

impl<'a> Stream<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Wrong> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or(CUT_SHORT)?;
        self.0 = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, Wrong> {
        let (&byte, rest) = self.0.split_first().ok_or(CUT_SHORT)?;
        self.0 = rest;
        Ok(byte)
    }

    /// Takes `count` bytes from the end.
    fn tail(&mut self, count: usize) -> Result<&'a [u8], Wrong> {
        let at = self.0.len().checked_sub(count).ok_or(CUT_SHORT)?;
        let (rest, tail) = self.0.split_at(at);
        self.0 = rest;
        Ok(tail)
    }

    /// Takes a variable-length integer: 7 bits a byte, the lowest first, the top bit if more
    /// follow.
    fn number(&mut self) -> Result<u32, Wrong> {
        let mut number = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= u32::from(byte & 127) << shift;
            if byte < 128 {
                return Ok(number);
            }
        }
        Err("have a number of more than 32 bits")
    }

    fn end(&self) -> Result<(), Wrong> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(TOO_MANY)
        }
    }
}

/// Decodes a zigzag difference: 0, -1, 1, -2, ...
fn difference(number: u32) -> u32 {
    (number >> 1) ^ (number & 1).wrapping_neg()
}

/// Encoding of four bytes of a row relative to the row before.
#[derive(Clone, Copy)]
enum Channel {
    Bytes,
    Pairs,
    /// Differing bits (xor), which were rotated up by this much.
    ///
    /// The direction of the rotation is as in meshoptimizer's own decoders.
    Bits(u32),
}

impl Channel {
    fn of(byte: u8) -> Result<Self, Wrong> {
        match (byte & 15, byte >> 4) {
            (0, 0) => Ok(Self::Bytes),
            (1, 0) => Ok(Self::Pairs),
            (2, by) => Ok(Self::Bits(by.into())),
            _ => Err("name an unknown channel mode"),
        }
    }

    fn next(self, last: [u8; 4], stored: [u8; 4]) -> [u8; 4] {
        match self {
            Self::Bytes => {
                std::array::from_fn(|at| last[at].wrapping_add(difference(stored[at].into()) as u8))
            }
            Self::Pairs => {
                let pair = |four: [u8; 4], at| u16::from_le_bytes([four[at], four[at + 1]]);
                let [a, b] = [0, 2].map(|at| {
                    let change = difference(pair(stored, at).into()) as u16;
                    pair(last, at).wrapping_add(change).to_le_bytes()
                });
                [a[0], a[1], b[0], b[1]]
            }
            Self::Bits(by) => {
                let change = u32::from_le_bytes(stored).rotate_right(by);
                (u32::from_le_bytes(last) ^ change).to_le_bytes()
            }
        }
    }
}

/// Decodes rows of attributes.
fn attributes(stream: &[u8], count: usize, width: usize, rows: &mut Vec<u8>) -> Result<(), Wrong> {
    let mut stream = Stream(stream);
    let (channels, least_tail) = match stream.byte()? {
        0xa0 => (0, 32),
        0xa1 => (width / 4, 24),
        _ => return Err(NOT_SUCH),
    };
    let tail = stream.tail(width + channels)?;
    stream.tail(least_tail.max(width + channels) - width - channels)?;
    let (first, modes) = tail.split_at(width);
    let mut last = first.to_vec();
    let mut of_channels = vec![Channel::Bytes; width / 4];
    for (channel, &mode) in of_channels.iter_mut().zip(modes) {
        *channel = Channel::of(mode)?;
    }
    let most = (BLOCK / width / GROUP * GROUP).min(MOST_ROWS);
    // One byte of a row after another, each for all rows of a block.
    let mut stored = vec![0_u8; most * width];
    let mut done = 0;
    while done < count {
        let now = most.min(count - done);
        let controls = stream.take(channels)?;
        for (byte, stored) in stored.chunks_exact_mut(most).enumerate() {
            let control = controls
                .get(byte / 4)
                .map(|four| (four >> (byte % 4 * 2)) & 3);
            let bits = match control {
                None => [0, 2, 4, 8],
                Some(0) => [0, 1, 2, 4],
                Some(1) => [1, 2, 4, 8],
                Some(2) => {
                    stored.fill(0);
                    continue;
                }
                Some(_) => {
                    stored[..now].copy_from_slice(stream.take(now)?);
                    continue;
                }
            };
            let groups = now.div_ceil(GROUP);
            let heads = stream.take(groups.div_ceil(4))?;
            for (at, group) in stored.chunks_exact_mut(GROUP).take(groups).enumerate() {
                let head = (heads[at / 4] >> (at % 4 * 2)) & 3;
                read_group(&mut stream, bits[usize::from(head)], group)?;
            }
        }
        for row in 0..now {
            for (at, (last, channel)) in last.chunks_exact_mut(4).zip(&of_channels).enumerate() {
                let stored = std::array::from_fn(|byte| stored[(4 * at + byte) * most + row]);
                let next = channel.next([last[0], last[1], last[2], last[3]], stored);
                last.copy_from_slice(&next);
            }
            rows.extend_from_slice(&last);
        }
        done += now;
    }
    stream.end()
}

/// Reads a group of 16 numbers of `bits` bits each; a number with all bits set is a byte behind
/// them.
fn read_group(stream: &mut Stream<'_>, bits: u32, group: &mut [u8]) -> Result<(), Wrong> {
    match bits {
        0 => group.fill(0),
        8 => group.copy_from_slice(stream.take(GROUP)?),
        _ => {
            let packed = stream.take(2 * bits as usize)?;
            let (each, most) = (8 / bits as usize, (1 << bits) - 1);
            for (at, number) in group.iter_mut().enumerate() {
                let place = (at % each) as u32;
                // Single bits begin with the lowest, others with the highest.
                let place = if bits == 1 {
                    place
                } else {
                    each as u32 - 1 - place
                };
                let short = (packed[at / each] >> (place * bits)) & most;
                *number = if short == most { stream.byte()? } else { short };
            }
        }
    }
    Ok(())
}

/// Ring buffer of the last 16 items.
#[derive(Default)]
struct Recent<T> {
    items: [T; 16],
    count: usize,
}

impl<T: Copy> Recent<T> {
    fn push(&mut self, item: T) {
        self.items[self.count % 16] = item;
        self.count += 1;
    }

    /// The item `back` pushes before the latest.
    fn get(&self, back: u8) -> Result<T, Wrong> {
        let before = self.count.checked_sub(1 + usize::from(back));
        let before = before.ok_or("refer to an entry before the first")?;
        Ok(self.items[before % 16])
    }
}

/// Decodes triangles.
fn triangles(stream: &[u8], count: usize, width: usize, rows: &mut Vec<u8>) -> Result<(), Wrong> {
    let mut stream = Stream(stream);
    if stream.byte()? != 0xe1 {
        return Err(NOT_SUCH);
    }
    let table = stream.tail(16)?;
    let is_whole = |both: &u8| both >> 4 != 15 && both & 15 != 15;
    if table[14..] != [0; 2] || !table.iter().all(is_whole) {
        return Err("end in an invalid table of triangles");
    }
    let codes = stream.take(count)?;
    let mut numbers = Numbers {
        stream,
        next: 0,
        last: 0,
    };
    let (mut edges, mut vertices) = (Recent::<[u32; 2]>::default(), Recent::<u32>::default());
    for &code in codes {
        let (high, low) = (code >> 4, code & 15);
        if high < 15 {
            let [a, b] = edges.get(high)?;
            let c = match low {
                0 => numbers.following(),
                1..=12 => vertices.get(low)?,
                13 => numbers.beside(u32::MAX),
                14 => numbers.beside(1),
                _ => numbers.explicit()?,
            };
            if !(1..=12).contains(&low) {
                vertices.push(c);
            }
            edges.push([c, b]);
            edges.push([a, c]);
            put(rows, width, &[a, b, c])?;
            continue;
        }
        let both = if low < 14 {
            table[usize::from(low)]
        } else {
            numbers.stream.byte()?
        };
        if low >= 14 && both == 0 {
            numbers.next = 0;
        }
        let a = if low == 15 {
            numbers.explicit()?
        } else {
            numbers.following()
        };
        let others = [both >> 4, both & 15];
        let mut found = [0; 2];
        for (which, vertex) in others.into_iter().zip(&mut found) {
            *vertex = match which {
                0 => numbers.following(),
                15 => numbers.explicit()?,
                _ => vertices.get(which - 1)?,
            };
        }
        let [b, c] = found;
        vertices.push(a);
        for (which, vertex) in others.into_iter().zip(found) {
            if which == 0 || which == 15 {
                vertices.push(vertex);
            }
        }
        edges.push([b, a]);
        edges.push([c, b]);
        edges.push([a, c]);
        put(rows, width, &[a, b, c])?;
    }
    numbers.stream.end()
}

/// Source of vertices that were not used recently.
struct Numbers<'a> {
    stream: Stream<'a>,
    /// The next number that is new, as a rule.
    next: u32,
    /// The last number that was given explicitly.
    last: u32,
}

impl Numbers<'_> {
    fn following(&mut self) -> u32 {
        let next = self.next;
        self.next = next.wrapping_add(1);
        next
    }

    fn beside(&mut self, by: u32) -> u32 {
        self.last = self.last.wrapping_add(by);
        self.last
    }

    fn explicit(&mut self) -> Result<u32, Wrong> {
        let by = difference(self.stream.number()?);
        Ok(self.beside(by))
    }
}

/// Decodes a sequence of numbers.
fn indices(stream: &[u8], count: usize, width: usize, rows: &mut Vec<u8>) -> Result<(), Wrong> {
    let mut stream = Stream(stream);
    if stream.byte()? != 0xd1 {
        return Err(NOT_SUCH);
    }
    stream.tail(4)?;
    let mut last = [0_u32; 2];
    for _ in 0..count {
        let number = stream.number()?;
        let last = &mut last[(number & 1) as usize];
        *last = last.wrapping_add(difference(number >> 1));
        put(rows, width, &[*last])?;
    }
    stream.end()
}

/// Appends numbers of 2 or 4 bytes.
fn put(rows: &mut Vec<u8>, width: usize, numbers: &[u32]) -> Result<(), Wrong> {
    for number in numbers {
        if width == 2 && *number > u16::MAX.into() {
            return Err("have a number above 65535 for a row of 2 bytes");
        }
        rows.extend_from_slice(&number.to_le_bytes()[..width]);
    }
    Ok(())
}

/// A filter that expands numbers after decoding.
enum Filter {
    None,
    /// Octahedral directions, of 8 or 16 bits.
    Octahedral(usize),
    /// Rotations without their largest component.
    Quaternion,
    /// Integers with an exponent.
    Exponential,
}

impl Filter {
    /// Returns the filter of this name for rows of `width` bytes.
    ///
    /// The error says what is wrong with the width, or is None for an unknown name.
    fn of(name: &str, width: usize) -> Result<Self, Option<Wrong>> {
        let (filter, is_width) = match name {
            "NONE" => (Self::None, true),
            "OCTAHEDRAL" => (Self::Octahedral(width / 4), width == 4 || width == 8),
            "QUATERNION" => (Self::Quaternion, width == 8),
            "EXPONENTIAL" => (Self::Exponential, width.is_multiple_of(4)),
            _ => return Err(None),
        };
        if is_width {
            Ok(filter)
        } else {
            Err(Some("has a byteStride that its filter cannot have"))
        }
    }

    fn apply(&self, rows: &mut [u8]) {
        match self {
            Self::None => {}
            Self::Octahedral(1) => {
                for four in rows.as_chunks_mut::<4>().0 {
                    let [x, y, z, _] = four.map(u8::cast_signed);
                    let direction = direction([x, y, z].map(f64::from), 127.0);
                    for (byte, part) in four.iter_mut().zip(direction) {
                        *byte = (part as i8).cast_unsigned();
                    }
                }
            }
            Self::Octahedral(_) => each_of_four_shorts(rows, |[x, y, z, w]| {
                let [x, y, z] = direction([x, y, z].map(f64::from), 32767.0);
                [x as i16, y as i16, z as i16, w]
            }),
            Self::Quaternion => each_of_four_shorts(rows, rotation),
            Self::Exponential => {
                for four in rows.as_chunks_mut::<4>().0 {
                    let number = i32::from_le_bytes(*four);
                    let (exponent, mantissa) = (number >> 24, (number << 8) >> 8);
                    let power = f64::from_bits((1023 + i64::from(exponent)).cast_unsigned() << 52);
                    *four = ((f64::from(mantissa) * power) as f32).to_le_bytes();
                }
            }
        }
    }
}

fn each_of_four_shorts(rows: &mut [u8], each: impl Fn([i16; 4]) -> [i16; 4]) {
    for row in rows.as_chunks_mut::<8>().0 {
        let [a, b, c, d, e, f, g, h] = *row;
        let shorts = each([[a, b], [c, d], [e, f], [g, h]].map(i16::from_le_bytes));
        let bytes = shorts.map(i16::to_le_bytes);
        row.copy_from_slice(bytes.as_flattened());
    }
}

/// Decodes a direction to length `most`, from a point of an octahedron with corners at `one`.
fn direction([x, y, one]: [f64; 3], most: f64) -> [f64; 3] {
    let (mut x, mut y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded outwards.
    let fold = z.min(0.0);
    x -= fold.copysign(x);
    y -= fold.copysign(y);
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|part| (part / length * most).round())
}

/// Decodes a rotation from three components, divided by the square root of two.
///
/// The fourth, the largest, is positive; `which` says which one it is.
fn rotation([x, y, z, which]: [i16; 4]) -> [i16; 4] {
    let one = f64::from(which | 3);
    let [x, y, z] = [x, y, z].map(|part| f64::from(part) / one * std::f64::consts::FRAC_1_SQRT_2);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let mut parts = [w, x, y, z].map(|part| (part * 32767.0).round() as i16);
    parts.rotate_right(usize::from(which.cast_unsigned() & 3));
    parts
}

#[cfg(test)]
mod tests {
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;
    use serde_json::Value;

    use super::*;

    /// Streams with what meshoptimizer's own decoder makes of them, from
    /// `tests/three/compress.mjs`.
    fn recorded() -> Vec<(String, Vec<u8>, Compressed, Vec<u8>)> {
        let file = include_str!("../../tests/fixtures/meshopt.json");
        let cases: Vec<Value> = serde_json::from_str(file).unwrap();
        let read = |mut case: Value| {
            let bytes = |name: &str| STANDARD.decode(case[name].as_str().unwrap()).unwrap();
            let (stream, rows) = (bytes("stream"), bytes("rows"));
            let what = case["what"].as_str().unwrap().to_owned();
            case["buffer"] = 0.into();
            case["byteLength"] = stream.len().into();
            (what, stream, serde_json::from_value(case).unwrap(), rows)
        };
        cases.into_iter().map(read).collect()
    }

    fn decoded(stream: &[u8], compressed: &Compressed) -> Result<Vec<u8>, Reason> {
        decode(stream, compressed, &mut Account::new(1 << 24))
    }

    #[test]
    fn streams_are_what_meshoptimizer_has_them_be() {
        let cases = recorded();
        assert!(cases.len() > 60);
        for (what, stream, compressed, rows) in cases {
            let ours = decoded(&stream, &compressed).unwrap();
            assert_eq!(ours.len(), rows.len(), "{what}");
            // Rounding in filters may differ by one, as their specification says.
            let is_same = match (compressed.filter.as_deref(), compressed.byte_stride) {
                (Some("OCTAHEDRAL"), 4) => {
                    let mut pairs = ours.iter().zip(&rows);
                    pairs.all(|(a, b)| a.cast_signed().abs_diff(b.cast_signed()) <= 1)
                }
                (Some("OCTAHEDRAL" | "QUATERNION"), _) => {
                    let shorts = |bytes: &[u8]| -> Vec<i16> {
                        let pairs = bytes.as_chunks::<2>().0;
                        pairs.iter().map(|&pair| i16::from_le_bytes(pair)).collect()
                    };
                    let (ours, theirs) = (shorts(&ours), shorts(&rows));
                    let mut pairs = ours.iter().zip(&theirs);
                    pairs.all(|(a, b)| a.abs_diff(*b) <= 1)
                }
                _ => ours == rows,
            };
            assert!(is_same, "{what}");
        }
    }

    #[test]
    fn spoilt_streams_are_refused_or_numbers() {
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as usize % below
        };
        let mut refused = 0;
        for (what, stream, compressed, rows) in recorded() {
            let same = |stream: &[u8]| decoded(stream, &compressed).is_ok_and(|ours| ours == rows);
            let step = stream.len() / 60 + 1;
            for length in (0..stream.len()).step_by(step) {
                assert!(
                    !same(&stream[..length]) || rows.is_empty(),
                    "{what}: {length}"
                );
                assert!(!same(&stream[length + 1..]) || rows.is_empty(), "{what}");
            }
            let longer = [&stream[..], &stream].concat();
            assert!(
                decoded(&longer, &compressed).is_err() || rows.is_empty(),
                "{what}"
            );
            for _ in 0..100 {
                let mut spoilt = stream.clone();
                for _ in 0..=random(3) {
                    spoilt[random(stream.len())] = random(256) as u8;
                }
                match decoded(&spoilt, &compressed) {
                    Ok(ours) => assert_eq!(ours.len(), rows.len()),
                    Err(_) => refused += 1,
                }
            }
        }
        assert!(refused > 1000, "{refused}");
    }

    #[test]
    fn what_no_stream_can_be_is_said() {
        let said = |mode: &str, filter: &str, count: u64, width: u64, stream: &[u8]| {
            let compressed = Compressed {
                buffer: 0,
                byte_offset: 0,
                byte_length: stream.len() as u64,
                byte_stride: width,
                count,
                mode: mode.into(),
                filter: Some(filter.into()),
            };
            decoded(stream, &compressed).unwrap_err().to_string()
        };
        for (mode, filter, count, width, words) in [
            ("ATTRIBUTES", "NONE", 1, 0, "byteStride 0; ATTRIBUTES need"),
            ("ATTRIBUTES", "NONE", 1, 6, "byteStride 6; ATTRIBUTES need"),
            ("ATTRIBUTES", "NONE", 1, 260, "byteStride 260; ATTRIBUTES"),
            ("ATTRIBUTES", "QUATERNION", 1, 12, "filter cannot have: 12"),
            (
                "ATTRIBUTES",
                "COLOR",
                1,
                4,
                "with filter \"COLOR\", which is not evaluated",
            ),
            ("ATTRIBUTES", "NONE", 1, 4, "begin with another byte"),
            (
                "TRIANGLES",
                "NONE",
                3,
                8,
                "byteStride 8; TRIANGLES need 2 or 4",
            ),
            (
                "TRIANGLES",
                "EXPONENTIAL",
                3,
                4,
                "a filter; TRIANGLES have none",
            ),
            (
                "TRIANGLES",
                "NONE",
                4,
                4,
                "4 corners of triangles, which is no",
            ),
            ("TRIANGLES", "NONE", 3, 4, "begin with another byte"),
            ("INDICES", "NONE", 3, 2, "begin with another byte"),
            (
                "POINTS",
                "NONE",
                3,
                2,
                "has mode \"POINTS\"; there are ATTRIBUTES",
            ),
            ("ATTRIBUTES", "NONE", 1 << 40, 256, "of memory"),
            ("ATTRIBUTES", "NONE", u64::MAX, 256, "of memory"),
        ] {
            let said = said(mode, filter, count, width, &[7; 100]);
            assert!(said.contains(words), "{words}: {said}");
        }
        // A triangle on an edge before the first, and a number that does not end.
        let first = [&[0xe1, 0x00][..], &[0; 16]].concat();
        assert!(said("TRIANGLES", "NONE", 3, 4, &first).contains("before the first"));
        let endless = [&[0xd1][..], &[0xff; 9], &[0; 4]].concat();
        assert!(said("INDICES", "NONE", 1, 4, &endless).contains("more than 32 bits"));
    }
}
