//! The triangle of a body that is nearest to each point, exactly, and where.
//!
//! A hint, or a leaf near a point, bounds its distance from above. All triangles whose boxes are
//! within that distance are then bounded from both sides: in single precision, and what is left in
//! double. Whatever may still be the nearest is compared exactly
//! (`pliant_exact::distance::nearest_triangle`). So the answer does not depend on the tree. Larsen,
//! Gottschalk, Lin and Manocha (2000) descend for each point alone, the nearest box first.

use super::candidates::Nearest;
use super::packets::{Packet, runs, together};
use super::share::{Job, for_each_tree, share};
use crate::collide::Common;
use crate::error::Error;
use crate::geometry::{Bounds, padded};
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::threads::Interrupt;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicU64;

/// A hint is of use if its distance has at most grown by this factor.
const FARTHER: f64 = 2.0;

/// Finds the nearest triangles of a body, where they are nearer than those that are known. Of
/// equally near ones the first, by body and number.
pub(crate) fn find_nearest<S: Coordinate>(
    common: &mut Common<S>,
    id: BodyId,
    points: &[[S; 3]],
    nearest: &mut [Nearest],
    interrupt: &Interrupt,
) -> Result<(), Error> {
    let body = common.bodies.get(id)?;
    let bounds = body.bounds();
    let mut all = points.iter().zip(nearest.iter());
    let is_near =
        |(&point, its): (&[S; 3], &Nearest)| gap(&bounds, &Bounds::at(point)) <= its.limit;
    if !all.any(is_near) {
        return Ok(());
    }
    let within = together(&bounds, body.mesh().topology().live_count());
    let looked_at = AtomicU64::new(0);
    for_each_tree(common, id, points.len(), interrupt, &mut |trees| {
        share(
            trees,
            points,
            nearest,
            &looked_at,
            &|trees, job, points, nearest| {
                let Job {
                    reach,
                    packets,
                    boxes,
                    candidates,
                } = job;
                let refit = trees.refit();
                let instructions = refit.instructions;
                let origin = trees.view().read.source.shape().origin;
                let rows: Vec<[S; 4]> = points.iter().map(|&it| padded(it)).collect();
                candidates.hinted(trees.view(), nearest);
                candidates.bound(instructions, (trees.view(), &rows), false, nearest);
                // The others go to a leaf, each to one of its own, for a tight limit.
                boxes.clear();
                for (place, &point) in points.iter().enumerate() {
                    let at = Bounds::at(point);
                    let Nearest { limit, hint, .. } = nearest[place];
                    let is_lost = hint.is_none_or(|hint| limit > FARTHER * hint.distance);
                    if is_lost && gap(&bounds, &at) <= limit {
                        boxes.push((place as u32, at.to_box(origin)));
                    }
                }
                reach.go_near(trees, boxes)?;
                candidates.near(instructions, trees.view(), reach, boxes);
                candidates.bound(instructions, (trees.view(), &rows), false, nearest);
                packets.clear();
                for (run, all) in runs(points, within) {
                    let farthest = nearest[run.clone()]
                        .iter()
                        .fold(0.0, |m: f64, it| m.max(it.limit));
                    if gap(&bounds, &all) > farthest {
                        continue;
                    }
                    let mut packet = Packet::from(run.start);
                    for place in run {
                        let at = Bounds::at(points[place]);
                        packet.push_near(&at.to_box(origin), nearest[place].limit);
                    }
                    packets.push(packet);
                }
                reach.meet(trees, packets)?;
                let view = trees.view();
                candidates.met(view, reach, packets);
                candidates.bound(instructions, (view, &rows), false, nearest);
                candidates.drop_far(nearest);
                candidates.set_aside(nearest);
                candidates.bound(instructions, (view, &rows), true, nearest);
                candidates.drop_far(nearest);
                candidates.keep_nearest(instructions, view, &rows, nearest);
                ControlFlow::Continue(())
            },
        )
    })?;
    common.statistics.candidate_pairs += looked_at.into_inner();
    Ok(())
}

/// Finds the nearest triangles of all bodies, those near all points first.
pub(crate) fn find_nearest_of_all<S: Coordinate>(
    common: &mut Common<S>,
    points: &[[S; 3]],
    nearest: &mut [Nearest],
    interrupt: &Interrupt,
) -> Result<(), Error> {
    let mut all = Bounds::EMPTY;
    points.iter().for_each(|&point| all.include(point));
    let gaps = common
        .bodies
        .in_order()
        .map(|body| (gap(&body.bounds(), &all), body.id()));
    let mut bodies: Vec<(f64, BodyId)> = gaps.collect();
    bodies.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (gap, body) in bodies {
        let farthest = nearest.iter().fold(0.0, |m: f64, it| m.max(it.limit));
        if gap > farthest {
            break;
        }
        find_nearest(common, body, points, nearest, interrupt)?;
    }
    Ok(())
}

/// Lower bound of the distance of two bounds, computed in `f64`.
fn gap<S: Coordinate>(a: &Bounds<S>, b: &Bounds<S>) -> f64 {
    let mut square = 0.0;
    for axis in 0..3 {
        let below = b.lo[axis].to_f64() - a.hi[axis].to_f64();
        let above = a.lo[axis].to_f64() - b.hi[axis].to_f64();
        let gap = below.max(above).max(0.0);
        square += gap * gap;
    }
    square.sqrt() * (1.0 - 8.0 * f64::EPSILON) - f64::powi(0.5, 500)
}
