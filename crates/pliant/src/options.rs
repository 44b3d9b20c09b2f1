//! Every choice a world offers, every default with its reason.

use std::num::{NonZeroU32, NonZeroUsize};

/// How a [`World`](crate::World) builds and updates its trees and finds bodies that may meet. No choice changes an answer.
///
/// ```
/// use pliant::{Degree, Options, World};
///
/// let mut options = Options::paper();
/// options.degree = Degree::Four;
/// let world = World::<f32>::with_options(options);
/// # assert_eq!(world.options().degree, Degree::Four);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Options {
    /// The most children of a node. Default: eight, as in the paper ("a slightly better choice").
    pub degree: Degree,
    /// How triangles are divided into a tree. Default: balanced, whose lanes are full.
    pub partition: Partition,
    /// The most triangles in a leaf. Default: 8, which are tested side by side; the paper has one.
    pub leaf_size: NonZeroU32,
    /// Which boxes are made when. Default: the paper's hybrid.
    pub update: Update,
    /// How pairs of bodies that may meet are found. Default: by the number of bodies.
    pub broad_phase: BroadPhase,
    /// How many threads share the work of a query, the calling one included: that of two bodies, or, where many meet and all pairs
    /// are asked for, the pairs of bodies. They are the world's own, or those of [a pool](crate::World::with_pool). Default: 1; more
    /// pay from about a millisecond of work on, and more than 256 are 256. For a fifth of a millisecond after a query threads of the
    /// world look for more to do before they sleep. Where the system gives none, the calling thread does it all.
    pub threads: NonZeroUsize,
    /// Whether the trees of bodies [mend themselves](crate::World::tree_quality): one that has decayed so far that a fresh one would have
    /// paid is built anew, a part of the work whenever the body has a new shape. Default: no. A tree that is being built takes memory beside
    /// the other, and most bodies stay near enough to the shape that they began with.
    pub mending: bool,
}

/// The most children a node has (paper, 3.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Degree {
    /// Binary trees.
    Two,
    /// 4-ary trees.
    Four,
    /// 8-ary trees.
    Eight,
}

impl Degree {
    /// 2, 4 or 8.
    pub fn get(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }
}

/// How the triangles of a body are divided into a tree when it is built (paper, 3.2): by the shape that the body has then, or
/// by its mesh alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Partition {
    /// The paper's preferred rule: a node's box is cut at its centre, along as many of its longest sides as the degree needs;
    /// a triangle goes where its midpoint lies.
    Centre,
    /// The same, cut at the mean of the midpoints.
    Mean,
    /// Every node is cut into parts of equal size, such that leaves and lanes are full. Not in the paper.
    Balanced,
    /// The paper's mesh connectivity tree: the triangles below a node are one connected piece of the mesh, neighbours sharing
    /// an edge, or components of it, each whole. Pieces are as equal as connectedness allows and have short borders. The shape
    /// that the body has when the tree is built does not matter.
    Connectivity,
}

/// Which boxes are made when (paper, 3.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Update {
    /// All boxes of a body that may meet another, from the leaves up.
    BottomUp,
    /// A box when it is reached, from the vertices below it.
    TopDown,
    /// The upper levels bottom-up, those below when they are reached.
    Hybrid {
        /// The level down to which boxes are made bottom-up, the root being level 0; levels that a tree does not have are
        /// its last. `None`: floor(n / 2), where n is the level of the deepest leaf, which the paper found "an efficient choice";
        /// but all levels in a body that meets itself, where every leaf meets at least itself, and after a query that looked at
        /// the triangles of many leaves (one in ten; never where leaves hold one).
        level: Option<u32>,
        /// How many levels are made at once, bottom-up, where a stale box is reached. The paper found one level,
        /// which is top-down, the fastest.
        levels_at_once: NonZeroU32,
    },
}

impl Update {
    /// The paper's hybrid: down to level n / 2 bottom-up, then a level at a time; with the two
    /// exceptions that stand at `level`.
    pub const HYBRID: Self = Self::Hybrid {
        level: None,
        levels_at_once: NonZeroU32::MIN,
    };

    /// How many levels are made where a stale box is reached.
    pub(crate) fn levels_at_once(self) -> u32 {
        match self {
            Self::Hybrid { levels_at_once, .. } => levels_at_once.get(),
            Self::BottomUp | Self::TopDown => 1,
        }
    }
}

/// How pairs of bodies whose boxes overlap are found (paper, 3.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BroadPhase {
    /// Brute force up to 100 bodies, as the paper found; above, a tree of bodies, for which the paper has sweep and prune.
    Auto,
    /// Every pair of boxes.
    BruteForce,
    /// The paper's: three sorted lists of box ends and one of overlapping pairs, kept from query to query. Where there are more than 16
    /// pairs a body, the tree finds them, and no list is kept.
    SweepAndPrune,
    /// A tree of the boxes of all bodies, refitted before every query that follows a movement. Not in the paper.
    Tree,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            degree: Degree::Eight,
            partition: Partition::Balanced,
            leaf_size: NonZeroU32::new(8).expect("8 is not 0"),
            update: Update::HYBRID,
            broad_phase: BroadPhase::Auto,
            threads: NonZeroUsize::MIN,
            mending: false,
        }
    }
}

impl Options {
    /// The configuration of the paper's experiments: 8-ary initial shape trees cut at the box centre, one triangle a leaf,
    /// hybrid update at level n / 2. The paper has no bodies that meet themselves; in those all levels are made ahead.
    pub fn paper() -> Self {
        Self {
            partition: Partition::Centre,
            leaf_size: NonZeroU32::MIN,
            ..Self::default()
        }
    }
}
