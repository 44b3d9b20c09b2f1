//! What a tree looks like, for those who draw it.

/// A node of a tree, drawn as a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeBox<S> {
    /// The smallest coordinates of the triangles below the node, as the caller has them.
    pub lower: [S; 3],
    /// The largest coordinates.
    pub upper: [S; 3],
    /// Whether the tree holds this box: it was made for the shape that the body has now. A query makes the boxes that it
    /// needs; the others are stale, as they were for some shape before, and nothing reads them.
    pub valid: bool,
}

/// The tree of a body in numbers; the structure only, which no movement changes. Of a body whose mesh was edited, its trees together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeShape {
    /// The level of the deepest leaf, where the root is level 0: the n of the paper's n / 2.
    pub depth: u32,
    /// All nodes, leaves and root included: the boxes of a complete update.
    pub nodes: usize,
    /// Nodes that hold triangles.
    pub leaves: usize,
}
