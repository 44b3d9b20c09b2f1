//! `Kind`, the trait of every kind of query, and the interface that the traversal calls.
//!
//! A kind says what it [`Needs`] of bodies, decides a [`Batch`] of pairs of leaves at a time, and
//! translates hits to the caller's numbers. The traversal knows no kind: it gets the `Needs` and,
//! for every task, a `dyn` [`LeafWork`]. So it is compiled once for `f32` and once for `f64`,
//! whatever kinds there are.

use super::labels::LabelPairs;
use super::near::{NearElements, Thicknesses, Which};
use crate::geometry::{Aabb, Points, Shape};
use crate::held::Held;
use crate::ids::{BodyId, TreeTriangle};
use crate::kernels::{Buffer, Coordinate, Instructions};
use crate::mesh::Order;
use crate::statistics::Statistics;
use crate::threads::Interrupt;

/// Candidate: two triangles whose boxes overlap, of the first body and of the second.
pub(crate) type Candidate = [TreeTriangle; 2];

/// Number of a set of a tree's boxes. Kinds whose boxes have the same source share a set.
pub(crate) type BoxSetNumber = usize;

/// Set of the boxes of the present shape: for intersections, contacts and distances.
pub(crate) const OF_SHAPES: BoxSetNumber = 0;
/// Set of the boxes of the shape and the end of a motion, grown: for candidates, close pairs and
/// impacts.
pub(crate) const OF_MOTIONS: BoxSetNumber = 1;
/// Set of the boxes of the present shape, grown: for close triangles.
pub(crate) const OF_GROWN_SHAPES: BoxSetNumber = 2;

/// Requirements of a kind: all that is known of a query until leaves are tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Needs {
    pub(crate) box_set: BoxSetNumber,
    /// Input of the test of leaves.
    pub(crate) leaves: Shown,
    /// Distance by which boxes are grown on every side. None if boxes are not grown.
    pub(crate) grows_by: Option<f32>,
    /// By how much of a body's thickness boxes are grown besides; 0 for kinds that do not look at
    /// it.
    pub(crate) counts_thickness: f64,
    /// How far the query looks along motions. None if it does not.
    pub(crate) reach: Option<Reach>,
    /// Whether things are no hits that are further apart than twice `grows_by`, even where their
    /// boxes overlap.
    pub(crate) culls_by_capsules: bool,
    /// Whether pairs are no hits that their one body leaves out: by its labels, or because they are
    /// as close in its rest shape.
    pub(crate) leaves_out: bool,
}

impl Needs {
    /// Needs of a query on the present shape that tests triangles whose boxes overlap.
    pub(crate) const TRIANGLES: Self = Self {
        box_set: OF_SHAPES,
        leaves: Shown::Triangles,
        grows_by: None,
        counts_thickness: 0.0,
        reach: None,
        culls_by_capsules: true,
        leaves_out: true,
    };

    /// Whether the test gets triangles, not runs of them.
    pub(crate) fn triangles(&self) -> bool {
        self.leaves == Shown::Triangles
    }

    /// Distance by which boxes of a body are grown, whose largest thickness is this.
    pub(crate) fn grows(&self, thickness: f64) -> Option<f32> {
        let by = self.counts_thickness * thickness;
        self.grows_by.map(|distance| grown(distance, by))
    }

    /// How boxes of bodies are made for this query.
    pub(crate) fn body_boxes(&self) -> BodyBoxes {
        BodyBoxes {
            grow_by: self.grows_by,
            counts_thickness: self.counts_thickness,
            hold_motions: self.reach.is_some(),
        }
    }
}

/// Kind of query: what it needs of bodies, how it decides leaves, and what it finds.
pub(crate) trait Kind: Sync {
    type Scalar: Coordinate;
    /// Hit with the caller's numbers.
    type Hit: Copy + std::fmt::Debug + Send + Sync;
    /// Hit as a visitor is shown it: as it is, or with measurements made on the way.
    type Shown: Copy + std::fmt::Debug + Send + Sync;
    /// Hit in tree order.
    type TreeHit: Copy + Default + std::fmt::Debug + Send + Sync;
    /// Scratch memory of one task for tests of leaves, kept from query to query.
    type Buffers: Default + std::fmt::Debug + Held + Send;

    fn needs(&self) -> Needs;

    /// Decides a batch of leaves, and appends hits in an order that depends on the batch alone.
    ///
    /// It counts candidates, exact decisions and hits.
    fn test(&self, leaves: &LeafTest<Self::Scalar>, batch: Batch, found: &mut FoundBy<Self>);

    /// Translates a hit to the caller's numbers.
    fn to_caller(&self, ids: &CallerIds, hit: Self::TreeHit) -> Self::Hit;

    /// Appends hits as visitors are shown them to `shown`.
    fn show(
        &self,
        leaves: &LeafTest<Self::Scalar>,
        hits: &[Self::TreeHit],
        shown: &mut Vec<Self::Shown>,
    );
}

/// Hits of one task's tests, counters of the work, and scratch memory.
#[derive(Debug, Default)]
pub(crate) struct Found<T, B> {
    /// Hits in tree order.
    pub(crate) hits: Buffer<T>,
    pub(crate) statistics: Statistics,
    pub(crate) buffers: B,
}

/// Hits, counters and scratch memory of a kind.
pub(crate) type FoundBy<K> = Found<<K as Kind>::TreeHit, <K as Kind>::Buffers>;

impl<T, B: Held> Held for Found<T, B> {
    fn held(&self) -> usize {
        self.hits.held() + self.buffers.held()
    }
}

/// Implements `Kind::show` for a kind whose visitors are shown the hits themselves.
macro_rules! shows_hits {
    () => {
        type Shown = Self::Hit;

        fn show(
            &self,
            leaves: &LeafTest<Self::Scalar>,
            hits: &[Self::TreeHit],
            shown: &mut Vec<Self::Hit>,
        ) {
            shown.extend(hits.iter().map(|&hit| self.to_caller(&leaves.ids, hit)));
        }
    };
}
pub(crate) use shows_hits;

/// Batch of leaves that overlap, in the form that [`Needs::leaves`] asks for.
pub(crate) enum Batch<'b> {
    /// Pairs of triangles whose boxes overlap. Within one body, pairs that share a vertex of the
    /// mesh are left out. The list may be changed.
    Triangles(&'b mut Buffer<Candidate>),
    /// Pairs of runs of up to eight triangles, of the first body and of the second, by number.
    ///
    /// Runs are numbered as blocks, or as triangles where every leaf is one triangle. Within one
    /// body a run may be paired with itself.
    Runs(&'b [[u32; 2]]),
}

impl<'b> Batch<'b> {
    /// The batch of a kind that needs triangles.
    #[inline]
    pub(crate) fn triangles(self) -> &'b mut Buffer<Candidate> {
        match self {
            Self::Triangles(candidates) => candidates,
            Self::Runs(_) => unreachable!("a kind is shown what it needs"),
        }
    }

    /// The batch of a kind that needs runs.
    #[inline]
    pub(crate) fn runs(self) -> &'b [[u32; 2]] {
        match self {
            Self::Runs(pairs) => pairs,
            Self::Triangles(_) => unreachable!("a kind is shown what it needs"),
        }
    }
}

/// Tests of leaves by one task: the door between the traversal and the kinds. Hits stay inside.
pub(crate) trait LeafWork<S> {
    /// Clears the hits, which have been handed over.
    fn clear(&mut self);
    /// Decides some leaves, whose boxes are valid.
    fn test(&mut self, leaves: &LeafTest<S>, batch: Batch);
    /// Whether more leaves may be tested before hits are handed over.
    fn has_room(&self) -> bool;
    /// Hands the hits to a collector, if there is one.
    fn hand_over(&mut self);
    /// Candidates that were decided since it was cleared.
    fn candidates(&self) -> u64;
}

/// Rule for boxes of bodies: by how much they are grown, and whether they hold the ends of motions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BodyBoxes {
    grow_by: Option<f32>,
    counts_thickness: f64,
    pub(crate) hold_motions: bool,
}

impl BodyBoxes {
    /// Box of a body, from the box of its shape, or of both ends of its motion, and its largest
    /// thickness.
    pub(crate) fn of(self, shape: Aabb, thickness: f64) -> Aabb {
        let by = self.counts_thickness * thickness;
        self.grow_by
            .map_or(shape, |distance| shape.grown(grown(distance, by)))
    }
}

/// Sum of two distances, rounded up; at most the largest number.
fn grown(distance: f32, by: f64) -> f32 {
    if by == 0.0 {
        return distance;
    }
    let nearest = ((f64::from(distance) + by) as f32).min(f32::MAX);
    nearest.next_up().min(f32::MAX)
}

/// Distance in time to which a kind with motions looks along them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach {
    /// Looks to the end of the motion.
    End,
    /// Looks to this time: boxes hold the way up to it, and a little more. Moving bodies go on to
    /// the end.
    Until(f64),
    /// Looks to the shape at this time, rounded, as if the motion ended there.
    To(f64),
}

/// Form of the leaves that a kind tests: see [`Batch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// Triangles whose boxes overlap.
    Triangles,
    /// Runs of up to eight triangles, compared by the boxes of the elements that belong to them.
    Runs(Which),
}

/// Input of a test of leaves besides the batch.
pub(crate) struct LeafTest<'q, S> {
    pub(crate) instructions: Instructions,
    pub(crate) interrupt: &'q Interrupt<'q>,
    /// Shapes of both bodies, or of the one body twice.
    pub(crate) shapes: [&'q Shape<'q, S>; 2],
    /// Positions at the end of what boxes hold, for kinds that hold motions.
    pub(crate) ends: [Option<&'q Points<S>>; 2],
    /// Positions at the end of the motion.
    pub(crate) motions: [Option<&'q Points<S>>; 2],
    pub(crate) ids: CallerIds<'q>,
    /// Elements and their boxes, for kinds that test runs.
    pub(crate) elements: [Option<NearElements<'q>>; 2],
    pub(crate) thickness: Thicknesses<'q>,
    /// Positions in the rest shape, if both bodies are one that has it, and the kind leaves pairs
    /// out.
    pub(crate) rest: Option<&'q Points<S>>,
    /// Pairs that labels leave out, likewise. Kinds that test triangles are shown none of them.
    pub(crate) labels: Option<&'q LabelPairs>,
    /// Whether both bodies are one.
    pub(crate) is_one_body: bool,
    /// Whether both trees are one, so that equal numbers of runs are the same run.
    pub(crate) is_one_tree: bool,
}

/// A mesh, as kinds see the edges of its triangles.
pub(crate) trait OwnEdges: Sync {
    /// The edge from a corner of a triangle to the next, by the caller's number.
    ///
    /// Of the triangles at an edge one has it as its own; for the others it is none. Edges are
    /// numbered the first time, unless `stop` interrupts that.
    fn own_edge(
        &self,
        triangle: TreeTriangle,
        corner: usize,
        stop: &dyn Fn() -> bool,
    ) -> Option<u32>;
}

/// Translation of tree order to the caller's numbers.
pub(crate) struct CallerIds<'q> {
    pub(crate) bodies: [BodyId; 2],
    pub(crate) orders: [&'q Order; 2],
    pub(crate) meshes: [&'q dyn OwnEdges; 2],
    /// The caller's numbers of edges, for kinds that look at edges; else empty.
    pub(crate) edges: [&'q [u32]; 2],
}
