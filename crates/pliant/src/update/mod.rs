//! Refitting: making boxes valid for the shape a body has now (paper, 3.3).
//!
//! One idea carries all three strategies of the paper: the boxes down to some level are made *ahead*, all at once and
//! bottom-up; what lies deeper is made top-down, when it is *reached*.
//!
//! ```text
//! bottom-up   ahead: down to the deepest leaf
//! top-down    ahead: the root only
//! hybrid      ahead: down to level floor(n / 2), or a given one, where n is the level of the deepest leaf;
//!             all levels, if none is given and much of the tree was reached the last time, or a body meets itself
//! ```
//!
//! `hybrid` decides how far ahead, `bottom_up` refits some levels below a wide node, `top_down` what a traversal reaches, and `refit`
//! makes the boxes, for all of them; `leaves` makes those of single triangles, `whole` all
//! of a body that meets itself, `quantize` quantizes them; a `DirtySet` is what was reached. Boxes made are
//! counted, so that the strategies can be compared by their work. What boxes are made of (`Source`) and
//! the degree are types where boxes are made, and matched on once a batch.

mod bottom_up;
mod dirty_set;
mod hybrid;
mod leaves;
mod quantize;
mod refit;
mod refitted;
mod top_down;
mod whole;

use crate::ids::WideNodeId;
use crate::kernels::Coordinate;
use crate::statistics::Statistics;
pub(crate) use dirty_set::DirtySet;
pub(crate) use refitted::{Partner, Refit, Refitted};

impl Refit<'_> {
    /// Refits the upper levels, unless they are valid. `wide_nodes` is scratch.
    pub(crate) fn ahead<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        partner: Partner,
        wide_nodes: &mut Vec<WideNodeId>,
        statistics: &mut Statistics,
    ) {
        hybrid::refit_ahead(self, one, partner, wide_nodes, statistics);
    }

    /// Refits wide nodes that a traversal has reached; they are stale. The lists are scratch.
    pub(crate) fn reached<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        reached: &mut DirtySet,
        lists: &mut [Vec<WideNodeId>; 2],
        statistics: &mut Statistics,
    ) {
        statistics.boxes_top_down += top_down::refit_reached(self, one, reached, lists);
    }

    /// Makes the boxes of triangles in leaves that a traversal has reached; some may be valid.
    pub(crate) fn reached_leaves<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        reached: &mut DirtySet,
        statistics: &mut Statistics,
    ) {
        statistics.triangle_boxes += leaves::refit_leaves(self, one, reached);
    }

    /// Makes the boxes of the triangles in all leaves, and quantizes them where leaves are blocks; all nodes are valid. `reached` is
    /// scratch.
    pub(crate) fn all_leaves<S: Coordinate>(
        &self,
        one: &mut Refitted<S>,
        reached: &mut DirtySet,
        statistics: &mut Statistics,
    ) {
        if !one.boxes.are_leaves_complete() {
            reached.insert_below(one.tree.leaves.len());
            self.reached_leaves(one, reached, statistics);
            one.boxes.complete_leaves();
        }
        quantize::quantize_all(self, one);
    }
}
