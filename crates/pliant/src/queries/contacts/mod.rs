//! Contacts: triangles that intersect, with the kind of each contact, all or of one kind alone.
//!
//! Candidates and decision are as of intersections. Pairs that `eight` decides on signs that are
//! certain and not zero are crossings. Only pairs that were left to exact signs are asked for their
//! kind.

mod hit;

use super::intersections::eight::{self, Undecided};
use super::{
    Batch, CallerIds, Candidate, FoundBy, Intersections, Kind, LeafTest, Needs, shows_hits,
};
use crate::held::held;
use crate::kernels::{Buffer, Coordinate};
pub use hit::{Contact, ContactKind};
use pliant_exact::contact_kind;

/// Kind of query: pairs of triangles that intersect, with the kinds of their contacts.
#[derive(Debug)]
pub(crate) struct Contacts<S> {
    intersections: Intersections<S>,
    only: Option<ContactKind>,
}

impl<S> Contacts<S> {
    /// Contacts of one kind, or of all kinds.
    pub(crate) fn of(only: Option<ContactKind>) -> Self {
        Self {
            intersections: Intersections::default(),
            only,
        }
    }
}

/// A pair in tree order, and the kind of its contact.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TreeContact {
    pair: Candidate,
    kind: ContactKind,
}

/// Scratch memory of a task: pairs that intersect, before their kind is known.
#[derive(Debug, Default)]
pub(crate) struct ContactBuffers {
    pub(in crate::queries) undecided: Undecided,
    pub(in crate::queries) pairs: Buffer<Candidate>,
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
