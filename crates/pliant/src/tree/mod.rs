//! Bounding volume hierarchy of a body: axis-aligned boxes, degree 2, 4 or 8 (paper, 3.2).
//!
//! A *node* is a box over a run of triangles. The children of one node are a [`WideNode`]: their
//! boxes lie side by side, because they are made and tested together. The structure is here and
//! never changes between builds; sets of boxes are beside it (`boxes`). The degree is a number
//! here, and a type where boxes lie in lanes. What differs from the paper: several triangles may
//! share a leaf, and vertex lists are mostly runs ([`VertexSets`]).

mod boxes;
pub(crate) mod build;
mod cut;
mod expand;
mod fans;
mod lanes_at_vertices;
mod leaves;
mod neighbours;
mod rims;
mod validate;
mod vertex_sets;
mod wide_node;

use crate::held::{self, Held, held};
use crate::ids::{NodeId, TreeTriangle, TreeVertex, WideNodeId};
use crate::mesh::Order;
use crate::threads::{Budget, Executor};
pub(crate) use boxes::{
    BlockBoxes, BoxSet, BoxSource, Grown, LeavesMut, NodeLanes, NodesMut, Over, Quantized, Source,
    Version, capsule_of_node, make_block_capsules, make_node_capsules, of_degree, of_source,
};
use build::Plan;
pub(crate) use expand::{BoxedTree, LeafPair, NodePair, Worklists, expand};
use fans::Fans;
pub(crate) use leaves::{BLOCK_LANES, FirstsOfBlocks, Leaves};
pub(crate) use neighbours::{Neighbours, NeighboursBuilder, STRICT_UPPER};
pub(crate) use rims::Rims;
use std::sync::Arc;
pub(crate) use vertex_sets::VertexSets;
use vertex_sets::VertexSetsBuilder;
pub(crate) use wide_node::{Child, WideNode};

/// Tree of one body, or of a part (a run of its triangles), of degree 2, 4 or 8.
///
/// A `NodeId` is a lane: wide node x 8 + lane. Wide node 0 holds the root alone, in its lane 0.
/// Wide nodes are stored level by level from the root down. So upper levels are a prefix of the
/// array, and a pass from its end meets children before their parents.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub(crate) wide_nodes: Vec<WideNode>,
    /// First wide node of every level.
    level_starts: Vec<u32>,
    /// Vertices below every node.
    pub(crate) vertices: VertexSets,
    /// Triangles in every leaf.
    pub(crate) leaves: Leaves,
    /// Table of triangles that share a vertex. Made when the body first meets itself, which most
    /// bodies never do.
    neighbours: Option<Box<Neighbours>>,
    /// Fans. Found when the body first meets itself, if many triangles may share a vertex.
    fans: Option<Arc<Fans>>,
    /// Most children of a node: 2, 4 or 8.
    degree: usize,
    /// Whether many of the triangles are long and thin.
    pub(crate) has_thin: bool,
    /// Level of the deepest leaf, where the root's is 0: the n of the paper's n / 2.
    pub(crate) depth: u32,
}

impl Tree {
    /// Builds the tree of a plan over a mesh in the plan's order, or over a run of its triangles.
    ///
    /// The triangles are the first to use vertices from `first_vertex` on.
    pub(crate) fn new(plan: &Plan, order: &Order, first_vertex: TreeVertex) -> Self {
        let mut tree = TreeBuilder::new(plan, order, first_vertex);
        tree.advance(plan, order, &mut Budget::whole());
        tree.finish(plan)
    }

    /// Returns the wide nodes of a level, as places in their list; none behind the last level.
    pub(crate) fn level(&self, level: u32) -> std::ops::Range<usize> {
        let start = |level: u32| match self.level_starts.get(level as usize) {
            Some(&start) => start as usize,
            None => self.wide_nodes.len(),
        };
        start(level)..start(level + 1)
    }

    /// Returns the level of a wide node. O(log depth).
    pub(crate) fn level_of(&self, wide_node: WideNodeId) -> u32 {
        let upto = |&start: &u32| start <= wide_node.0;
        self.level_starts.partition_point(upto) as u32 - 1
    }

    /// Returns how many nodes there are, leaves included: the boxes of a complete update.
    pub(crate) fn node_count(&self) -> usize {
        self.vertices.len()
    }

    /// Whether the table of neighbours is made.
    pub(crate) fn knows_neighbours(&self) -> bool {
        self.neighbours.is_some()
    }

    /// Makes the table of neighbours, unless it is made or leaves have no blocks. Interrupted, it
    /// makes none.
    pub(crate) fn know_neighbours(&mut self, order: &Order, executor: Executor) {
        if let Some(mut neighbours) = self.begin_neighbours(order)
            && neighbours.advance(&self.leaves, order, &mut Budget::until(executor.interrupt))
        {
            self.take_neighbours(neighbours, order);
        }
    }

    /// Begins the table of neighbours, unless it is made or leaves have no blocks.
    pub(crate) fn begin_neighbours(&self, order: &Order) -> Option<NeighboursBuilder> {
        let are_to_come = self.leaves.have_blocks() && self.neighbours.is_none();
        are_to_come.then(|| NeighboursBuilder::new(&self.leaves, order))
    }

    /// Finishes the table of neighbours and keeps it.
    pub(crate) fn take_neighbours(&mut self, neighbours: NeighboursBuilder, order: &Order) {
        let mut neighbours = neighbours.finish(&self.wide_nodes, &self.leaves);
        if neighbours.is_any_crowded() {
            neighbours.take_fans(self.know_fans(order));
        }
        self.neighbours = Some(Box::new(neighbours));
    }

    /// Finds the fans, unless they are known.
    pub(crate) fn know_fans(&mut self, order: &Order) -> Arc<Fans> {
        let fans = match self.fans.take() {
            Some(known) => known,
            None => Arc::new(Fans::new(&self.wide_nodes, &self.leaves, order)),
        };
        self.fans = Some(fans.clone());
        fans
    }

    /// Returns the fans, if they are known.
    #[inline]
    fn fans(&self) -> Option<&Fans> {
        self.fans.as_deref()
    }

    /// Returns the table of neighbours, if it is made.
    #[inline]
    pub(crate) fn neighbours(&self) -> Option<&Neighbours> {
        self.neighbours.as_deref()
    }

    /// Iterates over all wide nodes, level by level.
    pub(crate) fn with_ids(&self) -> impl Iterator<Item = (WideNodeId, &WideNode)> {
        (0..).map(WideNodeId).zip(&self.wide_nodes)
    }

    /// Returns the structure, for a loop over many nodes.
    #[inline(always)]
    pub(crate) fn nodes(&self) -> Nodes<'_> {
        Nodes(&self.wide_nodes)
    }

    /// Returns a wide node.
    #[inline(always)]
    pub(crate) fn wide_node(&self, wide_node: WideNodeId) -> &WideNode {
        self.nodes().wide(wide_node)
    }

    /// Returns the link from a node down, to a wide node or a leaf.
    #[inline(always)]
    pub(crate) fn child(&self, node: NodeId) -> Child {
        self.nodes().child(node)
    }

    /// Returns the number of a node, counted level by level: its place in `VertexSets`.
    #[inline(always)]
    fn number_of(&self, node: NodeId) -> usize {
        self.nodes().number_of(node)
    }

    /// Iterates over the nodes in a wide node.
    pub(crate) fn nodes_in(&self, wide_node: WideNodeId) -> impl Iterator<Item = NodeId> + use<> {
        let lanes = 0..self.wide_node(wide_node).len();
        lanes.map(move |lane| NodeId::new(wide_node, lane))
    }
}

/// Tree under construction: its nodes are there, the vertices below them come some at a time.
pub(crate) struct TreeBuilder {
    tree: Tree,
    vertices: VertexSetsBuilder,
}

impl TreeBuilder {
    /// Begins a tree; see [`Tree::new`].
    pub(crate) fn new(plan: &Plan, order: &Order, first_vertex: TreeVertex) -> Self {
        let mut wide_nodes = vec![WideNode::new(0)];
        let first = plan.nodes.first().map_or(0, |root| root.triangles.start);
        let mut leaves = Leaves::new(plan.leaf_size, TreeTriangle(first));
        // Nodes come level by level, so the next one is always in the first wide node that lacks a
        // child.
        let (mut wide_node, mut lane, mut lanes) = (0, 0, 1);
        let mut lanes_to_come = std::collections::VecDeque::new();
        let mut level_starts = Vec::new();
        for node in &plan.nodes {
            if lane == lanes {
                (wide_node, lane) = (wide_node + 1, 0);
                lanes = lanes_to_come
                    .pop_front()
                    .expect("a part below the root has a parent before it");
            }
            if node.level as usize == level_starts.len() {
                level_starts.push(wide_node as u32);
            }
            let child = if node.children.is_empty() {
                Child::Leaf(leaves.push(node.triangles.clone()))
            } else {
                lanes_to_come.push_back(node.children.len());
                wide_nodes.push(WideNode::new(node.children.start));
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
            fans: None,
            degree: plan.degree,
            has_thin: plan.has_thin,
            depth: plan.nodes.last().map_or(0, |deepest| deepest.level),
        };
        let vertices = VertexSetsBuilder::new(plan, order, first_vertex);
        Self { tree, vertices }
    }

    /// Continues with the same plan and order; returns whether it is done.
    pub(crate) fn advance(&mut self, plan: &Plan, order: &Order, budget: &mut Budget) -> bool {
        self.vertices.advance(plan, order, budget)
    }

    /// Returns the tree, when it is done.
    pub(crate) fn finish(self, plan: &Plan) -> Tree {
        let vertices = self.vertices.finish(plan);
        Tree {
            vertices,
            ..self.tree
        }
    }
}

held!(TreeBuilder: tree, vertices);

/// Structure of a tree alone: its wide nodes.
#[derive(Clone, Copy)]
pub(crate) struct Nodes<'t>(&'t [WideNode]);

impl<'t> Nodes<'t> {
    /// Returns a wide node.
    #[inline(always)]
    pub(crate) fn wide(self, wide_node: WideNodeId) -> &'t WideNode {
        &self.0[wide_node.index()]
    }

    /// Returns the link from a node down, to a wide node or a leaf.
    #[inline(always)]
    pub(crate) fn child(self, node: NodeId) -> Child {
        let (wide_node, lane) = node.wide_node_and_lane();
        self.wide(wide_node).child(lane)
    }

    /// Returns the number of a node, counted level by level: its place in `VertexSets`.
    #[inline(always)]
    fn number_of(self, node: NodeId) -> usize {
        let (wide_node, lane) = node.wide_node_and_lane();
        self.wide(wide_node).first_node as usize + lane
    }
}

held!(Tree: wide_nodes[], level_starts[], vertices, leaves;
    |tree| held::boxes(&tree.neighbours) + tree.fans().map_or(0, Held::held));
