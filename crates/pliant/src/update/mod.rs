//! Making boxes true for the shape a body has now (paper, 3.3).
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
//! `hybrid` decides how far ahead, `bottom_up` makes some levels below a group, `top_down` makes what a traversal reaches, and
//! `make` makes the boxes, for all of them; `leaves` makes those of single triangles; `noted` is what was reached. Boxes made are counted, so that the strategies can be compared by their work.

mod bottom_up;
mod hybrid;
mod leaves;
mod make;
mod noted;
mod top_down;

use crate::exec::Threads;
use crate::geometry::{Scalar, Shape};
use crate::kernels::Level;
use crate::options::Update;
use crate::statistics::Statistics;
use crate::tree::Tree;
use make::Work;
pub(crate) use noted::Noted;

/// What a body meets in a query: of how much of its tree boxes are made ahead depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meets {
    Another,
    /// Then every leaf meets at least itself.
    Itself,
}

/// What updates work with.
#[derive(Clone, Copy)]
pub(crate) struct Updates<'w> {
    pub(crate) threads: &'w Threads,
    pub(crate) level: Level,
    pub(crate) update: Update,
}

impl Updates<'_> {
    /// Makes the upper levels true, unless they are. `groups` is scratch.
    pub(crate) fn refresh_ahead<const N: usize, S: Scalar>(
        &self,
        tree: &mut Tree<N>,
        shape: &Shape<S>,
        meets: Meets,
        groups: &mut Vec<u32>,
        statistics: &mut Statistics,
    ) {
        hybrid::refresh_ahead(
            self.work(shape),
            tree,
            self.update,
            meets,
            groups,
            statistics,
        );
    }

    /// Makes groups true that a traversal has reached; they are not true. The lists are scratch.
    pub(crate) fn reach<const N: usize, S: Scalar>(
        &self,
        tree: &mut Tree<N>,
        shape: &Shape<S>,
        reached: &mut Noted,
        lists: &mut [Vec<u32>; 2],
        statistics: &mut Statistics,
    ) {
        let levels = self.update.levels_at_once();
        let work = self.work(shape);
        statistics.boxes_top_down += top_down::reach_groups(work, tree, reached, levels, lists);
    }

    /// Makes true the boxes of triangles in leaves that a traversal has reached; some may be true.
    pub(crate) fn reach_leaves<const N: usize, S: Scalar>(
        &self,
        tree: &mut Tree<N>,
        shape: &Shape<S>,
        reached: &mut Noted,
        statistics: &mut Statistics,
    ) {
        statistics.triangle_boxes += leaves::reach_leaves(self.work(shape), tree, reached);
    }

    /// Makes true the boxes of the triangles in all leaves. `reached` is scratch.
    pub(crate) fn make_leaves<const N: usize, S: Scalar>(
        &self,
        tree: &mut Tree<N>,
        shape: &Shape<S>,
        reached: &mut Noted,
        statistics: &mut Statistics,
    ) {
        if tree.leaves.complete != shape.epoch {
            reached.note_below(tree.leaves.len());
            self.reach_leaves(tree, shape, reached, statistics);
            tree.leaves.complete = shape.epoch;
        }
    }

    fn work<'w, 's, S>(&'w self, shape: &'w Shape<'s, S>) -> Work<'w, 's, S> {
        Work {
            threads: self.threads,
            level: self.level,
            shape,
        }
    }
}
