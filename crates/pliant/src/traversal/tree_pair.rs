//! Pair of trees to be descended: of two bodies, of one body, or one tree with itself.

use crate::geometry::Points;
use crate::ids::{BodyId, NodeId, TreeTriangle};
use crate::kernels::Coordinate;
use crate::mesh::Order;
use crate::queries::{CallerIds, LabelPairs, NearElements, Needs, OwnEdges, Removed, Thickness};
use crate::tree::{BoxSet, BoxedTree, Source, Tree};
use crate::update::Refitted;

/// Data that a query reads of a tree of a body, beside its boxes.
pub(crate) struct Read<'t, S> {
    pub(crate) body: BodyId,
    pub(crate) order: &'t Order,
    pub(crate) mesh: &'t dyn OwnEdges,
    pub(crate) tree: &'t Tree,
    pub(crate) source: Source<'t, S>,
    /// Positions at the end of the motion, for kinds that look along motions.
    pub(crate) motion: Option<&'t Points<S>>,
    /// Near elements, for kinds that are shown runs of triangles.
    pub(crate) elements: Option<NearElements<'t>>,
    /// Thickness of the body's vertices, if it has any.
    pub(crate) thickness: Option<&'t Thickness>,
    /// Positions in the rest shape, if the body has one.
    pub(crate) rest: Option<&'t Points<S>>,
    /// Pairs that the body's labels leave out, if it has labels.
    pub(crate) labels: Option<&'t LabelPairs>,
    /// Triangles that were removed from the mesh and are still in the tree, if there are any.
    pub(crate) removed: Option<Removed<'t>>,
}

impl<S: Coordinate> Read<'_, S> {
    /// Whether a triangle was removed from the mesh and is still in the tree.
    #[inline]
    pub(crate) fn is_gone(&self, triangle: TreeTriangle) -> bool {
        self.removed.is_some_and(|removed| removed.has(triangle))
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

/// One tree of a body as the traversal sees it, whose boxes it may refit.
pub(crate) struct Side<'t, S> {
    pub(crate) read: Read<'t, S>,
    pub(crate) boxes: &'t mut BoxSet,
}

impl<S: Coordinate> Side<'_, S> {
    /// Mutable boxes with their tree, for refitting.
    pub(crate) fn refitted(&mut self) -> Refitted<'_, S> {
        Refitted {
            tree: self.read.tree,
            boxes: self.boxes,
            source: &self.read.source,
        }
    }

    /// Read-only view, for tasks.
    #[inline]
    pub(crate) fn view(&self) -> View<'_, S> {
        View {
            read: &self.read,
            boxes: self.boxes,
        }
    }
}

/// Two trees, or one twice. The root boxes are valid.
#[expect(
    clippy::large_enum_variant,
    reason = "there is one at a time, and memory for it would be allocated"
)]
pub(crate) enum TreePair<'t, S> {
    /// One tree with itself, every pair of its triangles once.
    ///
    /// A pair of one node with itself stands for the pairs within it. It expands into its children
    /// with themselves, and into the pairs of different children that overlap.
    One(Side<'t, S>),
    /// Two trees whose root boxes overlap: of two bodies, or of one.
    Two([Side<'t, S>; 2]),
}

impl<S: Coordinate> TreePair<'_, S> {
    /// Read-only views of both trees, for tasks.
    #[inline]
    pub(crate) fn views(&self) -> Views<'_, S> {
        match self {
            Self::One(side) => Views::one(side.view()),
            Self::Two([a, b]) => Views::two([a.view(), b.view()]),
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

/// Read-only view of a tree of a body, which many tasks share.
pub(crate) struct View<'v, S> {
    pub(crate) read: &'v Read<'v, S>,
    pub(crate) boxes: &'v BoxSet,
}

// Not derived: `S` need not be `Copy`.
impl<S> Clone for View<'_, S> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for View<'_, S> {}

impl<'v, S> View<'v, S> {
    /// Tree and boxes alone, for a walk.
    #[inline]
    pub(super) fn boxed_tree(self, needs: &Needs) -> BoxedTree<'v> {
        BoxedTree {
            tree: self.read.tree,
            boxes: self.boxes,
            culls_by_capsules: needs.culls_by_capsules,
            rims: self.read.elements.as_ref().map(|it| it.boxes.rims()),
        }
    }
}

/// Read-only views of the trees of a pair, both of one tree if it is one with itself.
pub(crate) struct Views<'v, S> {
    sides: [View<'v, S>; 2],
    is_one_tree: bool,
}

impl<'v, S: Coordinate> Views<'v, S> {
    /// One tree with itself.
    #[inline]
    pub(crate) fn one(side: View<'v, S>) -> Self {
        Self {
            sides: [side; 2],
            is_one_tree: true,
        }
    }

    /// Two trees.
    #[inline]
    pub(crate) fn two(sides: [View<'v, S>; 2]) -> Self {
        Self {
            sides,
            is_one_tree: false,
        }
    }

    /// Whether this is one tree with itself.
    #[inline]
    pub(super) fn is_one_tree(&self) -> bool {
        self.is_one_tree
    }

    /// Whether both sides are of one body, in one tree or two. Triangles that share a vertex of the
    /// mesh are then no hits.
    #[inline]
    pub(super) fn is_one_body(&self) -> bool {
        let [a, b] = self.sides;
        a.read.body == b.read.body
    }

    /// Whether the root boxes, which are valid, overlap.
    pub(crate) fn do_overlap(&self) -> bool {
        let [a, b] = self.sides.map(|side| side.boxes.nodes().one(NodeId::ROOT));
        a.overlaps(&b)
    }

    /// Both sides, or the only one twice.
    #[inline]
    pub(super) fn sides(&self) -> [View<'v, S>; 2] {
        self.sides
    }

    /// Caller's numbering of bodies, triangles and edges on both sides.
    pub(super) fn caller_ids(&self) -> CallerIds<'v> {
        let [a, b] = self.sides.map(|side| side.read);
        CallerIds {
            bodies: [a.body, b.body],
            orders: [a.order, b.order],
            meshes: [a.mesh, b.mesh],
            edges: [a.caller_edges(), b.caller_edges()],
        }
    }
}
