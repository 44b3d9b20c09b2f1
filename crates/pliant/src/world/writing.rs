//! Hidden calls, for tests and for callers that write worlds down.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::Error;
use crate::ids::BodyId;
use crate::kernels::Instructions;

// Without a section of its own: all of it is hidden.
impl<S: Scalar> World<S> {
    /// Makes the kernels use other instructions, for tests that all of them give equal answers.
    #[doc(hidden)]
    pub fn use_instructions(&mut self, instructions: Instructions) {
        self.state_mut().common.instructions = instructions;
    }

    /// Edges of a body if anybody has asked for them, shape (k, 2), to write a world down.
    ///
    /// Their numbers stay. `None` if nobody has asked; they will be sorted then.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(hidden)]
    pub fn numbered_edges(&self, body: BodyId) -> Result<Option<&[[u32; 2]]>, Error> {
        Ok(self.state().body(body)?.mesh().numbered_edges())
    }

    /// Numbers the edges of a body, shape (k, 2), as they were when the world was written down.
    ///
    /// Returns false if these are not the edges of its mesh, or somebody has asked for edges
    /// already.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    #[doc(hidden)]
    pub fn number_edges(&mut self, body: BodyId, edges: &[[u32; 2]]) -> Result<bool, Error> {
        self.verbs.number_edges(body, edges)
    }

    /// Id of the next body, to write a world down; `None` if there are no more.
    #[doc(hidden)]
    pub fn next_id(&self) -> Option<u32> {
        self.state().common.bodies.next_id().ok().map(|id| id.0)
    }

    /// Skips all ids below `next`, or all there are, for a world that is read back. Ids never go
    /// back.
    #[doc(hidden)]
    pub fn skip_ids(&mut self, next: Option<u32>) {
        self.state_mut().common.bodies.skip_ids(next);
    }
}
