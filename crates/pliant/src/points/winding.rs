//! Winding numbers of a closed body round points, by exact rays.
//!
//! A ray goes along an axis, to the nearest side of the body's box. A point outside the box has
//! none, and winding number 0. What each triangle does to the ray is decided exactly
//! (`pliant_exact::crossing`), so the sum is that of real arithmetic.

use super::packets::{Packet, runs, together};
use super::share::{Job, TOGETHER, for_each_tree, share};
use crate::collide::Common;
use crate::error::Error;
use crate::geometry::{Aabb, Bounds};
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::threads::Interrupt;
use crate::traversal::View;
use pliant_exact::{Axis, Crossing, crossing};
use std::ops::ControlFlow;
use std::sync::atomic::AtomicU64;

/// Sum of all that the triangles of a body do to the ray from a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Winding {
    /// Whether the point is on the surface.
    pub(crate) is_on: bool,
    /// How often the ray leaves, less how often it enters.
    pub(crate) number: i32,
    /// How often it does either.
    pub(crate) crossings: u32,
}

impl Winding {
    fn add(&mut self, crossing: Crossing) {
        match crossing {
            Crossing::Misses => return,
            Crossing::Leaves => self.number += 1,
            Crossing::Enters => self.number -= 1,
            Crossing::Begins => self.is_on = true,
        }
        self.crossings += 1;
    }
}

/// Winding numbers of a body round points, which are in range. Closed or not is the caller's care.
pub(crate) fn windings<S: Coordinate>(
    common: &mut Common<S>,
    body: BodyId,
    points: &[[S; 3]],
    interrupt: &Interrupt,
) -> Result<Vec<Winding>, Error> {
    let its_body = common.bodies.get(body)?;
    let bounds = its_body.bounds();
    let within = together(&bounds, its_body.mesh().topology().live_count());
    let mut windings = vec![Winding::default(); points.len()];
    let looked_at = AtomicU64::new(0);
    for_each_tree(common, body, points.len(), interrupt, &mut |trees| {
        share(
            trees,
            points,
            &mut windings,
            &looked_at,
            &|trees, job, points, windings| {
                let origin = trees.view().read.source.shape().origin;
                let Job { reach, packets, .. } = job;
                packets.clear();
                let mut axes = [Axis::default(); TOGETHER];
                for (run, all) in runs(points, within) {
                    if !bounds.overlaps(&all) {
                        continue;
                    }
                    let axis = to_nearest_side(&bounds, &all);
                    axes[packets.len()] = axis;
                    let mut packet = Packet::from(run.start);
                    for &point in &points[run] {
                        packet.push(&box_of_ray(axis, point, origin));
                    }
                    packets.push(packet);
                }
                reach.meet(trees, packets)?;
                let View { read, .. } = trees.view();
                let shape = read.source.shape();
                for met in &reach.met {
                    let axis = axes[met.packet as usize];
                    let first = packets[met.packet as usize].first;
                    for (lane, triangle) in met.pairs().filter(|&(_, it)| !read.is_gone(it)) {
                        let place = (first + lane) as usize;
                        let point = points[place].map(S::to_f64);
                        let corners = shape.corners(triangle);
                        windings[place].add(crossing(S::PRECISION, axis, &point, &corners));
                    }
                }
                ControlFlow::Continue(())
            },
        )
    })?;
    common.statistics.candidate_pairs += looked_at.into_inner();
    Ok(windings)
}

/// The axis along which rays of points within `all` first leave some bounds.
fn to_nearest_side<S: Coordinate>(bounds: &Bounds<S>, all: &Bounds<S>) -> Axis {
    let mut nearest = (f64::INFINITY, Axis::default());
    for number in 0..3 {
        let up = bounds.hi[number].to_f64() - all.lo[number].to_f64();
        let down = all.hi[number].to_f64() - bounds.lo[number].to_f64();
        for (way, ascends) in [(up, true), (down, false)] {
            if way < nearest.0 {
                nearest = (way, Axis { number, ascends });
            }
        }
    }
    nearest.1
}

/// Box of a ray.
fn box_of_ray<S: Coordinate>(axis: Axis, point: [S; 3], origin: [f64; 4]) -> Aabb {
    let mut ray = Bounds::at(point).to_box(origin);
    if axis.ascends {
        ray.hi[axis.number] = f32::INFINITY;
    } else {
        ray.lo[axis.number] = f32::NEG_INFINITY;
    }
    ray
}
