//! Counts of a check: sums over its frames.

use crate::check::Check;
use crate::error::Error;
use crate::found::Found;

/// Numbers of a check: sums over the frames that were counted.
///
/// A number is `None` where no frame has it: [`Found`] says which settings it needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Number of frames.
    pub frames: u64,
    /// Intersecting pairs, or close ones.
    pub pairs: u64,
    /// Edges of one body that cross triangles of another or of the same.
    pub crossing_edges: Option<u64>,
    /// Pairs that share a vertex.
    pub adjacent: Option<u64>,
    /// Pairs, among `pairs`, that only touch.
    pub touching: Option<u64>,
    /// Pairs with a triangle without area.
    pub degenerate: u64,
    /// Components inside bodies.
    pub inside: u64,
}

impl Counts {
    /// Checks and counts all frames that are left.
    ///
    /// Without [`listed`](crate::Settings::listed) no list of pairs takes memory.
    ///
    /// # Errors
    ///
    /// See [`Check::next_frame`].
    pub fn of(check: &mut Check) -> Result<Self, Error> {
        let mut counts = Self::default();
        while let Some(found) = check.next_frame()? {
            counts.add(&found);
        }
        Ok(counts)
    }

    /// Adds a frame.
    pub fn add(&mut self, found: &Found) {
        let add = |sum: &mut Option<u64>, count: Option<usize>| {
            if let Some(count) = count {
                *sum = Some(sum.unwrap_or(0) + count as u64);
            }
        };
        self.frames += 1;
        self.pairs += found.count as u64;
        self.degenerate += found.degenerate as u64;
        let edges = found.crossing_edges.as_ref();
        add(
            &mut self.crossing_edges,
            edges.map(|all| all.iter().map(|it| it.edges).sum()),
        );
        let adjacent = found.adjacent.as_ref();
        add(&mut self.adjacent, adjacent.map(|it| it.count));
        add(&mut self.touching, found.kinds.map(|it| it.touching));
        self.inside += found.inside.as_ref().map_or(0, |it| it.all.len() as u64);
    }
}
