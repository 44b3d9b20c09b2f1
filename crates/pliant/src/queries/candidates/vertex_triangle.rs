//! Vertices near triangles.

use super::runs::Runs;
use super::{Margin, groups};
use crate::geometry::{Aabb, Shape, larger};
use crate::held::Held;
use crate::hits::VertexTriangle;
use crate::ids::{TreeTriangle, TreeVertex};
use crate::kernels::{Buffer, Coordinate, Simd, dispatch};
use crate::mesh::TriangleRun;
use crate::queries::{BoxSetNumber, CallerIds, Kind, LeafTest, Leaves};
use crate::statistics::Statistics;
use crate::tree::{Grown, Swept};
use std::marker::PhantomData;

/// Vertices and triangles whose boxes are near each other, of one body or of two: the vertices of either.
#[derive(Debug)]
pub(crate) struct VertexTriangleCandidates<S> {
    margin: Margin,
    scalar: PhantomData<S>,
}

impl<S> VertexTriangleCandidates<S> {
    pub(crate) fn within(margin: Margin) -> Self {
        Self {
            margin,
            scalar: PhantomData,
        }
    }
}

/// The vertices that belong to runs, and the triangles in them, of either side.
#[derive(Debug, Default)]
pub(crate) struct VertexAndTriangleRuns {
    vertices: [Runs; 2],
    triangles: [Runs; 2],
}

/// Beside the number of a triangle: the vertex is of the second body. There are fewer triangles than this.
const OF_SECOND: u32 = 1 << 31;

impl<S: Coordinate> Kind for VertexTriangleCandidates<S> {
    type Scalar = S;
    type Hit = VertexTriangle;
    /// A vertex and a triangle in tree order, the triangle with [`OF_SECOND`] or without.
    type TreeHit = [u32; 2];
    type Buffers = VertexAndTriangleRuns;
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
        buffers: &mut VertexAndTriangleRuns,
        hits: &mut Buffer<[u32; 2]>,
        statistics: &mut Statistics,
    ) {
        let VertexAndTriangleRuns {
            vertices,
            triangles,
        } = buffers;
        for runs in vertices.iter_mut().chain(&mut *triangles) {
            runs.go_on(leaves.descent);
        }
        dispatch!(leaves.instructions, i => {
            for &[a, b] in pairs {
                for (side, [of, other]) in [[a, b], [b, a]].into_iter().enumerate() {
                    // Within one run, all of its vertices meet all of its triangles.
                    if side == 1 && leaves.itself && a == b {
                        break;
                    }
                    let vertices = &mut vertices[side];
                    let triangles = &mut triangles[1 - side];
                    self.compare(i, leaves, side, [of, other], [vertices, triangles], (hits, statistics));
                }
            }
        });
    }

    fn to_caller(&self, ids: &CallerIds, [vertex, triangle]: [u32; 2]) -> VertexTriangle {
        let side = usize::from(triangle & OF_SECOND != 0);
        let triangle = TreeTriangle(triangle & !OF_SECOND);
        let orders = ids.orders;
        VertexTriangle {
            vertex_body: ids.bodies[side],
            vertex: orders[side].caller_vertex(TreeVertex(vertex)).0,
            triangle_body: ids.bodies[1 - side],
            triangle: orders[1 - side].caller_triangle(triangle).0,
        }
    }
}

impl<S: Coordinate> VertexTriangleCandidates<S> {
    /// The vertices of a run of one side with the triangles of a run of the other.
    #[inline(always)]
    fn compare<I: Simd>(
        &self,
        i: I,
        leaves: &LeafTest<S>,
        side: usize,
        [run, other]: [TriangleRun; 2],
        [vertices, triangles]: [&mut Runs; 2],
        (hits, statistics): (&mut Buffer<[u32; 2]>, &mut Statistics),
    ) {
        let sides = [side, 1 - side];
        let [Some(of_vertices), Some(of_triangles)] = sides.map(|side| leaves.elements[side])
        else {
            return;
        };
        let [at_vertices, at_triangles] =
            sides.map(|side| (leaves.shapes[side], leaves.ends[side]));
        let corners = leaves.shapes[1 - side].triangles;
        let groups = of_vertices.groups.zip(of_triangles.groups);
        let is_candidate = |[vertex, triangle]: [u32; 2]| {
            let triangle = (triangle & !OF_SECOND) as usize;
            let [a, b, c] = corners[triangle].map(|corner| corner.0 == vertex);
            let is_shared = leaves.itself & (a | b | c);
            let meet = groups.is_none_or(|(of_vertices, of_triangles)| {
                let vertex = of_vertices.vertices[vertex as usize];
                groups::meet(vertex, of_triangles.triangles[triangle])
            });
            !is_shared & meet
        };
        let tag = if side == 1 { OF_SECOND } else { 0 };
        let numbers = of_vertices.edges.vertices_of(run);
        let vertices = vertices.get(i, run, at_vertices, numbers, |vertex| [TreeVertex(vertex)]);
        let of_triangle = |triangle: u32| corners[triangle as usize];
        let triangles = triangles.get(i, other, at_triangles, other.range(), of_triangle);
        let limits = self
            .margin
            .limits::<S>(larger(vertices.most, triangles.most));
        vertices.compare(
            i,
            triangles,
            false,
            limits,
            |[vertex, triangle], sure, possible| {
                let pair = |bit: u32| [vertex + bit / 8, (triangle + bit % 8) | tag];
                let mut near = possible;
                let mut rest = possible & !sure;
                while rest != 0 {
                    let [vertex, triangle] = pair(rest.trailing_zeros());
                    if is_candidate([vertex, triangle]) {
                        let corners = corners[(triangle & !OF_SECOND) as usize];
                        statistics.exact_decisions += 1;
                        if !self
                            .margin
                            .holds(leaves, sides, &[TreeVertex(vertex)], &corners)
                        {
                            near &= !(rest & rest.wrapping_neg());
                        }
                    }
                    rest &= rest - 1;
                }
                statistics.candidate_pairs += u64::from(near.count_ones());
                let before = hits.len();
                hits.room().push_bits_if(near, pair, is_candidate);
                statistics.pairs += (hits.len() - before) as u64;
            },
        );
    }
}

impl Held for VertexAndTriangleRuns {
    fn held(&self) -> usize {
        let all = self.vertices.iter().chain(&self.triangles);
        all.map(Held::held).sum()
    }
}
