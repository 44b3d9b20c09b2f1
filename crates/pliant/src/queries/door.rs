//! What a kind of query is, and the door through which the traversal sees it.
//!
//! A kind says what it [`Needs`] of bodies, decides what it is shown of leaves, a [`Batch`] at a time, and numbers hits as the caller
//! does. The traversal knows no kind: it has [`Needs`], and for every task a [`LeafWork`].

use super::near::{NearElements, Which};
use crate::geometry::{Aabb, Points, Shape};
use crate::held::Held;
use crate::ids::{BodyId, TreeTriangle};
use crate::kernels::{Buffer, Coordinate, Instructions};
use crate::mesh::Order;
use crate::statistics::Statistics;
use crate::threads::Interrupt;

/// Two triangles whose boxes overlap, of the first body and of the second.
pub(crate) type Candidate = [TreeTriangle; 2];

/// Which set of a tree's boxes a kind uses: kinds whose boxes have the same source share one.
pub(crate) type BoxSetNumber = usize;

/// The boxes of the shape of now: of intersections, contacts and distances.
pub(crate) const OF_SHAPES: BoxSetNumber = 0;
/// Boxes that hold the shape and the end of a motion, and are grown: of candidates, close pairs and impacts.
pub(crate) const OF_MOTIONS: BoxSetNumber = 1;
/// Boxes of the shape of now, grown: of close triangles.
pub(crate) const OF_GROWN_SHAPES: BoxSetNumber = 2;

/// What a query reads of bodies: all that is to be known of it until leaves are tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Needs {
    pub(crate) box_set: BoxSetNumber,
    /// What it is shown of leaves.
    pub(crate) leaves: Shown,
    /// By how much boxes are larger than those of the shape, on every side; none if they are those of the shape.
    pub(crate) grows_by: Option<f32>,
    /// How far it looks along motions; none if it does not.
    pub(crate) reach: Option<Reach>,
}

impl Needs {
    /// The shape of now, and triangles whose boxes overlap.
    pub(crate) const TRIANGLES: Self = Self {
        box_set: OF_SHAPES,
        leaves: Shown::Triangles,
        grows_by: None,
        reach: None,
    };

    /// Whether it is shown triangles, not runs of them.
    pub(crate) fn triangles(&self) -> bool {
        self.leaves == Shown::Triangles
    }

    /// What boxes of bodies are for it.
    pub(crate) fn body_boxes(&self) -> BodyBoxes {
        BodyBoxes {
            grow_by: self.grows_by,
            hold_motions: self.reach.is_some(),
        }
    }
}

/// A kind of query.
pub(crate) trait Kind: Sync {
    type Scalar: Coordinate;
    /// What it finds, as the caller numbers things.
    type Hit: Copy + std::fmt::Debug + Send + Sync;
    /// A hit as a visitor is shown it: itself, or with what is measured on the way.
    type Shown: Copy + std::fmt::Debug + Send + Sync;
    /// What it finds, in tree order.
    type TreeHit: Copy + Default + std::fmt::Debug + Send + Sync;
    /// What a task keeps for the tests of leaves, from query to query.
    type Buffers: Default + std::fmt::Debug + Held + Send;

    fn needs(&self) -> Needs;

    /// Decides what it is shown, and appends what it finds, in an order that depends on nothing but
    /// that. It counts candidates, exact decisions and hits.
    fn test(&self, leaves: &LeafTest<Self::Scalar>, batch: Batch, found: &mut FoundBy<Self>);

    /// A hit as the caller numbers things.
    fn to_caller(&self, ids: &CallerIds, hit: Self::TreeHit) -> Self::Hit;

    /// Appends what visitors are shown of hits to a list.
    fn show(
        &self,
        leaves: &LeafTest<Self::Scalar>,
        hits: &[Self::TreeHit],
        shown: &mut Vec<Self::Shown>,
    );
}

/// Hits of tests of leaves, counters of the work, and the buffers of the tests.
#[derive(Debug, Default)]
pub(crate) struct Found<T, B> {
    /// In tree order.
    pub(crate) hits: Buffer<T>,
    pub(crate) statistics: Statistics,
    pub(crate) buffers: B,
}

/// Finds of one kind.
pub(crate) type FoundBy<K> = Found<<K as Kind>::TreeHit, <K as Kind>::Buffers>;

impl<T, B: Held> Held for Found<T, B> {
    fn held(&self) -> usize {
        self.hits.held() + self.buffers.held()
    }
}

/// In an implementation of `Kind`: visitors are shown hits themselves.
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

/// Leaves that overlap, some at a time, as a kind is shown them: what its [`Needs::leaves`] say.
pub(crate) enum Batch<'b> {
    /// Two triangles whose boxes overlap; of one body those that share no vertex of the mesh. The list may be changed.
    Triangles(&'b mut Buffer<Candidate>),
    /// Two runs of up to eight triangles, of the first body and of the second, by their numbers: those of blocks, or of triangles where
    /// every leaf is one; in one body a run perhaps with itself.
    Runs(&'b [[u32; 2]]),
}

impl<'b> Batch<'b> {
    /// For a kind that needs triangles.
    #[inline]
    pub(crate) fn triangles(self) -> &'b mut Buffer<Candidate> {
        match self {
            Self::Triangles(candidates) => candidates,
            Self::Runs(_) => unreachable!("a kind is shown what it needs"),
        }
    }

    /// For a kind that needs runs.
    #[inline]
    pub(crate) fn runs(self) -> &'b [[u32; 2]] {
        match self {
            Self::Runs(pairs) => pairs,
            Self::Triangles(_) => unreachable!("a kind is shown what it needs"),
        }
    }
}

/// What one task does with leaves that overlap: the door between the traversal and the kinds. What it finds stays inside.
pub(crate) trait LeafWork<S> {
    /// Forgets what was found and has been handed over.
    fn clear(&mut self);
    /// Decides some leaves, whose boxes are valid.
    fn test(&mut self, leaves: &LeafTest<S>, batch: Batch);
    /// Whether to go on before what was found is handed over.
    fn has_room(&self) -> bool;
    /// Hands what was found to a collector, if there is one.
    fn hand_over(&mut self);
}

/// What boxes of bodies are for a kind: by how much they are grown, and whether they hold the ends of motions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BodyBoxes {
    grow_by: Option<f32>,
    pub(crate) hold_motions: bool,
}

impl BodyBoxes {
    /// The box of a body, from that of its shape, or of both ends of its motion.
    pub(crate) fn of(self, shape: Aabb) -> Aabb {
        self.grow_by.map_or(shape, |distance| shape.grown(distance))
    }
}

/// How far a kind that holds motions looks along them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reach {
    /// To the end.
    End,
    /// Boxes hold the way up to this time, and a little more. What moves goes on to the end.
    Until(f64),
    /// To the shape at this time, rounded, as if the motion ended there.
    To(f64),
}

/// What a kind is shown of leaves that overlap: see [`Batch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shown {
    /// Triangles whose boxes overlap.
    Triangles,
    /// The triangles of either leaf, up to eight at a time: not their boxes, but those of elements that belong to them.
    Runs(Which),
}

/// What a test of leaves works with.
pub(crate) struct LeafTest<'q, S> {
    pub(crate) instructions: Instructions,
    pub(crate) interrupt: &'q Interrupt<'q>,
    /// Of both bodies, or of the one twice.
    pub(crate) shapes: [&'q Shape<'q, S>; 2],
    /// Where vertices are at the end of a motion, for kinds that hold motions.
    pub(crate) ends: [Option<&'q Points<S>>; 2],
    /// Where vertices are going.
    pub(crate) motions: [Option<&'q Points<S>>; 2],
    pub(crate) ids: CallerIds<'q>,
    /// For kinds that are shown runs.
    pub(crate) elements: [Option<NearElements<'q>>; 2],
    /// Whether it is one body with itself,
    pub(crate) is_one_body: bool,
    /// and in one tree, so that two runs of one number are one.
    pub(crate) is_one_tree: bool,
}

/// How the caller numbers things.
pub(crate) struct CallerIds<'q> {
    pub(crate) bodies: [BodyId; 2],
    pub(crate) orders: [&'q Order; 2],
    /// Of edges, for kinds that look at them; else none.
    pub(crate) edges: [&'q [u32]; 2],
}
