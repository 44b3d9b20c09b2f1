//! One query of two bodies or of one: boxes compared, upper levels made true, trees descended. Which bodies, the broad phase
//! says: see `queries`.

use super::body::Body;
use crate::exec::Threads;
use crate::geometry::{Origin, Scalar};
use crate::kernels::Level;
use crate::options::Options;
use crate::statistics::Statistics;
use crate::traversal::{OneTree, Scratch, Show, Side, TwoTrees, descend};
use crate::tree::Tree;
use crate::update::Updates;
use std::ops::ControlFlow;

/// What a query needs besides trees.
pub(super) struct Step<'w, S> {
    pub(super) options: &'w Options,
    pub(super) level: Level,
    pub(super) threads: &'w Threads,
    pub(super) bodies: &'w mut [Body<S>],
    pub(super) origin: Origin,
    pub(super) scratch: &'w mut Scratch,
    pub(super) statistics: &'w mut Statistics,
}

impl<'w, S: Scalar> Step<'w, S> {
    fn updates(&self) -> Updates<'w> {
        Updates {
            threads: self.threads,
            level: self.level,
            update: self.options.update,
        }
    }

    /// Makes the upper levels of a tree true for this frame, for a query of a body with `itself` or of two.
    pub(super) fn refresh_ahead<const N: usize>(
        &mut self,
        tree: &mut Tree<N>,
        body: usize,
        itself: bool,
    ) {
        self.bodies[body].bring_into_order(self.level, self.threads);
        let updates = self.updates();
        let shape = self.bodies[body].shape(self.origin);
        let groups = &mut self.scratch.groups[0];
        updates.refresh_ahead(tree, &shape, itself, groups, self.statistics);
    }

    /// Two different bodies; shown are (triangle of `a`, triangle of `b`).
    pub(super) fn meet<const N: usize>(
        &mut self,
        trees: &mut [Tree<N>],
        [a, b]: [usize; 2],
        show: Show,
    ) -> ControlFlow<()> {
        let [box_a, box_b] = [a, b].map(|body| self.bodies[body].exact_box(self.origin));
        if !box_a.overlaps(&box_b) {
            return ControlFlow::Continue(());
        }
        self.statistics.body_pairs += 1;
        let [tree_a, tree_b] = trees
            .get_disjoint_mut([a, b])
            .expect("two different bodies, one tree each");
        self.refresh_ahead(tree_a, a, false);
        self.refresh_ahead(tree_b, b, false);
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        let updates = self.updates();
        let mut meeting = TwoTrees {
            a: Side {
                tree: tree_a,
                mesh: &body_a.mesh,
                shape: body_a.shape(self.origin),
            },
            b: Side {
                tree: tree_b,
                mesh: &body_b.mesh,
                shape: body_b.shape(self.origin),
            },
        };
        descend(updates, &mut meeting, self.scratch, self.statistics, show)
    }

    /// A body with itself; shown are (smaller triangle, larger triangle).
    pub(super) fn meet_itself<const N: usize>(
        &mut self,
        tree: &mut Tree<N>,
        body: usize,
        show: Show,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        self.refresh_ahead(tree, body, true);
        let body = &self.bodies[body];
        tree.know_neighbours(&body.mesh);
        let updates = self.updates();
        let shape = body.shape(self.origin);
        if tree.complete == shape.epoch {
            // Every leaf is going to meet at least itself.
            updates.make_leaves(tree, &shape, &mut self.scratch.reached, self.statistics);
        }
        let mut meeting = OneTree {
            side: Side {
                tree,
                mesh: &body.mesh,
                shape,
            },
        };
        descend(updates, &mut meeting, self.scratch, self.statistics, show)
    }
}
