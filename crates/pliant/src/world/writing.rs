//! For tests, and for who writes worlds down.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::kernels::Instructions;

/// For tests, and for who writes worlds down.
impl<S: Scalar> World<S> {
    /// Makes the kernels use other instructions, for tests that all of them give the same answers.
    #[doc(hidden)]
    pub fn use_instructions(&mut self, instructions: Instructions) {
        self.state_mut().common.instructions = instructions;
    }

    /// The edges of a body, if anybody has asked for them, for whoever writes a world down: their
    /// numbers stay. None if nobody has; they will be sorted.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(hidden)]
    pub fn numbered_edges(&self, body: BodyId) -> Result<Option<&[[u32; 2]]>, Error> {
        Ok(self.state().body(body)?.mesh().numbered_edges())
    }

    /// Numbers the edges of a body as they were when the world was written down. Returns false if
    /// these are not the edges of its mesh, or somebody has asked for them.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(hidden)]
    pub fn number_edges(&mut self, body: BodyId, edges: &[[u32; 2]]) -> Result<bool, Error> {
        self.verbs.number_edges(body, edges)
    }

    /// The id of the next body, for whoever writes a world down; none if there are no more.
    #[doc(hidden)]
    pub fn next_id(&self) -> Option<u32> {
        self.state().common.bodies.next_id().ok().map(|id| id.0)
    }

    /// Uses no id below this one any more, or none at all, for whoever reads a world that was written down. Ids never go back.
    #[doc(hidden)]
    pub fn skip_ids(&mut self, next: Option<u32>) {
        self.state_mut().common.bodies.skip_ids(next);
    }
}
