#![doc = include_str!("../README.md")]
//!
//! # What an answer means
//!
//! - **Two triangles intersect** as closed sets: touching in one point counts, coplanar overlap counts, a degenerate triangle is
//!   the segment or point that it is. The decision is that of exact arithmetic on the coordinates given, whatever the scale,
//!   the order, the tree, the update or the processor.
//! - **Within a body**, pairs that share a vertex of the mesh are left out. The library welds nothing: vertices with different
//!   numbers are different, wherever they are.
//! - **Surfaces only**: a body wholly inside another meets no triangle of it.
//! - **All pairs** are one set, sorted. **The first pair** is some member of it: whether there is one never depends on options
//!   or history, which one it is may. An answer is an error if a body is not there, if the caller interrupts the query, or if a list
//!   would be longer than the caller allows.
//! - **Range**: coordinates are finite and at most `f32::MAX` in magnitude, or they are refused. All others are decided exactly,
//!   `f32` and `f64`, down to the smallest subnormal.
//! - **Floating-point environment**: exactness rests on IEEE 754 rounding to nearest. In a thread in which flush-to-zero or
//!   denormals-are-zero was switched on, answers are the same for coordinates that are zero or at least 2^-126 (`f32`) or
//!   2^-969 (`f64`) in magnitude; smaller ones are refused there.
//!
//! # Never stale
//!
//! [`World::set_positions`] takes a shape over in one checked pass, or refuses it, naming body and vertex, and keeps the last
//! good one. Every query then refits just the boxes that it reads: there is no refit to call and none to forget.
//! Replaying the same motion on one thread allocates nothing.
//!
//! # Map
//!
//! | for | look at |
//! |---|---|
//! | a first loop, step by step, and what to do with hits | [`guide`] |
//! | bodies | [`World::add`], [`remove`](World::remove), [`bodies`](World::bodies), [`BodyId`] |
//! | moving them | [`World::set_positions`], [`write_positions`](World::write_positions); [`rebuild`](World::rebuild); other meshes, [`set_mesh`](World::set_mesh) |
//! | meshes that change | [`World::edit`], [`Edit`], [`apply`](World::apply), [`Edited`]; [`components`](World::components), [`split`](World::split), [`fuse`](World::fuse), [`weld`](World::weld); [`tree_quality`](World::tree_quality), [`Options::mending`] |
//! | asking: what | [`World::intersections`]; [`Pair`]; how they intersect, [`contacts`](World::contacts), [`ContactKind`] |
//! | what is near, now or on the way | [`World::vertex_triangle_candidates`], [`edge_edge_candidates`](World::edge_edge_candidates); [`VertexTriangle`], [`EdgeEdge`]; [`World::edges`] |
//! | what is close, how far apart | [`World::close_vertex_triangle_pairs`], [`close_edge_edge_pairs`](World::close_edge_edge_pairs), [`close_triangle_pairs`](World::close_triangle_pairs); [`distance`](World::distance), [`nearest_body`](World::nearest_body); [`clearance`](World::clearance) |
//! | where bodies are going | [`World::set_motion`], [`finish_motion`](World::finish_motion), [`advance_motion`](World::advance_motion) |
//! | what meets on the way, and how far all may go | [`World::vertex_triangle_impacts`], [`edge_edge_impacts`](World::edge_edge_impacts), [`first_impact`](World::first_impact), [`free_step`](World::free_step), [`collision_free_step`](World::collision_free_step); of single pairs, [`vertex_triangle_impacts`], [`edge_edge_impacts`] |
//! | of whom | [`Selection`]: the whole world, each body with itself too, two bodies, one with itself |
//! | and how much | [`Query::all`], [`first`](Query::first), [`visit`](Query::visit), [`visit_some`](Query::visit_some); [`at_most`](Query::at_most), [`interrupt_if`](Query::interrupt_if); [`World::interruptible`] |
//! | who may meet whom | [`World::set_filter`], [`ignore`](World::ignore), [`unignore`](World::unignore); of candidates, [`set_vertex_groups`](World::set_vertex_groups) |
//! | the broad phase | [`BroadPhase`], [`World::set_loose_box`] |
//! | what was refused, and why | [`Error`], [`ErrorKind`] |
//! | time and work | [`Query::prepare`], [`World::statistics`], [`Statistics`] |
//! | how trees are built and updated | [`Options`], [`Degree`], [`Partition`], [`Update`]; [`World::tree_shape`], [`tree_cut`](World::tree_cut), [`vertex_order`](World::vertex_order) |
//! | threads | [`Options::threads`], or your own pool: [`World::with_pool`] |
//! | single or double precision | [`Scalar`] |
//! | exact decisions on single points and triangles | [`exact`] |
//! | the answer without any tree, to compare with | [`reference`](mod@reference) |
//! | what a body looks like, for pictures | [`World::triangles`], [`positions`](World::positions), [`tree_boxes`](World::tree_boxes), [`NodeBox`] |
//! | a whole simulation | `crates/pliant/examples/cloth_on_ball` in the repository: a cloth that falls on a moving ball and reacts to what is found |
//!
//! Words of the paper (Larsson and Akenine-Möller, *Collision Detection for Continuously Deforming Bodies*, 2001), and where they
//! are chosen: initial shape tree and mesh connectivity tree, [`Partition`]; bottom-up, top-down and hybrid update, [`Update`];
//! k-ary trees, [`Degree`]; brute force and sweep and prune, [`BroadPhase`]; first pair and all pairs, the queries of [`World`]; all
//! at once, [`Options::paper`].
//!
//! Inside, modules are the algorithm, in the order in which data flows; `ARCHITECTURE.md` in the repository says where each section
//! of the paper is.
//!
//! ```text
//! world         what users call: bodies, their shapes and motions, questions
//! collide       a query on its way: which bodies meet, pair by pair; where the phases meet
//! bodies        a body: its mesh, trees and shape; edits, and how trees are mended
//! mesh          what the caller said, how a tree orders it, its edges; what an edit makes of it
//! geometry      f32 or f64 coordinates, boxes in f32, rounded outward
//! tree          nodes of degree 2, 4, 8, and sets of their boxes; building: by shape, by mesh, balanced
//! update        which boxes are made when: bottom-up, top-down, hybrid
//! broad_phase   brute force; sweep and prune; a tree of bodies
//! traversal     tree against tree, tree against itself, for any kind of query
//! queries       one room a kind: intersections and contacts, candidates, close pairs, impacts
//! sort          hits in order
//! kernels       the inner loops, over boxes and points side by side
//! threads       one or many, private or lent
//! all_pairs     slow and obviously right: what `reference` goes through
//! ```

mod all_pairs;
mod bodies;
mod broad_phase;
mod collide;
mod edit;
mod error;
mod geometry;
mod held;
mod ids;
mod kernels;
mod mesh;
mod options;
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
pub use edit::{Edit, Edited};
pub use error::{Error, ErrorKind};
pub use ids::BodyId;
#[doc(hidden)]
pub use kernels::Instructions;
pub use options::{BroadPhase, Degree, Options, Partition, Update};
pub use queries::hits::*;
pub use selection::Selection;
pub use statistics::Statistics;
#[doc(hidden)]
pub use world::pair_impacts;
pub use world::{
    FreeStep, Fused, InContact, Interruptible, Piece, Query, Scalar, World, edge_edge_impacts,
    vertex_triangle_impacts,
};

/// Slow and obviously right: every pair of triangles, or of elements, no tree, no box of several,
/// no filter, exact signs.
///
/// Every configuration of [`World`] must give these pairs. O(m^2) or O(m_a m_b) exact decisions.
pub mod reference {
    pub use crate::all_pairs::{Moving, edges};
    pub use crate::world::reference::*;
}

/// Exact decisions on single points and triangles, for who asks about shapes beside a world.
pub mod exact {
    pub use pliant_exact::{is_degenerate, side_of_plane};
}

// A module of the documentation alone; its code is compiled and run like that of the README, with which this page begins.
#[cfg(any(doc, doctest))]
#[doc = include_str!("../guide.md")]
pub mod guide {}
