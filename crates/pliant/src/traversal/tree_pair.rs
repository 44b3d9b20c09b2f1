//! What is descended: the trees of two bodies, or the tree of one against itself.

use crate::geometry::Points;
use crate::ids::{BodyId, NodeId};
use crate::mesh::Order;
use crate::queries::{CallerIds, NearElements, Removed};
use crate::tree::BoxedTree;
use crate::tree::{BoxSet, BoxSource, Tree};
use crate::update::Refitted;

/// One body as the traversal sees it.
pub(crate) struct Side<'t, B: BoxSource> {
    pub(crate) body: BodyId,
    pub(crate) order: &'t Order,
    pub(crate) tree: &'t Tree,
    pub(crate) boxes: &'t mut BoxSet,
    pub(crate) source: B,
    /// Where vertices are going, for kinds that hold motions.
    pub(crate) motion: Option<&'t Points<B::Scalar>>,
    /// For kinds that are shown runs of triangles.
    pub(crate) elements: Option<NearElements<'t>>,
    /// What was taken out of the mesh and is still in the tree, if anything is.
    pub(crate) removed: Option<Removed<'t>>,
}

impl<B: BoxSource> Side<'_, B> {
    /// As the update sees it.
    pub(crate) fn refitted(&mut self) -> Refitted<'_, B> {
        Refitted {
            tree: self.tree,
            boxes: self.boxes,
            source: &self.source,
        }
    }

    /// As a walk sees it.
    pub(super) fn boxed_tree(&self) -> BoxedTree<'_> {
        BoxedTree {
            tree: self.tree,
            boxes: self.boxes,
        }
    }

    /// Where vertices are at the end of a motion, for kinds that hold motions.
    pub(super) fn end(&self) -> Option<&Points<B::Scalar>> {
        self.source.end().map(|end| end.positions)
    }

    /// The numbers of edges as the caller has them, for kinds that look at edges; else none.
    fn caller_edges(&self) -> &[u32] {
        match &self.elements {
            Some(elements) => elements.edges.caller_edges(),
            None => &[],
        }
    }
}

/// Two trees, or one twice.
pub(crate) trait TreePair: Sync {
    type Source: BoxSource;
    /// Whether it is one tree against itself.
    const ITSELF: bool;

    /// Whether it is one body, in one tree or two: then triangles that share a vertex of the mesh are no answer.
    fn is_one_body(&self) -> bool;

    /// Both bodies, or the one twice.
    fn sides(&self) -> [&Side<'_, Self::Source>; 2];

    /// The first or the second, to refit.
    fn refitted(&mut self, which: usize) -> Refitted<'_, Self::Source>;

    /// How the caller numbers what is in them.
    fn caller_ids(&self) -> CallerIds<'_> {
        let [a, b] = self.sides();
        CallerIds {
            bodies: [a.body, b.body],
            orders: [a.order, b.order],
            edges: [a.caller_edges(), b.caller_edges()],
        }
    }
}

/// Two trees, whose root boxes are valid and overlap: of two bodies, or of one.
pub(crate) struct TwoTrees<'t, B: BoxSource> {
    pub(crate) a: Side<'t, B>,
    pub(crate) b: Side<'t, B>,
}

impl<B: BoxSource> TwoTrees<'_, B> {
    /// Whether the root boxes, which are valid, overlap.
    pub(crate) fn overlap(&self) -> bool {
        let root = |side: &Side<B>| side.boxes.nodes().one(NodeId::ROOT);
        root(&self.a).overlaps(&root(&self.b))
    }
}

impl<B: BoxSource> TreePair for TwoTrees<'_, B> {
    type Source = B;
    const ITSELF: bool = false;

    #[inline(always)]
    fn is_one_body(&self) -> bool {
        self.a.body == self.b.body
    }

    #[inline(always)]
    fn sides(&self) -> [&Side<'_, B>; 2] {
        [&self.a, &self.b]
    }

    fn refitted(&mut self, which: usize) -> Refitted<'_, B> {
        [&mut self.a, &mut self.b][which].refitted()
    }
}

/// One body with itself, every pair of its triangles once. Its root box is valid.
///
/// A pair of one node with itself stands for the pairs within it; it expands into its children with themselves and into
/// the pairs of different children that overlap.
pub(crate) struct OneTree<'t, B: BoxSource> {
    pub(crate) side: Side<'t, B>,
}

impl<B: BoxSource> TreePair for OneTree<'_, B> {
    type Source = B;
    const ITSELF: bool = true;

    #[inline(always)]
    fn is_one_body(&self) -> bool {
        true
    }

    #[inline(always)]
    fn sides(&self) -> [&Side<'_, B>; 2] {
        [&self.side; 2]
    }

    fn refitted(&mut self, _: usize) -> Refitted<'_, B> {
        self.side.refitted()
    }
}
