//! Trees for drawing: boxes of nodes, and counts.

/// Box of a tree's node, for drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeBox<S> {
    /// Smallest coordinates of the triangles below the node, in the caller's coordinates.
    pub lower: [S; 3],
    /// Largest coordinates of the triangles below the node.
    pub upper: [S; 3],
    /// Whether the tree holds this box, made for the present shape of the body.
    ///
    /// A query makes the boxes that it needs. The others are stale: they are of an earlier shape,
    /// and nothing reads them.
    pub valid: bool,
}

/// Depth and counts of a body's tree. It is about structure only, which no movement changes.
///
/// For a body whose mesh was edited, it is about all of its trees together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeShape {
    /// Level of the deepest leaf, where the root is level 0: the n of the paper's n / 2.
    pub depth: u32,
    /// Number of nodes, leaves and root included: the boxes of a complete update.
    pub nodes: usize,
    /// Number of nodes that hold triangles.
    pub leaves: usize,
}
