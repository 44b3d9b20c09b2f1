//! Trees that mend themselves: a body whose tree has decayed is given a fresh one, which is built
//! some at a time beside it.
//!
//! ```text
//! each new shape of the body:
//!     no tree is on its way:   begin one, if by now a fresh tree would have spared what it costs   (rent, then buy)
//!     a tree is on its way:    build a share of it, in proportion to what the last query did and a fresh tree would have spared
//!     it is done:              exchange the trees
//! ```
//!
//! The tree is that of the mesh and the shape of some steps before. For the shape that is as good.
//! What was edited meanwhile follows as an edit does (`body::edits`): what is gone is marked in the
//! new tree, what has come is put behind it. No answer depends on a tree. A tree along the mesh
//! would be the same again, so it is not mended.
//!
//! What goes through all triangles at once is not divided: listing them, the first cuts, and
//! exchanging the trees.

mod decay;
mod mending;

use super::mesh::BodyMesh;
use super::shape::BodyShape;
use crate::held::{self, Held};
use crate::kernels::Coordinate;
use crate::mesh::{Changed, Order};
use crate::options::{Options, Partition};
use crate::threads::Budget;
use crate::tree::Tree;
use crate::tree::build::{CutAt, InitialShape, Planner, midpoint};
use decay::Decay;
pub(crate) use decay::Work;
use mending::{Mending, MeshThen, Rule};
use std::borrow::Cow;

/// How far the tree of a body has decayed, and the one that is to take its place.
#[derive(Default)]
pub(crate) struct Rebuild {
    /// How much more the tree does than a fresh one would.
    decay: Decay,
    /// The tree that is being built beside it.
    mending: Option<Box<Mending>>,
}

impl Rebuild {
    /// Copies how far the tree has decayed; no other is being built.
    pub(crate) fn copy(&self) -> Self {
        Self {
            decay: self.decay,
            mending: None,
        }
    }

    /// Notes what queries did in a version of the shape. A tree that was hardly edited tells what a
    /// fresh one does.
    pub(crate) fn note_work(&mut self, work: Work, version: u64, is_hardly_edited: bool) {
        self.decay.note(work, version, is_hardly_edited);
    }

    /// The pairs of nodes that are looked at for each that a fresh tree would look at.
    pub(crate) fn quality(&self) -> f64 {
        self.decay.quality()
    }

    /// Notes an edit of the mesh, after which there are fewer numbers of triangles or not.
    pub(crate) fn note_edit(&mut self, changed: &[Changed], are_fewer: bool) {
        if are_fewer {
            // A tree that is being built has numbers that are no more.
            self.mending = None;
        } else if let Some(mending) = &mut self.mending {
            mending.note(changed);
        }
    }

    /// Begins anew, with a tree that is another.
    pub(crate) fn begin_anew(&mut self) {
        self.decay.begin_anew();
        self.mending = None;
    }

    /// Goes on with mending, or begins it where it pays. Returns the tree that is to take the
    /// other's place, if it is done: with its order, and the triangles that were edited since.
    pub(crate) fn advance<S: Coordinate>(
        &mut self,
        mesh: &BodyMesh<S>,
        shape: &BodyShape<S>,
        know_neighbours: bool,
        options: &Options,
    ) -> Option<(Order, Tree, Vec<Changed>)> {
        let spared = self.decay.spared();
        let mut budget = Budget::of(spared.looks());
        let triangles = mesh.topology().live_count();
        let is_worth_it =
            spared.is_worth_building(triangles) && options.partition != Partition::Connectivity;
        let mending = match self.mending.take() {
            Some(mending) => *mending,
            None if is_worth_it => {
                // Listing the triangles is a look at each.
                budget.spend(triangles);
                begin(mesh, shape, options)
            }
            None => return None,
        };
        let vertices = mesh.order().vertex_order();
        let at = |vertex| shape.get(vertex, vertices);
        let midpoint_of =
            |place: usize, corners: [u32; 3]| midpoint(mesh.slots(place, corners).map(at));
        let now = mesh.triangles();
        let advanced = mending.advance(now, &midpoint_of, know_neighbours, &mut budget);
        if !advanced.is_done() {
            self.mending = Some(Box::new(advanced));
            return None;
        }
        let (then, mut order, tree) = advanced.finish()?;
        // Numbers of triangles and of vertices do not become fewer while a tree is built.
        order.add_vertices(then.vertices() as u32..mesh.vertex_count() as u32);
        Some((order, tree, then.changed(now)))
    }
}

/// Begins a tree of the current mesh and shape.
fn begin<S: Coordinate>(mesh: &BodyMesh<S>, shape: &BodyShape<S>, options: &Options) -> Mending {
    // In the order of the tree, in which corners lie near each other.
    let mut numbers = Vec::with_capacity(mesh.topology().live_count());
    numbers.extend(mesh.still_there(0..mesh.tree_triangles() as u32));
    let then = MeshThen::new(mesh.vertex_count());
    let (degree, leaf_size) = (options.degree.get(), options.leaf_size.get());
    let by_shape = |cut| -> Rule {
        let corners = numbers.iter().map(|&it| mesh.triangles()[it as usize]);
        let positions = shape.in_callers_order(mesh.order()).into_owned();
        let (corners, positions) = (Cow::Owned(corners.collect()), Cow::Owned(positions));
        Box::new(InitialShape::new(corners, positions, cut, degree))
    };
    let rule = match options.partition {
        Partition::Centre => by_shape(CutAt::Centre),
        Partition::Mean => by_shape(CutAt::Mean),
        Partition::Balanced | Partition::Connectivity => {
            return Mending::balanced(then, numbers, (degree, leaf_size));
        }
    };
    let planner = Planner::new(numbers.len(), degree, leaf_size, rule);
    Mending::by_rule(then, planner, numbers)
}

impl Held for Rebuild {
    fn held(&self) -> usize {
        held::boxes(&self.mending)
    }
}
