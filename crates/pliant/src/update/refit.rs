//! Boxes of wide nodes, from the vertices or from the wide nodes below them, as many at once as there are threads.
//!
//! Wide nodes are stored level by level in the order of their triangles. So a list of them in ascending order is cut into runs, and
//! each run owns one part of the array: no two jobs write one box.

use super::refitted::{Refit, Refitted};
use crate::ids::WideNodeId;
use crate::kernels::extent::{self, Extent};
use crate::kernels::{BoxLanes, Coordinate, Simd, dispatch};
use crate::tree::{BoxSource, Child, NodesMut, Over, Source, Tree, of_degree, of_source};

/// So many wide nodes, or fewer, are not worth waking a thread.
const SHARED: usize = 32;
/// The wide nodes of so many jobs are refitted before it is asked whether the query was
/// interrupted.
const UNINTERRUPTED: usize = 64;

/// A maker of the boxes of wide nodes, with all that it reads and writes for a run of them.
pub(super) trait Below<const N: usize>: Sized + Send {
    /// Wide nodes in a job: some microseconds of work.
    const JOB: usize;

    /// Cuts it in two before a wide node.
    fn split_before(self, wide_node: WideNodeId, tree: &Tree) -> [Self; 2];

    /// Makes the boxes of one wide node, and says how many they are.
    fn make<I: Simd, B: BoxSource>(
        &mut self,
        i: I,
        wide_node: WideNodeId,
        lanes: &mut BoxLanes<N>,
        tree: &Tree,
        source: &B,
    ) -> usize;
}

/// A run of wide nodes, and the part of a set of boxes that holds theirs.
pub(super) struct NodeRun<'t, const N: usize, F> {
    pub(super) run: &'t [WideNodeId],
    pub(super) nodes: NodesMut<'t, N>,
    pub(super) from: F,
    pub(super) stamp: u64,
    pub(super) made: usize,
}

/// Vertices, or, where boxes are merged, the boxes of wide nodes below, which are valid: from the
/// first of them on.
#[derive(Clone, Copy)]
struct Merged<'t, const N: usize> {
    merges: bool,
    first: usize,
    boxes: &'t [BoxLanes<N>],
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
        let (nodes, boxes) = NodesMut::before(boxes, stamps, one.tree.wide_nodes.len());
        let from = Merged { merges: false, first: 0, boxes };
        let job = NodeRun { run, nodes, from, stamp, made: 0 };
        refit_all(refit, job, one.tree, one.source, |_| {})
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
            let (nodes, boxes) = NodesMut::before(boxes, stamps, level.end);
            let from = Merged { merges: true, first: level.end, boxes };
            let job = NodeRun { run, nodes, from, stamp, made: 0 };
            refit_all(refit, job, one.tree, one.source, |_| {})
        });
        rest = &rest[..first];
    }
    made
}

/// Makes the boxes of a run, cut into shorter ones if there are threads for them, and shows what
/// each was made from. Returns how many boxes it made.
pub(super) fn refit_all<const N: usize, S: Coordinate, F: Below<N>>(
    refit: &Refit,
    whole: NodeRun<'_, N, F>,
    tree: &Tree,
    source: &Source<S>,
    mut show: impl FnMut(&F),
) -> u64 {
    let executor = refit.executor;
    let is_worth_it = whole.run.len() > SHARED && executor.are_many();
    let work = |job: &mut NodeRun<'_, N, F>| {
        for run in job.run.chunks(UNINTERRUPTED * F::JOB) {
            if executor.is_interrupted() {
                return;
            }
            of_source!(source, source => dispatch!(refit.instructions, i => {
                for &wide_node in run {
                    job.refit(i, wide_node, tree, source);
                }
            }));
        }
    };
    let mut made = 0;
    executor.run_cut(
        whole,
        is_worth_it,
        |whole| whole.cut(tree),
        work,
        |job| {
            made += job.made as u64;
            show(&job.from);
        },
    );
    made
}

impl<const N: usize, F: Below<N>> NodeRun<'_, N, F> {
    /// Jobs of fewer wide nodes.
    fn cut(self, tree: &Tree) -> Vec<Self> {
        let (mut nodes, mut from) = (self.nodes, self.from);
        let mut jobs = Vec::with_capacity(self.run.len().div_ceil(F::JOB));
        for run in self.run.chunks(F::JOB).rev() {
            let [earlier_nodes, nodes_here] = nodes.split_before(run[0]);
            let [earlier, from_here] = from.split_before(run[0], tree);
            jobs.push(Self {
                run,
                nodes: nodes_here,
                from: from_here,
                ..self
            });
            (nodes, from) = (earlier_nodes, earlier);
        }
        jobs.reverse();
        jobs
    }

    #[inline(always)]
    fn refit<I: Simd, B: BoxSource>(
        &mut self,
        i: I,
        wide_node: WideNodeId,
        tree: &Tree,
        source: &B,
    ) {
        let place = wide_node.index() - self.nodes.first;
        let lanes = &mut self.nodes.boxes[place];
        self.made += self.from.make(i, wide_node, lanes, tree, source);
        self.nodes.stamps[place] = self.stamp;
    }
}

impl<const N: usize> Below<N> for Merged<'_, N> {
    const JOB: usize = 16;

    fn split_before(self, _: WideNodeId, _: &Tree) -> [Self; 2] {
        [self; 2]
    }

    #[inline(always)]
    fn make<I: Simd, B: BoxSource>(
        &mut self,
        i: I,
        wide_node: WideNodeId,
        lanes: &mut BoxLanes<N>,
        tree: &Tree,
        source: &B,
    ) -> usize {
        let structure = tree.wide_node(wide_node);
        let first_node = structure.first_node as usize;
        let mut boxes: [Extent<I>; 8] = [extent::nothing(i); 8];
        if let Some(twelves) = tree.vertices.twelves::<N>(first_node) {
            for lane in 0..N {
                boxes[lane] = source.over(i, Over::Twelve(&twelves[lane]));
            }
            extent::store(boxes, N, lanes);
            return N;
        }
        let count = structure.len();
        for lane in 0..count {
            boxes[lane] = match structure.child(lane) {
                Child::Inner(below) if self.merges => {
                    extent::of_box(i, &self.boxes[below.index() - self.first].union())
                }
                Child::Leaf(leaf) if !tree.leaves.have_blocks() => {
                    let triangle = tree.leaves.first_triangle(leaf);
                    let corners = &source.shape().triangles[triangle.index()];
                    source.over(i, Over::Triangle(corners))
                }
                _ => {
                    let (run, border) = tree.vertices.run_and_border(first_node + lane);
                    source.over(i, Over::Run([run.start, run.end], border))
                }
            };
        }
        extent::store(boxes, count, lanes);
        count
    }
}
