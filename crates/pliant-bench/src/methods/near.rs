//! Elements within a margin (vertices near triangles, edges near edges) from pairs of triangles.
//!
//! For methods that find pairs of triangles; and by a sweep alone, which is the truth. Every vertex
//! and edge belongs to the first triangle that has it. Two triangles whose grown boxes overlap
//! compare the elements that belong to them, so each pair of elements comes up once. Gaps are
//! compared in `f64`, in which differences of similar `f32` are exact. Rows and edge numbers are
//! the library's.
//!
//! | sought | decided by |
//! |---|---|
//! | boxes within the margin | their gap in `f64` |
//! | elements within a distance | plain `f64`; near the limit the exact reference |
//! | elements that meet during the motion | the exact reference, which has no tree |

use super::aabb::Aabb;
use super::plain_distance::{of_point_and_triangle, of_segments};
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use pliant::reference::{self, Moving};
use std::collections::BTreeMap;

/// Box of some vertices, over both ends of the motion if there is one.
#[inline]
pub(super) fn swept_box(positions: &[[f32; 3]], ends: &[[f32; 3]], corners: &[u32]) -> Aabb {
    let mut hull = Aabb::EMPTY;
    for &corner in corners {
        let at = |point: [f32; 3]| Aabb {
            lo: point,
            hi: point,
        };
        hull = hull.merge(&at(positions[corner as usize]));
        if let Some(&end) = ends.get(corner as usize) {
            hull = hull.merge(&at(end));
        }
    }
    hull
}

/// Relation that is sought, among elements whose boxes are near each other.
#[derive(Clone, Copy, Debug)]
enum Sought {
    /// Every such pair.
    Near,
    /// Pairs of elements at most this far apart.
    CloserThan(f64),
    /// Pairs of elements that meet during the motion.
    Meeting,
}

/// Form of the answer.
#[derive(Clone, Copy, Debug)]
enum Told {
    /// All rows.
    Rows,
    /// One row of two numbers: the count of each kind.
    Count,
    /// Row of the earliest contact, if there is one.
    Earliest,
}

/// Vertices, edges and triangles of all bodies, and the pairs found.
pub(super) struct Elements {
    radius: f64,
    sought: Sought,
    bodies: Vec<Body>,
    /// Vertices near triangles, then edges near edges.
    found: [Vec<Pair>; 2],
    /// Time, kind and row of the earliest contact.
    earliest: Option<(f64, usize, Pair)>,
    keys: Vec<u64>,
    all: Vec<Pair>,
    pub(super) counters: Counters,
}

struct Body {
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    /// For each triangle, which of its vertices belong to it, and the numbers of the edges that do.
    owned: Vec<([bool; 3], [Option<u32>; 3])>,
    vertex_boxes: Vec<Aabb>,
    edge_boxes: Vec<Aabb>,
    triangle_boxes: Vec<Aabb>,
    /// Positions of vertices now and at the end of the motion; empty where boxes suffice.
    positions: [Vec<[f64; 3]>; 2],
}

impl Body {
    fn new(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let sides =
            |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
        let mut numbers: BTreeMap<[u32; 2], (u32, bool)> = BTreeMap::new();
        for side in triangles.iter().flat_map(|&corners| sides(corners)) {
            if side[0] != side[1] {
                numbers.insert(side, (0, true));
            }
        }
        for (number, (_, (of_edge, _))) in (0..).zip(&mut numbers) {
            *of_edge = number;
        }
        let mut is_free = vec![true; vertices];
        let owned = triangles.iter().map(|&corners| {
            let own_vertices = corners.map(|corner| std::mem::take(&mut is_free[corner as usize]));
            let own_edges = sides(corners).map(|side| {
                let (number, is_free) = numbers.get_mut(&side)?;
                std::mem::take(is_free).then_some(*number)
            });
            (own_vertices, own_edges)
        });
        let owned = owned.collect();
        Self {
            triangles: triangles.to_vec(),
            edges: numbers.into_keys().collect(),
            owned,
            vertex_boxes: Vec::new(),
            edge_boxes: Vec::new(),
            triangle_boxes: Vec::new(),
            positions: Default::default(),
        }
    }

    fn points<const C: usize>(&self, corners: [u32; C]) -> [[f64; 3]; C] {
        corners.map(|corner| self.positions[0][corner as usize])
    }

    /// Positions of corners now, and at the end of the motion.
    fn way<const C: usize>(&self, corners: [u32; C]) -> [[[f64; 3]; C]; 2] {
        let [_, ends] = &self.positions;
        [
            self.points(corners),
            corners.map(|corner| ends[corner as usize]),
        ]
    }
}

impl Elements {
    /// Elements with this margin round each.
    pub(super) fn within(radius: f64) -> Self {
        Self {
            radius,
            sought: Sought::Near,
            bodies: Vec::new(),
            found: Default::default(),
            earliest: None,
            keys: Vec::new(),
            all: Vec::new(),
            counters: Counters::default(),
        }
    }

    /// Growth of boxes of triangles on every side that misses no candidate: a little more than the
    /// margin, as boxes are rounded.
    #[cfg_attr(not(feature = "peers"), expect(dead_code, reason = "peers ask it"))]
    pub(super) fn grown_by(&self) -> f32 {
        (self.radius * 1.001) as f32
    }

    pub(super) fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        let bodies = bodies.iter();
        self.bodies = bodies
            .map(|body| Body::new(body.triangles, body.shape.world.len()))
            .collect();
    }

    /// Makes the boxes of all elements.
    pub(super) fn take_over(&mut self, shapes: &[Shape<'_>]) {
        for (body, shape) in self.bodies.iter_mut().zip(shapes) {
            let ends = shape.end.unwrap_or_default();
            let hull = |corners: &[u32]| swept_box(shape.world, ends, corners);
            let vertices = 0..shape.world.len() as u32;
            body.vertex_boxes.clear();
            body.vertex_boxes.extend(vertices.map(|it| hull(&[it])));
            body.edge_boxes.clear();
            body.edge_boxes.extend(body.edges.iter().map(|it| hull(it)));
            body.triangle_boxes.clear();
            let triangles = body.triangles.iter();
            body.triangle_boxes.extend(triangles.map(|it| hull(it)));
            if !matches!(self.sought, Sought::Near) {
                let ends = shape.end.unwrap_or(shape.world);
                for (positions, given) in body.positions.iter_mut().zip([shape.world, ends]) {
                    positions.clear();
                    positions.extend(given.iter().map(|point| point.map(f64::from)));
                }
            }
        }
    }

    pub(super) fn begin(&mut self) {
        self.found.iter_mut().for_each(Vec::clear);
        self.earliest = None;
    }

    /// Compares the elements that belong to two triangles, of two bodies in order or of one.
    #[inline]
    #[cfg_attr(not(feature = "peers"), expect(dead_code, reason = "peers ask it"))]
    pub(super) fn meet(&mut self, bodies: [usize; 2], triangles: [u32; 2]) {
        for side in 0..2 {
            let [a, b] = [bodies[side], bodies[1 - side]];
            let [i, j] = [triangles[side], triangles[1 - side]];
            let corners = self.bodies[a].triangles[i as usize];
            let (is_own, _) = self.bodies[a].owned[i as usize];
            for (vertex, is_own) in corners.into_iter().zip(is_own) {
                if is_own {
                    self.vertex_triangle([a, b], vertex, j);
                }
            }
        }
        let [a, b] = bodies;
        let edges_of = |body: usize, triangle: u32| self.bodies[body].owned[triangle as usize].1;
        let [of_a, of_b] = [edges_of(a, triangles[0]), edges_of(b, triangles[1])];
        for i in of_a.into_iter().flatten() {
            for j in of_b.into_iter().flatten() {
                self.edge_edge([a, b], i, j);
            }
        }
    }

    #[inline]
    fn vertex_triangle(&mut self, [a, b]: [usize; 2], vertex: u32, triangle: u32) {
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        self.counters.decisions += 1;
        if a == b && body_b.triangles[triangle as usize].contains(&vertex) {
            return;
        }
        let box_a = &body_a.vertex_boxes[vertex as usize];
        let box_b = &body_b.triangle_boxes[triangle as usize];
        if !are_within(box_a, box_b, 2.0 * self.radius) {
            return;
        }
        let row = [a as u32, vertex, b as u32, triangle];
        let corners = body_b.triangles[triangle as usize];
        match self.sought {
            Sought::Near => self.found[0].push(row),
            Sought::CloserThan(distance) => {
                let (point, corners) = (body_a.points([vertex]), body_b.points(corners));
                let apart = of_point_and_triangle(point[0], corners);
                let is_close = is_at_most(apart, distance).unwrap_or_else(|| {
                    let (one, other) = (alone(&[[0; 3]], &point), alone(&[[0, 1, 2]], &corners));
                    let close = reference::close_vertex_triangle_pairs(&one, &other, distance);
                    !close.expect("these are bodies").is_empty()
                });
                if is_close {
                    self.found[0].push(row);
                }
            }
            Sought::Meeting => {
                let (point, corners) = (body_a.way([vertex]), body_b.way(corners));
                let one = on_the_way(&[[0; 3]], &point);
                let other = on_the_way(&[[0, 1, 2]], &corners);
                let met = reference::vertex_triangle_impacts(&one, &other, 0.0);
                self.meeting(0, row, &met.expect("these are bodies"));
            }
        }
    }

    /// Keeps two elements if the reference says that they meet.
    fn meeting(&mut self, kind: usize, row: Pair, met: &[reference::Timed]) {
        for &(_, [low, _]) in met {
            self.found[kind].push(row);
            let known = self.earliest.unwrap_or((f64::INFINITY, 0, row));
            let own = (low, kind, row);
            self.earliest = Some(if own < known { own } else { known });
        }
    }

    #[inline]
    fn edge_edge(&mut self, [a, b]: [usize; 2], i: u32, j: u32) {
        let (body_a, body_b) = (&self.bodies[a], &self.bodies[b]);
        self.counters.decisions += 1;
        let others = body_b.edges[j as usize];
        if a == b
            && body_a.edges[i as usize]
                .iter()
                .any(|it| others.contains(it))
        {
            return;
        }
        let (box_a, box_b) = (
            &body_a.edge_boxes[i as usize],
            &body_b.edge_boxes[j as usize],
        );
        if !are_within(box_a, box_b, 2.0 * self.radius) {
            return;
        }
        let (first, second) = ([a as u32, i], [b as u32, j]);
        let row = {
            let ([a, i], [b, j]) = (first.min(second), first.max(second));
            [a, i, b, j]
        };
        let ends = body_a.edges[i as usize];
        match self.sought {
            Sought::Near => self.found[1].push(row),
            Sought::CloserThan(distance) => {
                let (one, other) = (body_a.points(ends), body_b.points(others));
                let is_close = is_at_most(of_segments(one, other), distance).unwrap_or_else(|| {
                    let (one, other) = (alone(&[[0, 1, 1]], &one), alone(&[[0, 1, 1]], &other));
                    let close = reference::close_edge_edge_pairs(&one, &other, distance);
                    !close.expect("these are bodies").is_empty()
                });
                if is_close {
                    self.found[1].push(row);
                }
            }
            Sought::Meeting => {
                let (one, other) = (body_a.way(ends), body_b.way(others));
                let one = on_the_way(&[[0, 1, 1]], &one);
                let other = on_the_way(&[[0, 1, 1]], &other);
                let met = reference::edge_edge_impacts(&one, &other, 0.0);
                self.meeting(1, row, &met.expect("these are bodies"));
            }
        }
    }

    /// All pairs found, each kind sorted: by keys of 64 bits, if numbers of elements fit.
    pub(super) fn sorted(&mut self) -> &[Pair] {
        let elements = self.bodies.iter();
        let elements = elements.map(|it| it.edges.len().max(it.triangles.len()));
        let bits = |count: usize| usize::BITS - count.leading_zeros();
        let (of_body, of_element) = (bits(self.bodies.len()), bits(elements.max().unwrap_or(0)));
        self.all.clear();
        for found in &mut self.found {
            if 2 * (of_body + of_element) > u64::BITS {
                found.sort_unstable();
                self.all.extend_from_slice(found);
                continue;
            }
            self.keys.clear();
            self.keys.extend(found.iter().map(|&[a, i, b, j]| {
                let [a, i, b, j] = [a, i, b, j].map(u64::from);
                ((a << of_element | i) << of_body | b) << of_element | j
            }));
            self.keys.sort_unstable();
            let part = |key: u64, width: u32| (key & ((1 << width) - 1)) as u32;
            self.all.extend(self.keys.iter().map(|&key| {
                let rest = key >> of_element;
                let first = rest >> of_body;
                [
                    (first >> of_element) as u32,
                    part(first, of_element),
                    part(rest, of_body),
                    part(key, of_element),
                ]
            }));
        }
        &self.all
    }
}

/// A body of one triangle, perhaps degenerate.
fn alone<'b>(triangles: &'b [[u32; 3]], positions: &'b [[f64; 3]]) -> Moving<'b, f64> {
    Moving::at(triangles, positions)
}

/// A moving body of one triangle, perhaps degenerate.
fn on_the_way<'b, const C: usize>(
    triangles: &'b [[u32; 3]],
    [start, end]: &'b [[[f64; 3]; C]; 2],
) -> Moving<'b, f64> {
    Moving {
        end: Some(end),
        ..alone(triangles, start)
    }
}

/// Whether a length measured in `f64` is at most `distance`; `None` if rounding leaves it open.
#[inline]
fn is_at_most(apart: f64, distance: f64) -> Option<bool> {
    ((apart - distance).abs() > 1e-6 * distance).then_some(apart <= distance)
}

/// Whether the gap of two boxes is at most `gap` on every axis.
#[inline]
fn are_within(a: &Aabb, b: &Aabb, gap: f64) -> bool {
    let is_near = |low: f32, high: f32| f64::from(low) - f64::from(high) <= gap;
    (0..3).all(|axis| is_near(a.lo[axis], b.hi[axis]) & is_near(b.lo[axis], a.hi[axis]))
}

/// Sort and sweep along one axis over all elements, without a tree or pairs of triangles.
pub struct NearSweep {
    elements: Elements,
    told: Told,
    /// Start on the axis, body and number, for vertices, edges and triangles.
    begins: [Vec<(f32, usize, u32)>; 3],
}

impl NearSweep {
    /// Pairs within this margin round each vertex, edge and triangle.
    pub fn new(radius: f64) -> Self {
        Self {
            elements: Elements::within(radius),
            told: Told::Rows,
            begins: Default::default(),
        }
    }

    /// Pairs of elements at most this far apart.
    pub fn closer_than(distance: f64) -> Self {
        let mut all = Self::new(distance / 2.0);
        all.elements.sought = Sought::CloserThan(distance);
        all
    }

    /// Pairs of elements that meet during the motion.
    pub fn meeting() -> Self {
        let mut all = Self::new(0.0);
        all.elements.sought = Sought::Meeting;
        all
    }

    /// Reports only the earliest contact. Ties: vertex and triangle before edges, then the first in
    /// order.
    #[must_use]
    pub fn earliest(self) -> Self {
        Self {
            told: Told::Earliest,
            ..self
        }
    }

    /// Reports only counts: one row of the number of vertices and triangles, the number of edges,
    /// and two zeros.
    #[must_use]
    pub fn counted(self) -> Self {
        Self {
            told: Told::Count,
            ..self
        }
    }
}

impl Method for NearSweep {
    fn name(&self) -> String {
        "sweep of all elements".to_owned()
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.elements.build(bodies);
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.elements.take_over(shapes);
    }

    fn all_pairs(&mut self) -> &[Pair] {
        &[]
    }

    fn first_pair(&mut self) -> Option<Pair> {
        None
    }

    fn candidates(&mut self) -> Option<&[Pair]> {
        let Self {
            elements,
            told,
            begins,
        } = self;
        elements.begin();
        for (kind, list) in begins.iter_mut().enumerate() {
            list.clear();
            for (place, body) in elements.bodies.iter().enumerate() {
                let boxes = [&body.vertex_boxes, &body.edge_boxes, &body.triangle_boxes][kind];
                // Vertices that no triangle uses make no pair.
                let is_used =
                    |number: u32| kind > 0 || body.edges.iter().flatten().any(|&end| end == number);
                let all_used = body
                    .edges
                    .iter()
                    .flatten()
                    .collect::<std::collections::BTreeSet<_>>();
                let all_used = all_used.len() == body.vertex_boxes.len();
                let items = (0..).zip(boxes);
                let items = items.filter(|&(number, _)| all_used || is_used(number));
                list.extend(items.map(|(number, it)| (it.lo[0], place, number)));
            }
            list.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        }
        let reach = 2.0 * elements.radius;
        let [vertices, edges, triangles] = &*begins;
        let end = |elements: &Elements, kind: usize, body: usize, number: u32| {
            let body = &elements.bodies[body];
            let boxes = [&body.vertex_boxes, &body.edge_boxes, &body.triangle_boxes][kind];
            f64::from(boxes[number as usize].hi[0]) + reach
        };
        // Of two elements near each other on the axis, one begins first. From there, the other
        // begins before it ends.
        let mut next = 0;
        for &(from, a, vertex) in vertices {
            while next < triangles.len() && triangles[next].0 < from {
                next += 1;
            }
            let last = end(elements, 0, a, vertex);
            for &(begin, b, triangle) in &triangles[next..] {
                if f64::from(begin) > last {
                    break;
                }
                elements.vertex_triangle([a, b], vertex, triangle);
            }
        }
        let mut next = 0;
        for &(from, b, triangle) in triangles {
            while next < vertices.len() && vertices[next].0 <= from {
                next += 1;
            }
            let last = end(elements, 2, b, triangle);
            for &(begin, a, vertex) in &vertices[next..] {
                if f64::from(begin) > last {
                    break;
                }
                elements.vertex_triangle([a, b], vertex, triangle);
            }
        }
        for (place, &(_, a, i)) in edges.iter().enumerate() {
            let last = end(elements, 1, a, i);
            for &(begin, b, j) in &edges[place + 1..] {
                if f64::from(begin) > last {
                    break;
                }
                elements.edge_edge([a, b], i, j);
            }
        }
        match told {
            Told::Rows => return Some(elements.sorted()),
            Told::Count => {
                let [of_vertices, of_edges] = &elements.found;
                elements.all = vec![[of_vertices.len() as u32, of_edges.len() as u32, 0, 0]];
            }
            Told::Earliest => {
                elements.all = elements.earliest.map(|(.., row)| row).into_iter().collect();
            }
        }
        Some(&elements.all)
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.elements.counters)
    }
}
