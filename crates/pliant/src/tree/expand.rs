//! Expansion of node pairs: to pairs of their children that overlap, or to a pair of leaves.
//!
//! Trees are of one degree, which is matched on once a batch (`boxes/lanes.rs`).

use super::rims::GrownRims;
use super::{BoxSet, Child, Neighbours, Nodes, Rims, STRICT_UPPER, Tree, of_degree};
use crate::geometry::Aabb;
use crate::held::held;
use crate::ids::{LeafId, NodeId, WideNodeId};
use crate::kernels::{
    BoxLanes, Buffer, EightCapsules, Instructions, Simd, Volumes, cull_by_capsules, dispatch,
    overlap_mask,
};

/// Two nodes whose boxes are valid and overlap, or a node with itself.
pub(crate) type NodePair = [NodeId; 2];

/// Two leaves whose boxes overlap, or a leaf with itself.
pub(crate) type LeafPair = [LeafId; 2];

/// Tree and a set of its boxes: all that a walk reads of a body.
#[derive(Clone, Copy)]
pub(crate) struct BoxedTree<'t> {
    pub(crate) tree: &'t Tree,
    pub(crate) boxes: &'t BoxSet,
    /// Whether what capsules show to be apart is left out.
    pub(crate) culls_by_capsules: bool,
    /// Rims, for kinds that look at elements.
    pub(crate) rims: Option<&'t Rims>,
}

impl<'t> BoxedTree<'t> {
    /// Capsules of the nodes of every wide node, if there are any and they count.
    #[inline]
    fn node_capsules(self) -> Option<&'t [EightCapsules]> {
        self.boxes
            .node_capsules()
            .filter(|_| self.culls_by_capsules)
    }

    /// Capsules of the triangles of every block, if there are any and they count.
    #[inline]
    pub(crate) fn block_capsules(self) -> Option<&'t [EightCapsules]> {
        self.boxes
            .block_capsules()
            .filter(|_| self.culls_by_capsules)
    }
}

/// Boxes and capsules of the nodes of every wide node of a tree, and its rims if it meets itself.
#[derive(Clone, Copy)]
struct NodeVolumes<'t, const N: usize> {
    boxes: &'t [BoxLanes<N>],
    capsules: Option<&'t [EightCapsules]>,
    rims: Option<GrownRims<'t>>,
}

impl<'t, const N: usize> NodeVolumes<'t, N> {
    fn of(self, wide_node: WideNodeId) -> Volumes<'t, N> {
        Volumes {
            boxes: &self.boxes[wide_node.index()],
            capsules: self.capsules.map(|all| &all[wide_node.index()]),
        }
    }

    /// Clears the bits of pairs that capsules show to be apart, or that rims leave out.
    ///
    /// The nodes are of a wide node of this tree and of one of another. Not inlined, so that trees
    /// without either lose nothing.
    #[inline(never)]
    fn cull<I: Simd>(
        self,
        i: I,
        wide_node: WideNodeId,
        (other, of_other): (Self, WideNodeId),
        pairs: u64,
    ) -> u64 {
        let mut left = pairs;
        if let Some(rims) = self.rims {
            let (a, b) = (self.of(wide_node).boxes, other.of(of_other).boxes);
            let mut pairs = pairs;
            while pairs != 0 {
                let bit = pairs.trailing_zeros();
                let [lane_a, lane_b] = [bit as usize / 8, bit as usize % 8];
                let nodes = [
                    NodeId::new(wide_node, lane_a),
                    NodeId::new(of_other, lane_b),
                ];
                if rims.leave_out(nodes, [a.get(lane_a), b.get(lane_b)]) {
                    left &= !(1 << bit);
                }
                pairs &= pairs - 1;
            }
        }
        if self.capsules.is_none() && other.capsules.is_none() {
            return left;
        }
        cull_by_capsules(i, self.of(wide_node), other.of(of_other), left)
    }

    /// As [`cull`](Self::cull), of one node of this tree.
    #[inline(never)]
    fn cull_one<I: Simd>(self, i: I, node: NodeId, other: (Self, WideNodeId), lanes: u64) -> u64 {
        let (wide_node, lane) = node.wide_node_and_lane();
        self.cull(i, wide_node, other, lanes << (8 * lane)) >> (8 * lane)
    }
}

/// Eight consecutive leaves, and a bit for each that is in a pair.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ReachedLeaves {
    pub(crate) first: LeafId,
    pub(crate) lanes: u8,
}

/// Mask of the pairs (i, i) of eight lanes; a pair (i, j) is bit 8 i + j.
const DIAGONAL: u64 = 0x8040_2010_0804_0201;

/// Work lists of a task: the stack of node pairs, and the list of leaf pairs.
#[derive(Debug, Default)]
pub(crate) struct Worklists {
    /// Stack of node pairs that are still to be expanded.
    pub(crate) nodes: Buffer<NodePair>,
    /// Leaf pairs that are still to be tested.
    pub(crate) leaves: Buffer<LeafPair>,
    /// Leaves in the new leaf pairs, for either tree; some perhaps more than once.
    pub(crate) reached: [Buffer<ReachedLeaves>; 2],
    /// Counter of expanded node pairs, and of leaf pairs that went straight onto their list.
    pub(crate) node_pairs: u64,
}

impl Worklists {
    /// Empties all lists and the counter.
    pub(crate) fn clear(&mut self) {
        self.nodes.clear();
        self.clear_leaves();
        self.node_pairs = 0;
    }

    /// Empties the lists of leaves.
    pub(crate) fn clear_leaves(&mut self) {
        self.leaves.clear();
        self.reached.iter_mut().for_each(Buffer::clear);
    }
}

/// Expands every pair of a batch, of two trees or of one with itself.
///
/// The boxes below the nodes are valid. Leaves that are neighbours according to `left_out` may be
/// left out.
pub(crate) fn expand(
    instructions: Instructions,
    trees: [BoxedTree<'_>; 2],
    is_itself: bool,
    batch: &[NodePair],
    left_out: Option<&Neighbours>,
    found: &mut Worklists,
) {
    let of = trees.map(|it| it.tree);
    let capsules = trees.map(BoxedTree::node_capsules);
    let rims = trees[0].rims.filter(|rims| is_itself && rims.are_any());
    let rims = rims.map(|rims| GrownRims {
        rims,
        tree: trees[0].tree,
        grown_by: trees[0].boxes.grown_by(),
    });
    let is_culled = rims.is_some() || capsules.iter().any(Option::is_some);
    of_degree!([trees[0].boxes.nodes(), trees[1].boxes.nodes()], boxes => {
        let volumes = is_culled.then(|| [0, 1].map(|which| NodeVolumes {
            boxes: boxes[which],
            capsules: capsules[which],
            rims,
        }));
        let volumes = volumes.as_ref();
        dispatch!(instructions, i => if is_itself {
            expand_all::<_, _, true>(i, of, boxes, volumes, batch, left_out, found);
        } else {
            expand_all::<_, _, false>(i, of, boxes, volumes, batch, left_out, found);
        });
    });
}

/// [`expand`] for one instruction set, one degree, and two trees or one.
#[inline(always)]
fn expand_all<I: Simd, const N: usize, const ITSELF: bool>(
    i: I,
    [a, b]: [&Tree; 2],
    [boxes_a, boxes_b]: [&[BoxLanes<N>]; 2],
    volumes: Option<&[NodeVolumes<N>; 2]>,
    batch: &[NodePair],
    left_out: Option<&Neighbours>,
    found: &mut Worklists,
) {
    let Worklists {
        nodes,
        leaves,
        reached,
        node_pairs,
    } = found;
    *node_pairs += batch.len() as u64;
    let (nodes_a, nodes_b) = (a.nodes(), b.nodes());
    for &[node_a, node_b] in batch {
        match (nodes_a.child(node_a), nodes_b.child(node_b)) {
            (Child::Leaf(leaf_a), Child::Leaf(leaf_b)) => {
                if let Some(known) = left_out
                    && known.are_neighbours(i, leaf_a, leaf_b)
                {
                    continue;
                }
                leaves.push([leaf_a, leaf_b]);
                for (reached, first) in reached.iter_mut().zip([leaf_a, leaf_b]) {
                    reached.push(ReachedLeaves { first, lanes: 1 });
                }
            }
            (Child::Leaf(_), Child::Inner(below)) => {
                let mut mask = boxes_b[below.index()].overlaps(&one_box(boxes_a, node_a));
                if let Some([a, b]) = volumes {
                    mask = a.cull_one(i, node_a, (*b, below), mask);
                }
                nodes
                    .room()
                    .push_bits(mask, |lane| [node_a, NodeId::new(below, lane as usize)]);
            }
            (Child::Inner(below), Child::Leaf(_)) => {
                let mut mask = boxes_a[below.index()].overlaps(&one_box(boxes_b, node_b));
                if let Some([a, b]) = volumes {
                    mask = b.cull_one(i, node_b, (*a, below), mask);
                }
                nodes
                    .room()
                    .push_bits(mask, |lane| [NodeId::new(below, lane as usize), node_b]);
            }
            (Child::Inner(below_a), Child::Inner(below_b)) => {
                if left_out.is_some_and(|known| are_one_fan(nodes_a, known, [node_a, node_b])) {
                    continue;
                }
                let (wide_a, wide_b) = (nodes_a.wide(below_a), nodes_b.wide(below_b));
                let (boxes_a, boxes_b) = (&boxes_a[below_a.index()], &boxes_b[below_b.index()]);
                if let (Some(first_a), Some(first_b)) = (wide_a.first_leaf, wide_b.first_leaf) {
                    // Leaves side by side: their pairs need not go over the stack. Where some are
                    // left out all boxes are valid: then no leaf is to be refitted.
                    let mut left = u64::MAX;
                    if let Some(known) = left_out {
                        left = !known.among_leaves(i, below_a, below_b);
                    }
                    let mut lanes = [0; 2];
                    let mut asked = u64::MAX;
                    if ITSELF && node_a == node_b {
                        let len = wide_a.len() as u32;
                        let mut alone = DIAGONAL & left & u64::MAX >> (64 - 8 * len);
                        while alone != 0 {
                            let lane = alone.trailing_zeros() / 8;
                            leaves.push([first_a.plus(lane); 2]);
                            lanes[0] |= 1 << lane;
                            alone &= alone - 1;
                        }
                        *node_pairs += u64::from(len);
                        asked = STRICT_UPPER;
                    }
                    let room = leaves.room();
                    let mask = overlap_mask(i, boxes_a, boxes_b) & asked;
                    *node_pairs += u64::from(mask.count_ones());
                    let mut mask = mask & left;
                    if let Some([a, b]) = volumes {
                        mask = a.cull(i, below_a, (*b, below_b), mask);
                    }
                    room.push_bits(mask, |bit| [first_a.plus(bit / 8), first_b.plus(bit % 8)]);
                    if left_out.is_some() {
                        continue;
                    }
                    lanes[0] |= rows_of(mask);
                    lanes[1] |= columns_of(mask);
                    for (which, first) in [first_a, first_b].into_iter().enumerate() {
                        let lanes = lanes[which];
                        reached[which].push(ReachedLeaves { first, lanes });
                    }
                    continue;
                }
                let mut asked = u64::MAX;
                if ITSELF && node_a == node_b {
                    // Each child with itself, whatever its box, and with each later one.
                    for lane in 0..wide_a.len() {
                        nodes.push([NodeId::new(below_a, lane); 2]);
                    }
                    asked = STRICT_UPPER;
                }
                let room = nodes.room();
                let mut mask = overlap_mask(i, boxes_a, boxes_b) & asked;
                if let Some([a, b]) = volumes {
                    mask = a.cull(i, below_a, (*b, below_b), mask);
                }
                let node = |below, lane| NodeId::new(below, lane as usize);
                room.push_bits(mask, |bit| [node(below_a, bit / 8), node(below_b, bit % 8)]);
            }
        }
    }
}

/// Whether all triangles below two nodes of a tree share a vertex, as far as it is known. Not
/// inlined, so that trees without fans lose nothing.
#[inline(never)]
fn are_one_fan(nodes: Nodes, known: &Neighbours, pair: NodePair) -> bool {
    let fans = known.fans();
    fans.is_some_and(|fans| fans.are_one(pair.map(|node| nodes.number_of(node))))
}

/// Box of one node.
#[inline(always)]
fn one_box<const N: usize>(boxes: &[BoxLanes<N>], node: NodeId) -> Aabb {
    let (wide_node, lane) = node.wide_node_and_lane();
    boxes[wide_node.index()].get(lane % N)
}

/// Set of the i in a mask of pairs (i, j) of eight lanes, bit 8 i + j.
fn rows_of(mask: u64) -> u8 {
    let mut rows = mask | mask >> 4;
    rows |= rows >> 2;
    rows |= rows >> 1;
    // Bit 0 of byte i says whether i is in a pair; the product moves it to bit i of the highest
    // byte.
    ((rows & 0x0101_0101_0101_0101).wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8
}

/// Set of the j in a mask of pairs (i, j) of eight lanes, bit 8 i + j.
fn columns_of(mask: u64) -> u8 {
    mask.to_le_bytes()
        .into_iter()
        .fold(0, |columns, row| columns | row)
}

held!(Worklists: nodes, leaves, reached);

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
