//! Which lanes of which blocks hold the triangles that meet at a vertex: an index of corners the other way round, in memory only while
//! neighbours are looked for.

use super::{BLOCK_LANES, Leaves};
use crate::ids::{BlockId, TreeVertex};
use crate::mesh::Order;
use crate::threads::Interrupt;
use std::mem::replace;
use std::ops::Range;

/// So many triangles are looked at before it is asked whether the query was interrupted.
const UNINTERRUPTED: usize = 1 << 14;

/// No block.
const NONE: BlockId = BlockId(u32::MAX);

/// The blocks that have triangles at every vertex, one vertex after the other.
pub(super) struct LanesAtVertices {
    starts: Vec<u32>,
    blocks: Vec<BlockId>,
    /// Of each of these blocks, the lanes of the triangles with a corner at the vertex.
    lanes: Vec<u8>,
}

impl LanesAtVertices {
    /// Cost: linear in triangles and vertices. `None` if it was interrupted.
    pub(super) fn new(leaves: &Leaves, order: &Order, interrupt: &Interrupt) -> Option<Self> {
        let mut starts = vec![0; order.used_vertices() + 1];
        // The last block that was seen at each vertex: blocks come in order, so it is new where it is another.
        let mut last = vec![NONE; order.used_vertices()];
        for_each_corner(leaves, order, interrupt, |vertex, block, _| {
            if replace(&mut last[vertex], block) != block {
                starts[vertex + 1] += 1;
            }
        })?;
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // Each start is that of its vertex now; it goes up to that of the next while blocks are put down.
        let count = starts[starts.len() - 1] as usize;
        let (mut blocks, mut lanes) = (vec![BlockId(0); count], vec![0; count]);
        last.fill(NONE);
        for_each_corner(leaves, order, interrupt, |vertex, block, lane| {
            let place = &mut starts[vertex];
            if replace(&mut last[vertex], block) != block {
                blocks[*place as usize] = block;
                *place += 1;
            }
            lanes[*place as usize - 1] |= 1 << lane;
        })?;
        starts.rotate_right(1);
        starts[0] = 0;
        Some(Self {
            starts,
            blocks,
            lanes,
        })
    }

    /// How many blocks have triangles at a vertex.
    pub(super) fn count(&self, vertex: TreeVertex) -> usize {
        self.of(vertex).len()
    }

    /// The blocks at a vertex, in order, and which of their lanes.
    pub(super) fn at(&self, vertex: TreeVertex) -> impl Iterator<Item = (BlockId, u8)> {
        let own = self.of(vertex);
        let blocks = self.blocks[own.clone()].iter().copied();
        blocks.zip(self.lanes[own].iter().copied())
    }

    fn of(&self, vertex: TreeVertex) -> Range<usize> {
        let vertex = vertex.index();
        self.starts[vertex] as usize..self.starts[vertex + 1] as usize
    }
}

/// Calls with the vertex, block and lane of every corner, in the order of blocks. `None` if it was interrupted.
fn for_each_corner(
    leaves: &Leaves,
    order: &Order,
    interrupt: &Interrupt,
    mut corner: impl FnMut(usize, BlockId, usize),
) -> Option<()> {
    for (number, leaf) in leaves.ids().enumerate() {
        if number.is_multiple_of(UNINTERRUPTED / BLOCK_LANES) && interrupt.is_set() {
            return None;
        }
        let triangles = &order.all_corners()[leaves.triangles(leaf)];
        for (block, triangles) in leaves.blocks(leaf).zip(triangles.chunks(BLOCK_LANES)) {
            for (lane, corners) in triangles.iter().enumerate() {
                for vertex in corners {
                    corner(vertex.index(), BlockId(block), lane);
                }
            }
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Topology;

    #[test]
    fn triangles_meet_at_their_corners() {
        // Vertices 3 and 5 are not used, and tree order numbers the others as they come: 4, 1, 2, 0.
        let topology = Topology::new(&[[4, 1, 2], [2, 1, 0], [4, 4, 2]], 6);
        let order = Order::new(&topology, vec![0, 1, 2]);
        let mut leaves = Leaves::new(8, crate::ids::TreeTriangle(0));
        leaves.push(0..1);
        leaves.push(1..3);
        let lanes = LanesAtVertices::new(&leaves, &order, &Interrupt::default()).unwrap();
        let expected: [&[(u32, u8)]; 4] = [
            &[(0, 0b01), (1, 0b10)],
            &[(0, 0b01), (1, 0b01)],
            &[(0, 0b01), (1, 0b11)],
            &[(1, 0b01)],
        ];
        for (vertex, expected) in (0..).map(TreeVertex).zip(expected) {
            let found = lanes.at(vertex).map(|(block, lanes)| (block.0, lanes));
            assert!(found.eq(expected.iter().copied()), "{vertex:?}");
            assert_eq!(lanes.count(vertex), expected.len());
        }
    }
}
