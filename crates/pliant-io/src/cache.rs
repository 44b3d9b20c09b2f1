//! Point caches: PC2 and MDD, positions of all frames without faces. NPY is read by `npz`.
//!
//! ```text
//! PC2, little-endian    "POINTCACHE2\0", version 1, vertices n, first frame, frames a sample,
//!                       samples T; then T x n x (x, y, z)
//! MDD, big-endian       samples T, vertices n, T times; then T x n x (x, y, z)
//! ```
//!
//! Integers have 32 bits, everything else is f32. A sample is a frame, whatever its time. The faces
//! come from a mesh: one frame of any format with the same number of vertices, whose positions are
//! dropped. The length of the file must match its header exactly.

use std::io::{self, BufReader, Read, Seek, SeekFrom};

use crate::error::{Fault, Place, Reason};
use crate::file::{Found, Opened};
use crate::format::Format;
use crate::frame::{Announced, Complete, Frame};
use crate::moved_mesh::MovedMesh;
use crate::npz::Npz;
use crate::options::OpenOptions;
use crate::positions::Precision;
use crate::source::FrameSource;

/// First bytes of a PC2 file: signature and version.
pub(crate) const PC2: [u8; 16] = *b"POINTCACHE2\0\x01\0\0\0";

/// Size of a position in bytes.
const POSITION: usize = 12;
/// Positions read at a time: few calls, with a buffer of 48 KiB.
const ROWS: u64 = 4096;

/// Frames of a mesh whose positions are in a point cache.
pub(crate) struct Cache {
    mesh: Option<MovedMesh>,
    input: BufReader<Opened>,
    big_endian: bool,
    /// Offset of the first position, in bytes.
    head: u64,
    /// Number of vertices of a frame.
    count: u64,
    frames: u64,
    next: u64,
    /// Reused buffer: positions as the file has them.
    chunk: Vec<u8>,
}

/// Opens the mesh, which must be one frame, and the positions, which have the given format.
pub(crate) fn open(
    mesh: &Found,
    positions: &Found,
    format: Format,
    options: &OpenOptions,
) -> Result<Box<dyn FrameSource>, Fault> {
    let in_mesh = |fault: Fault| fault.or_in(mesh.path());
    let source = Format::of(mesh.path())
        .map_err(|reason| in_mesh(reason.into()))?
        .open(mesh, options)
        .map_err(in_mesh)?;
    let frames = source.frame_count();
    if frames != 1 {
        return Err(in_mesh(Reason::MeshMoves { frames }.into()));
    }
    let mesh = MovedMesh::new(mesh.clone(), source);
    if format == Format::Npy {
        let npy = Npz::beside(mesh, positions, options.max_memory)?;
        return Ok(Box::new(npy));
    }
    let mut input = BufReader::with_capacity(1 << 16, positions.open()?);
    let length = input.get_ref().length();
    let big_endian = format == Format::Mdd;
    let (frames, count, head) = if big_endian {
        let [frames, count] = whole(&mut input, [length, 8], u32::from_be_bytes)?;
        let times = 4 * u64::from(frames);
        (frames, count, times.saturating_add(8))
    } else {
        let mut start = [0; 16];
        fill(&mut input, &mut start, [length, 32])?;
        if start != PC2 {
            let reason = "is not a PC2 file of version 1";
            return Err(Reason::Malformed(reason.into()).at(Place::Byte(0)));
        }
        let [count, _, _, frames] = whole(&mut input, [length, 32], u32::from_le_bytes)?;
        (frames, count, 32)
    };
    if frames == 0 {
        return Err(Reason::NoFrames.into());
    }
    if count == 0 {
        return Err(Reason::NoVertices.into());
    }
    let (frames, count) = (u64::from(frames), u64::from(count));
    let needed = u128::from(frames) * u128::from(count) * POSITION as u128 + u128::from(head);
    if needed != u128::from(length) {
        let message = format!(
            "{frames} frames of {count} vertices need {needed} bytes, the file has {length}"
        );
        return Err(if needed > u128::from(length) {
            Reason::Truncated(message)
        } else {
            Reason::Malformed(message)
        }
        .into());
    }
    input.seek(SeekFrom::Start(head))?;
    Ok(Box::new(Cache {
        mesh: Some(mesh),
        input,
        big_endian,
        head,
        count,
        frames,
        next: 0,
        chunk: Vec::new(),
    }))
}

/// Reads the next unsigned integers of a header; `lengths` as in [`fill`].
fn whole<const N: usize>(
    input: &mut impl Read,
    lengths: [u64; 2],
    number: fn([u8; 4]) -> u32,
) -> Result<[u32; N], Fault> {
    let mut numbers = [0; N];
    for each in &mut numbers {
        let mut bytes = [0; 4];
        fill(input, &mut bytes, lengths)?;
        *each = number(bytes);
    }
    Ok(numbers)
}

/// Reads bytes of a header. The lengths of file and header, in bytes, are for the message.
fn fill(input: &mut impl Read, bytes: &mut [u8], [file, header]: [u64; 2]) -> Result<(), Reason> {
    input.read_exact(bytes).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => Reason::Truncated(format!(
            "the header needs {header} bytes, the file has {file}"
        )),
        _ => error.into(),
    })
}

impl Cache {
    fn read_frame(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let place = Place::Frame(self.next);
        let at = |reason: Reason| reason.at(Place::Frame(self.next));
        if let Some(mesh) = self.mesh.take() {
            mesh.read(self.count, frame)?;
            frame
                .replace_vertices(Precision::F32, self.count)
                .map_err(at)?;
        } else {
            let announced = Announced {
                vertices: self.count,
                faces: 0,
            };
            frame.begin(Precision::F32, announced).map_err(at)?;
            frame.same_faces();
        }
        let number = if self.big_endian {
            f32::from_be_bytes
        } else {
            f32::from_le_bytes
        };
        let mut left = self.count;
        while left > 0 {
            let now = left.min(ROWS);
            self.chunk.resize(now as usize * POSITION, 0);
            self.input
                .read_exact(&mut self.chunk)
                .map_err(|error| match error.kind() {
                    io::ErrorKind::UnexpectedEof => {
                        Reason::Truncated("the file ends within this frame".into())
                    }
                    _ => error.into(),
                })
                .map_err(at)?;
            for bytes in self.chunk.chunks_exact(POSITION) {
                let mut position = [0.0; 3];
                for (value, bytes) in position.iter_mut().zip(bytes.chunks_exact(4)) {
                    *value = number(bytes.try_into().unwrap_or_default()).into();
                }
                frame.vertex(position).map_err(at)?;
            }
            left -= now;
        }
        self.next += 1;
        frame.complete(0).map_err(|fault| fault.or_at(place))
    }
}

impl FrameSource for Cache {
    fn frame_count(&self) -> usize {
        usize::try_from(self.frames).unwrap_or(usize::MAX)
    }

    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let read = self.read_frame(frame);
        // Before the reader's own error: a change while reading is the likelier cause of it.
        self.input.get_ref().unchanged()?;
        read
    }

    fn skip(&mut self, frames: usize) -> Result<(), Fault> {
        // Bounded by the length of the file, which was checked.
        let bytes = (frames as u64).saturating_mul(self.count * POSITION as u64);
        self.input
            .seek_relative(i64::try_from(bytes).unwrap_or(i64::MAX))?;
        self.next += frames as u64;
        Ok(())
    }

    fn rewind(&mut self) -> Result<bool, Fault> {
        self.input.get_ref().unchanged()?;
        self.input.seek(SeekFrom::Start(self.head))?;
        self.next = 0;
        Ok(true)
    }

    fn held(&self) -> u64 {
        self.mesh.as_ref().map_or(0, MovedMesh::held)
    }
}
