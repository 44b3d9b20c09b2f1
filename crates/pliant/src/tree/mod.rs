//! The bounding volume tree of one body: axis-aligned boxes, up to N children a node.
//!
//! A *node* is a box over a run of triangles. Nodes that are children of one node lie side by side in the lanes of one
//! [`Siblings`] group, because they are made and tested together. A [`NodeId`] is a lane: group x N + lane. Group 0 holds the
//! root alone, in its lane 0. Groups are stored level by level from the root down, so that the groups of the upper levels are
//! a prefix of the array, and a pass from its end to its beginning meets children before their parents.
//!
//! The structure never changes between builds; boxes do. A group, and a leaf for the boxes of its triangles, carries the *epoch*
//! of the body at which these were made, and is **true** only if that is the body's epoch now. Two rules hold at all times: nothing
//! reads a box that is not true, and the group above a true group or leaf is true. `update` makes them true, `traversal` asks for
//! it, `validate` checks it.
//!
//! Paper, 3.2. What differs: several triangles may share a leaf (whose triangles' boxes are then kept, eight side by side);
//! vertex lists of inner nodes are mostly runs of numbers, which takes away most of the memory that 3.3 regrets.

pub(crate) mod build;
mod leaves;
mod neighbours;
mod parts;
mod siblings;
mod validate;
mod vertex_sets;

use crate::geometry::Aabb;
use crate::mesh::Mesh;
use build::Plan;
pub(crate) use leaves::{LEAF_LANES, LeafBoxes, Leaves};
pub(crate) use neighbours::Neighbours;
pub(crate) use siblings::{Below, Child, Siblings};
pub(crate) use vertex_sets::VertexSets;

/// A node: one lane of one group of siblings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct NodeId(u32);

impl NodeId {
    pub(crate) const ROOT: Self = Self(0);

    #[inline]
    pub(crate) fn new<const N: usize>(group: u32, lane: usize) -> Self {
        Self(group * N as u32 + lane as u32)
    }

    #[inline]
    pub(crate) fn group_and_lane<const N: usize>(self) -> (usize, usize) {
        (self.0 as usize / N, self.0 as usize % N)
    }
}

/// The tree of one body, of degree `N`.
#[derive(Debug)]
pub(crate) struct Tree<const N: usize> {
    pub(crate) groups: Vec<Siblings<N>>,
    /// The first group of every level.
    level_starts: Vec<u32>,
    /// The vertices below every node.
    pub(crate) vertices: VertexSets,
    /// The triangles in every leaf.
    pub(crate) leaves: Leaves,
    /// Which triangles share a vertex; made when the body first meets itself.
    neighbours: Option<Neighbours>,
    /// The level of the deepest leaf, where the root's is 0: the n of the paper's n / 2.
    pub(crate) depth: u32,
    /// The epoch in which all groups were last made at once: in that epoch none is untrue.
    pub(crate) complete: u64,
}

impl<const N: usize> Tree<N> {
    /// The tree of a plan over a mesh that is in the plan's order. No box is true yet.
    pub(crate) fn new(plan: &Plan, mesh: &Mesh) -> Self {
        let mut groups = vec![Siblings::<N>::new(0)];
        let mut leaves = Leaves::new(plan.leaf_size);
        // Parts come level by level, so the part at hand is always in the first group that still lacks a child.
        let (mut group, mut lane, mut lanes) = (0, 0, 1);
        let mut lanes_of_groups = std::collections::VecDeque::new();
        let mut level_starts = Vec::new();
        for part in &plan.parts {
            if lane == lanes {
                (group, lane) = (group + 1, 0);
                lanes = lanes_of_groups
                    .pop_front()
                    .expect("a part below the root has a parent before it");
            }
            if part.level as usize == level_starts.len() {
                level_starts.push(group as u32);
            }
            groups[group].children[lane] = if part.children.is_empty() {
                Child::leaf(leaves.push(part.triangles.clone()))
            } else {
                lanes_of_groups.push_back(part.children.len());
                groups.push(Siblings::new(part.children.start));
                Child::group(groups.len() as u32 - 1)
            };
            lane += 1;
        }
        for group in &mut groups {
            let below = |child: Child| match child.below() {
                Below::Leaf(leaf) => Some(leaf),
                Below::Group(_) => None,
            };
            if group.used_children().all(|child| below(child).is_some()) {
                group.first_leaf = below(group.children[0]);
            }
        }
        groups.shrink_to_fit();
        leaves.shrink_to_fit();
        let depth = plan.parts.last().map_or(0, |deepest| deepest.level);
        Self {
            groups,
            level_starts,
            vertices: VertexSets::new(plan, mesh, N),
            leaves,
            neighbours: None,
            depth,
            complete: 0,
        }
    }

    /// The groups of a level; behind the last level there are none.
    pub(crate) fn level(&self, level: u32) -> std::ops::Range<u32> {
        let start = |level: u32| match self.level_starts.get(level as usize) {
            Some(&group) => group,
            None => self.groups.len() as u32,
        };
        start(level)..start(level + 1)
    }

    /// The level of a group.
    pub(crate) fn level_of(&self, group: u32) -> u32 {
        self.level_starts.partition_point(|&start| start <= group) as u32 - 1
    }

    /// How many nodes there are, leaves included: the boxes of a complete update.
    pub(crate) fn node_count(&self) -> usize {
        self.vertices.len()
    }

    /// Makes the table of neighbours, unless it is there, or there are no blocks that it could be of.
    pub(crate) fn know_neighbours(&mut self, mesh: &Mesh) {
        if self.leaves.have_boxes() && self.neighbours.is_none() {
            self.neighbours = Some(Neighbours::new(&self.leaves, mesh));
        }
    }

    /// Which triangles share a vertex, if that was asked for before.
    pub(crate) fn neighbours(&self) -> Option<&Neighbours> {
        self.neighbours.as_ref()
    }

    #[inline]
    pub(crate) fn child(&self, node: NodeId) -> Child {
        let (group, lane) = node.group_and_lane::<N>();
        self.groups[group].children[lane]
    }

    /// The box of a node whose group is true.
    #[inline]
    pub(crate) fn box_of(&self, node: NodeId) -> Aabb {
        let (group, lane) = node.group_and_lane::<N>();
        self.groups[group].boxes.get(lane)
    }
}
