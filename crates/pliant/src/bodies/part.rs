//! A tree of a body, over a run of the triangles in tree order, and what hangs on it: boxes, and boxes of elements.
//!
//! A body has one part, over all of its triangles, until its mesh is edited: see `edits`.

use super::positions::SMALL;
use crate::geometry::{Points, Shape};
use crate::held::{self, held};
use crate::ids::TreeVertex;
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::{Elements, Order};
use crate::queries::{BoxSetNumber, NearBoxes, Which};
use crate::threads::Executor;
use crate::tree::{BoxSet, Source, Tree};
use std::ops::Range;

pub(crate) struct Part {
    pub(crate) tree: Tree,
    /// Its run of the triangles in tree order.
    pub(crate) triangles: Range<u32>,
    /// They are the first to use vertices from this one on.
    pub(crate) first_vertex: TreeVertex,
    /// By the number of the set. They are made when a kind of query asks for them; but in a large body the first, of the shape as it is,
    /// is there from the beginning.
    boxes: Vec<Option<BoxSet>>,
    /// Boxes of elements, once somebody asks for those.
    pub(crate) near_boxes: Option<Box<NearBoxes>>,
}

/// What boxes of elements are made of: the mesh in tree order, the shape, and where it is going.
pub(crate) struct OfElements<'b, S> {
    pub(crate) elements: &'b Elements,
    pub(crate) shape: Shape<'b, S>,
    pub(crate) end: Option<(&'b Points<S>, u64)>,
}

impl Part {
    /// Of a tree over these triangles, which are the first to use vertices from `first_vertex` on.
    pub(crate) fn new(tree: Tree, triangles: Range<u32>, first_vertex: TreeVertex) -> Self {
        let boxes = if triangles.len() > SMALL {
            vec![Some(BoxSet::new(&tree))]
        } else {
            Vec::new()
        };
        Self {
            tree,
            triangles,
            first_vertex,
            boxes,
            near_boxes: None,
        }
    }

    /// The tree, a set of its boxes, which is made if it was never asked for, and the boxes of elements.
    pub(crate) fn for_query(
        &mut self,
        number: BoxSetNumber,
    ) -> (&Tree, &mut BoxSet, Option<&NearBoxes>) {
        if self.boxes.len() <= number {
            self.boxes.resize_with(number + 1, || None);
        }
        let tree = &self.tree;
        let boxes = self.boxes[number].get_or_insert_with(|| BoxSet::new(tree));
        (tree, boxes, self.near_boxes.as_deref())
    }

    /// A set of boxes, if some query asked for it.
    pub(crate) fn boxes(&self, number: BoxSetNumber) -> Option<&BoxSet> {
        self.boxes.get(number)?.as_ref()
    }

    /// The same, whose boxes are made anew.
    pub(crate) fn copy(&self) -> Self {
        Self::new(self.tree.clone(), self.triangles.clone(), self.first_vertex)
    }

    /// All boxes are stale: some may have been left half made.
    pub(crate) fn forget_boxes(&mut self) {
        self.boxes.iter_mut().flatten().for_each(BoxSet::forget);
    }

    /// Makes the boxes of elements, unless they are those of the shape and the motion of now. Returns false if it was interrupted.
    pub(crate) fn make_near_boxes<S: Coordinate>(
        &mut self,
        which: Which,
        of: &OfElements<S>,
        threads: (Instructions, Executor),
    ) -> bool {
        let end = of.end.map(|(positions, epoch)| Shape {
            positions,
            epoch,
            ..of.shape
        });
        let source = Source::new(of.shape, end, Some(0.0));
        self.near_boxes.get_or_insert_default().make(
            which,
            source.version(),
            threads,
            (&of.shape, end.map(|end| end.positions)),
            (&self.tree.leaves, of.elements),
        )
    }

    /// Which of its triangles share a vertex, for a part that meets itself. A small part behind others is not worth a table, which takes
    /// time by all vertices: corners are compared there.
    pub(crate) fn know_neighbours(&mut self, order: &Order, executor: Executor) {
        if self.triangles.start == 0 {
            self.tree.know_neighbours(order, executor);
        }
    }
}

held!(Part: tree, boxes; |part| held::boxes(&part.near_boxes));
