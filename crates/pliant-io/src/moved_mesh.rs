//! The mesh beside a cache of positions: it supplies the faces, the cache every position.

use crate::error::{Fault, Reason};
use crate::file::Found;
use crate::frame::Frame;
use crate::source::FrameSource;

/// A mesh of one frame, not read yet, that the positions of another file move.
pub(crate) struct MovedMesh {
    file: Found,
    source: Box<dyn FrameSource>,
}

impl MovedMesh {
    pub(crate) fn new(file: Found, source: Box<dyn FrameSource>) -> Self {
        Self { file, source }
    }

    /// Reads the mesh into `frame`; an error unless it has `count` vertices, one per position.
    pub(crate) fn read(mut self, count: u64, frame: &mut Frame) -> Result<(), Fault> {
        let path = self.file.path();
        let complete = self.source.read(frame);
        let _complete = complete.map_err(|fault| fault.or_in(path))?;
        let expected = frame.vertex_count() as u64;
        if expected != count {
            return Err(Reason::VertexCount {
                vertices: count,
                expected,
                than: path.to_owned(),
            }
            .into());
        }
        Ok(())
    }

    /// Bytes held by its source.
    pub(crate) fn held(&self) -> u64 {
        self.source.held()
    }
}
