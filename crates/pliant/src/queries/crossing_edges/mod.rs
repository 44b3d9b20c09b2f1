//! Crossing edges: an edge and a triangle whose insides meet, and not in the triangle's plane.
//!
//! Idea: then every triangle that has the edge intersects the other, or shares a vertex with it and
//! crosses it beyond. So pairs that intersect are asked which of their six edges cross. Of the
//! triangles at an edge one has it as its own, and tells.

mod hit;

use super::contacts::ContactBuffers;
use super::intersections::eight;
use super::{Batch, CallerIds, Candidate, FoundBy, Kind, LeafTest, Needs, shows_hits};
use crate::held::empty;
use crate::kernels::Coordinate;
pub use hit::CrossingEdge;
use pliant_exact::crossing_edges;
use std::marker::PhantomData;

/// Kind of query: edges that cross triangles with which their own triangle shares no vertex.
#[derive(Debug)]
pub(crate) struct CrossingEdges<S> {
    scalar: PhantomData<S>,
}

empty!(CrossingEdges<S>: scalar);

/// A pair in tree order, which of its triangles has the edge, and the edge.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TreeCrossing {
    pair: Candidate,
    of: usize,
    /// By the caller's number.
    edge: u32,
}

impl<S: Coordinate> Kind for CrossingEdges<S> {
    type Scalar = S;
    type Hit = CrossingEdge;
    type TreeHit = TreeCrossing;
    type Buffers = ContactBuffers;

    shows_hits!();

    fn needs(&self) -> Needs {
        Needs {
            // An edge may cross what one of its triangles leaves out.
            leaves_out: false,
            ..Needs::TRIANGLES
        }
    }

    fn test(&self, leaves: &LeafTest<S>, batch: Batch, found: &mut FoundBy<Self>) {
        let ContactBuffers { undecided, pairs } = &mut found.buffers;
        let statistics = &mut found.statistics;
        pairs.clear();
        eight::decide(leaves, batch.triangles(), undecided, pairs, statistics);
        statistics.pairs -= pairs.len() as u64;
        for &pair in pairs.as_slice() {
            if leaves.interrupt.is_set() {
                return;
            }
            let [a, b] = [0, 1].map(|of| leaves.shapes[of].corners(pair[of]));
            let crossing = crossing_edges(S::PRECISION, &a, &b);
            for (of, corner) in (0..6).map(|edge| (edge / 3, edge % 3)) {
                if crossing[of][corner]
                    && let mesh = leaves.ids.meshes[of]
                    && let Some(edge) =
                        mesh.own_edge(pair[of], corner, &|| leaves.interrupt.is_set())
                {
                    statistics.pairs += 1;
                    found.hits.push(TreeCrossing { pair, of, edge });
                }
            }
        }
    }

    fn to_caller(&self, ids: &CallerIds, hit: TreeCrossing) -> CrossingEdge {
        let TreeCrossing { pair, of, edge } = hit;
        let other = 1 - of;
        CrossingEdge {
            edge_body: ids.bodies[of],
            edge,
            triangle_body: ids.bodies[other],
            triangle: ids.orders[other].caller_triangle(pair[other]).0,
        }
    }
}
