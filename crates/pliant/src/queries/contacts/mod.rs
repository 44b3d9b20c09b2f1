//! Triangles that intersect, and how: the same candidates, the same decision, and then the kind of each pair, or those of one kind alone.
//!
//! What `eight` decides on signs that are certain and not zero crosses. Only pairs that were left to exact signs are asked for their kind.

mod hit;

use super::intersections::eight::{self, Undecided};
use super::{
    Batch, CallerIds, Candidate, FoundBy, Intersections, Kind, LeafTest, Needs, shows_hits,
};
use crate::held::held;
use crate::kernels::{Buffer, Coordinate};
pub use hit::{Contact, ContactKind};
use pliant_exact::contact_kind;

/// Pairs of triangles that intersect, with their kinds.
#[derive(Debug)]
pub(crate) struct Contacts<S> {
    intersections: Intersections<S>,
    only: Option<ContactKind>,
}

impl<S> Contacts<S> {
    /// Of one kind, or of all.
    pub(crate) fn of(only: Option<ContactKind>) -> Self {
        Self {
            intersections: Intersections::default(),
            only,
        }
    }
}

/// A pair in tree order, and its kind.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TreeContact {
    pair: Candidate,
    kind: ContactKind,
}

/// What a task keeps: pairs that intersect, before it is known how.
#[derive(Debug, Default)]
pub(crate) struct ContactBuffers {
    undecided: Undecided,
    pairs: Buffer<Candidate>,
}

impl<S: Coordinate> Kind for Contacts<S> {
    type Scalar = S;
    type Hit = Contact;
    type TreeHit = TreeContact;
    type Buffers = ContactBuffers;

    shows_hits!();

    fn needs(&self) -> Needs {
        Needs::TRIANGLES
    }

    fn test(&self, leaves: &LeafTest<S>, batch: Batch, found: &mut FoundBy<Self>) {
        let ContactBuffers { undecided, pairs } = &mut found.buffers;
        let statistics = &mut found.statistics;
        pairs.clear();
        let crossing = eight::decide(leaves, batch.triangles(), undecided, pairs, statistics);
        let all = pairs.as_slice();
        statistics.pairs -= all.len() as u64;
        for (place, &pair) in all.iter().enumerate() {
            let kind = if place < crossing {
                ContactKind::Crossing
            } else if leaves.interrupt.is_set() {
                return;
            } else {
                let [a, b] = pair;
                let (a, b) = (leaves.shapes[0].corners(a), leaves.shapes[1].corners(b));
                contact_kind(S::PRECISION, &a, &b)
            };
            if self.only.is_none_or(|only| only == kind) {
                statistics.pairs += 1;
                found.hits.push(TreeContact { pair, kind });
            }
        }
    }

    #[inline]
    fn to_caller(&self, ids: &CallerIds, hit: TreeContact) -> Contact {
        Contact {
            pair: self.intersections.to_caller(ids, hit.pair),
            kind: hit.kind,
        }
    }
}

held!(ContactBuffers: undecided, pairs);
