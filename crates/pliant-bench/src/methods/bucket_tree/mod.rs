//! BucketTree: an octree of fixed shape over each body, whose leaves are buckets refilled each
//! step.
//!
//! Ganovelli, Dingliana and O'Sullivan 2000, *BucketTree: Improving Collision Detection between
//! Deformable Objects*. Connectivity is not used.
//!
//! | part | how |
//! |---|---|
//! | step | all bodies, all triangles: box of the body, buckets, boxes bottom-up (`octree`) |
//! | bucket | by the centroid: one a triangle |
//! | bodies | brute force over their boxes |
//! | query | depth first; of two nodes the one with the longer box is opened, never a bucket |
//! | two buckets | their triangles against the overlap of the buckets' boxes, then each other |
//! | counted boxes | of triangles, buckets and nodes |
//! | counted tests | of nodes and buckets, and all tests of triangles |
//!
//! The query skips empty subtrees.

mod octree;

use crate::decision::Decision;
use crate::method::{Counters, Method, Pair};
use crate::methods::aabb::Aabb;
use crate::methods::answer::{Answer, Wanted, self_pair};
use crate::methods::bodies::{Bodies, share_a_vertex};
use crate::methods::triangle_box::triangle_box;
use crate::motion::{BodyMesh, Shape};
use octree::Octree;
use std::ops::ControlFlow;

/// Octrees with buckets.
pub struct BucketTree {
    depth: u32,
    bodies: Bodies,
    octrees: Vec<Octree>,
    scratch: Scratch,
    answer: Answer,
}

/// Memory that queries reuse.
#[derive(Default)]
struct Scratch {
    /// Pairs of nodes whose boxes overlap, still to be opened.
    ahead: Vec<[u32; 2]>,
    /// Triangles of a bucket that reach the other, with their boxes.
    near: [Vec<(u32, Aabb)>; 2],
}

impl BucketTree {
    /// Octrees with 8^`depth` buckets.
    ///
    /// # Panics
    ///
    /// If `depth` is not from 1 to 7.
    pub fn new(depth: u32, decision: Decision) -> Self {
        assert!((1..=7).contains(&depth), "an octree of {depth} levels");
        Self {
            depth,
            bodies: Bodies::default(),
            octrees: Vec::new(),
            scratch: Scratch::default(),
            answer: Answer::new(decision),
        }
    }

    fn query(&mut self, wanted: Wanted) {
        self.answer.begin(wanted);
        // Breaks when there are enough pairs.
        let _ = self.bodies.overlapping_pairs().try_for_each(|pair| {
            Pairing::of(&self.bodies, &self.octrees, pair)
                .descend(&mut self.scratch, &mut self.answer)
        });
    }
}

impl Method for BucketTree {
    fn name(&self) -> String {
        format!("BucketTree (depth {}, by centroid)", self.depth)
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.bodies = Bodies::build(bodies);
        self.octrees = bodies
            .iter()
            .map(|body| Octree::new(self.depth, body.triangles.len()))
            .collect();
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.bodies.take_over(shapes);
        for (body, octree) in self.octrees.iter_mut().enumerate() {
            self.answer.counters.boxes += octree.fill(&self.bodies, body);
        }
    }

    fn all_pairs(&mut self) -> &[Pair] {
        self.query(Wanted::All);
        self.answer.sorted()
    }

    fn first_pair(&mut self) -> Option<Pair> {
        self.query(Wanted::First);
        self.answer.first()
    }

    fn self_pairs(&mut self) -> Option<&[Pair]> {
        self.answer.begin(Wanted::All);
        for body in 0..self.octrees.len() {
            let _ = Pairing::of(&self.bodies, &self.octrees, [body, body])
                .descend(&mut self.scratch, &mut self.answer);
        }
        Some(self.answer.sorted())
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.answer.counters)
    }
}

/// Two octrees, or one octree twice.
struct Pairing<'a> {
    bodies: &'a Bodies,
    octrees: [&'a Octree; 2],
    pair: [usize; 2],
}

impl<'a> Pairing<'a> {
    fn of(bodies: &'a Bodies, octrees: &'a [Octree], pair: [usize; 2]) -> Self {
        Self {
            bodies,
            octrees: pair.map(|body| &octrees[body]),
            pair,
        }
    }

    /// Visits pairs of buckets, beginning with the roots.
    fn descend(&self, scratch: &mut Scratch, answer: &mut Answer) -> ControlFlow<()> {
        let [a, b] = self.octrees;
        let itself = self.pair[0] == self.pair[1];
        let Scratch { ahead, near } = scratch;
        let overlap = |i: u32, j: u32, answer: &mut Answer| {
            answer.counters.box_tests += 1;
            a.bounds(i).overlaps(b.bounds(j))
        };
        ahead.clear();
        if itself || overlap(0, 0, answer) {
            ahead.push([0, 0]);
        }
        while let Some([i, j]) = ahead.pop() {
            let buckets = [a.is_bucket(i), b.is_bucket(j)];
            if itself && i == j {
                if buckets[0] {
                    self.test_one(i, near, answer)?;
                    continue;
                }
                for first in a.children(i) {
                    ahead.push([first, first]);
                    for second in a.children(i).filter(|&second| second > first) {
                        if overlap(first, second, answer) {
                            ahead.push([first, second]);
                        }
                    }
                }
            } else if buckets == [true; 2] {
                self.test_two([i, j], near, answer)?;
            } else if buckets[0] || (!buckets[1] && side(a.bounds(i)) < side(b.bounds(j))) {
                for child in b.children(j) {
                    if overlap(i, child, answer) {
                        ahead.push([i, child]);
                    }
                }
            } else {
                for child in a.children(i) {
                    if overlap(child, j, answer) {
                        ahead.push([child, j]);
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Decides the triangles of two buckets.
    fn test_two(
        &self,
        [i, j]: [u32; 2],
        near: &mut [Vec<(u32, Aabb)>; 2],
        answer: &mut Answer,
    ) -> ControlFlow<()> {
        let [a, b] = self.octrees;
        let both = a.bounds(i).overlap(b.bounds(j));
        for (side, node) in [i, j].into_iter().enumerate() {
            self.gather(side, node, &both, &mut near[side], answer);
        }
        let [of_a, of_b] = &*near;
        for (s, s_box) in of_a {
            answer.counters.box_tests += of_b.len() as u64;
            for (t, t_box) in of_b {
                if s_box.overlaps(t_box) {
                    self.test([*s, *t], answer)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Decides the triangles of one bucket against each other.
    fn test_one(
        &self,
        bucket: u32,
        near: &mut [Vec<(u32, Aabb)>; 2],
        answer: &mut Answer,
    ) -> ControlFlow<()> {
        let all = &mut near[0];
        let everywhere = *self.octrees[0].bounds(bucket);
        self.gather(0, bucket, &everywhere, all, answer);
        for (place, (s, s_box)) in all.iter().enumerate() {
            let others = &all[place + 1..];
            answer.counters.box_tests += others.len() as u64;
            for (t, t_box) in others {
                if s_box.overlaps(t_box) {
                    self.test([*s, *t], answer)?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Collects the triangles of a bucket whose boxes meet a box.
    #[inline]
    fn gather(
        &self,
        side: usize,
        bucket: u32,
        region: &Aabb,
        near: &mut Vec<(u32, Aabb)>,
        answer: &mut Answer,
    ) {
        let triangles = &self.bodies.triangles[self.pair[side]];
        let positions = &self.bodies.positions[self.pair[side]];
        near.clear();
        for triangle in self.octrees[side].triangles(bucket) {
            let own = triangle_box(triangles[triangle as usize], positions);
            answer.counters.box_tests += 1;
            if own.overlaps(region) {
                near.push((triangle, own));
            }
        }
    }

    #[inline]
    fn test(&self, [s, t]: [u32; 2], answer: &mut Answer) -> ControlFlow<()> {
        let [a, b] = self.pair;
        let pair = if a == b {
            let triangles = &self.bodies.triangles[a];
            if share_a_vertex(triangles[s as usize], triangles[t as usize]) {
                return ControlFlow::Continue(());
            }
            self_pair(a, s, t)
        } else {
            [a as u32, s, b as u32, t]
        };
        answer.candidate(pair, &self.bodies.corners(a, s), &self.bodies.corners(b, t))
    }
}

/// Longest side of a box.
#[inline]
fn side(bounds: &Aabb) -> f32 {
    (0..3).fold(0.0, |side: f32, axis| {
        side.max(bounds.hi[axis] - bounds.lo[axis])
    })
}
