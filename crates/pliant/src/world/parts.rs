//! How a tree divides its body: for pictures, and to judge partitions.

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
}
