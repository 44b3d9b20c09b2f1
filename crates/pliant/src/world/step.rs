//! One query of two bodies or of one: boxes compared, upper levels made true, trees descended. Which bodies, the broad phase
//! says: see `queries`.

use super::body::Body;
use crate::exec::Threads;
use crate::geometry::{Origin, Scalar};
use crate::kernels::Level;
use crate::options::Update;
use crate::statistics::Statistics;
use crate::traversal::{OneTree, Scratch, Show, Side, TwoTrees, descend};
use crate::tree::Tree;
use crate::update::{Meets, Updates};
use std::ops::ControlFlow;

/// What a query needs besides bodies and their trees.
pub(super) struct Step<'w> {
    pub(super) update: Update,
    pub(super) level: Level,
    pub(super) threads: &'w Threads,
    pub(super) origin: Origin,
    pub(super) scratch: &'w mut Scratch,
    pub(super) statistics: &'w mut Statistics,
}

/// A body and its tree.
pub(super) struct Planted<'w, const N: usize, S> {
    pub(super) body: &'w mut Body<S>,
    pub(super) tree: &'w mut Tree<N>,
}

impl<'w, const N: usize, S> Planted<'w, N, S> {
    /// The body at a place.
    pub(super) fn at(bodies: &'w mut [Body<S>], trees: &'w mut [Tree<N>], place: usize) -> Self {
        Self {
            body: &mut bodies[place],
            tree: &mut trees[place],
        }
    }

    /// The bodies at two places.
    pub(super) fn both(
        bodies: &'w mut [Body<S>],
        trees: &'w mut [Tree<N>],
        places: [usize; 2],
    ) -> [Self; 2] {
        let different = "two different bodies, one tree each";
        let [body_a, body_b] = bodies.get_disjoint_mut(places).expect(different);
        let [tree_a, tree_b] = trees.get_disjoint_mut(places).expect(different);
        [(body_a, tree_a), (body_b, tree_b)].map(|(body, tree)| Self { body, tree })
    }

    /// The same for a while.
    pub(super) fn again(&mut self) -> Planted<'_, N, S> {
        Planted {
            body: self.body,
            tree: self.tree,
        }
    }

    fn side(self, origin: Origin) -> Side<'w, N, S>
    where
        S: Scalar,
    {
        let body = &*self.body;
        Side {
            tree: self.tree,
            mesh: &body.mesh,
            shape: body.shape(origin),
        }
    }
}

impl<'w> Step<'w> {
    fn updates(&self) -> Updates<'w> {
        Updates {
            threads: self.threads,
            level: self.level,
            update: self.update,
        }
    }

    /// Makes the upper levels of a tree true for this frame.
    pub(super) fn refresh_ahead<const N: usize, S: Scalar>(
        &mut self,
        Planted { body, tree }: &mut Planted<N, S>,
        meets: Meets,
    ) {
        body.bring_into_order(self.level, self.threads);
        let shape = body.shape(self.origin);
        let updates = self.updates();
        let groups = &mut self.scratch.groups[0];
        updates.refresh_ahead(tree, &shape, meets, groups, self.statistics);
    }

    /// Two different bodies; shown are (triangle of the first, triangle of the second).
    pub(super) fn meet<const N: usize, S: Scalar>(
        &mut self,
        mut both: [Planted<N, S>; 2],
        show: Show,
    ) -> ControlFlow<()> {
        let [box_a, box_b] = both.each_ref().map(|one| one.body.exact_box(self.origin));
        if !box_a.overlaps(&box_b) {
            return ControlFlow::Continue(());
        }
        self.statistics.body_pairs += 1;
        both.iter_mut()
            .for_each(|one| self.refresh_ahead(one, Meets::Another));
        let [a, b] = both.map(|one| one.side(self.origin));
        let meeting = &mut TwoTrees { a, b };
        descend(self.updates(), meeting, self.scratch, self.statistics, show)
    }

    /// A body with itself; shown are (smaller triangle, larger triangle).
    pub(super) fn meet_itself<const N: usize, S: Scalar>(
        &mut self,
        mut one: Planted<N, S>,
        show: Show,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        self.refresh_ahead(&mut one, Meets::Itself);
        let side = one.side(self.origin);
        side.tree.know_neighbours(side.mesh);
        let updates = self.updates();
        if side.tree.complete == side.shape.epoch {
            // Every leaf is going to meet at least itself.
            let reached = &mut self.scratch.reached;
            updates.make_leaves(side.tree, &side.shape, reached, self.statistics);
        }
        let meeting = &mut OneTree { side };
        descend(updates, meeting, self.scratch, self.statistics, show)
    }
}
