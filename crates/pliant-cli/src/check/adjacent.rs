//! Totals of pairs that share a vertex, and the line that says them.

use super::figures::counted;
use crate::table::grouped;
use pliant_check::{Found, Kinds};

/// Pairs that share a vertex, over all frames so far.
#[derive(Default)]
pub(super) struct AdjacentTally {
    kinds: Kinds,
    twice: usize,
}

impl AdjacentTally {
    pub(super) fn count(&mut self, found: &Found) {
        let Some(adjacent) = &found.adjacent else {
            return;
        };
        self.kinds += adjacent.kinds;
        self.twice += adjacent.twice;
    }

    /// A line about them, if there are any.
    pub(super) fn said(&self) -> Option<String> {
        let Kinds {
            crossing,
            overlapping,
            touching,
        } = self.kinds;
        let all = crossing + overlapping + touching;
        if all == 0 {
            return None;
        }
        let pairs = counted((
            all,
            "pair of triangles shares a vertex and meets beyond it",
            "pairs of triangles share a vertex and meet beyond it",
        ));
        let [cross, overlap, touch] = [crossing, overlapping, touching].map(|n| grouped(n as u64));
        let twice = match self.twice {
            0 => String::new(),
            count => format!(
                "; {}",
                counted((count, "triangle stands twice", "triangles stand twice"))
            ),
        };
        Some(format!(
            "{pairs}: {cross} cross, {overlap} overlap in a plane, {touch} touch{twice}"
        ))
    }
}
