//! Boxes of groups, straight from the vertices and triangles below them, as many groups at once as there are threads.
//!
//! Groups are stored level by level in the order of their triangles, and so are the blocks of triangles in leaves. So groups in
//! ascending order are cut into runs, and each run owns one part of either array: no two jobs write one box.

use crate::exec::Threads;
use crate::geometry::{Scalar, Shape};
use crate::kernels::Level;
use crate::kernels::extent::{self, Extent};
use crate::statistics::Statistics;
use crate::tree::{Below, Block, LEAF_LANES, LeafRuns, Siblings, Tree, VertexSets};
use fearless_simd::{Simd, dispatch};

/// Groups in a job: some ten microseconds of work.
const JOB: usize = 32;

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
    first_block: usize,
    blocks: &'t mut [Block],
    /// Boxes of nodes and of triangles made.
    made: [u64; 2],
}

impl<'t, const N: usize> Job<'t, N> {
    /// A run of groups, and all of the tree.
    fn of_all(run: &'t [u32], groups: &'t mut [Siblings<N>], blocks: &'t mut [Block]) -> Self {
        Self {
            run,
            first_group: 0,
            groups,
            first_block: 0,
            blocks,
            made: [0; 2],
        }
    }
}

/// Makes groups true from what is below them; they come in ascending order. Returns how many boxes of nodes it made.
pub(super) fn make_groups_true<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    run: &[u32],
    statistics: &mut Statistics,
) -> u64 {
    let (leaves, blocks) = tree.leaves.split();
    let mut whole = Job::of_all(run, &mut tree.groups, blocks);
    let make = |job: &mut Job<'_, N>| {
        dispatch!(work.level, i => {
            for &group in job.run {
                make_group_true::<_, _, _, false>(i, job, group as usize, leaves, &tree.vertices, work.shape);
            }
        });
    };
    let [nodes, triangles] = if run.len() <= JOB || !work.threads.are_many() {
        make(&mut whole);
        whole.made
    } else {
        let mut jobs = cut(whole, leaves);
        work.threads.run(&mut jobs, |_, job| make(job));
        jobs.iter().fold([0; 2], |all, job| {
            [all[0] + job.made[0], all[1] + job.made[1]]
        })
    };
    statistics.triangle_boxes += triangles;
    nodes
}

/// Makes groups true from the groups below them, which are, and from the triangles in their leaves. The groups come in ascending
/// order and are made from the last to the first, children before their parents.
pub(super) fn merge_groups<const N: usize, S: Scalar>(
    work: Work<'_, '_, S>,
    tree: &mut Tree<N>,
    run: &[u32],
    statistics: &mut Statistics,
) -> u64 {
    let (leaves, blocks) = tree.leaves.split();
    let mut job = Job::of_all(run, &mut tree.groups, blocks);
    dispatch!(work.level, i => {
        for &group in run.iter().rev() {
            make_group_true::<_, _, _, true>(i, &mut job, group as usize, leaves, &tree.vertices, work.shape);
        }
    });
    statistics.triangle_boxes += job.made[1];
    job.made[0]
}

/// Cuts a job into jobs of fewer groups.
fn cut<'t, const N: usize>(whole: Job<'t, N>, leaves: LeafRuns) -> Vec<Job<'t, N>> {
    let Job {
        run,
        mut first_group,
        mut groups,
        mut first_block,
        mut blocks,
        ..
    } = whole;
    let mut jobs = Vec::with_capacity(run.len().div_ceil(JOB));
    let mut runs = run.chunks(JOB).peekable();
    while let Some(run) = runs.next() {
        // Up to the first group of the next job, and the first block below it.
        let next_group = runs.peek().map(|next| next[0] as usize);
        let end = next_group.map_or(groups.len(), |next| next - first_group);
        let (own_groups, other_groups) = groups.split_at_mut(end);
        let next_block = other_groups
            .iter()
            .find_map(|group| first_block_below(group, leaves));
        let end = next_block.map_or(blocks.len(), |next| next - first_block);
        let (own_blocks, other_blocks) = blocks.split_at_mut(end);
        jobs.push(Job {
            run,
            first_group,
            groups: own_groups,
            first_block,
            blocks: own_blocks,
            made: [0; 2],
        });
        first_group = next_group.unwrap_or(first_group);
        first_block = next_block.unwrap_or(first_block);
        (groups, blocks) = (other_groups, other_blocks);
    }
    jobs
}

/// The first block of triangles in a leaf of a group, if it has leaves and they have blocks.
fn first_block_below<const N: usize>(group: &Siblings<N>, leaves: LeafRuns) -> Option<usize> {
    group.used_children().find_map(|child| match child.below() {
        Below::Leaf(leaf) => leaves.get(leaf).1,
        Below::Group(_) => None,
    })
}

/// Makes one group true, and the boxes of the triangles in its leaves. If `MERGE`, the groups below are true.
#[inline(always)]
fn make_group_true<I: Simd, const N: usize, S: Scalar, const MERGE: bool>(
    i: I,
    job: &mut Job<'_, N>,
    group: usize,
    leaves: LeafRuns,
    vertices: &VertexSets,
    shape: &Shape<S>,
) {
    let place = group - job.first_group;
    let first_node = job.groups[place].first_node as usize;
    let children = job.groups[place].children;
    let count = job.groups[place].len();
    let mut boxes: [Extent<I>; 8] = [extent::nothing(i); 8];
    for lane in 0..count {
        boxes[lane] = match children[lane].below() {
            Below::Group(below) if MERGE => extent::of_box(
                i,
                &job.groups[below as usize - job.first_group].boxes.union(),
            ),
            Below::Group(_) => {
                let (run, border) = vertices.run_and_border(first_node + lane);
                extent::of_points(i, shape, run, border)
            }
            Below::Leaf(leaf) => {
                let (triangles, first_block) = leaves.get(leaf);
                let Some(first_block) = first_block else {
                    boxes[lane] = extent::of_triangle(i, shape, triangles.start as u32);
                    continue;
                };
                job.made[1] += triangles.len() as u64;
                let mut all = None;
                let blocks = &mut job.blocks[first_block - job.first_block..];
                for (block, triangles) in blocks
                    .iter_mut()
                    .zip(shape.triangles[triangles].chunks(LEAF_LANES))
                {
                    let of_block = extent::of_block(i, shape, triangles, block);
                    all = Some(all.map_or(of_block, |all| extent::union(all, of_block)));
                }
                all.expect("a leaf has triangles")
            }
        };
    }
    let siblings = &mut job.groups[place];
    extent::store(boxes, count, &mut siblings.boxes);
    siblings.epoch = shape.epoch;
    job.made[0] += count as u64;
}
