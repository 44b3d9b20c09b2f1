//! Inverse index of corners: the blocks, and their lanes, that hold the triangles at each vertex.
//!
//! In memory only while neighbours are looked for.

use super::{BLOCK_LANES, Leaves};
use crate::held::held;
use crate::ids::{BlockId, LeafId, TreeVertex};
use crate::mesh::Order;
use crate::threads::Budget;
use std::mem::replace;

/// Leaves between two checks of the budget.
const AT_ONCE: usize = 64;
/// Looks of the budget that a triangle takes.
const LOOKS: usize = 2;

/// Sentinel: no block.
const NONE: BlockId = BlockId(u32::MAX);

/// Blocks with triangles at each vertex, in compressed sparse rows (CSR); made some leaves at a
/// time.
pub(super) struct LanesAtVertices {
    /// Where the row of each vertex begins, and the end of the last.
    starts: Vec<u32>,
    /// Blocks of all rows, one row after the other, ascending in each. With each go the lanes of
    /// its triangles that have a corner at the vertex.
    blocks: Vec<(BlockId, u8)>,
    stage: Stage,
    /// First leaf that was not gone through in this stage.
    next: usize,
    /// Last block seen at each vertex. Blocks come in order, so another block is a new one.
    last: Vec<BlockId>,
}

/// Stage of the construction: a two-pass counting sort.
#[derive(PartialEq)]
enum Stage {
    /// First pass: counts the blocks at each vertex, in the place behind its start.
    Counting,
    /// Second pass: puts blocks down. Each start moves up to where the next row begins.
    Filling,
    Done,
}

impl LanesAtVertices {
    /// Begins the index of a mesh in tree order.
    pub(super) fn new(order: &Order) -> Self {
        Self {
            starts: vec![0; order.used_vertices() + 1],
            blocks: Vec::new(),
            stage: Stage::Counting,
            next: 0,
            last: vec![NONE; order.used_vertices()],
        }
    }

    /// Continues with the same leaves and order; returns whether it is done.
    ///
    /// Cost in all: linear in triangles and vertices.
    #[inline(never)]
    pub(super) fn advance(&mut self, leaves: &Leaves, order: &Order, budget: &mut Budget) -> bool {
        let (starts, last, next) = (&mut self.starts, &mut self.last, &mut self.next);
        if self.stage == Stage::Counting {
            let is_done = for_each_corner(leaves, order, next, budget, |vertex, block, _| {
                if replace(&mut last[vertex], block) != block {
                    starts[vertex + 1] += 1;
                }
            });
            if !is_done {
                return false;
            }
            for vertex in 1..starts.len() {
                starts[vertex] += starts[vertex - 1];
            }
            let count = starts[starts.len() - 1] as usize;
            self.blocks = vec![(NONE, 0); count];
            last.fill(NONE);
            (self.stage, *next) = (Stage::Filling, 0);
        }
        if self.stage == Stage::Filling {
            let blocks = &mut self.blocks;
            let is_done = for_each_corner(leaves, order, next, budget, |vertex, block, lane| {
                let place = &mut starts[vertex];
                if replace(&mut last[vertex], block) != block {
                    blocks[*place as usize].0 = block;
                    *place += 1;
                }
                blocks[*place as usize - 1].1 |= 1 << lane;
            });
            if !is_done {
                return false;
            }
            starts.rotate_right(1);
            starts[0] = 0;
            (self.stage, *last) = (Stage::Done, Vec::new());
        }
        true
    }

    /// Returns the blocks at a vertex, ascending, each with its lanes there. O(1).
    #[inline]
    pub(super) fn at(&self, vertex: TreeVertex) -> &[(BlockId, u8)] {
        let vertex = vertex.index();
        &self.blocks[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

/// Calls `corner` with the vertex, block and lane of each corner, from leaf `next` on, by ascending
/// blocks.
///
/// Returns whether all leaves were gone through; if not, `next` is the first that was not.
fn for_each_corner(
    leaves: &Leaves,
    order: &Order,
    next: &mut usize,
    budget: &mut Budget,
    mut corner: impl FnMut(usize, BlockId, usize),
) -> bool {
    while *next < leaves.len() {
        if budget.is_spent() {
            return false;
        }
        for leaf in (*next..leaves.len().min(*next + AT_ONCE)).map(|leaf| LeafId(leaf as u32)) {
            let triangles = &order.all_corners()[leaves.triangles(leaf)];
            budget.spend(LOOKS * triangles.len());
            for (block, triangles) in leaves.blocks(leaf).zip(triangles.chunks(BLOCK_LANES)) {
                for (lane, corners) in triangles.iter().enumerate() {
                    for vertex in corners {
                        corner(vertex.index(), BlockId(block), lane);
                    }
                }
            }
        }
        *next = leaves.len().min(*next + AT_ONCE);
    }
    true
}

held!(LanesAtVertices: starts[], blocks[], last[]);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Topology;

    #[test]
    fn triangles_meet_at_their_corners() {
        // Vertices 3 and 5 are not used. Tree order numbers the others as they come: 4, 1, 2, 0.
        let topology = Topology::new(&[[4, 1, 2], [2, 1, 0], [4, 4, 2]], 6);
        let order = Order::new(&topology, vec![0, 1, 2]);
        let mut leaves = Leaves::new(8, crate::ids::TreeTriangle(0));
        leaves.push(0..1);
        leaves.push(1..3);
        let mut lanes = LanesAtVertices::new(&order);
        // A budget of one look is enough to get on.
        while !lanes.advance(&leaves, &order, &mut Budget::of(1)) {}
        let expected: [&[(u32, u8)]; 4] = [
            &[(0, 0b01), (1, 0b10)],
            &[(0, 0b01), (1, 0b01)],
            &[(0, 0b01), (1, 0b11)],
            &[(1, 0b01)],
        ];
        for (vertex, expected) in (0..).map(TreeVertex).zip(expected) {
            let found = lanes.at(vertex).iter();
            let found = found.map(|&(block, lanes)| (block.0, lanes));
            assert!(found.eq(expected.iter().copied()), "{vertex:?}");
        }
    }
}
