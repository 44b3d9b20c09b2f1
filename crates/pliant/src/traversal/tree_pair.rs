//! What is descended: the trees of two bodies, two trees of one, or one tree against itself.

use crate::geometry::Points;
use crate::ids::{BodyId, NodeId};
use crate::kernels::Coordinate;
use crate::mesh::Order;
use crate::queries::{CallerIds, NearElements, Removed};
use crate::tree::{BoxSet, BoxedTree, Source, Tree};
use crate::update::Refitted;
use std::ops::Deref;

/// One tree of a body as the traversal sees it, whose boxes it may refit.
pub(crate) struct Side<'t, S, B = &'t mut BoxSet> {
    pub(crate) body: BodyId,
    pub(crate) order: &'t Order,
    pub(crate) tree: &'t Tree,
    pub(crate) boxes: B,
    pub(crate) source: Source<'t, S>,
    /// Where vertices are going, for kinds that look along motions.
    pub(crate) motion: Option<&'t Points<S>>,
    /// For kinds that are shown runs of triangles.
    pub(crate) elements: Option<NearElements<'t>>,
    /// What was taken out of the mesh and is still in the tree, if anything is.
    pub(crate) removed: Option<Removed<'t>>,
}

/// One tree of a body as tasks read it, many at a time.
pub(crate) type View<'t, S> = Side<'t, S, &'t BoxSet>;

impl<S: Coordinate> Side<'_, S> {
    /// As tasks read it.
    pub(super) fn view(&self) -> View<'_, S> {
        View {
            body: self.body,
            order: self.order,
            tree: self.tree,
            boxes: self.boxes,
            source: self.source,
            motion: self.motion,
            elements: self.elements,
            removed: self.removed,
        }
    }

    /// As the update sees it.
    pub(crate) fn refitted(&mut self) -> Refitted<'_, S> {
        Refitted {
            tree: self.tree,
            boxes: self.boxes,
            source: &self.source,
        }
    }
}

impl<S: Coordinate, B: Deref<Target = BoxSet>> Side<'_, S, B> {
    /// As a walk sees it.
    pub(super) fn boxed_tree(&self) -> BoxedTree<'_> {
        BoxedTree {
            tree: self.tree,
            boxes: &self.boxes,
        }
    }

    /// Where vertices are at the end of a motion, for kinds that look along motions.
    pub(super) fn end(&self) -> Option<&Points<S>> {
        self.source.end().map(|end| end.positions)
    }

    /// The numbers of edges as the caller has them, for kinds that look at edges; else none.
    fn caller_edges(&self) -> &[u32] {
        let elements = self.elements.as_ref();
        elements.map_or(&[], |elements| elements.edges.caller_edges())
    }
}

/// Two trees, or one twice. The root boxes are valid.
#[expect(
    clippy::large_enum_variant,
    reason = "there is one at a time, and memory for it would be allocated"
)]
pub(crate) enum TreePair<'t, S, B = &'t mut BoxSet> {
    /// One tree with itself, every pair of its triangles once.
    ///
    /// A pair of one node with itself stands for the pairs within it; it expands into its children with themselves and into
    /// the pairs of different children that overlap.
    One(Side<'t, S, B>),
    /// Two trees whose root boxes overlap: of two bodies, or of one.
    Two([Side<'t, S, B>; 2]),
}

impl<S: Coordinate> TreePair<'_, S> {
    /// As tasks read it.
    pub(super) fn view(&self) -> TreePair<'_, S, &BoxSet> {
        match self {
            Self::One(side) => TreePair::One(side.view()),
            Self::Two([a, b]) => TreePair::Two([a.view(), b.view()]),
        }
    }

    /// The first or the second, to refit.
    pub(super) fn refitted(&mut self, which: usize) -> Refitted<'_, S> {
        match self {
            Self::One(side) => side.refitted(),
            Self::Two(sides) => sides[which].refitted(),
        }
    }
}

impl<'t, S: Coordinate, B: Deref<Target = BoxSet>> TreePair<'t, S, B> {
    /// Whether it is one tree with itself.
    #[inline]
    pub(super) fn is_one_tree(&self) -> bool {
        matches!(self, Self::One(_))
    }

    /// Whether it is one body, in one tree or two: then triangles that share a vertex of the mesh are no answer.
    #[inline]
    pub(super) fn is_one_body(&self) -> bool {
        let [a, b] = self.sides();
        a.body == b.body
    }

    /// Whether the root boxes, which are valid, overlap.
    pub(crate) fn do_overlap(&self) -> bool {
        let [a, b] = self
            .sides()
            .map(|side| side.boxes.nodes().one(NodeId::ROOT));
        a.overlaps(&b)
    }

    /// Both, or the one twice.
    #[inline]
    pub(super) fn sides(&self) -> [&Side<'t, S, B>; 2] {
        match self {
            Self::One(side) => [side; 2],
            Self::Two([a, b]) => [a, b],
        }
    }

    /// How the caller numbers what is in them.
    pub(super) fn caller_ids(&self) -> CallerIds<'_> {
        let [a, b] = self.sides();
        CallerIds {
            bodies: [a.body, b.body],
            orders: [a.order, b.order],
            edges: [a.caller_edges(), b.caller_edges()],
        }
    }
}
