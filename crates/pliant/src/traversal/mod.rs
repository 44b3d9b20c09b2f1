//! Dual-tree traversal: pairs of nodes whose boxes overlap, down to pairs of leaves and their
//! candidates.
//!
//! ```text
//! one task, its stack = [(root, root)]                      boxes valid and overlapping
//! while some task has pairs of nodes:
//!     distribute:  if a task is idle, or the only one has many: the last pairs, to all tasks
//!     every task, until it needs stale boxes, or its list of pairs of leaves is long:
//!         take a batch from the top of its stack            hundreds; for a visitor 1, 2, 4, ...
//!         expand it: children that overlap onto the stack, pairs of leaves onto the list
//!     refit:       the stale wide nodes that tasks need     only refitting writes boxes
//!     when the lists are long, or the stacks empty:
//!         refit:   the boxes of the triangles in these leaves
//!         every task: test leaves: triangles whose boxes overlap are candidates,
//!                     which the kind of query decides
//!         show:    the hits, to a visitor in order; every task shows a collector its own
//! ```
//!
//! Idea: tasks descend depth first in batches from the top of a stack, with no recursion.
//! Invariant: tasks and jobs of refitting write only lists, or boxes, of their own. A visitor sees
//! the same hits in the same order whatever the number of threads is. Difference from the paper,
//! which descends pair by pair: batches change the order in which boxes are reached. Where all hits
//! are wanted, the boxes reached are the same.
//!
//! - **Memory** is bounded by depth x batch for any input, even with all triangles in one place.
//! - **Batches**: long from the beginning where all hits are wanted, since each ends with a wait
//!   for the last task. For a visitor they start small and double: one that wants the first hit
//!   gets it after a few nodes.
//! - **Distribution**: tasks get the last pairs only. They then work in one place of the trees,
//!   instead of reading from everywhere at once.
//! - **Threads**: where all hits are wanted, the number of tasks, and when leaves are tested, may
//!   depend on the number of threads. The same boxes are then made, and the same hits found, which
//!   are sorted.
//! - **Free tasks**: where an update completed all boxes, including the triangles' boxes, tasks
//!   test leaves on the way and wait for nothing. This is the default for a body with itself. The
//!   descent then leaves out leaves that share a vertex; `leaf_pairs` tests them afterwards, list
//!   by list.
//! - **Kinds of query**: every task has a `queries::LeafWork`, which processes leaves. Nothing here
//!   is compiled for a kind of query, or for a degree.
//! - `nearest` is a branch and bound over two trees that are apart: it looks for the smallest gap,
//!   not for overlaps.
//! - **Node**: one box, a lane of a wide node (Embree calls the wide node a node).

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
pub(crate) use rounds::{Pairs, Round};
pub(crate) use share::{Item, Piece};
pub(crate) use sink::{Collector, Sink, Visitor};
pub(crate) use task::{Task, TaskWork, Tasks};
pub(crate) use tree_pair::{Read, Side, TreePair, View, Views};
