//! Bodies of a world: adding, moving and removing them.

use super::handle::World;
use super::scalar::Scalar;
use crate::error::{Error, ErrorKind};
use crate::ids::BodyId;
use crate::selection::Selection;

/// # Bodies: adding, moving, removing
impl<S: Scalar> World<S> {
    /// Adds a body and returns its id: triangles as corner indices, shape (m, 3), and positions,
    /// shape (n, 3).
    ///
    /// Indices count from 0. The tree is built on these positions, which need not be special; a
    /// rest pose is best. Vertices that no triangle uses are allowed, and checked like the others.
    ///
    /// Corners may repeat: a degenerate triangle is the segment or point that it is. So `[i, j, j]`
    /// is an edge of its own, as of a cable or a net, and `[i, i, i]` is a point. Every question
    /// answers for them as for triangles.
    ///
    /// Cost: O(m log m) for the balanced partition; for the others O(m) a level of the tree.
    ///
    /// # Errors
    ///
    /// [`NoTriangles`](crate::ErrorKind::NoTriangles),
    /// [`VertexOutOfRange`](crate::ErrorKind::VertexOutOfRange),
    /// [`BadPosition`](crate::ErrorKind::BadPosition),
    /// [`NeedsSubnormals`](crate::ErrorKind::NeedsSubnormals).
    /// [`TooLarge`](crate::ErrorKind::TooLarge) above 2^28 triangles or 2^32 - 1 vertices.
    /// [`TooManyBodies`](crate::ErrorKind::TooManyBodies) after 2^32 bodies.
    #[doc(alias = "insert")]
    pub fn add(&mut self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<BodyId, Error> {
        self.verbs.add(triangles, positions)
    }

    /// Gives a body a new shape: a position for each vertex, shape (n, 3), in the order in which it
    /// was added.
    ///
    /// The positions are checked, and taken over only if all are good; else the body keeps its old
    /// shape.
    ///
    /// Cost: O(n), one pass that copies them. There are two passes if a query looked at the shape
    /// before, and the body is large or there is one thread. The first checks; the second brings
    /// them straight into the order of the tree.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody),
    /// [`WrongLength`](crate::ErrorKind::WrongLength),
    /// [`OutsideLooseBox`](crate::ErrorKind::OutsideLooseBox).
    /// [`BadPosition`](crate::ErrorKind::BadPosition) for the first coordinate, of a used vertex or
    /// not, that is NaN, infinite or above `f32::MAX` in magnitude.
    /// [`NeedsSubnormals`](crate::ErrorKind::NeedsSubnormals) in a thread that flushes subnormal
    /// numbers.
    #[doc(alias = "update_vertices")]
    #[doc(alias = "refit")]
    pub fn set_positions(&mut self, body: BodyId, positions: &[[S; 3]]) -> Result<(), Error> {
        self.verbs.set_positions(body, positions)
    }

    /// Gives several bodies new shapes at once, shape (n, 3) each: all of them or none.
    ///
    /// As [`set_positions`](Self::set_positions) of each, in any order, shared by all threads.
    ///
    /// ```
    /// # use pliant::{ErrorKind, World};
    /// # let mut world = World::<f32>::new();
    /// # let shape = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// # let [shirt, skin] = [world.add(&[[0, 1, 2]], &shape)?, world.add(&[[0, 1, 2]], &shape)?];
    /// let [moved, broken] = [shape.map(|[x, y, z]| [x, y, z + 1.0]), [[f32::NAN; 3]; 3]];
    /// world.set_positions_of(&[(shirt, &moved), (skin, &moved)])?;
    /// let error = world.set_positions_of(&[(shirt, &shape), (skin, &broken)]).unwrap_err();
    /// assert_eq!(error.body, Some(skin));
    /// assert_eq!(*world.positions(shirt)?, moved); // neither has moved
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// Cost: O(n) in all vertices. Allocates a list of the bodies.
    ///
    /// # Errors
    ///
    /// As [`set_positions`](Self::set_positions), of the first shape in the list that is refused;
    /// [`SameBody`](crate::ErrorKind::SameBody) if a body is listed twice.
    pub fn set_positions_of(&mut self, shapes: &[(BodyId, &[[S; 3]])]) -> Result<(), Error> {
        self.verbs.set_positions_of(shapes)
    }

    /// Gives a body a new shape that `write` fills into a buffer of the world's, shape (n, 3).
    ///
    /// Vertices come in the order in which they were added. The caller needs no buffer of its own.
    /// This one comes filled with NaN, and every vertex must be written. It is then checked and
    /// taken over as by [`set_positions`](Self::set_positions).
    ///
    /// Cost: O(n).
    ///
    /// # Errors
    ///
    /// The errors of [`set_positions`](Self::set_positions). A coordinate that is NaN, as an
    /// unwritten one is, is [`NotWritten`](crate::ErrorKind::NotWritten). If `write` panics, the
    /// body keeps its shape.
    pub fn write_positions(
        &mut self,
        body: BodyId,
        write: impl FnOnce(&mut [[S; 3]]),
    ) -> Result<(), Error> {
        let vertices = self.vertex_count(body)?;
        let mut lent = std::mem::take(&mut self.state_mut().lent);
        lent.clear();
        lent.resize(vertices, [S::NAN; 3]);
        write(&mut lent);
        let moved = self.verbs.set_positions(body, &lent);
        self.state_mut().lent = lent;
        moved.map_err(|mut refused| {
            if let ErrorKind::BadPosition { vertex, position } = refused.kind
                && position.iter().any(|x| x.is_nan())
            {
                refused.kind = ErrorKind::NotWritten { vertex };
            }
            refused
        })
    }

    /// Removes a body, whose id will not be used again. Cost: O(b) for b bodies.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn remove(&mut self, body: BodyId) -> Result<(), Error> {
        let common = &mut self.state_mut().common;
        let rank = common.bodies.remove(body)?;
        common.body_pairs.remove(rank);
        self.state_mut().forget_answers(body);
        Ok(())
    }

    /// Bodies of a selection, whether they are there or not.
    pub(super) fn bodies_of(&self, of: Selection) -> Vec<BodyId> {
        match of {
            Selection::World | Selection::Everything => self.bodies().collect(),
            Selection::Between(a, b) => vec![a, b],
            Selection::Within(a) => vec![a],
        }
    }

    /// Ids of the bodies of this world, in the order in which they were added.
    pub fn bodies(&self) -> impl ExactSizeIterator<Item = BodyId> {
        self.state().common.bodies.ids().iter().copied()
    }
}
