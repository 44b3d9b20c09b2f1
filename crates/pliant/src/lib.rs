#![doc = include_str!("../README.md")]
//!
//! # What an answer means
//!
//! - **Two triangles intersect** as closed sets: touching in one point counts, and so does coplanar
//!   overlap. A degenerate triangle is the segment or point that it is.
//! - **Decisions are exact** for all coordinates that are accepted. Scale, order, tree, update and
//!   processor change nothing.
//! - **Within a body**, pairs of triangles that share a vertex of the mesh are left out. Vertices
//!   with different numbers are different, wherever they are: the library welds nothing unasked.
//! - **Surfaces, not volumes**: a body wholly inside another meets no triangle of it. Whether it is
//!   inside is asked by [`World::contained`].
//! - **All hits** are one set, sorted. **The first hit** is some member of it. Whether there is one
//!   never depends on options or history; which one it is may.
//! - **An answer is an error** if a body is not there, the caller interrupts the query, or a list
//!   would be longer than allowed.
//! - **Coordinates** that are not finite or above `f32::MAX` in magnitude are refused
//!   ([`ErrorKind::BadPosition`]). A thread that flushes subnormal numbers refuses tiny ones, too
//!   ([`ErrorKind::NeedsSubnormals`]).
//!
//! `docs/RELIABILITY.md` in the repository has the one list of limits ("Where it ends").
//!
//! # Never stale
//!
//! [`World::set_positions`] takes over a shape in one checked pass, or refuses it, naming body and
//! vertex, and keeps the last good one. Every query then refits just the boxes that it reads: there
//! is no refit to call and none to forget. Replaying the same motion on one thread allocates
//! nothing.
//!
#![doc = include_str!("../pictures/tree.svg")]
//!
//! # Candidates, close pairs, impacts
//!
//! Solvers ask about *elements*: a vertex and a triangle, or two edges. Three kinds of questions
//! differ in how near these must be.
//!
//! - **Candidates**: their boxes are within a margin of each other, now or anywhere on the way to
//!   the end of a motion.
//! - **Close pairs**: they are at most a distance apart in the present shape, decided exactly. Each
//!   comes with its closest points.
//! - **Impacts**: they meet on the way to the end of a motion, decided exactly. Each comes with an
//!   interval that holds the time of first contact.
//!
#![doc = include_str!("../pictures/margins.svg")]
//!
//! # Map
//!
//! - **First loop, step by step, and what to do with hits**: [`guide`].
//! - **Bodies**: [`World::add`], [`remove`](World::remove), [`bodies`](World::bodies), [`BodyId`].
//! - **Moving them**: [`World::set_positions`], [`write_positions`](World::write_positions).
//! - **Triangles that intersect**: [`World::intersections`], [`Pair`]. How they do:
//!   [`contacts`](World::contacts), [`ContactKind`].
//! - **Whom to ask about**: [`Selection`], which is the whole world, each body with itself too, two
//!   bodies, or one with itself.
//! - **How much to ask for**: [`Query::all`], [`first`](Query::first), [`visit`](Query::visit),
//!   [`visit_some`](Query::visit_some). Limits: [`at_most`](Query::at_most),
//!   [`interrupt_if`](Query::interrupt_if), [`World::interruptible`].
//! - **Candidates**: [`World::vertex_triangle_candidates`],
//!   [`edge_edge_candidates`](World::edge_edge_candidates), [`VertexTriangle`], [`EdgeEdge`],
//!   [`World::edges`].
//! - **Close pairs**: [`World::close_vertex_triangle_pairs`],
//!   [`close_edge_edge_pairs`](World::close_edge_edge_pairs),
//!   [`close_triangle_pairs`](World::close_triangle_pairs).
//! - **Distances**: [`World::distance`], [`nearest_body`](World::nearest_body),
//!   [`clearance`](World::clearance).
//! - **Inside**: [`World::points_inside`], [`inside`](World::inside), [`Located`], [`InsideRule`].
//!   What has an inside: [`watertight`](World::watertight), [`Watertight`]. Bodies in bodies:
//!   [`contained`](World::contained). How deep: [`depth`](World::depth), [`Depth`].
//! - **Closest points**: [`World::closest_points`],
//!   [`signed_closest_points`](World::signed_closest_points), [`ClosestPoint`].
//! - **Motions**: [`World::set_motion`], [`finish_motion`](World::finish_motion),
//!   [`advance_motion`](World::advance_motion).
//! - **Impacts**: [`World::vertex_triangle_impacts`],
//!   [`edge_edge_impacts`](World::edge_edge_impacts), [`first_impact`](World::first_impact). For
//!   single pairs: [`vertex_triangle_impacts`], [`edge_edge_impacts`].
//! - **Single pairs, without a world**: besides these, [`vertex_triangle_distances`],
//!   [`edge_edge_distances`], [`PairDistance`], [`triangle_contacts`].
//! - **How far all may go**: [`World::free_step`],
//!   [`collision_free_step`](World::collision_free_step).
//! - **Meshes that change**: [`World::edit`], [`Edit`], [`apply`](World::apply), [`Edited`],
//!   [`set_mesh`](World::set_mesh). Pieces: [`components`](World::components),
//!   [`split`](World::split), [`fuse`](World::fuse), [`weld`](World::weld).
//! - **Where pairs meet**: [`Segments`], [`Curves`], [`Curve::enclosed_areas`], [`Feature`].
//! - **What is new since the last step**: [`Changes`], [`Changed`]; a hit's two things: [`Listed`].
//! - **Trees that no longer fit the shape**: [`World::rebuild`],
//!   [`tree_quality`](World::tree_quality), [`Options::mending`].
//! - **Who may meet whom**: [`World::set_filter`], [`ignore`](World::ignore),
//!   [`unignore`](World::unignore). For candidates also
//!   [`set_vertex_groups`](World::set_vertex_groups). Parts of one body:
//!   [`set_labels`](World::set_labels), [`Labels`].
//! - **Broad phase**: [`BroadPhase`], [`World::set_loose_box`].
//! - **Refusals**: [`Error`], [`ErrorKind`].
//! - **Time and work**: [`Query::prepare`], [`World::statistics`], [`Statistics`],
//!   [`World::memory_usage`].
//! - **How trees are built and updated**: [`Options`], [`Degree`], [`Partition`], [`Update`]. How
//!   they look: [`World::tree_shape`], [`tree_cut`](World::tree_cut),
//!   [`vertex_order`](World::vertex_order).
//! - **Threads**: [`Options::threads`], [`Options::all_threads`], a pool of your own with
//!   [`World::with_pool`], or a [`Scheduler`] with [`World::with_scheduler`].
//! - **Single or double precision**: [`Scalar`].
//! - **Exact decisions on single points and triangles**: [`exact`].
//! - **Answers without any tree, to compare with**: [`reference`](mod@reference).
//! - **Bodies as pictures**: [`World::triangles`], [`positions`](World::positions),
//!   [`tree_boxes`](World::tree_boxes), [`NodeBox`].
//! - **A whole simulation**: `crates/pliant/examples/cloth_on_ball` in the repository. A cloth
//!   falls on a moving ball, and reacts to what is found.
//!
//! Words of the paper (Larsson and Akenine-Möller, *Collision Detection for Continuously Deforming
//! Bodies*, 2001), and where they are chosen:
//!
//! - initial shape tree, mesh connectivity tree: [`Partition`];
//! - bottom-up, top-down and hybrid update: [`Update`];
//! - k-ary trees: [`Degree`];
//! - brute force, sweep and prune: [`BroadPhase`];
//! - first pair and all pairs: [`Query`];
//! - all of its choices at once: [`Options::paper`].
//!
//! `ARCHITECTURE.md` in the repository says which folder of the source implements which section.

mod all_pairs;
mod bodies;
mod broad_phase;
mod changes;
mod collide;
mod curves;
mod edit;
mod error;
mod feature_pairs;
mod geometry;
mod held;
mod hit_rows;
mod ids;
mod kernels;
mod labels;
mod mesh;
mod options;
mod pairs;
mod points;
mod queries;
mod selection;
mod sort;
mod statistics;
mod threads;
mod traversal;
mod tree;
mod update;
mod world;

pub use bodies::{NodeBox, TreeShape};
#[doc(hidden)]
pub use changes::RowChanges;
pub use changes::{Changed, Changes, Ended, Listed, Thing};
pub use curves::{Curve, CurveEnd, Curves, Segment, Segments, Step};
#[doc(hidden)]
pub use curves::{CurveColumns, SegmentColumns};
pub use edit::{Edit, Edited};
pub use error::{Error, ErrorKind};
pub use feature_pairs::{FeaturePair, FeaturePairs};
pub use hit_rows::{HitRows, InRows};
pub use ids::BodyId;
#[doc(hidden)]
pub use kernels::Instructions;
pub use labels::Labels;
pub use mesh::Watertight;
pub use options::{BroadPhase, Degree, Options, Partition, Update};
pub use pairs::{
    PairDistance, edge_edge_distances, edge_edge_impacts, triangle_contacts,
    vertex_triangle_distances, vertex_triangle_impacts,
};
#[doc(hidden)]
pub use pairs::{pair_distances, pair_impacts};
pub use pliant_exact::{End, Feature};
pub use points::{ClosestPoint, InsideRule, Located, Side};
pub use queries::hits::*;
pub use selection::Selection;
pub use statistics::Statistics;
pub use threads::Scheduler;
#[doc(hidden)]
pub use threads::{Clock, RecordedPart};
pub use world::{
    Contained, Containment, Depth, FreeStep, Fused, InContact, Interruptible, Piece, Query, Scalar,
    World,
};

/// Brute-force references of every kind of question: slow, and obviously right.
///
/// They take every pair of triangles or of elements, without tree or filter, and decide by exact
/// signs. Every configuration of [`World`] must give these pairs. Cost: O(m^2) exact decisions for
/// one body, O(m_a m_b) for two.
pub mod reference {
    pub use crate::all_pairs::{Moving, edges, leave_out};
    pub use crate::world::reference::*;
}

/// Exact predicates on single points and triangles, without a world.
pub mod exact {
    pub use pliant_exact::{is_degenerate, side_of_plane};
}

// Modules of the documentation alone. Their code is compiled and run, as the README's is. The site
// has the same text. Links to parts lead to files, unless they are given here before.
#[cfg(any(doc, doctest))]
/// [Which question do I ask?]: crate::guide::which_question
/// [First contact]: crate::guide::first_contact
/// [A body with itself]: crate::guide::with_itself
/// [Near]: crate::guide::near
/// [When]: crate::guide::when
/// [Change]: crate::guide::change
/// [Where they meet]: crate::guide::where_they_meet
/// [Inside]: crate::guide::inside
/// [For solvers]: crate::guide::for_solvers
/// [Many meshes]: crate::guide::many_meshes
/// [C and C++]: crate::guide::cpp
/// [In your program]: crate::guide::in_your_program
///
#[doc = include_str!("../guide/README.md")]
pub mod guide {
    #[doc = include_str!("../guide/which_question.md")]
    pub mod which_question {}
    #[doc = include_str!("../guide/first_contact.md")]
    pub mod first_contact {}
    #[doc = include_str!("../guide/with_itself.md")]
    pub mod with_itself {}
    #[doc = include_str!("../guide/near.md")]
    pub mod near {}
    #[doc = include_str!("../guide/when.md")]
    pub mod when {}
    #[doc = include_str!("../guide/change.md")]
    pub mod change {}
    #[doc = include_str!("../guide/where_they_meet.md")]
    pub mod where_they_meet {}
    #[doc = include_str!("../guide/inside.md")]
    pub mod inside {}
    #[doc = include_str!("../guide/for_solvers.md")]
    pub mod for_solvers {}
    #[doc = include_str!("../guide/many_meshes.md")]
    pub mod many_meshes {}
    #[doc = include_str!("../guide/cpp.md")]
    pub mod cpp {}
    #[doc = include_str!("../guide/in_your_program.md")]
    pub mod in_your_program {}
}
