//! Boxes of a body's vertices, edges and triangles, each made when a query first needs them.

use super::groups::Groups;
use super::removed::Removed;
use super::runs::{Ends, RunBoxes};
use crate::held::held;
use crate::ids::TreeVertex;
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::{Elements, TriangleRun};
use crate::threads::Executor;
use crate::tree::{BoxSource, Grown, Rims, Tree};

/// Kinds of elements that a kind of query looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Which {
    VerticesAndTriangles,
    Edges,
}

/// Boxes of a body's elements.
#[derive(Debug, Default)]
pub(crate) struct NearBoxes {
    pub(in crate::queries) vertices: Option<RunBoxes<1>>,
    pub(in crate::queries) triangles: Option<RunBoxes<3>>,
    pub(in crate::queries) edges: Option<RunBoxes<2>>,
    rims: Rims,
}

/// Vertices and edges of a body, and their boxes.
#[derive(Clone, Copy)]
pub(crate) struct NearElements<'q> {
    pub(crate) edges: &'q Elements,
    pub(crate) boxes: &'q NearBoxes,
    /// Collision groups of the elements. None where all vertices meet.
    pub(crate) groups: Option<&'q Groups>,
    /// Removed triangles and vertices. None where nothing was removed.
    pub(crate) removed: Option<Removed<'q>>,
}

impl NearBoxes {
    /// Rims of the tree's nodes, of the version of the boxes.
    pub(crate) fn rims(&self) -> &Rims {
        &self.rims
    }

    /// Makes the boxes of some kinds of elements, unless they are already of the version of the
    /// source, which grows by nothing. Returns false if interrupted.
    pub(crate) fn make<S: Coordinate>(
        &mut self,
        which: Which,
        source: &Grown<S>,
        threads: (Instructions, Executor),
        (tree, elements): (&Tree, &Elements),
    ) -> bool {
        if !self.rims.make(tree, source, threads.1) {
            return false;
        }
        let version = source.version();
        let positions: Ends<S> = (&source.from, source.to.map(|end| end.positions));
        let leaves = &tree.leaves;
        let runs = || (0..leaves.run_count() as u32).map(|number| leaves.run(number));
        match which {
            Which::VerticesAndTriangles => {
                let vertices = self.vertices.get_or_insert_with(|| {
                    let of_runs = runs().map(|it| elements.vertices_of(it));
                    RunBoxes::new(of_runs, |vertex| [TreeVertex(vertex)])
                });
                let triangles = self.triangles.get_or_insert_with(|| {
                    let corners = positions.0.triangles;
                    RunBoxes::new(runs().map(TriangleRun::range), |it| corners[it as usize])
                });
                vertices.make(version, threads, positions)
                    && triangles.make(version, threads, positions)
            }
            Which::Edges => {
                let edges = self.edges.get_or_insert_with(|| {
                    let of_runs = runs().map(|it| elements.edges_of(it));
                    RunBoxes::new(of_runs, |edge| elements.ends()[edge as usize])
                });
                edges.make(version, threads, positions)
            }
        }
    }
}

held!(NearBoxes: vertices, triangles, edges, rims);
