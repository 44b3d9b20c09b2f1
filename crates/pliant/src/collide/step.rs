//! One pair of bodies, or one body with itself, in a query: tree order, refit of upper levels,
//! descent.
//!
//! `body_pairs` decides which bodies these are.

use super::body_pairs::BodyPair;
use crate::bodies::Bodies;
use crate::bodies::Body;
use crate::bodies::Work;
use crate::geometry::Origin;
use crate::kernels::Coordinate;
use crate::queries::{Needs, Shown};
use crate::statistics::Statistics;
use crate::traversal::{Scratch, Side, Tasks, TreePair, descend};
use crate::update::{Partner, Refit};
use std::ops::ControlFlow;

/// Fewest pairs of nodes that tell how trees have decayed; fewer are not worth noting.
pub(super) const SAYS_NOTHING: u64 = 64;

/// Context of a query besides its bodies.
pub(crate) struct Step<'q> {
    pub(crate) needs: Needs,
    pub(crate) refit: Refit<'q>,
    pub(crate) origin: Origin,
    pub(crate) scratch: &'q mut Scratch,
    pub(crate) statistics: &'q mut Statistics,
}

impl Step<'_> {
    /// Passes the hits of two bodies, or of one with itself, to the sink. Breaks if the sink does,
    /// or if interrupted.
    pub(crate) fn meet<S: Coordinate>(
        &mut self,
        bodies: &mut Bodies<S>,
        [a, b]: BodyPair,
        tasks: &mut dyn Tasks<S>,
    ) -> ControlFlow<()> {
        if a == b {
            self.meet_itself(bodies.at_mut(a), tasks)
        } else {
            self.meet_another(bodies.two([a, b]), tasks)
        }
    }

    /// Processes two different bodies.
    pub(crate) fn meet_another<S: Coordinate>(
        &mut self,
        both: [&mut Body<S>; 2],
        tasks: &mut dyn Tasks<S>,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        let before = self.looked_at();
        let [body_a, body_b] = both;
        self.bring_body_into_tree_order(body_a)?;
        self.bring_body_into_tree_order(body_b)?;
        let (parts_a, parts_b) = (body_a.part_count(), body_b.part_count());
        for a in 0..parts_a {
            for b in 0..parts_b {
                let a = self.ahead(body_a, a, Partner::Another)?;
                let b = self.ahead(body_b, b, Partner::Another)?;
                self.descend_two([a, b], parts_a + parts_b > 2, tasks)?;
            }
        }
        if let Some([node_pairs, candidates]) = self.much_since(before) {
            let work = Work::of_two(node_pairs, candidates);
            for body in [body_a, body_b] {
                body.note_work(work);
            }
        }
        ControlFlow::Continue(())
    }

    /// Processes one body with itself.
    pub(crate) fn meet_itself<S: Coordinate>(
        &mut self,
        body: &mut Body<S>,
        tasks: &mut dyn Tasks<S>,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        let before = self.looked_at();
        self.bring_body_into_tree_order(body)?;
        let parts = body.part_count();
        for part in 0..parts {
            if self.needs.triangles() {
                body.know_neighbours(part, self.refit.executor);
            }
            let side = self.ahead(body, part, Partner::Itself)?;
            self.descend(&mut TreePair::One(side), tasks)?;
        }
        for high in 1..parts {
            for low in 0..high {
                let [mut a, mut b] = body.two_sides(&self.needs, self.origin, [low, high]);
                self.refit_ahead(&mut a, Partner::Another)?;
                self.refit_ahead(&mut b, Partner::Another)?;
                self.descend_two([a, b], true, tasks)?;
            }
        }
        if let Some([node_pairs, candidates]) = self.much_since(before) {
            let triangles = body.mesh().topology().live_count();
            body.note_work(Work::of_one(node_pairs, candidates, triangles));
        }
        ControlFlow::Continue(())
    }

    /// Pairs of nodes and candidates so far.
    fn looked_at(&self) -> [u64; 2] {
        [self.statistics.node_pairs, self.statistics.candidate_pairs]
    }

    /// Pairs of nodes and candidates since `before`, if enough to tell how trees have decayed.
    fn much_since(&self, before: [u64; 2]) -> Option<[u64; 2]> {
        let now = self.looked_at();
        let is_much = self.needs.triangles() && now[0] - before[0] >= SAYS_NOTHING;
        is_much.then(|| [now[0] - before[0], now[1] - before[1]])
    }

    /// Descends two trees. Where bodies have several trees, skips two whose root boxes do not
    /// overlap.
    fn descend_two<S: Coordinate>(
        &mut self,
        both: [Side<'_, S>; 2],
        are_several: bool,
        tasks: &mut dyn Tasks<S>,
    ) -> ControlFlow<()> {
        let mut pair = TreePair::Two(both);
        if are_several && !pair.views().do_overlap() {
            return ControlFlow::Continue(());
        }
        self.descend(&mut pair, tasks)
    }

    fn descend<S: Coordinate>(
        &mut self,
        pair: &mut TreePair<S>,
        tasks: &mut dyn Tasks<S>,
    ) -> ControlFlow<()> {
        let (scratch, statistics) = (&mut *self.scratch, &mut *self.statistics);
        descend(self.refit, self.needs, pair, tasks, scratch, statistics)
    }

    /// Does early for a body what a query does before it descends.
    pub(crate) fn prepare<S: Coordinate>(
        &mut self,
        body: &mut Body<S>,
        partner: Partner,
    ) -> ControlFlow<()> {
        self.bring_body_into_tree_order(body)?;
        for part in 0..body.part_count() {
            if partner == Partner::Itself && self.needs.triangles() {
                body.know_neighbours(part, self.refit.executor);
            }
            let _ = self.ahead(body, part, partner)?;
        }
        ControlFlow::Continue(())
    }

    /// Brings a body into the order of its trees, and refits the boxes of its elements if the kind
    /// reads them. Breaks if interrupted.
    pub(crate) fn bring_body_into_tree_order<S: Coordinate>(
        &mut self,
        body: &mut Body<S>,
    ) -> ControlFlow<()> {
        let executor = self.refit.executor;
        let instructions = self.refit.instructions;
        let reach = self.needs.reach;
        if !body.bring_into_tree_order(reach, instructions, executor) {
            return ControlFlow::Break(());
        }
        if let Shown::Runs(which) = self.needs.leaves
            && !body.make_near_boxes(which, reach, self.origin, (instructions, executor))
        {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Part of a body in tree order, with the upper levels of its boxes refitted. Breaks if
    /// interrupted.
    pub(crate) fn ahead<'b, S: Coordinate>(
        &mut self,
        body: &'b mut Body<S>,
        part: usize,
        partner: Partner,
    ) -> ControlFlow<(), Side<'b, S>> {
        let mut side = body.side(&self.needs, self.origin, part);
        self.refit_ahead(&mut side, partner)?;
        ControlFlow::Continue(side)
    }

    /// Refits the boxes that are completed ahead of the descent, for a query or early work alike.
    /// Breaks if interrupted.
    fn refit_ahead<S: Coordinate>(
        &mut self,
        side: &mut Side<'_, S>,
        partner: Partner,
    ) -> ControlFlow<()> {
        let lists = &mut self.scratch.wide_nodes[0];
        let statistics = &mut *self.statistics;
        self.refit
            .ahead(&mut side.refitted(), partner, lists, statistics);
        let itself = partner == Partner::Itself;
        if itself && self.needs.triangles() && side.boxes.are_nodes_complete() {
            // Every leaf is going to meet at least itself.
            let [reached, _] = &mut self.scratch.reached;
            self.refit
                .all_leaves(&mut side.refitted(), reached, statistics);
        }
        if self.refit.executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}
