//! How much more the tree of a body does than a fresh one would, estimated from what queries did.
//!
//! What a query of triangles finds near each other, its *candidates*, does not depend on the tree,
//! nor does how many triangles there are; how many pairs of nodes it looks at on the way does. On
//! the scenes of this project fresh trees look at a pair of nodes for every two candidates of two
//! bodies, and in a body that meets itself at one for five candidates and, for its neighbours, at
//! about two for three triangles. How many these are for a triangle depends on the options and the
//! surface: the first query with a tree that was hardly edited since it was built tells, and of two
//! bodies how many are for a candidate. What is more than that is decay: nodes that have grown into
//! each other, or triangles that were taken out.

/// Pairs of nodes that a fresh tree looks at for each candidate of two bodies, of one with itself,
/// and for each triangle of that.
const OF_TWO: f64 = 0.45;
const OF_ONE: f64 = 0.2;
const OF_TRIANGLE: f64 = 0.69;

/// Fewer pairs of nodes say nothing.
const FEWEST: f64 = 256.0;

/// A fresh tree costs as much as looking at so many pairs of nodes, for each triangle.
const COST: f64 = 4.0;

/// While a query looks at a pair of nodes or of triangles, building looks at so many triangles: in
/// `shuffle` what is built in a step takes up to two thirds as long as its query. Slower, the old
/// tree decays meanwhile by more than that.
const PACE: f64 = 1.5;

/// For a pair of nodes that a fresh tree would have spared in the last shape, building looks at so
/// many triangles at most: the less a tree has decayed, the less hurry there is, and the shorter
/// are the steps in which it is mended.
const GAIN: f64 = 8.0;

/// What looking at a body cost, and what a fresh tree would look at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Work {
    /// Pairs of nodes that were looked at.
    node_pairs: u64,
    /// And of triangles.
    candidates: u64,
    /// Those of a fresh tree for candidates of this and another body, but for a factor,
    of_two: f64,
    /// for candidates of the body with itself,
    of_one: f64,
    /// and for its triangles, but for another factor.
    of_triangles: f64,
}

impl Work {
    /// Pairs of nodes and of triangles that were looked at.
    fn all(&self) -> f64 {
        (self.node_pairs + self.candidates) as f64
    }

    /// Of two bodies.
    pub(crate) fn of_two(node_pairs: u64, candidates: u64) -> Self {
        Self {
            node_pairs,
            candidates,
            of_two: OF_TWO * candidates as f64,
            ..Self::default()
        }
    }

    /// Of a body of so many triangles with itself.
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
    /// Since this one was built.
    since_built: f64,
    /// In the last shape alone.
    in_last_shape: f64,
    /// Of all pairs of nodes and of triangles that were looked at in the last shape.
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

    /// Whether a fresh tree of so many triangles would have paid by now.
    pub(super) fn is_worth_building(&self, triangles: usize) -> bool {
        self.since_built > COST * triangles as f64
    }
}

/// What queries did with the tree of a body since it was built.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Decay {
    /// In the shape of now, or in the last in which somebody looked.
    last: Work,
    version: u64,
    /// Whether the tree was hardly edited then, and tells what a fresh one does.
    is_hardly_edited: bool,
    /// Factors for triangles, and for candidates of two bodies; none before a query that says
    /// something.
    for_triangles: Option<f64>,
    for_two: Option<f64>,
    /// Pairs of nodes that a fresh tree would have spared, of all shapes before.
    spared: f64,
}

impl Decay {
    /// A body was looked at, in a version of its shape; its tree was hardly edited since it was
    /// built, or was.
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

    /// What was done in the last shape counts as done.
    fn settle(&mut self) {
        let last = self.last;
        let node_pairs = last.node_pairs as f64;
        // What was edited has decayed already.
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

    /// What a fresh tree would have looked at in the last shape, if that is known.
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

    /// How many pairs of nodes are looked at for one that a fresh tree would; 1 before anything is
    /// known.
    pub(crate) fn quality(&self) -> f64 {
        let expected = self.expected();
        expected.map_or(1.0, |expected| self.last.node_pairs as f64 / expected)
    }

    /// What a fresh tree would have spared by now. A shape is over.
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

    /// The tree is another, of the same kind: the factors stay.
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
        // What was edited does not tell what a fresh tree does.
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
