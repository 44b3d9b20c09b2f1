//! What a pair of nodes becomes: pairs of their children, or candidate pairs of triangles.

use crate::kernels::{bits::Batch, overlap_mask};
use crate::mesh::Mesh;
use crate::pairs::{Candidate, LeafPair, NodePair};
use crate::tree::{Below, LEAF_LANES, Leaves, NodeId, Tree};
use fearless_simd::Simd;

/// Of the pairs (i, j) of eight lanes, bit 8 i + j, those with j > i.
const LATER_LANES: u64 = {
    let (mut mask, mut lane) = (0, 0);
    while lane < 8 {
        mask |= (0xff << (lane + 1) & 0xff) << (8 * lane);
        lane += 1;
    }
    mask
};

/// Pairs of children that overlap onto `nodes`, pairs of leaves onto `leaves`, for every pair of a batch. What is below the
/// nodes is true.
#[inline(always)]
pub(super) fn expand<I: Simd, const N: usize, const ITSELF: bool>(
    i: I,
    [a, b]: [&Tree<N>; 2],
    batch: &[NodePair],
    nodes: &mut Batch<NodePair>,
    leaves: &mut Vec<LeafPair>,
) {
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
}

/// A place in the list of pairs of leaves: a pair, a block of its first leaf, a block of its second.
pub(super) type Place = (usize, usize, usize);

/// Candidates of pairs of leaves, from a place on, until there are `enough`; returns the place where it stopped. They are the
/// pairs of triangles whose boxes overlap; within one body those that share no vertex.
#[inline(always)]
pub(super) fn candidates<I: Simd, const ITSELF: bool>(
    i: I,
    [a, b]: [&Leaves; 2],
    mesh: &Mesh,
    pairs: &[LeafPair],
    (first_pair, mut block_a, mut block_b): Place,
    found: &mut Batch<Candidate>,
    enough: usize,
) -> Place {
    if !a.have_boxes() {
        // One triangle a leaf: its box is the leaf's, which overlaps. With itself it shares its vertices.
        for pair in pairs {
            let [a, b] = [a.triangles(pair[0]).start, b.triangles(pair[1]).start];
            if !ITSELF || !mesh.share_a_vertex(a, b) {
                found.push([a, b]);
            }
        }
        return (pairs.len(), 0, 0);
    }
    for (place, &[leaf_a, leaf_b]) in pairs.iter().enumerate().skip(first_pair) {
        let (blocks_a, blocks_b) = (a.boxes(leaf_a), b.boxes(leaf_b));
        let (start_a, start_b) = (a.triangles(leaf_a).start, b.triangles(leaf_b).start);
        while block_a < blocks_a.len() {
            while block_b < blocks_b.len() {
                if found.len() >= enough {
                    return (place, block_a, block_b);
                }
                let first_a = start_a + (block_a * LEAF_LANES) as u32;
                let first_b = start_b + (block_b * LEAF_LANES) as u32;
                let pair = |bit: u32| [first_a + bit / 8, first_b + bit % 8];
                let room = found.room();
                let overlaps = overlap_mask(i, &blocks_a[block_a], &blocks_b[block_b]);
                if ITSELF {
                    // Within one leaf, each pair of triangles once, and none with itself.
                    let wanted = match block_b.cmp(&block_a) {
                        _ if leaf_a != leaf_b => u64::MAX,
                        std::cmp::Ordering::Less => 0,
                        std::cmp::Ordering::Equal => LATER_LANES,
                        std::cmp::Ordering::Greater => u64::MAX,
                    };
                    room.push_bits_if(overlaps & wanted, pair, |[a, b]| !mesh.share_a_vertex(a, b));
                } else {
                    room.push_bits(overlaps, pair);
                }
                block_b += 1;
            }
            (block_a, block_b) = (block_a + 1, 0);
        }
        (block_a, block_b) = (0, 0);
    }
    (pairs.len(), 0, 0)
}
