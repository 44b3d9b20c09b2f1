//! obvhs: its binary tree with refit, and a traversal of pairs of its public nodes.
//!
//! - **Build**, once, on boxes of the triangles in their first shape, by the library's recipe
//!   `build_bvh2`. The preset is the slowest and best, as building is not timed: PLOC, reinsertion,
//!   collapsed leaves.
//! - **Layout**, as the documentation advises: nodes in the order of the traversal, triangles in
//!   the order of the leaves, without an indirection.
//! - **Step**: writes the boxes of the leaves and calls `refit_all`, which is then one sweep over
//!   the nodes from back to front.
//! - **Query**: the library has no traversal of two trees. This one is iterative, with a stack of
//!   pairs of nodes with overlapping boxes. Two inner nodes are *both* opened (four box tests);
//!   against a leaf, the inner node alone (two). Opening only the larger of two was 15 to 25 %
//!   slower.
//! - **Tree with itself**: a node with itself opens into either child with itself and the two with
//!   each other, so each pair comes once.
//! - **Leaves** with more than one triangle: boxes of triangles are made where two leaves meet.
//!
//! Every box test is visible and counted. Counted boxes are made by the refit; making boxes where
//! leaves meet is part of the test.

use super::answer::{Answer, Proposer, self_pair};
use super::bodies::share_a_vertex;
use super::near::{Elements, swept_box};
use crate::decision::{Decision, Triangle};
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use std::ops::{ControlFlow, Range};
use std::time::Duration;

/// obvhs with refit.
pub struct Obvhs {
    triangles_a_leaf: u32,
    bodies: Vec<Body>,
    scratch: Scratch,
    answer: Answer,
}

/// Memory that queries reuse.
#[derive(Default)]
struct Scratch {
    /// Pairs of nodes whose boxes overlap, still to be opened.
    stack: Vec<[u32; 2]>,
    /// Triangles of one leaf that reach another, with their boxes.
    reaching: Vec<(usize, Aabb)>,
}

impl Obvhs {
    /// Trees of the library with at most `triangles_a_leaf` triangles a leaf (1 to 255), and this
    /// triangle test.
    pub fn new(triangles_a_leaf: u32, decision: Decision) -> Self {
        Self {
            triangles_a_leaf,
            bodies: Vec::new(),
            scratch: Scratch::default(),
            answer: Answer::new(decision),
        }
    }
}

/// obvhs with refitted boxes of motions, grown by a margin, for candidates.
pub struct NearObvhs {
    triangles_a_leaf: u32,
    bodies: Vec<Body>,
    scratch: Scratch,
    elements: Elements,
}

impl NearObvhs {
    /// Trees of the library with at most `triangles_a_leaf` triangles a leaf, and a margin of
    /// `radius` round each element.
    pub fn new(triangles_a_leaf: u32, radius: f64) -> Self {
        Self {
            triangles_a_leaf,
            bodies: Vec::new(),
            scratch: Scratch::default(),
            elements: Elements::within(radius),
        }
    }
}

impl Method for NearObvhs {
    fn name(&self) -> String {
        format!("obvhs 0.4 ({} a leaf), grown boxes", self.triangles_a_leaf)
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.elements.build(bodies);
        let grown_by = self.elements.grown_by();
        self.bodies = bodies
            .iter()
            .map(|body| Body {
                grown_by,
                ..Body::build(body, self.triangles_a_leaf)
            })
            .collect();
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.elements.take_over(shapes);
        for (body, shape) in self.bodies.iter_mut().zip(shapes) {
            body.positions.copy_from_slice(shape.world);
            body.ends.clear();
            body.ends.extend_from_slice(shape.end.unwrap_or_default());
            body.refit();
            self.elements.counters.boxes += body.tree.nodes.len() as u64;
        }
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
            scratch,
            elements,
            ..
        } = self;
        elements.begin();
        for (a, body_a) in bodies.iter().enumerate() {
            let mut box_tests = 0;
            let _ = self_candidates(body_a, scratch, &mut box_tests, |i, j| {
                elements.meet([a, a], [body_a.numbers[i], body_a.numbers[j]]);
                ControlFlow::Continue(())
            });
            for (b, body_b) in bodies.iter().enumerate().skip(a + 1) {
                if !body_a.bounds().intersect_aabb(body_b.bounds()) {
                    continue;
                }
                let _ = candidates(body_a, body_b, scratch, &mut box_tests, |i, j| {
                    elements.meet([a, b], [body_a.numbers[i], body_b.numbers[j]]);
                    ControlFlow::Continue(())
                });
            }
            elements.counters.box_tests += box_tests;
        }
        Some(elements.sorted())
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.elements.counters)
    }
}

impl Proposer for Obvhs {
    fn name(&self) -> String {
        format!("obvhs 0.4 ({} a leaf)", self.triangles_a_leaf)
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.bodies = bodies
            .iter()
            .map(|body| Body::build(body, self.triangles_a_leaf))
            .collect();
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for (body, shape) in self.bodies.iter_mut().zip(shapes) {
            body.positions.copy_from_slice(shape.world);
            body.refit();
            self.answer.counters.boxes += body.tree.nodes.len() as u64;
        }
    }

    fn between_bodies(&mut self) -> ControlFlow<()> {
        let Self {
            bodies,
            scratch,
            answer,
            ..
        } = self;
        for (a, body_a) in bodies.iter().enumerate() {
            for (b, body_b) in bodies.iter().enumerate().skip(a + 1) {
                if !body_a.bounds().intersect_aabb(body_b.bounds()) {
                    continue;
                }
                let mut box_tests = 0;
                let flow = candidates(body_a, body_b, scratch, &mut box_tests, |i, j| {
                    let pair = [a as u32, body_a.numbers[i], b as u32, body_b.numbers[j]];
                    answer.candidate(pair, &body_a.corners(i), &body_b.corners(j))
                });
                answer.counters.box_tests += box_tests;
                flow?;
            }
        }
        ControlFlow::Continue(())
    }

    fn within_bodies(&mut self) -> ControlFlow<()> {
        let Self {
            bodies,
            scratch,
            answer,
            ..
        } = self;
        for (number, body) in bodies.iter().enumerate() {
            let mut box_tests = 0;
            let flow = self_candidates(body, scratch, &mut box_tests, |i, j| {
                if share_a_vertex(body.triangles[i], body.triangles[j]) {
                    return ControlFlow::Continue(());
                }
                let pair = self_pair(number, body.numbers[i], body.numbers[j]);
                answer.candidate(pair, &body.corners(i), &body.corners(j))
            });
            answer.counters.box_tests += box_tests;
            flow?;
        }
        ControlFlow::Continue(())
    }

    fn answer(&mut self) -> &mut Answer {
        &mut self.answer
    }
}

/// A body, with its triangles in the order of the leaves.
struct Body {
    triangles: Vec<[u32; 3]>,
    /// Caller's numbers of the triangles.
    numbers: Vec<u32>,
    /// Positions in the caller's order.
    positions: Vec<[f32; 3]>,
    /// Positions at the end of the motion; empty if there is none.
    ends: Vec<[f32; 3]>,
    /// Growth of boxes on every side.
    grown_by: f32,
    tree: Bvh2,
}

impl Body {
    fn build(body: &BodyMesh<'_>, triangles_a_leaf: u32) -> Self {
        let positions = body.shape.world.to_vec();
        let boxes: Vec<Aabb> = body
            .triangles
            .iter()
            .map(|&corners| triangle_box(&positions, corners))
            .collect();
        let recipe = BvhBuildParams {
            max_prims_per_leaf: triangles_a_leaf,
            pre_split: false,
            ..BvhBuildParams::very_slow_build()
        };
        let mut tree = build_bvh2(&boxes, recipe, &mut Duration::default());
        tree.reorder_in_stack_traversal_order();
        let mut numbers = Vec::with_capacity(body.triangles.len());
        for leaf in tree.nodes.iter_mut().filter(|node| node.is_leaf()) {
            let first = numbers.len() as u32;
            numbers.extend(places(leaf).map(|place| tree.primitive_indices[place]));
            leaf.first_index = first;
        }
        // The library expects the tree to say that places are triangles now.
        tree.primitive_indices = (0..numbers.len() as u32).collect();
        Self {
            triangles: numbers
                .iter()
                .map(|&number| body.triangles[number as usize])
                .collect(),
            numbers,
            positions,
            ends: Vec::new(),
            grown_by: 0.0,
            tree,
        }
    }

    /// Writes the boxes of the leaves, then refits by the library.
    fn refit(&mut self) {
        let nodes = self.tree.nodes.len();
        for node in 0..nodes {
            if self.tree.nodes[node].is_leaf() {
                let mut boxes = places(&self.tree.nodes[node]).map(|it| self.triangle_box(it));
                let first = boxes.next().expect("a leaf has triangles");
                let hull = boxes.fold(first, |hull, own_box| hull.union(&own_box));
                self.tree.nodes[node].set_aabb(hull);
            }
        }
        self.tree.refit_all();
    }

    fn bounds(&self) -> &Aabb {
        self.tree.nodes[0].aabb()
    }

    #[inline]
    fn corners(&self, place: usize) -> Triangle {
        self.triangles[place].map(|vertex| self.positions[vertex as usize])
    }

    #[inline]
    fn triangle_box(&self, place: usize) -> Aabb {
        let corners = self.triangles[place];
        if self.grown_by == 0.0 && self.ends.is_empty() {
            return triangle_box(&self.positions, corners);
        }
        let own_box = swept_box(&self.positions, &self.ends, &corners);
        let grown_by = self.grown_by;
        Aabb::new(
            own_box.lo.map(|x| x - grown_by).into(),
            own_box.hi.map(|x| x + grown_by).into(),
        )
    }
}

#[inline]
fn triangle_box(positions: &[[f32; 3]], corners: [u32; 3]) -> Aabb {
    let own_box = super::triangle_box::triangle_box(corners, positions);
    Aabb::new(own_box.lo.into(), own_box.hi.into())
}

/// Places of a leaf's triangles.
#[inline]
fn places(leaf: &Bvh2Node) -> Range<usize> {
    let first = leaf.first_index as usize;
    first..first + leaf.prim_count as usize
}

/// Visits pairs of triangles of two bodies whose boxes overlap.
fn candidates(
    a: &Body,
    b: &Body,
    Scratch { stack, reaching }: &mut Scratch,
    box_tests: &mut u64,
    mut visit: impl FnMut(usize, usize) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let (nodes_a, nodes_b) = (&a.tree.nodes[..], &b.tree.nodes[..]);
    stack.clear();
    stack.push([0, 0]);
    while let Some([i, j]) = stack.pop() {
        let (node_a, node_b) = (&nodes_a[i as usize], &nodes_b[j as usize]);
        if node_a.is_leaf() && node_b.is_leaf() {
            leaf_against_leaf([a, b], [node_a, node_b], reaching, box_tests, &mut visit)?;
        } else {
            open([nodes_a, nodes_b], [i, j], stack, box_tests);
        }
    }
    ControlFlow::Continue(())
}

/// Visits pairs of triangles of one body whose boxes overlap, each once.
fn self_candidates(
    body: &Body,
    Scratch { stack, reaching }: &mut Scratch,
    box_tests: &mut u64,
    mut visit: impl FnMut(usize, usize) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let nodes = &body.tree.nodes[..];
    stack.clear();
    stack.push([0, 0]);
    while let Some([i, j]) = stack.pop() {
        let (node_a, node_b) = (&nodes[i as usize], &nodes[j as usize]);
        match (i == j, node_a.is_leaf(), node_b.is_leaf()) {
            (true, true, _) => within_leaf(body, node_a, box_tests, &mut visit)?,
            (true, false, _) => {
                let (left, right) = (node_a.first_index, node_a.first_index + 1);
                *box_tests += 1;
                if overlap(nodes, left, nodes, right) {
                    stack.push([left, right]);
                }
                stack.push([left, left]);
                stack.push([right, right]);
            }
            (false, true, true) => leaf_against_leaf(
                [body, body],
                [node_a, node_b],
                reaching,
                box_tests,
                &mut visit,
            )?,
            (false, ..) => open([nodes, nodes], [i, j], stack, box_tests),
        }
    }
    ControlFlow::Continue(())
}

#[inline]
fn overlap(nodes_a: &[Bvh2Node], i: u32, nodes_b: &[Bvh2Node], j: u32) -> bool {
    nodes_a[i as usize]
        .aabb()
        .intersect_aabb(nodes_b[j as usize].aabb())
}

/// Opens the inner nodes of a pair, and pushes the pairs of children whose boxes overlap.
#[inline]
fn open(
    [nodes_a, nodes_b]: [&[Bvh2Node]; 2],
    [i, j]: [u32; 2],
    stack: &mut Vec<[u32; 2]>,
    box_tests: &mut u64,
) {
    let children = |nodes: &[Bvh2Node], number: u32| {
        let node = &nodes[number as usize];
        if node.is_leaf() {
            number..number + 1
        } else {
            node.first_index..node.first_index + 2
        }
    };
    for i in children(nodes_a, i) {
        for j in children(nodes_b, j) {
            *box_tests += 1;
            if overlap(nodes_a, i, nodes_b, j) {
                stack.push([i, j]);
            }
        }
    }
}

/// Visits pairs of triangles of two leaves whose boxes overlap.
///
/// The boxes of the leaves are known to overlap, which is enough for one triangle a leaf.
#[inline]
fn leaf_against_leaf(
    [a, b]: [&Body; 2],
    [leaf_a, leaf_b]: [&Bvh2Node; 2],
    reaching: &mut Vec<(usize, Aabb)>,
    box_tests: &mut u64,
    visit: &mut impl FnMut(usize, usize) -> ControlFlow<()>,
) -> ControlFlow<()> {
    if leaf_a.prim_count == 1 && leaf_b.prim_count == 1 {
        return visit(leaf_a.first_index as usize, leaf_b.first_index as usize);
    }
    reaching.clear();
    reaching.extend(
        places(leaf_b)
            .map(|place| (place, b.triangle_box(place)))
            .filter(|(_, own_box)| own_box.intersect_aabb(leaf_a.aabb())),
    );
    *box_tests += u64::from(leaf_b.prim_count);
    if reaching.is_empty() {
        return ControlFlow::Continue(());
    }
    for i in places(leaf_a) {
        let box_a = a.triangle_box(i);
        *box_tests += reaching.len() as u64;
        for (j, box_b) in &*reaching {
            if box_a.intersect_aabb(box_b) {
                visit(i, *j)?;
            }
        }
    }
    ControlFlow::Continue(())
}

/// Visits pairs of triangles of one leaf whose boxes overlap.
fn within_leaf(
    body: &Body,
    leaf: &Bvh2Node,
    box_tests: &mut u64,
    visit: &mut impl FnMut(usize, usize) -> ControlFlow<()>,
) -> ControlFlow<()> {
    for i in places(leaf) {
        let own_box = body.triangle_box(i);
        for j in i + 1..leaf.first_index as usize + leaf.prim_count as usize {
            *box_tests += 1;
            if own_box.intersect_aabb(&body.triangle_box(j)) {
                visit(i, j)?;
            }
        }
    }
    ControlFlow::Continue(())
}
