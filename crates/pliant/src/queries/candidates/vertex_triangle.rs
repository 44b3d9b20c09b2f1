//! Candidates of vertices and triangles.

use super::hit::VertexTriangle;
use super::{Candidates, keep};
use crate::geometry::larger;
use crate::ids::{TreeTriangle, TreeVertex};
use crate::kernels::{Coordinate, dispatch};
use crate::queries::near::runs::{RUNS_AT_ONCE, RunPairs, near_runs};
use crate::queries::near::{Which, groups};
use crate::queries::{Batch, CallerIds, FoundBy, Kind, LeafTest, Needs, shows_hits};

/// Kind of query: vertices and triangles whose boxes are near each other, of one body or of two,
/// the vertices of either.
pub(crate) type VertexTriangleCandidates<S> = Candidates<VertexTriangle, S>;

/// Flag beside the number of a triangle: the vertex is the second body's. Numbers of triangles are
/// below it.
const OF_SECOND: u32 = 1 << 31;

impl<S: Coordinate> Kind for VertexTriangleCandidates<S> {
    type Scalar = S;
    type Hit = VertexTriangle;
    /// A vertex and a triangle in tree order, the triangle with or without [`OF_SECOND`].
    type TreeHit = [u32; 2];
    type Buffers = ();

    shows_hits!();

    fn needs(&self) -> Needs {
        self.margin.needs(Which::VerticesAndTriangles)
    }

    fn test(&self, leaves: &LeafTest<S>, batch: Batch, found: &mut FoundBy<Self>) {
        let pairs = batch.runs();
        let before = found.hits.len();
        for side in 0..2 {
            self.test_side(leaves, side, pairs, found);
        }
        found.statistics.pairs += (found.hits.len() - before) as u64;
    }

    #[inline]
    fn to_caller(&self, ids: &CallerIds, hit: [u32; 2]) -> VertexTriangle {
        let (side, vertex, triangle) = Self::sides_of(hit);
        let orders = ids.orders;
        VertexTriangle {
            vertex_body: ids.bodies[side],
            vertex: orders[side].caller_vertex(vertex).0,
            triangle_body: ids.bodies[1 - side],
            triangle: orders[1 - side].caller_triangle(triangle).0,
        }
    }
}

impl<S: Coordinate> VertexTriangleCandidates<S> {
    /// Side of the vertex of a candidate, the vertex, and the triangle, which is of the other side.
    #[inline]
    pub(crate) fn sides_of([vertex, triangle]: [u32; 2]) -> (usize, TreeVertex, TreeTriangle) {
        let side = usize::from(triangle & OF_SECOND != 0);
        (
            side,
            TreeVertex(vertex),
            TreeTriangle(triangle & !OF_SECOND),
        )
    }

    /// Tests the vertices of runs of one side against the triangles of runs of the other.
    fn test_side(
        &self,
        leaves: &LeafTest<S>,
        side: usize,
        pairs: &[[u32; 2]],
        found: &mut FoundBy<Self>,
    ) {
        let sides = [side, 1 - side];
        let [Some(of_vertices), Some(of_triangles)] = sides.map(|side| leaves.elements[side])
        else {
            return;
        };
        let boxes = (&of_vertices.boxes.vertices, &of_triangles.boxes.triangles);
        let (Some(vertices), Some(triangles)) = boxes else {
            return;
        };
        let limits = self
            .margin
            .limits::<S>(leaves, larger(vertices.most(), triangles.most()));
        let corners = leaves.shapes[1 - side].triangles;
        let groups = of_vertices.groups.zip(of_triangles.groups);
        let removed = (of_vertices.removed, of_triangles.removed);
        let is_any_left_out = groups.is_some() || removed.0.is_some() || removed.1.is_some();
        let meet = is_any_left_out.then_some(|[vertex, triangle]: [u32; 2]| {
            let triangle = triangle & !OF_SECOND;
            let groups_meet = groups.is_none_or(|(of_vertices, of_triangles)| {
                let vertex = of_vertices.vertices[vertex as usize];
                groups::meet(vertex, of_triangles.triangles[triangle as usize])
            });
            let is_gone = || {
                let vertex = removed
                    .0
                    .is_some_and(|it| it.has_vertex(TreeVertex(vertex)));
                vertex || removed.1.is_some_and(|it| it.has(TreeTriangle(triangle)))
            };
            groups_meet && !is_gone()
        });
        let holds = |[vertex, triangle]: [u32; 2]| {
            let corners = &corners[(triangle & !OF_SECOND) as usize];
            self.margin
                .holds(leaves, sides, &[TreeVertex(vertex)], corners)
        };
        let tag = if side == 1 { OF_SECOND } else { 0 };
        dispatch!(leaves.instructions, i => {
            for pairs in pairs.chunks(RUNS_AT_ONCE) {
                let runs = RunPairs {
                    pairs,
                    first: side,
                    // Within one run, side 0 has paired all of its vertices with all of its
                    // triangles.
                    without_itself: side == 1 && leaves.is_one_tree,
                };
                let mut kept = [[0; 2]; RUNS_AT_ONCE];
                for &[a, b] in near_runs(i, (vertices, triangles), runs, limits, &mut kept) {
                    let (a, b) = (vertices.run(a), triangles.run(b));
                    a.compare(i, &b, leaves.is_one_body, limits, |[first, second], near, sure| {
                        let pair = |bit: u32| [first + bit / 8, (second + bit % 8) | tag];
                        keep([near, sure], pair, meet, holds, found);
                    });
                }
            }
        });
    }
}
