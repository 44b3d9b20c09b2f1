//! Queries of bodies: which of them may meet, and what they do to each other, pair by pair or many pairs at once.
//!
//! `asked` answers a `request` of some kind, pair by pair (`step`) or many pairs at once (`scheduler`); an `answer` is what its tasks find.
//! `body_pairs` says who may meet whom, `witness` is the last first pair, `origin` what boxes are relative to. Close pairs are put in
//! order and measured in `close`; how far bodies are apart is found in `distance`. What meets first, and how far everything may go, is
//! found in `impacts`.

mod answer;
mod asked;
mod body_pairs;
mod close;
mod distance;
mod impacts;
mod origin;
mod request;
mod scheduler;
mod step;
mod witness;

pub(crate) use asked::{Asked, Common};
pub(crate) use body_pairs::BodyPairs;
pub(crate) use close::InBodies;
pub(crate) use distance::{Distances, check, in_common, others_by_gap};
pub(crate) use impacts::{AskedImpacts, OfKind};
pub(crate) use origin::FloatingOrigin;
pub(crate) use request::{Ask, Request};
pub(crate) use witness::{Witnesses, near, pair_of};
