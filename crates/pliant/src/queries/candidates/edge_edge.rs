//! Edges near edges.

use super::{Margin, Which, groups, keep};
use crate::geometry::{Aabb, Shape, larger};
use crate::hits::EdgeEdge;
use crate::ids::TreeEdge;
use crate::kernels::{Buffer, Coordinate, dispatch};
use crate::queries::{BoxSetNumber, CallerIds, Kind, LeafTest, Leaves};
use crate::statistics::Statistics;
use crate::tree::{Grown, Swept};
use std::marker::PhantomData;

/// Edges whose boxes are near each other.
#[derive(Debug)]
pub(crate) struct EdgeEdgeCandidates<S> {
    margin: Margin,
    scalar: PhantomData<S>,
}

impl<S> EdgeEdgeCandidates<S> {
    pub(crate) fn within(margin: Margin) -> Self {
        Self {
            margin,
            scalar: PhantomData,
        }
    }
}

impl<S: Coordinate> Kind for EdgeEdgeCandidates<S> {
    type Scalar = S;
    type Hit = EdgeEdge;
    /// Edges in tree order.
    type TreeHit = [u32; 2];
    type Buffers = ();
    type Source<'s> = Grown<Swept<'s, S>>;

    const BOX_SET: BoxSetNumber = 1;
    const LEAVES: Leaves = Leaves::Runs(Which::Edges);
    const HOLDS_MOTIONS: bool = true;

    fn grows_by(&self) -> f32 {
        self.margin.grown_by
    }

    fn body_box(&self, of_shape: Aabb) -> Aabb {
        self.margin.body_box(of_shape)
    }

    fn source<'s>(&self, shape: Shape<'s, S>, end: Option<Shape<'s, S>>) -> Grown<Swept<'s, S>> {
        self.margin.source(shape, end)
    }

    fn test_runs(
        &self,
        leaves: &LeafTest<S>,
        pairs: &[[u32; 2]],
        hits: &mut Buffer<[u32; 2]>,
        statistics: &mut Statistics,
    ) {
        let [Some(of_a), Some(of_b)] = leaves.elements else {
            return;
        };
        let (Some(runs_a), Some(runs_b)) = (&of_a.boxes.edges, &of_b.boxes.edges) else {
            return;
        };
        let [ends_a, ends_b] = [of_a.edges.ends(), of_b.edges.ends()];
        let limits = self
            .margin
            .limits::<S>(larger(runs_a.most(), runs_b.most()));
        let groups = of_a.groups.zip(of_b.groups);
        let is_left_out = |[a, b]: [u32; 2]| {
            let (edge_a, edge_b) = (ends_a[a as usize], ends_b[b as usize]);
            let is_shared = (edge_a[0] == edge_b[0])
                | (edge_a[0] == edge_b[1])
                | (edge_a[1] == edge_b[0])
                | (edge_a[1] == edge_b[1]);
            let meet = groups.is_none_or(|(of_a, of_b)| {
                groups::meet(of_a.edges[a as usize], of_b.edges[b as usize])
            });
            leaves.itself & is_shared | !meet
        };
        let holds = |[a, b]: [u32; 2]| {
            let (a, b) = (&ends_a[a as usize], &ends_b[b as usize]);
            self.margin.holds(leaves, [0, 1], a, b)
        };
        let before = hits.len();
        dispatch!(leaves.instructions, i => {
            for &[a, b] in pairs {
                let itself = leaves.itself && a == b;
                let (a, b) = (runs_a.run(a), runs_b.run(b));
                a.compare(i, &b, itself, limits, |[first_a, first_b], sure, possible| {
                    let pair = |bit: u32| [first_a + bit / 8, first_b + bit % 8];
                    keep([sure, possible], pair, is_left_out, holds, hits, statistics);
                });
            }
        });
        statistics.pairs += (hits.len() - before) as u64;
    }

    fn to_caller(&self, ids: &CallerIds, [a, b]: [u32; 2]) -> EdgeEdge {
        let number = |side: usize, edge: u32| {
            let elements = ids.elements[side].as_ref();
            elements.map_or(edge, |it| it.edges.caller_edge(TreeEdge(edge)))
        };
        let a = (ids.bodies[0], number(0, a));
        let b = (ids.bodies[1], number(1, b));
        let ((body_a, edge_a), (body_b, edge_b)) = (a.min(b), a.max(b));
        EdgeEdge {
            body_a,
            edge_a,
            body_b,
            edge_b,
        }
    }
}
