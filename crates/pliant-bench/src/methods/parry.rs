//! parry3d: a `TriMesh` whose vertices move, and its `Bvh::leaf_pairs`.
//!
//! The shortest public way through the library, which is also the fastest. Boxes of bodies are
//! boxes of the roots, compared by brute force.
//!
//! - **Mesh**: keeps the only copy of vertices and triangles.
//! - **Build**: `TriMesh` builds the tree, by the surface area heuristic in bins, on the first
//!   shape. It is never rebuilt: the library could reorder or rebuild it, at a price every step.
//! - **Step**: `TriMesh::update_vertices` writes the vertices and refits the binary tree in place,
//!   one triangle a leaf.
//! - **Query**: `leaf_pairs` descends two trees together and yields pairs of leaves whose boxes
//!   overlap. A tree with itself is `traverse_bvtt_single_tree`, each pair once.
//! - **Decision**: the bench's. The library's own test of two triangles (GJK) is slower, and
//!   reports near neighbours in one plane.
//! - **Counters**: boxes by the size of the trees, box tests in the check given to `leaf_pairs`.
//!   Not visible, so not counted: its first four pairs, taken as overlapping, and the tests within
//!   one tree.

use super::answer::{Answer, Proposer, self_pair};
use super::bodies::share_a_vertex;
use super::near::{Elements, swept_box};
use crate::decision::{Decision, Triangle};
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Vector};
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use parry3d::query;
use parry3d::shape::{TriMesh, TriMeshFlags, Triangle as ParryTriangle};
use std::cell::Cell;
use std::ops::ControlFlow;

/// parry3d with refit.
pub struct Parry {
    meshes: Vec<TriMesh>,
    boxes: Vec<Aabb>,
    workspace: BvhWorkspace,
    answer: Answer,
}

impl Parry {
    /// Trees of the library, with this triangle test.
    pub fn new(decision: Decision) -> Self {
        Self {
            meshes: Vec::new(),
            boxes: Vec::new(),
            workspace: BvhWorkspace::default(),
            answer: Answer::new(decision),
        }
    }
}

/// parry3d's tree with refitted boxes of motions, grown by a margin, for candidates.
///
/// Boxes go into the tree as `TriMesh` puts them there.
pub struct NearParry {
    bodies: Vec<(Vec<[u32; 3]>, Bvh)>,
    workspace: BvhWorkspace,
    elements: Elements,
}

impl NearParry {
    /// Candidates with this margin round each vertex, edge and triangle.
    pub fn new(radius: f64) -> Self {
        Self {
            bodies: Vec::new(),
            workspace: BvhWorkspace::default(),
            elements: Elements::within(radius),
        }
    }

    fn box_of(&self, shape: &Shape<'_>, corners: &[u32; 3]) -> Aabb {
        let own_box = swept_box(shape.world, shape.end.unwrap_or_default(), corners);
        let grown_by = self.elements.grown_by();
        Aabb {
            mins: Vector::from(own_box.lo.map(|x| x - grown_by)),
            maxs: Vector::from(own_box.hi.map(|x| x + grown_by)),
        }
    }
}

impl Method for NearParry {
    fn name(&self) -> String {
        "parry3d 0.31, grown boxes".to_owned()
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.elements.build(bodies);
        for body in bodies {
            let boxes = body.triangles.iter();
            let boxes: Vec<_> = boxes
                .map(|corners| self.box_of(&body.shape, corners))
                .collect();
            // The strategy with which `TriMesh` builds its own tree.
            let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
            self.bodies.push((body.triangles.to_vec(), tree));
        }
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.elements.take_over(shapes);
        let mut bodies = std::mem::take(&mut self.bodies);
        for ((triangles, tree), shape) in bodies.iter_mut().zip(shapes) {
            for (number, corners) in (0..).zip(&*triangles) {
                let own_box = self.box_of(shape, corners);
                let _ = tree.insert_or_update_partially(own_box, number, 0.0);
            }
            tree.refit_without_opt();
            let leaves = triangles.len() as u64;
            self.elements.counters.boxes += leaves + leaves.saturating_sub(2);
        }
        self.bodies = bodies;
    }

    fn all_pairs(&mut self) -> &[Pair] {
        &[]
    }

    fn first_pair(&mut self) -> Option<Pair> {
        None
    }

    fn candidates(&mut self) -> Option<&[Pair]> {
        let Self {
            bodies,
            workspace,
            elements,
        } = self;
        elements.begin();
        for (a, (_, tree_a)) in bodies.iter().enumerate() {
            tree_a.traverse_bvtt_single_tree::<false>(workspace, &mut |i, j| {
                elements.meet([a, a], [i, j]);
            });
            for (b, (_, tree_b)) in bodies.iter().enumerate().skip(a + 1) {
                if !tree_a.root_aabb().intersects(&tree_b.root_aabb()) {
                    continue;
                }
                let box_tests = Cell::new(0);
                let leaves = tree_a.leaf_pairs(tree_b, |node_a, node_b| {
                    box_tests.set(box_tests.get() + 1);
                    node_a.intersects(node_b)
                });
                leaves.for_each(|(i, j)| elements.meet([a, b], [i, j]));
                elements.counters.box_tests += box_tests.get();
            }
        }
        Some(elements.sorted())
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.elements.counters)
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
            // Leaves, and nodes above them except the root, which is not stored.
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
                        // All pairs are wanted, and the traversal could not be stopped.
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

/// Distance of two bodies by parry3d, in one of two ways.
pub struct FarParry {
    meshes: Parry,
    bounded: bool,
    /// Triangles that were nearest in the last query.
    last: Option<(u32, u32)>,
}

impl FarParry {
    /// By `query::distance` of two meshes, which descends one tree and, for each of its leaves, the
    /// other.
    pub fn by_query() -> Self {
        Self {
            meshes: Parry::new(crate::decision::exact),
            bounded: false,
            last: None,
        }
    }

    /// By `leaf_pairs` of both trees, pruned by the nearest triangles found so far.
    ///
    /// The nearest pair of the last query comes first. `query::distance` of two triangles measures
    /// pairs.
    pub fn by_leaf_pairs() -> Self {
        Self {
            bounded: true,
            ..Self::by_query()
        }
    }
}

impl Method for FarParry {
    fn name(&self) -> String {
        let way = if self.bounded {
            "leaf pairs nearer than the nearest"
        } else {
            "query::distance"
        };
        format!("parry3d 0.31, {way}")
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        Proposer::build(&mut self.meshes, bodies);
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        Proposer::step(&mut self.meshes, shapes);
    }

    fn all_pairs(&mut self) -> &[Pair] {
        &[]
    }

    fn first_pair(&mut self) -> Option<Pair> {
        None
    }

    fn distance(&mut self) -> Option<f64> {
        let [a, b, ..] = &self.meshes.meshes[..] else {
            return None;
        };
        let here = Pose::IDENTITY;
        if !self.bounded {
            let distance = query::distance(&here, a, &here, b).ok()?;
            return Some(distance.distance.into());
        }
        let triangle = |mesh: &TriMesh, number: u32| {
            let vertices = mesh.vertices();
            let [a, b, c] = mesh.indices()[number as usize].map(|vertex| vertices[vertex as usize]);
            ParryTriangle::new(a, b, c)
        };
        let measure = |i: u32, j: u32| {
            let (a, b) = (triangle(a, i), triangle(b, j));
            let distance = query::distance(&here, &a, &here, &b);
            distance.map_or(f32::MAX, |distance| distance.distance)
        };
        let nearest = Cell::new(self.last.map_or(f32::MAX, |(i, j)| measure(i, j)));
        let box_tests = Cell::new(0);
        let leaves = a.bvh().leaf_pairs(b.bvh(), |node_a, node_b| {
            box_tests.set(box_tests.get() + 1);
            let zero = Vector::ZERO;
            let gap = (node_b.mins() - node_a.maxs()).max(node_a.mins() - node_b.maxs());
            gap.max(zero).length_squared() < nearest.get() * nearest.get()
        });
        for (i, j) in leaves {
            // Their distance was below the bound when their parents were compared.
            let boxes = [(a, i), (b, j)].map(|(mesh, number)| triangle(mesh, number).local_aabb());
            let gap = (boxes[1].mins - boxes[0].maxs).max(boxes[0].mins - boxes[1].maxs);
            if gap.max(Vector::ZERO).length_squared() >= nearest.get() * nearest.get() {
                continue;
            }
            self.meshes.answer.counters.decisions += 1;
            let distance = measure(i, j);
            if distance < nearest.get() {
                nearest.set(distance);
                self.last = Some((i, j));
            }
        }
        self.meshes.answer.counters.box_tests += box_tests.get();
        Some(nearest.get().into())
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.meshes.answer.counters)
    }
}
