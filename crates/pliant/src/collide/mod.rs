//! Collision queries over bodies: which pairs may meet, and their hits, pair by pair or many pairs
//! at once.
//!
//! - `request`, `asked`, `answer`: a query's parameters, how it is answered, and the hits of its
//!   tasks.
//! - `body_pairs`: the pairs of bodies that may meet.
//! - `step`: one pair of bodies; `together`: many pairs at once, on several threads.
//! - `witness`: the last first pair, tested before anything else.
//! - `close`, `distance`: close pairs measured; the distance of bodies.
//! - `impacts`: the first contact of a motion, and how far everything may move.
//! - `crossing_edges`: edges that cross triangles, from pairs of triangles.
//! - `adjacent`: triangles with a vertex in common, body by body.
//! - `origin`: the point that boxes are relative to.

mod adjacent;
mod answer;
mod asked;
mod body_pairs;
mod close;
mod crossing_edges;
mod distance;
mod impacts;
mod origin;
mod request;
mod step;
mod together;
mod witness;

pub(crate) use adjacent::AskedAdjacent;
pub(crate) use asked::{Asked, Common};
pub(crate) use body_pairs::BodyPairs;
pub(crate) use close::InBodies;
pub(crate) use crossing_edges::AskedCrossing;
pub(crate) use distance::{Distances, check, in_common, others_by_gap};
pub(crate) use impacts::{AskedImpacts, OfKind};
pub(crate) use origin::FloatingOrigin;
pub(crate) use request::{Ask, Request};
pub(crate) use witness::{Witnesses, near, pair_of};
