//! What a pair of nodes becomes: pairs of their children that overlap, or a pair of leaves.

use crate::kernels::{bits::Batch, overlap_mask};
use crate::pairs::{LeafPair, NodePair};
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

/// Pairs of children that overlap onto `nodes`, pairs of leaves onto `leaves`, for every pair of a batch. What is below the
/// nodes is true. Returns how many pairs of leaves went straight onto their list, without being pairs of nodes on the stack.
#[inline(always)]
pub(super) fn expand<I: Simd, const N: usize, const ITSELF: bool>(
    i: I,
    [a, b]: [&Tree<N>; 2],
    batch: &[NodePair],
    nodes: &mut Batch<NodePair>,
    leaves: &mut Batch<LeafPair>,
) -> u64 {
    let mut straight = 0;
    for &[node_a, node_b] in batch {
        match (a.child(node_a).below(), b.child(node_b).below()) {
            (Below::Leaf(leaf_a), Below::Leaf(leaf_b)) => leaves.push([leaf_a, leaf_b]),
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
                    let mut wanted = u64::MAX;
                    if ITSELF && node_a == node_b {
                        for lane in 0..group_a.len() as u32 {
                            leaves.push([first_a + lane; 2]);
                        }
                        wanted = LATER_LANES;
                    }
                    let room = leaves.room();
                    let mask = overlap_mask(i, &group_a.boxes, &group_b.boxes) & wanted;
                    room.push_bits(mask, |bit| [first_a + bit / 8, first_b + bit % 8]);
                    straight += (leaves.len() - before) as u64;
                    continue;
                }
                let mut wanted = u64::MAX;
                if ITSELF && node_a == node_b {
                    // Every child with itself, whatever its box, and with each later one.
                    for lane in 0..group_a.len() as u32 {
                        nodes.push([NodeId::new::<N>(below_a, lane as usize); 2]);
                    }
                    wanted = LATER_LANES;
                }
                let room = nodes.room();
                let mask = overlap_mask(i, &group_a.boxes, &group_b.boxes) & wanted;
                room.push_bits(mask, |bit| {
                    [
                        NodeId::new::<N>(below_a, bit as usize / 8),
                        NodeId::new::<N>(below_b, bit as usize % 8),
                    ]
                });
            }
        }
    }
    straight
}
