//! One pair of bodies, or one body with itself, in a query of some kind: shapes into tree order, upper levels refitted, trees
//! descended. Which bodies, `body_pairs` says.

use super::bodies::Bodies;
use super::body::Body;
use super::body_pairs::BodyPair;
use super::decay::Work;
use crate::geometry::Origin;
use crate::kernels::Coordinate;
use crate::queries::{Kind, Leaves};
use crate::statistics::Statistics;
use crate::traversal::{OneTree, Scratch, Side, Sink, TreePair, TwoTrees, descend};
use crate::tree::BoxSource;
use crate::update::{Partner, Refit};
use std::ops::ControlFlow;

/// Fewer pairs of nodes say nothing of how trees have decayed, and are not worth writing down.
const SAYS_NOTHING: u64 = 64;

/// What a query needs besides bodies.
pub(super) struct Step<'q, K: Kind> {
    pub(super) kind: &'q K,
    pub(super) refit: Refit<'q>,
    pub(super) origin: Origin,
    pub(super) scratch: &'q mut Scratch<K>,
    pub(super) statistics: &'q mut Statistics,
}

impl<K: Kind> Step<'_, K>
where
    K::Scalar: Coordinate,
{
    /// Shows what two bodies, or one and itself, do to each other. Breaks if the sink does, or if it is interrupted.
    pub(super) fn meet(
        &mut self,
        bodies: &mut Bodies<K::Scalar>,
        [a, b]: BodyPair,
        sink: &mut Sink<K::Hit>,
    ) -> ControlFlow<()> {
        if a == b {
            self.meet_itself(&mut bodies.list[a.index()], sink)
        } else {
            self.meet_another(bodies.two([a, b]), sink)
        }
    }

    /// Two different bodies.
    pub(super) fn meet_another(
        &mut self,
        both: [&mut Body<K::Scalar>; 2],
        sink: &mut Sink<K::Hit>,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        let before = self.looked_at();
        let [body_a, body_b] = both;
        self.bring_body_into_tree_order(body_a)?;
        self.bring_body_into_tree_order(body_b)?;
        let (parts_a, parts_b) = (body_a.parts.len(), body_b.parts.len());
        for a in 0..parts_a {
            for b in 0..parts_b {
                let a = self.ahead(body_a, a, Partner::Another)?;
                let b = self.ahead(body_b, b, Partner::Another)?;
                self.descend_two(TwoTrees { a, b }, parts_a + parts_b > 2, sink)?;
            }
        }
        if let Some([node_pairs, candidates]) = self.much_since(before) {
            let work = Work::of_two(node_pairs, candidates);
            for body in [body_a, body_b] {
                body.decay.note(work, body.epoch, body.is_hardly_edited());
            }
        }
        ControlFlow::Continue(())
    }

    /// One body with itself.
    pub(super) fn meet_itself(
        &mut self,
        body: &mut Body<K::Scalar>,
        sink: &mut Sink<K::Hit>,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        let before = self.looked_at();
        self.bring_body_into_tree_order(body)?;
        let parts = body.parts.len();
        for part in 0..parts {
            if K::LEAVES == Leaves::Triangles {
                body.know_neighbours(part, self.refit.executor);
            }
            let side = self.ahead(body, part, Partner::Itself)?;
            self.descend(&mut OneTree { side }, sink)?;
        }
        for high in 1..parts {
            for low in 0..high {
                let [mut a, mut b] = body.two_sides(self.kind, self.origin, [low, high]);
                self.refit_ahead(&mut a, Partner::Another)?;
                self.refit_ahead(&mut b, Partner::Another)?;
                self.descend_two(TwoTrees { a, b }, true, sink)?;
            }
        }
        if let Some([node_pairs, candidates]) = self.much_since(before) {
            let triangles = body.topology.live_count();
            let work = Work::of_one(node_pairs, candidates, triangles);
            body.decay.note(work, body.epoch, body.is_hardly_edited());
        }
        ControlFlow::Continue(())
    }

    /// Pairs of nodes and candidates that were looked at so far.
    fn looked_at(&self) -> [u64; 2] {
        [self.statistics.node_pairs, self.statistics.candidate_pairs]
    }

    /// The same since they were so, if that says anything of how trees have decayed.
    fn much_since(&self, before: [u64; 2]) -> Option<[u64; 2]> {
        let now = self.looked_at();
        let is_much = K::LEAVES == Leaves::Triangles && now[0] - before[0] >= SAYS_NOTHING;
        is_much.then(|| [now[0] - before[0], now[1] - before[1]])
    }

    /// Two trees; those of which bodies have several perhaps do not overlap.
    fn descend_two(
        &mut self,
        mut pair: TwoTrees<'_, K::Source<'_>>,
        are_several: bool,
        sink: &mut Sink<K::Hit>,
    ) -> ControlFlow<()> {
        if are_several && !pair.overlap() {
            return ControlFlow::Continue(());
        }
        self.descend(&mut pair, sink)
    }

    fn descend<P>(&mut self, pair: &mut P, sink: &mut Sink<K::Hit>) -> ControlFlow<()>
    where
        P: TreePair,
        P::Source: BoxSource<Scalar = K::Scalar>,
    {
        descend(
            self.refit,
            self.kind,
            pair,
            self.scratch,
            self.statistics,
            sink,
        )
    }

    /// Does for a body, early, what a query of it does before it descends.
    pub(super) fn prepare(
        &mut self,
        body: &mut Body<K::Scalar>,
        partner: Partner,
    ) -> ControlFlow<()> {
        self.bring_body_into_tree_order(body)?;
        for part in 0..body.parts.len() {
            if partner == Partner::Itself && K::LEAVES == Leaves::Triangles {
                body.know_neighbours(part, self.refit.executor);
            }
            let _ = self.ahead(body, part, partner)?;
        }
        ControlFlow::Continue(())
    }

    /// Brings a body into the order of its trees, and makes the boxes of its elements if the kind reads those. Breaks if it is interrupted.
    pub(super) fn bring_body_into_tree_order(
        &mut self,
        body: &mut Body<K::Scalar>,
    ) -> ControlFlow<()> {
        let executor = self.refit.executor;
        let instructions = self.refit.instructions;
        let reach = K::HOLDS_MOTIONS.then(|| self.kind.reach());
        if !body.bring_into_tree_order(reach, instructions, executor) {
            return ControlFlow::Break(());
        }
        if let Some(which) = K::LEAVES.elements()
            && !body.make_near_boxes(which, reach, self.origin, (instructions, executor))
        {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// A part of a body that was brought into tree order, with the upper levels of its boxes. Breaks if it is interrupted.
    pub(super) fn ahead<'b>(
        &mut self,
        body: &'b mut Body<K::Scalar>,
        part: usize,
        partner: Partner,
    ) -> ControlFlow<(), Side<'b, K::Source<'b>>> {
        let mut side = body.side(self.kind, self.origin, part);
        self.refit_ahead(&mut side, partner)?;
        ControlFlow::Continue(side)
    }

    /// Does what comes before the descent: the same for a query and for what is done early. Breaks if it is interrupted.
    fn refit_ahead(
        &mut self,
        side: &mut Side<'_, K::Source<'_>>,
        partner: Partner,
    ) -> ControlFlow<()> {
        let lists = &mut self.scratch.wide_nodes[0];
        let statistics = &mut *self.statistics;
        self.refit
            .ahead(&mut side.refitted(), partner, lists, statistics);
        let itself = partner == Partner::Itself;
        if itself && !K::HAS_RUNS && side.boxes.are_nodes_complete() {
            // Every leaf is going to meet at least itself.
            let reached = &mut self.scratch.reached;
            self.refit
                .all_leaves(&mut side.refitted(), reached, statistics);
        }
        if self.refit.executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}
