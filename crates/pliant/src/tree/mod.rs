//! The bounding volume tree of one body: axis-aligned boxes, up to 2, 4 or 8 children a node.
//!
//! **The degree** is a number here. It is a type where boxes of nodes are side by side: in `boxes` (`NodeLanes`), what
//! walks down two trees (`expand`), and `update`. Each matches on it once a batch.
//!
//! A *node* is a box over a run of triangles. Nodes that are children of one node lie side by side in the lanes of one
//! [`WideNode`], because their boxes are made and tested together. A `NodeId` is a lane: wide node x 8 + lane. Wide node 0 holds the
//! root alone, in its lane 0. Wide nodes are stored level by level from the root down, so that those of the upper levels are
//! a prefix of the array, and a pass from its end to its beginning meets children before their parents.
//!
//! The structure is here and never changes between builds. The boxes are beside it, in sets (`boxes`): a tree may have more than one,
//! and which of them are valid changes all the time.
//!
//! Paper, 3.2. What differs: several triangles may share a leaf (whose triangles' boxes are then kept, eight side by side);
//! vertex lists of inner nodes are mostly runs of numbers, which takes away most of the memory that 3.3 regrets.

mod boxes;
pub(crate) mod build;
mod cut;
mod expand;
mod fans;
mod lanes_at_vertices;
mod leaves;
mod neighbours;
mod validate;
mod vertex_sets;
mod wide_node;

use crate::held::{self, held};
use crate::ids::{NodeId, TreeTriangle, TreeVertex, WideNodeId};
use crate::mesh::Order;
use crate::threads::{Budget, Executor};
pub(crate) use boxes::{
    BlockBoxes, BoxSet, BoxSource, Grown, LeavesMut, NodeLanes, NodesMut, Over, Quantized, Source,
    Version, of_degree, of_source,
};
use build::Plan;
pub(crate) use expand::{BoxedTree, LeafPair, NodePair, Worklists, expand};
pub(crate) use leaves::{BLOCK_LANES, FirstsOfBlocks, Leaves};
pub(crate) use neighbours::{Neighbours, NeighboursBuilder, STRICT_UPPER};
pub(crate) use vertex_sets::VertexSets;
use vertex_sets::VertexSetsBuilder;
pub(crate) use wide_node::{Child, WideNode};

/// The tree of one body, of degree 2, 4 or 8.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) wide_nodes: Vec<WideNode>,
    /// The first wide node of every level.
    level_starts: Vec<u32>,
    /// The vertices below every node.
    pub(crate) vertices: VertexSets,
    /// The triangles in every leaf.
    pub(crate) leaves: Leaves,
    /// Which triangles share a vertex; made when the body first meets itself, which most bodies never do.
    neighbours: Option<Box<Neighbours>>,
    /// The most children of a node: 2, 4 or 8.
    degree: usize,
    /// The level of the deepest leaf, where the root's is 0: the n of the paper's n / 2.
    pub(crate) depth: u32,
}

impl Tree {
    /// The tree of a plan over a mesh that is in the plan's order, or over a run of its triangles, which are the first to use vertices from
    /// `first_vertex` on.
    pub(crate) fn new(plan: &Plan, order: &Order, first_vertex: TreeVertex) -> Self {
        let mut tree = TreeBuilder::new(plan, order, first_vertex);
        tree.advance(plan, order, &mut Budget::whole());
        tree.finish(plan)
    }

    /// The wide nodes of a level, as places in their list; behind the last level there are none.
    pub(crate) fn level(&self, level: u32) -> std::ops::Range<usize> {
        let start = |level: u32| match self.level_starts.get(level as usize) {
            Some(&start) => start as usize,
            None => self.wide_nodes.len(),
        };
        start(level)..start(level + 1)
    }

    /// The level of a wide node.
    pub(crate) fn level_of(&self, wide_node: WideNodeId) -> u32 {
        let upto = |&start: &u32| start <= wide_node.0;
        self.level_starts.partition_point(upto) as u32 - 1
    }

    /// How many nodes there are, leaves included: the boxes of a complete update.
    pub(crate) fn node_count(&self) -> usize {
        self.vertices.len()
    }

    /// Whether the table of neighbours is there.
    pub(crate) fn knows_neighbours(&self) -> bool {
        self.neighbours.is_some()
    }

    /// Makes the table of neighbours, unless it is there, or there are no blocks that it could be of. Interrupted, it makes none.
    pub(crate) fn know_neighbours(&mut self, order: &Order, executor: Executor) {
        if let Some(mut neighbours) = self.begin_neighbours(order)
            && neighbours.advance(&self.leaves, order, &mut Budget::until(executor.interrupt))
        {
            self.take_neighbours(neighbours, order);
        }
    }

    /// Begins the table of neighbours, unless it is there, or there are no blocks that it could be of.
    pub(crate) fn begin_neighbours(&self, order: &Order) -> Option<NeighboursBuilder> {
        let are_to_come = self.leaves.have_blocks() && self.neighbours.is_none();
        are_to_come.then(|| NeighboursBuilder::new(&self.leaves, order))
    }

    /// Takes the table of neighbours, when it is done.
    pub(crate) fn take_neighbours(&mut self, neighbours: NeighboursBuilder, order: &Order) {
        let neighbours = neighbours.finish(&self.wide_nodes, &self.leaves, order);
        self.neighbours = Some(Box::new(neighbours));
    }

    /// Which triangles share a vertex, if that was asked for before.
    #[inline]
    pub(crate) fn neighbours(&self) -> Option<&Neighbours> {
        self.neighbours.as_deref()
    }

    /// All wide nodes, level by level.
    pub(crate) fn with_ids(&self) -> impl Iterator<Item = (WideNodeId, &WideNode)> {
        (0..).map(WideNodeId).zip(&self.wide_nodes)
    }

    /// The structure, for a loop over many nodes.
    #[inline(always)]
    pub(crate) fn nodes(&self) -> Nodes<'_> {
        Nodes(&self.wide_nodes)
    }

    #[inline(always)]
    pub(crate) fn wide_node(&self, wide_node: WideNodeId) -> &WideNode {
        self.nodes().wide(wide_node)
    }

    /// What is below a node.
    #[inline(always)]
    pub(crate) fn child(&self, node: NodeId) -> Child {
        self.nodes().child(node)
    }

    /// The nodes in a wide node.
    pub(crate) fn nodes_in(&self, wide_node: WideNodeId) -> impl Iterator<Item = NodeId> + use<> {
        let lanes = 0..self.wide_node(wide_node).len();
        lanes.map(move |lane| NodeId::new(wide_node, lane))
    }
}

/// A tree on its way: its nodes are there, the vertices below them come some at a time.
pub(crate) struct TreeBuilder {
    tree: Tree,
    vertices: VertexSetsBuilder,
}

impl TreeBuilder {
    /// As [`Tree::new`].
    pub(crate) fn new(plan: &Plan, order: &Order, first_vertex: TreeVertex) -> Self {
        let mut wide_nodes = vec![WideNode::new(0)];
        let first = plan.parts.first().map_or(0, |root| root.triangles.start);
        let mut leaves = Leaves::new(plan.leaf_size, TreeTriangle(first));
        // Parts come level by level, so the part at hand is always in the first wide node that still lacks a child.
        let (mut wide_node, mut lane, mut lanes) = (0, 0, 1);
        let mut lanes_to_come = std::collections::VecDeque::new();
        let mut level_starts = Vec::new();
        for part in &plan.parts {
            if lane == lanes {
                (wide_node, lane) = (wide_node + 1, 0);
                lanes = lanes_to_come
                    .pop_front()
                    .expect("a part below the root has a parent before it");
            }
            if part.level as usize == level_starts.len() {
                level_starts.push(wide_node as u32);
            }
            let child = if part.children.is_empty() {
                Child::Leaf(leaves.push(part.triangles.clone()))
            } else {
                lanes_to_come.push_back(part.children.len());
                wide_nodes.push(WideNode::new(part.children.start));
                Child::Inner(WideNodeId(wide_nodes.len() as u32 - 1))
            };
            wide_nodes[wide_node].set_child(lane, child);
            lane += 1;
        }
        for wide_node in &mut wide_nodes {
            let first = match wide_node.child(0) {
                Child::Leaf(leaf) => Some(leaf),
                Child::Inner(_) => None,
            };
            if wide_node
                .children()
                .all(|child| matches!(child, Child::Leaf(_)))
            {
                wide_node.first_leaf = first;
            }
        }
        wide_nodes.shrink_to_fit();
        leaves.shrink_to_fit();
        let tree = Tree {
            wide_nodes,
            level_starts,
            vertices: VertexSets::default(),
            leaves,
            neighbours: None,
            degree: plan.degree,
            depth: plan.parts.last().map_or(0, |deepest| deepest.level),
        };
        let vertices = VertexSetsBuilder::new(plan, order, first_vertex);
        Self { tree, vertices }
    }

    /// Goes on with the same plan and order; returns whether it is done.
    pub(crate) fn advance(&mut self, plan: &Plan, order: &Order, budget: &mut Budget) -> bool {
        self.vertices.advance(plan, order, budget)
    }

    /// The tree, when it is done.
    pub(crate) fn finish(self, plan: &Plan) -> Tree {
        let vertices = self.vertices.finish(plan);
        Tree {
            vertices,
            ..self.tree
        }
    }
}

held!(TreeBuilder: tree, vertices);

/// The structure of a tree, without what hangs on it.
#[derive(Clone, Copy)]
pub(crate) struct Nodes<'t>(&'t [WideNode]);

impl<'t> Nodes<'t> {
    #[inline(always)]
    pub(crate) fn wide(self, wide_node: WideNodeId) -> &'t WideNode {
        &self.0[wide_node.index()]
    }

    /// What is below a node.
    #[inline(always)]
    pub(crate) fn child(self, node: NodeId) -> Child {
        let (wide_node, lane) = node.wide_node_and_lane();
        self.wide(wide_node).child(lane)
    }
}

held!(Tree: wide_nodes[], level_starts[], vertices, leaves;
    |tree| held::boxes(&tree.neighbours));
