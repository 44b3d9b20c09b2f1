//! One pair of bodies, or one body with itself, in a query of some kind: shapes into tree order, upper levels refitted, trees
//! descended. Which bodies, `body_pairs` says.

use super::bodies::Bodies;
use super::body::Body;
use super::body_pairs::BodyPair;
use crate::geometry::Origin;
use crate::kernels::Coordinate;
use crate::queries::{Kind, Leaves};
use crate::statistics::Statistics;
use crate::traversal::{OneTree, Scratch, Side, Sink, TreePair, TwoTrees, descend};
use crate::tree::BoxSource;
use crate::update::{Partner, Refit};
use std::ops::ControlFlow;

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
    pub(super) fn meet<const N: usize>(
        &mut self,
        bodies: &mut Bodies<N, K::Scalar>,
        [a, b]: BodyPair,
        sink: Sink<K::Hit>,
    ) -> ControlFlow<()> {
        if a == b {
            self.meet_itself(&mut bodies.list[a.index()], sink)
        } else {
            self.meet_another(bodies.two([a, b]), sink)
        }
    }

    /// Two different bodies.
    pub(super) fn meet_another<const N: usize>(
        &mut self,
        both: [&mut Body<N, K::Scalar>; 2],
        sink: Sink<K::Hit>,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        let [a, b] = both.map(|body| self.ahead(body, Partner::Another));
        self.descend(&mut TwoTrees { a: a?, b: b? }, sink)
    }

    /// One body with itself.
    pub(super) fn meet_itself<const N: usize>(
        &mut self,
        body: &mut Body<N, K::Scalar>,
        sink: Sink<K::Hit>,
    ) -> ControlFlow<()> {
        self.statistics.body_pairs += 1;
        let side = self.ahead(body, Partner::Itself)?;
        self.descend(&mut OneTree { side }, sink)
    }

    fn descend<const N: usize, P>(&mut self, pair: &mut P, sink: Sink<K::Hit>) -> ControlFlow<()>
    where
        P: TreePair<N>,
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

    /// Does what comes before the descent: the same for a query and for what is done early. Breaks if it is interrupted.
    pub(super) fn ahead<'b, const N: usize>(
        &mut self,
        body: &'b mut Body<N, K::Scalar>,
        partner: Partner,
    ) -> ControlFlow<(), Side<'b, N, K::Source<'b>>> {
        let executor = self.refit.executor;
        let instructions = self.refit.instructions;
        let reach = K::HOLDS_MOTIONS.then(|| self.kind.reach());
        if !body.bring_into_tree_order(reach, instructions, executor) {
            return ControlFlow::Break(());
        }
        let itself = partner == Partner::Itself;
        if itself && K::LEAVES == Leaves::Triangles {
            body.tree.know_neighbours(&body.order, executor);
        }
        if let Some(which) = K::LEAVES.elements()
            && !body.make_near_boxes(which, reach, self.origin, (instructions, executor))
        {
            return ControlFlow::Break(());
        }
        let mut side = body.side(self.kind, self.origin);
        let lists = &mut self.scratch.wide_nodes[0];
        let statistics = &mut *self.statistics;
        self.refit
            .ahead(&mut side.refitted(), partner, lists, statistics);
        if itself && K::LEAVES.elements().is_none() && side.boxes.are_nodes_complete() {
            // Every leaf is going to meet at least itself.
            let reached = &mut self.scratch.reached;
            self.refit
                .all_leaves(&mut side.refitted(), reached, statistics);
        }
        if executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(side)
    }
}
