//! What a pair of nodes becomes: pairs of their children that overlap, or a pair of leaves.

use crate::kernels::{bits::Batch, overlap_mask};
use crate::pairs::{LeafPair, NodePair, WantedLeaves};
use crate::tree::{Below, NodeId, Tree};
use fearless_simd::Simd;

/// Of the pairs (i, j) of eight lanes, bit 8 i + j, those with j > i.
pub(super) const LATER_LANES: u64 = {
    let (mut mask, mut lane) = (0, 0);
    while lane < 8 {
        mask |= (0xff << (lane + 1) & 0xff) << (8 * lane);
        lane += 1;
    }
    mask
};

/// What pairs of nodes became.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// Pairs of children that overlap.
    pub(super) nodes: Batch<NodePair>,
    /// Pairs of leaves.
    pub(super) leaves: Batch<LeafPair>,
    /// The leaves in these pairs, some perhaps more than once, of either tree.
    pub(super) wanted: [Batch<WantedLeaves>; 2],
    /// How many pairs of nodes were expanded, with those of leaves that went straight onto their list.
    pub(super) node_pairs: u64,
}

impl Found {
    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.clear_leaves();
        self.node_pairs = 0;
    }

    pub(super) fn clear_leaves(&mut self) {
        self.leaves.clear();
        self.wanted.iter_mut().for_each(Batch::clear);
    }
}

/// Expands every pair of a batch. What is below the nodes is true.
#[inline(always)]
pub(super) fn expand<I: Simd, const N: usize, const ITSELF: bool>(
    i: I,
    [a, b]: [&Tree<N>; 2],
    batch: &[NodePair],
    found: &mut Found,
) {
    let Found {
        nodes,
        leaves,
        wanted,
        node_pairs,
    } = found;
    *node_pairs += batch.len() as u64;
    for &[node_a, node_b] in batch {
        match (a.child(node_a).below(), b.child(node_b).below()) {
            (Below::Leaf(leaf_a), Below::Leaf(leaf_b)) => {
                leaves.push([leaf_a, leaf_b]);
                for (wanted, first) in wanted.iter_mut().zip([leaf_a, leaf_b]) {
                    wanted.push(WantedLeaves { first, lanes: 1 });
                }
            }
            (Below::Leaf(_), Below::Group(below)) => {
                let mask = b.groups[below as usize].boxes.overlaps(&a.box_of(node_a));
                nodes.room().push_bits(mask, |lane| {
                    [node_a, NodeId::new::<N>(below, lane as usize)]
                });
            }
            (Below::Group(below), Below::Leaf(_)) => {
                let mask = a.groups[below as usize].boxes.overlaps(&b.box_of(node_b));
                nodes.room().push_bits(mask, |lane| {
                    [NodeId::new::<N>(below, lane as usize), node_b]
                });
            }
            (Below::Group(below_a), Below::Group(below_b)) => {
                let (group_a, group_b) = (&a.groups[below_a as usize], &b.groups[below_b as usize]);
                if let (Some(first_a), Some(first_b)) = (group_a.first_leaf, group_b.first_leaf) {
                    // Leaves side by side: their pairs need not go over the stack.
                    let before = leaves.len();
                    let mut lanes = [0; 2];
                    let mut asked = u64::MAX;
                    if ITSELF && node_a == node_b {
                        for lane in 0..group_a.len() as u32 {
                            leaves.push([first_a + lane; 2]);
                            lanes[0] |= 1 << lane;
                        }
                        asked = LATER_LANES;
                    }
                    let room = leaves.room();
                    let mask = overlap_mask(i, &group_a.boxes, &group_b.boxes) & asked;
                    room.push_bits(mask, |bit| [first_a + bit / 8, first_b + bit % 8]);
                    *node_pairs += (leaves.len() - before) as u64;
                    lanes[0] |= rows_of(mask);
                    lanes[1] |= columns_of(mask);
                    for (which, first) in [first_a, first_b].into_iter().enumerate() {
                        let lanes = lanes[which];
                        wanted[which].push(WantedLeaves { first, lanes });
                    }
                    continue;
                }
                let mut asked = u64::MAX;
                if ITSELF && node_a == node_b {
                    // Every child with itself, whatever its box, and with each later one.
                    for lane in 0..group_a.len() as u32 {
                        nodes.push([NodeId::new::<N>(below_a, lane as usize); 2]);
                    }
                    asked = LATER_LANES;
                }
                let room = nodes.room();
                let mask = overlap_mask(i, &group_a.boxes, &group_b.boxes) & asked;
                room.push_bits(mask, |bit| {
                    [
                        NodeId::new::<N>(below_a, bit as usize / 8),
                        NodeId::new::<N>(below_b, bit as usize % 8),
                    ]
                });
            }
        }
    }
}

/// Of pairs (i, j) of eight lanes, bit 8 i + j, the i.
fn rows_of(mask: u64) -> u8 {
    let mut rows = mask | mask >> 4;
    rows |= rows >> 2;
    rows |= rows >> 1;
    // Bit 0 of byte i is whether there is an i; the product moves it to bit i of the highest byte.
    ((rows & 0x0101_0101_0101_0101).wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8
}

/// Of pairs (i, j) of eight lanes, bit 8 i + j, the j.
fn columns_of(mask: u64) -> u8 {
    mask.to_le_bytes()
        .into_iter()
        .fold(0, |columns, row| columns | row)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_of_pairs() {
        for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
            let pair = 1_u64 << (8 * i + j);
            assert_eq!((rows_of(pair), columns_of(pair)), (1 << i, 1 << j));
            let two = pair | 1 << 35;
            assert_eq!(
                (rows_of(two), columns_of(two)),
                (1 << i | 1 << 4, 1 << j | 1 << 3)
            );
        }
        assert_eq!((rows_of(0), columns_of(0)), (0, 0));
    }
}
