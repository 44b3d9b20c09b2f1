//! Counters of the work of a query, which explain its cost on any machine. Time is never read
//! inside the library.
//!
//! Counters are equal for any number of threads, with one exception: decisions and pairs on the way
//! to a first impact or a free step. There every thread goes by the earliest contact found so far.

/// Work of one query, with what [`prepare`](crate::Query::prepare) did since the query before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Statistics {
    /// Pairs of bodies whose trees were traversed; 1 for a query of two bodies or of one with
    /// itself.
    pub body_pairs: u64,
    /// Boxes refitted ahead of a traversal, level by level from below.
    pub boxes_bottom_up: u64,
    /// Boxes refitted when a traversal reached them.
    pub boxes_top_down: u64,
    /// Boxes of single triangles in leaves of several. They are made when a leaf meets another, or
    /// ahead in a body that meets itself.
    pub triangle_boxes: u64,
    /// Pairs of nodes with overlapping boxes. For a distance: pairs whose boxes were near enough to
    /// be opened.
    pub node_pairs: u64,
    /// Pairs of triangles with overlapping boxes, which were therefore decided, or near enough to
    /// be measured; of points and triangles likewise. Within a body, pairs that share a vertex are
    /// not counted.
    pub candidate_pairs: u64,
    /// Pairs of moving elements that were decided one by one, because separating directions in
    /// single precision did not keep them apart.
    pub scalar_decisions: u64,
    /// Candidates of which floating point left a sign open, so that exact arithmetic was needed. Of
    /// moving elements: pairs for which exact arithmetic decided whether they meet.
    pub exact_decisions: u64,
    /// Hits found.
    pub pairs: u64,
}

impl std::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        let Self {
            body_pairs,
            boxes_bottom_up,
            boxes_top_down,
            triangle_boxes,
            node_pairs,
            candidate_pairs,
            scalar_decisions,
            exact_decisions,
            pairs,
        } = other;
        self.body_pairs += body_pairs;
        self.boxes_bottom_up += boxes_bottom_up;
        self.boxes_top_down += boxes_top_down;
        self.triangle_boxes += triangle_boxes;
        self.node_pairs += node_pairs;
        self.candidate_pairs += candidate_pairs;
        self.scalar_decisions += scalar_decisions;
        self.exact_decisions += exact_decisions;
        self.pairs += pairs;
    }
}
