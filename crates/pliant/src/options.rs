//! Options of a world: every choice, and the reason for its default.

use std::num::{NonZeroU32, NonZeroUsize};

/// Options of a [`World`](crate::World): how it builds and updates trees and finds bodies that may
/// meet.
///
/// No choice changes an answer.
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
    /// Most children of a node. Default: eight, as in the paper ("a slightly better choice").
    pub degree: Degree,
    /// Division of triangles into a tree. Default: balanced, whose lanes are full.
    pub partition: Partition,
    /// Most triangles in a leaf. Default: 8, which are tested side by side; the paper has one.
    pub leaf_size: NonZeroU32,
    /// Order in which boxes are made. Default: the paper's hybrid.
    pub update: Update,
    /// Broad phase: how pairs of bodies that may meet are found. Default: by the number of bodies.
    pub broad_phase: BroadPhase,
    /// Threads that share the work of a query, the calling one included. Default: 1.
    ///
    /// A query wakes as many as its work pays for. Where all hits are asked for, they share the
    /// work of all pairs of bodies; else that of two bodies.
    ///
    /// They belong to the world, or to [a pool](crate::World::with_pool) that it was lent. Where
    /// the system gives none, the calling thread does it all.
    ///
    /// More threads than the work pays for sleep. Where other programs use the cores, fewer may be
    /// quicker: `pliant bench cores` measures your machine. More than 256 are taken as 256. For a
    /// fifth of a millisecond after a query, threads of the world look for more work before they
    /// sleep.
    pub threads: NonZeroUsize,
    /// Whether trees of bodies [mend themselves](crate::World::tree_quality). Default: no.
    ///
    /// A tree that has decayed so far that a fresh one would have paid is built anew. A part of
    /// that work is done whenever the body gets a new shape. The new tree takes memory beside the
    /// old one until it is ready. Most bodies stay near enough to the shape that they began with.
    pub mending: bool,
}

/// Degree of a tree: the most children that a node has (paper, 3.2).
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
    /// The degree as a number: 2, 4 or 8.
    pub fn get(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Four => 4,
            Self::Eight => 8,
        }
    }
}

/// Division of a body's triangles into a tree, by its shape or by its mesh alone (paper, 3.2).
///
/// The shape is the one that the body has when the tree is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Partition {
    /// Cut at the centre of a node's box: the paper's preferred rule.
    ///
    /// The box is cut along as many of its longest sides as the degree needs. A triangle goes where
    /// its midpoint lies.
    Centre,
    /// Cut at the mean of the midpoints, and otherwise as [`Centre`](Self::Centre).
    Mean,
    /// Cut into parts of equal size, such that leaves and lanes are full. Not in the paper.
    Balanced,
    /// The paper's mesh connectivity tree: the triangles below a node are one connected piece.
    ///
    /// Neighbours share an edge. Where a mesh has several components, a node may hold some of them,
    /// each whole. Pieces are as equal as connectedness allows and have short borders. The shape of
    /// the body does not matter.
    Connectivity,
}

/// Update strategy: which boxes are made when (paper, 3.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Update {
    /// All boxes of a body that may meet another, refitted from the leaves up.
    BottomUp,
    /// A box when a query reaches it, from the vertices below it.
    TopDown,
    /// Upper levels bottom-up, lower ones when a query reaches them.
    Hybrid {
        /// Level down to which boxes are made bottom-up. The root is level 0; a level that a tree
        /// does not have is its last.
        ///
        /// `None`: floor(n / 2), where n is the level of the deepest leaf, which the paper found
        /// "an efficient choice". There are two exceptions, in which all levels are made:
        ///
        /// - in a body that meets itself, where every leaf meets at least itself;
        /// - after a query that looked at the triangles of one leaf in ten or more; never where
        ///   leaves hold one triangle.
        level: Option<u32>,
        /// Levels that are made at once, bottom-up, where a stale box is reached. The paper found
        /// one level, which is top-down, the fastest.
        levels_at_once: NonZeroU32,
    },
}

impl Update {
    /// The paper's hybrid: down to level n / 2 bottom-up, then a level at a time.
    ///
    /// Its two exceptions are said at `level`.
    pub const HYBRID: Self = Self::Hybrid {
        level: None,
        levels_at_once: NonZeroU32::MIN,
    };

    /// Levels that are made where a stale box is reached.
    pub(crate) fn levels_at_once(self) -> u32 {
        match self {
            Self::Hybrid { levels_at_once, .. } => levels_at_once.get(),
            Self::BottomUp | Self::TopDown => 1,
        }
    }
}

/// Broad phase: how pairs of bodies whose boxes overlap are found (paper, 3.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BroadPhase {
    /// Brute force up to 100 bodies, as the paper found; above, a tree of bodies.
    ///
    /// Above 100 bodies the paper has sweep and prune.
    Auto,
    /// Brute force: every pair of boxes, O(b^2) for b bodies.
    BruteForce,
    /// The paper's sweep and prune: three sorted lists of box ends and one of overlapping pairs.
    ///
    /// The lists are kept from query to query. Where there are more than 16 pairs a body, the tree
    /// finds them and no list is kept.
    SweepAndPrune,
    /// Tree over the boxes of all bodies, refitted before every query that follows a movement. Not
    /// in the paper.
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
    /// The defaults, with a thread for each processor that this process may use, as the system
    /// counts them. If it does not say how many, it is one.
    ///
    /// No number of threads changes an answer. One thread, the default, is best where a simulator
    /// uses the other cores itself.
    pub fn all_threads() -> Self {
        let threads = std::thread::available_parallelism();
        Self {
            threads: threads.unwrap_or(NonZeroUsize::MIN),
            ..Self::default()
        }
    }

    /// The configuration of the paper's experiments.
    ///
    /// 8-ary initial shape trees are cut at the box centre, with one triangle a leaf, and updated
    /// by the hybrid at level n / 2. The paper has no bodies that meet themselves; in those all
    /// levels are made ahead.
    pub fn paper() -> Self {
        Self {
            partition: Partition::Centre,
            leaf_size: NonZeroU32::MIN,
            ..Self::default()
        }
    }
}
