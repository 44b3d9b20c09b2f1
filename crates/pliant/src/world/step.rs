//! One query of two bodies or of one: boxes compared, upper levels made true, trees descended. Which bodies, the broad phase
//! says: see `queries`.

use super::body::Body;
use crate::geometry::Scalar;
use crate::options::Options;
use crate::statistics::Statistics;
use crate::traversal::{OneTree, Scratch, Side, TwoTrees, descend};
use crate::tree::Tree;
use crate::update::refresh_ahead;
use std::ops::ControlFlow;

/// What is shown every pair, as the caller numbers triangles, until it breaks.
pub(super) type Visit<'v> = &'v mut dyn FnMut([u32; 2]) -> ControlFlow<()>;

/// What a query needs besides trees.
pub(super) struct Step<'w, S> {
    pub(super) options: &'w Options,
    pub(super) bodies: &'w [Body<S>],
    pub(super) origin: [f64; 3],
    pub(super) scratch: &'w mut Scratch,
    pub(super) statistics: &'w mut Statistics,
}

impl<S: Scalar> Step<'_, S> {
    /// Makes the upper levels of a tree true for this frame.
    pub(super) fn refresh_ahead<const N: usize>(&mut self, tree: &mut Tree<N>, body: usize) {
        let shape = self.bodies[body].shape(self.origin);
        let update = self.options.update;
        let boxes = refresh_ahead(tree, update, &shape, &mut self.scratch.groups);
        // The root alone, from the vertices, is the beginning of top-down.
        let top_down = update == crate::Update::TopDown;
        *(if top_down {
            &mut self.statistics.boxes_top_down
        } else {
            &mut self.statistics.boxes_bottom_up
        }) += boxes;
    }

    /// Two different bodies; the visitor sees (triangle of `a`, triangle of `b`).
    pub(super) fn meet<const N: usize>(
        &mut self,
        trees: &mut [Tree<N>],
        [a, b]: [usize; 2],
        visit: Visit,
    ) -> ControlFlow<()> {
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        if !body_a
            .exact_box(self.origin)
            .overlaps(&body_b.exact_box(self.origin))
        {
            return ControlFlow::Continue(());
        }
        self.statistics.body_pairs += 1;
        let [tree_a, tree_b] = trees
            .get_disjoint_mut([a, b])
            .expect("two different bodies, one tree each");
        self.refresh_ahead(tree_a, a);
        self.refresh_ahead(tree_b, b);
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
            levels_at_once: self.options.update.levels_at_once(),
        };
        descend(&mut meeting, self.scratch, self.statistics, visit)
    }

    /// A body with itself; the visitor sees (smaller triangle, larger triangle).
    pub(super) fn meet_itself<const N: usize>(
        &mut self,
        tree: &mut Tree<N>,
        body: usize,
        visit: Visit,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        self.refresh_ahead(tree, body);
        let body = &self.bodies[body];
        let mut meeting = OneTree {
            side: Side {
                tree,
                mesh: &body.mesh,
                shape: body.shape(self.origin),
            },
            levels_at_once: self.options.update.levels_at_once(),
        };
        descend(&mut meeting, self.scratch, self.statistics, visit)
    }
}
