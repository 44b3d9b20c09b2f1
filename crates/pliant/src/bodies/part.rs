//! Part of a body: a tree over a run of its triangles, with boxes of nodes and of elements.
//!
//! A body has one part, over all of its triangles, until its mesh is edited: see `body::edits`.

use super::shape::SMALL;
use crate::held::{self, held};
use crate::ids::TreeVertex;
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::{Elements, Order};
use crate::options::Partition;
use crate::queries::{BoxSetNumber, NearBoxes, OF_MOTIONS, OF_SHAPES, Which};
use crate::threads::Executor;
use crate::tree::{BoxSet, Grown, Tree, Version};
use std::ops::Range;

/// Tree over a run of the triangles in tree order, with its boxes.
pub(crate) struct Part {
    tree: Tree,
    triangles: Range<u32>,
    /// The lowest vertex that the part's triangles are the first to use.
    first_vertex: TreeVertex,
    /// Sets of boxes by number, made when a query asks for them. In a large body the set of the
    /// present shape is there from the beginning.
    boxes: Vec<Option<BoxSet>>,
    /// Boxes of elements, made when first needed.
    near_boxes: Option<Box<NearBoxes>>,
}

impl Part {
    /// Part with a tree over these triangles, the first to use vertices from `first_vertex` on.
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

    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Run of triangles in tree order that the tree is over.
    pub(crate) fn triangles(&self) -> Range<u32> {
        self.triangles.clone()
    }

    /// The lowest vertex that the part's triangles are the first to use.
    pub(crate) fn first_vertex(&self) -> TreeVertex {
        self.first_vertex
    }

    /// Tree, a set of its boxes, and the boxes of elements. A set is made when first asked for.
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

    /// The tree, a set of its boxes, and the boxes of elements, as they are, if the set was made.
    pub(crate) fn for_reading(
        &self,
        number: BoxSetNumber,
    ) -> Option<(&Tree, &BoxSet, Option<&NearBoxes>)> {
        let boxes = self.boxes(number)?;
        Some((&self.tree, boxes, self.near_boxes.as_deref()))
    }

    /// A set of boxes, if some query asked for it.
    fn boxes(&self, number: BoxSetNumber) -> Option<&BoxSet> {
        self.boxes.get(number)?.as_ref()
    }

    /// Whether each node of a cut at a level has a valid box of this version of the shape.
    pub(crate) fn valid_in_cut(&self, level: u32, version: Version) -> Vec<bool> {
        match self.boxes(OF_SHAPES) {
            Some(boxes) => self.tree.valid_in_cut(level, boxes, version),
            None => vec![false; self.tree.starts_of_cut(level).len()],
        }
    }

    /// Checks the structure of the tree, and that each valid box holds everything below it, now and
    /// at the end of a motion.
    ///
    /// An error says in a sentence what is wrong.
    pub(crate) fn validate<S: Coordinate>(
        &self,
        order: &Order,
        partition: Partition,
        shapes: Grown<S>,
    ) -> Result<(), String> {
        let triangles = self.triangles.start as usize..self.triangles.end as usize;
        self.tree.validate(order, triangles, partition)?;
        if let Some(boxes) = self.boxes(OF_SHAPES) {
            self.tree.validate_boxes(boxes, &shapes.from)?;
        }
        if let Some(boxes) = self.boxes(OF_MOTIONS) {
            let source = Grown {
                distance: boxes.grown_by(),
                ..shapes
            };
            self.tree.validate_boxes(boxes, &source)?;
        }
        Ok(())
    }

    /// Copies the part. Its boxes are made anew.
    pub(crate) fn copy(&self) -> Self {
        Self::new(self.tree.clone(), self.triangles.clone(), self.first_vertex)
    }

    /// Makes all boxes stale: an interruption may have left some half made.
    pub(crate) fn forget_boxes(&mut self) {
        self.boxes.iter_mut().flatten().for_each(BoxSet::forget);
    }

    /// Makes the boxes of elements, unless they hold these shapes. Returns false if interrupted.
    pub(crate) fn make_near_boxes<S: Coordinate>(
        &mut self,
        which: Which,
        source: &Grown<S>,
        (order, elements): (&Order, &Elements),
        threads: (Instructions, Executor),
    ) -> bool {
        if self.is_first() {
            self.tree.know_fans(order);
        }
        let boxes = self.near_boxes.get_or_insert_default();
        boxes.make(which, source, threads, (&self.tree, elements))
    }

    /// Finds which triangles share a vertex, for the first part, which may meet itself.
    ///
    /// For a small part behind others that is not worth a table, whose cost is O(all vertices):
    /// corners are compared there.
    pub(crate) fn know_neighbours(&mut self, order: &Order, executor: Executor) {
        if self.is_first() {
            self.tree.know_neighbours(order, executor);
        }
    }

    /// Whether this is the body's first part.
    fn is_first(&self) -> bool {
        self.triangles.start == 0
    }
}

held!(Part: tree, boxes; |part| held::boxes(&part.near_boxes));
