//! Inspection: meshes and shapes of bodies, the structure and boxes of their trees, and the work of
//! the last query.

use super::handle::World;
use super::scalar::Scalar;
use crate::bodies::NodeBox;
use crate::bodies::TreeShape;
use crate::error::Error;
use crate::ids::BodyId;
use crate::statistics::Statistics;
use crate::threads::{Clock, RecordedPart, Threads};
use std::num::NonZeroUsize;

/// # Looking inside: meshes, trees, work
impl<S: Scalar> World<S> {
    /// Triangles of a body as they were added and edited, shape (m, 3).
    ///
    /// A number that an [`Edit`](crate::Edit) has left empty is [`u32::MAX`] three times.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn triangles(&self, body: BodyId) -> Result<&[[u32; 3]], Error> {
        Ok(self.state().body(body)?.mesh().triangles())
    }

    /// Edges of a body, shape (k, 2): two vertices each, the smaller first; each edge once.
    ///
    /// The number of an edge is its place here. A degenerate triangle has the edges whose two ends
    /// differ.
    ///
    /// They are sorted when they are first asked for, here or by a query for edges. From then on an
    /// edge keeps its number while any triangle has it, however the mesh is edited. The number of
    /// an edge that is gone is empty, [`u32::MAX`] two times, until a new edge takes it. New edges
    /// take the lowest empty numbers first, then new ones, in the order of the triangles that were
    /// changed. [`set_mesh`](Self::set_mesh) keeps numbers where it edits.
    ///
    /// Cost: O(m) the first time, and after [`rebuild`](Self::rebuild).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn edges(&self, body: BodyId) -> Result<&[[u32; 2]], Error> {
        Ok(self.state().body(body)?.mesh().edges())
    }

    /// Positions of a body as they were given last, shape (n, 3).
    ///
    /// Vertices that an [`Edit`](crate::Edit) has left empty are at NaN. Cost: O(n), a copy.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn positions(&self, body: BodyId) -> Result<Vec<[S; 3]>, Error> {
        Ok(self.state().body(body)?.positions().into_owned())
    }

    /// Count of triangle numbers of a body, m; numbers that an [`Edit`](crate::Edit) left empty
    /// count.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn triangle_count(&self, body: BodyId) -> Result<usize, Error> {
        Ok(self.triangles(body)?.len())
    }

    /// Count of vertex numbers of a body, n, which is the length that its positions must have;
    /// empty numbers count.
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn vertex_count(&self, body: BodyId) -> Result<usize, Error> {
        Ok(self.state().body(body)?.mesh().vertex_count())
    }

    /// Order in which queries read the vertices of a body, shape (n,): place i of memory has vertex
    /// `order[i]`.
    ///
    /// Vertices are numbered as the caller numbers them. Queries are faster on a body whose
    /// vertices come in this order already, the more so the larger it is. A simulation that can
    /// choose stores them so. Vertex i of the new body is then vertex `order[i]` of the old one,
    /// and triangles name the new numbers. The tree of the new body is the same, and its order is
    /// 0, 1, 2, ...
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
    /// let position = |i: u8| [f32::from(i), f32::from(i * i % 7), 0.0];
    /// let positions: Vec<[f32; 3]> = (0..10).map(position).collect();
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

    /// Shape of a body's tree: its depth, and how many nodes and leaves it has. Cost: at most O(m).
    ///
    /// # Errors
    ///
    /// [`NoSuchBody`](crate::ErrorKind::NoSuchBody).
    pub fn tree_shape(&self, body: BodyId) -> Result<TreeShape, Error> {
        Ok(self.state().body(body)?.tree_shape())
    }

    /// Cuts a body's tree at a level: for each triangle the part it is in, shape (m,).
    ///
    /// A part is a node of that level, or a leaf above it. Level 0 is one part, level 1 the
    /// children of the root. [`TreeShape::depth`] and all levels below it are the leaves. Parts are
    /// numbered from 0 in the order of the tree, so parts with close numbers are close in the tree.
    ///
    /// Triangles that an [`Edit`](crate::Edit) adds are in trees of their own. Each is cut at the
    /// level, in parts behind the others. A number that is left empty is in part [`u32::MAX`].
    ///
    /// Cost: O(m).
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

    /// Boxes of a level of a body's tree, and which of them the tree holds for the present shape:
    /// figure 2 of the paper.
    ///
    /// There is one box a part, in the order of [`tree_cut`](Self::tree_cut): a leaf above the
    /// level stands for itself. The boxes are exactly the triangles' own. The tree's boxes, in
    /// single precision, are equal or a rounding larger. The call makes no box of the tree, and
    /// reads none.
    ///
    /// Cost: O(m).
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

    /// Counters of the last query, with what [`Query::prepare`](crate::Query::prepare) did before
    /// it.
    pub fn statistics(&self) -> &Statistics {
        &self.state().common.statistics
    }

    /// Records jobs from now on, for benchmarks that replay them on more workers.
    ///
    /// Work is cut as for `threads`, done by the calling thread alone, and timed by `clock`.
    #[doc(hidden)]
    pub fn record_jobs(&mut self, threads: NonZeroUsize, clock: Clock) {
        self.state_mut().common.threads = Threads::recorded(threads, clock);
    }

    /// Has all threads share `parts` pieces without work, for benchmarks that time waits.
    #[doc(hidden)]
    pub fn run_empty_parts(&mut self, parts: u32) {
        self.state_mut().run_empty_parts(parts);
    }

    /// Parts that were recorded since the last call.
    #[doc(hidden)]
    pub fn take_record(&self) -> Vec<RecordedPart> {
        self.state().common.threads.take_record()
    }

    /// Memory that this world holds, in bytes: bodies, trees, boxes, and lists that queries keep
    /// for the next ones.
    ///
    /// Capacity counts, used or not. Threads do not count, nor does the memory that a running query
    /// takes besides.
    ///
    /// Cost: O(b) for b bodies.
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

    /// Checks every invariant of every tree, for tests and bug reports; no sequence of calls should
    /// ever make it fail.
    ///
    /// - The structure of the tree is right.
    /// - Each box that claims to be valid is the box of the vertices below it as they are now.
    /// - Nodes of mesh connectivity trees are connected pieces or whole components.
    ///
    /// Cost: O(m) a level of the tree.
    ///
    /// # Errors
    ///
    /// A sentence that names the body and what is wrong.
    pub fn validate(&self) -> Result<(), String> {
        self.verbs.validate()
    }
}
