//! The trait of readers: a source returns the frames of one file in order.

use std::sync::Arc;

use crate::error::Fault;
use crate::frame::{Complete, Frame};
use crate::note::Note;

/// The frames of one file, in order.
pub(crate) trait FrameSource: Send {
    /// Number of frames in the file.
    fn frame_count(&self) -> usize;

    /// Reads the next frame into `frame`; an error if the file changed meanwhile.
    ///
    /// Not called after the last frame, nor after an error.
    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault>;

    /// Skips `frames` frames; at least one is left afterwards.
    ///
    /// Called only when the body already has its faces, from this source or from another.
    fn skip(&mut self, frames: usize) -> Result<(), Fault>;

    /// Returns to the first frame without opening the file again. False where that is not possible.
    fn rewind(&mut self) -> Result<bool, Fault> {
        Ok(false)
    }

    /// Bytes held by the source, beside the frame.
    fn held(&self) -> u64 {
        0
    }

    /// Weld key of each vertex of the first frame: only vertices with equal keys may be welded.
    ///
    /// None where equal positions are enough.
    fn alike(&self) -> Option<Vec<u64>> {
        None
    }

    /// Whether two vertices with equal weld keys coincide bit for bit in every frame.
    ///
    /// See [`alike`](Self::alike). If not, they are welded nevertheless: rounding that parts them
    /// is no reason to refuse a frame.
    fn moves_alike(&self, _: u32, _: u32) -> bool {
        true
    }

    /// Notes about the body, once its first frame is read.
    ///
    /// In a file of several bodies, the first body has the notes about the file.
    fn notes(&self) -> Vec<Note> {
        Vec::new()
    }

    /// Name of the animation that moves the body.
    fn clip(&self) -> Option<&Arc<str>> {
        None
    }
}
