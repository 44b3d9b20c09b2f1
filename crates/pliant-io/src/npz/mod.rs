//! NPZ: `vertices` (T, n, 3) or (n, 3), `faces` (m, 3): a whole sequence in one file, or, by
//! pattern, several files whose frames follow one another.
//!
//! Frame by frame from the compressed stream; never more than one frame unpacked. Little and big
//! endian alike. The end of the data and its checksum are verified before the last frame is handed
//! out: whoever stops earlier, or passes over frames of an array that is not deflated, has read unverified data.

mod directory;
mod entry;
mod header;

use crate::error::{Fault, Place, Reason};
use crate::file::Found;
use crate::format::FrameSource;
use crate::frame::{Announced, Complete, Frame};
use crate::positions::Precision;
use entry::Entry;
use header::{Dtype, Header};

/// A reader of one NPZ file.
pub(crate) struct Npz {
    file: Found,
    vertices: Entry,
    dtype: Dtype,
    frames: u64,
    /// Vertices of a frame.
    count: u64,
    next: u64,
    /// Reused: some rows of an array, as they are in the file.
    chunk: Vec<u8>,
}

/// Rows read at a time.
const ROWS: u64 = 4096;

impl Npz {
    pub(crate) fn open(file: &Found) -> Result<Self, Fault> {
        let in_array = |reason: Reason| reason.at(Place::Array("vertices"));
        let mut vertices = Entry::open(file, "vertices")?;
        let header = Header::read(&mut vertices).map_err(in_array)?;
        let (frames, count) = match header.shape[..] {
            [frames, count, 3] => (frames, count),
            [count, 3] => (1, count),
            _ => {
                return Err(in_array(wrong_shape(
                    &header.shape,
                    "(frames, vertices, 3) or (vertices, 3)",
                )));
            }
        };
        if !matches!((header.dtype.kind, header.dtype.size), ('f', 4 | 8)) {
            let written = &header.dtype.written;
            let advice = format!(
                "type {written} cannot be read; save vertices.astype(np.float32), or float64"
            );
            return Err(in_array(Reason::Unsupported(advice)));
        }
        if header.fortran_order {
            return Err(in_array(column_by_column("vertices")));
        }
        if frames == 0 {
            return Err(in_array(Reason::NoFrames));
        }
        if count == 0 {
            return Err(in_array(Reason::NoVertices));
        }
        check_size(frames, count, header.dtype.size as u64, vertices.left())?;
        Ok(Self {
            file: file.clone(),
            vertices,
            dtype: header.dtype,
            frames,
            count,
            next: 0,
            chunk: Vec::new(),
        })
    }

    fn read_vertices(&mut self, frame: &mut Frame) -> Result<(), Fault> {
        let (big_endian, size) = (self.dtype.big_endian, self.dtype.size);
        let number = move |bytes: &[u8]| real(bytes, big_endian);
        let place = Place::Frame(self.next);
        rows(
            &mut self.vertices,
            &mut self.chunk,
            self.count,
            size,
            |_, row| {
                let [x, y, z] = [0, 1, 2].map(|axis| number(&row[axis * size..][..size]));
                frame.vertex([x, y, z])
            },
        )
        .map_err(|reason| reason.at(place))
    }

    /// Begins the first frame, once it is known how large it is, and reads its faces.
    fn begin_with_faces(&mut self, frame: &mut Frame) -> Result<(), Fault> {
        let in_array = |reason: Reason| reason.at(Place::Array("faces"));
        let mut faces = Entry::open(&self.file, "faces").map_err(in_array)?;
        let header = Header::read(&mut faces).map_err(in_array)?;
        let &[count, 3] = &header.shape[..] else {
            return Err(in_array(wrong_shape(&header.shape, "(triangles, 3)")));
        };
        let dtype = header.dtype;
        if !matches!((dtype.kind, dtype.size), ('i' | 'u', 1 | 2 | 4 | 8)) {
            let written = &dtype.written;
            return Err(in_array(Reason::Unsupported(format!(
                "type {written} cannot be read; save faces.astype(np.uint32)"
            ))));
        }
        if header.fortran_order {
            return Err(in_array(column_by_column("faces")));
        }
        self.begin(frame, count)?;
        let read = rows(
            &mut faces,
            &mut self.chunk,
            count,
            dtype.size,
            |face, row| {
                let mut corners = [0; 3];
                for (corner, bytes) in corners.iter_mut().zip(row.chunks_exact(dtype.size)) {
                    let index = integer(bytes, &dtype);
                    let (first, last) = (0, i64::from(u32::MAX) - 1);
                    let in_range = u32::try_from(index).ok().filter(|&index| index < u32::MAX);
                    *corner = in_range.ok_or(Reason::VertexIndex {
                        face,
                        index,
                        first,
                        last,
                    })?;
                }
                frame.face(&corners, || Place::Array("faces"))
            },
        );
        read.and_then(|()| faces.finish()).map_err(in_array)
    }

    /// Begins the next frame; `faces` is how many the first announces.
    fn begin(&self, frame: &mut Frame, faces: u64) -> Result<(), Fault> {
        let precision = if self.dtype.size == 4 {
            Precision::F32
        } else {
            Precision::F64
        };
        let announced = Announced {
            vertices: self.count,
            faces,
        };
        let begun = frame.begin(precision, announced);
        begun.map_err(|reason| reason.at(Place::Frame(self.next)))
    }

    fn read_frame(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let place = Place::Frame(self.next);
        if self.next == 0 {
            self.begin_with_faces(frame)?;
        } else {
            self.begin(frame, 0)?;
            frame.same_faces();
        }
        self.read_vertices(frame)?;
        self.next += 1;
        if self.next == self.frames {
            self.vertices.finish()?;
        }
        frame.complete(0).map_err(|fault| fault.or_at(place))
    }
}

impl FrameSource for Npz {
    fn frame_count(&self) -> usize {
        usize::try_from(self.frames).unwrap_or(usize::MAX)
    }

    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let read = self.read_frame(frame);
        // First: what looks wrong may be half of a change.
        self.vertices.unchanged()?;
        read
    }

    fn skip(&mut self, frames: usize) -> Result<(), Fault> {
        let frames = frames as u64;
        let bytes = frames.saturating_mul(self.count.saturating_mul(3 * self.dtype.size as u64));
        let skipped = self.vertices.skip(bytes);
        // First: what looks wrong may be half of a change.
        self.vertices.unchanged()?;
        skipped.map_err(|reason| reason.at(Place::Frame(self.next)))?;
        self.next += frames;
        Ok(())
    }
}

/// Holds the shape against the size in the directory, so that a file cut short is refused before
/// its first frame, not after its last.
fn check_size(frames: u64, count: u64, size: u64, announced: u64) -> Result<(), Fault> {
    let frame = count.checked_mul(3 * size);
    let all = frame.and_then(|frame| frame.checked_mul(frames));
    let needed = all.map_or("more than 2^64".into(), |all| all.to_string());
    let message = format!("the shape needs {needed} bytes, the file announces {announced}");
    if all.is_none_or(|all| all > announced) {
        let whole = frame.map_or(0, |frame| announced / frame);
        return Err(Reason::Truncated(message).at(Place::Frame(whole)));
    }
    if all.is_some_and(|all| all < announced) {
        return Err(Reason::Malformed(message).at(Place::Array("vertices")));
    }
    Ok(())
}

/// Reads `count` rows of three numbers of `size` bytes and hands them out one by one.
fn rows(
    entry: &mut Entry,
    chunk: &mut Vec<u8>,
    count: u64,
    size: usize,
    mut each: impl FnMut(u64, &[u8]) -> Result<(), Reason>,
) -> Result<(), Reason> {
    let row = 3 * size;
    let mut done = 0;
    while done < count {
        let now = ROWS.min(count - done);
        chunk.resize(now as usize * row, 0);
        let read = entry.fill(chunk)?;
        for bytes in chunk[..read].chunks_exact(row) {
            each(done, bytes)?;
            done += 1;
        }
        if read < chunk.len() {
            return Err(Reason::Truncated(format!(
                "the data ends in row {done} of {count}"
            )));
        }
    }
    Ok(())
}

/// The float that 4 or 8 bytes write.
fn real(bytes: &[u8], big_endian: bool) -> f64 {
    match (bytes, big_endian) {
        (&[a, b, c, d], false) => f32::from_le_bytes([a, b, c, d]).into(),
        (&[a, b, c, d], true) => f32::from_be_bytes([a, b, c, d]).into(),
        (&[a, b, c, d, e, f, g, h], false) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        (&[a, b, c, d, e, f, g, h], true) => f64::from_be_bytes([a, b, c, d, e, f, g, h]),
        _ => f64::NAN, // no float has another size; refused like any other number that is none
    }
}

/// The whole number that up to 8 bytes write; unsigned ones beyond `i64::MAX` become `i64::MAX`,
/// out of range all the same.
fn integer(bytes: &[u8], dtype: &Dtype) -> i64 {
    let negative = |most_significant: u8| dtype.kind == 'i' && most_significant >= 0x80;
    let most_significant = if dtype.big_endian {
        bytes.first()
    } else {
        bytes.last()
    };
    let filler = if most_significant.is_some_and(|&byte| negative(byte)) {
        0xff
    } else {
        0
    };
    let mut wide = [filler; 8];
    for (to, from) in wide.iter_mut().zip(0..bytes.len()) {
        *to = if dtype.big_endian {
            bytes[bytes.len() - 1 - from]
        } else {
            bytes[from]
        };
    }
    match dtype.kind {
        'i' => i64::from_le_bytes(wide),
        _ => i64::try_from(u64::from_le_bytes(wide)).unwrap_or(i64::MAX),
    }
}

fn wrong_shape(shape: &[u64], wanted: &str) -> Reason {
    let mut written = format!("{shape:?}");
    written.truncate(60);
    Reason::Unsupported(format!("has shape {written}; it must be {wanted}"))
}

fn column_by_column(array: &str) -> Reason {
    Reason::Unsupported(format!(
        "is in Fortran order; save np.ascontiguousarray({array})"
    ))
}
