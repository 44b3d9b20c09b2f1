//! obvhs on changing meshes: its own insertion and removal of leaves, one triangle each.
//!
//! A new triangle is inserted and an old one removed, by the library's `insert_primitive` and
//! `remove_primitive`. A triangle with other corners only gets another box. A step writes the boxes
//! of all leaves and calls `refit_all`, as on unchanging meshes (`obvhs.rs`). The layout of the
//! tree is never renewed: leaves stay where insertion puts them.

use super::bodies::share_a_vertex;
use super::triangle_box::triangle_box;
use crate::decision::Decision;
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use pliant_scenes::{ChangingMesh, Event};
use std::time::Duration;

/// obvhs with trees that follow edits.
pub struct ChangingObvhs {
    decision: Decision,
    bodies: Vec<Body>,
    stack: Vec<[u32; 2]>,
    pairs: Vec<Pair>,
    counters: Counters,
}

struct Body {
    triangles: Vec<[u32; 3]>,
    positions: Vec<[f32; 3]>,
    tree: Bvh2,
}

impl ChangingObvhs {
    /// Trees of the library with one triangle a leaf, and this triangle test.
    pub fn new(decision: Decision) -> Self {
        Self {
            decision,
            bodies: Vec::new(),
            stack: Vec::new(),
            pairs: Vec::new(),
            counters: Counters::default(),
        }
    }
}

impl Body {
    fn build(triangles: &[[u32; 3]], positions: &[[f32; 3]]) -> Self {
        let (numbers, boxes): (Vec<u32>, Vec<Aabb>) = (0..)
            .zip(triangles)
            .filter(|(_, corners)| **corners != ChangingMesh::EMPTY)
            .map(|(number, &corners)| (number, aabb(positions, corners)))
            .unzip();
        let recipe = BvhBuildParams {
            max_prims_per_leaf: 1,
            pre_split: false,
            ..BvhBuildParams::very_slow_build()
        };
        let mut tree = build_bvh2(&boxes, recipe, &mut Duration::default());
        tree.reorder_in_stack_traversal_order();
        for place in &mut tree.primitive_indices {
            *place = numbers[*place as usize];
        }
        Self {
            triangles: triangles.to_vec(),
            positions: positions.to_vec(),
            tree,
        }
    }

    /// Applies the changes of the triangles to the tree.
    fn follow(&mut self, triangles: &[[u32; 3]], positions: &[[f32; 3]]) {
        const EMPTY: [u32; 3] = ChangingMesh::EMPTY;
        self.triangles.resize(triangles.len(), EMPTY);
        for (number, (old, &new)) in (0..).zip(self.triangles.iter_mut().zip(triangles)) {
            match (*old == EMPTY, new == EMPTY) {
                (true, false) => _ = self.tree.insert_primitive(aabb(positions, new), number),
                (false, true) => self.tree.remove_primitive(number),
                _ => {}
            }
            *old = new;
        }
    }

    fn refit(&mut self, positions: &[[f32; 3]]) {
        self.positions.clear();
        self.positions.extend_from_slice(positions);
        for node in &mut self.tree.nodes {
            if node.is_leaf() {
                let number = self.tree.primitive_indices[node.first_index as usize];
                node.set_aabb(aabb(positions, self.triangles[number as usize]));
            }
        }
        self.tree.refit_all();
    }
}

fn aabb(positions: &[[f32; 3]], corners: [u32; 3]) -> Aabb {
    let own_box = triangle_box(corners, positions);
    Aabb::new(own_box.lo.into(), own_box.hi.into())
}

impl Method for ChangingObvhs {
    fn name(&self) -> String {
        "obvhs 0.4 (1 a leaf), insertion and removal".to_owned()
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.bodies = bodies
            .iter()
            .map(|body| Body::build(body.triangles, body.shape.world))
            .collect();
    }

    fn change(&mut self, events: &[Event], shapes: &[Shape<'_>], meshes: &[ChangingMesh]) {
        for event in events {
            match *event {
                Event::Edit { body, .. } => {
                    self.bodies[body].follow(&meshes[body].triangles, shapes[body].world);
                }
                Event::Fuse { kept, gone } => {
                    self.bodies[kept] = Body::build(&meshes[kept].triangles, shapes[kept].world);
                    self.bodies[gone].triangles.clear();
                }
            }
        }
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for (body, shape) in self.bodies.iter_mut().zip(shapes) {
            if !body.triangles.is_empty() {
                body.refit(shape.world);
                self.counters.boxes += body.tree.nodes.len() as u64;
            }
        }
    }

    fn all_pairs(&mut self) -> &[Pair] {
        &[]
    }

    fn first_pair(&mut self) -> Option<Pair> {
        None
    }

    fn candidates(&mut self) -> Option<&[Pair]> {
        self.pairs.clear();
        for a in 0..self.bodies.len() {
            for b in a..self.bodies.len() {
                self.meet(a, b);
            }
        }
        self.pairs.sort_unstable();
        Some(&self.pairs)
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}

impl ChangingObvhs {
    /// Visits pairs of two bodies, or of one body with itself.
    fn meet(&mut self, a: usize, b: usize) {
        let Self {
            bodies,
            stack,
            pairs,
            counters,
            decision,
        } = self;
        let both = [&bodies[a], &bodies[b]];
        if both.iter().any(|body| body.triangles.is_empty()) {
            return;
        }
        let nodes = both.map(|body| &body.tree.nodes[..]);
        let is_one = a == b;
        stack.clear();
        stack.push([0, 0]);
        while let Some([i, j]) = stack.pop() {
            let [node_i, node_j] = [&nodes[0][i as usize], &nodes[1][j as usize]];
            if node_i.is_leaf() && node_j.is_leaf() {
                if is_one && i == j {
                    continue;
                }
                let numbers = [(0, node_i), (1, node_j)].map(|(side, node)| {
                    let place = node.first_index as usize;
                    both[side].tree.primitive_indices[place]
                });
                let corners = [0, 1].map(|side| both[side].triangles[numbers[side] as usize]);
                if is_one && share_a_vertex(corners[0], corners[1]) {
                    continue;
                }
                counters.decisions += 1;
                let [s, t] = [0, 1]
                    .map(|side| corners[side].map(|vertex| both[side].positions[vertex as usize]));
                if decision(&s, &t) {
                    let [s, t] = numbers;
                    let in_order = if is_one { [s.min(t), s.max(t)] } else { [s, t] };
                    pairs.push([a as u32, in_order[0], b as u32, in_order[1]]);
                }
                continue;
            }
            let children = |side: usize, number: u32| {
                let node = &nodes[side][number as usize];
                if node.is_leaf() {
                    number..number + 1
                } else {
                    node.first_index..node.first_index + 2
                }
            };
            for s in children(0, i) {
                for t in children(1, j) {
                    if is_one && i == j && t < s {
                        continue;
                    }
                    counters.box_tests += 1;
                    let boxes = [nodes[0][s as usize].aabb(), nodes[1][t as usize].aabb()];
                    if (is_one && s == t) || boxes[0].intersect_aabb(boxes[1]) {
                        stack.push([s, t]);
                    }
                }
            }
        }
    }
}
