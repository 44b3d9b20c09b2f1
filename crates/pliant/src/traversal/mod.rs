//! From pairs of nodes to hits: tree against tree, and a tree against itself, for any kind of query.
//!
//! ```text
//! one task, its stack = [(root, root)]                      boxes valid and overlapping
//! while some task has pairs of nodes:
//!     distribute:  if one has none, or there is only one yet and it has many: the last of all pairs to all tasks
//!     every task, until it asks for boxes that are stale, or its list of leaves is long:
//!         take a batch from the top of its stack            hundreds; of a visitor 1 pair, then 2, 4, ...
//!         expand it: children whose boxes overlap onto the stack, pairs of leaves onto the list
//!     refit:       the wide nodes that they ask for         only refitting writes boxes
//!     when the lists are long, or the stacks empty:
//!         refit:   the boxes of the triangles in these leaves
//!         every task: test leaves: triangles whose boxes overlap are candidates; the kind of query decides these
//!         show:    the hits, to a visitor in order; every task shows a collector its own
//! ```
//!
//! Where all boxes were completed at once, those of triangles too, tasks are *free*: leaves are tested on the way, and nothing is waited
//! for. So it is for a body with itself if the update makes all its boxes ahead, as the default does; leaves that share a vertex are then
//! left out of the descent, and tested afterwards, list by list (`leaf_pairs`).
//!
//! Tasks and jobs of refitting write lists, or boxes, of their own; so threads share the work. How many tasks there are, and when
//! leaves are tested, may depend on the number of threads where all hits are wanted: the same boxes are then made and the same hits
//! found, which are sorted. What a visitor is shown, and in which order, never depends on it. Tasks are given what is last of all,
//! so that together they are at work in one place of the trees: given all there is, they would read from everywhere at once. Batches
//! come from the top of a stack, which bounds memory by depth x batch whatever the input is (all triangles in one place
//! included), and needs no recursion. Batches are long from the beginning where all hits are wanted: each ends in waiting for
//! the last task. For a visitor they start small, so that one that wants the first hit gets it after a few nodes, and double.
//!
//! What is done with leaves is behind a door, `queries::LeafWork`, of which every task has one; nothing here is compiled for a kind of
//! query, or for a degree.
//!
//! `nearest` is another loop, for two trees that are apart: not what overlaps is looked for, but what is least apart.
//!
//! A node is one box, a lane of a wide node (Embree calls the wide node a node). Differs from the paper, which descends pair by pair;
//! where all hits are wanted the boxes reached are the same but for the order.

mod block_pairs;
mod context;
mod descent;
mod leaf_pairs;
mod nearest;
mod rounds;
mod share;
mod sink;
mod task;
mod tree_pair;
mod walk;

pub(crate) use descent::{Scratch, descend};
pub(crate) use nearest::{NearestScratch, gap_square, nearest};
pub(crate) use rounds::{PairOf, Round, leaves_left_out};
pub(crate) use share::{Item, Piece};
pub(crate) use sink::{Collector, Sink, Visitor};
pub(crate) use task::{Task, TaskWork, Tasks};
pub(crate) use tree_pair::{Side, TreePair, View};
