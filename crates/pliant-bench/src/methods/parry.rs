//! parry3d: a `TriMesh` whose vertices move, and its `Bvh::leaf_pairs`.
//!
//! The shortest public way through the library, which is also the fastest: `TriMesh::update_vertices` writes the vertices and
//! refits the whole binary tree in place, one triangle a leaf; `leaf_pairs` descends two trees together and yields pairs of
//! leaves whose boxes overlap; then comes the decision of the bench. The library's own test of two triangles (GJK) is not
//! used: it is slower, and reports near neighbours in one plane. A tree against itself is `traverse_bvtt_single_tree`, each
//! pair once.
//!
//! The mesh keeps the only copy of vertices and triangles. Boxes of bodies are those of the roots, met by brute force.
//!
//! The tree is the one that `TriMesh` builds (binned surface area heuristic on the first shape), refitted for ever; the library
//! could reorder or rebuild it, at a price every step.
//!
//! Boxes are counted by the size of the trees, box tests between bodies in the check given to `leaf_pairs`. What
//! `leaf_pairs` does before its first check (four pairs of children of the roots, taken as overlapping) and the box tests of a
//! tree with itself are not visible, and not counted.

use super::answer::{Answer, Proposer, self_pair};
use super::bodies::share_a_vertex;
use crate::decision::{Decision, Triangle};
use crate::motion::{BodyMesh, Shape};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::Vector;
use parry3d::partitioning::BvhWorkspace;
use parry3d::shape::{TriMesh, TriMeshFlags};
use std::cell::Cell;
use std::ops::ControlFlow;

/// parry3d, refitted.
pub struct Parry {
    meshes: Vec<TriMesh>,
    boxes: Vec<Aabb>,
    workspace: BvhWorkspace,
    answer: Answer,
}

impl Parry {
    /// The library's trees with this decision.
    pub fn new(decision: Decision) -> Self {
        Self {
            meshes: Vec::new(),
            boxes: Vec::new(),
            workspace: BvhWorkspace::default(),
            answer: Answer::new(decision),
        }
    }
}

#[inline]
fn corners(mesh: &TriMesh, triangle: u32) -> Triangle {
    let vertices = mesh.vertices();
    mesh.indices()[triangle as usize].map(|vertex| vertices[vertex as usize].to_array())
}

impl Proposer for Parry {
    fn name(&self) -> String {
        "parry3d 0.31".to_owned()
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        let mesh = |body: &BodyMesh<'_>| {
            let vertices = body.shape.world.iter().map(|&p| Vector::from(p)).collect();
            TriMesh::with_flags(vertices, body.triangles.to_vec(), TriMeshFlags::DEFORMABLE)
                .expect("a scene's bodies have triangles")
        };
        self.meshes = bodies.iter().map(mesh).collect();
        self.boxes = self.meshes.iter().map(TriMesh::local_aabb).collect();
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for ((mesh, own_box), shape) in self.meshes.iter_mut().zip(&mut self.boxes).zip(shapes) {
            mesh.update_vertices(|vertices| {
                for (vertex, &position) in vertices.iter_mut().zip(shape.world) {
                    *vertex = Vector::from(position);
                }
            });
            *own_box = mesh.local_aabb();
            // The leaves, and the nodes above them but for the root, which is not stored.
            let leaves = mesh.indices().len() as u64;
            self.answer.counters.boxes += leaves + leaves.saturating_sub(2);
        }
    }

    fn between_bodies(&mut self) -> ControlFlow<()> {
        let Self {
            meshes,
            boxes,
            answer,
            ..
        } = self;
        for (a, mesh_a) in meshes.iter().enumerate() {
            for (b, mesh_b) in meshes.iter().enumerate().skip(a + 1) {
                if !boxes[a].intersects(&boxes[b]) {
                    continue;
                }
                let box_tests = Cell::new(0);
                let mut leaves = mesh_a.bvh().leaf_pairs(mesh_b.bvh(), |node_a, node_b| {
                    box_tests.set(box_tests.get() + 1);
                    node_a.intersects(node_b)
                });
                let flow = leaves.try_for_each(|(i, j)| {
                    answer.candidate(
                        [a as u32, i, b as u32, j],
                        &corners(mesh_a, i),
                        &corners(mesh_b, j),
                    )
                });
                answer.counters.box_tests += box_tests.get();
                flow?;
            }
        }
        ControlFlow::Continue(())
    }

    fn within_bodies(&mut self) -> ControlFlow<()> {
        let Self {
            meshes,
            workspace,
            answer,
            ..
        } = self;
        for (body, mesh) in meshes.iter().enumerate() {
            let triangles = mesh.indices();
            mesh.bvh()
                .traverse_bvtt_single_tree::<false>(workspace, &mut |i, j| {
                    if !share_a_vertex(triangles[i as usize], triangles[j as usize]) {
                        let pair = self_pair(body, i, j);
                        // All are wanted; the traversal could not be stopped.
                        let _ = answer.candidate(pair, &corners(mesh, i), &corners(mesh, j));
                    }
                });
        }
        ControlFlow::Continue(())
    }

    fn answer(&mut self) -> &mut Answer {
        &mut self.answer
    }
}
