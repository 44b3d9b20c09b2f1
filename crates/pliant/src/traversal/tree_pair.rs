//! Pair of trees to be descended: of two bodies, of one body, or one tree with itself.

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
    /// Positions at the end of the motion, for kinds that look along motions.
    pub(crate) motion: Option<&'t Points<S>>,
    /// Near elements, for kinds that are shown runs of triangles.
    pub(crate) elements: Option<NearElements<'t>>,
    /// Triangles that were removed from the mesh and are still in the tree, if there are any.
    pub(crate) removed: Option<Removed<'t>>,
}

/// Read-only view of a tree of a body, which many tasks share.
pub(crate) type View<'t, S> = Side<'t, S, &'t BoxSet>;

impl<S: Coordinate> Side<'_, S> {
    /// Read-only view, for tasks.
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

    /// Mutable boxes with their tree, for refitting.
    pub(crate) fn refitted(&mut self) -> Refitted<'_, S> {
        Refitted {
            tree: self.tree,
            boxes: self.boxes,
            source: &self.source,
        }
    }
}

impl<S: Coordinate, B: Deref<Target = BoxSet>> Side<'_, S, B> {
    /// Tree and boxes alone, for a walk.
    pub(super) fn boxed_tree(&self) -> BoxedTree<'_> {
        BoxedTree {
            tree: self.tree,
            boxes: &self.boxes,
        }
    }

    /// Positions at the end of what boxes hold, for kinds that look along motions.
    pub(super) fn end(&self) -> Option<&Points<S>> {
        self.source.end().map(|end| end.positions)
    }

    /// Caller's numbers of edges, for kinds that look at edges; else empty.
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
    /// A pair of one node with itself stands for the pairs within it. It expands into its children
    /// with themselves, and into the pairs of different children that overlap.
    One(Side<'t, S, B>),
    /// Two trees whose root boxes overlap: of two bodies, or of one.
    Two([Side<'t, S, B>; 2]),
}

impl<S: Coordinate> TreePair<'_, S> {
    /// Read-only view, for tasks.
    pub(super) fn view(&self) -> TreePair<'_, S, &BoxSet> {
        match self {
            Self::One(side) => TreePair::One(side.view()),
            Self::Two([a, b]) => TreePair::Two([a.view(), b.view()]),
        }
    }

    /// Mutable boxes of the first (0) or second (1) tree, for refitting.
    pub(super) fn refitted(&mut self, which: usize) -> Refitted<'_, S> {
        match self {
            Self::One(side) => side.refitted(),
            Self::Two(sides) => sides[which].refitted(),
        }
    }
}

impl<'t, S: Coordinate, B: Deref<Target = BoxSet>> TreePair<'t, S, B> {
    /// Whether this is one tree with itself.
    #[inline]
    pub(super) fn is_one_tree(&self) -> bool {
        matches!(self, Self::One(_))
    }

    /// Whether both sides are of one body, in one tree or two. Triangles that share a vertex of the
    /// mesh are then no hits.
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

    /// Both sides, or the only one twice.
    #[inline]
    pub(super) fn sides(&self) -> [&Side<'t, S, B>; 2] {
        match self {
            Self::One(side) => [side; 2],
            Self::Two([a, b]) => [a, b],
        }
    }

    /// Caller's numbering of bodies, triangles and edges on both sides.
    pub(super) fn caller_ids(&self) -> CallerIds<'_> {
        let [a, b] = self.sides();
        CallerIds {
            bodies: [a.body, b.body],
            orders: [a.order, b.order],
            edges: [a.caller_edges(), b.caller_edges()],
        }
    }
}
