//! Table of neighbours: triangles of a body that share a vertex, block by block, for
//! self-collision.
//!
//! Triangles that share a vertex always touch, and are no answer. The mesh of a tree stays, so the
//! pairs to compare between two neighbouring blocks are known beforehand, as a mask. Blocks that
//! are neighbours overlap in any shape, because both hold a vertex. So where leaves are blocks, a
//! traversal need not find neighbours: they are gone through list by list. Blocks with too many
//! neighbours are *crowded* and have no list, for masks would take memory by the square
//! ([`Neighbours::is_crowded`]).

use super::fans::Fans;
use super::lanes_at_vertices::LanesAtVertices;
use super::{BLOCK_LANES, Leaves, WideNode};
use crate::held::held;
use crate::ids::{BlockId, LeafId, TreeTriangle, WideNodeId};
use crate::kernels::{Simd, find_lane};
use crate::mesh::Order;
use crate::threads::Budget;
use std::ops::Range;
use std::sync::Arc;

/// Most later neighbours of a block that is not crowded. On a surface there are about five.
const MOST_NEIGHBOURS: usize = 32;
/// Most blocks at a vertex of a block that is not crowded: only so far are they looked through.
const MOST_AT_A_VERTEX: usize = 64;

/// Looks of the budget that the lists of a triangle take.
const LOOKS: usize = 10;

/// Mask of the pairs (i, j) of eight lanes with j > i; a pair is bit 8 i + j.
pub(crate) const STRICT_UPPER: u64 = {
    let (mut mask, mut lane) = (0, 0);
    while lane < 8 {
        mask |= (0xff << (lane + 1) & 0xff) << (8 * lane);
        lane += 1;
    }
    mask
};

/// Lists of lane pairs between numbered things of up to eight lanes each (CSR).
///
/// Each thing's list begins with itself; later things follow.
#[derive(Clone, Debug)]
struct LaneLists {
    /// Where the list of each thing begins, and the end of the last.
    starts: Vec<u32>,
    /// Things of all lists, then seven numbers that no thing has, so that eight can be read at
    /// once.
    others: Vec<u32>,
    /// For each entry of `others`, the mask of lane pairs with it.
    masks: Vec<u64>,
}

impl LaneLists {
    /// Allocates for `things` lists with `others` entries in all.
    fn with_capacity(things: usize, others: usize) -> Self {
        let mut starts = Vec::with_capacity(things + 1);
        starts.push(0);
        Self {
            starts,
            others: Vec::with_capacity(others + 7),
            masks: Vec::with_capacity(others),
        }
    }

    /// Appends the list of the next thing.
    fn push(&mut self, list: &[(u32, u64)]) {
        self.others.extend(list.iter().map(|&(thing, _)| thing));
        self.masks.extend(list.iter().map(|&(_, mask)| mask));
        self.starts.push(self.masks.len() as u32);
    }

    /// Pads the end, and gives back unused memory.
    fn finish(&mut self) {
        self.others.extend([u32::MAX; 7]);
        self.others.shrink_to_fit();
        self.masks.shrink_to_fit();
    }

    /// Returns the places of the list of a thing.
    #[inline(always)]
    fn list(&self, thing: u32) -> Range<usize> {
        let [start, end] = [thing as usize, thing as usize + 1].map(|place| self.starts[place]);
        start as usize..end as usize
    }

    /// Returns the lane pairs of thing `a` with `b`, which is not before it, if `b` is on its list.
    #[inline(always)]
    fn get<I: Simd>(&self, i: I, a: u32, b: u32) -> Option<u64> {
        let list = self.list(a);
        let mut mask = None;
        for place in list.clone().step_by(8) {
            let eight = self.others[place..]
                .first_chunk()
                .expect("the end is padded");
            // Lanes behind the list belong to the next one.
            let own = 0xff >> 8_usize.saturating_sub(list.end - place);
            let found = find_lane(i, eight, b) & own;
            if found != 0 {
                mask = Some(self.masks[place + found.trailing_zeros() as usize]);
            }
        }
        mask
    }
}

/// Neighbours of all blocks of a tree, and of its wide nodes of leaves.
///
/// On a surface a block of eight triangles has about ten neighbours. Half of them come later, and
/// are on its list. Masks are in the order of [`overlap_mask`](crate::kernels::overlap_mask).
#[derive(Clone, Debug)]
pub(crate) struct Neighbours {
    /// For each block that is not crowded: the pairs of triangles to compare, because they share no
    /// vertex. Within a block, each pair once.
    of_blocks: LaneLists,
    /// For each wide node of leaves that are blocks: the pairs of leaves that are neighbours and
    /// not crowded. A leaf is its own neighbour.
    of_wide_nodes: LaneLists,
    /// Fans, if any block is crowded. The tree has them too.
    fans: Option<Arc<Fans>>,
}

impl Neighbours {
    /// Returns the mask of triangle pairs to compare: bit 8 i + j for triangle i of `a` and j of
    /// `b`.
    ///
    /// Pairs that share a vertex are left out. Within one block each pair is there once. `None` if
    /// the pairs are not known. Unused lanes are in no pair of neighbours; between other blocks
    /// they may be.
    #[inline(always)]
    pub(crate) fn compared<I: Simd>(&self, i: I, a: BlockId, b: BlockId) -> Option<u64> {
        let known = a <= b && !self.is_crowded(a);
        known.then(|| self.of_blocks.get(i, a.0, b.0).unwrap_or(u64::MAX))
    }

    /// Whether a block is crowded: it has too many neighbours, and no list of them.
    ///
    /// Crowded blocks are found by their boxes, like strangers. Corners are compared when their
    /// triangles are. Nodes of one fan (`fans`) are left out.
    #[inline(always)]
    pub(crate) fn is_crowded(&self, block: BlockId) -> bool {
        self.of_blocks.list(block.0).is_empty()
    }

    /// Whether any block is crowded.
    pub(super) fn is_any_crowded(&self) -> bool {
        let blocks = self.of_blocks.starts.len() - 1;
        (0..blocks as u32).any(|block| self.is_crowded(BlockId(block)))
    }

    /// Takes the fans of the tree.
    pub(super) fn take_fans(&mut self, fans: Arc<Fans>) {
        self.fans = Some(fans);
    }

    /// Returns the fans, if any block is crowded.
    #[inline(always)]
    pub(super) fn fans(&self) -> Option<&Fans> {
        self.fans.as_deref()
    }

    /// Returns a block and its later neighbours, with the mask of triangle pairs to compare with
    /// each.
    ///
    /// Empty for a crowded block.
    #[inline(always)]
    pub(crate) fn of_block(&self, block: BlockId) -> (&[u32], &[u64]) {
        let list = self.of_blocks.list(block.0);
        (
            &self.of_blocks.others[list.clone()],
            &self.of_blocks.masks[list],
        )
    }

    /// Whether [`of_block`](Self::of_block) names a pair of leaves, or a leaf with itself. For
    /// leaves that are blocks.
    #[inline(always)]
    pub(crate) fn are_neighbours<I: Simd>(&self, i: I, a: LeafId, b: LeafId) -> bool {
        self.of_blocks.get(i, a.0.min(b.0), a.0.max(b.0)).is_some()
    }

    /// Returns the mask of neighbouring leaves of two wide nodes of leaves, or of one with itself.
    ///
    /// Bit 8 i + j is set if leaf i of `a` and leaf j of `b` are neighbours. For leaves that are
    /// blocks.
    #[inline(always)]
    pub(crate) fn among_leaves<I: Simd>(&self, i: I, a: WideNodeId, b: WideNodeId) -> u64 {
        if a <= b {
            self.of_wide_nodes.get(i, a.0, b.0).unwrap_or(0)
        } else {
            transposed(self.of_wide_nodes.get(i, b.0, a.0).unwrap_or(0))
        }
    }
}

/// Transposes a mask: pair (i, j) becomes (j, i).
fn transposed(mask: u64) -> u64 {
    let mut transposed = 0;
    for (row, lanes) in mask.to_le_bytes().into_iter().enumerate() {
        for lane in 0..8 {
            transposed |= u64::from(lanes >> lane & 1) << (8 * lane + row);
        }
    }
    transposed
}

/// Mask of the pairs of `rows` lanes i and `columns` lanes j.
fn pairs_of_lanes(rows: usize, columns: usize) -> u64 {
    let row = 0xff >> (8 - columns);
    (0..rows).fold(0, |mask, lane| mask | row << (8 * lane))
}

/// Table of neighbours under construction, made some leaves at a time.
///
/// Cost in all: linear in the triangles, whatever the mesh.
pub(crate) struct NeighboursBuilder {
    at_vertices: LanesAtVertices,
    /// First leaf whose lists are to come.
    next: u32,
    of_blocks: LaneLists,
    list: Vec<(u32, u64)>,
}

impl NeighboursBuilder {
    /// Begins the table; leaves have blocks.
    pub(super) fn new(leaves: &Leaves, order: &Order) -> Self {
        // On a surface a block has four to six later neighbours.
        let count = leaves.block_count();
        Self {
            at_vertices: LanesAtVertices::new(order),
            next: 0,
            of_blocks: LaneLists::with_capacity(count, 6 * count),
            list: Vec::new(),
        }
    }

    /// Continues with the same leaves and order; returns whether all leaves have their lists.
    pub(crate) fn advance(&mut self, leaves: &Leaves, order: &Order, budget: &mut Budget) -> bool {
        if !self.at_vertices.advance(leaves, order, budget) {
            return false;
        }
        while (self.next as usize) < leaves.len() {
            if budget.is_spent() {
                return false;
            }
            let leaf = LeafId(self.next);
            let triangles = leaves.triangles(leaf);
            budget.spend(LOOKS * triangles.len());
            for (block, start) in leaves
                .blocks(leaf)
                .zip(triangles.clone().step_by(BLOCK_LANES))
            {
                let end = triangles.end.min(start + BLOCK_LANES);
                self.list_neighbours((leaves, order), block, start..end);
                self.of_blocks.push(&self.list);
            }
            self.next += 1;
        }
        true
    }

    /// Lists a block and its later neighbours with the pairs of triangles to compare; nothing if it
    /// is crowded.
    fn list_neighbours(
        &mut self,
        (leaves, order): (&Leaves, &Order),
        block: u32,
        own: Range<usize>,
    ) {
        let (at_vertices, list) = (&self.at_vertices, &mut self.list);
        list.clear();
        // Masks first hold the pairs that share a vertex.
        list.push((block, 0));
        for (lane, place) in own.enumerate() {
            for vertex in order.corners(TreeTriangle(place as u32)) {
                let at_vertex = at_vertices.at(vertex);
                if at_vertex.len() > MOST_AT_A_VERTEX {
                    list.clear();
                    return;
                }
                for &(other, other_lanes) in at_vertex {
                    if other.0 < block {
                        continue;
                    }
                    let pairs = u64::from(other_lanes) << (8 * lane);
                    match list.iter_mut().find(|(known, _)| *known == other.0) {
                        Some((_, mask)) => *mask |= pairs,
                        None => list.push((other.0, pairs)),
                    }
                }
            }
        }
        if list.len() > 1 + MOST_NEIGHBOURS {
            list.clear();
        }
        let lanes = |block: u32| leaves.run_of_block(BlockId(block)).count as usize;
        for (other, mask) in &mut *list {
            *mask = !*mask & pairs_of_lanes(lanes(block), lanes(*other));
        }
        if let Some((_, within)) = list.first_mut() {
            *within &= STRICT_UPPER;
        }
    }

    /// Returns the finished table.
    pub(super) fn finish(self, wide_nodes: &[WideNode], leaves: &Leaves) -> Neighbours {
        let mut of_blocks = self.of_blocks;
        of_blocks.finish();
        // It is as large as the lists, and no longer needed.
        drop(self.at_vertices);
        let wide_nodes = if leaves.are_blocks() { wide_nodes } else { &[] };
        Neighbours {
            fans: None,
            of_wide_nodes: lists_of_wide_nodes(wide_nodes, leaves, &of_blocks),
            of_blocks,
        }
    }
}

held!(NeighboursBuilder: at_vertices, of_blocks, list[]);

/// Neighbours of wide nodes of leaves, from the neighbours of their leaves, each of which is a
/// block.
///
/// Wide nodes are numbered as their leaves are, so a later leaf is in a later wide node.
fn lists_of_wide_nodes(
    wide_nodes: &[WideNode],
    leaves: &Leaves,
    of_leaves: &LaneLists,
) -> LaneLists {
    let mut place_of = vec![None; leaves.len()];
    for (number, wide_node) in (0_u32..).zip(wide_nodes) {
        if let Some(first) = wide_node.first_leaf {
            for lane in 0..wide_node.len() as u32 {
                place_of[first.plus(lane).index()] = Some((number, lane));
            }
        }
    }
    let mut lists = LaneLists::with_capacity(wide_nodes.len(), 6 * wide_nodes.len());
    let mut list: Vec<(u32, u64)> = Vec::new();
    for wide_node in wide_nodes {
        list.clear();
        if let Some(first) = wide_node.first_leaf {
            for lane in 0..wide_node.len() as u32 {
                for &other in &of_leaves.others[of_leaves.list(first.plus(lane).0)] {
                    let Some((other_node, other_lane)) = place_of[other as usize] else {
                        continue;
                    };
                    let bit = 1 << (8 * lane + other_lane);
                    match list.iter_mut().find(|(known, _)| *known == other_node) {
                        Some((_, mask)) => *mask |= bit,
                        None => list.push((other_node, bit)),
                    }
                }
            }
        }
        lists.push(&list);
    }
    lists.finish();
    lists
}

held!(LaneLists: starts[], others[], masks[]);

held!(Neighbours: of_blocks, of_wide_nodes);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::{Instructions, dispatch};
    use crate::mesh::Topology;

    /// Checks every two blocks against a comparison of all corners. Returns how many blocks are
    /// crowded.
    fn check(triangles: &[[u32; 3]], vertices: usize, leaf_sizes: &[u32]) -> usize {
        let topology = Topology::new(triangles, vertices);
        let backwards = (0..triangles.len() as u32).rev().collect();
        let order = Order::new(&topology, backwards);
        let mut leaves = Leaves::new(16, TreeTriangle(0));
        let mut start = 0;
        for &size in leaf_sizes.iter().cycle() {
            let end = (start + size).min(triangles.len() as u32);
            leaves.push(start..end);
            start = end;
            if start == triangles.len() as u32 {
                break;
            }
        }
        let mut neighbours = NeighboursBuilder::new(&leaves, &order);
        while !neighbours.advance(&leaves, &order, &mut Budget::of(1)) {}
        let neighbours = neighbours.finish(&[], &leaves);
        let blocks = || (0..leaves.block_count() as u32).map(BlockId);
        let first = |block: BlockId| leaves.first_of_block(block).0;
        let end = |block: BlockId| {
            let next = BlockId(block.0 + 1);
            blocks()
                .find(|&block| block == next)
                .map_or(triangles.len() as u32, first)
        };
        let mut unknown = 0;
        for a in blocks() {
            for b in blocks() {
                let mut expected = 0;
                for i in first(a)..end(a) {
                    for j in first(b)..end(b) {
                        let share = order.share_a_vertex(TreeTriangle(i), TreeTriangle(j));
                        expected |= u64::from(share) << (8 * (i - first(a)) + j - first(b));
                    }
                }
                let widest = Instructions::widest();
                let compared = dispatch!(widest, i => neighbours.compared(i, a, b));
                let expected = !expected & if a == b { STRICT_UPPER } else { u64::MAX };
                let size = |block| (end(block) - first(block)) as usize;
                let lanes = pairs_of_lanes(size(a), size(b));
                match compared {
                    Some(compared) => assert_eq!(compared & lanes, expected & lanes, "{a:?} {b:?}"),
                    None => unknown += usize::from(a == b),
                }
                assert!(a <= b || compared.is_none());
            }
        }
        unknown
    }

    #[test]
    fn masks_are_what_comparing_all_corners_gives() {
        // A grid, whose blocks have few neighbours.
        let grid = |width: u32| -> Vec<[u32; 3]> {
            let cells = (0..width).flat_map(|y| (0..width).map(move |x| y * (width + 1) + x));
            cells
                .flat_map(|v| [[v, v + 1, v + width + 2], [v, v + width + 2, v + width + 1]])
                .collect()
        };
        for leaf_sizes in [&[8][..], &[5, 8, 1], &[16, 3]] {
            assert_eq!(check(&grid(20), 21 * 21, leaf_sizes), 0);
        }
        // Strangers, one triangle again and again, triangles that are points.
        assert_eq!(check(&[[0, 1, 2]; 40], 3, &[8]), 0);
        assert_eq!(check(&[[4, 4, 4]; 20], 9, &[8]), 0);
        let strangers: Vec<[u32; 3]> = (0..50).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        assert_eq!(check(&strangers, 150, &[8]), 0);
    }

    #[test]
    fn crowded_blocks_are_left_to_comparing_corners() {
        // A fan: too many triangles round one vertex.
        let fan: Vec<[u32; 3]> = (0..600).map(|t| [0, t + 1, t + 2]).collect();
        assert_eq!(check(&fan, 602, &[8]), 75);
        // Each vertex in few triangles, each block with many neighbours.
        let mut random = pliant_oracle::Random::new(9);
        let tangle: Vec<[u32; 3]> = (0..2_000)
            .map(|_| [0; 3].map(|_: u32| random.below(1_009)))
            .collect();
        let crowded = check(&tangle, 1_009, &[8]);
        assert!((100..250).contains(&crowded), "{crowded} of 250");
    }
}
