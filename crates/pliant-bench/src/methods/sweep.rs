//! Sort and sweep over boxes of triangles, in the region where two bodies overlap: is a tree worth
//! it?
//!
//! One axis is swept: the one on which the box centres vary most, where the fewest boxes share a
//! coordinate. Boxes are sorted by their lower side from scratch at every query. Two boxes overlap
//! on the axis if and only if the later one begins before the earlier one ends. The other two axes
//! are compared directly, then triangles are decided, except neighbours. Nothing is kept from step
//! to step, so this is also the truth where all pairs without boxes would take too long.

use super::aabb::Aabb;
use super::answer::{Answer, Proposer, self_pair};
use super::bodies::{Bodies, share_a_vertex};
use super::region::{Region, gather_overlap};
use crate::decision::Decision;
use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use std::ops::ControlFlow;

/// Sort and sweep over boxes of triangles, along one axis.
pub struct Sweep {
    bodies: Bodies,
    regions: [Region; 2],
    sorted: [Sorted; 2],
    answer: Answer,
}

impl Sweep {
    /// The sweep with this triangle test.
    pub fn new(decision: Decision) -> Self {
        Self {
            bodies: Bodies::default(),
            regions: Default::default(),
            sorted: Default::default(),
            answer: Answer::new(decision),
        }
    }
}

/// The sweep over different bodies and each body with itself, where others are asked for
/// candidates.
pub struct Everywhere {
    sweep: Sweep,
    pairs: Vec<Pair>,
}

impl Everywhere {
    /// The sweep with this triangle test.
    pub fn new(decision: Decision) -> Self {
        Self {
            sweep: Sweep::new(decision),
            pairs: Vec::new(),
        }
    }
}

impl Method for Everywhere {
    fn name(&self) -> String {
        Method::name(&self.sweep)
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        Method::build(&mut self.sweep, bodies);
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        Method::step(&mut self.sweep, shapes);
    }

    fn all_pairs(&mut self) -> &[Pair] {
        self.sweep.all_pairs()
    }

    fn first_pair(&mut self) -> Option<Pair> {
        self.sweep.first_pair()
    }

    fn candidates(&mut self) -> Option<&[Pair]> {
        self.pairs.clear();
        self.pairs.extend(self.sweep.all_pairs());
        self.pairs.extend(self.sweep.self_pairs()?);
        self.pairs.sort_unstable();
        Some(&self.pairs)
    }

    fn take_counters(&mut self) -> Counters {
        self.sweep.take_counters()
    }
}

impl Proposer for Sweep {
    fn name(&self) -> String {
        "flat sweep".to_owned()
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
            sorted,
            answer,
        } = self;
        for [a, b] in bodies.overlapping_pairs() {
            gather_overlap(bodies, [a, b], regions);
            answer.counters.boxes += (bodies.triangles[a].len() + bodies.triangles[b].len()) as u64;
            let axis = widest_axis(regions.iter().flat_map(|region| &region.boxes));
            for (sorted, region) in sorted.iter_mut().zip(&*regions) {
                sorted.sort(region, axis);
            }
            let [of_a, of_b] = &*sorted;
            let mut box_tests = 0;
            let flow = sweep_two(&of_a.items, &of_b.items, &mut box_tests, |i, j| {
                answer.candidate(
                    [a as u32, i, b as u32, j],
                    &bodies.corners(a, i),
                    &bodies.corners(b, j),
                )
            });
            answer.counters.box_tests += box_tests;
            flow?;
        }
        ControlFlow::Continue(())
    }

    fn within_bodies(&mut self) -> ControlFlow<()> {
        let Self {
            bodies,
            regions: [region, _],
            sorted: [sorted, _],
            answer,
        } = self;
        for (body, triangles) in bodies.triangles.iter().enumerate() {
            region.gather(bodies, body, &bodies.boxes[body]);
            answer.counters.boxes += triangles.len() as u64;
            sorted.sort(region, widest_axis(&region.boxes));
            let mut box_tests = 0;
            let flow = sweep_one(&sorted.items, &mut box_tests, |i, j| {
                if share_a_vertex(triangles[i as usize], triangles[j as usize]) {
                    return ControlFlow::Continue(());
                }
                answer.candidate(
                    self_pair(body, i, j),
                    &bodies.corners(body, i),
                    &bodies.corners(body, j),
                )
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

/// Axis on which the centres of the boxes have the largest variance; the first of equal ones.
fn widest_axis<'a>(boxes: impl IntoIterator<Item = &'a Aabb>) -> usize {
    let (mut count, mut sums, mut squares) = (0.0, [0.0; 3], [0.0; 3]);
    for own_box in boxes {
        count += 1.0;
        for axis in 0..3 {
            let twice_centre = f64::from(own_box.lo[axis]) + f64::from(own_box.hi[axis]);
            sums[axis] += twice_centre;
            squares[axis] += twice_centre * twice_centre;
        }
    }
    // Far from the origin rounding may choose a worse axis, but never causes a wrong answer.
    let variance = |axis: usize| squares[axis] - sums[axis] * sums[axis] / count;
    (1..3).fold(0, |widest, axis| {
        if variance(axis) > variance(widest) {
            axis
        } else {
            widest
        }
    })
}

/// A box and its triangle, the axis of the sweep first.
#[derive(Clone, Copy, Debug)]
struct Item {
    lo: [f32; 3],
    hi: [f32; 3],
    triangle: u32,
}

impl Item {
    /// Whether two boxes overlap on the axes that are not swept; touching counts.
    ///
    /// No branch between the four comparisons: they are seldom true together.
    #[inline]
    fn overlaps_across(&self, other: &Self) -> bool {
        (self.lo[1] <= other.hi[1])
            & (other.lo[1] <= self.hi[1])
            & (self.lo[2] <= other.hi[2])
            & (other.lo[2] <= self.hi[2])
    }
}

/// Boxes in the order in which they begin.
#[derive(Debug, Default)]
struct Sorted {
    keys: Vec<u64>,
    items: Vec<Item>,
}

impl Sorted {
    /// Sorts integer keys (start above place), then fetches the boxes in that order.
    fn sort(&mut self, region: &Region, axis: usize) {
        self.keys.clear();
        self.keys.extend(
            region.boxes.iter().enumerate().map(|(place, own_box)| {
                u64::from(ascending(own_box.lo[axis])) << 32 | place as u64
            }),
        );
        self.keys.sort_unstable();
        self.items.clear();
        self.items.extend(self.keys.iter().map(|&key| {
            let place = key as u32 as usize;
            let own_box = &region.boxes[place];
            let axes = [axis, (axis + 1) % 3, (axis + 2) % 3];
            Item {
                lo: axes.map(|axis| own_box.lo[axis]),
                hi: axes.map(|axis| own_box.hi[axis]),
                triangle: region.triangles[place],
            }
        }));
    }
}

/// An integer that grows with a finite number.
#[inline]
fn ascending(value: f32) -> u32 {
    let bits = value.to_bits();
    if value.is_sign_negative() {
        !bits
    } else {
        bits | 1 << 31
    }
}

/// Visits the overlapping pairs of two lists, each once.
///
/// Of two boxes that overlap on the axis, one begins first or they begin together. When it is
/// taken, the other is still to come.
fn sweep_two(
    a: &[Item],
    b: &[Item],
    box_tests: &mut u64,
    mut visit: impl FnMut(u32, u32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let (mut i, mut j) = (0, 0);
    while let (Some(first_a), Some(first_b)) = (a.get(i), b.get(j)) {
        if first_a.lo[0] <= first_b.lo[0] {
            overlapping(first_a, &b[j..], box_tests, |other| {
                visit(first_a.triangle, other)
            })?;
            i += 1;
        } else {
            overlapping(first_b, &a[i..], box_tests, |other| {
                visit(other, first_b.triangle)
            })?;
            j += 1;
        }
    }
    ControlFlow::Continue(())
}

/// Visits the overlapping pairs of one list, each once.
fn sweep_one(
    items: &[Item],
    box_tests: &mut u64,
    mut visit: impl FnMut(u32, u32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    for (place, item) in items.iter().enumerate() {
        overlapping(item, &items[place + 1..], box_tests, |other| {
            visit(item.triangle, other)
        })?;
    }
    ControlFlow::Continue(())
}

/// Visits the boxes that overlap `item`, among the next in order. None of them begins before it.
#[inline]
fn overlapping(
    item: &Item,
    to_come: &[Item],
    box_tests: &mut u64,
    mut visit: impl FnMut(u32) -> ControlFlow<()>,
) -> ControlFlow<()> {
    for other in to_come {
        if other.lo[0] > item.hi[0] {
            break;
        }
        *box_tests += 1;
        if item.overlaps_across(other) {
            visit(other.triangle)?;
        }
    }
    ControlFlow::Continue(())
}
