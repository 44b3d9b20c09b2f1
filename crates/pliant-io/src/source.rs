//! What a reader of a file that is a sequence does: hand out frame after frame.

use std::sync::Arc;

use crate::error::Fault;
use crate::frame::{Complete, Frame};
use crate::note::Note;

/// The frames of one file, in order.
pub(crate) trait FrameSource: Send {
    /// How many there are.
    fn frame_count(&self) -> usize;

    /// Reads the next one into `frame`, from a file that did not change meanwhile; not called after the last, nor after an
    /// error.
    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault>;

    /// Passes over so many; at least one is left. Not called before the body has its faces, be they of this source or of another
    /// one.
    fn skip(&mut self, frames: usize) -> Result<(), Fault>;

    /// Begins again without opening its file again: the next is the first. False where it cannot.
    fn rewind(&mut self) -> Result<bool, Fault> {
        Ok(false)
    }

    /// The bytes that it holds beside the frame.
    fn held(&self) -> u64 {
        0
    }

    /// A number for each vertex of the frame read first: vertices may be welded only if theirs are equal. None where equal
    /// positions are enough.
    fn alike(&self) -> Option<Vec<u64>> {
        None
    }

    /// Whether two vertices that are [`alike`](Self::alike) are at one place in every frame, to the bit. If not, they are one vertex all
    /// the same, and how far rounding parts them is no reason to refuse a frame.
    fn moves_alike(&self, _: u32, _: u32) -> bool {
        true
    }

    /// What is to be said about the body, once its first frame is read. Of a file of several bodies the first says what is about all.
    fn notes(&self) -> Vec<Note> {
        Vec::new()
    }

    /// The name of the animation that moves it.
    fn clip(&self) -> Option<&Arc<str>> {
        None
    }
}
