//! What a body is, what its tree looks like, and what the last query did.

use super::handle::World;
use super::scalar::Scalar;
use crate::bodies::NodeBox;
use crate::bodies::TreeShape;
use crate::error::Error;
use crate::ids::BodyId;
use crate::statistics::Statistics;

/// What a body is, what its tree looks like, and what the last query did.
impl<S: Scalar> World<S> {
    /// The triangles of a body as they were added and edited, shape (m, 3): three times [`u32::MAX`] for a number that an [`Edit`](crate::Edit) has left
    /// empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn triangles(&self, body: BodyId) -> Result<&[[u32; 3]], Error> {
        Ok(self.state().body(body)?.mesh().triangles())
    }

    /// The edges of a body, shape (k, 2): two vertices each, the smaller first. Every edge once, whatever triangles share it. The number of
    /// an edge is its place here. A degenerate triangle has the edges whose two ends differ.
    ///
    /// They are sorted when they are first asked for, here or by a query for edges. From then on an edge keeps its number while there is a
    /// triangle that has it, however the mesh is edited: a number whose edge is gone is empty, two times [`u32::MAX`], until an edge that
    /// comes takes it, the lowest first; then come new numbers, in the order of the triangles that were changed.
    /// [`set_mesh`](Self::set_mesh) keeps numbers where it edits.
    ///
    /// Cost: O(m) the first time, and after [`rebuild`](Self::rebuild).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn edges(&self, body: BodyId) -> Result<&[[u32; 2]], Error> {
        Ok(self.state().body(body)?.mesh().edges())
    }

    /// The shape that a body has now: the positions that it was given last; NaN for vertices that an [`Edit`](crate::Edit) has left empty.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn positions(&self, body: BodyId) -> Result<Vec<[S; 3]>, Error> {
        Ok(self.state().body(body)?.positions().into_owned())
    }

    /// How many triangles a body has: of numbers, those left empty by an [`Edit`](crate::Edit) counted with the others.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn triangle_count(&self, body: BodyId) -> Result<usize, Error> {
        Ok(self.triangles(body)?.len())
    }

    /// How many vertices a body has, counted by number like triangles: the length that its positions must have.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn vertex_count(&self, body: BodyId) -> Result<usize, Error> {
        Ok(self.state().body(body)?.mesh().vertex_count())
    }

    /// The order in which queries read the vertices of a body, as the caller numbers them: at place i of memory is vertex
    /// `order[i]`. Shape (n,).
    ///
    /// Queries are faster on a body whose vertices come in this order already, the more so the larger it is. A simulation that
    /// can choose stores them so: vertex i of the new body is vertex `order[i]` of the old one, and triangles name the new
    /// numbers. The tree of the new body is the same, and its order is 0, 1, 2, ...
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let mut triangles = vec![[9, 1, 2], [2, 1, 3], [4, 8, 6]];
    /// let positions: Vec<[f32; 3]> = (0..10).map(|i| [i as f32, (i * i % 7) as f32, 0.0]).collect();
    /// let body = world.add(&triangles, &positions)?;
    ///
    /// let order = world.vertex_order(body)?.to_vec();
    /// let positions: Vec<_> = order.iter().map(|&old| positions[old as usize]).collect();
    /// let mut new_number = vec![0; order.len()];
    /// for (new, &old) in order.iter().enumerate() {
    ///     new_number[old as usize] = new as u32;
    /// }
    /// for corner in triangles.as_flattened_mut() {
    ///     *corner = new_number[*corner as usize];
    /// }
    /// let body = world.add(&triangles, &positions)?;
    /// assert!(world.vertex_order(body)?.iter().copied().eq(0..10));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn vertex_order(&self, body: BodyId) -> Result<&[u32], Error> {
        Ok(self.state().body(body)?.mesh().vertex_order())
    }

    /// The tree of a body in numbers.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn tree_shape(&self, body: BodyId) -> Result<TreeShape, Error> {
        Ok(self.state().body(body)?.tree_shape())
    }

    /// For each triangle of a body, the part it is in when the tree is cut at a level: its node of that level, or its leaf, if
    /// that is above. Parts are numbered from 0 in the order of the tree, so that parts with close numbers are close in the
    /// tree. Level 0 is one part, level 1 the children of the root, [`TreeShape::depth`] and all
    /// levels below it the leaves. What an [`Edit`](crate::Edit) adds is in trees of its own, each of which is cut at the level, in parts behind the
    /// others. A number that is left empty is in part [`u32::MAX`].
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let strip: Vec<[u32; 3]> = (0..64).map(|i| [i, i + 1, i + 2]).collect();
    /// let zigzag: Vec<[f32; 3]> = (0..66).map(|i| [i as f32, (i % 2) as f32, 0.0]).collect();
    /// let body = world.add(&strip, &zigzag)?;
    ///
    /// assert!(world.tree_cut(body, 0)?.iter().all(|&part| part == 0));
    /// let parts = world.tree_cut(body, 1)?;
    /// assert_eq!(parts.iter().max(), Some(&7));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn tree_cut(&self, body: BodyId, level: u32) -> Result<Vec<u32>, Error> {
        Ok(self.state().body(body)?.tree_cut(level))
    }

    /// The boxes of a level of a body's tree, and which of them the tree holds for the shape that the body has now: figure 2
    /// of the paper. One box a part, in the order of [`tree_cut`](Self::tree_cut): a leaf above the level stands for
    /// itself.
    ///
    /// The corners are those of the triangles; the tree's own boxes, in single precision, are the same or a rounding
    /// larger. Makes no box, and reads none.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    ///
    /// ```
    /// use pliant::World;
    ///
    /// let mut world = World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let root = world.tree_boxes(body, 0)?[0];
    /// assert_eq!((root.lower, root.upper, root.valid), ([0.0; 3], [2.0, 1.0, 0.0], false));
    /// world.intersections(pliant::Selection::Within(body)).prepare()?;
    /// assert!(world.tree_boxes(body, 0)?[0].valid);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn tree_boxes(&self, body: BodyId, level: u32) -> Result<Vec<NodeBox<S>>, Error> {
        self.verbs.tree_boxes(body, level)
    }

    /// What the last query did, with what [`Query::prepare`](crate::Query::prepare) did before it.
    pub fn statistics(&self) -> &Statistics {
        &self.state().common.statistics
    }

    /// How many bytes of memory this world holds: bodies, trees, boxes, and the lists that queries keep for the next ones, with all
    /// that they have room for. Threads, and what a query that is under way takes besides, are not counted.
    ///
    /// ```
    /// let mut world = pliant::World::<f32>::new();
    /// let body = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let with_it = world.memory_usage();
    /// world.remove(body)?;
    /// assert!(world.memory_usage() < with_it);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn memory_usage(&self) -> usize {
        self.verbs.memory_usage()
    }

    /// Checks every invariant of every tree: the structure, that each box that claims to be valid is the box of the vertices below it
    /// as they are now, and that the nodes of mesh connectivity trees are connected pieces or whole components. For tests and bug
    /// reports; no sequence of calls should ever make it fail.
    ///
    /// Cost: every triangle once a level.
    ///
    /// # Errors
    ///
    /// A sentence that names the body and what is wrong.
    pub fn validate(&self) -> Result<(), String> {
        self.verbs.validate()
    }
}
