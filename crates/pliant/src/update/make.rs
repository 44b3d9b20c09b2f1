//! Boxes of groups, straight from the vertices and triangles below them, as many groups at once as there are threads.
//!
//! Groups are stored level by level in the order of their triangles. So groups in ascending order are cut into runs, and each run
//! owns one part of the array: no two jobs write one box.

use crate::exec::Threads;
use crate::geometry::{Scalar, Shape};
use crate::kernels::Level;
use crate::kernels::extent::{self, Extent};
use crate::tree::{Below, Leaves, Siblings, Tree, VertexSets};
use fearless_simd::{Simd, dispatch};

/// Groups in a job: some tens of microseconds of work.
const JOB: usize = 128;

/// Where and with what to make boxes.
#[derive(Clone, Copy)]
pub(super) struct Work<'w, 's, S> {
    pub(super) threads: &'w Threads,
    pub(super) level: Level,
    pub(super) shape: &'w Shape<'s, S>,
}

/// A run of groups, and the part of a tree that holds their boxes.
struct Job<'t, const N: usize> {
    run: &'t [u32],
    first_group: usize,
    groups: &'t mut [Siblings<N>],
    made: u64,
}

/// Makes groups true from what is below them; they come in ascending order. Returns how many boxes it made.
pub(super) fn make_groups_true<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    run: &[u32],
) -> u64 {
    let (vertices, leaves) = (&tree.vertices, &tree.leaves);
    let make = |job: &mut Job<'_, N>| {
        dispatch!(work.level, i => {
            for &group in job.run {
                make_group_true::<_, _, _, false>(i, job, group as usize, leaves, vertices, work.shape);
            }
        });
    };
    let mut whole = Job::of_all(run, &mut tree.groups);
    if run.len() <= JOB || !work.threads.are_many() {
        make(&mut whole);
        return whole.made;
    }
    let mut jobs = cut(whole);
    work.threads.run(&mut jobs, |_, job| make(job));
    jobs.iter().map(|job| job.made).sum()
}

/// Makes groups true from the groups below them, which are, and from the triangles in their leaves. The groups come in ascending
/// order and are made from the last to the first, children before their parents.
pub(super) fn merge_groups<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    run: &[u32],
) -> u64 {
    let mut job = Job::of_all(run, &mut tree.groups);
    dispatch!(work.level, i => {
        for &group in run.iter().rev() {
            make_group_true::<_, _, _, true>(i, &mut job, group as usize, &tree.leaves, &tree.vertices, work.shape);
        }
    });
    job.made
}

impl<'t, const N: usize> Job<'t, N> {
    /// A run of groups, and all of the tree.
    fn of_all(run: &'t [u32], groups: &'t mut [Siblings<N>]) -> Self {
        Self {
            run,
            first_group: 0,
            groups,
            made: 0,
        }
    }

    /// Keeps the first `count` of these boxes, which are those of a group.
    #[inline(always)]
    fn store<I: Simd>(&mut self, place: usize, boxes: [Extent<I>; 8], count: usize, epoch: u64) {
        let siblings = &mut self.groups[place];
        extent::store(boxes, count, &mut siblings.boxes);
        siblings.epoch = epoch;
        self.made += count as u64;
    }
}

/// Cuts a job into jobs of fewer groups.
fn cut<const N: usize>(whole: Job<'_, N>) -> Vec<Job<'_, N>> {
    let Job {
        run,
        first_group,
        mut groups,
        ..
    } = whole;
    let mut jobs = Vec::with_capacity(run.len().div_ceil(JOB));
    for run in run.chunks(JOB).rev() {
        let first = run[0] as usize;
        let (before, own) = groups.split_at_mut(first - first_group);
        jobs.push(Job {
            run,
            first_group: first,
            groups: own,
            made: 0,
        });
        groups = before;
    }
    jobs.reverse();
    jobs
}

/// Makes one group true. If `MERGE`, the groups below are true.
#[inline(always)]
fn make_group_true<I: Simd, const N: usize, S: Scalar, const MERGE: bool>(
    i: I,
    job: &mut Job<'_, N>,
    group: usize,
    leaves: &Leaves,
    vertices: &VertexSets,
    shape: &Shape<S>,
) {
    let place = group - job.first_group;
    let first_node = job.groups[place].first_node as usize;
    let mut boxes: [Extent<I>; 8] = [extent::nothing(i); 8];
    if let Some(twelves) = vertices.twelves::<N>(first_node) {
        for lane in 0..N {
            boxes[lane] = extent::of_twelve(i, shape, &twelves[lane]);
        }
        job.store(place, boxes, N, shape.epoch);
        return;
    }
    let children = job.groups[place].children;
    let count = job.groups[place].len();
    for lane in 0..count {
        boxes[lane] = match children[lane].below() {
            Below::Group(below) if MERGE => extent::of_box(
                i,
                &job.groups[below as usize - job.first_group].boxes.union(),
            ),
            Below::Leaf(leaf) if !leaves.have_boxes() => {
                extent::of_triangle(i, shape, leaves.triangles(leaf).start)
            }
            _ => {
                let (run, border) = vertices.run_and_border(first_node + lane);
                extent::of_points(i, shape, run, border)
            }
        };
    }
    job.store(place, boxes, count, shape.epoch);
}
