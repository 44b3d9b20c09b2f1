//! Candidates of edges and edges.

use super::hit::EdgeEdge;
use super::{Candidates, keep};
use crate::geometry::larger;
use crate::kernels::ring::Ring;
use crate::kernels::{Coordinate, dispatch};
use crate::queries::near::runs::{RUNS_AT_ONCE, RunPairs, near_runs};
use crate::queries::near::{Which, groups};
use crate::queries::{Batch, CallerIds, FoundBy, Kind, LeafTest, Needs, shows_hits};

/// Kind of query: pairs of edges whose boxes are near each other.
pub(crate) type EdgeEdgeCandidates<S> = Candidates<EdgeEdge, S>;

impl<S: Coordinate> Kind for EdgeEdgeCandidates<S> {
    type Scalar = S;
    type Hit = EdgeEdge;
    /// Two edges in tree order.
    type TreeHit = [u32; 2];
    type Buffers = ();

    shows_hits!();

    fn needs(&self) -> Needs {
        self.margin.needs(Which::Edges)
    }

    fn test(&self, leaves: &LeafTest<S>, batch: Batch, found: &mut FoundBy<Self>) {
        let pairs = batch.runs();
        let [Some(of_a), Some(of_b)] = leaves.elements else {
            return;
        };
        let (Some(runs_a), Some(runs_b)) = (&of_a.boxes.edges, &of_b.boxes.edges) else {
            return;
        };
        let [ends_a, ends_b] = [of_a.edges.ends(), of_b.edges.ends()];
        let limits = self
            .margin
            .limits::<S>(leaves, larger(runs_a.most(), runs_b.most()));
        let groups = of_a.groups.zip(of_b.groups);
        let removed = [of_a, of_b].map(|side| side.removed.map(|_| side.edges));
        let is_any_left_out = groups.is_some() || removed.iter().any(Option::is_some);
        let meet = is_any_left_out.then_some(|pair: [u32; 2]| {
            let is_gone = |which: usize| removed[which].is_some_and(|it| it.is_gone(pair[which]));
            let groups_meet = groups.is_none_or(|(of_a, of_b)| {
                groups::meet(of_a.edges[pair[0] as usize], of_b.edges[pair[1] as usize])
            });
            groups_meet && !is_gone(0) && !is_gone(1)
        });
        let holds = |[a, b]: [u32; 2]| {
            let (a, b) = (&ends_a[a as usize], &ends_b[b as usize]);
            self.margin.holds(leaves, [0, 1], a, b)
        };
        let mut ring = Ring::EMPTY;
        let before = found.hits.len();
        dispatch!(leaves.instructions, i => {
            for pairs in pairs.chunks(RUNS_AT_ONCE) {
                let runs = RunPairs {
                    pairs,
                    first: 0,
                    without_itself: false,
                };
                let mut kept = [[0; 2]; RUNS_AT_ONCE];
                for &[a, b] in near_runs(i, (runs_a, runs_b), runs, limits, &mut kept) {
                    if leaves.is_one_tree && a == b {
                        runs_a.run(a).compare_within(i, &mut ring, limits, |pair, is_sure| {
                            keep([1, u64::from(is_sure)], |_| pair, meet, holds, found);
                        });
                        continue;
                    }
                    let (a, b) = (runs_a.run(a), runs_b.run(b));
                    a.compare(i, &b, leaves.is_one_body, limits, |[first_a, first_b], near, sure| {
                        let pair = |bit: u32| [first_a + bit / 8, first_b + bit % 8];
                        keep([near, sure], pair, meet, holds, found);
                    });
                }
            }
        });
        found.statistics.pairs += (found.hits.len() - before) as u64;
    }

    #[inline]
    fn to_caller(&self, ids: &CallerIds, hit: [u32; 2]) -> EdgeEdge {
        let [body_a, body_b] = ids.bodies;
        let [a, b] = Self::of_caller(ids, hit);
        // In one body the smaller edge is first. A branch on which one that is could not be
        // predicted.
        let [edge_a, edge_b] = if body_a == body_b {
            [a.min(b), a.max(b)]
        } else {
            [a, b]
        };
        EdgeEdge {
            body_a,
            edge_a,
            body_b,
            edge_b,
        }
    }
}

impl<S> EdgeEdgeCandidates<S> {
    /// Whether the caller's numbers put the second edge before the first.
    #[inline]
    pub(crate) fn is_swapped(ids: &CallerIds, hit: [u32; 2]) -> bool {
        let [a, b] = Self::of_caller(ids, hit);
        ids.bodies[0] == ids.bodies[1] && b < a
    }

    #[inline]
    fn of_caller(ids: &CallerIds, [a, b]: [u32; 2]) -> [u32; 2] {
        [ids.edges[0][a as usize], ids.edges[1][b as usize]]
    }
}
