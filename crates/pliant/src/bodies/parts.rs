//! Parts of a body: the first, which always exists, and the others.

use super::debug_view::TreeShape;
use super::part::Part;
use crate::held::held;
use crate::ids::TreeVertex;
use crate::tree::Tree;
use std::iter;

/// Trees of a body, each over a run of its triangles in tree order.
pub(crate) struct Parts {
    /// Part with the triangles that were there when its tree was built.
    first: Part,
    /// Parts with triangles that came since.
    others: Vec<Part>,
}

impl Parts {
    /// One part, whose tree is over all triangles.
    pub(crate) fn of(tree: Tree, triangles: usize) -> Self {
        Self {
            first: Part::new(tree, 0..triangles as u32, TreeVertex(0)),
            others: Vec::new(),
        }
    }

    /// Copies the parts. Their boxes are made anew.
    pub(crate) fn copy(&self) -> Self {
        Self {
            first: self.first.copy(),
            others: self.others.iter().map(Part::copy).collect(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        1 + self.others.len()
    }

    pub(crate) fn all(&self) -> impl Iterator<Item = &Part> {
        iter::once(&self.first).chain(&self.others)
    }

    pub(crate) fn all_mut(&mut self) -> impl Iterator<Item = &mut Part> {
        iter::once(&mut self.first).chain(&mut self.others)
    }

    pub(crate) fn one_mut(&mut self, number: usize) -> &mut Part {
        match number.checked_sub(1) {
            None => &mut self.first,
            Some(number) => &mut self.others[number],
        }
    }

    /// Two different parts, mutable, the lower number first.
    pub(crate) fn two_mut(&mut self, [low, high]: [usize; 2]) -> [&mut Part; 2] {
        let (before, rest) = self.others.split_at_mut(high - 1);
        let low = match low.checked_sub(1) {
            None => &mut self.first,
            Some(low) => &mut before[low],
        };
        [low, &mut rest[0]]
    }

    /// Number of triangles in the first part.
    pub(crate) fn in_first(&self) -> usize {
        self.first.triangles().len()
    }

    /// Whether it is known which triangles of the first part share a vertex.
    pub(crate) fn know_neighbours(&self) -> bool {
        self.first.tree().knows_neighbours()
    }

    /// Appends a part behind all others.
    pub(crate) fn push(&mut self, part: Part) {
        self.others.push(part);
    }

    /// Removes and returns the last part, if it is not the first and has at most `most` triangles.
    pub(crate) fn pop(&mut self, most: usize) -> Option<Part> {
        self.others.pop_if(|last| last.triangles().len() <= most)
    }

    pub(crate) fn trees(&self) -> impl Iterator<Item = &Tree> {
        self.all().map(Part::tree)
    }

    /// Depth, nodes and leaves of all trees together.
    pub(crate) fn shape(&self) -> TreeShape {
        let trees = || self.trees();
        TreeShape {
            depth: trees().map(|tree| tree.depth).max().unwrap_or_default(),
            nodes: trees().map(Tree::node_count).sum(),
            leaves: trees().map(|tree| tree.leaves.len()).sum(),
        }
    }
}

held!(Parts: first, others);
