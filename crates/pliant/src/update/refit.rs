//! Refit of wide nodes, from the vertices or from the wide nodes below them, on several threads.
//!
//! Wide nodes are stored level by level in the order of their triangles. So an ascending list of
//! them is cut into runs, and each run owns one part of the array. No two jobs write one box.

use super::refitted::{Refit, Refitted};
use crate::ids::WideNodeId;
use crate::kernels::extent::{self, Extent};
use crate::kernels::{BoxLanes, Coordinate, Simd, dispatch};
use crate::threads::Grain;
use crate::tree::{
    BoxSource, Child, NodesMut, Over, Source, Tree, make_node_capsules, of_degree, of_source,
};

/// Jobs whose wide nodes are refitted between two checks for interruption.
const UNINTERRUPTED: usize = 64;

/// Maker of the boxes of wide nodes, with all that it reads and writes for a run of them.
pub(super) trait Below<const N: usize>: Sized + Send {
    /// A job of wide nodes.
    const GRAIN: Grain;

    /// Cuts it in two before a wide node.
    fn split_before(self, wide_node: WideNodeId, tree: &Tree) -> [Self; 2];

    /// Makes the boxes of one wide node. Returns how many they are.
    fn make<I: Simd, B: BoxSource>(
        &mut self,
        i: I,
        wide_node: WideNodeId,
        lanes: &mut BoxLanes<N>,
        tree: &Tree,
        source: &B,
    ) -> usize;

    /// Makes the capsules of triangles below a wide node, whose nodes have theirs.
    fn make_capsules<B: BoxSource>(&mut self, _: WideNodeId, _: &Tree, _: &B) {}
}

/// Job: a run of wide nodes, the part of a box set that holds their boxes, and a maker.
pub(super) struct NodeRun<'t, const N: usize, F> {
    pub(super) run: &'t [WideNodeId],
    pub(super) nodes: NodesMut<'t, N>,
    pub(super) from: F,
    pub(super) stamp: u64,
    pub(super) made: usize,
}

/// Maker that reads vertices, or merges the boxes of wide nodes below.
///
/// Boxes to merge are valid, and given from the wide node `first` on.
#[derive(Clone, Copy)]
struct Merged<'t, const N: usize> {
    merges: bool,
    first: usize,
    boxes: &'t [BoxLanes<N>],
}

/// Refits wide nodes from the vertices below them; `run` is ascending. Returns how many boxes it
/// made.
pub(super) fn refit_from_vertices<S: Coordinate>(
    refit: &Refit,
    one: &mut Refitted<S>,
    run: &[WideNodeId],
) -> u64 {
    let stamp = one.boxes.stamp();
    let (nodes, stamps, capsules) = one.boxes.nodes_mut();
    of_degree!(nodes, boxes => {
        let (nodes, boxes) = NodesMut::before(boxes, stamps, capsules, one.tree.wide_nodes.len());
        let from = Merged { merges: false, first: 0, boxes };
        let job = NodeRun { run, nodes, from, stamp, made: 0 };
        refit_all(refit, job, one.tree, one.source, |_| {})
    })
}

/// Refits wide nodes from the valid wide nodes below them, and leaves from their vertices.
///
/// `run` is ascending; it is refitted level by level, children before parents. Returns how many
/// boxes it made.
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
        let (nodes, stamps, capsules) = one.boxes.nodes_mut();
        let run = &rest[first..];
        made += of_degree!(nodes, boxes => {
            let (nodes, boxes) = NodesMut::before(boxes, stamps, capsules, level.end);
            let from = Merged { merges: true, first: level.end, boxes };
            let job = NodeRun { run, nodes, from, stamp, made: 0 };
            refit_all(refit, job, one.tree, one.source, |_| {})
        });
        rest = &rest[..first];
    }
    made
}

/// Refits a run of wide nodes, cut into jobs if there are threads for them.
///
/// Shows the maker of each job when it is done. Returns how many boxes were made.
pub(super) fn refit_all<const N: usize, S: Coordinate, F: Below<N>>(
    refit: &Refit,
    whole: NodeRun<'_, N, F>,
    tree: &Tree,
    source: &Source<S>,
    mut show: impl FnMut(&F),
) -> u64 {
    let executor = refit.executor;
    let nanoseconds = F::GRAIN.time(whole.run.len());
    let work = |job: &mut NodeRun<'_, N, F>| {
        for run in job.run.chunks(UNINTERRUPTED * F::GRAIN.items) {
            if executor.is_interrupted() {
                return;
            }
            of_source!(source, source => {
                dispatch!(refit.instructions, i => {
                    for &wide_node in run {
                        job.refit(i, wide_node, tree, source);
                    }
                });
                if !job.nodes.capsules.is_empty() {
                    for &wide_node in run {
                        if executor.is_interrupted() {
                            return;
                        }
                        job.make_capsules(wide_node, tree, source);
                    }
                }
            });
        }
    };
    let mut made = 0;
    executor.run_cut(
        whole,
        nanoseconds,
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
    /// Cuts the run into jobs of fewer wide nodes.
    fn cut(self, tree: &Tree) -> Vec<Self> {
        let (mut nodes, mut from) = (self.nodes, self.from);
        let mut jobs = Vec::with_capacity(self.run.len().div_ceil(F::GRAIN.items));
        for run in self.run.chunks(F::GRAIN.items).rev() {
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

    /// Makes the capsules beside the boxes.
    fn make_capsules<B: BoxSource>(&mut self, wide_node: WideNodeId, tree: &Tree, source: &B) {
        let place = wide_node.index() - self.nodes.first;
        make_node_capsules(&mut self.nodes.capsules[place], tree, wide_node, source);
        self.from.make_capsules(wide_node, tree, source);
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
    const GRAIN: Grain = Grain::WIDE_NODES;

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
