//! Decay of a body's tree: its work relative to a fresh tree's, estimated from the work of queries.
//!
//! The number of pairs of triangles whose boxes overlap, the *candidates*, does not depend on the
//! tree; the number of pairs of nodes tested does. On this project's scenes, fresh trees need a
//! constant number of pairs of nodes per candidate and per triangle ([`OF_TWO`], [`OF_ONE`],
//! [`OF_TRIANGLE`]). The constants vary with options and surface; the first query with a hardly
//! edited tree gives factors for them. More work than that is decay: nodes that have grown into
//! each other, or removed triangles.

/// Pairs of nodes that a fresh tree tests for each candidate of two bodies: about one for two.
const OF_TWO: f64 = 0.45;
/// Pairs of nodes that a fresh tree tests for each candidate of a body with itself: one for five.
const OF_ONE: f64 = 0.2;
/// Pairs of nodes that a fresh tree of a body that meets itself tests for each triangle, about two
/// for three, because of neighbours.
const OF_TRIANGLE: f64 = 0.69;

/// The fewest pairs of nodes that say something.
const FEWEST: f64 = 256.0;

/// Cost of building a fresh tree, in tests of pairs of nodes for each triangle.
const COST: f64 = 4.0;

/// Looks of building at triangles for each pair of nodes or triangles that a query tests.
///
/// In `shuffle` the share built in a step takes up to two thirds as long as its query. At a slower
/// pace the old tree decays meanwhile by more than that.
const PACE: f64 = 1.5;

/// The most looks of building for each pair of nodes that a fresh tree would have spared in the
/// last shape.
///
/// The less a tree has decayed, the less hurry there is, and the shorter are the steps in which it
/// is mended.
const GAIN: f64 = 8.0;

/// Work of queries on a body, and the estimated work of a fresh tree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Work {
    /// Pairs of nodes tested.
    node_pairs: u64,
    /// Pairs of triangles tested.
    candidates: u64,
    /// Pairs of nodes that a fresh tree tests for candidates of this and another body, up to a
    /// factor.
    of_two: f64,
    /// Pairs of nodes that a fresh tree tests for candidates of the body with itself.
    of_one: f64,
    /// Pairs of nodes that a fresh tree tests for the body's triangles, up to another factor.
    of_triangles: f64,
}

impl Work {
    /// Pairs of nodes and of triangles tested.
    fn all(&self) -> f64 {
        (self.node_pairs + self.candidates) as f64
    }

    /// Work of a query on two bodies.
    pub(crate) fn of_two(node_pairs: u64, candidates: u64) -> Self {
        Self {
            node_pairs,
            candidates,
            of_two: OF_TWO * candidates as f64,
            ..Self::default()
        }
    }

    /// Work of a query on a body of `triangles` triangles with itself.
    pub(crate) fn of_one(node_pairs: u64, candidates: u64, triangles: usize) -> Self {
        Self {
            node_pairs,
            candidates,
            of_one: OF_ONE * candidates as f64,
            of_triangles: OF_TRIANGLE * triangles as f64,
            ..Self::default()
        }
    }
}

/// Pairs of nodes that a fresh tree would have spared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spared {
    /// Pairs spared since the present tree was built.
    since_built: f64,
    /// Pairs spared in the last shape alone.
    in_last_shape: f64,
    /// Pairs of nodes and of triangles tested in the last shape.
    looked_at: f64,
}

impl Spared {
    /// Triangles that building looks at in this step.
    #[expect(
        clippy::cast_sign_loss,
        reason = "neither what was looked at nor what would have been spared is negative"
    )]
    pub(super) fn looks(&self) -> usize {
        (PACE * self.looked_at).min(GAIN * self.in_last_shape) as usize
    }

    /// Whether a fresh tree of `triangles` triangles would have paid by now.
    pub(super) fn is_worth_building(&self, triangles: usize) -> bool {
        self.since_built > COST * triangles as f64
    }
}

/// Record of the work of queries with the tree of a body since it was built.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Decay {
    /// Work in the present shape, or in the last one that was queried, and its version.
    last: Work,
    version: u64,
    /// Whether the tree was hardly edited then, and so tells what a fresh one does.
    is_hardly_edited: bool,
    /// Factors for triangles, and for candidates of two bodies. None before a query that says
    /// something.
    for_triangles: Option<f64>,
    for_two: Option<f64>,
    /// Pairs of nodes that a fresh tree would have spared, in all earlier shapes.
    spared: f64,
}

impl Decay {
    /// Notes the work of a query in a version of the shape, and whether the tree was hardly edited
    /// since it was built.
    pub(crate) fn note(&mut self, work: Work, version: u64, is_hardly_edited: bool) {
        if self.version != version {
            self.settle();
            self.version = version;
            self.is_hardly_edited = is_hardly_edited;
        }
        self.last.node_pairs += work.node_pairs;
        self.last.candidates += work.candidates;
        self.last.of_two += work.of_two;
        self.last.of_one += work.of_one;
        self.last.of_triangles += work.of_triangles;
    }

    /// Adds the work of the last shape to the record.
    fn settle(&mut self) {
        let last = self.last;
        let node_pairs = last.node_pairs as f64;
        // An edited tree has decayed already.
        if self.is_hardly_edited && last.of_triangles >= FEWEST {
            let rest = (node_pairs - last.of_one - last.of_two).max(0.0);
            self.for_triangles.get_or_insert(rest / last.of_triangles);
        } else if self.is_hardly_edited && last.of_two >= FEWEST {
            self.for_two.get_or_insert(node_pairs / last.of_two);
        }
        if let Some(expected) = self.expected() {
            self.spared += (node_pairs - expected).max(0.0);
        }
        self.last = Work::default();
    }

    /// Estimated pairs of nodes of a fresh tree in the last shape, if the factors are known.
    fn expected(&self) -> Option<f64> {
        let last = self.last;
        let of_two = self.for_two.unwrap_or(1.0) * last.of_two;
        let expected = match self.for_triangles {
            Some(factor) => factor * last.of_triangles + last.of_one + of_two,
            None if last.of_triangles == 0.0 && self.for_two.is_some() => of_two,
            None => return None,
        };
        (expected >= FEWEST && last.node_pairs as f64 >= FEWEST).then_some(expected)
    }

    /// Pairs of nodes tested for each that a fresh tree would test. It is 1 before anything is
    /// known.
    pub(crate) fn quality(&self) -> f64 {
        let expected = self.expected();
        expected.map_or(1.0, |expected| self.last.node_pairs as f64 / expected)
    }

    /// Ends a shape, and returns what a fresh tree would have spared by now.
    pub(crate) fn spared(&mut self) -> Spared {
        let looked_at = self.last.all();
        let before = self.spared;
        self.settle();
        Spared {
            since_built: self.spared,
            in_last_shape: self.spared - before,
            looked_at,
        }
    }

    /// Begins anew with an exchanged tree of the same kind: the factors stay.
    pub(crate) fn begin_anew(&mut self) {
        self.last = Work::default();
        self.spared = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_more_than_at_first_is_decay() {
        let mut decay = Decay::default();
        assert_eq!(decay.quality(), 1.0);
        let is = |found: f64, expected: f64| (found - expected).abs() < 1e-6;
        // An edited tree does not tell what a fresh tree does.
        decay.note(Work::of_one(14_400, 1_000, 10_000), 7, false);
        assert_eq!(decay.quality(), 1.0);
        decay.note(Work::of_one(7_200, 1_000, 10_000), 1, true);
        assert_eq!(decay.quality(), 1.0);
        decay.note(Work::of_one(14_400, 1_000, 10_000), 2, true);
        assert!(is(decay.quality(), 2.0));
        let spared = decay.spared();
        assert!(is(spared.since_built, 7_200.0) && is(spared.in_last_shape, 7_200.0));
        assert!(is(spared.looked_at, 15_400.0));
        decay.begin_anew();
        let spared = decay.spared();
        assert_eq!(
            [spared.since_built, spared.in_last_shape, spared.looked_at],
            [0.0; 3]
        );
        // More triangles and candidates are no decay, nor is another body.
        decay.note(Work::of_one(14_400, 2_000, 20_000), 3, false);
        assert!(is(decay.quality(), 1.0));
        decay.note(Work::of_two(4_500, 10_000), 3, false);
        assert!(is(decay.quality(), 1.0));
    }
}
