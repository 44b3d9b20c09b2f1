//! A body brought up to date, and its trees shown to points, on several threads.
//!
//! For many points all boxes of a tree are made before, and threads share the points. For few they
//! are made when they are reached. The results are the same.

use super::candidates::Candidates;
use super::packets::Packet;
use super::reach::{Reach, Trees};
use crate::collide::Common;
use crate::error::Error;
use crate::geometry::Aabb;
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::queries::Needs;
use crate::threads::{Grain, Interrupt};
use crate::update::Partner;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

/// Points that go down a tree together.
pub(super) const TOGETHER: usize = 256;
/// Points are many if a body has at most this number of triangles for each.
const TRIANGLES_OF_ONE: usize = 64;

/// Shows each tree of a body to `work`, brought up to date for a number of points.
///
/// Ends early if `work` breaks; fails if interrupted.
pub(super) fn for_each_tree<S: Coordinate>(
    common: &mut Common<S>,
    id: BodyId,
    points: usize,
    interrupt: &Interrupt,
    work: &mut dyn FnMut(Trees<S>) -> ControlFlow<()>,
) -> Result<(), Error> {
    let place = common.bodies.place(id)?;
    common.settle_origin();
    let (mut step, bodies, _) = common.step(Needs::TRIANGLES, interrupt, false);
    let body = bodies.at_mut(place);
    let triangles = body.mesh().topology().live_count();
    let partner = if points.saturating_mul(TRIANGLES_OF_ONE) >= triangles {
        // All boxes, with the triangles', as for a body that meets itself.
        Partner::Itself
    } else {
        Partner::Another
    };
    let mut answer = || {
        step.bring_body_into_tree_order(body)?;
        for part in 0..body.part_count() {
            let mut side = step.ahead(body, part, partner)?;
            let leaves = &side.read.tree.leaves;
            let are_leaves_made = !leaves.have_blocks() || side.boxes.are_leaves_complete();
            work(if side.boxes.are_nodes_complete() && are_leaves_made {
                Trees::Made(side.view(), step.refit)
            } else {
                Trees::Lazy(&mut side, step.refit, step.statistics)
            })?;
        }
        ControlFlow::Continue(())
    };
    let _ = answer();
    common.end(interrupt)
}

/// Lists of one job, kept from some points to the next.
#[derive(Debug, Default)]
pub(super) struct Job {
    pub(super) reach: Reach,
    pub(super) packets: Vec<Packet>,
    /// Points by number, and their boxes.
    pub(super) boxes: Vec<(u32, Aabb)>,
    pub(super) candidates: Candidates,
}

/// Work with one tree: points, and a result for each.
pub(super) type Work<'w, S, R> =
    &'w (dyn Fn(&mut Trees<S>, &mut Job, &[[S; 3]], &mut [R]) -> ControlFlow<()> + Sync);

/// Has threads do the work for all points, some at a time. Breaks if it does, or if interrupted.
///
/// Counts the pairs of a point and a triangle that were looked at.
pub(super) fn share<S: Coordinate, R: Send>(
    mut trees: Trees<S>,
    points: &[[S; 3]],
    results: &mut [R],
    looked_at: &AtomicU64,
    work: Work<S, R>,
) -> ControlFlow<()> {
    let all = |trees: &mut Trees<S>, points: &[[S; 3]], results: &mut [R]| {
        let mut job = Job::default();
        let some = points.chunks(TOGETHER).zip(results.chunks_mut(TOGETHER));
        for (points, results) in some {
            work(trees, &mut job, points, results)?;
        }
        looked_at.fetch_add(job.reach.looked_at, Ordering::Relaxed);
        ControlFlow::Continue(())
    };
    let Trees::Made(view, refit) = trees else {
        return all(&mut trees, points, results);
    };
    let grain = Grain::RAYS;
    let nanoseconds = grain.time(points.len());
    if !refit.executor.pays(nanoseconds) {
        return all(&mut Trees::Made(view, refit), points, results);
    }
    let jobs = points
        .chunks(grain.items)
        .zip(results.chunks_mut(grain.items));
    let mut jobs: Vec<_> = jobs
        .map(|(points, results)| (points, results, true))
        .collect();
    refit
        .executor
        .run(&mut jobs, nanoseconds, |_, (points, results, ends)| {
            *ends = all(&mut Trees::Made(view, refit), points, results).is_break();
        });
    if jobs.iter().any(|&(.., ends)| ends) {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}
