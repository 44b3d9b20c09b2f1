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

/// Groups in a job: some microseconds of work.
const JOB: usize = 16;
/// So many groups, or fewer, are not worth waking a thread.
const SHARED: usize = 2 * JOB;

/// Where and with what to make boxes.
#[derive(Clone, Copy)]
pub(super) struct Work<'w, 's, S> {
    pub(super) threads: &'w Threads,
    pub(super) level: Level,
    pub(super) shape: &'w Shape<'s, S>,
}

/// A run of groups, the part of a tree that holds their boxes, and the part below that.
struct Job<'t, const N: usize> {
    run: &'t [u32],
    first_group: usize,
    groups: &'t mut [Siblings<N>],
    first_below: usize,
    below: &'t [Siblings<N>],
    made: u64,
}

/// Makes groups true from the vertices below them; they come in ascending order. Returns how many boxes it made.
pub(super) fn make_groups_true<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    run: &[u32],
) -> u64 {
    let job = Job {
        run,
        first_group: 0,
        groups: &mut tree.groups,
        first_below: 0,
        below: &[],
        made: 0,
    };
    make_all::<_, _, false>(work, job, &tree.leaves, &tree.vertices)
}

/// Makes groups true from the groups below them, which are, and from the triangles in their leaves. The groups come in ascending
/// order and are made level by level, children before their parents.
pub(super) fn merge_groups<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    run: &[u32],
) -> u64 {
    let (mut rest, mut made) = (run, 0);
    while let Some(&last) = rest.last() {
        let level = tree.level(tree.level_of(last));
        let first = rest.partition_point(|&group| group < level.start);
        let (groups, below) = tree.groups.split_at_mut(level.end as usize);
        let job = Job {
            run: &rest[first..],
            first_group: 0,
            groups,
            first_below: level.end as usize,
            below,
            made: 0,
        };
        made += make_all::<_, _, true>(work, job, &tree.leaves, &tree.vertices);
        rest = &rest[..first];
    }
    made
}

/// Makes the groups of a job true, cut into jobs of fewer groups if there are threads for them. Returns how many boxes it made.
fn make_all<const N: usize, S: Scalar, const MERGE: bool>(
    work: Work<'_, '_, S>,
    mut whole: Job<'_, N>,
    leaves: &Leaves,
    vertices: &VertexSets,
) -> u64 {
    let make = |job: &mut Job<'_, N>| {
        dispatch!(work.level, i => {
            for &group in job.run {
                make_group_true::<_, _, _, MERGE>(i, job, group as usize, leaves, vertices, work.shape);
            }
        });
    };
    if whole.run.len() <= SHARED || !work.threads.are_many() {
        make(&mut whole);
        return whole.made;
    }
    let mut jobs = whole.cut();
    work.threads.run(&mut jobs, |_, job| make(job));
    jobs.iter().map(|job| job.made).sum()
}

impl<const N: usize> Job<'_, N> {
    /// Jobs of fewer groups.
    fn cut(self) -> Vec<Self> {
        let mut groups = self.groups;
        let mut jobs = Vec::with_capacity(self.run.len().div_ceil(JOB));
        for run in self.run.chunks(JOB).rev() {
            let first_group = run[0] as usize;
            let (before, own) = groups.split_at_mut(first_group - self.first_group);
            jobs.push(Self {
                run,
                first_group,
                groups: own,
                ..self
            });
            groups = before;
        }
        jobs.reverse();
        jobs
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
                &job.below[below as usize - job.first_below].boxes.union(),
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
