//! Brute force over boxes of triangles: the floor that every other method should beat.
//!
//! Compares every pair of boxes in the region where two bodies overlap, and every pair within a
//! body, then decides. Boxes are made once per query and body. They are compared eight at a time,
//! in structure-of-arrays form: each axis is a row of eight numbers. There is no branch until all
//! eight are known.

use super::aabb::Aabb;
use super::answer::{Answer, Proposer, self_pair};
use super::bodies::{Bodies, share_a_vertex};
use super::region::{Region, gather_overlap};
use crate::decision::Decision;

use crate::motion::{BodyMesh, Shape};
use std::ops::ControlFlow;

/// Brute force over all pairs of boxes, without order or tree.
pub struct BruteForce {
    bodies: Bodies,
    regions: [Region; 2],
    rows: Vec<Row>,
    answer: Answer,
}

impl BruteForce {
    /// Brute force with this triangle test.
    pub fn new(decision: Decision) -> Self {
        Self {
            bodies: Bodies::default(),
            regions: Default::default(),
            rows: Vec::new(),
            answer: Answer::new(decision),
        }
    }
}

impl Proposer for BruteForce {
    fn name(&self) -> String {
        "brute force over boxes".to_owned()
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.bodies = Bodies::build(bodies);
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.bodies.take_over(shapes);
    }

    fn between_bodies(&mut self) -> ControlFlow<()> {
        let Self {
            bodies,
            regions,
            rows,
            answer,
        } = self;
        for [a, b] in bodies.overlapping_pairs() {
            gather_overlap(bodies, [a, b], regions);
            answer.counters.boxes += (bodies.triangles[a].len() + bodies.triangles[b].len()) as u64;
            let [of_a, of_b] = &*regions;
            fill(rows, &of_b.boxes);
            for (&i, box_a) in of_a.triangles.iter().zip(&of_a.boxes) {
                answer.counters.box_tests += of_b.boxes.len() as u64;
                let corners = bodies.corners(a, i);
                overlapping(rows, 0, box_a, |place| {
                    let j = of_b.triangles[place];
                    let pair = [a as u32, i, b as u32, j];
                    answer.candidate(pair, &corners, &bodies.corners(b, j))
                })?;
            }
        }
        ControlFlow::Continue(())
    }

    fn within_bodies(&mut self) -> ControlFlow<()> {
        let Self {
            bodies,
            regions: [region, _],
            rows,
            answer,
        } = self;
        for (body, triangles) in bodies.triangles.iter().enumerate() {
            region.gather(bodies, body, &bodies.boxes[body]);
            answer.counters.boxes += triangles.len() as u64;
            fill(rows, &region.boxes);
            for (i, own_box) in region.boxes.iter().enumerate() {
                let after = i + 1;
                answer.counters.box_tests += (triangles.len() - after) as u64;
                let corners = bodies.corners(body, i as u32);
                overlapping(rows, after, own_box, |j| {
                    if share_a_vertex(triangles[i], triangles[j]) {
                        return ControlFlow::Continue(());
                    }
                    let (i, j) = (i as u32, j as u32);
                    answer.candidate(self_pair(body, i, j), &corners, &bodies.corners(body, j))
                })?;
            }
        }
        ControlFlow::Continue(())
    }

    fn answer(&mut self) -> &mut Answer {
        &mut self.answer
    }
}

/// Number of boxes in a row, which are compared together.
const WIDTH: usize = 8;

/// Eight boxes side by side: lower and upper sides for each axis. Missing boxes are empty.
#[derive(Clone, Copy, Debug)]
struct Row {
    lo: [[f32; WIDTH]; 3],
    hi: [[f32; WIDTH]; 3],
}

impl Row {
    fn of(boxes: &[Aabb]) -> Self {
        let mut row = Self {
            lo: [[f32::INFINITY; WIDTH]; 3],
            hi: [[f32::NEG_INFINITY; WIDTH]; 3],
        };
        for (lane, own_box) in boxes.iter().enumerate() {
            for axis in 0..3 {
                row.lo[axis][lane] = own_box.lo[axis];
                row.hi[axis][lane] = own_box.hi[axis];
            }
        }
        row
    }

    /// Lanes whose boxes overlap `other`; touching counts.
    #[inline]
    fn overlapping(&self, other: &Aabb) -> [bool; WIDTH] {
        std::array::from_fn(|lane| {
            (self.lo[0][lane] <= other.hi[0])
                & (other.lo[0] <= self.hi[0][lane])
                & (self.lo[1][lane] <= other.hi[1])
                & (other.lo[1] <= self.hi[1][lane])
                & (self.lo[2][lane] <= other.hi[2])
                & (other.lo[2] <= self.hi[2][lane])
        })
    }
}

fn fill(rows: &mut Vec<Row>, boxes: &[Aabb]) {
    rows.clear();
    rows.extend(boxes.chunks(WIDTH).map(Row::of));
}

/// Visits the boxes from place `start` on that overlap `other`.
#[inline]
fn overlapping(
    rows: &[Row],
    start: usize,
    other: &Aabb,
    mut visit: impl FnMut(usize) -> ControlFlow<()>,
) -> ControlFlow<()> {
    for (number, row) in rows.iter().enumerate().skip(start / WIDTH) {
        let lanes = row.overlapping(other);
        if lanes == [false; WIDTH] {
            continue;
        }
        for (lane, _) in lanes.iter().enumerate().filter(|&(_, &overlaps)| overlaps) {
            let place = number * WIDTH + lane;
            if place >= start {
                visit(place)?;
            }
        }
    }
    ControlFlow::Continue(())
}
