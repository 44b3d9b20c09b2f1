//! How a tree divides its body: for pictures, to judge partitions, and to store vertices in its order.

use super::forest::with_trees;
use super::{BodyId, World};
use crate::error::Error;
use crate::geometry::Scalar;

impl<S: Scalar> World<S> {
    /// For each triangle of a body, the part it is in when the tree is cut at a level: its node of that level, or its leaf, if
    /// that is above. Parts are numbered from 0 in the order of the tree, so that parts with close numbers are close in the
    /// tree. Level 0 is one part, level 1 the children of the root, [`TreeShape::depth`](super::TreeShape::depth) and all
    /// levels below it the leaves.
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
    /// assert!(world.tree_parts(body, 0)?.iter().all(|&part| part == 0));
    /// let parts = world.tree_parts(body, 1)?;
    /// assert_eq!(parts.iter().max(), Some(&7));
    /// # Ok::<(), pliant::Error>(())
    /// ```
    pub fn tree_parts(&self, body: BodyId, level: u32) -> Result<Vec<u32>, Error> {
        let place = self.place(body)?;
        let starts = with_trees!(&self.forest, trees => trees[place].starts_of_parts(level));
        let ids = self.bodies[place].mesh.triangle_ids();
        let mut parts = vec![0; ids.len()];
        let ends = starts[1..].iter().copied().chain([ids.len() as u32]);
        for (part, (&start, end)) in starts.iter().zip(ends).enumerate() {
            for &triangle in &ids[start as usize..end as usize] {
                parts[triangle as usize] = part as u32;
            }
        }
        Ok(parts)
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
        Ok(self.bodies[self.place(body)?].mesh.vertex_ids())
    }
}
