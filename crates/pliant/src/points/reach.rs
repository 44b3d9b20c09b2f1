//! Packets of points, brought down a tree to the triangles whose boxes theirs overlap.
//!
//! All go down together, level by level, so that a step needs few boxes of the tree and many
//! packets use each. Invariant: a box of the tree is made before it is read. It is made when it is
//! reached, for few points; for many all are made before, and threads share the points.

use super::packets::Packet;
use crate::geometry::Aabb;
use crate::ids::{BlockId, LeafId, TreeTriangle, WideNodeId};
use crate::kernels::{
    Coordinate, Instructions, dispatch, lanes_overlapping, least_of, near_mask_each, overlap_mask,
    priorities,
};
use crate::statistics::Statistics;
use crate::traversal::{Side, View};
use crate::tree::{Child, of_degree};
use crate::update::{DirtySet, Refit};
use std::ops::ControlFlow;

/// A tree of a body, as the points of one job see it.
pub(super) enum Trees<'q, 't, S> {
    /// Its boxes are made when they are reached.
    Lazy(&'q mut Side<'t, S>, Refit<'q>, &'q mut Statistics),
    /// Its boxes are made.
    Made(View<'q, S>, Refit<'q>),
}

/// Triangles side by side in tree order, whose boxes the boxes of a packet overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    /// Number of the packet.
    pub(super) packet: u32,
    pub(super) first: TreeTriangle,
    /// Bit `8 i + j`: box i of the packet and triangle j from the first on.
    pub(super) mask: u64,
}

impl Met {
    /// Number of a box in the packet and a triangle, of each pair.
    #[inline]
    pub(super) fn pairs(self) -> impl Iterator<Item = (u32, TreeTriangle)> {
        let mut rest = self.mask;
        std::iter::from_fn(move || {
            let bit = rest.trailing_zeros();
            let pair = (rest != 0).then(|| (bit / 8, self.first.plus(bit % 8)));
            rest &= rest.wrapping_sub(1);
            pair
        })
    }
}

/// Lists of one job.
#[derive(Debug, Default)]
pub(super) struct Reach {
    /// Wide nodes or leaves, each with the number of a packet.
    now: Vec<[u32; 2]>,
    next: Vec<[u32; 2]>,
    leaves: Vec<[u32; 2]>,
    pub(super) met: Vec<Met>,
    /// Pairs of a box and a triangle so far.
    pub(super) looked_at: u64,
    stale: DirtySet,
    lists: [Vec<WideNodeId>; 2],
}

impl<S: Coordinate> Trees<'_, '_, S> {
    pub(super) fn view(&self) -> View<'_, S> {
        match self {
            Self::Lazy(side, ..) => side.view(),
            Self::Made(view, _) => *view,
        }
    }

    pub(super) fn refit(&self) -> Refit<'_> {
        match self {
            Self::Lazy(_, refit, _) | Self::Made(_, refit) => *refit,
        }
    }
}

impl Reach {
    /// Finds all triangles whose boxes overlap boxes of packets. Breaks if interrupted.
    pub(super) fn meet<S: Coordinate>(
        &mut self,
        trees: &mut Trees<S>,
        packets: &[Packet],
    ) -> ControlFlow<()> {
        self.now.clear();
        self.leaves.clear();
        self.met.clear();
        self.now
            .extend((0..packets.len() as u32).map(|packet| [0, packet]));
        while !self.now.is_empty() {
            self.make_nodes(trees)?;
            let refit = trees.refit();
            self.down(trees.view(), packets, refit.instructions);
        }
        std::mem::swap(&mut self.now, &mut self.leaves);
        self.make_leaves(trees)?;
        self.reach_triangles(trees.view(), packets, trees.refit().instructions);
        let pairs = self.met.iter().map(|it| u64::from(it.mask.count_ones()));
        self.looked_at += pairs.sum::<u64>();
        ControlFlow::Continue(())
    }

    /// Goes down to a leaf near each box. Breaks if interrupted.
    pub(super) fn go_near<S: Coordinate>(
        &mut self,
        trees: &mut Trees<S>,
        boxes: &[(u32, Aabb)],
    ) -> ControlFlow<()> {
        self.now.clear();
        self.leaves.clear();
        self.now
            .extend((0..boxes.len() as u32).map(|number| [0, number]));
        while !self.now.is_empty() {
            self.make_nodes(trees)?;
            let (view, instructions) = (trees.view(), trees.refit().instructions);
            self.next.clear();
            let nodes = view.read.tree.nodes();
            of_degree!(view.boxes.nodes(), lanes => {
                dispatch!(instructions, i => {
                    for &[below, number] in &self.now {
                        let (_, its_box) = &boxes[number as usize];
                        let lane = least_of(priorities(i, &lanes[below as usize], its_box));
                        match nodes.wide(WideNodeId(below)).child(lane) {
                            Child::Inner(below) => self.next.push([below.0, number]),
                            Child::Leaf(leaf) => self.leaves.push([leaf.0, number]),
                        }
                    }
                });
            });
            std::mem::swap(&mut self.now, &mut self.next);
        }
        std::mem::swap(&mut self.now, &mut self.leaves);
        let made = self.make_leaves(trees);
        std::mem::swap(&mut self.now, &mut self.leaves);
        made
    }

    /// The leaves, and the number of a box near each.
    pub(super) fn leaves(&self) -> impl Iterator<Item = (LeafId, u32)> {
        self.leaves
            .iter()
            .map(|&[leaf, number]| (LeafId(leaf), number))
    }

    /// Makes the boxes of the wide nodes of this level that are stale.
    fn make_nodes<S: Coordinate>(&mut self, trees: &mut Trees<S>) -> ControlFlow<()> {
        if let Trees::Lazy(side, refit, statistics) = trees {
            for &[node, _] in &self.now {
                if !side.boxes.is_valid(WideNodeId(node)) {
                    self.stale.insert(node);
                }
            }
            if !self.stale.is_empty() {
                let (stale, lists) = (&mut self.stale, &mut self.lists);
                refit.reached(&mut side.refitted(), stale, lists, statistics);
            }
        }
        or_interrupted(trees)
    }

    /// Makes the boxes of the triangles in the leaves of this level that are stale.
    fn make_leaves<S: Coordinate>(&mut self, trees: &mut Trees<S>) -> ControlFlow<()> {
        if let Trees::Lazy(side, refit, statistics) = trees {
            for &[leaf, _] in &self.now {
                if !side.boxes.is_leaf_valid(LeafId(leaf)) {
                    self.stale.insert(leaf);
                }
            }
            if !self.stale.is_empty() {
                refit.reached_leaves(&mut side.refitted(), &mut self.stale, statistics);
            }
        }
        or_interrupted(trees)
    }

    /// Goes down one level.
    fn down<S: Coordinate>(
        &mut self,
        view: View<S>,
        packets: &[Packet],
        instructions: Instructions,
    ) {
        self.next.clear();
        let nodes = view.read.tree.nodes();
        of_degree!(view.boxes.nodes(), lanes => {
            dispatch!(instructions, i => {
                for &[below, packet] in &self.now {
                    let all = &packets[packet as usize].all;
                    let mut mask = lanes_overlapping(i, &lanes[below as usize], all);
                    let wide_node = nodes.wide(WideNodeId(below));
                    while mask != 0 {
                        match wide_node.child(mask.trailing_zeros() as usize % 8) {
                            Child::Inner(below) => self.next.push([below.0, packet]),
                            Child::Leaf(leaf) => self.leaves.push([leaf.0, packet]),
                        }
                        mask &= mask - 1;
                    }
                }
            });
        });
        std::mem::swap(&mut self.now, &mut self.next);
    }

    /// Goes from leaves to the triangles whose boxes are overlapped.
    fn reach_triangles<S: Coordinate>(
        &mut self,
        view: View<S>,
        packets: &[Packet],
        instructions: Instructions,
    ) {
        let leaves = &view.read.tree.leaves;
        if !leaves.have_blocks() {
            for &[leaf, packet] in &self.now {
                let first = leaves.first_triangle(LeafId(leaf));
                let lanes = u64::MAX >> (64 - 8 * packets[packet as usize].len);
                let mask = lanes & 0x0101_0101_0101_0101;
                self.met.push(Met {
                    packet,
                    first,
                    mask,
                });
            }
            return;
        }
        let of_blocks = view.boxes.blocks();
        let firsts = leaves.firsts_of_blocks();
        let are_blocks = leaves.are_blocks();
        dispatch!(instructions, i => {
            for &[leaf, packet] in &self.now {
                let Packet { len, all, each, limits, .. } = &packets[packet as usize];
                let its_blocks = if are_blocks {
                    leaf..leaf + 1
                } else {
                    leaves.blocks(LeafId(leaf))
                };
                for block in its_blocks.map(BlockId) {
                    let its_boxes = of_blocks.of(block);
                    let mask = match limits {
                        Some(limits) => {
                            near_mask_each(i, each, its_boxes, *len as usize, limits)
                        }
                        None if *len == 1 => lanes_overlapping(i, its_boxes, all),
                        None => overlap_mask(i, each, its_boxes),
                    };
                    if mask != 0 {
                        let first = firsts.of(block);
                        self.met.push(Met { packet, first, mask });
                    }
                }
            }
        });
    }
}

fn or_interrupted<S: Coordinate>(trees: &Trees<S>) -> ControlFlow<()> {
    if trees.refit().executor.is_interrupted() {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}
