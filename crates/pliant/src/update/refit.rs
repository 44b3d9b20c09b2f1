//! Boxes of wide nodes, from the vertices or from the wide nodes below them, as many at once as there are threads.
//!
//! Wide nodes are stored level by level in the order of their triangles. So a list of them in ascending order is cut into runs, and
//! each run owns one part of the array: no two jobs write one box.

use super::refitted::{Refit, Refitted};
use crate::ids::WideNodeId;
use crate::kernels::extent::{self, Extent};
use crate::kernels::{BoxLanes, Coordinate, Simd, dispatch};
use crate::tree::{BoxSource, Child, NodesMut, Over, Source, Tree, of_degree, of_source};

/// Wide nodes in a job: some microseconds of work.
const JOB: usize = 16;
/// So many wide nodes, or fewer, are not worth waking a thread.
const SHARED: usize = 2 * JOB;
/// So many wide nodes are refitted before it is asked whether the query was interrupted.
const UNINTERRUPTED: usize = 1024;

/// A run of wide nodes, the part of a set of boxes that holds theirs, and the part below that.
struct NodeRun<'t, const N: usize> {
    run: &'t [WideNodeId],
    nodes: NodesMut<'t, N>,
    /// Whether boxes are merged from those of wide nodes below, which are valid.
    merges: bool,
    first_below: usize,
    below: &'t [BoxLanes<N>],
    stamp: u64,
    made: u64,
}

/// Makes the boxes of wide nodes from the vertices below them; they come in ascending order. Returns how many boxes it made.
pub(super) fn refit_from_vertices<S: Coordinate>(
    refit: &Refit,
    one: &mut Refitted<S>,
    run: &[WideNodeId],
) -> u64 {
    let stamp = one.boxes.stamp();
    let (nodes, stamps) = one.boxes.nodes_mut();
    of_degree!(nodes, boxes => {
        let (nodes, below) = NodesMut::before(boxes, stamps, one.tree.wide_nodes.len());
        let job = NodeRun { run, nodes, merges: false, first_below: 0, below, stamp, made: 0 };
        refit_all(refit, job, one.tree, one.source)
    })
}

/// Makes the boxes of wide nodes from those of the wide nodes below them, which are valid, and from the vertices of their leaves. They
/// come in ascending order and are made level by level, children before their parents.
pub(super) fn refit_from_children<S: Coordinate>(
    refit: &Refit,
    one: &mut Refitted<S>,
    run: &[WideNodeId],
) -> u64 {
    let stamp = one.boxes.stamp();
    let (mut rest, mut made) = (run, 0);
    while let Some(&last) = rest.last() {
        let level = one.tree.level(one.tree.level_of(last));
        let first = rest.partition_point(|wide_node| wide_node.index() < level.start);
        let (nodes, stamps) = one.boxes.nodes_mut();
        let run = &rest[first..];
        made += of_degree!(nodes, boxes => {
            let (nodes, below) = NodesMut::before(boxes, stamps, level.end);
            let job = NodeRun { run, nodes, merges: true, first_below: level.end, below, stamp, made: 0 };
            refit_all(refit, job, one.tree, one.source)
        });
        rest = &rest[..first];
    }
    made
}

/// Makes the boxes of a job, cut into jobs of fewer wide nodes if there are threads for them. Returns how many boxes it made.
fn refit_all<const N: usize, S: Coordinate>(
    refit: &Refit,
    whole: NodeRun<'_, N>,
    tree: &Tree,
    source: &Source<S>,
) -> u64 {
    let executor = refit.executor;
    let is_worth_it = whole.run.len() > SHARED && executor.are_many();
    let work = |job: &mut NodeRun<'_, N>| {
        for run in job.run.chunks(UNINTERRUPTED) {
            if executor.is_interrupted() {
                return;
            }
            of_source!(source, source => dispatch!(refit.instructions, i => {
                for &wide_node in run {
                    refit_one(i, job, wide_node, tree, source);
                }
            }));
        }
    };
    let mut made = 0;
    executor.run_cut(whole, is_worth_it, NodeRun::cut, work, |job| {
        made += job.made;
    });
    made
}

impl<const N: usize> NodeRun<'_, N> {
    /// Jobs of fewer wide nodes.
    fn cut(self) -> Vec<Self> {
        let mut nodes = self.nodes;
        let mut jobs = Vec::with_capacity(self.run.len().div_ceil(JOB));
        for run in self.run.chunks(JOB).rev() {
            let [before, own] = nodes.split_before(run[0]);
            jobs.push(Self {
                run,
                nodes: own,
                ..self
            });
            nodes = before;
        }
        jobs.reverse();
        jobs
    }

    /// Keeps the first `count` of these boxes, which are those of a wide node.
    #[inline(always)]
    fn store<I: Simd>(&mut self, place: usize, boxes: [Extent<I>; 8], count: usize) {
        extent::store(boxes, count, &mut self.nodes.boxes[place]);
        self.nodes.stamps[place] = self.stamp;
        self.made += count as u64;
    }
}

/// Makes the boxes of one wide node. If it is merged, the wide nodes below are valid.
#[inline(always)]
fn refit_one<I: Simd, const N: usize, B: BoxSource>(
    i: I,
    job: &mut NodeRun<'_, N>,
    wide_node: WideNodeId,
    tree: &Tree,
    source: &B,
) {
    let place = wide_node.index() - job.nodes.first;
    let structure = tree.wide_node(wide_node);
    let first_node = structure.first_node as usize;
    let mut boxes: [Extent<I>; 8] = [extent::nothing(i); 8];
    if let Some(twelves) = tree.vertices.twelves::<N>(first_node) {
        for lane in 0..N {
            boxes[lane] = source.over(i, Over::Twelve(&twelves[lane]));
        }
        job.store(place, boxes, N);
        return;
    }
    let count = structure.len();
    for lane in 0..count {
        boxes[lane] = match structure.child(lane) {
            Child::Inner(below) if job.merges => {
                extent::of_box(i, &job.below[below.index() - job.first_below].union())
            }
            Child::Leaf(leaf) if !tree.leaves.have_blocks() => {
                let triangle = tree.leaves.first_triangle(leaf);
                let corners = source.shape().triangles[triangle.index()];
                source.over(i, Over::Triangle(corners))
            }
            _ => {
                let (run, border) = tree.vertices.run_and_border(first_node + lane);
                source.over(i, Over::Run([run.start, run.end], border))
            }
        };
    }
    job.store(place, boxes, count);
}
