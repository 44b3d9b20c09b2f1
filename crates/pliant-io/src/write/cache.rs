//! PC2 and MDD writer: the positions of all frames in 32 bits, one after another.

use std::io::Write;
use std::path::Path;

use super::coordinates::{narrowed, widened};
use super::shape::Shape;
use super::staged::StagedFile;
use crate::cache::PC2;
use crate::error::{Error, Reason};
use crate::positions::Positions;

/// A point cache being written.
pub(super) struct Cache {
    staged: StagedFile,
    big_endian: bool,
    /// Reused buffer: a frame as the file has it.
    bytes: Vec<u8>,
}

impl Cache {
    /// Begins a file. MDD stores the time of each frame, PC2 only their number.
    pub(super) fn create(
        path: &Path,
        big_endian: bool,
        shape: &Shape,
        fps: f64,
    ) -> Result<Self, Error> {
        let counts = [shape.frame_count, shape.vertex_count].map(i32::try_from);
        let [Ok(frames), Ok(vertices)] = counts else {
            let reason = format!(
                "has {} frames of {} vertices; this format holds at most {} of each, so write .npz",
                shape.frame_count,
                shape.vertex_count,
                i32::MAX
            );
            return Err(Error::new(path, Reason::Unsupported(reason)));
        };
        let mut bytes = Vec::new();
        if big_endian {
            bytes.extend(frames.to_be_bytes());
            bytes.extend(vertices.to_be_bytes());
            for frame in 0..frames {
                bytes.extend(((f64::from(frame) / fps) as f32).to_be_bytes());
            }
        } else {
            bytes.extend(PC2);
            bytes.extend(vertices.to_le_bytes());
            let (first, frames_a_sample) = (0.0_f32, 1.0_f32);
            bytes.extend([first.to_le_bytes(), frames_a_sample.to_le_bytes()].concat());
            bytes.extend(frames.to_le_bytes());
        }
        let mut cache = Self {
            staged: StagedFile::create(path)?,
            big_endian,
            bytes,
        };
        cache.write()?;
        Ok(cache)
    }

    fn write(&mut self) -> Result<(), Error> {
        let written = self.staged.write_all(&self.bytes);
        written.map_err(|error| Error::new(self.staged.path(), Reason::Write(error)))
    }

    /// Writes a frame; returns whether a coordinate was rounded.
    pub(super) fn frame(&mut self, positions: Positions<'_>) -> Result<bool, Error> {
        let mut rounded = false;
        self.bytes.clear();
        for position in widened(positions) {
            for x in narrowed(position, &mut rounded) {
                self.bytes.extend(if self.big_endian {
                    x.to_be_bytes()
                } else {
                    x.to_le_bytes()
                });
            }
        }
        self.write()?;
        Ok(rounded)
    }

    pub(super) fn finish(self) -> StagedFile {
        self.staged
    }
}
