//! Which lanes of which blocks hold the triangles that meet at a vertex: an index of corners the other way round, in memory only while
//! neighbours are looked for.

use super::{BLOCK_LANES, Leaves};
use crate::ids::{BlockId, TreeVertex};
use crate::mesh::Order;
use crate::threads::Interrupt;

/// So many triangles are looked at before it is asked whether the query was interrupted.
const UNINTERRUPTED: usize = 1 << 14;

/// The triangles that meet at every vertex, one vertex after the other; a triangle twice where two of its corners are one vertex.
pub(super) struct LanesAtVertices {
    starts: Vec<u32>,
    /// Eight times the block, and the lane: this fits, for a body has at most 2^28 triangles.
    lanes: Vec<u32>,
}

impl LanesAtVertices {
    /// Cost: linear in triangles and vertices. `None` if it was interrupted.
    pub(super) fn new(leaves: &Leaves, order: &Order, interrupt: &Interrupt) -> Option<Self> {
        let corners = order.all_corners();
        let mut starts = vec![0; order.used_vertices() + 1];
        for triangles in corners.chunks(UNINTERRUPTED) {
            if interrupt.is_set() {
                return None;
            }
            for &vertex in triangles.as_flattened() {
                starts[vertex.index() + 1] += 1;
            }
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // Each start is that of its vertex now; it goes up to that of the next while lanes are put down.
        let mut lanes = vec![0; 3 * corners.len()];
        for (number, leaf) in leaves.ids().enumerate() {
            if number.is_multiple_of(UNINTERRUPTED / BLOCK_LANES) && interrupt.is_set() {
                return None;
            }
            let first = leaves.blocks(leaf).start * BLOCK_LANES as u32;
            for (lane, corners) in (first..).zip(&corners[leaves.triangles(leaf)]) {
                for vertex in corners {
                    let place = &mut starts[vertex.index()];
                    lanes[*place as usize] = lane;
                    *place += 1;
                }
            }
        }
        starts.rotate_right(1);
        starts[0] = 0;
        Some(Self { starts, lanes })
    }

    /// How many corners of triangles are at a vertex.
    pub(super) fn count(&self, vertex: TreeVertex) -> usize {
        self.of(vertex).len()
    }

    /// The blocks and lanes at a vertex, in order.
    pub(super) fn at(&self, vertex: TreeVertex) -> impl Iterator<Item = (BlockId, u32)> {
        const LANES: u32 = BLOCK_LANES as u32;
        self.of(vertex)
            .iter()
            .map(|&lane| (BlockId(lane / LANES), lane % LANES))
    }

    fn of(&self, vertex: TreeVertex) -> &[u32] {
        let vertex = vertex.index();
        &self.lanes[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
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
        let mut leaves = Leaves::new(8);
        leaves.push(0..1);
        leaves.push(1..3);
        let lanes = LanesAtVertices::new(&leaves, &order, &Interrupt::default()).unwrap();
        let expected: [&[(u32, u32)]; 4] = [
            &[(0, 0), (1, 1), (1, 1)],
            &[(0, 0), (1, 0)],
            &[(0, 0), (1, 0), (1, 1)],
            &[(1, 0)],
        ];
        for (vertex, expected) in (0..).map(TreeVertex).zip(expected) {
            let found = lanes.at(vertex).map(|(block, lane)| (block.0, lane));
            assert!(found.eq(expected.iter().copied()), "{vertex:?}");
            assert_eq!(lanes.count(vertex), expected.len());
        }
    }
}
