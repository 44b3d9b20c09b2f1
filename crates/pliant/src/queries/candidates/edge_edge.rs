//! Edges near edges.

use super::runs::Runs;
use super::{Margin, groups};
use crate::geometry::{Aabb, Shape, larger};
use crate::held::Held;
use crate::hits::EdgeEdge;
use crate::ids::TreeEdge;
use crate::kernels::{Buffer, Coordinate, dispatch};
use crate::mesh::TriangleRun;
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

/// The edges that belong to runs, of either side.
#[derive(Debug, Default)]
pub(crate) struct EdgeRuns([Runs; 2]);

impl<S: Coordinate> Kind for EdgeEdgeCandidates<S> {
    type Scalar = S;
    type Hit = EdgeEdge;
    /// Edges in tree order.
    type TreeHit = [u32; 2];
    type Buffers = EdgeRuns;
    type Source<'s> = Grown<Swept<'s, S>>;

    const BOX_SET: BoxSetNumber = 1;
    const LEAVES: Leaves = Leaves::Runs;
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
        pairs: &[[TriangleRun; 2]],
        EdgeRuns([runs_a, runs_b]): &mut EdgeRuns,
        hits: &mut Buffer<[u32; 2]>,
        statistics: &mut Statistics,
    ) {
        let [Some(of_a), Some(of_b)] = leaves.elements else {
            return;
        };
        let [ends_a, ends_b] = [of_a.edges.ends(), of_b.edges.ends()];
        let [at_a, at_b] = [0, 1].map(|side| (leaves.shapes[side], leaves.ends[side]));
        let groups = of_a.groups.zip(of_b.groups);
        let is_candidate = |[a, b]: [u32; 2]| {
            let (edge_a, edge_b) = (ends_a[a as usize], ends_b[b as usize]);
            let is_shared = leaves.itself
                && (edge_a[0] == edge_b[0])
                    | (edge_a[0] == edge_b[1])
                    | (edge_a[1] == edge_b[0])
                    | (edge_a[1] == edge_b[1]);
            let meet = groups.is_none_or(|(of_a, of_b)| {
                groups::meet(of_a.edges[a as usize], of_b.edges[b as usize])
            });
            !is_shared & meet
        };
        runs_a.go_on(leaves.descent);
        runs_b.go_on(leaves.descent);
        dispatch!(leaves.instructions, i => {
            for &[a, b] in pairs {
                let itself = leaves.itself && a == b;
                let a = runs_a.get(i, a, at_a, of_a.edges.edges_of(a), |edge| ends_a[edge as usize]);
                let b = runs_b.get(i, b, at_b, of_b.edges.edges_of(b), |edge| ends_b[edge as usize]);
                let limits = self.margin.limits::<S>(larger(a.most, b.most));
                a.compare(i, b, itself, limits, |[first_a, first_b], sure, possible| {
                    let pair = |bit: u32| [first_a + bit / 8, first_b + bit % 8];
                    let mut near = possible;
                    let mut rest = possible & !sure;
                    while rest != 0 {
                        let [a, b] = pair(rest.trailing_zeros());
                        if is_candidate([a, b]) {
                            let corners = [ends_a[a as usize], ends_b[b as usize]];
                            statistics.exact_decisions += 1;
                            if !self.margin.holds(leaves, [0, 1], &corners[0], &corners[1]) {
                                near &= !(rest & rest.wrapping_neg());
                            }
                        }
                        rest &= rest - 1;
                    }
                    statistics.candidate_pairs += u64::from(near.count_ones());
                    let before = hits.len();
                    hits.room().push_bits_if(near, pair, is_candidate);
                    statistics.pairs += (hits.len() - before) as u64;
                });
            }
        });
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

impl Held for EdgeRuns {
    fn held(&self) -> usize {
        self.0.iter().map(Held::held).sum()
    }
}
