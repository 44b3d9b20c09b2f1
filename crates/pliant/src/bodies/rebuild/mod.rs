//! Mending of trees: a body whose tree has decayed gets a fresh one, built beside it a share at a
//! time.
//!
//! Each new shape of a body does one of three things (rent, then buy):
//!
//! - No tree is being built: begin one, if a fresh tree would have spared by now as much as it
//!   costs.
//! - A tree is being built: build a share, in proportion to the last query's work and to what a
//!   fresh tree would have spared.
//! - The tree is done: exchange the trees.
//!
//! The new tree is of the mesh and the shape of some steps before; for the shape that is as good.
//! Edits made meanwhile are applied as to any tree (`body::edits`). No answer depends on a tree.
//! Connectivity trees are not mended, because a rebuilt one would be the same.

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

/// State of mending: decay of the body's tree, and the tree that is being built to replace it.
#[derive(Default)]
pub(crate) struct Rebuild {
    /// Extra work of the present tree, estimated.
    decay: Decay,
    /// Tree that is being built beside it.
    mending: Option<Box<Mending>>,
}

impl Rebuild {
    /// Copies the decay of the tree. No other tree is being built in the copy.
    pub(crate) fn copy(&self) -> Self {
        Self {
            decay: self.decay,
            mending: None,
        }
    }

    /// Notes the work of queries in a version of the shape. A hardly edited tree tells what a fresh
    /// one does.
    pub(crate) fn note_work(&mut self, work: Work, version: u64, is_hardly_edited: bool) {
        self.decay.note(work, version, is_hardly_edited);
    }

    /// Factor by which the tree looks at more pairs of nodes than a fresh tree would.
    pub(crate) fn quality(&self) -> f64 {
        self.decay.quality()
    }

    /// Notes an edit of the mesh. `are_fewer` says whether there are fewer numbers of triangles
    /// after it.
    pub(crate) fn note_edit(&mut self, changed: &[Changed], are_fewer: bool) {
        if are_fewer {
            // The tree that is being built has numbers that no longer exist.
            self.mending = None;
        } else if let Some(mending) = &mut self.mending {
            mending.note(changed);
        }
    }

    /// Begins anew, with an exchanged tree.
    pub(crate) fn begin_anew(&mut self) {
        self.decay.begin_anew();
        self.mending = None;
    }

    /// Continues to build the tree, or begins to where it pays.
    ///
    /// Returns the finished tree, with its order and the triangles that were edited since it was
    /// begun. Three steps go through all triangles at once and are not divided: listing them, the
    /// first cuts, and exchanging the trees.
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

/// Begins a tree of the present mesh and shape.
fn begin<S: Coordinate>(mesh: &BodyMesh<S>, shape: &BodyShape<S>, options: &Options) -> Mending {
    // In tree order, in which corners lie near each other.
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
