//! NPZ and NPY reader: arrays of numpy, a whole sequence in one file.
//!
//! An archive has `vertices` (T, n, 3) or (n, 3), and `faces` (m, 3); a pattern joins several into
//! one body. An NPY file is `vertices` alone, beside a mesh. Frames are read one by one from the
//! compressed stream, in either byte order; at most one is unpacked at a time.
//!
//! - Unusual arrays are read where their meaning is clear, and noted: other names, Fortran order
//!   (held in memory as a whole), half precision, integers.
//! - The end of the data and its checksum are verified before the last frame is returned. Data are
//!   unverified if a caller stops earlier, or skips frames of an array that is not deflated.

mod directory;
mod entry;
mod header;

use crate::error::{Fault, Place, Reason};
use crate::file::Found;
use crate::frame::{Announced, Complete, Frame};
use crate::memory::Account;
use crate::moved_mesh::MovedMesh;
use crate::note::Note;
use crate::positions::Precision;
use crate::size::Size;
use crate::source::FrameSource;
use crate::text::two_coordinates;
use entry::Entry;
use header::{Dtype, Header};
use std::io::Read as _;

/// Accepted names of the array of positions; the first is the usual one.
const VERTICES: [&str; 3] = ["vertices", "verts", "v"];
/// Accepted names of the array of triangles; the first is the usual one.
const FACES: [&str; 2] = ["faces", "f"];

/// Reads an NPY file of integers, shape (n,). `max_memory`: limit of what they take, in bytes.
pub(crate) fn integers(file: &Found, max_memory: u64) -> Result<Vec<i64>, Fault> {
    let mut array = Entry::whole(file, "integers")?;
    let header = Header::read(&mut array)?;
    let &[count] = &header.shape[..] else {
        return Err(wrong_shape(&header.shape, "(n,)").into());
    };
    let dtype = header.dtype;
    if !matches!((dtype.kind, dtype.size), ('i' | 'u', 1 | 2 | 4 | 8)) {
        let written = &dtype.written;
        let advice = format!("type {written} cannot be read; save integers");
        return Err(Reason::Unsupported(advice).into());
    }
    let (bytes, there) = (count.saturating_mul(dtype.size as u64), array.left());
    if there != bytes {
        let message = format!("{count} numbers need {bytes} bytes, and {there} are there");
        let reason = if there < bytes {
            Reason::Truncated
        } else {
            Reason::Malformed
        };
        return Err(reason(message).into());
    }
    Account::new(max_memory).enter(there.saturating_add(count.saturating_mul(8)))?;
    let all = whole(&mut array);
    // Before the reader's own error: a change while reading is the likelier cause of it.
    array.unchanged()?;
    let all = all?;
    let numbers = all.chunks_exact(dtype.size);
    Ok(numbers.map(|bytes| integer(bytes, &dtype)).collect())
}

/// Reader of an NPZ file, or of an NPY file of positions beside a mesh.
pub(crate) struct Npz {
    file: Found,
    vertices: Entry,
    dtype: Dtype,
    frames: u64,
    /// Number of vertices of a frame.
    count: u64,
    next: u64,
    /// Reused buffer: rows of an array as the file has them.
    chunk: Vec<u8>,
    /// All bytes of an array in Fortran order (column by column), once it was read.
    columns: Option<Vec<u8>>,
    is_by_columns: bool,
    /// The mesh that an NPY file moves, until it is read.
    mesh: Option<MovedMesh>,
    is_npy: bool,
    notes: Vec<Note>,
}

/// Rows read at a time: few calls, with a buffer of at most 96 KiB (f64).
const ROWS: u64 = 4096;

impl Npz {
    /// Opens an archive. `max_memory`: limit in bytes for an array that must be held as a whole.
    pub(crate) fn open(file: &Found, max_memory: u64) -> Result<Self, Fault> {
        let in_array = |reason: Reason| reason.at(Place::Array("vertices"));
        let mut vertices = Entry::open(file, &VERTICES).map_err(|reason| match reason {
            Reason::Truncated(_) => in_array(reason),
            _ => reason.into(),
        })?;
        let header = Header::read(&mut vertices).map_err(in_array)?;
        let begun = Self::begin_array(file, vertices, header, max_memory);
        begun.map_err(|fault| fault.or_at(Place::Array("vertices")))
    }

    /// Opens an NPY file of positions that move `mesh`, which is one frame.
    pub(crate) fn beside(mesh: MovedMesh, file: &Found, max_memory: u64) -> Result<Self, Fault> {
        let mut vertices = Entry::whole(file, VERTICES[0])?;
        let header = Header::read(&mut vertices)?;
        let mut npy = Self::begin_array(file, vertices, header, max_memory)?;
        npy.mesh = Some(mesh);
        npy.is_npy = true;
        Ok(npy)
    }

    fn begin_array(
        file: &Found,
        vertices: Entry,
        header: Header,
        max_memory: u64,
    ) -> Result<Self, Fault> {
        let (frames, count) = match header.shape[..] {
            [frames, count, 3] => (frames, count),
            [count, 3] => (1, count),
            [_, 2] | [_, _, 2] => return Err(two_coordinates().into()),
            _ => {
                let wanted = "(frames, vertices, 3) or (vertices, 3)";
                return Err(wrong_shape(&header.shape, wanted).into());
            }
        };
        let Dtype {
            kind,
            size,
            ref written,
            ..
        } = header.dtype;
        let mut notes = Vec::new();
        let mut note = |is: String| {
            let holds = "vertices";
            notes.push(Note::Array { holds, is });
        };
        match (kind, size) {
            ('f', 4 | 8) => {}
            ('f', 2) | ('i' | 'u', 1 | 2) => {
                note(format!("is of type {written} and was read as float32"));
            }
            ('i' | 'u', 4 | 8) => note(format!("is of type {written} and was read as float64")),
            _ => {
                let advice = format!(
                    "type {written} cannot be read; save vertices.astype(np.float32), or float64"
                );
                return Err(Reason::Unsupported(advice).into());
            }
        }
        if vertices.name != VERTICES[0] {
            note(format!(
                "is called `{}`, not `{}`",
                vertices.name, VERTICES[0]
            ));
        }
        if frames == 0 {
            return Err(Reason::NoFrames.into());
        }
        if count == 0 {
            return Err(Reason::NoVertices.into());
        }
        check_size(frames, count, size as u64, vertices.left())?;
        let is_by_columns = header.fortran_order;
        if is_by_columns {
            let needed = vertices.left();
            if needed > max_memory {
                return Err(column_by_column("vertices", needed, max_memory).into());
            }
            note("is in Fortran order, so that all of it is held in memory".to_owned());
        }
        Ok(Self {
            file: file.clone(),
            vertices,
            dtype: header.dtype,
            frames,
            count,
            next: 0,
            chunk: Vec::new(),
            columns: None,
            is_by_columns,
            mesh: None,
            is_npy: false,
            notes,
        })
    }

    fn read_vertices(&mut self, frame: &mut Frame) -> Result<(), Fault> {
        let place = Place::Frame(self.next);
        let Self {
            vertices,
            dtype,
            count,
            chunk,
            ..
        } = self;
        if self.is_by_columns {
            let all = match &self.columns {
                Some(all) => all,
                None => self.columns.insert(whole(vertices)?),
            };
            // In Fortran order the first index varies fastest.
            let (frames, count) = (self.frames as usize, *count as usize);
            let number = |at: usize| real(&all[at * dtype.size..][..dtype.size], dtype);
            for vertex in 0..count {
                let at = |axis: usize| self.next as usize + frames * (vertex + count * axis);
                let position = [number(at(0)), number(at(1)), number(at(2))];
                take(frame, position, dtype).map_err(|reason| reason.at(place.clone()))?;
            }
            return Ok(());
        }
        rows(vertices, chunk, *count, dtype.size, |_, row| {
            let [x, y, z] =
                [0, 1, 2].map(|axis| real(&row[axis * dtype.size..][..dtype.size], dtype));
            take(frame, [x, y, z], dtype)
        })
        .map_err(|reason| reason.at(place))
    }

    /// Begins the first frame, whose size the array of faces completes, and reads its faces.
    fn begin_with_faces(&mut self, frame: &mut Frame) -> Result<(), Fault> {
        let in_array = |reason: Reason| reason.at(Place::Array("faces"));
        let mut faces = Entry::open(&self.file, &FACES).map_err(in_array)?;
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
        let mut note = |is: String| {
            let holds = "faces";
            self.notes.push(Note::Array { holds, is });
        };
        if faces.name != FACES[0] {
            note(format!("is called `{}`, not `{}`", faces.name, FACES[0]));
        }
        if header.fortran_order {
            note("is in Fortran order".to_owned());
        }
        self.begin(frame, count)?;
        let size = dtype.size;
        let held = if header.fortran_order {
            faces.left()
        } else {
            0
        };
        frame.enter(held).map_err(in_array)?;
        let vertices = self.count;
        let mut each = |face: u64, bytes: [&[u8]; 3]| {
            let mut corners = [0; 3];
            for (corner, bytes) in corners.iter_mut().zip(bytes) {
                let index = integer(bytes, &dtype);
                let (first, last) = (0, vertices as i64 - 1);
                let in_range = u32::try_from(index).ok();
                let in_range = in_range.filter(|&index| u64::from(index) < vertices);
                *corner = in_range.ok_or(Reason::VertexIndex {
                    face,
                    index,
                    first,
                    last,
                })?;
            }
            frame.face(&corners, || Place::Array("faces"))
        };
        let read = if header.fortran_order {
            let all = checked_faces(count, size, held).and_then(|()| whole(&mut faces));
            all.and_then(|all| {
                let of = |at: u64| &all[at as usize * size..][..size];
                (0..count).try_for_each(|face| each(face, [0, 1, 2].map(|c| of(face + c * count))))
            })
        } else {
            rows(&mut faces, &mut self.chunk, count, size, |face, row| {
                each(face, [0, 1, 2].map(|corner| &row[corner * size..][..size]))
            })
        };
        frame.take_off(held);
        read.and_then(|()| faces.finish()).map_err(in_array)
    }

    fn precision(&self) -> Precision {
        match (self.dtype.kind, self.dtype.size) {
            ('f', 8) | ('i' | 'u', 4 | 8) => Precision::F64,
            _ => Precision::F32,
        }
    }

    /// Begins the next frame; `faces`: number of faces that the first frame announces.
    fn begin(&self, frame: &mut Frame, faces: u64) -> Result<(), Fault> {
        let announced = Announced {
            vertices: self.count,
            faces,
        };
        let begun = frame.begin(self.precision(), announced);
        begun.map_err(|reason| reason.at(Place::Frame(self.next)))
    }

    fn read_frame(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let place = Place::Frame(self.next);
        if let Some(mesh) = self.mesh.take() {
            mesh.read(self.count, frame)?;
            frame.replace_vertices(self.precision(), self.count)?;
        } else if self.next == 0 && !self.is_npy {
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
        // Before the reader's own error: a change while reading is the likelier cause of it.
        self.vertices.unchanged()?;
        read
    }

    fn skip(&mut self, frames: usize) -> Result<(), Fault> {
        let frames = frames as u64;
        if self.is_by_columns {
            self.next += frames;
            return Ok(());
        }
        let bytes = frames.saturating_mul(self.count.saturating_mul(3 * self.dtype.size as u64));
        let skipped = self.vertices.skip(bytes);
        // Before the reader's own error: a change while reading is the likelier cause of it.
        self.vertices.unchanged()?;
        skipped.map_err(|reason| reason.at(Place::Frame(self.next)))?;
        self.next += frames;
        Ok(())
    }

    fn rewind(&mut self) -> Result<bool, Fault> {
        if self.columns.is_some() {
            self.vertices.unchanged()?;
            self.next = 0;
            return Ok(true);
        }
        if self.is_npy {
            // The faces are not read again.
            self.vertices = Entry::whole(&self.file, VERTICES[0])?;
            Header::read(&mut self.vertices)?;
            self.next = 0;
        }
        Ok(self.is_npy)
    }

    fn held(&self) -> u64 {
        let mesh = self.mesh.as_ref().map_or(0, MovedMesh::held);
        let all = self
            .count
            .saturating_mul(self.frames.saturating_mul(3 * self.dtype.size as u64));
        mesh + if self.is_by_columns { all } else { 0 }
    }

    fn notes(&self) -> Vec<Note> {
        self.notes.clone()
    }
}

/// Reads the rest of an array into memory, which grows as data arrives.
fn whole(entry: &mut Entry) -> Result<Vec<u8>, Reason> {
    let announced = entry.left();
    let mut all = Vec::new();
    entry.read_to_end(&mut all)?;
    if (all.len() as u64) < announced {
        let read = all.len();
        return Err(Reason::Truncated(format!(
            "the data ends after {read} of {announced} bytes"
        )));
    }
    Ok(all)
}

/// Compares the shape of faces that are held as a whole with their size.
fn checked_faces(count: u64, size: usize, held: u64) -> Result<(), Reason> {
    let needed = u128::from(count) * 3 * size as u128;
    if needed != u128::from(held) {
        return Err(Reason::Truncated(format!(
            "the shape needs {needed} bytes, the file announces {held}"
        )));
    }
    Ok(())
}

/// Appends a vertex; refuses integers that f64 may have rounded.
fn take(frame: &mut Frame, position: [f64; 3], dtype: &Dtype) -> Result<(), Reason> {
    // Larger integers were rounded.
    let most = 9_007_199_254_740_992.0;
    if dtype.kind != 'f' && position.iter().any(|x| x.abs() >= most) {
        let vertex = frame.vertex_count();
        return Err(Reason::Unsupported(format!(
            "a coordinate of vertex {vertex} is 2^53 or more, and float64 does not hold \
             all such numbers; save vertices.astype(np.float64)"
        )));
    }
    frame.vertex(position)
}

/// Compares the shape with the size in the directory.
///
/// So a file cut short is refused before its first frame, not after its last.
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

/// Reads `count` rows of three numbers of `size` bytes, and passes each to `each`.
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

/// Converts bytes to a number.
fn real(bytes: &[u8], dtype: &Dtype) -> f64 {
    if dtype.kind != 'f' {
        return integer(bytes, dtype) as f64;
    }
    match (bytes, dtype.big_endian) {
        (&[a, b], false) => half(u16::from_le_bytes([a, b])),
        (&[a, b], true) => half(u16::from_be_bytes([a, b])),
        (&[a, b, c, d], false) => f32::from_le_bytes([a, b, c, d]).into(),
        (&[a, b, c, d], true) => f32::from_be_bytes([a, b, c, d]).into(),
        (&[a, b, c, d, e, f, g, h], false) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        (&[a, b, c, d, e, f, g, h], true) => f64::from_be_bytes([a, b, c, d, e, f, g, h]),
        _ => f64::NAN, // no float has another size; refused like any other NaN
    }
}

/// Converts half precision: a sign, five bits of exponent and ten of fraction.
fn half(bits: u16) -> f64 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    let size = match exponent {
        0 => fraction * 0.5_f64.powi(24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1024.0 + fraction) * 2.0_f64.powi(exponent - 25),
    };
    if bits >> 15 == 1 { -size } else { size }
}

/// Converts up to 8 bytes to an integer. Unsigned ones beyond `i64::MAX` become `i64::MAX`.
///
/// That is out of range all the same.
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

fn column_by_column(array: &str, needed: u64, limit: u64) -> Reason {
    let [needed, limit] = [needed, limit].map(Size);
    Reason::Unsupported(format!(
        "is in Fortran order, so that {needed} would be held in memory, {limit} are allowed; \
         save np.ascontiguousarray({array})"
    ))
}
